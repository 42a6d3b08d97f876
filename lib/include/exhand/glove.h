/* SPDX-License-Identifier: MIT */
/* Glove: 22 A/D codes to 22 joint angles, and the calibration of a user's glove.
 *
 * A frame holds the codes of all sensors. Implausible codes are rejected. The others pass one
 * low-pass and one quantizer and become angles:
 *
 *   own_i = gain_i (code_i - zero_i)          angle_i = own_i + cross_i0 own_a + cross_i1 own_b
 *
 * Cross terms correct abduction sensors, which the flexion of neighbouring knuckles disturbs. Gain,
 * zero and cross terms form the calibration of one user in one glove. A calibration that is
 * damaged, old, implausible or of another user is refused, and the error names the cause.
 *
 *   int err = exh_glove_cal_load(&cal, buf, len_B, &bad);
 *   if (err == 0) { err = exh_glove_setup(&cfg, &par, &cal, (struct exh_period){1, 100}); }
 *   uint32_t faulty = exh_glove_step(&glove, &cfg, &in, angle_turn_q32); // once per frame */
#ifndef EXHAND_GLOVE_H
#define EXHAND_GLOVE_H

#include "exhand/bytes.h"
#include "exhand/filter.h"
#include "exhand/quantizer.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The CyberGlove's sensors in the order of its wires. Flexion angles grow from the flat hand,
 * abduction angles from closed fingers. Each finger abduction is the angle between two fingers. */
enum exh_glove_sensor_id {
    EXH_GLOVE_THUMB_ROTATE,    /* 0: across the palm */
    EXH_GLOVE_THUMB_MPJ,       /* 1: knuckle */
    EXH_GLOVE_THUMB_IJ,        /* 2: tip's joint */
    EXH_GLOVE_THUMB_AB,        /* 3: abduction */
    EXH_GLOVE_INDEX_MPJ,       /* 4: knuckle */
    EXH_GLOVE_INDEX_PIJ,       /* 5: middle joint */
    EXH_GLOVE_INDEX_DIJ,       /* 6: tip's joint */
    EXH_GLOVE_MIDDLE_MPJ,      /* 7: knuckle */
    EXH_GLOVE_MIDDLE_PIJ,      /* 8: middle joint */
    EXH_GLOVE_MIDDLE_DIJ,      /* 9: tip's joint */
    EXH_GLOVE_MIDDLE_INDEX_AB, /* 10: between middle and index */
    EXH_GLOVE_RING_MPJ,        /* 11: knuckle */
    EXH_GLOVE_RING_PIJ,        /* 12: middle joint */
    EXH_GLOVE_RING_DIJ,        /* 13: tip's joint */
    EXH_GLOVE_RING_MIDDLE_AB,  /* 14: between ring and middle */
    EXH_GLOVE_LITTLE_MPJ,      /* 15: knuckle */
    EXH_GLOVE_LITTLE_PIJ,      /* 16: middle joint */
    EXH_GLOVE_LITTLE_DIJ,      /* 17: tip's joint */
    EXH_GLOVE_LITTLE_RING_AB,  /* 18: between little and ring finger */
    EXH_GLOVE_PALM_ARCH,       /* 19: arch of the palm */
    EXH_GLOVE_WRIST_PITCH,     /* 20: wrist, up and down */
    EXH_GLOVE_WRIST_YAW,       /* 21: wrist, sideways */
    EXH_GLOVE_SENSORS          /* number of sensors: 22 */
};

/* The name of a sensor, such as "ThumbRotate". Never NULL. */
const char *exh_glove_sensor_text(unsigned sensor);

/* The frame that a board delivers. */
struct exh_glove_in {
    int16_t raw[EXH_GLOVE_SENSORS]; /* A/D codes; 305 uV each on a +-10 V card */
    uint16_t age_ticks;             /* age of the frame, ticks; 0 = converted for this tick */
};

/* --- parameters --- */

