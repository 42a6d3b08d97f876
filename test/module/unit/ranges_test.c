/* SPDX-License-Identifier: MIT */
/* A set-up takes both ends of each parameter's documented range, and refuses the next value beyond.
 * Each field is tried alone, and the others have their usual values. */
#include "exhand/drive.h"
#include "exhand/error.h"
#include "exhand/precontact.h"
#include "exhand/probe.h"
#include "exhand/quad.h"
#include "exhand/safety.h"
#include "exhand/supply.h"
#include "exhand/table.h"
#include "exhand/tracking.h"
#include "exhand/motion.h"

#include "check.h"

#define FIELDS_MAX  16u
#define A(num, den) EXH_Q(num, den, EXH_Q_CUR)
#define M(num, den) EXH_Q(num, den, EXH_Q_POS)

static const struct exh_period kHz = {1, 1000};
static const struct exh_probe_scale scale = {EXH_Q(66, 1000000, EXH_Q_STEP), {1, 1000}};

struct range {
    int32_t usual, lo, hi;
};

static void some(const char *name, const struct range *of, uint32_t n,
    int (*setup)(const int32_t *par), int32_t *par)
{
    CHECK(setup(par) == 0, "%s, usual: %d", name, setup(par));
    for (uint32_t i = 0; i < n; i++) {
        const int32_t was = par[i];
        if (of[i].lo > of[i].hi) { continue; } /* another's */
        par[i] = of[i].lo;
        CHECK(setup(par) == 0, "%s, field %" PRIu32 ": its least", name, i);
        par[i] = of[i].hi;
        CHECK(setup(par) == 0, "%s, field %" PRIu32 ": its most", name, i);
        if (of[i].lo > INT32_MIN) {
            par[i] = of[i].lo - 1;
            CHECK(setup(par) == -EXH_E_RANGE, "%s, field %" PRIu32 ": below", name, i);
        }
        if (of[i].hi < INT32_MAX) {
            par[i] = of[i].hi + 1;
            CHECK(setup(par) == -EXH_E_RANGE, "%s, field %" PRIu32 ": above", name, i);
        }
        par[i] = was;
    }
}

static void ends(
    const char *name, const struct range *of, uint32_t n, int (*setup)(const int32_t *par))
{
    int32_t par[FIELDS_MAX] = {0};
    for (uint32_t i = 0; i < n; i++) { par[i] = of[i].usual; }
    some(name, of, n, setup, par);
}

static int watch(const int32_t *p)
{
    const struct exh_motion_par par = {p[0], p[1], p[2], p[3]};
    struct exh_motion_cfg cfg;
    return exh_motion_setup(&cfg, &par, kHz);
}

static int track(const int32_t *p)
{
    const struct exh_tracking_par par = {p[0], p[1]};
    struct exh_tracking_cfg cfg;
    return exh_tracking_setup(&cfg, &par, kHz);
}

static int supply(const int32_t *p)
{
    const struct exh_supply_par par = {p[0], p[1], p[2], p[3]};
    struct exh_supply_cfg cfg;
    return exh_supply_setup(&cfg, &par, kHz);
}

static int safety(const int32_t *p)
{
    const struct exh_safety_par par = {p[0], p[1], p[2], p[3], p[4]};
    struct exh_safety_cfg cfg;
    return exh_safety_setup(&cfg, &par, kHz);
}

static int quad(const int32_t *p)
{
    const struct exh_quad_par par = {p[0], p[1]};
    struct exh_quad_cfg cfg;
    return exh_quad_setup(&cfg, &par, kHz, (unsigned)p[2]);
}

static int probe(const int32_t *p)
{
    const struct exh_probe_par par = {p[0], p[1], p[2], p[3], p[4], p[5]};
    struct exh_probe_cfg cfg;
    return exh_probe_setup(&cfg, &par, scale);
}

