/* SPDX-License-Identifier: MIT */
/* Drift: laws that are cheap enough to run for 10^9 ticks, half a day at 20 kHz. The input repeats
 * every 1000 ticks. So after the transient every period must give the bits of an early one, and
 * sums must grow by the same number in each. A state may have bits below those of the output. These
 * may cycle, and the output's last bits with them: as much after 10^9 ticks as early on. Counters
 * begin just below their ends and pass them in every period. */
#include "stability.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PERIOD  1000u
#define SETTLED 1200u /* periods after which one is kept, to compare with */
#define OUTS    3
#define PI      3.14159265358979323846

static int32_t wave[PERIOD]; /* counts: two sines, from 0 back to 0 */

static void make_wave(void)
{
    for (unsigned i = 0; i < PERIOD; i++) {
        const double t = 2 * PI * i / PERIOD;
        wave[i] = (int32_t)lrint(700 * (1 - cos(t)) + 90 * sin(7 * t));
    }
}

/* --- the laws: a tick, and its output --- */

static const struct exh_period T = {1, 20000};
static const struct exh_velocity_scale scale = {EXH_Q(5, 1000000, EXH_Q_STEP), {1, 20000}};

/* Encoder, velocity, law, drive and the observer of energy, in one contact that never ends. */
static struct {
    struct exh_quad_par quad_par;
    struct exh_quad_cfg quad_cfg;
    struct exh_quad quad;
    struct exh_velocity_window_cfg velocity_cfg;
    struct exh_velocity_window velocity;
    struct exh_contact_par par;
    struct exh_contact contact;
    struct exh_drive_par drive_par;
    struct exh_drive_cfg drive_cfg;
    struct exh_drive drive;
    struct exh_knot knot[2], held[2];
    struct exh_passivity_par passivity_par;
    struct exh_passivity_cfg passivity_cfg;
    struct exh_passivity passivity;
} law;

static void law_start(int32_t k_Npm_q10)
{
    static const struct exh_velocity_par p = {2};
    memset(&law, 0, sizeof law);
    law.quad_par = (struct exh_quad_par){scale.step_m_q42, exh_quad_rows[1].dflt};
    law.par = (struct exh_contact_par){
        k_Npm_q10, EXH_Q(5, 1, EXH_Q_B), EXH_Q(1, 2, EXH_Q_FORCE), EXH_Q(1, 1000, EXH_Q_POS), 0};
    for (int i = 0; i < EXH_DRIVE_ROWS; i++) {
        ((int32_t *)&law.drive_par)[i] = exh_drive_rows[i].dflt;
    }
    law.drive_par.slew_down_Nps = 10000000;
    law.knot[1] = (struct exh_knot){EXH_Q(22, 1, EXH_Q_FORCE), EXH_Q(66, 10, EXH_Q_CUR), {0, 0}};
    if (exh_quad_setup(&law.quad_cfg, &law.quad_par, T, 16) != 0 ||
        exh_velocity_window_setup(&law.velocity_cfg, scale, &p) != 0 ||
        exh_table_setup(law.knot, 2) != 0 || exh_table_invert(law.held, law.knot, 2) != 0 ||
        exh_drive_setup(&law.drive_cfg, &law.drive_par, T, (struct exh_table){law.knot, 2},
            (struct exh_table){NULL, 0}) != 0 ||
        exh_passivity_setup(&law.passivity_cfg, &law.passivity_par, &law.drive_cfg,
            (struct exh_table){law.held, 2}, scale, EXH_Q(3, 1, EXH_Q_VEL)) != 0) {
        abort();
    }
}

/* Below what the motor carries for ever, and above. */
static void cool_start(void) { law_start(EXH_Q(800, 1, EXH_Q_K)); }

static void hot_start(void) { law_start(EXH_Q(2000, 1, EXH_Q_K)); }

static void law_tick(unsigned i, int32_t out[OUTS])
{
    static const struct exh_permit open = {EXH_PERMIT_OPEN, INT32_C(1) << 30, 0, 1, {0, 0}};
    const int32_t cnt = exh_quad_step(&law.quad, &law.quad_cfg, (uint32_t)wave[i] + 65000u);
    const struct exh_contact_in in = {exh_quad_pos_m_q30(&law.quad_par, cnt),
        exh_velocity_window_step(&law.velocity, &law.velocity_cfg, cnt),
        -EXH_Q(3, 1000, EXH_Q_POS)};
    struct exh_force_ledger f;
    struct exh_current_ledger c;
    const int touching = exh_contact_step(&law.contact, &law.par, in, &f);
    exh_passivity_step(&law.passivity, &law.passivity_cfg, cnt, touching, &f);
    exh_drive_force_step(&law.drive, &law.drive_cfg, &open, &f);
    exh_drive_current_step(&law.drive, &law.drive_cfg, &f, &c);
    c.coded_A_q26 = (int32_t)(c.table_A_q26 + c.peak_A_q26 + c.i2t_A_q26);
    exh_passivity_update(&law.passivity, &law.passivity_cfg, &f, c.coded_A_q26);
    out[0] = f.force_N_q20;
    out[1] = c.coded_A_q26;
}

