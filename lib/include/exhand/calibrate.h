/* SPDX-License-Identifier: MIT */
/* Calibration: what was measured on one finger, the tables made of it, its image.
 *
 * The paper's first step: known forces (masses, F = m g) give the table from force
 * to current and the one from the current monitor to force. Stored are the measured
 * points, not the tables: residuals and friction can be computed again, and both
 * tables come from one source. probe.h has the motions that measure the points.
 * A calibration that is damaged, old, another device's, or that does not rise is
 * refused, and the name of what is wrong with it is told.
 */
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

/* A mean on its way. All zeros: of none. */
struct exh_mean {
    int64_t sum; /* of the values, exact, |sum| <= n 2^31 */
    uint32_t n;  /* < 2^31: |sum| stays below 2^62 */
};

/* One value; after 2^31-1 of them further ones are ignored. */
void exh_mean_add(struct exh_mean *m, int32_t v);

/* floor(sum / n + 1/2), error <= 1/2 LSB, any unit; 0 of none. Divides: 64 steps. */
int32_t exh_mean_value(const struct exh_mean *m);

/* --- points --- */

#define EXH_CALIB_POINTS_MAX 16 /* sums of squares stay below 2^63 */

/* What one mass gave. Force over either current is 0.1 .. 2047 N/A. */
struct exh_calib_point {
    int32_t force_N_q20;    /* known force m g, N, > 0 .. 100 */
    int32_t cur_A_q26;      /* coded current that balances it, A, > 0 .. 6.6 */
    int32_t mon_A_q26;      /* its mean by the monitor, A, > 0 .. 10 */
    int32_t friction_A_q26; /* half of what friction holds, A, 0 .. 6.6 */
};

/* Which of a point's two currents. */
enum exh_calib_column {
    EXH_CALIB_CURRENT, /* cur_A_q26, coded */
    EXH_CALIB_MONITOR  /* mon_A_q26, monitored */
};

/* The straight line through the origin nearest to n points: least squares of force,
 * N per A = sum(F I) / sum(I^2), relative error of the division 2^-31. */
struct exh_calib_fit {
    struct exh_gain gain; /* force raw per current raw */
    int32_t kf_NpA_q20;   /* N/A; error <= 1 LSB */
};

/* -EXH_E_RANGE: n not 1 .. EXH_CALIB_POINTS_MAX, a value outside its range above, as is
 * its force over current. Set-up only (divides). */
int exh_calib_fit(struct exh_calib_fit *fit, const struct exh_calib_point *p, unsigned n,
    enum exh_calib_column which);

/* F - kf I of one point, N q20, error <= 1 LSB + 2^-31 of F; saturates at +-2048 N. */
int32_t exh_calib_residual_N_q20(
    const struct exh_calib_fit *fit, const struct exh_calib_point *p, enum exh_calib_column which);

/* --- a calibration of one finger --- */

#define EXH_CALIB_VALID_MAX_DAYS 366 /* a year: cables, sheaths and motors age */

/* A calibration of one finger. What is out of range is refused, never limited. */
struct exh_calib {
    uint32_t device_id;    /* of the box, given by whoever calibrates */
    uint32_t finger;       /* 0 .. EXH_FINGERS - 1 */
    uint32_t day;          /* when: days since 1970-01-01, or any serial number that grows */
    uint32_t valid_days;   /* good on days day .. day + valid_days, 0 .. EXH_CALIB_VALID_MAX_DAYS */
    int32_t dac_rawpA_q16; /* scales and zero it was measured with (exh_drive_par): with
                            * others it is no longer true. Codes per ampere */
    int32_t dac_zero_raw;  /* code of no current, 0 .. 65535 */
    int32_t mon_A_q40;     /* ampere per monitor code */
    int32_t mon_zero_raw;  /* monitor code at no current as measured, -32768 .. 32767: the
                            * points are less this, so whoever uses the monitor table
                            * must copy it to the drive's mon_zero_raw */
    int32_t f0_A_q26;      /* current at which the slack string returns, A, 0 .. 6.6 */
    int32_t end_A_q26;     /* tables go on straight to here, A; at or below the last
                            * point: they end there. 0 .. 6.6 */
    struct exh_calib_point *point; /* the caller's, in order of rising force */
    uint8_t points;                /* how many are used */
    uint8_t cap;                   /* how many there is room for */
};

