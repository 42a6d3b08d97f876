/* SPDX-License-Identifier: MIT */
/* Parameters: a scene's values that may be changed, and their image.
 *
 * Parameters are changed in one way only: stage (checked against range and time),
 * then apply, which the loop calls between two ticks.
 */
#ifndef EXHAND_PARAMS_H
#define EXHAND_PARAMS_H

#include "exhand/authority.h"
#include "exhand/bytes.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A scene's parameters. The caller owns both arrays, exh_signal_count() long; the active one is the
 * scene's parameter struct, the staged one what is wanted. Zero, or as exh_params_setup() leaves
 * it; both arrays are written by the functions below only, or before exh_params_seal(). */
struct exh_params {
    const struct exh_signal_table *table; /* of what the values are */
    int32_t *active;                      /* raw values in effect */
    int32_t *staged;                      /* raw values wanted */
    uint8_t locked;                       /* set-up values are refused from now on */
    uint8_t pending;                      /* something was staged since the last apply */
    uint8_t moving;                       /* a slewed value is not yet where it is wanted */
    uint8_t shift;                        /* a slewed value goes by 2^-shift of what is left */
    uint8_t by;               /* bits, 1 << enum exh_source: who staged since the last apply */
    uint16_t led[2];          /* ids of slewed rows that gains.h moves while locked; 0: none */
    uint32_t count;           /* exh_signal_count() */
    uint32_t sum, passed, at; /* exh_params_verify(): of all, of those looked at, the next */
};

#define EXH_PARAMS_VERSION 1 /* of the image */

/* How fast slewed values go. Set-up only. */
struct exh_tune_par {
    int32_t time_ms; /* 0..1000 ms; 0: at once */
};
#define EXH_TUNE_ROWS 1
extern const struct exh_signal exh_tune_rows[EXH_TUNE_ROWS];
#define EXH_TUNE_SHIFT_MAX 15 /* 2^15 ticks are more than 1 s at 20 kHz */

/* Defaults into both arrays, unlocked, shift 0. */
void exh_params_setup(
    struct exh_params *p, const struct exh_signal_table *table, int32_t *active, int32_t *staged);

/* At the end of set-up, in scenes that want it: the least shift with 2^shift * T >= par->time_ms,
 * at most EXH_TUNE_SHIFT_MAX. So in a tick a value goes by no more than T/time of what is left (and
 * 1 LSB), and 63 % of the way takes time to 2 * time. A scene that never calls it changes at once.
 */
void exh_params_slew_setup(
    struct exh_params *p, const struct exh_tune_par *par, struct exh_period T);

/* Stages one raw value, as the person at the box. -EXH_E_UNKNOWN, -EXH_E_RANGE (outside min..max),
 * or -EXH_E_STATE (an output; another set-up value while locked, the same is accepted); nothing is
 * staged then. */
int exh_params_stage(struct exh_params *p, uint16_t id, uint16_t instance, int32_t raw);

/* The same by index of the value, for whoever walks the table; and whether it would be staged. */
int exh_params_stage_at(struct exh_params *p, uint32_t i, int32_t raw);
int exh_params_validate(const struct exh_params *p, uint32_t i, int32_t raw);

/* The same by anybody; who.locked is taken from p. -EXH_E_STATE too: authority.h denies it. */
int exh_params_stage_by(struct exh_params *p, struct exh_authority who, uint32_t i, int32_t raw);
int exh_params_validate_by(
    const struct exh_params *p, struct exh_authority who, uint32_t i, int32_t raw);

/* One step from `now` towards `goal`: by 2^-shift of what is left, rounded up to whole LSB. shift
 * 0..31. Never beyond; at the goal after at most 2^shift * (1 + 0.7 * (32 - shift)) + 1 steps, from
 * anywhere; from d LSB away, d > 2^shift, after at most 2^shift * (1 + ln(d / 2^shift)) + 1. */
int32_t exh_params_slew_step(int32_t now, int32_t goal, unsigned shift);

/* Makes active what is staged; call between ticks only, once. Slewed values go one step while
 * locked, and at once before. 1 if there was anything to do: while 1 comes back its cost is one of
 * two constants of the table, that of what is just staged (all values), and that of what is on its
 * way (slewed rows). */
int exh_params_apply(struct exh_params *p);

/* For the owner of the `led` rows, between apply and tick: sets active value i. It keeps slewing if
 * it differs from the staged value. i below count. */
void exh_params_set_active(struct exh_params *p, uint32_t i, int32_t raw);

/* Wanted becomes what is active now: what was staged, or is on its way, stops here. */
void exh_params_discard(struct exh_params *p);

/* Takes back what was staged since the caller copied all of `staged` and `pending`: what is on its
 * way goes on. In the place of a copy back, which the guard would tell as damage. */
void exh_params_rollback(struct exh_params *p, const int32_t *was, uint8_t pending);

/* Both arrays through a cursor, as a keyframe has them: every value as it is active, a slewed one
 * followed by what is wanted. Read: all of them are checked as exh_params_stage() does, and taken
 * whole; else the cursor is not ok and nothing is. */
void exh_params_serialize(struct exh_bytes *c, struct exh_params *p);

/* Redundancy, for a guard (exhand/integrity.h): seal takes both arrays as they are now; verify
 * then checks the next value, in turn. 1: the value was changed by anything but these functions
 * (while nothing slews), or at the end of a round, the checksum of both arrays disagrees. One
 * flipped bit in either array is found within two rounds, while a value slews, too. */
void exh_params_seal(struct exh_params *p);
int exh_params_verify(struct exh_params *p);

/* Image: "EXHP", version u16, count u16, table CRC u32, values i32…, CRC u32,
 * little-endian. Saves what is wanted: the staged values. Bytes written, or -EXH_E_SHORT. */
int32_t exh_params_save(const struct exh_params *p, void *buf, size_t cap_B);

/* Stages a whole image or nothing, before the set-up is over, but for values of EXH_WHEN_PERSON:
 * those stay as they are, whatever stands in their place, since no image says what a person bears.
 * -EXH_E_SHORT, -EXH_E_VERSION (other version or table), -EXH_E_CRC, -EXH_E_RANGE or -EXH_E_STATE;
 * for the last two *bad (may be NULL) is the index of the offending value. */
int exh_params_load(struct exh_params *p, const void *buf, size_t len_B, uint32_t *bad);

/* The same with values of EXH_WHEN_PERSON: of a log's header, for whoever runs that run again. */
int exh_params_restore(struct exh_params *p, const void *buf, size_t len_B, uint32_t *bad);

#ifdef __cplusplus
}
#endif
#endif
