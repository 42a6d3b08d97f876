/* SPDX-License-Identifier: MIT */
/* Glove: 22 A/D codes to 22 joint angles, and the calibration of a user's glove.
 *
 * One frame of all sensors at a time: codes that no hand gives are kept out, the rest
 * goes through one low-pass and one quantizer (stable bits) and becomes an angle:
 *
 *   own_i = gain_i (code_i - zero_i)          angle_i = own_i + cross_i0 own_a + cross_i1 own_b
 *
 * The cross terms are for abduction sensors, which the flexion of the knuckles beside them
 * pulls along. Gain, zero and cross terms belong to a user in a glove: a calibration.
 * One that is damaged, old, somebody else's or implausible is refused, and the name of
 * what is wrong with it is told.
 */
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

/* The CyberGlove's sensors in the order of its wires. Flexion counts up from the flat hand,
 * abduction from fingers together; the three abductions of fingers are between two of them. */
enum exh_glove_sensor_id {
    EXH_GLOVE_THUMB_ROTATE,    /* 0: across the palm */
    EXH_GLOVE_THUMB_MPJ,       /* 1: knuckle */
    EXH_GLOVE_THUMB_IJ,        /* 2: tip's joint */
    EXH_GLOVE_THUMB_AB,        /* 3: aside */
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
    EXH_GLOVE_PALM_ARCH,       /* 19: of the palm */
    EXH_GLOVE_WRIST_PITCH,     /* 20: of the wrist, up and down */
    EXH_GLOVE_WRIST_YAW,       /* 21: of the wrist, aside */
    EXH_GLOVE_SENSORS          /* how many there are: 22 */
};

/* "ThumbRotate", ...; never NULL. */
const char *exh_glove_sensor_text(unsigned sensor);

/* What a board delivers. */
struct exh_glove_in {
    int16_t raw[EXH_GLOVE_SENSORS]; /* A/D codes, +-10 V card: 305 uV each */
    uint16_t age_ticks;             /* 0 = converted for this tick */
};

/* --- parameters --- */

/* Parameters of one glove; rows in exh_glove_rows[]. */
struct exh_glove_par {
    int32_t order;           /* of the low-pass: 1, 2; 0 = none */
    int32_t fc_Hz_q16;       /* its cut-off, below half the glove's own rate */
    int32_t bits;            /* stable bits of the card's range, 1 .. 24 */
    int32_t hyst_raw_q16;    /* hysteresis, codes q16, at most a step of 2^(16-bits)
                              * codes; at or above the noise's peak to peak behind
                              * the filter: an angle moves once and stays */
    int32_t low_raw;         /* a code at or below: the amplifier is at its lower rail */
    int32_t high_raw;        /* a code at or above: at its upper */
    int32_t open_high;       /* 1: an open wire reads high, a short low; 0: the other way */
    int32_t debounce_frames; /* that many frames in a row make and end a fault, 1 .. 255 */
    int32_t margin_q16;      /* a code may leave the calibrated span by this share of it, 0 .. 8 */
};
#define EXH_GLOVE_ROWS 9
extern const struct exh_signal exh_glove_rows[EXH_GLOVE_ROWS];

/* --- calibration --- */

#define EXH_GLOVE_NONE 255 /* no sensor */

/* A user's calibration of one sensor. */
struct exh_glove_sensor {
    int32_t zero_raw_q15;      /* code at which its own angle is 0, -32768 .. 32767 */
    int32_t gain_turnpraw_q38; /* turn per code, 2^-21 .. 2^-7 either way; < 0: falls */
    int32_t cross_q30[2];      /* of the own angle of of[0], of[1], each +-2 */
    int16_t low_raw, high_raw; /* lowest and highest code when it was calibrated */
    uint8_t of[2];             /* sensors without cross terms, or EXH_GLOVE_NONE */
};