/* Parameters of one glove; rows in exh_glove_rows[]. */
struct exh_glove_par {
    int32_t order;           /* order of the low-pass, 1 or 2; 0 = none */
    int32_t fc_Hz_q16;       /* its cut-off, Hz, below half the frame rate of the glove */
    int32_t bits;            /* stable bits of the card's range, 1 .. 24 */
    int32_t hyst_raw_q16;    /* hysteresis, codes q16, 0 .. 2^(16-bits) codes; against jitter, at
                              * least the peak-to-peak noise after the filter */
    int32_t low_raw;         /* at or below this code, the amplifier is at its lower rail */
    int32_t high_raw;        /* at or above this code, at its upper rail */
    int32_t open_high;       /* 1: an open wire reads high, a short reads low; 0: the reverse */
    int32_t debounce_frames; /* consecutive frames that start or end a fault, 1 .. 255 */
    int32_t margin_q16;      /* allowed excess beyond the calibrated span, as share of it, 0 .. 8 */
};
#define EXH_GLOVE_ROWS 9
extern const struct exh_signal exh_glove_rows[EXH_GLOVE_ROWS];

/* --- calibration --- */

#define EXH_GLOVE_NONE 255 /* no sensor */

/* A user's calibration of one sensor. */
struct exh_glove_sensor {
    int32_t zero_raw_q15;      /* code at which the sensor's own angle is 0, -32768 .. 32767 */
    int32_t gain_turnpraw_q38; /* turn per code, 2^-21 .. 2^-7 in magnitude; < 0: the code falls */
    int32_t cross_q30[2];      /* factors of the own angles of sensors of[0], of[1], each +-2 */
    int16_t low_raw, high_raw; /* lowest and highest code during calibration */
    uint8_t of[2];             /* sensors without cross terms, or EXH_GLOVE_NONE */
};

/* A user's calibration of a glove. Values out of range are refused, never limited. */
struct exh_glove_cal {
    uint32_t user_id, glove_id; /* numbers that the person who calibrates assigns */
    uint32_t day;               /* date, days since 1970-01-01 */
    uint32_t valid_days;        /* valid on days day .. day + valid_days */
    uint32_t present;           /* bit i: sensor i exists. A missing sensor has gain 0, only cross
                                 * terms, and no faults. 0: no calibration */
    struct exh_glove_sensor sensor[EXH_GLOVE_SENSORS]; /* enum exh_glove_sensor_id */
};

/* A default for running without a user's calibration, of no real hand. It uses the end points of
 * one published calibration file (normalised 0 .. 1) at -9 .. 9 V. No cross terms; ids are 0. */
extern const struct exh_glove_cal exh_glove_cal_default;

/* The subject of an error. */
enum exh_glove_error_kind {
    EXH_GLOVE_IMAGE,    /* the bytes of the image */
    EXH_GLOVE_USER,     /* made for another user */
    EXH_GLOVE_GLOVE,    /* made for another glove */
    EXH_GLOVE_AGE,      /* older than valid_days, or from the future */
    EXH_GLOVE_PRESENT,  /* no sensors, or a sensor that does not exist */
    EXH_GLOVE_GAIN,     /* gain is zero or implausible; at: the sensor, also below */
    EXH_GLOVE_ZERO,     /* zero lies beyond the card's range */
    EXH_GLOVE_SPAN,     /* calibrated over fewer than EXH_GLOVE_SPAN_MIN_RAW codes */
    EXH_GLOVE_CROSS,    /* cross term beyond +-2, or of a sensor that cannot have one; in a fit
                         * also: a pose deviates by more than half a turn */
    EXH_GLOVE_POSES,    /* too few poses, or poses that do not separate the terms */
    EXH_GLOVE_MOVE,     /* the hand did not move enough */
    EXH_GLOVE_NOISE,    /* codes varied too much while a pose was held */
    EXH_GLOVE_RESIDUAL, /* a pose lies too far off the fitted line */
    EXH_GLOVE_ERRORS    /* number of kinds; of a sensor: no error */
};
/* The reason why a calibration was refused. */
struct exh_glove_error {
    uint8_t what; /* enum exh_glove_error_kind */
    uint8_t at;   /* the sensor, if the error concerns one */
};

/* The name of a kind, such as "gain". Never NULL. */
const char *exh_glove_error_text(unsigned what);

#define EXH_GLOVE_SPAN_MIN_RAW 64 /* 20 mV: three times the paper's noise */

/* The kind of error of one sensor, 0 .. 21, or EXH_GLOVE_ERRORS if it has none. */
unsigned exh_glove_sensor_validate(const struct exh_glove_cal *cal, unsigned sensor);

/* Checks all ranges. Returns 0, or -EXH_E_RANGE and the reason in *bad; bad may be NULL. */
int exh_glove_cal_validate(const struct exh_glove_cal *cal, struct exh_glove_error *bad);

/* Checks whether the calibration is for this user, glove and day. Returns 0, -EXH_E_RANGE (empty or
 * refused before), -EXH_E_VERSION (another user or glove) or -EXH_E_STALE (age), as in *bad. */
