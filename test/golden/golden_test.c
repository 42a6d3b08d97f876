/* SPDX-License-Identifier: MIT */
/* Every module at every rate against the digests of the independent generator, and
 * tick by tick at the paper's six rates. Where a digest differs, the generator is
 * called for that module and rate, and the first tick that differs is told.
 *
 * Environment on hosts: EXH_TEST=name takes one module, EXH_RATES=lo..hi:step every
 * step-th of these rates alone (beyond 2000 hundreds of rates, up to 20000), EXH_EXPLAIN=0 counts
 * without telling, EXH_CELLS=1 says what ran. */
#include "explain.h"
#include "modules.h"

static const uint32_t traced[] = {90, 100, 200, 500, 1000, 2000};

static uint32_t digest_of(golden_run *run, uint32_t rate_Hz)
{
    static struct golden g;
    g = (struct golden){.see = NULL};
    run(&g, rate_Hz);
    return g.crc;
}

/* Every step-th hundred of rates beyond those that have a digest each; whole hundreds alone. */
static void beyond(const char *name, golden_run *run, struct golden_rates of)
{
    static uint32_t want[GOLDEN_HUNDREDS];
    const int there = golden_hundreds(name, want);
    uint32_t all = 0;
    uint32_t ran = 0;
    for (uint32_t i = 0; i < GOLDEN_HUNDREDS; i += of.step) {
        const uint32_t lo = GOLDEN_RATES + 100u * i + 1u;
        uint32_t crc = 0;
        if (lo < of.lo || lo + 99u > of.hi) { continue; }
        CHECK(there, "%s: no digests beyond %u Hz", name, GOLDEN_RATES);
        if (!there) { return; }
        for (uint32_t k = 0; k < 100; k++) {
            crc = golden_crc_u32(crc, digest_of(run, lo + k));
            ran++;
        }
        CHECK(crc == want[i], "%s: differs from %" PRIu32 " to %" PRIu32 " Hz", name, lo, lo + 99u);
        all = golden_crc_u32(all, crc);
    }
    if (ran > 0) { check_note("beyond: %s %" PRIu32 " %08" PRIx32, name, ran, all); }
}

/* digest[i] is that of i + 1 Hz. */
static void all_rates(const char *name, golden_run *run, const uint32_t *digest)
{
    const struct golden_rates of = golden_rates();
    uint32_t differ = 0;
    uint32_t first = 0;
    uint32_t ran = 0;
    uint32_t crc = 0;
    const uint32_t hi = of.hi < GOLDEN_RATES ? of.hi : GOLDEN_RATES;
    for (uint32_t rate = of.lo; rate <= hi; rate += of.step) {
        const uint32_t got = digest_of(run, rate);
        crc = golden_crc_u32(crc, got);
        ran++;
        if (got == digest[rate - 1]) { continue; }
        if (differ++ == 0) { first = rate; }
    }
    if (golden_cells() && ran > 0) {
        check_note("cells: %s %" PRIu32 "..%" PRIu32 ":%" PRIu32 " %" PRIu32 " %08" PRIx32, name,
                   of.lo, hi, of.step, ran, crc);
    }
    if (differ > 0 && !golden_quiet()) { check_note("%s", golden_explain(name, run, first)); }
    CHECK(differ == 0, "%s: %" PRIu32 " of %" PRIu32 " rates differ, the first is %" PRIu32 " Hz",
          name, differ, ran, first);
    for (size_t i = 0; i < sizeof traced / sizeof traced[0]; i++) {
        const int in = traced[i] >= of.lo && traced[i] <= of.hi;
        const char *said = in ? golden_trace(name, run, traced[i]) : "";
        CHECK(said[0] == '\0', "%s", said);
    }
    if (of.hi > GOLDEN_RATES) { beyond(name, run, of); }
}

/* --- the tale of a run that is wrong in one place --- */

static void (*honest)(struct golden *g);

static void one_more(struct golden *g)
{
    if (g->tick == 130) { g->v[1]++; }
    honest(g);
}

static void wrong_run(struct golden *g, uint32_t rate_Hz)
{
    honest = g->see;
    g->see = one_more;
    golden_velocity_window(g, rate_Hz);
}

static int begins(const char *text, const char *with)
{
    while (*with != '\0' && *text == *with) {
        text++;
        with++;
    }
    return *with == '\0';
}

TEST(first_tick_that_differs_is_told)
{
    const char *want = "velocity_window at 90 Hz, tick 130: vel_mps_q27: expected ";
    const char *said = golden_trace("velocity_window", wrong_run, 90);
    CHECK(said[0] == '\0' || begins(said, want), "from the trace: %s", said);
    said = golden_explain("velocity_window", wrong_run, 91);
    if (begins(said, "no trace from: ")) {
        check_note("the generator cannot be asked here");
        return;
    }
    CHECK(begins(said, "velocity_window at 91 Hz, tick 130: vel_mps_q27: expected "),
          "from the generator: %s", said);
    said = golden_explain("velocity_window", golden_velocity_window, 90);
    CHECK(begins(said, "velocity_window at 90 Hz is as"), "of a run that is right: %s", said);
}

#define MODULE(name) \
    TEST(name) \
    { \
        all_rates(#name, golden_##name, digest_##name); \
    } \
    typedef int module_##name

MODULE(fix);
MODULE(bytes);
MODULE(record);
MODULE(ring);
MODULE(signal);
MODULE(slots);
MODULE(quad);
MODULE(quad_ab);
MODULE(velocity_window);
MODULE(velocity_pole);
MODULE(velocity_foaw);
MODULE(velocity_track);
MODULE(contact);
MODULE(table);
MODULE(drive);
MODULE(track);
MODULE(passivity);
MODULE(watch);
MODULE(guard);
MODULE(supply);
MODULE(safety);
MODULE(calibrate);
MODULE(probe);
MODULE(home);
MODULE(weigh);
MODULE(filter);
MODULE(quantizer);
MODULE(gains);
MODULE(glove);
MODULE(glove_every);
MODULE(glove_cal);
MODULE(angle);
MODULE(hand);
MODULE(precontact);
MODULE(wire);
MODULE(mirror);
MODULE(modbus);
MODULE(modbus_rtu);
MODULE(drop);
MODULE(guarded);
MODULE(bilateral);

TEST_MAIN("golden", first_tick_that_differs_is_told, fix, bytes, record, ring, signal, slots, quad,
          quad_ab, velocity_window, velocity_pole, velocity_foaw, velocity_track, contact, table,
          drive, track, watch, guard, supply, passivity, safety, calibrate, probe, home, weigh,
          filter, quantizer, gains, glove, glove_every, glove_cal, angle, hand, precontact, wire,
          mirror, modbus, modbus_rtu, drop, guarded, bilateral);
