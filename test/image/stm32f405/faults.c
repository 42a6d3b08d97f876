/* SPDX-License-Identifier: MIT */
/* The run goes on to a random time and forks: in the child a fault begins there, and must end as
 * its kind says; the parent goes on without it. */
#include "faults.h"

#include "kinds.h"

#include "base/param.h"

#include "exhand/error.h"
#include "exhand/safety.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define MS        (STM_HZ / 1000)
#define LIMIT     (20 * (uint64_t)MS)
#define WATCHED   (50 * (uint64_t)MS)  /* they stay off */
#define SAID      (200 * (uint64_t)MS) /* behind a log of 82 ms words come */
#define CEASES    (3 * STM_HZ / 1000000)
#define FROM      (120 * (uint64_t)MS) /* the dead-man switch is held from 100 ms on */
#define SPAN      (3000 * (uint64_t)MS)
#define ARMS      (100 * (uint64_t)MS)  /* not before; the loop runs from a fifth of it on */
#define ARMED     (1000 * (uint64_t)MS) /* with arm_pull, and the ramp */
#define REFUSED   (750 * (uint64_t)MS)
#define LONG      (4000 * (uint64_t)MS) /* I2t allows the peak for 2.7 s */
#define PRESSES   (900 * (uint64_t)MS)  /* a simulated hand, in its first contact */
#define WITHDRAWN (2000 * (uint64_t)MS)
#define SAFETY    60u /* in struct exh_scene of a 32-bit image, */
#define PARAMS    12u /* and of its struct exh_params, the values in effect */
#define ACTIVE    4u
#define CURRENT   0.006 /* A: a step of the library's codes is 0.5 mA, of tracking's 4 */
#define HARDLY    0.05  /* A: the pull of a string without a contact is 0.1 N */
#define CODES     0.002 /* A: a code of the library's, and half a step of the D/A's */
#define FALLS_S   0.6   /* of a mass: else it hangs at rest, where no count can be wrong */
#define GUARD_B   256u  /* from where RAM begins to the stack (ldscripts/stm32f405.ld), */
#define STACK_B   8192u
#define PAINT     0xA5A5A5A5u /* which start.c has painted */
#define REPORTED  24

static struct machine *m;

struct seen {
    uint8_t kind, done, ran, pulled; /* ran: the gate was open; pulled: a current flowed */
    uint8_t on, pulls, state;        /* at the end */
    uint8_t acted, above;            /* it took effect; a limit of the parameters was passed */
    uint64_t off_after, zero_after;  /* the last time that drives, and current, went off */
    uint64_t clung;                  /* the longest that a finger far before its wall was pulled */
    uint32_t stack_B;
    double most_A, heat; /* of what I2t allows: 1 */
    char told[REPORTED];
};

/* --- in the child --- */

static struct {
    uint8_t on, pulls, above;
    uint64_t off_at, zero_at, at;
    double most_A, heat;
    struct {
        double limit_A, cont_A, budget, A, heat; /* A: since `at` */
        uint64_t from;                           /* near its wall, or hardly pulled */
    } finger[EXH_FINGERS];
    uint64_t clung;
    uint8_t let_go; /* a finger whose encoder is at fault was pulled, and then hardly */
} now;

static double current_A(unsigned i)
{
    const struct sim_device *d = &loop.cfg.board.device;
    const double code = 32768 + da_uV(&loop.board.da, i) * 3249e-6;
    return (code - d->dac_zero) / d->dac_perA;
}

/* A parameter in effect, as the image has it, of this finger or of all; the largest of several. */
static double param(const char *name, unsigned f)
{
    const struct exh_signal_table *t = loop.cfg.scene->params->table;
    const uint32_t at = machine_word(m, machine_word(m, loop.scene + PARAMS) + ACTIVE);
    double most = -1;
    for (uint32_t i = 0; i < exh_signal_count(t); i++) {
        uint16_t k;
        const struct exh_signal *row = exh_signal_at(t, i, &k);
        if (strcmp(row->name, name) == 0 && (k == f || f == EXH_FINGERS)) {
            most = fmax(most, cli_signal_value(row, (int32_t)machine_word(m, at + 4 * i)));
        }
    }
    return most;
}