int exh_glove_cal_check(const struct exh_glove_cal *cal, uint32_t user_id, uint32_t glove_id,
    uint32_t day, struct exh_glove_error *bad);

/* Image: "EXHG", version u16, sensors u16, and five u32 in the order above. For each sensor:
 * zero, gain, cross 0, cross 1 (i32), low, high (i16), of 0, of 1 (u8). Last the CRC-32.
 * Little-endian. */
#define EXH_GLOVE_CAL_VERSION 1
#define EXH_GLOVE_CAL_IMAGE_B (8u + 20u + 22u * EXH_GLOVE_SENSORS + 4u)

/* Saves the image. Returns the bytes written, -EXH_E_SHORT, or an error of
 * exh_glove_cal_validate(): it never writes an image that it would refuse to read. */
int32_t exh_glove_cal_save(
    const struct exh_glove_cal *cal, void *buf, size_t cap_B, struct exh_glove_error *bad);

/* Reads and checks a whole image; ignores bytes after it. Returns 0, -EXH_E_SHORT, -EXH_E_VERSION,
 * -EXH_E_CRC, or an error of exh_glove_cal_validate(). After an error, cal->present is 0. */
int exh_glove_cal_load(
    struct exh_glove_cal *cal, const void *buf, size_t len_B, struct exh_glove_error *bad);

/* --- the tick --- */

/* The cause of a channel's fault. */
enum exh_glove_cause {
    EXH_GLOVE_GOOD,    /* no fault */
    EXH_GLOVE_OPEN,    /* at the rail of an open wire */
    EXH_GLOVE_SHORT,   /* at the other rail */
    EXH_GLOVE_OUTSIDE, /* beyond the calibrated span and its margin */
    EXH_GLOVE_CAUSES   /* number of causes */
};
const char *exh_glove_cause_text(unsigned cause); /* name, such as "open"; never NULL */

/* Set-up of a glove; constant in the tick. */
struct exh_glove_cfg {
    const struct exh_glove_cal *cal;    /* the caller's */
    struct exh_filter_cfg filter;       /* of all channels; unset at order 0 */
    struct exh_quantizer_cfg quantizer; /* of all channels */
    int16_t lo_raw[EXH_GLOVE_SENSORS], hi_raw[EXH_GLOVE_SENSORS]; /* accepted codes */
    int16_t low_raw, high_raw;                                    /* the rails */
    uint8_t low_cause, high_cause;                                /* causes at the rails */
    uint8_t debounce_frames;                                      /* the parameter */
    uint8_t order;                                                /* the parameter; 0: no filter */
    uint8_t crossed[EXH_GLOVE_SENSORS]; /* sensors with cross terms, in order */
    uint8_t crosses;                    /* their number */
};

/* State of a glove. All zeros: no frame yet. */
struct exh_glove {
    struct exh_filter filter[EXH_GLOVE_SENSORS];       /* low-pass of codes, q16 */
    struct exh_quantizer quantizer[EXH_GLOVE_SENSORS]; /* quantizer of the low-pass's output */
    int16_t good_raw[EXH_GLOVE_SENSORS];               /* last accepted code: the filter's input */
    uint16_t faults[EXH_GLOVE_SENSORS];                /* number of faults; stays at 65535 */
    uint8_t run[EXH_GLOVE_SENSORS];   /* consecutive frames that contradict cause */
    uint8_t cause[EXH_GLOVE_SENSORS]; /* enum exh_glove_cause */
    uint8_t started;                  /* 1 after the first frame, which settles all filters */
};

/* Set-up (divides); cal must outlive cfg. T is the time between frames of the glove, which may be
 * several ticks of the loop. -EXH_E_CUTOFF: fc at or above half the frame rate. -EXH_E_RATE: no
 * period. -EXH_E_RANGE: a parameter outside its row, more hysteresis than a step, low_raw not below
 * high_raw, an invalid calibration, or a calibrated span that touches a rail. */
int exh_glove_setup(struct exh_glove_cfg *cfg, const struct exh_glove_par *par,
    const struct exh_glove_cal *cal, struct exh_period T);