static int home(const int32_t *p)
{
    const struct exh_home_par par = {p[0], p[1], p[2], p[3], p[4], p[5]};
    struct exh_home_cfg cfg;
    return exh_home_setup(&cfg, &par, scale);
}

static int weigh(const int32_t *p)
{
    const struct exh_weigh_par par = {{p[0], p[1], p[2], p[3], p[4], p[5]}, p[6], p[7]};
    struct exh_weigh_cfg cfg;
    return exh_weigh_setup(&cfg, &par, scale);
}

static int drive(const int32_t *p)
{
    static struct exh_knot knot[2] = {{0, 0, {0, 0}}, {EXH_Q(10, 1, EXH_Q_FORCE), A(5, 1), {0, 0}}};
    static struct exh_knot back[2];
    const struct exh_drive_par par = {
        p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11], p[12]};
    struct exh_drive_cfg cfg;
    if (exh_table_setup(knot, 2) < 0 || exh_table_invert(back, knot, 2) < 0) { return 1; }
    return exh_drive_setup(
        &cfg, &par, kHz, (struct exh_table){knot, 2}, (struct exh_table){back, 2});
}

static int advise(const int32_t *p)
{
    const struct exh_precontact_need need = {p[0], p[1], p[2], p[3], p[4], p[5], p[6]};
    struct exh_precontact_advice a;
    return exh_precontact_advise(&a, &need, kHz, p[7]);
}

TEST(of_watch)
{
    static const struct range of[] = {
        {EXH_Q(3, 1, EXH_Q_VEL), EXH_Q(1, 10, EXH_Q_VEL), EXH_Q(10, 1, EXH_Q_VEL)},
        {20, 1, 1000},
        {1000, 100, 60000},
        {A(1, 4), A(1, 20), A(66, 10)},
    };
    int32_t never[] = {EXH_Q(3, 1, EXH_Q_VEL), 20, 0, A(1, 4)};
    ends("watch", of, LEN(of), watch);
    CHECK(watch(never) == 0, "0 ms: never");
    never[2] = 1;
    CHECK(watch(never) == -EXH_E_RANGE, "1 ms");
    never[2] = -1;
    CHECK(watch(never) == -EXH_E_RANGE, "-1 ms");
}

TEST(of_track)
{
    static const struct range of[] = {{A(1, 4), A(1, 10), A(1, 1)}, {20, 1, 100}};
    ends("track", of, LEN(of), track);
}

/* 50 V are 32766 codes at the finest scale; where the supply is not judged, any is as good. */
TEST(of_supply)
{
    enum { V = INT32_C(1) << EXH_Q_SUPPLY };
    static const struct range of[] = {{20 * V, 0, 50 * V}, {50 * V, 20 * V, 100 * V},
        {EXH_Q(1, 128, EXH_Q_VPRAW), 1638451, INT32_MAX}, {10, 1, 1000}};
    static const struct range unjudged[] = {
        {0, 0, 0}, {50 * V, 0, 100 * V}, {1, 1, INT32_MAX}, {10, 1, 1000}};
    ends("supply", of, LEN(of), supply);
    for (uint32_t i = 1; i < LEN(unjudged); i++) {
        int32_t par[] = {0, 50 * V, 1, 10};
        par[i] = unjudged[i].lo;
        CHECK(supply(par) == 0, "unjudged, field %" PRIu32 ": its least", i);
        par[i] = unjudged[i].hi;
        CHECK(supply(par) == 0, "unjudged, field %" PRIu32 ": its most", i);
        par[i] = unjudged[i].lo - 1;
        CHECK(supply(par) == -EXH_E_RANGE, "unjudged, field %" PRIu32 ": below", i);
        if (unjudged[i].hi < INT32_MAX) {
            par[i] = unjudged[i].hi + 1;
            CHECK(supply(par) == -EXH_E_RANGE, "unjudged, field %" PRIu32 ": above", i);
        }
    }
}