/* What no fault may pass (docs/SAFETY.md), from the parameters in effect alone. */
static void set_limits(void)
{
    for (unsigned f = 0; f < loop.cfg.scene->fingers; f++) {
        const double material_N = param("mat_f_max", EXH_FINGERS), peak_A = param("i_peak", f);
        double most_N = fmin(param("f_max", f), param("person_f", EXH_FINGERS));
        if (material_N >= 0) { most_N = fmin(most_N, material_N); }
        now.finger[f].limit_A =
            fmin(fmin(peak_A, param("person_i", EXH_FINGERS)), most_N / param("kf", f));
        now.finger[f].cont_A = param("i_cont", f);
        now.finger[f].budget = (peak_A * peak_A - now.finger[f].cont_A * now.finger[f].cont_A) *
                               param("peak_time", f) / 1000;
        now.finger[f].from = m->s.now;
    }
}

/* String that is out, as it is. */
static double string_m(unsigned f)
{
    const struct sim_device *d = &loop.cfg.board.device;
    const int32_t cnt = (int32_t)(loop.board.enc[f] - (uint32_t)d->enc_start);
    return cnt * d->step_m / d->decode;
}

/* Since the last look each current was as it was then. */
static void go_by(unsigned f, double A)
{
    const double s = (double)(m->s.now - now.at) / STM_HZ, was_A = now.finger[f].A;
    const double cont_A = now.finger[f].cont_A;
    now.finger[f].heat = fmax(0, now.finger[f].heat + (was_A * was_A - cont_A * cont_A) * s);
    now.heat = fmax(now.heat, now.finger[f].heat / now.finger[f].budget);
    now.let_go |= (loop.board.stuck | loop.board.miswired | loop.board.half) >> f & 1 &&
                  was_A > HARDLY && A <= HARDLY;
    now.finger[f].A = A;
    if (was_A <= HARDLY || string_m(f) > KIND_FAR_M) { now.finger[f].from = m->s.now; }
    if (m->s.now - now.finger[f].from > now.clung) { now.clung = m->s.now - now.finger[f].from; }
    now.above |= A > now.finger[f].limit_A + CODES;
}

