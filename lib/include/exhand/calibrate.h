/* SPDX-License-Identifier: MIT */
/* Calibration: the measured points of one finger, the tables made from them, and their image.
 *
 * The first step of the paper: known forces (masses, F = m g) give the table from force to current
 * and the one from monitor current to force. The image stores the measured points, not the tables.
 * So residuals and friction can be recomputed, and both tables have one source. probe.h contains
 * the motions that measure the points. A calibration that is damaged, old, of another device or not
 * rising is refused, and the error names the cause.
 *
 *   int err = exh_calib_load(&calib, buf, len_B, &bad);
 *   if (err == 0) { err = exh_calib_check(&calib, &here, &bad); }
 *   int n = err == 0 ? exh_calib_force_table(&calib, knot, cap, &bad) : err; */
#ifndef EXHAND_CALIBRATE_H
#define EXHAND_CALIBRATE_H

#include "exhand/fix.h"
#include "exhand/table.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- mean: exact sum, one rounding --- */

/* A running mean. All zeros: empty. */
struct exh_mean {
    int64_t sum; /* exact sum of the values, |sum| <= n 2^31 */
    uint32_t n;  /* < 2^31: |sum| stays below 2^62 */
};

/* Adds one value. Ignores all values after 2^31-1. */
void exh_mean_add(struct exh_mean *m, int32_t v);

/* floor(sum / n + 1/2) in the unit of the values, error <= 1/2 LSB; 0 if empty. Divides. */
int32_t exh_mean_value(const struct exh_mean *m);

/* --- points --- */

#define EXH_CALIB_POINTS_MAX 16 /* sums of squares stay below 2^63 */

/* Measurement with one mass. Force divided by either current is 0.1 .. 2047 N/A. */
struct exh_calib_point {
    int32_t force_N_q20;    /* known force m g, N, > 0 .. 100 */
    int32_t cur_A_q26;      /* coded current that balances the force, A, > 0 .. 6.6 */
    int32_t mon_A_q26;      /* mean monitor current, A, > 0 .. 10 */
    int32_t friction_A_q26; /* half of the current range that friction holds, A, 0 .. 6.6 */
};

/* The choice between the two currents of a point. */
enum exh_calib_column {
    EXH_CALIB_CURRENT, /* cur_A_q26, coded */
    EXH_CALIB_MONITOR  /* mon_A_q26, monitored */
};

/* The line through the origin that fits n points best: least squares of force, N per A = sum(F I) /
 * sum(I^2). The relative error of the division is 2^-31. */
struct exh_calib_fit {
    struct exh_gain gain; /* force LSB per current LSB */
    int32_t kf_NpA_q20;   /* N/A; error <= 1 LSB */
};

/* Fits the line to p[n]. -EXH_E_RANGE: n not 1 .. EXH_CALIB_POINTS_MAX, or a value or ratio outside
 * its range above. Set-up only (divides). */
int exh_calib_fit(struct exh_calib_fit *fit, const struct exh_calib_point *p, unsigned n,
    enum exh_calib_column which);

/* The residual F - kf I of one point, N q20. Error <= 1 LSB + 2^-31 of F; saturates at +-2048 N. */
int32_t exh_calib_residual_N_q20(
    const struct exh_calib_fit *fit, const struct exh_calib_point *p, enum exh_calib_column which);

/* --- a calibration of one finger --- */

#define EXH_CALIB_VALID_MAX_DAYS 366 /* one year: cables, sheaths and motors age */

/* A calibration of one finger. Values out of range are refused, never limited. */
struct exh_calib {
    uint32_t device_id;    /* id of the device, assigned by the person who calibrates */
    uint32_t finger;       /* 0 .. EXH_FINGERS - 1 */
    uint32_t day;          /* date: days since 1970-01-01, or any growing serial number */
    uint32_t valid_days;   /* valid until day + this, 0 .. EXH_CALIB_VALID_MAX_DAYS */
    int32_t dac_rawpA_q16; /* codes per ampere. This and the next three must equal the drive's
                            * (exh_drive_par), else the calibration is invalid */
    int32_t dac_zero_raw;  /* code of 0 A, 0 .. 65535 */
    int32_t mon_A_q40;     /* ampere per monitor code */
    int32_t mon_zero_raw;  /* measured monitor code at 0 A, -32768 .. 32767. Copy it to the drive's
                            * mon_zero_raw to use the monitor table */
    int32_t f0_A_q26;      /* current that winds in the slack string, A, 0 .. 6.6 */
    int32_t end_A_q26;     /* tables extend to here, or to the last point if higher, A, 0 .. 6.6 */
    struct exh_calib_point *point; /* the caller's array of length cap, by rising force */
    uint8_t points;                /* points in use */
    uint8_t cap;                   /* length of the array */
};

