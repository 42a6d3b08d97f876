/* SPDX-License-Identifier: MIT */
/* Calibration of a glove from poses: least squares, in integers.
 *
 * The angle of a sensor is linear in its code and, for an abduction, in the angles of two knuckles.
 * Sums of products of differences over all pairs of poses replace the usual sums about the mean.
 * They are n times as large and need no mean. Elimination gives the last unknown; its share is
 * subtracted from the angles, and so on down to the gain. */
#include "exhand/glove.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define ALL                   4                  /* code, two knuckles, and the known angle */
#define ANGLES_APART_TURN_Q32 EXH_Q(5, 360, 32)  /* smallest difference of known angles */
#define PIVOT_MIN             (INT64_C(1) << 42) /* a knuckle movement of 2.8 degrees */
#define PIVOT_SHARE           8                  /* 2^-8 of it must be independent */

const struct exh_glove_fit_par exh_glove_fit_default = {256, 128, EXH_Q(6, 360, 32)};

/* The poses with a known angle of one sensor. */
struct known {
    unsigned n, terms;                 /* number of poses; of unknown factors */
    uint8_t pose[EXH_GLOVE_POSES_MAX]; /* their indices */
    int32_t code_raw_q16[EXH_GLOVE_POSES_MAX];
    int32_t term[ALL][EXH_GLOVE_POSES_MAX];      /* code q12, angles of knuckles turn_q28 */
    int32_t angle_turn_q32[EXH_GLOVE_POSES_MAX]; /* minus the cross terms found */
};

struct factor {
    struct exh_gain size;
    int down; /* 1: negative */
};

/* num/den, den > 0; results below 2^-32 are 0. */
static int factor_set(struct factor *f, int64_t num, int64_t den)
{
    const uint64_t size = num < 0 ? (uint64_t)-num : (uint64_t)num;
    f->down = num < 0;
    if (exh_gain_set(&f->size, size, (uint64_t)den) == 0) { return 0; }
    f->size = (struct exh_gain){0, 1};
    return size < (uint64_t)den ? 0 : -EXH_E_RANGE;
}

/* f v. By the Cauchy-Schwarz inequality, no larger than the sums from which it comes. */
static int64_t factor_mul(const struct factor *f, int64_t v)
{
    const int64_t q31 = exh_mul64_q31(v, f->size.mant);
    const unsigned s = f->size.shift;
    const int64_t size = s > 31 ? exh_shr_round(q31, s - 31u) : q31 * (INT64_C(1) << (31u - s));
    return f->down ? -size : size;
}

static int32_t own_turn_q32(const struct exh_glove_sensor *s, int32_t raw_q16)
{
    return exh_sat32(exh_mul_shr((raw_q16 >> 1) - s->zero_raw_q15, s->gain_turnpraw_q38,
        EXH_Q_ZERO + EXH_Q_TPRAW - EXH_Q_TURN));
}

/* sum[r][c] over all pairs; the known angle follows the terms. */
static void sums(int64_t sum[ALL][ALL], const struct known *k)
{
    for (unsigned r = 0; r <= k->terms; r++) {
        for (unsigned c = r; c <= k->terms; c++) {
            sum[r][c] = 0;
            for (unsigned p = 0; p < k->n; p++) {
                for (unsigned q = 0; q < p; q++) {
                    sum[r][c] +=
                        (int64_t)(k->term[r][p] - k->term[r][q]) * (k->term[c][p] - k->term[c][q]);
                }
            }
        }
    }
}

/* The factor of the last term, and its inverse if wanted. -EXH_E_RANGE: the terms moved too little
 * or were dependent. */
static int last_factor(struct known *k, struct factor *f, struct factor *inverse)
{
    const unsigned last = k->terms - 1, y = k->terms;
    int64_t sum[ALL][ALL], least[ALL];
    for (unsigned p = 0; p < k->n; p++) { k->term[y][p] = k->angle_turn_q32[p] >> 4; }
    sums(sum, k);
    for (unsigned r = 0; r <= last; r++) { least[r] = sum[r][r] >> PIVOT_SHARE; }
    for (unsigned r = 0; r <= last; r++) {
        /* With dependent terms, the divisor would consist of rounding errors. */
        if (sum[r][r] < 1 || sum[r][r] < least[r] || (r > 0 && sum[r][r] < PIVOT_MIN)) {
            return -EXH_E_RANGE;
        }
        for (unsigned c = r + 1; r < last && c <= y; c++) {
            struct factor share;
            if (factor_set(&share, sum[r][c], sum[r][r]) < 0) { return -EXH_E_RANGE; }
            for (unsigned d = c; d <= y; d++) { sum[c][d] -= factor_mul(&share, sum[r][d]); }
        }
    }
    if (inverse != NULL) {
        const int64_t size = sum[last][y] < 0 ? -sum[last][y] : sum[last][y];
        if (size == 0 || factor_set(inverse, sum[last][last], size) < 0) { return -EXH_E_RANGE; }
        inverse->down = sum[last][y] < 0;
    }
    return factor_set(f, sum[last][y], sum[last][last]);
}

