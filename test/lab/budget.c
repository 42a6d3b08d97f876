/* SPDX-License-Identifier: MIT */
/* exhand-lab budget: the highest rate of the loop that the box can hold, bound by bound. */
#include "lab/lab.h"

#include "base/option.h"

#include <stdio.h>

struct times {
    double access_us, fast_us, byte_us, timer_us, cpi, settle_us, convert_us, update_us, sample_us,
        every;
};

/* Dearest ticks, as `make hil` counts them; accesses to cards as test/device/cards demands them
 * too. */
static const struct load {
    const char *name;
    double goal_Hz;
    int words, bytes;    /* accesses to motor cards, 16 bits; to the glove's card, 8 bits */
    int insns, channels; /* channels: converted by one board and tick */
    int parts;           /* ticks in which a glove scan is taken; 0: no glove */
    const char *counted;
} load[] = {
    {"drop", 20000, 14, 0, 3968, 2, 0, "make hil ARGS=rates, all in every tick"},
    {"drop, in turn", 20000, 11, 0, 3911, 1, 0, "make hil ARGS=rates, turns=1"},
    {"bilateral, frame in a tick", 10000, 44, 49, 18891, 4, 1,
        "accesses: test/device/cards; make hil ARGS=box, 2 kHz: a frame in every tick"},
    {"bilateral, in turn, frame", 10000, 30, 1, 13448, 1, 11,
        "make hil ARGS=box, 10 kHz, turns=1 scan_slice=2: packets and a part"},
    {"bilateral, in turn, part", 10000, 30, 6, 13448, 1, 11, "the same, and 2 samples"},
};
#define LOADS       ((int)(sizeof load / sizeof load[0]))
#define TIMER_READS 5 /* and one access to the interrupt controller, in every tick */

/* Time that does not depend on access times. */
static double insns_us(const struct load *l, const struct times *t)
{
    return l->insns * t->cpi / 1600.0 + TIMER_READS * t->timer_us;
}

static double bus_us(const struct load *l, const struct times *t)
{
    return (l->words + 1) * t->access_us + l->bytes * t->byte_us;
}

/* The longest that a tick is bound by, and what that is. */
struct bound {
    double us;
    const char *by;
};

static double glove_us(const struct load *l, const struct times *t)
{
    const double scan_us = l->parts ? 22 * t->sample_us : 0;
    return l->parts && t->every > l->parts + 1 ? scan_us / (t->every - l->parts - 1) : scan_us;
}

static struct bound bound_of(const struct load *l, const struct times *t)
{
    const double insns = insns_us(l, t), bus = bus_us(l, t);
    const struct bound all[] = {{insns + bus, bus > insns ? "bus" : "instructions"},
        {t->settle_us + l->channels * t->convert_us, "A/D"}, {t->update_us, "D/A"},
        {glove_us(l, t), "glove"}};
    struct bound longest = all[0];
    for (size_t i = 1; i < sizeof all / sizeof all[0]; i++) {
        if (all[i].us > longest.us) { longest = all[i]; }
    }
    return longest;
}

/* Where all accesses are fast ones. */
static double fast_Hz(const struct load *l, const struct times *t)
{
    struct times fast = *t;
    fast.access_us = fast.byte_us = t->fast_us;
    return 1e6 / bound_of(l, &fast).us;
}

static void print(const struct load *l, const struct times *t, int csv)
{
    const double insns = insns_us(l, t), bus = bus_us(l, t), glove = glove_us(l, t);
    const double ad = t->settle_us + l->channels * t->convert_us;
    const struct bound longest = bound_of(l, t);
    const double Hz = 1e6 / longest.us, fast = fast_Hz(l, t);
    const double holds_us = (1e6 / l->goal_Hz - insns) / (l->words + 1 + l->bytes);
    if (csv) {
        printf("\"%s\",%.0f,%d,%d,%d,%.3f,%.3f,%.3f,%.3f,%.3f,%.0f,%s,%.0f,%.3f\n", l->name,
            l->goal_Hz, l->words, l->bytes, l->insns, insns, bus, ad, t->update_us, glove, Hz,
            longest.by, fast, holds_us);
        return;
    }
    printf("%-27s %3d + %2d %6d | %6.1f %6.1f %6.1f %6.1f %6.1f | %6.0f %-12s %6.0f | %5.0f %-4s "
           "%6.2f\n",
        l->name, l->words, l->bytes, l->insns, insns, bus, ad, t->update_us, glove, Hz, longest.by,
        fast, l->goal_Hz, Hz >= l->goal_Hz ? "ok" : "no", holds_us);
}

