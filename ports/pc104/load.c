/* SPDX-License-Identifier: MIT */
/* What a tick costs, by the timer that makes the ticks: nothing that a law or a digest sees. And
 * the policy of the paper's xPC Target for ticks that come too early: so many, not counting the
 * first ones, then safe. Of these one is forgotten in LEAK_S. (The scene's own safety is stricter:
 * one in 64, EXH_FAULT_OVERRUN.) */
#include "pc104.h"

#include "exhand/error.h"
#include "exhand/exhand.h"
#include "exhand/fix.h"

#include <string.h>

#define BINS         16u /* sixteenths of the period, then what took longer */
#define DRY_TICKS    64u
#define DRY_ROUNDS   8u
#define DRY_IO_TICKS 16u
#define LEAK_S       10u
#define NS_PER_S     UINT64_C(1000000000)

/* All values are counts of the timer until they are printed. */
static struct {
    uint32_t began, last, least, most, ticks, wake;
    uint32_t skipped; /* ticks, between the one that it slept for and this one */
    uint8_t slept;    /* that one did not become due while the one before ran */
    uint64_t sum;
    uint32_t bin_per_count_q32;
    uint32_t bin[BINS + 1];
} spent = {.least = UINT32_MAX};

static uint32_t missed_in_all, late_in_all;
static uint32_t second_ticks;            /* periods in a second, 2 at least */
static uint32_t scene_counts, io_counts; /* of dry ticks */

/* The signals of this table are shown to people; no record holds them. */
static int32_t signal[4 + BINS + 1 + 3 + 1];
static const struct exh_signal rows[] = {
    {0xA101, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "tick_last", "ns", "time the last tick took"},
    {0xA102, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "tick_min", "ns", "shortest"},
    {0xA103, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "tick_mean", "ns", "mean"},
    {0xA104, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "tick_max", "ns", "longest"},
};
static const struct exh_signal bin_rows[] = {
    {0xA105, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "tick_bin", "",
        "ticks of each sixteenth of a period, then longer"},
};
static const struct exh_signal count_rows[] = {
    {0xA106, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "tick_missed", "", "ticks skipped"},
    {0xA107, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "irq_spurious", "",
        "interrupts nobody asked for"},
    {0xA108, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "tick_late", "",
        "ticks due while the one before still ran"},
};
static const struct exh_signal wake_rows[] = {
    {0xA109, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "tick_wake", "ns",
        "longest from a tick's instant to its waking"},
};
static const struct exh_signal_group groups[] = {
    {rows, 4, 1}, {bin_rows, 1, BINS + 1}, {count_rows, 3, 1}, {wake_rows, 1, 1}};
const struct exh_signal_table pc104_load_table = {groups, 4};

/* By the instruction: reports are also made when an assertion of the library has failed. */
static uint64_t divided(uint64_t num, uint32_t den)
{
    uint32_t high = (uint32_t)(num >> 32), low = (uint32_t)num, rest = 0;
    __asm__("divl %2" : "+a"(high), "+d"(rest) : "r"(den) : "cc");
    __asm__("divl %2" : "+a"(low), "+d"(rest) : "r"(den) : "cc");
    return (uint64_t)high << 32 | low;
}

static int32_t ns(uint64_t counts)
{
    const uint64_t n = divided(counts * NS_PER_S, pc104_timer_Hz());
    return n > INT32_MAX ? INT32_MAX : (int32_t)n;
}

static int32_t capped(uint32_t n) { return n > INT32_MAX ? INT32_MAX : (int32_t)n; }

const int32_t *pc104_load_signals(void)
{
    signal[0] = ns(spent.last);
    signal[1] = ns(spent.least);
    signal[2] = spent.ticks ? ns(divided(spent.sum, spent.ticks)) : 0;
    signal[3] = ns(spent.most);
    for (unsigned i = 0; i <= BINS; i++) { signal[4 + i] = capped(spent.bin[i]); }
    signal[5 + BINS] = capped(missed_in_all);
    signal[6 + BINS] = capped(pc104_spurious);
    signal[7 + BINS] = capped(late_in_all);
    signal[8 + BINS] = ns(spent.wake);
    return signal;
}

/* --- during the run --- */

/* At a low rate this many periods would leave a current without supervision for long. */
static uint32_t hang_ticks(void)
{
    const uint32_t asked = (uint32_t)pc104_par.hang_ticks;
    if ((uint64_t)asked * pc104_timer_counts() <= pc104_timer_Hz()) { return asked; }
    return second_ticks;
}

/* Outputs are safe: what is said and handed over now may take as long as it wants. */
void pc104_load_stop(void) { pc104_hang_ticks = 0; }

