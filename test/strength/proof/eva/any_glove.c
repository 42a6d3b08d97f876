/* SPDX-License-Identifier: MIT */
/* PROVES: glove
 * Any codes in any state read from bytes; any gain, cross term, end and sensor, a zero within the
 * card; any coefficients, limits and lists, damaged ones included. Set-up with any parameters and
 * any valid calibration. A cause is one of the four. Frames in parts, an empty part included.
 *
 * EVA: -eva-slevel 30
 * PLANT: lib/src/sense/glove.c: cfg->crossed[n] < EXH_GLOVE_SENSORS ? cfg->crossed[n] : 0 -> cfg->crossed[n]
 * PLANT: lib/src/sense/glove.c: if (cal->of[k] >= EXH_GLOVE_SENSORS) { continue; } -> if (cal->of[k] == EXH_GLOVE_NONE) { continue; }
 * PLANT: lib/src/sense/glove.c: n < cfg->crosses && n < EXH_GLOVE_SENSORS -> n < cfg->crosses
 * PLANT: lib/src/sense/glove.c: angle_turn_q32[i] = exh_sat32(sum); -> angle_turn_q32[i] = (int32_t)sum;
 * PLANT: lib/src/sense/glove.c: if (s->cause[i] >= EXH_GLOVE_CAUSES) { s->cause[i] = EXH_GLOVE_OUTSIDE; } -> (void)0;
 * PLANT: lib/src/sense/glove.c: exh_clamp((int64_t)s->high_raw + margin, INT16_MIN, par->high_raw - 1) -> (s->high_raw + margin)
 */
#include "num/bytes.c"
#include "num/fix.c"
#include "sense/filter.c"
#include "sense/filter_low.c"
#include "sense/filter_high.c"
#include "sense/quantizer.c"
#define exh_filter_setup(cfg, par, T) filter_set_up(cfg)
static int filter_set_up(struct exh_filter_cfg *cfg);
/* exh_rows_validate() value by value: Eva does not see through bytes of a struct. */
#define exh_rows_validate(rows, n, par) in_rows(par)
#define INSIDE(k, v)                    (exh_glove_rows[k].min <= (v) && (v) <= exh_glove_rows[k].max)
static int in_rows(const struct exh_glove_par *p);
#include "sense/glove.c"
static int in_rows(const struct exh_glove_par *p)
{
    return INSIDE(0, p->order) && INSIDE(1, p->fc_Hz_q16) && INSIDE(2, p->bits) &&
           INSIDE(3, p->hyst_raw_q16) && INSIDE(4, p->low_raw) && INSIDE(5, p->high_raw) &&
           INSIDE(6, p->open_high) && INSIDE(7, p->debounce_frames) && INSIDE(8, p->margin_q16);
}

#include "any.h"

/* Both prove elsewhere: eva/any_glove_cal.c and, for the coefficients that a set-up can make, test/module/prop. */
int exh_glove_cal_validate(const struct exh_glove_cal *cal, struct exh_glove_error *bad)
{
    (void)cal;
    (void)bad;
    return any32();
}

static int filter_set_up(struct exh_filter_cfg *cfg)
{
    ANY(*cfg);
    return any32();
}

static struct exh_glove s;
static struct exh_glove_cfg cfg;
static struct exh_glove_cal cal;
static struct exh_glove_in in;
static int32_t angle_turn_q32[EXH_GLOVE_SENSORS];

static void any_cal(void)
{
    ANY(cal);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        cal.sensor[i].zero_raw_q15 = Frama_C_interval(-(1 << 30), (1 << 30) - 1);
    }
}

static void any_cfg(uint8_t kind)
{
    ANY(cfg);
    cfg.cal = &cal;
    cfg.filter.kind = kind;
    cfg.filter.a = Frama_C_interval(0, (1 << 30) - 1);
    cfg.low_cause = (uint8_t)Frama_C_unsigned_int_interval(EXH_GLOVE_OPEN, EXH_GLOVE_SHORT);
    cfg.high_cause = (uint8_t)Frama_C_unsigned_int_interval(EXH_GLOVE_OPEN, EXH_GLOVE_SHORT);
    cfg.quantizer.half = Frama_C_unsigned_int_interval(64, UINT32_C(1) << 30);
}

static void one_frame(uint8_t kind)
{
    uint32_t faulty;
    any_cfg(kind);
    FROM_BYTES(s, exh_glove_serialize);
    ANY(in);
    faulty = exh_glove_step(&s, &cfg, &in, angle_turn_q32);
    /*@ assert sensors: faulty < 4194304; */
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const uint8_t cause = s.cause[i];
        /*@ assert a_cause: cause < 4; */
    }
}

static void one_frame_in_parts(void)
{
    static const uint8_t end[] = {0, 4, 10, 22, 22, 3};
    any_cfg(EXH_FILTER_LOW2);
    FROM_BYTES(s, exh_glove_serialize);
    ANY(in);
    exh_glove_believe(&s, &cfg, &in, angle_turn_q32);
    for (unsigned p = 0; p < 5; p++) {
        exh_glove_angles(&s, &cfg, end[p], end[p + 1], angle_turn_q32);
    }
    exh_glove_cross(&cfg, angle_turn_q32);
}

static void set_up(void)
{
    struct exh_glove_par par;
    const struct exh_period T = {any_u32(), any_u32()};
    ANY(par);
    (void)exh_glove_setup(&cfg, &par, &cal, T);
}

int main(void)
{
    any_cal();
    set_up();
    one_frame(EXH_FILTER_LOW1);
    one_frame(EXH_FILTER_LOW2);
    one_frame(EXH_FILTER_HIGH1);
    one_frame(EXH_FILTER_HIGH2);
    one_frame_in_parts();
    END();
    return 0;
}