TEST(of_safety)
{
    static const struct range of[] = {{1, 0, 1},
        {EXH_Q(1, 1, EXH_Q_FORCE), EXH_Q(1, 10, EXH_Q_FORCE), EXH_Q(10, 1, EXH_Q_FORCE)},
        {50, 1, 1000}, {500, 1, 5000}, {15, 5, 18}};
    ends("safety", of, LEN(of), safety);
}

TEST(of_quad)
{
    static const struct range of[] = {
        {EXH_Q(66, 1000000, EXH_Q_STEP), EXH_Q(1, 1000000, EXH_Q_STEP), INT32_MAX},
        {EXH_Q(2, 1, EXH_Q_VEL), EXH_Q(1, 10, EXH_Q_VEL), INT32_MAX},
        {24, 16, 32},
    };
    ends("quad", of, LEN(of), quad);
}

TEST(of_probe)
{
    int32_t par[] = {A(1, 100), A(1, 1), 100, 10000, M(1, 1000), M(1, 10)};
    static const struct range of[] = {
        {0, A(1, 1000000), A(1, 2)}, {0, 0, A(33, 10)}, {0, 1, 10000}, {0, 1, 1000000}};
    some("probe", of, LEN(of), probe, par);
    par[0] = -A(1, 1000000);
    CHECK(probe(par) == 0, "the least step down");
    par[0] = -A(1, 2);
    CHECK(probe(par) == 0, "the greatest");
    par[0] = -A(1, 2) - 1;
    CHECK(probe(par) == -EXH_E_RANGE, "a greater one");
    par[0] = 0;
    CHECK(probe(par) == -EXH_E_RANGE, "no step");
    par[0] = A(1, 100);
    par[4] = 0;
    CHECK(probe(par) == -EXH_E_RANGE, "no movement");
    par[4] = 1;
    CHECK(probe(par) == 0, "the least movement");
    par[4] = M(1, 1000);
    par[5] = M(1, 1);
    CHECK(probe(par) == 0, "1 m");
    par[5] = M(1, 1) + 1;
    CHECK(probe(par) == -EXH_E_RANGE, "more");
    par[5] = par[4];
    CHECK(probe(par) == -EXH_E_RANGE, "no way beyond the movement");
}

TEST(of_home)
{
    int32_t par[] = {A(1, 10), 100, 10000, M(1, 1000), M(1, 100), M(1, 2)};
    static const struct range of[] = {{0, 1, A(1, 2)}, {0, 1, 10000}, {0, 1, 1000000}};
    some("home", of, LEN(of), home, par);
    par[3] = 0;
    CHECK(home(par) == -EXH_E_RANGE, "no movement");
    par[3] = 1;
    CHECK(home(par) == 0, "the least movement");
    par[3] = M(1, 1000);
    par[4] = 0;
    CHECK(home(par) == 0, "an end at once");
    par[4] = -1;
    CHECK(home(par) == -EXH_E_RANGE, "one before it");
    par[4] = par[5];
    CHECK(home(par) == 0, "only the last place is none");
    par[4] = par[5] + 1;
    CHECK(home(par) == -EXH_E_RANGE, "not that either");
    par[4] = 0;
    par[5] = par[3];
    CHECK(home(par) == -EXH_E_RANGE, "no way beyond the movement");
    par[5] = par[3] + M(1, 10000);
    CHECK(home(par) == 0, "a little more");
    par[5] = M(1, 1);
    CHECK(home(par) == 0, "1 m");
    par[5] = M(1, 1) + 1;
    CHECK(home(par) == -EXH_E_RANGE, "more");
}