/* What an error is about. */
enum exh_calib_error_kind {
    EXH_CALIB_IMAGE,       /* the bytes */
    EXH_CALIB_DEVICE,      /* it was made for another one */
    EXH_CALIB_FINGER,      /* or for another finger of it */
    EXH_CALIB_AGE,         /* older than valid_days, or from the future */
    EXH_CALIB_SCALE,       /* scale or zero of D/A or monitor differ from those it was made with */
    EXH_CALIB_VALUE,       /* zero, F0, end or number of points */
    EXH_CALIB_FORCE_TABLE, /* force -> current; at: the point */
    EXH_CALIB_MONITOR_TABLE, /* monitor -> force; at: the point */
    EXH_CALIB_VALIDITY,      /* valid_days above EXH_CALIB_VALID_MAX_DAYS */
    EXH_CALIB_FAR_CURRENT, /* force over coded current, far from what is expected; at: the point */
    EXH_CALIB_FAR_MONITOR, /* the same over the monitored one */
    EXH_CALIB_FAR_FINGERS, /* either, far from the median of the fingers; at: the point */
    EXH_CALIB_ERRORS       /* how many there are */
};
/* The culprit: why a calibration was refused. */
struct exh_calib_error {
    uint8_t what; /* enum exh_calib_error_kind */
    uint8_t at;   /* point, from 0, for the tables and what is far */
};

/* "force-to-current table", ...; never NULL. */
const char *exh_calib_error_text(unsigned what);

/* Knots for exh_drive_setup(): through the origin and all points, and straight on to
 * end_A (along the fitted line's slope) where that lies beyond them; the monitor's to the
 * last point's monitored current + (end_A - its current), <= 16.6 A, along its own line's.
 * The monitor's is odd: it reads through zero. Returns how many knots, or -EXH_E_MONOTONE,
 * -EXH_E_RANGE (with *bad, may be NULL, the culprit), -EXH_E_SHORT (cap too small;
 * points + 2 and 2 points + 3 always do). Exact at every point. Set-up only (divides). */
int exh_calib_force_table(
    const struct exh_calib *c, struct exh_knot *knot, unsigned cap, struct exh_calib_error *bad);
int exh_calib_monitor_table(
    const struct exh_calib *c, struct exh_knot *knot, unsigned cap, struct exh_calib_error *bad);

/* All of it: values in range, validity, and both tables as above. 0 or the error. */
int exh_calib_validate(const struct exh_calib *c, struct exh_calib_error *bad);

/* Force over current of one point, N/A q20, rounded down; saturates, as above 0 A. 0 where the
 * current is none. Set-up only (divides). */
int32_t exh_calib_ratio_NpA_q20(const struct exh_calib_point *p, enum exh_calib_column which);

/* Is force over either current within half of kf, so 1/2 .. 3/2 of it, at every point? Between two
 * points a table's ratio lies between theirs. Beyond the last it lies between that and the line's.
 * So it holds everywhere: if kf is right, no force is above twice what is asked. For points that
 * were validated and kf 0 .. 512 N/A. 0, or -EXH_E_RANGE with *bad (may be NULL) FAR_CURRENT or
 * FAR_MONITOR and the point. No division. */
int exh_calib_near(const struct exh_calib *c, int32_t kf_NpA_q20, struct exh_calib_error *bad);

/* Where and when it is to be used. */
struct exh_calib_target {
    uint32_t device_id, finger, day; /* this box, this finger of it, today; as in exh_calib */
    int32_t dac_rawpA_q16, dac_zero_raw, mon_A_q40; /* of the drive parameters in use */
    int32_t mon_zero_raw; /* likewise, after copying the calibration's: without, it's stale */
};

/* May it be used here and today? -EXH_E_RANGE (no points: nothing was loaded, or it was
 * refused), -EXH_E_VERSION (another device, another finger) or -EXH_E_STALE (age, scales,
 * zeros); *bad tells which. It does not look at the points: exh_calib_load() has. */
int exh_calib_check(
    const struct exh_calib *c, const struct exh_calib_target *here, struct exh_calib_error *bad);

/* --- image ---
 *
 * "EXHC", version u16, points u16, ten values of 4 bytes in the order above, points of four i32,
 * CRC-32 of all before it; little-endian. */

#define EXH_CALIB_VERSION 2                                            /* 1 had no dac_zero_raw */
#define EXH_CALIB_IMAGE_B (8u + 40u + 16u * EXH_CALIB_POINTS_MAX + 4u) /* the largest */

/* Bytes written, or -EXH_E_SHORT; or what exh_calib_validate() refuses: nothing that
 * could not be read again is written. */
int32_t exh_calib_save(
    const struct exh_calib *c, void *buf, size_t cap_B, struct exh_calib_error *bad);

/* Reads and checks a whole image; bytes behind it are ignored. c->point and c->cap
 * are the caller's. -EXH_E_SHORT (also: more points than cap), -EXH_E_VERSION,
 * -EXH_E_CRC, or what exh_calib_validate() refuses; then c->points is 0. */
int exh_calib_load(struct exh_calib *c, const void *buf, size_t len_B, struct exh_calib_error *bad);

#ifdef __cplusplus
}
#endif
#endif