/* Collects the poses of sensor `at` and checks them. EXH_GLOVE_ERRORS: no error. */
static unsigned gather(struct known *k, const struct exh_glove_cal *cal, struct exh_glove_fit *fit,
    unsigned at, const struct exh_glove_pose *pose, unsigned n, const struct exh_glove_fit_par *par)
{
    int32_t code[2] = {INT32_MAX, INT32_MIN}, angle[2] = {INT32_MAX, INT32_MIN};
    k->n = 0;
    k->terms = 1;
    for (unsigned p = 0; p < n; p++) {
        const int32_t raw_q16 = pose[p].mean_raw_q16[at];
        const int32_t known = pose[p].angle_turn_q32[at];
        const unsigned m = k->n;
        if (!(pose[p].known >> at & 1)) { continue; }
        if (pose[p].noise_raw[at] > par->noise_max_raw) {
            fit->pose = (uint8_t)p;
            return EXH_GLOVE_NOISE;
        }
        k->pose[m] = (uint8_t)p;
        k->code_raw_q16[m] = raw_q16;
        k->term[0][m] = raw_q16 >> 4;
        k->angle_turn_q32[m] = known;
        k->terms = 1;
        for (unsigned j = 0; j < 2; j++) {
            const unsigned of = cal->sensor[at].of[j];
            if (of == EXH_GLOVE_NONE) { continue; }
            k->term[k->terms++][m] = own_turn_q32(&cal->sensor[of], pose[p].mean_raw_q16[of]) >> 4;
        }
        code[0] = raw_q16 < code[0] ? raw_q16 : code[0];
        code[1] = raw_q16 > code[1] ? raw_q16 : code[1];
        angle[0] = known < angle[0] ? known : angle[0];
        angle[1] = known > angle[1] ? known : angle[1];
        k->n++;
    }
    fit->poses = (uint8_t)k->n;
    if (k->n <= k->terms || (int64_t)angle[1] - angle[0] < ANGLES_APART_TURN_Q32) {
        return EXH_GLOVE_POSES;
    }
    return (int64_t)code[1] - code[0] < (int64_t)par->move_min_raw * 65536 ? EXH_GLOVE_MOVE
                                                                           : EXH_GLOVE_ERRORS;
}

/* Finds the cross terms from last to first and subtracts each from the angles. */
static unsigned fit_cross(struct known *k, struct exh_glove_sensor *s)
{
    for (unsigned j = 2; j-- > 0;) {
        struct factor f;
        int64_t cross_q30;
        if (s->of[j] == EXH_GLOVE_NONE) { continue; }
        if (last_factor(k, &f, NULL) < 0) { return EXH_GLOVE_POSES; }
        cross_q30 = factor_mul(&f, INT64_C(1) << 30);
        if (cross_q30 > INT32_MAX || cross_q30 < INT32_MIN) { return EXH_GLOVE_CROSS; }
        s->cross_q30[j] = (int32_t)cross_q30;
        k->terms--;
        for (unsigned p = 0; p < k->n; p++) {
            const int64_t share = exh_mul_shr(s->cross_q30[j], k->term[k->terms][p], 30 - 4);
            const int64_t left = k->angle_turn_q32[p] - share;
            if (left > INT32_MAX || left < INT32_MIN) { return EXH_GLOVE_CROSS; } /* no joint */
            k->angle_turn_q32[p] = (int32_t)left;
        }
    }
    return EXH_GLOVE_ERRORS;
}

static int64_t mean(const int32_t *v, unsigned n)
{
    uint64_t sum = (uint64_t)n << 31; /* offset, so never negative */
    for (unsigned p = 0; p < n; p++) { sum += (uint64_t)(int64_t)v[p]; }
    return (int64_t)exh_udiv64(sum, n, NULL) - (INT64_C(1) << 31);
}

/* The gain by a line through the remaining angles, and its zero. */
static unsigned fit_line(struct known *k, struct exh_glove_sensor *s)
{
    struct factor f, inverse;
    int64_t gain, zero_q16;
    if (last_factor(k, &f, &inverse) < 0) { return EXH_GLOVE_GAIN; }
    gain = factor_mul(&f, INT64_C(1) << (38 + 12 - 28)); /* turn q28 over code q12 */
    zero_q16 = mean(k->code_raw_q16, k->n) - factor_mul(&inverse, mean(k->angle_turn_q32, k->n));
    if (gain > INT32_MAX || gain < -INT32_MAX) { return EXH_GLOVE_GAIN; }
    if (zero_q16 > INT32_MAX || zero_q16 < INT32_MIN) { return EXH_GLOVE_ZERO; }
    s->gain_turnpraw_q38 = (int32_t)gain;
    s->zero_raw_q15 = (int32_t)(zero_q16 >> 1);
    return EXH_GLOVE_ERRORS;
}

