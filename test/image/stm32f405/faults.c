/* SPDX-License-Identifier: MIT */
/* The run goes on to a random time and forks: in the child a fault begins there, and the drives
 * must be off in time; the parent goes on without it. */
#include "faults.h"

#include "exhand/safety.h"

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define MS      (STM_HZ / 1000)
#define LIMIT   (20 * (uint64_t)MS)
#define WATCHED (60 * (uint64_t)MS)  /* they stay off; */
#define SAID    (200 * (uint64_t)MS) /* behind a log of 82 ms words come */
#define FROM    (700 * (uint64_t)MS) /* of the loop: it is armed, and its ramp is over */
#define SPAN    (2500 * (uint64_t)MS)
#define ASTRAY  0x08080000u /* an endless loop stands there */

static struct machine *m;

/* --- what goes wrong --- */

static void estop(void) { loop.cut |= EXH_DIN_ESTOP; }
static void drive(void) { loop.cut |= EXH_DIN_DRIVE0; }
static void deadman(void) { loop.cut |= EXH_DIN_DEADMAN; }
static void jumped(void) { loop.board.jump[0] = 20000; }
static void adc_late(void) { m->s.wrong |= 1u << STM_ADC_LATE; }
static void da_silent(void) { m->s.wrong |= 1u << STM_DA_SILENT; }
static void spi_stuck(void)
{
    m->s.wrong |= 1u << STM_SPI_STUCK;
    if (m->s.spi[2].shifts) { m->s.spi[2].done_at = STM_NEVER; }
}
static void clock_lost(void) { stm_hse_fails(&m->s); }
static void supply_low(void) { stm_supply_low(&m->s, 1); }
static void brown_out(void)
{
    m->s.resets = 1;
    m->s.reset_flags = STM_BROWNOUT;
}
static void astray(void) { machine_set_reg(m, UC_ARM_REG_PC, ASTRAY | 1); }
static void masked(void)
{
    machine_set_reg(m, UC_ARM_REG_PRIMASK, 1);
    astray();
}
static void slow_watchdog(void)
{
    m->s.wrong |= 1u << STM_LSI_SLOW;
    astray();
}
/* The next that uses the stack runs over its end. */
static void overrun(void) { machine_set_reg(m, UC_ARM_REG_SP, STM_RAM + 256 + 16); }

static const struct {
    const char *name,
        *told; /* what the image must say of it: a fault's name, or words; "": reset */
    void (*begin)(void);
} kind[] = {{"emergency stop", "estop", estop}, {"a drive not ready", "drive", drive},
    {"dead-man let go", "deadman", deadman}, {"encoder jumped", "", jumped},
    {"A/D transfers stop", "card", adc_late}, {"D/A silent", "card", da_silent},
    {"SPI stuck", "card", spi_stuck}, {"crystal stops", "crystal", clock_lost},
    {"supply low", "card", supply_low}, {"brown-out", "reset", brown_out},
    {"program astray", "reset", astray}, {"the same, interrupts off", "reset", masked},
    {"the same, 17 kHz watchdog", "reset", slow_watchdog}, {"stack overrun", "exception", overrun}};
enum { KINDS = sizeof kind / sizeof kind[0] };

struct seen {
    uint8_t kind, done, off, stays, pulled;
    uint64_t took;
    char told[24];
};

/* --- in the child --- */

static int drives_on(void) { return board_enables(&m->s) != 0; }

/* After a reset pins float: resistors hold drives off and the D/A cleared. */
static void start_anew(void)
{
    const uint32_t flags = m->s.reset_flags;
    stm_reset(&m->s, flags);
    da_clear(&loop.board.da, 0);
    loop.begun = loop.open = 0;
    machine_boot(m);
}

static void note(struct seen *s, const char *what)
{
    if (s->told[0] == 0) { snprintf(s->told, sizeof s->told, "%.23s", what); }
}

static void tell(struct seen *s)
{
    const struct exh_safety *safe = loop.cfg.scene->safety;
    if (strstr(loop.text, "crystal")) { note(s, "crystal"); }
    if (strstr(loop.text, "exception")) { note(s, "exception"); }
    for (unsigned k = 0; safe && k < 16; k++) {
        if (safe->first == 1u << k) { note(s, exh_fault_name(k)); }
    }
}