/* I2t holds back to a whole code of the D/A: codes are what may differ. */
static void hot_tick(unsigned i, int32_t out[OUTS])
{
    law_tick(i, out);
    out[1] = (int32_t)exh_mul_shr(out[1], law.drive_par.dac_rawpA_q16, EXH_Q_CUR + EXH_Q_DAC);
}

static int64_t law_sum(void) { return law.passivity.energy_Ncnt_q20; }

/* A count that passes 2^31 in every period, through all estimators of velocity. */
static struct {
    struct exh_velocity_window_cfg window_cfg;
    struct exh_velocity_window window;
    struct exh_velocity_pole_cfg pole_cfg;
    struct exh_velocity_pole pole;
    struct exh_velocity_track_cfg track_cfg;
    struct exh_velocity_track track;
} speed;

static void speed_start(void)
{
    static const struct exh_velocity_par p = {4};
    memset(&speed, 0, sizeof speed);
    if (exh_velocity_window_setup(&speed.window_cfg, scale, &p) != 0 ||
        exh_velocity_pole_setup(&speed.pole_cfg, scale, 2000) != 0 ||
        exh_velocity_track_setup(&speed.track_cfg, scale, 2000) != 0) {
        abort();
    }
}

static void speed_tick(unsigned i, int32_t out[OUTS])
{
    const int32_t cnt = exh_wrap_add(INT32_MAX - 600, wave[i]);
    out[0] = exh_velocity_window_step(&speed.window, &speed.window_cfg, cnt);
    out[1] = exh_velocity_pole_step(&speed.pole, &speed.pole_cfg, cnt);
    out[2] = exh_velocity_track_step(&speed.track, &speed.track_cfg, cnt);
}

/* Low-passes of both orders, an input to the ends of the word. */
static struct {
    struct exh_filter_cfg cfg[2];
    struct exh_filter s[2];
} low;

static void low_start(void)
{
    memset(&low, 0, sizeof low);
    for (int i = 0; i < 2; i++) {
        const struct exh_filter_par par = {i + 1, EXH_Q(50, 1, 16)};
        if (exh_filter_setup(&low.cfg[i], &par, T) != 0) { abort(); }
    }
}

static void low_tick(unsigned i, int32_t out[OUTS])
{
    const int32_t x = (int32_t)exh_clamp((int64_t)(wave[i] - 700) * 3200000, INT32_MIN, INT32_MAX);
    for (int k = 0; k < 2; k++) { exh_filter_step(&low.s[k], &low.cfg[k], &x, &out[k], 1); }
}

static int64_t nothing_summed(void) { return 0; }

static const struct law {
    const char *name;
    void (*start)(void);
    void (*tick)(unsigned i, int32_t out[OUTS]);
    int64_t (*sum)(void);
    int32_t may; /* LSB */
} laws[] = {
    {"drift: encoder, law, drive, energy: every period as an early one", cool_start, law_tick,
        law_sum, 0},
    {"drift: velocities across 2^31 counts: every period as an early one", speed_start, speed_tick,
        nothing_summed, 0},
    {"drift: low-passes: every period as an early one, to 1 LSB", low_start, low_tick,
        nothing_summed, 1},
    {"drift: force, and code of the current that I2t holds back: to 1 LSB", hot_start, hot_tick,
        nothing_summed, 1},
};

struct seen {
    int32_t early[PERIOD][OUTS];
    int64_t first_sum, each;
    int64_t off, sum_off, late; /* the most; of the last hundredth alone */
};

static void period(const struct law *one, struct seen *y, uint64_t p, int late)
{
    const int64_t before = one->sum();
    for (unsigned i = 0; i < PERIOD; i++) {
        int32_t out[OUTS] = {0, 0, 0};
        one->tick(i, out);
        for (int k = 0; k < OUTS; k++) {
            const int64_t by = (int64_t)out[k] - y->early[i][k], size = by < 0 ? -by : by;
            if (p == SETTLED) { y->early[i][k] = out[k]; }
            if (p > SETTLED && size > y->off) { y->off = size; }
            if (late && size > y->late) { y->late = size; }
        }
    }
    if (p == SETTLED) {
        y->first_sum = before;
        y->each = one->sum() - before;
    }
}

int drifts(uint64_t ticks)
{
    const uint64_t periods = ticks / PERIOD;
    FILE *csv = csv_open("drift", "law,ticks,off by LSB,in the last hundredth,sum off by");
    int failed = 0;
    make_wave();
    for (size_t l = 0; l < LEN(laws); l++) {
        static struct seen y;
        memset(&y, 0, sizeof y);
        laws[l].start();
        for (uint64_t p = 0; p < periods; p++) {
            period(&laws[l], &y, p, p >= periods - periods / 100);
        }
        y.sum_off = laws[l].sum() - y.first_sum - y.each * (int64_t)(periods - SETTLED);
        failed += must(y.off <= laws[l].may && y.sum_off == 0, laws[l].name,
            "%" PRIu64 " ticks, off by %" PRId64 " LSB, sum by %" PRId64, ticks, y.off, y.sum_off);
        fprintf(csv, "%.*s,%" PRIu64 ",%" PRId64 ",%" PRId64 ",%" PRId64 "\n",
            (int)strcspn(laws[l].name + 7, ":"), laws[l].name + 7, ticks, y.off, y.late, y.sum_off);
    }
    csv_close(csv);
    return failed;
}