/* A user's calibration of a glove. What is out of range is refused, never limited. */
struct exh_glove_cal {
    uint32_t user_id, glove_id; /* given by whoever calibrates */
    uint32_t day;               /* when: days since 1970-01-01 */
    uint32_t valid_days;        /* good on days day .. day + valid_days */
    uint32_t present;           /* bit i: there is a sensor i. Where not, its gain is 0, so
                                 * its angle is what cross terms make it, and it has no
                                 * faults. 0: no calibration */
    struct exh_glove_sensor sensor[EXH_GLOVE_SENSORS]; /* enum exh_glove_sensor_id */
};

/* To run without a user's: nobody's hand, end points of one published calibration file
 * (normalised 0 .. 1) at -9 .. 9 V; no cross terms. user_id and glove_id are 0. */
extern const struct exh_glove_cal exh_glove_cal_default;

/* What an error is about. */
enum exh_glove_error_kind {
    EXH_GLOVE_IMAGE,    /* the bytes */
    EXH_GLOVE_USER,     /* made for another user */
    EXH_GLOVE_GLOVE,    /* or another glove */
    EXH_GLOVE_AGE,      /* older than valid_days, or from the future */
    EXH_GLOVE_PRESENT,  /* no sensors, or one that there is none of */
    EXH_GLOVE_GAIN,     /* zero or implausible; at: the sensor, also below */
    EXH_GLOVE_ZERO,     /* its zero lies beyond the card's range */
    EXH_GLOVE_SPAN,     /* calibrated over fewer than EXH_GLOVE_SPAN_MIN_RAW codes */
    EXH_GLOVE_CROSS,    /* cross term beyond +-2, or of no sensor to have one of; in a fit
                         * also one that a pose leaves more than half a turn after */
    EXH_GLOVE_POSES,    /* too few poses, or poses that do not tell its terms apart */
    EXH_GLOVE_MOVE,     /* the hand did not move enough */
    EXH_GLOVE_NOISE,    /* codes varied too much while a pose was held */
    EXH_GLOVE_RESIDUAL, /* a pose lies too far off the line through all */
    EXH_GLOVE_ERRORS    /* how many there are; of a sensor: nothing is wrong */
};
/* The culprit: why a calibration was refused. */
struct exh_glove_error {
    uint8_t what; /* enum exh_glove_error_kind */
    uint8_t at;   /* sensor, where it is about one */
};

/* "gain", ...; never NULL. */
const char *exh_glove_error_text(unsigned what);

#define EXH_GLOVE_SPAN_MIN_RAW 64 /* 20 mV: three times the paper's noise */

/* What is wrong with one sensor, 0 .. 21, of it; EXH_GLOVE_ERRORS: nothing. */
unsigned exh_glove_sensor_validate(const struct exh_glove_cal *cal, unsigned sensor);

/* Values in range? 0, or -EXH_E_RANGE with *bad (may be NULL) the culprit. */
int exh_glove_cal_validate(const struct exh_glove_cal *cal, struct exh_glove_error *bad);

/* May it be used for this user, glove and day? -EXH_E_RANGE (nothing loaded, or refused),
 * -EXH_E_VERSION (another user, another glove), -EXH_E_STALE (age); *bad tells which. */
int exh_glove_cal_check(const struct exh_glove_cal *cal, uint32_t user_id, uint32_t glove_id,
    uint32_t day, struct exh_glove_error *bad);

/* Image: "EXHG", version u16, sensors u16, five u32 in the order above, then of each
 * sensor zero, gain, cross 0, cross 1 (i32), low, high (i16), of 0, of 1 (u8), CRC-32 of
 * all before it; little-endian. */
#define EXH_GLOVE_CAL_VERSION 1
#define EXH_GLOVE_CAL_IMAGE_B (8u + 20u + 22u * EXH_GLOVE_SENSORS + 4u)

/* Bytes written, or -EXH_E_SHORT; or what exh_glove_cal_validate() refuses: nothing that
 * could not be read again is written. */
int32_t exh_glove_cal_save(
    const struct exh_glove_cal *cal, void *buf, size_t cap_B, struct exh_glove_error *bad);

