/* SPDX-License-Identifier: MIT */
/* The run goes on to a random time and forks: in the child a fault begins there, and must end as
 * its kind says; the parent goes on without it. */
#include "faults.h"

#include "kinds.h"

#include "exhand/error.h"
#include "exhand/safety.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define MS       (STM_HZ / 1000)
#define LIMIT    (20 * (uint64_t)MS)
#define WATCHED  (50 * (uint64_t)MS)  /* they stay off */
#define SAID     (200 * (uint64_t)MS) /* behind a log of 82 ms words come */
#define CEASES   (3 * STM_HZ / 1000000)
#define FROM     (120 * (uint64_t)MS) /* the dead-man switch is held from 100 ms on */
#define SPAN     (3000 * (uint64_t)MS)
#define SAFETY   60u   /* in struct exh_scene of a 32-bit image */
#define CURRENT  0.006 /* A: a step of the library's codes is 0.5 mA, of tracking's 4 */
#define PEAK     6.61  /* A: the D/A's span, docs/SAFETY.md */
#define REPORTED 24

static struct machine *m;

struct seen {
    uint8_t kind, done, ran, pulled; /* ran: the gate was open; pulled: a current flowed */
    uint8_t on, pulls, state;        /* at the end */
    uint64_t off_after, zero_after;  /* the last time that drives, and current, went off */
    double most_A;
    char told[REPORTED];
};

/* --- in the child --- */

static struct {
    uint8_t on, pulls;
    uint64_t off_at, zero_at;
    double most_A;
} now;

static double current_A(unsigned i)
{
    const struct sim_device *d = &loop.cfg.board.device;
    const double code = 32768 + da_uV(&loop.board.da, i) * 3249e-6;
    return (code - d->dac_zero) / d->dac_perA;
}

/* At the pins, each time that one of them moves: what the drives are told. */
static void look(void)
{
    const unsigned on = board_enables(&m->s);
    int pulls = 0;
    for (unsigned i = 0; i < loop.cfg.scene->fingers; i++) {
        const double A = on >> i & 1 ? current_A(i) : 0, size = A < 0 ? -A : A;
        pulls |= size > CURRENT;
        now.most_A = size > now.most_A ? size : now.most_A;
    }
    if (now.on && !on) { now.off_at = m->s.now; }
    if (now.pulls && !pulls) { now.zero_at = m->s.now; }
    now.on = on != 0;
    now.pulls = pulls != 0;
}

/* What the image has of its state. */
static struct exh_safety safety(void)
{
    struct exh_safety s;
    const uint8_t *at = machine_at(m, machine_word(m, loop.scene + SAFETY), sizeof s);
    memset(&s, 0, sizeof s);
    if (at) { memcpy(&s, at, sizeof s); }
    return s;
}

/* After a reset pins float: resistors hold drives off and the D/A cleared. */
static void start_anew(void)
{
    const uint32_t flags = m->s.reset_flags;
    stm_reset(&m->s, flags);
    da_clear(&loop.board.da, 0);
    loop.begun = loop.open = 0;
    look();
    machine_boot(m);
}

static void note(struct seen *s, const char *what)
{
    if (s->told[0] == 0) { snprintf(s->told, sizeof s->told, "%.23s", what); }
}

static void run_to(struct seen *s, uint64_t end)
{
    enum machine_end how = M_RUNS;
    while (m->s.now < end && how != M_BROKEN && how != M_HALTED) {
        m->stop_at = end;
        m->s.wake = 0;
        how = machine_run(m); /* M_HALTED: its loop makes safe and feeds, for good */
        if (how == M_RESET) {
            note(s, "reset");
            start_anew();
        }
        if (how == M_HUNG) { m->s.now = end; }
    }
}

static void tell(struct seen *s)
{
    const struct exh_safety safe = safety();
    if (strstr(loop.text, "crystal")) { note(s, "crystal"); }
    if (strstr(loop.text, "exception")) { note(s, "exception"); }
    for (unsigned k = 0; k < EXH_FAULTS; k++) {
        if (safe.first == 1u << k) { note(s, exh_fault_name(k)); }
    }
    s->state = safe.state;
}

static void child(struct seen *s, unsigned chance)
{
    const struct kind *k = &kinds[s->kind];
    const uint64_t from = m->s.now;
    const struct exh_safety safe = safety();
    s->ran = exh_safety_is_running(&safe) != 0;
    loop.text_n = 0;
    loop.text[0] = 0;
    loop.quiet = 1;
    board_changed = look;
    now.most_A = 0;
    look();
    now.off_at = now.zero_at = from;
    s->pulled = now.pulls;
    k->begin(chance);
    if (k->cease) {
        run_to(s, from + CEASES);
        k->cease();
    }
    run_to(s, from + (k->ends == ENDS_WORDS || k->ends == ENDS_STUCK ? SAID : WATCHED));
    tell(s);
    s->on = now.on;
    s->pulls = now.pulls;
    s->off_after = now.off_at - from;
    s->zero_after = now.zero_at - from;
    s->most_A = now.most_A;
    s->done = m->end != M_BROKEN;
    if (!s->done) { note(s, m->why); }
}

/* --- outside --- */

