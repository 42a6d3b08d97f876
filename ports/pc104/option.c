/* SPDX-License-Identifier: MIT */
/* Options of every image: their rows, and the value that a text is of any row. A value outside its
 * range stops the image before anything moves. */
#include "pc104.h"

#include "exhand/error.h"
#include "exhand/exhand.h"

#define TICKS_MAX 2000000000
#define WORDS_MAX 17

static const struct exh_signal rows[] = {
    {0xA001, 0, EXH_WHEN_SETUP, 0, 20000, 0, "rate", "hz", "ticks a second; 0: the scene's"},
    {0xA002, 0, EXH_WHEN_SETUP, 0, TICKS_MAX, 0, "ticks", "", "then stop; 0: never"},
    {0xA003, 0, EXH_WHEN_SETUP, 0, 2, 0, "timer", "", "which makes the ticks"},
    {0xA004, 0, EXH_WHEN_SETUP, 0, 3, 0, "log", "", "where records go"},
    {0xA005, 0, EXH_WHEN_SETUP, 0, TICKS_MAX, 100, "overload_max", "",
        "late ticks tolerated; one is forgotten in 10 s"},
    {0xA006, 0, EXH_WHEN_SETUP, 0, TICKS_MAX, 64, "grace", "",
        "first ticks, in which they do not count"},
    {0xA007, 0, EXH_WHEN_SETUP, 2, 10000, 20, "hang", "", "periods after which a tick is hung"},
    {0xA008, 0, EXH_WHEN_SETUP, 0, 1000000, 0, "budget", "us",
        "stated cost of a tick; 0: measured"},
    {0xA009, 0, EXH_WHEN_SETUP, 0, 1000, 25, "headroom", "percent", "left free above that cost"},
    {0xA00A, 0, EXH_WHEN_SETUP, 0, 16, 0, "provoke", "", "a failure to be seen ending safe"},
    {0xA00B, 0, EXH_WHEN_SETUP, 0, TICKS_MAX, 100, "provoke_at", "", "in this tick"},
    {0xA00C, 0, EXH_WHEN_SETUP, 0, 1, 0, "idle", "", "what the processor does between ticks"},
    {0xA00D, 0, EXH_WHEN_SETUP, 0, 3, 0, "dump", "", "where the black box goes after a fault"},
    {0xA00E, 0, EXH_WHEN_SETUP, 0, 1 << 20, 0, "dump_kib", "", "of its memory in use; 0: all"},
    {0xA00F, 10, EXH_WHEN_SETUP, 0, 86400 << 10, 0, "gap", "s",
        "so long the longest gap is looked for; 0: not"},
};
static const struct exh_signal_group groups[] = {{rows, sizeof rows / sizeof rows[0], 1}};
const struct exh_signal_table pc104_option_table = {groups, 1};
EXH_STATIC_ASSERT(pc104_par_matches_rows,
    sizeof(struct pc104_par) == sizeof(int32_t) * (sizeof rows / sizeof rows[0]));

/* Values that are words, in the order of their enums. */
static const struct {
    const char *name, *const word[WORDS_MAX];
} words[] = {
    {"timer", {"auto", "hpet", "pit"}},
    {"log", {"off", "serial", "debug", "udp"}},
    {"dump", {"off", "serial", "debug", "udp"}},
    {"idle", {"halt", "spin"}},
    {"provoke", {"none", "divide", "opcode", "null", "write", "stack", "nmi", "spurious", "hang",
                    "slow", "timer", "assert", "mask", "idle", "twice", "reset", "mce"}},
};

/* Of a program that takes no options: nothing is too much. */
struct pc104_par pc104_par = {.overload_max = INT32_MAX};

void pc104_refuse(const char *name, const char *value)
{
    pc104_say("option ");
    pc104_say(name);
    if (value) {
        pc104_say("=");
        pc104_say(value);
    }
    pc104_say(": ");
}

void pc104_refuse_range(const struct exh_signal *row, const char *value)
{
    pc104_refuse(row->name, value);
    pc104_say("allowed ");
    pc104_say_fixed(row->min, row->frac);
    pc104_say("..");
    pc104_say_fixed(row->max, row->frac);
    pc104_say(row->unit[0] ? " " : "");
    pc104_say(row->unit);
    pc104_say("\n");
    pc104_halt(PC104_EXIT_OPTION, "option refused: nothing was started");
}

/* One of its words, or -1 if it takes none: then -2 where it takes others. */
static int32_t word_of(const char *name, const char *value)
{
    for (unsigned i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (!pc104_same_text(words[i].name, name)) { continue; }
        for (int32_t k = 0; k < WORDS_MAX && words[i].word[k]; k++) {
            if (pc104_same_text(words[i].word[k], value)) { return k; }
        }
        pc104_refuse(name, value);
        pc104_say("one of");
        for (unsigned k = 0; k < WORDS_MAX && words[i].word[k]; k++) {
            pc104_say(" ");
            pc104_say(words[i].word[k]);
        }
        pc104_say("\n");
        pc104_halt(PC104_EXIT_OPTION, "option refused: nothing was started");
    }
    return -1;
}

int32_t pc104_value_of(const struct exh_signal *row, const char *value)
{
    int32_t raw = word_of(row->name, value);
    if (raw < 0 && (pc104_number(value, row->frac, &raw) < 0 || raw < row->min || raw > row->max)) {
        pc104_refuse_range(row, value);
    }
    return raw;
}