/* At the pins, each time that one of them moves: the commands to the drives. */
static void look(void)
{
    const unsigned on = board_enables(&m->s);
    int pulls = 0;
    for (unsigned i = 0; i < loop.cfg.scene->fingers; i++) {
        const double A = on >> i & 1 ? current_A(i) : 0, size = fabs(A);
        go_by(i, size);
        pulls |= size > CURRENT;
        now.most_A = size > now.most_A ? size : now.most_A;
    }
    if (now.on && !on) { now.off_at = m->s.now; }
    if (now.pulls && !pulls) { now.zero_at = m->s.now; }
    now.on = on != 0;
    now.pulls = pulls != 0;
    now.at = m->s.now;
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

/* Bytes of the stack that were used since the image painted it. */
static uint32_t stack_B(void)
{
    uint32_t free_B = 0;
    while (free_B < STACK_B && machine_word(m, STM_RAM + GUARD_B + free_B) == PAINT) {
        free_B += 4;
    }
    return STACK_B - free_B;
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
    if (safe.refused == EXH_ARM_POLARITY) { note(s, "polarity"); }
    s->state = safe.state;
}

static uint64_t watched(const struct kind *k)
{
    switch (k->set) {
    case SET_GLOVE: return WITHDRAWN;
    case SET_ARM: return REFUSED;
    case SET_LONG: return LONG;
    case SET_PERSON: return LONG / 4;
    case SET_MANY:
    case SETS:
    default: return k->ends == ENDS_WORDS ? SAID : WATCHED;
    }
}

static void child(struct seen *s, unsigned chance)
{
    const struct kind *k = &kinds[s->kind];
    const uint64_t from = m->s.now;
    const struct exh_safety safe = safety();
    const uint32_t sign = k->sign ? k->sign() : 0;
    s->ran = exh_safety_is_running(&safe) != 0;
    loop.text_n = 0;
    loop.text[0] = 0;
    loop.quiet = 1;
    set_limits();
    now.at = from;
    board_changed = look;
    look();
    now.most_A = 0;
    now.off_at = now.zero_at = from;
    s->pulled = now.pulls;
    k->begin(chance);
    look();
    if (k->cease) {
        run_to(s, from + CEASES);
        k->cease();
    }
    run_to(s, from + watched(k));
    look();
    tell(s);
    s->on = now.on;
    s->pulls = now.pulls;
    s->off_after = now.off_at - from;
    s->zero_after = now.zero_at - from;
    s->most_A = now.most_A;
    s->heat = now.heat;
    s->clung = now.clung;
    if (k->ends == ENDS_LETGO && now.let_go) { note(s, "let go"); }
    s->above = now.above;
    s->stack_B = k->begin == kind_overruns ? 0 : stack_B();
    s->acted = k->sign && k->sign() != sign;
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

/* Before the gate is open a fault need not be reported: the box is, or goes, off. A fault with a
 * name leaves the box in FAULT. */
static int is_wrong(const struct seen *s)
{
    const struct kind *k = &kinds[s->kind];
    const int off = !s->on && !s->pulls;
    const int soon = off && s->off_after <= LIMIT && s->zero_after <= LIMIT;
    const int told = strcmp(s->told, k->told) == 0;
    const int latched = s->state == EXH_STATE_FAULT || strcmp(k->told, "reset") == 0;
    const uint64_t patience = KIND_DOUBT_MS * (uint64_t)MS + LIMIT;
    if (!s->done || s->above || s->heat > 1 || s->stack_B > STACK_B / 2) { return 1; }
    switch (k->ends) {
    case ENDS_BOUND: return s->told[0] && s->on;
    case ENDS_LETGO: return s->clung > patience || !told;
    case ENDS_ARM:
        return !off || !told || s->state != EXH_STATE_OFF ||
               s->most_A > KIND_ARM_N / loop.cfg.board.device.kf_npa + CURRENT;
    case ENDS_WELL: return !told || !s->acted || (s->ran && !s->on);
    case ENDS_WORDS: return !soon || !told;
    case ENDS_OFF:
    default: return !soon || (s->ran && !(told && latched)) || (k->sign && !s->acted);
    }
}

static double larger(double a, double b) { return a > b ? a : b; }

static unsigned row(const struct seen *seen, unsigned times, unsigned k)
{
    unsigned n = 0, pulled = 0, acted = 0, told = 0, bad = 0;
    double sum = 0, zero = 0, off = 0, most_A = 0;
    const char *else_told = "";
    const int ends =
        kinds[k].ends != ENDS_BOUND && kinds[k].ends != ENDS_WELL && kinds[k].ends != ENDS_LETGO;
    for (unsigned i = 0; i < times; i++) {
        const struct seen *s = &seen[i];
        if (s->kind != k) { continue; }
        n++;
        pulled += s->pulled;
        acted += s->acted;
        bad += is_wrong(s) != 0;
        sum += (double)s->zero_after / MS;
        zero = larger(zero, (double)s->zero_after / MS);
        off = larger(off, (double)s->off_after / MS);
        most_A = larger(most_A, s->most_A);
        told += strcmp(s->told, kinds[k].told) == 0;
        if (s->told[0] && strcmp(s->told, kinds[k].told) != 0) { else_told = s->told; }
    }
    if (n == 0) { return 0; }
    printf("| %s | %u | %u | ", kinds[k].name, n, pulled);
    if (kinds[k].sign) { printf("%u | ", acted); }
    if (!kinds[k].sign) { printf("told | "); }
    if (ends) { printf("%.2f, %.2f | %.2f | ", sum / n, zero, off); }
    if (!ends) { printf("– | – | "); }
    printf("%.2f | %s %u%s%s | %u |\n", most_A, kinds[k].told[0] ? kinds[k].told : "nothing", told,
        else_told[0] ? ", else " : "", else_told, bad);
    return bad;
}

static unsigned table(const struct seen *seen, unsigned times, enum kind_set set)
{
    unsigned bad = 0, pulled = 0, ran = 0;
    double heat = 0, clung_ms = 0;
    uint32_t most_B = 0;
    printf("| fault | times | while a current flowed | took effect | current zero, mean and most "
           "ms | drives off, most ms | most A | told as | wrong |\n"
           "|--|--|--|--|--|--|--|--|--|\n");
    for (unsigned k = 0; k < kind_count; k++) { bad += row(seen, times, k); }
    for (unsigned i = 0; i < times; i++) {
        pulled += seen[i].pulled;
        ran += seen[i].ran;
        heat = larger(heat, seen[i].heat);
        most_B = seen[i].stack_B > most_B ? seen[i].stack_B : most_B;
        clung_ms = larger(clung_ms, (double)seen[i].clung / MS);
    }
    printf("\nlimit %.3f A, %.0f %% of what I2t allows, %u bytes of stack", now.finger[0].limit_A,
        100 * heat, (unsigned)most_B);
    if (set == SET_GLOVE) { printf(", let go at most %.1f ms late", clung_ms); }
    printf("\n");
    printf("%u faults, %u with the gate open, %u while a current flowed: %u wrong\n", times, ran,
        pulled, bad);
    return bad;
}

/* The n-th kind of a set, again and again. */
static uint8_t kind_of(enum kind_set set, unsigned n)
{
    unsigned of = 0, k = 0;
    for (unsigned i = 0; i < kind_count; i++) { of += kinds[i].set == set; }
    for (n %= of; kinds[k].set != set || n-- > 0;) { k++; }
    return (uint8_t)k;
}

/* The run without a fault goes on to this time. */
static int go_to(uint64_t at)
{
    m->stop_at = at;
    m->s.wake = 0;
    if (m->s.now < at && machine_run(m) != M_DONE) {
        fprintf(stderr, "stm32f405: the run ended by itself: %s\n", m->why);
        return 0;
    }
    return 1;
}

/* Else what its faults end in would say nothing. */
static int is_well(void)
{
    const struct exh_safety safe = safety();
    if (exh_safety_is_running(&safe)) { return 1; }
    fprintf(stderr, "stm32f405: without a fault the box is in state %u, faults 0x%x\n", safe.state,
        (unsigned)safe.faults);
    return 0;
}

int stm_faults(struct machine *machine, unsigned times, uint64_t seed, enum kind_set set)
{
    static const uint64_t from[SETS] = {FROM, PRESSES, ARMS / 5, FROM, FROM};
    static const uint64_t span[SETS] = {SPAN, PRESSES, ARMS / 2, SPAN, SPAN};
    struct seen *seen = calloc(times, sizeof *seen);
    uint64_t *at = calloc(times, sizeof *at), base;
    unsigned bad;
    m = machine;
    if (seen == NULL || at == NULL) { return 1; }
    for (unsigned i = 0; i < times; i++) {
        at[i] = from[set] + draw(&seed) * span[set] / (UINT64_C(1) << 31);
    }
    qsort(at, times, sizeof *at, by_time);
    kinds_prepare(m);
    loop.cfg.board.device.observe_s = FALLS_S;
    loop.ticks_wanted = UINT32_MAX;
    stm_reset(&m->s, STM_POWER_ON);
    machine_boot(m);
    base = m->s.now;
    for (unsigned i = 0; i < times; i++) {
        if (!go_to(base + at[i])) { return 1; }
        seen[i].kind = kind_of(set, i);
        in_child(&seen[i], (unsigned)draw(&seed));
    }
    if (!go_to(m->s.now < base + ARMED ? base + ARMED : m->s.now) || !is_well()) { return 1; }
    set_limits();
    bad = table(seen, times, set);
    free(at);
    free(seen);
    return bad != 0;
}