static void head(const struct times *t)
{
    printf("The dearest tick of a scene, and the highest rate at which all ticks may be such\n\n"
           "%-27s accesses  instr. |  each alone, us a tick               |  rate bound by     at "
           "%4.2f |  goal      holds to\n"
           "%-27s 16 +  8          | instr.    bus    A/D    D/A  glove |    Hz            us: Hz |"
           "    Hz       us access\n",
        "scene", t->fast_us, "");
}

static void foot(const struct times *t)
{
    printf("\nInstructions and bus come one after the other, converters run beside them. Stated: "
           "access %.2f us, of "
           "8 bits %.2f,\ntimer %.2f (uncertain: ISA 0.4..2 us); CPI %.2f at 1.6 GHz (assumed); "
           "A/D settles %.0f us "
           "and takes %.0f a channel, D/A %.0f\n(uncertain); glove %.0f us a sample (4..20, "
           "known), a frame every %.0f "
           "ticks. Instructions and accesses are counted:\n",
        t->access_us, t->byte_us, t->timer_us, t->cpi, t->settle_us, t->convert_us, t->update_us,
        t->sample_us, t->every);
    for (int i = 0; i < LOADS; i++) { printf("  %-27s %s\n", load[i].name, load[i].counted); }
}

int cli_budget(int argc, char **argv)
{
    struct times t = {1, 0.7, -1, 0.25, 2, 15, 10, 10, 10, 20};
    int csv = 0, err;
    const struct cli_option option[] = {
        {"access-us", CLI_REAL, &t.access_us, 0.01, 100, "US",
            "an access of 16 bits to a port (1)"},
        {"fast-us", CLI_REAL, &t.fast_us, 0.01, 100, "US",
            "an access of any width, for the rate beside (0.7)"},
        {"byte-us", CLI_REAL, &t.byte_us, 0.01, 100, "US", "one of 8 bits (as 16 bits)"},
        {"timer-us", CLI_REAL, &t.timer_us, 0, 100, "US", "a read of the timer (0.25)"},
        {"cpi", CLI_REAL, &t.cpi, 0.1, 100, "N", "cycles an instruction, of 1.6 GHz (2)"},
        {"settle-us", CLI_REAL, &t.settle_us, 0, 1000, "US", "A/D settling, once a scan (15)"},
        {"convert-us", CLI_REAL, &t.convert_us, 0, 1000, "US", "A/D conversion of a channel (10)"},
        {"update-us", CLI_REAL, &t.update_us, 0, 1000, "US", "D/A update (10)"},
        {"sample-us", CLI_REAL, &t.sample_us, 1, 100, "US", "glove, from sample to sample (10)"},
        {"every", CLI_REAL, &t.every, 1, 1000, "TICKS", "from one glove frame to the next (20)"},
        {"csv", CLI_FLAG, &csv, 0, 0, NULL, "comma-separated values instead of the table"},
    };
    const struct cli_command c = {"budget", "[options]",
        "The highest rate of the loop that the box can hold, bound by bound, from accesses and "
        "instructions\n"
        "as the tests count them and from times as they are stated here.\n"
        "holds to: the longest access at which the goal holds, all accesses alike.",
        option, (int)(sizeof option / sizeof option[0]), 0};
    err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (t.byte_us < 0) { t.byte_us = t.access_us; }
    if (csv) {
        printf("scene,goal_hz,accesses_16,accesses_8,instructions,instructions_us,bus_us,ad_us,da_"
               "us,glove_us,"
               "rate_hz,bound,fast_rate_hz,access_holds_us\n");
    } else {
        head(&t);
    }
    for (int i = 0; i < LOADS; i++) { print(&load[i], &t, csv); }
    if (!csv) { foot(&t); }
    return 0;
}