/* Processes one new frame; *s is all zeros before the first. Call it once per frame, not per tick;
 * between frames, keep the angles. angle_turn_q32[22] are saturated to +-1/2 turn, since a joint
 * does not wrap. Returns bit i for a faulty sensor i; s->cause[i] gives the cause. A fault only
 * sets this bit. All other channels continue; cross terms use the held angle.
 *
 * A code at a rail or beyond the span's margin is rejected. The last accepted code replaces it at
 * the filter's input, so a spike has no effect. After debounce_frames consecutive rejected codes
 * the channel is faulty. Its angle settles at the last accepted code. After debounce_frames good
 * codes the fault ends. The angle then follows the filter's step response without a jump.
 * - A bad code in the first frame is a fault in that frame. The code of angle 0, or the nearer end
 *   of the calibrated span, replaces it.
 *
 * The error of an angle is (Q + H)/2 of the quantizer times the gain, plus 1/2 LSB per term. The
 * cost depends on the order and the number of cross terms. A channel with rejected codes costs some
 * 20 instructions more, and each sensor after it some 7. in->age_ticks is not read. */
uint32_t exh_glove_step(struct exh_glove *s, const struct exh_glove_cfg *cfg,
    const struct exh_glove_in *in, int32_t *angle_turn_q32);

/* exh_glove_step() in parts, for a frame that is processed over several ticks. The results have the
 * same bits. One array of 22 passes through all parts; its codes become angles. First call
 * exh_glove_believe(): it accepts codes and returns the faulty sensors. Then exh_glove_angles() for
 * sensors from .. to - 1, in any division; both at most 22; does nothing if from >= to. Last
 * exh_glove_cross() for all cross terms. */
uint32_t exh_glove_believe(struct exh_glove *s, const struct exh_glove_cfg *cfg,
    const struct exh_glove_in *in, int32_t *code_raw_q16);
void exh_glove_angles(struct exh_glove *s, const struct exh_glove_cfg *cfg, unsigned from,
    unsigned to, int32_t *angle_turn_q32);
void exh_glove_cross(const struct exh_glove_cfg *cfg, int32_t *angle_turn_q32);

/* State through a cursor (bytes.h). */
void exh_glove_serialize(struct exh_bytes *c, struct exh_glove *s);

/* --- calibration from poses --- */

#define EXH_GLOVE_POSES_MAX 16 /* sums of products stay within 2^62 */

/* A pose in which the hand was held still: its known angles and measured codes. */
struct exh_glove_pose {
    uint32_t known;                            /* bit i: the angle of sensor i is known */
    int32_t angle_turn_q32[EXH_GLOVE_SENSORS]; /* angles of the known sensors */
    int32_t mean_raw_q16[EXH_GLOVE_SENSORS];   /* mean code */
    int32_t noise_raw[EXH_GLOVE_SENSORS];      /* highest less lowest code */
};

/* Limits within which a fit is accepted. */
struct exh_glove_fit_par {
    int32_t move_min_raw;          /* smallest difference of codes between two poses */
    int32_t noise_max_raw;         /* largest noise_raw of a pose */
    int32_t residual_max_turn_q32; /* largest residual of a pose */
};
extern const struct exh_glove_fit_par exh_glove_fit_default; /* 256 codes, 128 codes, 6 deg */

/* Result of the fit for one sensor. */
struct exh_glove_fit {
    int32_t residual_turn_q32; /* worst residual: known minus fitted angle */
    uint8_t pose;              /* index of that pose */
    uint8_t poses;             /* number of poses that know the angle */
    uint8_t what;              /* enum exh_glove_error_kind; EXH_GLOVE_ERRORS: no error */
};

/* Fits a calibration by least squares to n poses: gain and zero of each present sensor, and the
 * cross terms of sensors with of[]. Cross terms use the fitted angles of the other sensors. Two
 * poses determine gain and zero. Each cross term needs one more, in which the other sensor moves.
 *
 * On entry *cal holds ids, day, present and of[]; on return also the rest. Missing sensors keep
 * their cross terms. low and high become the extreme means of all poses. fit[22] receives one
 * result per sensor. Returns 0, or -EXH_E_RANGE with the first bad sensor in *bad (may be NULL),
 * and sets present to 0. n outside 2 .. EXH_GLOVE_POSES_MAX is the error EXH_GLOVE_POSES. The
 * deviation from exact least squares is below 2^-12 of the span. Set-up only (divides). */
int exh_glove_cal_fit(struct exh_glove_cal *cal, struct exh_glove_fit *fit,
    const struct exh_glove_pose *pose, unsigned n, const struct exh_glove_fit_par *par,
    struct exh_glove_error *bad);

#ifdef __cplusplus
}
#endif
#endif