/* Reads and checks a whole image; bytes behind it are ignored. -EXH_E_SHORT,
 * -EXH_E_VERSION, -EXH_E_CRC, or what exh_glove_cal_validate() refuses; then present is 0. */
int exh_glove_cal_load(
    struct exh_glove_cal *cal, const void *buf, size_t len_B, struct exh_glove_error *bad);

/* --- the tick --- */

/* Why a channel is not believed. */
enum exh_glove_cause {
    EXH_GLOVE_GOOD,    /* it is believed */
    EXH_GLOVE_OPEN,    /* at the rail that an open wire goes to */
    EXH_GLOVE_SHORT,   /* at the other rail */
    EXH_GLOVE_OUTSIDE, /* beyond the calibrated span and its margin */
    EXH_GLOVE_CAUSES   /* how many there are */
};
const char *exh_glove_cause_text(unsigned cause); /* "open", ...; never NULL */

/* A glove as it is set up; constant in the tick. */
struct exh_glove_cfg {
    const struct exh_glove_cal *cal;    /* the caller's */
    struct exh_filter_cfg filter;       /* of all channels; not made at order 0 */
    struct exh_quantizer_cfg quantizer; /* of all channels */
    int16_t lo_raw[EXH_GLOVE_SENSORS], hi_raw[EXH_GLOVE_SENSORS]; /* codes that are believed */
    int16_t low_raw, high_raw;                                    /* the rails */
    uint8_t low_cause, high_cause;                                /* what a code there means */
    uint8_t debounce_frames;                                      /* the parameter, 1 .. 255 */
    uint8_t order;                      /* the parameter; 0: the filter is left out */
    uint8_t crossed[EXH_GLOVE_SENSORS]; /* those with cross terms, in order */
    uint8_t crosses;                    /* how many */
};

/* A glove from frame to frame. A state of zeros has seen none. */
struct exh_glove {
    struct exh_filter filter[EXH_GLOVE_SENSORS];       /* of codes q16 */
    struct exh_quantizer quantizer[EXH_GLOVE_SENSORS]; /* of the filter's output */
    int16_t good_raw[EXH_GLOVE_SENSORS]; /* last code that was believed: the filter's input */
    uint16_t faults[EXH_GLOVE_SENSORS];  /* how often it became faulty; stays at 65535 */
    uint8_t run[EXH_GLOVE_SENSORS];      /* frames in a row that speak against `cause` */
    uint8_t cause[EXH_GLOVE_SENSORS];    /* enum exh_glove_cause */
    uint8_t started;                     /* the first frame settles all */
};

/* Set-up (divides); cal must outlive cfg. T is the time between frames, which is the
 * glove's own and may be several ticks of the loop. -EXH_E_CUTOFF: fc at or above half its
 * rate. -EXH_E_RATE: no period. -EXH_E_RANGE: a parameter outside its row, more hysteresis than a
 * step, low_raw not below high_raw, what exh_glove_cal_validate() refuses, or a calibrated span
 * that touches a rail. */
int exh_glove_setup(struct exh_glove_cfg *cfg, const struct exh_glove_par *par,
    const struct exh_glove_cal *cal, struct exh_period T);

/* One new frame; *s is zero before the first. Call it once a frame, not once a tick: with
 * an older frame that was seen before, keep the angles. 22 angles, turn_q32, +-1/2 turn:
 * beyond, they saturate (a joint does not wrap). Returns bit i: sensor i is faulty, s->cause
 * tells why. A faulty one is only flagged; all others go on, and so do cross terms, from the
 * angle that it holds.
 *
 * What happens to a code that is not believed (rail, or beyond the span's margin): the last
 * one that was takes its place in the filter, from its first frame on. So a spike leaves no
 * trace. From the debounce_frames-th in a row the channel is faulty; its angle stands still,
 * at the last good code's, once the filter has settled there. A faulty channel believes
 * again with the debounce_frames-th good code in a row, and its angle goes there as the
 * filter's step response does, with no jump. In the first frame a bad code is a fault at
 * once; its place takes the code of angle 0, or the end of the calibrated span next to it.
 *
 * Error of the angle: (Q + H)/2 of the quantizer in the sensor's gain, and 1/2 LSB a term.
 * Cost depends on the order and the number of cross terms; a channel that is faulty or in
 * doubt costs some 20 instructions more. Ages are the caller's: in->age_ticks is not read. */