void pc104_load_begin(void)
{
    pc104_tick_began = pc104_ticks;
    pc104_hang_ticks = hang_ticks(); /* no grace: currents flow in the first, too */
    spent.began = pc104_timer_now();
    if (spent.slept) {
        const uint64_t n =
            (uint64_t)spent.skipped * pc104_timer_counts() + (spent.began - pc104_timer_due());
        if (n > spent.wake) { spent.wake = n < UINT32_MAX ? (uint32_t)n : UINT32_MAX; }
    }
}

void pc104_load_end(void)
{
    const uint32_t n = pc104_timer_now() - spent.began;
    const uint64_t bin = (uint64_t)n * spent.bin_per_count_q32 >> 32;
    spent.last = n;
    spent.least = n < spent.least ? n : spent.least;
    spent.most = n > spent.most ? n : spent.most;
    spent.sum += n;
    spent.ticks++;
    spent.bin[bin < BINS ? bin : BINS]++;
}

static uint32_t add_sat(uint32_t a, uint32_t b) { return b > UINT32_MAX - a ? UINT32_MAX : a + b; }

void pc104_load_missed(uint32_t tick, uint32_t missed, uint32_t late)
{
    static struct pc104_overload overload; /* after the grace */
    missed_in_all = add_sat(missed_in_all, missed);
    late_in_all = add_sat(late_in_all, late);
    spent.skipped = missed;
    spent.slept = late == 0;
    if (tick < (uint32_t)pc104_par.grace_ticks) { return; }
    overload.most = (uint32_t)pc104_par.overload_max;
    overload.leak_ticks = LEAK_S * second_ticks;
    if (pc104_overload_step(&overload, add_sat(missed, 1), late)) {
        pc104_halt(PC104_EXIT_OVERLOAD, "overload: more ticks late than overload_max allows");
    }
}

void pc104_load_report(void)
{
    const int32_t *s = pc104_load_signals();
    uint16_t k;
    if (spent.ticks == 0) { return; }
    for (uint32_t i = 0; i < exh_signal_count(&pc104_load_table); i++) {
        const struct exh_signal *row = exh_signal_at(&pc104_load_table, i, &k);
        if (k == 0) {
            pc104_say(i ? "\n" : "");
            pc104_say(row->name);
        }
        pc104_say(" ");
        pc104_say_u32((uint32_t)s[i]);
        if (row->unit[0]) {
            pc104_say(" ");
            pc104_say(row->unit);
        }
    }
    pc104_say("\n");
}

/* --- before it --- */

/* The minimum over rounds of the longest tick. A disturbance of one round (an emulator's host,
 * firmware) is left to the overload policy; a cost of every round is included. */
static uint32_t least_of_rounds(void (*once)(uint32_t tick), uint32_t ticks, uint32_t apart)
{
    uint32_t least = UINT32_MAX, last = pc104_timer_now();
    for (uint32_t round = 0; round < DRY_ROUNDS; round++) {
        uint32_t most = 0;
        for (uint32_t i = 0; i < ticks; i++) {
            uint32_t began, n;
            do {
                began = pc104_timer_now();
            } while (began - last < apart);
            last = began;
            once(round * ticks + i);
            n = pc104_timer_now() - began;
            most = n > most ? n : most;
        }
        least = most < least ? most : least;
    }
    return least;
}

static const struct exh_scene *scene;

/* As many packets as a tick may bring, as long as its own are: what the scene last sent. Where it
 * has a peer to get them from. */
static void dry_mail(const struct exh_scene_link *l)
{
    const struct exh_scene_mail *out = l->out;
    unsigned longest = 0;
    for (unsigned i = 1; i < out->packets; i++) {
        if (out->len_B[i] > out->len_B[longest]) { longest = i; }
    }
    if (out->packets == 0 || !pc104_link_up()) { return; }
    for (unsigned i = 0; i < EXH_SCENE_PACKETS; i++) {
        l->in->len_B[i] = out->len_B[longest];
        memcpy(l->in->byte[i], out->byte[longest], out->len_B[longest]);
    }
    l->in->packets = EXH_SCENE_PACKETS;
}

/* Into a wall and out again, with a new glove frame in every tick; no card sees the outputs. What
 * a tick costs depends on the scene's configuration and not on values (docs/DESIGN.md 5). */