/* The subject of an error. */
enum exh_calib_error_kind {
    EXH_CALIB_IMAGE,         /* the bytes of the image */
    EXH_CALIB_DEVICE,        /* made for another device */
    EXH_CALIB_FINGER,        /* made for another finger */
    EXH_CALIB_AGE,           /* older than valid_days, or from the future */
    EXH_CALIB_SCALE,         /* scales or zeros of D/A or monitor have changed */
    EXH_CALIB_VALUE,         /* zero, F0, end or number of points */
    EXH_CALIB_FORCE_TABLE,   /* force -> current; at: the point */
    EXH_CALIB_MONITOR_TABLE, /* monitor -> force; at: the point */
    EXH_CALIB_VALIDITY,      /* valid_days above EXH_CALIB_VALID_MAX_DAYS */
    EXH_CALIB_FAR_CURRENT,   /* force per coded current is implausible; at: the point */
    EXH_CALIB_FAR_MONITOR,   /* force per monitor current is implausible; at: the point */
    EXH_CALIB_FAR_FINGERS,   /* either ratio is far from the median of the fingers; at: the point */
    EXH_CALIB_ERRORS         /* number of kinds */
};
/* The reason why a calibration was refused. */
struct exh_calib_error {
    uint8_t what; /* enum exh_calib_error_kind */
    uint8_t at;   /* index of the point, for tables and ratios */
};

/* The name of a kind, such as "force-to-current table". Never NULL. */
const char *exh_calib_error_text(unsigned what);

/* Makes the knots for exh_drive_setup(), exact at every point. The force table runs through 0 and
 * all points, then with the fitted line's slope to end_A. The monitor table continues also, to the
 * last point's monitor current + (end_A - its current), <= 16.6 A. It is odd: currents may be < 0.
 *
 * Returns the number of knots or an error: -EXH_E_MONOTONE, -EXH_E_RANGE, -EXH_E_SHORT (cap too
 * small; points + 2 and 2 points + 3 suffice). *bad, if not NULL, has the reason. Set-up only. */
int exh_calib_force_table(
    const struct exh_calib *c, struct exh_knot *knot, unsigned cap, struct exh_calib_error *bad);
int exh_calib_monitor_table(
    const struct exh_calib *c, struct exh_knot *knot, unsigned cap, struct exh_calib_error *bad);

/* Checks ranges, validity and both tables. Returns 0 or the error as above. */
int exh_calib_validate(const struct exh_calib *c, struct exh_calib_error *bad);

/* Force divided by the current of one point, N/A q20, rounded down, saturating. 0 if the current is
 * not above 0. Set-up only (divides). */
int32_t exh_calib_ratio_NpA_q20(const struct exh_calib_point *p, enum exh_calib_column which);

/* Checks that force divided by either current is within 1/2 .. 3/2 of kf at every point. The ratio
 * of a table between two points lies between theirs, and beyond the last between it and the line's.
 * So if kf is right, no force exceeds twice the request. Requires validated points and kf 0 .. 512
 * N/A. Returns 0, or -EXH_E_RANGE with FAR_CURRENT or FAR_MONITOR and the point in *bad (may be
 * NULL). Does not divide. */
int exh_calib_near(const struct exh_calib *c, int32_t kf_NpA_q20, struct exh_calib_error *bad);

/* Place and time of use. */
struct exh_calib_target {
    uint32_t device_id, finger, day; /* this device, this finger, today; as in exh_calib */
    int32_t dac_rawpA_q16, dac_zero_raw, mon_A_q40; /* drive parameters in use */
    int32_t mon_zero_raw;                           /* the same, after copying the calibration's */
};

/* Checks whether the calibration may be used here and today. Returns 0, -EXH_E_RANGE (empty or
 * refused before), -EXH_E_VERSION (another device or finger) or -EXH_E_STALE (age, scales, zeros);
 * *bad gives the reason. Does not check the points, since exh_calib_load() does. */
int exh_calib_check(
    const struct exh_calib *c, const struct exh_calib_target *here, struct exh_calib_error *bad);

/* --- image ---
 *
 * "EXHC", version u16, points u16, ten 4-byte values in the order above, four i32 per point, CRC-32
 * of all bytes before. Little-endian. */

#define EXH_CALIB_VERSION 2                                            /* 1 lacks dac_zero_raw */
#define EXH_CALIB_IMAGE_B (8u + 40u + 16u * EXH_CALIB_POINTS_MAX + 4u) /* largest size */

/* Saves the image. Returns the bytes written, -EXH_E_SHORT, or an error of exh_calib_validate(): it
 * never writes an image that it would refuse to read. */
int32_t exh_calib_save(
    const struct exh_calib *c, void *buf, size_t cap_B, struct exh_calib_error *bad);

/* Reads and checks a whole image; ignores bytes after it. The caller provides c->point and c->cap.
 * Returns 0, -EXH_E_SHORT (also for more points than cap), -EXH_E_VERSION, -EXH_E_CRC, or an error
 * of exh_calib_validate(). After an error, c->points is 0. */
int exh_calib_load(struct exh_calib *c, const void *buf, size_t len_B, struct exh_calib_error *bad);

#ifdef __cplusplus
}
#endif
#endif
