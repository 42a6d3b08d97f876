/* SPDX-License-Identifier: MIT */
/* One run of an image: --rate HZ, --ticks N, --seed N, --spoil TICK, --say (what it prints),
 * --where (cycles by block), --faults N (instead: that many, a table). Prints a row of figures. */
#include "faults.h"

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
static uint32_t most_of_99(struct loop_result *r)
{
    const uint64_t all = r->ticks > 1 ? r->ticks - 1 : 0;
    const size_t n = all < LOOP_KEEPS ? all : LOOP_KEEPS;
    qsort(r->kept, n, sizeof r->kept[0], by_value);
    return n ? r->kept[(n - 1) * 99 / 100] : 0;
}

static double highest_Hz(uint32_t cycles) { return cycles ? CORE_HZ / cycles : 0; }

static int verdict(void)
{
    struct loop_result *r = &loop.r;
    const double n = r->ticks > 1 ? (double)(r->ticks - 1) : 1;
    const uint32_t most = most_of_99(r);
    int bad = machine.end != M_DONE || r->differ || r->ticks < loop.ticks_wanted;
    bad |= machine.s.unclocked || machine.s.unknown || machine.s.flash.latency_Hz;
    printf("%-9s %5.0f Hz %6lu ticks %6lu pull %5lu packets | insns %6.0f %6u | cycles %6.0f %6u "
           "%6u | accesses %4.0f %4u | highest Hz %6.0f %6.0f | missed %lu | %s\n",
        loop.cfg.scene->name, (double)loop.T.den / (double)loop.T.num, (unsigned long)r->ticks,
        (unsigned long)r->pulling, (unsigned long)r->packets, (double)r->insns / n, r->most_insns,
        (double)r->cycles / n, most, r->most_cycles, (double)r->accesses / n, r->most_accesses,
        highest_Hz(most), highest_Hz(r->most_cycles), (unsigned long)r->missed,
        bad ? "NOT WELL" : "same bits");
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

int main(int argc, char **argv)
{
    uint64_t seed = 1;
    unsigned faults = 0;
    int bad;
    int say = 0, where = 0, i = 1;
    loop.spoil = -1;
    loop.ticks_wanted = 2000;
    for (; i + 1 < argc && argv[i][0] == '-'; i++) {
        const char *value = argv[i + 1];
        if (!strcmp(argv[i], "--say")) {
            say = 1;
            continue;
        }
        if (!strcmp(argv[i], "--where")) {
            where = 1;
            continue;
        }
        if (!strcmp(argv[i], "--rate")) { loop.rate_Hz = (uint32_t)atol(value); }
        if (!strcmp(argv[i], "--ticks")) { loop.ticks_wanted = (uint32_t)atol(value); }
        if (!strcmp(argv[i], "--seed")) { seed = (uint64_t)atol(value); }
        if (!strcmp(argv[i], "--faults")) { faults = (unsigned)atol(value); }
        if (!strcmp(argv[i], "--spoil")) { loop.spoil = atol(value); }
        i++;
    }
    if (i + 1 != argc) {
        fprintf(stderr, "usage: stm32f405 [--rate HZ] [--ticks N] [--seed N] [--spoil TICK] "
                        "[--faults N] [--say] [--where] "
                        "IMAGE\n");
        return 2;
    }
    machine.guarded = faults != 0;
    if (loop_open(&machine, argv[i], seed) < 0) { return 2; }
    if (faults) {
        bad = stm_faults(&machine, faults, seed);
        machine_close(&machine);
        return bad;
    }
    loop_run();
    if (say) { printf("%s", loop.text); }
    for (uint32_t at = 0; where && at < BLOCKS; at++) {
        const struct block *k = &machine.cost.block[at];
        if (k->spent) { printf("where 0x%x %lu\n", STM_FLASH + 2 * at, (unsigned long)k->spent); }
    }
    bad = verdict();
    machine_close(&machine);
    return bad;
}