static void dry_tick(uint32_t tick)
{
    static struct exh_scene_in in;
    struct exh_drive_out out;
    in.command = tick < 2 ? EXH_CMD_RUN : EXH_CMD_NONE;
    in.drive.din = UINT32_MAX;
    in.glove_new = 1;
    in.glove.age_ticks = 0;
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        in.drive.enc_raw[i] = (tick & 256u ? 512u - (tick & 511u) : tick & 511u) * 8u;
    }
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { in.glove.raw[i] = (int16_t)(tick * 16u); }
    scene->tick(&in, &out);
    if (scene->link) {
        scene->link->write();
        dry_mail(scene->link);
    }
    pc104_scene_dry(scene, tick, &in, &out);
}

void pc104_load_scene(const struct exh_scene *sc)
{
    const uint32_t rate_Hz = pc104_par.rate_Hz ? (uint32_t)pc104_par.rate_Hz : sc->rate_Hz;
    const struct exh_scene_board board = {{1, rate_Hz}, exh_board_info.enc_bits};
    scene = sc;
    if (pc104_par.budget_us || rate_Hz < 1 || rate_Hz > 20000 || sc->setup(board) < 0) { return; }
    scene_counts = least_of_rounds(dry_tick, DRY_TICKS, 0); /* exh_loop() sets it up again */
    if (scene->link) { scene->link->in->packets = scene->link->out->packets = 0; }
}

/* What an idle tick asks of the cards: outputs stay zero, drives disabled. */
static void dry_io(uint32_t tick)
{
    static const struct exh_drive_out idle = {.dac_raw = {32768, 32768, 32768, 32768, 32768}};
    struct exh_drive_in in;
    struct exh_glove_in glove;
    (void)tick;
    (void)exh_board_read_drive(&in);
    if (scene && scene->read_glove) { (void)scene->read_glove(&glove); }
    (void)exh_board_write_drive(&idle);
    pc104_link_dry();
}

static void say_us(uint32_t counts)
{
    pc104_say_fixed((int64_t)exh_udiv64((uint64_t)ns(counts) << 10, 1000, NULL), 10);
    pc104_say(" us");
}

/* Ticks of the cards are one period apart, as in the loop, at most 0.5 ms. So conversions have
 * progressed as far. */
static uint32_t apart(void)
{
    const uint32_t period = pc104_timer_counts(), most = pc104_timer_Hz() / 2000;
    return period < most ? period : most;
}

/* Long divisions, which no tick makes, not even the first. */
static void divide(void)
{
    second_ticks = (uint32_t)exh_udiv64(pc104_timer_Hz(), pc104_timer_counts(), NULL);
    second_ticks = second_ticks < 2 ? 2 : second_ticks;
    spent.bin_per_count_q32 =
        (uint32_t)exh_udiv64((uint64_t)BINS << 32, pc104_timer_counts(), NULL);
}

/* Before anything moves, for a person who looks at this machine. */
static void say_gap(uint32_t left)
{
    const uint32_t asked_s_q10 = (uint32_t)pc104_par.gap_s_q10;
    struct pc104_gap g;
    if (asked_s_q10 == 0) { return; }
    g = pc104_gap_look(pc104_timer_now, (uint64_t)asked_s_q10 * pc104_timer_Hz() >> 10, left);
    pc104_say("gap longest ");
    say_us(g.longest);
    pc104_say(" in ");
    pc104_say_fixed(asked_s_q10, 10);
    pc104_say(" s, a tick of this rate leaves ");
    say_us(left);
    pc104_say(", longer ");
    pc104_say_u32(g.beyond);
    pc104_say("\n");
}

int pc104_load_fits(uint32_t rate_Hz)
{
    uint64_t cost;
    uint32_t need;
    divide();
    if (pc104_par.budget_us) {
        cost = exh_udiv64((uint64_t)pc104_par.budget_us * pc104_timer_Hz(), 1000000, NULL);
    } else {
        io_counts = least_of_rounds(dry_io, DRY_IO_TICKS, apart());
        cost = (uint64_t)scene_counts + io_counts;
    }
    cost = exh_udiv64(cost * (100u + (uint32_t)pc104_par.headroom_pct), 100, NULL);
    need = cost < INT32_MAX ? (uint32_t)cost : INT32_MAX;
    pc104_say(pc104_par.budget_us ? "budget stated" : "budget measured: scene ");
    if (!pc104_par.budget_us) {
        say_us(scene_counts);
        pc104_say(", cards and link ");
        say_us(io_counts);
    }
    pc104_say(", with headroom ");
    say_us(need);
    pc104_say("\n");
    if (need <= pc104_timer_counts()) {
        say_gap(pc104_timer_counts() - need);
        return 0;
    }
    pc104_say("rate ");
    pc104_say_u32(rate_Hz);
    pc104_say(" Hz: a tick costs more than its period: take at most ");
    pc104_say_u32(pc104_timer_highest_Hz(need));
    pc104_say(" Hz\n");
    return -EXH_E_RATE;
}