static unsigned residuals(const struct known *k, const struct exh_glove_sensor *s,
    struct exh_glove_fit *fit, int32_t max_turn_q32)
{
    int64_t worst = -1;
    for (unsigned p = 0; p < k->n; p++) {
        const int32_t left =
            exh_sat32((int64_t)k->angle_turn_q32[p] - own_turn_q32(s, k->code_raw_q16[p]));
        const int64_t size = left < 0 ? -(int64_t)left : left;
        if (size <= worst) { continue; }
        worst = size;
        fit->residual_turn_q32 = left;
        fit->pose = k->pose[p];
    }
    return worst > max_turn_q32 ? EXH_GLOVE_RESIDUAL : EXH_GLOVE_ERRORS;
}

/* The span over all poses, including those without a known angle. */
static void span(
    struct exh_glove_sensor *s, unsigned at, const struct exh_glove_pose *pose, unsigned n)
{
    s->low_raw = INT16_MAX;
    s->high_raw = INT16_MIN;
    for (unsigned p = 0; p < n; p++) {
        const int16_t code = (int16_t)(pose[p].mean_raw_q16[at] >> 16);
        s->low_raw = code < s->low_raw ? code : s->low_raw;
        s->high_raw = code > s->high_raw ? code : s->high_raw;
    }
}

static int has_cross(const struct exh_glove_sensor *s)
{
    return s->of[0] != EXH_GLOVE_NONE || s->of[1] != EXH_GLOVE_NONE;
}

static unsigned fit_sensor(struct exh_glove_cal *cal, struct exh_glove_fit *fit, unsigned at,
    const struct exh_glove_pose *pose, unsigned n, const struct exh_glove_fit_par *par)
{
    struct exh_glove_sensor *s = &cal->sensor[at];
    struct known k;
    unsigned what;
    span(s, at, pose, n);
    what = gather(&k, cal, fit, at, pose, n, par);
    if (what == EXH_GLOVE_ERRORS) { what = fit_cross(&k, s); }
    if (what == EXH_GLOVE_ERRORS) { what = fit_line(&k, s); }
    return what == EXH_GLOVE_ERRORS ? residuals(&k, s, fit, par->residual_max_turn_q32) : what;
}

/* 1 if the other sensors it needs are present, have no cross terms and were fitted. */
static int cross_known(
    const struct exh_glove_cal *cal, const struct exh_glove_fit *fit, unsigned at)
{
    for (unsigned j = 0; j < 2; j++) {
        const unsigned of = cal->sensor[at].of[j];
        if (of == EXH_GLOVE_NONE) { continue; }
        if (of >= EXH_GLOVE_SENSORS || has_cross(&cal->sensor[of]) || !(cal->present >> of & 1) ||
            fit[of].what != EXH_GLOVE_ERRORS) {
            return 0;
        }
    }
    return 1;
}

/* Fits all present sensors with cross terms, or all without. */
static void fit_all(struct exh_glove_cal *cal, struct exh_glove_fit *fit,
    const struct exh_glove_pose *pose, unsigned n, const struct exh_glove_fit_par *par, int cross)
{
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        unsigned what = EXH_GLOVE_CROSS;
        if (!(cal->present >> i & 1) || has_cross(&cal->sensor[i]) != cross) { continue; }
        cal->sensor[i].cross_q30[0] = cal->sensor[i].cross_q30[1] = 0;
        if (cross_known(cal, fit, i)) { what = fit_sensor(cal, &fit[i], i, pose, n, par); }
        if (what == EXH_GLOVE_ERRORS) { what = exh_glove_sensor_validate(cal, i); }
        fit[i].what = (uint8_t)what;
    }
}

int exh_glove_cal_fit(struct exh_glove_cal *cal, struct exh_glove_fit *fit,
    const struct exh_glove_pose *pose, unsigned n, const struct exh_glove_fit_par *par,
    struct exh_glove_error *bad)
{
    struct exh_glove_error first = {EXH_GLOVE_POSES, 0};
    int err = n < 2 || n > EXH_GLOVE_POSES_MAX ? -EXH_E_RANGE : 0;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        fit[i] = (struct exh_glove_fit){0, 0, 0, EXH_GLOVE_ERRORS};
        cal->sensor[i].gain_turnpraw_q38 = cal->sensor[i].zero_raw_q15 = 0;
        cal->sensor[i].low_raw = cal->sensor[i].high_raw = 0;
    }
    if (err == 0) {
        fit_all(cal, fit, pose, n, par, 0);
        fit_all(cal, fit, pose, n, par, 1);
        for (unsigned i = EXH_GLOVE_SENSORS; i-- > 0;) {
            if (fit[i].what == EXH_GLOVE_ERRORS) { continue; }
            first = (struct exh_glove_error){fit[i].what, (uint8_t)i};
            err = -EXH_E_RANGE;
        }
    }
    if (err == 0) { err = exh_glove_cal_validate(cal, &first); }
    if (err < 0) { cal->present = 0; }
    if (err < 0 && bad != NULL) { *bad = first; }
    return err;
}
