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
    if (differ > 0) { golden_explain(name, run, first); }
    CHECK(differ == 0, "%s: %" PRIu32 " of %" PRIu32 " rates differ, the first is %" PRIu32 " Hz",
          name, differ, hi - lo + 1, first);
    for (size_t i = 0; i < sizeof traced / sizeof traced[0]; i++) {
        if (traced[i] >= lo && traced[i] <= hi) { golden_trace(name, run, traced[i]); }
    }
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
MODULE(signal);
MODULE(quad);
MODULE(quad_ab);
MODULE(velocity_window);
MODULE(velocity_pole);
MODULE(velocity_foaw);
MODULE(velocity_track);
MODULE(contact);
MODULE(table);
MODULE(drive);
MODULE(safety);
MODULE(calibrate);
MODULE(drop);

TEST_MAIN("golden", fix, bytes, record, signal, quad, quad_ab, velocity_window, velocity_pole,
          velocity_foaw, velocity_track, contact, table, drive, safety, calibrate, drop);