uint32_t exh_glove_step(struct exh_glove *s, const struct exh_glove_cfg *cfg,
    const struct exh_glove_in *in, int32_t *angle_turn_q32);

/* The same in parts, for a frame that is spread over ticks. The bits are the same. First: the codes
 * that are believed; returns who is faulty. Then: the angles of sensors from .. to - 1, in any
 * parts; both at most 22; none if from >= to. Last: the cross terms of all. One array of 22 goes
 * through all: its codes become angles. */
uint32_t exh_glove_believe(struct exh_glove *s, const struct exh_glove_cfg *cfg,
    const struct exh_glove_in *in, int32_t *code_raw_q16);
void exh_glove_angles(struct exh_glove *s, const struct exh_glove_cfg *cfg, unsigned from,
    unsigned to, int32_t *angle_turn_q32);
void exh_glove_cross(const struct exh_glove_cfg *cfg, int32_t *angle_turn_q32);

/* State through a cursor (bytes.h). */
void exh_glove_serialize(struct exh_bytes *c, struct exh_glove *s);

/* --- a calibration from poses --- */

#define EXH_GLOVE_POSES_MAX 16 /* sums of products stay within 2^62 */

/* The hand held still in one pose: what is known of it, and what was measured. */
struct exh_glove_pose {
    uint32_t known; /* bit i: the pose says what the angle of sensor i is */
    int32_t angle_turn_q32[EXH_GLOVE_SENSORS]; /* of those known */
    int32_t mean_raw_q16[EXH_GLOVE_SENSORS];   /* mean code */
    int32_t noise_raw[EXH_GLOVE_SENSORS];      /* highest less lowest code */
};

/* What a fit is to be believed at. */
struct exh_glove_fit_par {
    int32_t move_min_raw;          /* codes between two of its poses at least */
    int32_t noise_max_raw;         /* noise_raw of each pose at most */
    int32_t residual_max_turn_q32; /* of each pose at most */
};
extern const struct exh_glove_fit_par exh_glove_fit_default; /* 256 codes, 128 codes, 6 deg */

/* How one sensor came out. */
struct exh_glove_fit {
    int32_t residual_turn_q32; /* the worst: known less fitted angle */
    uint8_t pose;              /* of that pose */
    uint8_t poses;             /* how many say its angle */
    uint8_t what;              /* enum exh_glove_error_kind, or EXH_GLOVE_ERRORS: fine */
};

/* Least squares over the poses that know a sensor's angle: gain and zero of each sensor
 * present, and the cross terms of those that have of[] (of the angles that the fit gives
 * those other sensors). Two poses give the line through both; each cross term needs one
 * more, in which that other sensor moves.
 * *cal: ids, day, present and of[] on entry, the rest on return; what is not present keeps
 * its cross terms. low and high are the lowest and highest mean of all poses. fit: one for
 * each of the 22. 0, or -EXH_E_RANGE: the first sensor in *bad (may be NULL), each one's
 * in fit[], and present is 0; also when n is not 2 .. EXH_GLOVE_POSES_MAX (EXH_GLOVE_POSES).
 * Off exact least squares by less than 2^-12 of the span, however hard the poses are to
 * tell apart. Set-up only (divides). */
int exh_glove_cal_fit(struct exh_glove_cal *cal, struct exh_glove_fit *fit,
    const struct exh_glove_pose *pose, unsigned n, const struct exh_glove_fit_par *par,
    struct exh_glove_error *bad);

#ifdef __cplusplus
}
#endif
#endif
