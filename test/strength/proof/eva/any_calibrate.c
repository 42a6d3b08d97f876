/* SPDX-License-Identifier: MIT */
/* PROVES: calibration of a finger
 * Any bytes of some lengths as an image, with room for none to two points. Any calibration of up
 * to two points is judged and compared. Calibrations with points in range become tables of any
 * room and are written into buffers of some sizes. Lines through any points. test/module/unit
 * shows that the check accepts only points in range.
 *
 * EVA: -eva-slevel 60
 * PLANT: lib/src/bench/calibrate.c: if (h.points > c->cap) { return -EXH_E_SHORT; } -> (void)0;
 * PLANT: lib/src/bench/calibrate.c: if (cap < last + 2u) { return refuse(bad, EXH_CALIB_FORCE_TABLE, last, -EXH_E_SHORT); } -> (void)0;
 * PLANT: lib/src/bench/calibrate.c: if (cap < 2u * last + 3u) { return refuse(bad, EXH_CALIB_MONITOR_TABLE, last, -EXH_E_SHORT); } -> (void)0;
 * PLANT: lib/src/bench/calibrate.c: what < EXH_CALIB_ERRORS -> what <= EXH_CALIB_ERRORS
 * PLANT: lib/src/bench/calibrate.c: if (n < 1 || n > EXH_CALIB_POINTS_MAX) { return -EXH_E_RANGE; } -> (void)0;
 */
#include "num/bytes.c"
#include "num/crc.c"
#include "num/fix.c"
#define exh_gain_set any_gain
#include "bench/calibrate.c"
#undef exh_gain_set

#include "any.h"

#define POINTS 2

static struct exh_calib c;
static struct exh_calib_point point[EXH_CALIB_POINTS_MAX];
static struct exh_calib_target here;
static struct exh_calib_error bad;
static uint8_t image_B[EXH_CALIB_IMAGE_B];

/* Of points in range it is below 32 (smt.py: line_is_below_32). */
int any_gain(struct exh_gain *g, uint64_t num, uint64_t den)
{
    (void)num;
    (void)den;
    g->mant = Frama_C_interval(0, INT32_MAX);
    g->shift = (uint8_t)Frama_C_unsigned_int_interval(26, 62);
    return Frama_C_interval(-1, 0);
}

int exh_table_setup(struct exh_knot *knot, unsigned n)
{
    int32_t last = 0;
    for (unsigned i = 0; i < n; i++) { last = knot[i].x; }
    return last == 0 || Frama_C_interval(0, 1) ? -EXH_E_MONOTONE : 0;
}

static void any_calib(uint8_t points, uint8_t cap)
{
    ANY(c);
    ANY(point);
    c.points = points;
    c.cap = cap;
    c.point = point + (EXH_CALIB_POINTS_MAX - cap);
}

static void judged(uint8_t points)
{
    any_calib(points, points);
    (void)rises(&c, EXH_CALIB_CURRENT, EXH_CALIB_FORCE_TABLE, &bad);
    (void)rises(&c, EXH_CALIB_MONITOR, EXH_CALIB_MONITOR_TABLE, NULL);
}

static void in_range(uint8_t points)
{
    any_calib(points, points);
    for (unsigned i = 0; i < EXH_CALIB_POINTS_MAX; i++) {
        point[i].force_N_q20 = Frama_C_interval(1, EXH_FORCE_MAX_N_Q20);
        point[i].cur_A_q26 = Frama_C_interval(1, CUR_MAX_A_Q26);
        point[i].mon_A_q26 = Frama_C_interval(1, MON_MAX_A_Q26);
    }
    c.end_A_q26 = Frama_C_interval(0, CUR_MAX_A_Q26);
}

static void tables(uint8_t points)
{
    static struct exh_knot knot[2 * EXH_CALIB_POINTS_MAX + 3];
    in_range(points);
    (void)exh_calib_validate(&c, &bad);
    (void)exh_calib_force_table(&c, knot + 1, 2 * EXH_CALIB_POINTS_MAX + 2, NULL);
    for (unsigned cap = 0; cap < 2u * points + 3; cap++) {
        struct exh_knot *k = knot + (2 * EXH_CALIB_POINTS_MAX + 3 - cap);
        (void)exh_calib_force_table(&c, k, cap, &bad);
        (void)exh_calib_monitor_table(&c, k, cap, NULL);
    }
}

static void others(void)
{
    struct exh_calib_fit fit;
    any_calib(POINTS, POINTS);
    ANY(here);
    (void)exh_calib_check(&c, &here, &bad);
    (void)exh_calib_near(&c, Frama_C_interval(0, INT32_C(1) << 29), &bad);
    (void)exh_calib_ratio_NpA_q20(point, EXH_CALIB_CURRENT);
    (void)exh_calib_ratio_NpA_q20(point, EXH_CALIB_MONITOR);
    (void)any_gain(&fit.gain, 0, 1);
    (void)exh_calib_residual_N_q20(&fit, point, EXH_CALIB_MONITOR);
    (void)exh_calib_fit(&fit, point, POINTS, EXH_CALIB_CURRENT);
    (void)exh_calib_fit(&fit, point, any_u32(), EXH_CALIB_MONITOR);
    (void)exh_calib_error_text(any_u32());
}

static void loaded(uint8_t cap, size_t len_B)
{
    any_calib(0, cap);
    ANY(image_B);
    (void)load(&c, image_B + (sizeof image_B - len_B), len_B);
    /*@ assert has_room: c.points <= cap; */
}

static void saved(size_t cap_B)
{
    in_range(POINTS);
    (void)exh_calib_save(&c, image_B + (sizeof image_B - cap_B), cap_B, &bad);
}

int main(void)
{
    judged(0);
    judged(1);
    judged(2);
    tables(0);
    tables(1);
    tables(2);
    others();
    loaded(0, 52);
    loaded(1, 68);
    loaded(2, 84);
    loaded(2, 83);
    loaded(2, 7);
    (void)exh_calib_load(&c, image_B, 7, NULL);
    /*@ assert nothing: c.points == 0; */
    saved(84);
    saved(83);
    END();
    return 0;
}