/* Step by step, since what drives show between two of them is not seen. */
static void child(struct seen *s)
{
    const int words = kind[s->kind].begin == clock_lost || kind[s->kind].begin == overrun;
    const uint64_t from = m->s.now, end = from + (words ? SAID : WATCHED);
    uint64_t off_at = 0;
    loop.text_n = 0;
    loop.text[0] = 0;
    s->pulled = loop.last.dac_raw[0] != 32768;
    loop.quiet = 1;
    kind[s->kind].begin();
    for (uint64_t at = from + MS / 10; at <= end; at += MS / 10) {
        m->stop_at = at;
        m->s.wake = 0;
        while (m->s.now < at && m->end != M_BROKEN) {
            if (m->s.resets) { m->end = M_RESET; }
            if (m->end == M_RESET) {
                note(s, "reset");
                start_anew();
            }
            if (machine_run(m) == M_HALTED) { break; } /* its loop makes safe and feeds, for good */
            if (m->end == M_HUNG) { m->s.now = at; }
        }
        if (!drives_on() && off_at == 0) { off_at = m->s.now; }
        if (drives_on() && off_at) { s->stays = 0; }
        if (m->end == M_HALTED) { break; }
    }
    tell(s);
    s->took = off_at ? off_at - from : WATCHED;
    s->off = off_at && off_at - from <= LIMIT;
    s->done = m->end != M_BROKEN;
    if (!s->done) { note(s, m->why); }
}

/* --- outside --- */

static void in_child(struct seen *s)
{
    int way[2];
    pid_t pid;
    fflush(NULL);
    if (pipe(way) < 0 || (pid = fork()) < 0) { return; }
    if (pid == 0) {
        child(s);
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

static int table(const struct seen *seen, unsigned times)
{
    int bad = 0;
    printf(
        "%-26s %6s %8s %8s %6s  %s\n", "fault", "times", "mean ms", "most ms", "late", "told as");
    for (unsigned k = 0; k < KINDS; k++) {
        unsigned n = 0, late = 0;
        double sum = 0, most = 0;
        const char *told = "";
        for (unsigned i = 0; i < times; i++) {
            const double ms = (double)seen[i].took / MS;
            if (seen[i].kind != k) { continue; }
            n++;
            late += !seen[i].done || !seen[i].off || !seen[i].stays;
            if (kind[k].told[0] && strcmp(seen[i].told, kind[k].told) != 0) { late++; }
            if (!told[0] || strcmp(seen[i].told, kind[k].told) != 0) { told = seen[i].told; }
            sum += ms;
            most = ms > most ? ms : most;
        }
        bad += late != 0;
        printf(
            "%-26s %6u %8.2f %8.2f %6u  %s\n", kind[k].name, n, n ? sum / n : 0, most, late, told);
    }
    return bad;
}

int stm_faults(struct machine *machine, unsigned times, uint64_t seed)
{
    struct seen *seen = calloc(times, sizeof *seen);
    uint64_t *at = calloc(times, sizeof *at), base;
    unsigned pulled = 0;
    int bad;
    m = machine;
    if (seen == NULL || at == NULL) { return 1; }
    for (unsigned i = 0; i < times; i++) {
        at[i] = FROM + draw(&seed) * SPAN / (UINT64_C(1) << 31);
    }
    qsort(at, times, sizeof *at, by_time);
    m->flash[ASTRAY - STM_FLASH] = 0xFE;
    m->flash[ASTRAY - STM_FLASH + 1] = 0xE7;
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
        seen[i].kind = (uint8_t)(i % KINDS);
        seen[i].stays = 1;
        in_child(&seen[i]);
        pulled += seen[i].pulled;
    }
    bad = table(seen, times);
    printf("%u faults of %u kinds, %u while a current flowed; drives off within 20 ms and for the "
           "rest of 60: %s\n",
        times, (unsigned)KINDS, pulled, bad ? "NOT ALL" : "all");
    free(at);
    free(seen);
    return bad != 0;
}
