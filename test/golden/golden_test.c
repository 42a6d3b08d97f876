/* SPDX-License-Identifier: MIT */
/* Every module at every rate against the digests of the independent generator. A digest is a CRC of
 * a hundred rates. Where one differs, the generator runs for its rates, then for the first rate
 * that differs. The test prints the first tick that differs.
 *
 * Environment on hosts:
 *   EXH_TEST=name           one module
 *   EXH_RATES=lo..hi:step   every step-th of these rates, up to 20000
 *   EXH_HUNDREDS=2001,2301  of those, only the hundreds that begin so
 *   EXH_EXPLAIN=0           count without an explanation
 *   EXH_CELLS=1             print what ran
 *   EXH_DIGESTS=file        has the digests of single rates
 *   EXH_WRITE=file          gets them
 *   EXH_TRACES=folder       traces of the paper's six rates, which are compared tick by tick */
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

/* Results of a module's rates. */
struct tally {
    uint32_t ran, differ, first; /* the first rate that differs */
    uint32_t crc;                /* of the digests that ran */
    uint32_t hundreds, crc_hundreds;
    uint32_t unknown; /* rates without a known digest */
    int rough;        /* differ has whole hundreds of which some rates may agree */
};

/* The rates of a hundred that ran, in their order. */
struct hundred {
    uint32_t n, crc;
    uint32_t rate[GOLDEN_HUNDRED], got[GOLDEN_HUNDRED];
};

static void play(struct hundred *h, golden_run *run, uint32_t first, const struct golden_rates *of)
{
    h->n = h->crc = 0;
    for (uint32_t rate = first; rate < first + GOLDEN_HUNDRED; rate++) {
        if (rate < of->lo || rate > of->hi || (rate - of->lo) % of->step != 0) { continue; }
        h->rate[h->n] = rate;
        h->got[h->n] = digest_of(run, rate);
        h->crc = golden_crc_u32(h->crc, h->got[h->n]);
        h->n++;
    }
}

static void differs(struct tally *t, uint32_t rate)
{
    if (t->differ++ == 0) { t->first = rate; }
}

/* Rates one by one: a whole hundred whose CRC differs, or a part of one. */
static void one_by_one(
    struct tally *t, const struct hundred *h, const char *name, uint32_t first, uint32_t want)
{
    static uint32_t digest[GOLDEN_HUNDRED];
    const uint32_t before = t->differ;
    const int whole = h->n == GOLDEN_HUNDRED;
    /* The generator takes its time: of whole hundreds only the first that differs is requested. */
    const int known = golden_singles(name, first, want, !whole || before == 0, digest);
    if (!known && !whole) { t->unknown += h->n; }
    for (uint32_t i = 0; known && i < h->n; i++) {
        if (h->got[i] != digest[h->rate[i] - first]) { differs(t, h->rate[i]); }
    }
    if (whole && t->differ == before) { /* no digest says which, or the CRC is an old one */
        t->rough = 1;
        for (uint32_t i = 0; i < h->n; i++) { differs(t, h->rate[i]); }
    }
}

static void tell(
    const struct tally *t, const char *name, golden_run *run, const struct golden_rates *of)
{
    if (golden_cells() && t->ran > 0) {
        check_note("cells: %s %" PRIu32 "..%" PRIu32 ":%" PRIu32 " %" PRIu32 " %08" PRIx32, name,
            of->lo, of->hi, of->step, t->ran, t->crc);
        check_note("hundreds: %s %" PRIu32 " %08" PRIx32, name, t->hundreds, t->crc_hundreds);
    }
    if (t->differ > 0 && !golden_quiet()) { check_note("%s", golden_explain(name, run, t->first)); }
    CHECK(t->differ == 0,
        "%s: %s%" PRIu32 " of %" PRIu32 " rates differ, the first is %" PRIu32 " Hz", name,
        t->rough ? "up to " : "", t->differ, t->ran, t->first);
    CHECK(t->unknown == 0 || !golden_files(),
        "%s: no digests of %" PRIu32 " single rates: make golden-rates, or python3", name,
        t->unknown);
}

/* crc[i] is of the digests at 100 i + 1 … 100 i + 100 Hz. */
static void all_rates(const char *name, golden_run *run, const uint32_t *crc)
{
    static struct hundred h;
    const struct golden_rates of = golden_rates();
    struct tally t = {0};
    for (uint32_t i = 0; i < GOLDEN_HUNDREDS && i * GOLDEN_HUNDRED < of.hi; i++) {
        const uint32_t first = i * GOLDEN_HUNDRED + 1u;
        if (!golden_drawn(first)) { continue; }
        play(&h, run, first, &of);
        for (uint32_t k = 0; k < h.n; k++) { t.crc = golden_crc_u32(t.crc, h.got[k]); }
        t.ran += h.n;
        if (h.n == GOLDEN_HUNDRED) {
            t.hundreds++;
            t.crc_hundreds = golden_crc_u32(t.crc_hundreds, h.crc);
            golden_write(name, first, h.got);
        }
        if (h.n > 0 && (h.n < GOLDEN_HUNDRED || h.crc != crc[i])) {
            one_by_one(&t, &h, name, first, crc[i]);
        }
    }
    tell(&t, name, run, &of);
    for (size_t i = 0; i < sizeof traced / sizeof traced[0]; i++) {
        const int in = traced[i] >= of.lo && traced[i] <= of.hi;
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
    TEST(name) { all_rates(#name, golden_##name, digest_##name); } \
    typedef int module_##name

MODULE(fix);
MODULE(bytes);
MODULE(mac);
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
MODULE(limiter);
MODULE(chatter);
MODULE(guard);
MODULE(supply);
MODULE(safety);
MODULE(calibrate);
MODULE(probe);
MODULE(home);
MODULE(weigh);
MODULE(filter);
MODULE(filter_cheap);
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

TEST_MAIN("golden", first_tick_that_differs_is_told, fix, bytes, mac, record, ring, signal, slots,
    quad, quad_ab, velocity_window, velocity_pole, velocity_foaw, velocity_track, contact, table,
    drive, track, watch, limiter, chatter, guard, supply, passivity, safety, calibrate, probe, home,
    weigh, filter, filter_cheap, quantizer, gains, glove, glove_every, glove_cal, angle, hand,
    precontact, wire, mirror, modbus, modbus_rtu, drop, guarded, bilateral);