static void in_child(struct seen *s, unsigned chance)
{
    int way[2];
    pid_t pid;
    fflush(NULL);
    if (pipe(way) < 0 || (pid = fork()) < 0) { return; }
    if (pid == 0) {
        child(s, chance);
        _exit(write(way[1], s, sizeof *s) != sizeof *s);
    }
    close(way[1]);
    if (read(way[0], s, sizeof *s) != sizeof *s) { s->done = 0; }
    close(way[0]);
    (void)waitpid(pid, NULL, 0);
}

static uint64_t draw(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return *state >> 33;
}

static int by_time(const void *a, const void *b)
{
    uint64_t x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

/* Before the gate is open a fault need not be told: the box is, or goes, off. A fault with a name
 * leaves the box in FAULT. */
static int is_wrong(const struct seen *s)
{
    const struct kind *k = &kinds[s->kind];
    const uint64_t limit = LIMIT + (k->ends == ENDS_STUCK ? KIND_STUCK_MS * (uint64_t)MS : 0);
    const int off = !s->on && !s->pulls && s->off_after <= limit && s->zero_after <= limit;
    const int told = strcmp(s->told, k->told) == 0;
    const int latched = s->state == EXH_STATE_FAULT || strcmp(k->told, "reset") == 0;
    if (!s->done || s->most_A > PEAK) { return 1; }
    switch (k->ends) {
    case ENDS_BOUND: return s->told[0] && s->on;
    case ENDS_STUCK: return s->told[0] && !(off && told && latched);
    case ENDS_WELL: return !told || (s->ran && !s->on);
    case ENDS_WORDS: return !off || !told;
    case ENDS_OFF:
    default: return !off || (s->ran && !(told && latched));
    }
}

static double larger(double a, double b) { return a > b ? a : b; }

static unsigned row(const struct seen *seen, unsigned times, unsigned k)
{
    unsigned n = 0, pulled = 0, told = 0, bad = 0;
    double sum = 0, zero = 0, off = 0, most_A = 0;
    const char *else_told = "";
    for (unsigned i = 0; i < times; i++) {
        const struct seen *s = &seen[i];
        if (s->kind != k) { continue; }
        n++;
        pulled += s->pulled;
        bad += is_wrong(s) != 0;
        sum += (double)s->zero_after / MS;
        zero = larger(zero, (double)s->zero_after / MS);
        off = larger(off, (double)s->off_after / MS);
        most_A = larger(most_A, s->most_A);
        told += strcmp(s->told, kinds[k].told) == 0;
        if (s->told[0] && strcmp(s->told, kinds[k].told) != 0) { else_told = s->told; }
    }
    if (n == 0) { return 0; }
    if (kinds[k].ends != ENDS_BOUND && kinds[k].ends != ENDS_WELL) {
        printf(
            "| %s | %u | %u | %.2f, %.2f | %.2f | ", kinds[k].name, n, pulled, sum / n, zero, off);
    } else {
        printf("| %s | %u | %u | – | – | ", kinds[k].name, n, pulled);
    }
    printf("%.2f | %s %u%s%s | %u |\n", most_A, kinds[k].told[0] ? kinds[k].told : "nothing", told,
        else_told[0] ? ", else " : "", else_told, bad);
    return bad;
}

static unsigned table(const struct seen *seen, unsigned times)
{
    unsigned bad = 0, pulled = 0, ran = 0;
    printf("| fault | times | while a current flowed | current zero, mean and most ms | drives "
           "off, most ms | most A | told as | wrong |\n|--|--|--|--|--|--|--|--|\n");
    for (unsigned k = 0; k <= kind_count; k++) { bad += row(seen, times, k); }
    for (unsigned i = 0; i < times; i++) {
        pulled += seen[i].pulled;
        ran += seen[i].ran;
    }
    printf("\n%u faults, %u with the gate open, %u while a current flowed: %u wrong\n", times, ran,
        pulled, bad);
    return bad;
}

int stm_faults(struct machine *machine, unsigned times, uint64_t seed, int stuck)
{
    struct seen *seen = calloc(times, sizeof *seen);
    uint64_t *at = calloc(times, sizeof *at), base;
    unsigned bad;
    m = machine;
    if (seen == NULL || at == NULL) { return 1; }
    for (unsigned i = 0; i < times; i++) {
        at[i] = FROM + draw(&seed) * SPAN / (UINT64_C(1) << 31);
    }
    qsort(at, times, sizeof *at, by_time);
    kinds_prepare(m);
    loop.ticks_wanted = UINT32_MAX;
    stm_reset(&m->s, STM_POWER_ON);
    machine_boot(m);
    base = m->s.now;
    for (unsigned i = 0; i < times; i++) {
        m->stop_at = base + at[i];
        m->s.wake = 0;
        if (m->s.now < m->stop_at && machine_run(m) != M_DONE) {
            fprintf(stderr, "stm32f405: the run ended by itself: %s\n", m->why);
            return 1;
        }
        seen[i].kind = (uint8_t)(stuck ? kind_count : i % kind_count);
        in_child(&seen[i], (unsigned)draw(&seed));
    }
    bad = table(seen, times);
    free(at);
    free(seen);
    return bad != 0;
}
