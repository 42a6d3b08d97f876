/* SPDX-License-Identifier: MIT */
/* velocity: the four estimators. */
#include "modules.h"

#include "exhand/velocity.h"

static uint32_t tau(struct golden_rng *r)
{
    const int64_t any = golden_draw(r, 0, 1000000);
    return (uint32_t)(any >> golden_draw(r, 0, 16));
}

/* What is common to the four: step, counts and the rows. */
struct any {
    struct golden_rng rng;
    struct golden_wave cnt;
    struct exh_velocity_scale scale;
};

/* small: counts a tick in ramps and walks; 0: what is some 8 m/s. */
static void begin(struct any *a, const char *name, uint32_t rate_Hz, int64_t small)
{
    a->rng = golden_rng(name, rate_Hz, 0);
    a->scale.step_m_q42 = golden_step(&a->rng);
    if (small == 0) { small = (INT64_C(1) << 45) / ((int64_t)a->scale.step_m_q42 * rate_Hz); }
    golden_wave(&a->cnt, name, rate_Hz, 1, INT32_MIN, INT32_MAX, small < 3 ? 3 : (int32_t)small);
}

static void row(struct golden *g, const struct any *a, int32_t vel_mps_q27)
{
    golden_put(g, a->cnt.at[g->tick]);
    golden_put(g, vel_mps_q27);
}

/* 1 when this tick is one of set-up. */
static int again(const struct golden *g, struct any *a, uint32_t rate_Hz)
{
    if (g->tick != 0 && g->tick != GOLDEN_AGAIN) { return 0; }
    a->scale.T = golden_period(rate_Hz, g->tick);
    return 1;
}

void golden_velocity_window(struct golden *g, uint32_t rate_Hz)
{
    static struct any a;
    struct exh_velocity_window_cfg cfg;
    struct exh_velocity_window s;
    begin(&a, "velocity_window", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        if (again(g, &a, rate_Hz)) {
            const struct exh_velocity_par par = {(int32_t)golden_draw(&a.rng, 0, 4)};
            CHECK_EQ_I64(exh_velocity_window_setup(&cfg, a.scale, &par), 0);
            (void)memset(&s, 0, sizeof s);
        }
        row(g, &a, exh_velocity_window_step(&s, &cfg, a.cnt.at[g->tick]));
        GOLDEN_STATE(g, exh_velocity_window_serialize, &s);
        golden_tick(g);
    }
}

void golden_velocity_pole(struct golden *g, uint32_t rate_Hz)
{
    static struct any a;
    struct exh_velocity_pole_cfg cfg;
    struct exh_velocity_pole s;
    begin(&a, "velocity_pole", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        if (again(g, &a, rate_Hz)) {
            CHECK_EQ_I64(exh_velocity_pole_setup(&cfg, a.scale, tau(&a.rng)), 0);
            (void)memset(&s, 0, sizeof s);
        }
        row(g, &a, exh_velocity_pole_step(&s, &cfg, a.cnt.at[g->tick]));
        GOLDEN_STATE(g, exh_velocity_pole_serialize, &s);
        golden_tick(g);
    }
}

void golden_velocity_foaw(struct golden *g, uint32_t rate_Hz)
{
    static struct any a;
    struct exh_velocity_foaw_cfg cfg;
    struct exh_velocity_foaw s;
    begin(&a, "velocity_foaw", rate_Hz, 40);
    while (g->tick < GOLDEN_TICKS) {
        if (again(g, &a, rate_Hz)) {
            const unsigned n = (unsigned)golden_draw(&a.rng, 2, 16);
            const int64_t any = golden_draw(&a.rng, 1, 255);
            const unsigned tol = (unsigned)(any >> golden_draw(&a.rng, 0, 7));
            CHECK_EQ_I64(exh_velocity_foaw_setup(&cfg, a.scale, n, tol > 0 ? tol : 1), 0);
            (void)memset(&s, 0, sizeof s);
        }
        row(g, &a, exh_velocity_foaw_step(&s, &cfg, a.cnt.at[g->tick]));
        GOLDEN_STATE(g, exh_velocity_foaw_serialize, &s);
        golden_tick(g);
    }
}

void golden_velocity_track(struct golden *g, uint32_t rate_Hz)
{
    static struct any a;
    struct exh_velocity_track_cfg cfg;
    struct exh_velocity_track s;
    begin(&a, "velocity_track", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        if (again(g, &a, rate_Hz)) {
            CHECK_EQ_I64(exh_velocity_track_setup(&cfg, a.scale, tau(&a.rng)), 0);
            (void)memset(&s, 0, sizeof s);
        }
        row(g, &a, exh_velocity_track_step(&s, &cfg, a.cnt.at[g->tick]));
        GOLDEN_STATE(g, exh_velocity_track_serialize, &s);
        golden_tick(g);
    }
}
