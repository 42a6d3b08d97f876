/* Every module at every rate against the digests of the independent generator, and
 * tick by tick at the paper's six rates. Where a digest differs, the generator is
 * called for that module and rate, and the first tick that differs is told.
 *
 * Environment on hosts: EXH_TEST=name takes one module, EXH_RATES=lo..hi these rates
 * alone, EXH_EXPLAIN=0 counts without telling. */
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

/* digest[i] is that of i + 1 Hz. */
static void all_rates(const char *name, golden_run *run, const uint32_t *digest)
{
    uint32_t lo = 1;
    uint32_t hi = GOLDEN_RATES;
    uint32_t differ = 0;
    uint32_t first = 0;
    golden_rates(&lo, &hi);
    for (uint32_t rate = lo; rate <= hi; rate++) {
        if (digest_of(run, rate) == digest[rate - 1]) { continue; }
        if (differ++ == 0) { first = rate; }
    }
    if (differ > 0 && !golden_quiet()) { check_note("%s", golden_explain(name, run, first)); }
    CHECK(differ == 0, "%s: %" PRIu32 " of %" PRIu32 " rates differ, the first is %" PRIu32 " Hz",
          name, differ, hi - lo + 1, first);
    for (size_t i = 0; i < sizeof traced / sizeof traced[0]; i++) {
        const int in = traced[i] >= lo && traced[i] <= hi;
        const char *said = in ? golden_trace(name, run, traced[i]) : "";
        CHECK(said[0] == '\0', "%s", said);
    }
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

TEST_MAIN("golden", first_tick_that_differs_is_told, fix, bytes, record, ring, signal, slots, quad, quad_ab,
          velocity_window, velocity_pole, velocity_foaw, velocity_track, contact, table, drive,
          track, watch, guard, supply, passivity, safety, calibrate, probe, home, weigh, filter, quantizer,
          gains, glove, glove_cal, angle, hand, precontact, wire, mirror, modbus, modbus_rtu,
          drop, guarded, bilateral);
