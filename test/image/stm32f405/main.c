/* SPDX-License-Identifier: MIT */
/* One run of an image, or another action of the options: see help[]. */
#include "faults.h"
#include "kinds.h"
#include "show.h"

#include <stdlib.h>
#include <string.h>

#define CORE_HZ 168000000.0

static struct machine machine;

static const char *const ends[] = {"runs", "halted", "was reset", "hung", "broke", "done"};

static int by_value(const void *a, const void *b)
{
    uint32_t x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

/* Of 100 ticks 99 take no more. */
static uint32_t most_of_99(const struct loop_result *r, uint32_t *kept)
{
    const uint64_t all = r->ticks > 1 ? r->ticks - 1 : 0;
    const size_t n = all < LOOP_KEEPS ? all : LOOP_KEEPS;
    qsort(kept, n, sizeof kept[0], by_value);
    return n ? kept[(n - 1) * 99 / 100] : 0;
}

static double highest_Hz(uint32_t cycles) { return cycles ? CORE_HZ / cycles : 0; }

static void row(int bad, uint32_t most, uint32_t least)
{
    const struct loop_result *r = &loop.r;
    const double n = r->ticks > 1 ? (double)(r->ticks - 1) : 1;
    printf(
        "%-9s %5.0f Hz at %4u MHz %6lu ticks %6lu pull %5lu packets | insns %6.0f %6u | cycles "
        "%6.0f %6u "
        "%6u, at least %6.0f %6u | accesses %4.0f %4u | highest Hz %6.0f .. %6.0f, dearest %6.0f "
        "| missed %lu | %s\n",
        loop.cfg.scene->name, (double)loop.T.den / (double)loop.T.num, 168 * machine.speed,
        (unsigned long)r->ticks, (unsigned long)r->pulling, (unsigned long)r->packets,
        (double)r->insns / n, r->most_insns, (double)r->cycles / n, most, r->most_cycles,
        (double)r->least / n, least, (double)r->accesses / n, r->most_accesses, highest_Hz(most),
        highest_Hz(least), highest_Hz(r->most_cycles), (unsigned long)r->missed,
        bad ? "NOT WELL" : "same bits");
}

static int verdict(int show)
{
    struct loop_result *r = &loop.r;
    const uint32_t most = most_of_99(r, r->kept);
    int bad = machine.end != M_DONE || r->differ || r->ticks < loop.ticks_wanted;
    bad |= machine.s.unclocked || machine.s.unknown || machine.s.flash.latency_Hz;
    if (show) {
        show_run(bad, most);
    } else {
        row(bad, most, most_of_99(r, r->fewest));
    }
    if (r->differ) {
        printf("  %lu ticks differ, the first is %lu: %s\n", (unsigned long)r->differ,
            (unsigned long)r->first, r->what);
    }
    if (r->missed) {
        printf("  %lu ticks missed, the first behind %lu; the dearest is %lu\n",
            (unsigned long)r->missed, (unsigned long)r->first_missed, (unsigned long)r->dearest);
    }
    if (machine.end != M_DONE) { printf("  it %s: %s\n", ends[machine.end], machine.why); }
    if (machine.s.unclocked) { printf("  0x%x has no clock\n", machine.s.unclocked_at); }
    if (machine.s.unknown) { printf("  0x%x is not modelled\n", machine.s.unknown_at); }
    if (machine.s.flash.latency_Hz) { printf("  too few wait states\n"); }
    return bad;
}

static const struct {
    const char *name;
    int takes; /* a number */
} option[] = {{"--rate", 1}, {"--ticks", 1}, {"--seed", 1}, {"--spoil", 1}, {"--faults", 1},
    {"--cuts", 1}, {"--speed", 1}, {"--say", 0}, {"--where", 0}, {"--jumps", 0}, {"--welded", 0},
    {"--show", 0}, {"--help", 0}, {"--set", 1}};
enum {
    RATE,
    TICKS,
    SEED,
    SPOIL,
    FAULTS,
    CUTS,
    SPEED,
    SAY,
    WHERE,
    JUMPS,
    WELDED,
    SHOW,
    HELP,
    SET,
    OPTIONS
};

static const char help[] =
    "usage: emulator [OPTION...] IMAGE\n"
    "\n"
    "Runs an image of ports/stm32f405 (ELF; scene drop, guarded or bilateral), unmodified, on an\n"
    "emulated chip in closed loop with a simulated hand, and prints a row of figures.\n"
    "  --rate HZ      rate of the loop (the scene's)\n"
    "  --ticks N      then the run ends (2000)\n"
    "  --seed N       of hand and device (1)\n"
    "  --show         for a person: what the image says, and how it did\n"
    "  --say          the newest that came over its text line, records of the log too\n"
    "  --where        cycles by block of code, of all ticks and of the dearest\n"
    "  --speed N      the processor is N times as fast, all else as it is (1)\n"
    "  --spoil TICK   a count more is read in that tick: it must be found\n"
    "Instead of a run:\n"
    "  --faults N     N faults, each from a random time; a table\n"
    "    --welded     and drive 0 stays enabled: it must be found\n"
    "    --set N      encoders alone: 1 in a contact, 2 before a box arms with arm_pull, 3 for\n"
    "                 4 s, 4 for 1 s with a low person_i\n"
    "  --cuts N       the supply fails in N operations of a save into flash\n"
    "  --jumps        a program leaves memory; no IMAGE\n"
    "Exit status: 0 all well, 1 not, 2 bad usage. Nothing here was ever run on hardware.\n";

/* The first argument that is no option; argc: there is a bad one. */
static int options(int argc, char **argv, long value[OPTIONS])
{
    int i = 1;
    for (; i < argc && argv[i][0] == '-'; i++) {
        unsigned k = 0;
        while (k < OPTIONS && strcmp(argv[i], option[k].name) != 0) { k++; }
        if (k == OPTIONS || i + option[k].takes >= argc) { return argc; }
        value[k] = option[k].takes ? atol(argv[++i]) : 1;
    }
    return i;
}

int main(int argc, char **argv)
{
    long value[OPTIONS] = {[TICKS] = 2000, [SEED] = 1, [SPOIL] = -1};
    const int i = options(argc, argv, value);
    int bad;
    if (value[JUMPS] && i == argc) { return stm_jumps(); }
    if (i + 1 != argc || value[HELP]) {
        fputs(help, value[HELP] ? stdout : stderr);
        return value[HELP] ? 0 : 2;
    }
    loop.rate_Hz = (uint32_t)value[RATE];
    loop.ticks_wanted = (uint32_t)value[TICKS];
    loop.spoil = value[SPOIL];
    machine.guarded = value[FAULTS] != 0;
    machine.speed = value[SPEED] > 0 ? (uint32_t)value[SPEED] : 1;
    if (loop_open(&machine, argv[i], (uint64_t)value[SEED]) < 0) { return 2; }
    loop.board.welded = value[WELDED] != 0;
    if (value[SET] < 0 || value[SET] >= SETS) { return 2; }
    kinds_set((enum kind_set)value[SET]);
    if (value[FAULTS] || value[CUTS]) {
        bad = value[CUTS] ? stm_cuts(&machine, argv[i], (unsigned)value[CUTS])
                          : stm_faults(&machine, (unsigned)value[FAULTS], (uint64_t)value[SEED],
                                (enum kind_set)value[SET]);
        machine_close(&machine);
        return bad;
    }
    loop.show_words = value[SHOW] ? show_words : NULL;
    loop_run();
    if (value[SAY]) { printf("%s", loop.text); }
    for (uint32_t at = 0; value[WHERE] && at < BLOCKS; at++) {
        const struct block *k = &machine.cost.block[at];
        if (k->spent) {
            printf("where 0x%x %lu %u\n", STM_FLASH + 2 * at, (unsigned long)k->spent, k->most);
        }
    }
    if (value[WHERE]) {
        const double n = loop.r.ticks ? (double)loop.r.ticks : 1;
        printf("cycles of waiting for the flash, by tick, with set-up: code %.0f, constants %.0f\n",
            (double)machine.cost.stalls / n, (double)machine.cost.data_stalls / n);
    }
    bad = verdict(value[SHOW] != 0);
    machine_close(&machine);
    return bad;
}