TEST(of_weigh)
{
    int32_t par[] = {A(1, 100), A(1, 1), 100, 10000, M(1, 1000), M(1, 10), A(1, 10), 1000};
    static const struct range of[] = {{0, A(1, 1000000), A(1, 2)}, {0, A(1, 10), A(33, 10)},
        {0, 1, 10000}, {0, 1, 1000000}, {0, 1, 0}, {0, 1, 0}, {0, 0, A(1, 1)}, {0, 1, 100000}};
    some("weigh", of, LEN(of), weigh, par);
    par[0] = -A(1, 100);
    CHECK(weigh(par) == -EXH_E_RANGE, "it goes up first");
    par[0] = A(1, 1000000);
    CHECK(weigh(par) == 0, "the least step");
    par[0] = A(1, 1000000) - 1;
    CHECK(weigh(par) == -EXH_E_RANGE, "a step that the probe refuses");
}

TEST(of_drive)
{
    static const struct range of[] = {
        {EXH_Q(10, 1, EXH_Q_FORCE), 0, EXH_Q(100, 1, EXH_Q_FORCE)},
        {200000, 1, 10000000},
        {200000, 1000, 10000000},
        {A(6, 1), A(3, 1), A(66, 10)},
        {A(3, 1), 0, A(33, 10)},
        {2700, 1, 2700},
        {32768, 0, 65535},
        {12184, 0, 32767},
        {EXH_Q(1846, 1, EXH_Q_DAC), EXH_Q(1, 1, EXH_Q_DAC), INT32_MAX},
        {0, -32768, 32767},
        {567787804, 1, INT32_MAX},
        {EXH_Q(40, 1, EXH_Q_FORCE), EXH_Q(1, 8, EXH_Q_FORCE), EXH_Q(100, 1, EXH_Q_FORCE)},
        {A(66, 10), 0, A(66, 10)},
    };
    int32_t par[] = {0, 1, 1000, A(1, 10), 0, 1, 0, 0, EXH_Q(1, 1, EXH_Q_DAC), 0, 1,
        EXH_Q(1, 8, EXH_Q_FORCE), 0};
    ends("drive", of, LEN(of), drive);
    CHECK(drive(par) == 0, "the least peak");
    par[3]--;
    CHECK(drive(par) == -EXH_E_RANGE, "a lower one");
    par[3] = A(1, 10);
    par[4] = A(1, 10);
    CHECK(drive(par) == 0, "for ever as at the peak");
    par[4]++;
    CHECK(drive(par) == -EXH_E_RANGE, "for ever more than at the peak");
}

/* What is as long as it may be is what the result cannot hold, so each is shown with the others
 * small. */
TEST(of_advise)
{
    int32_t par[] = {0, 0, 0, 0, 0, 0, 0, -M(5, 1000)};
    static const int32_t most[] = {
        M(1, 1000), 2000000, M(1, 2), 2000000, EXH_Q(1, 4, EXH_Q_VEL), INT32_MAX, INT32_MAX};
    CHECK(advise(par) == 0, "nothing at all is needed");
    for (uint32_t i = 0; i < LEN(most); i++) {
        par[i] = -1;
        CHECK(advise(par) == -EXH_E_RANGE, "field %" PRIu32 ": below", i);
        par[i] = most[i];
        CHECK(advise(par) == 0, "field %" PRIu32 ": its most", i);
        if (most[i] == 2000000) {
            par[i]++;
            CHECK(advise(par) == -EXH_E_RANGE, "field %" PRIu32 ": above", i);
        }
        par[i] = 0;
    }
    par[7] = -1;
    CHECK(advise(par) == 0, "the nearest d_lim");
    par[7] = 0;
    CHECK(advise(par) == -EXH_E_RANGE, "none");
}

/* A ball of the least radius counts. */
TEST(advice_for_the_least_ball)
{
    const struct exh_precontact_need need = {0, 0, 0, 0, 0, 3, 1};
    struct exh_precontact_advice a;
    CHECK_EQ_I64(exh_precontact_advise(&a, &need, kHz, -M(5, 1000)), 0);
    CHECK_EQ_I64(a.error_m_q30, 5); /* 9/2, up */
}

TEST_MAIN("unit/ranges", of_watch, of_track, of_supply, of_safety, of_quad, of_probe, of_home,
    of_weigh, of_drive, of_advise, advice_for_the_least_ball);
