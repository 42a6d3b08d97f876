/* SPDX-License-Identifier: MIT */
/* Parameters: the changeable values of a scene, and their binary image.
 *
 * A change takes two steps. Stage checks the value against its range and against the time. Apply,
 * which the loop calls between two ticks, makes it active.
 *
 *   int err = exh_params_stage(&params, EXH_CONTACT_K_ID, EXH_INDEX, EXH_Q(1500, 1, EXH_Q_K));
 *   if (err == 0) { exh_params_apply(&params); } */
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

/* The parameters of a scene. The caller owns both arrays, each exh_signal_count() long. The active
 * array is the scene's parameter struct, the staged array holds the requested values. The struct is
 * all zeros or set by exh_params_setup(). After exh_params_seal(), only functions below may write
 * them. */
struct exh_params {
    const struct exh_signal_table *table; /* describes the values */
    int32_t *active;                      /* raw values in effect */
    int32_t *staged;                      /* raw values requested */
    uint8_t locked;                       /* 1: set-up values are refused */
    uint8_t pending;                      /* something was staged since the last apply */
    uint8_t moving;                       /* 1: a slewed value has not reached its staged value */
    uint8_t shift;                        /* slew per tick: 2^-shift of the distance */
    uint8_t by;               /* 1 << enum exh_source of all that staged since the last apply */
    uint16_t led[2];          /* ids of slewed rows that gains.h moves while locked; 0: none */
    uint32_t count;           /* exh_signal_count() */
    uint32_t sum, passed, at; /* of exh_params_verify(): sum of all, sum so far, next index */
};

#define EXH_PARAMS_VERSION 1 /* version of the image */

/* How fast slewed values move. Set-up only. */
struct exh_tune_par {
    int32_t time_ms; /* 0..1000 ms; 0: in one step */
};
#define EXH_TUNE_ROWS 1
extern const struct exh_signal exh_tune_rows[EXH_TUNE_ROWS];
#define EXH_TUNE_SHIFT_MAX 15 /* 2^15 ticks are more than 1 s at 20 kHz */

/* Writes the defaults into both arrays, unlocks, and sets shift to 0. */
void exh_params_setup(
    struct exh_params *p, const struct exh_signal_table *table, int32_t *active, int32_t *staged);

/* Sets the slew rate; call it at the end of set-up. shift becomes the smallest with
 * 2^shift * T >= par->time_ms, at most EXH_TUNE_SHIFT_MAX. Per tick, a value then moves by at most
 * T/time of the remaining distance plus 1 LSB. It covers 63 % of the distance within time to
 * 2 * time. Without this call, values change in one step. */
void exh_params_slew_setup(
    struct exh_params *p, const struct exh_tune_par *par, struct exh_period T);

/* Stages one raw value on behalf of the person at the box. Errors, after which nothing is staged:
 * -EXH_E_UNKNOWN: no such value; -EXH_E_RANGE: outside min..max; -EXH_E_STATE: an output, or a
 * changed set-up value while locked. A set-up value equal to the present one is accepted. */
int exh_params_stage(struct exh_params *p, uint16_t id, uint16_t instance, int32_t raw);

/* exh_params_stage() by the index of the value. Validate returns the result without staging. */
int exh_params_stage_at(struct exh_params *p, uint32_t i, int32_t raw);
int exh_params_validate(const struct exh_params *p, uint32_t i, int32_t raw);

/* The same for any source. who.locked is taken from p. Also -EXH_E_STATE: authority.h denies it. */
int exh_params_stage_by(struct exh_params *p, struct exh_authority who, uint32_t i, int32_t raw);
int exh_params_validate_by(
    const struct exh_params *p, struct exh_authority who, uint32_t i, int32_t raw);

/* The value after one step from now towards goal: a step of 2^-shift of the distance, rounded up to
 * whole LSB; shift 0..31. It never overshoots. From d LSB away, d > 2^shift, it arrives within
 * 2^shift * (1 + ln(d / 2^shift)) + 1 steps. From anywhere, it arrives within
 * 2^shift * (1 + 0.7 * (32 - shift)) + 1 steps. */
int32_t exh_params_slew_step(int32_t now, int32_t goal, unsigned shift);

/* Makes the staged values active; call it once, between ticks. While locked, slewed values move one
 * step. Before that they change in one call. Returns 1 if it changed anything. Its cost is then one
 * of two constants: all values after a new staging, slewed rows alone while they move. */
int exh_params_apply(struct exh_params *p);

/* Sets active value i, i below count. Only the module that owns the led rows calls it, between
 * apply and tick. The value continues to slew if it differs from the staged value. */
void exh_params_set_active(struct exh_params *p, uint32_t i, int32_t raw);

/* Cancels all pending changes: the staged values become the present active ones. Slewing stops. */
void exh_params_discard(struct exh_params *p);

/* Restores the staged values from a copy of staged and pending that the caller made before. Slewing
 * continues. Do not copy back by hand: exh_params_verify() would report damage. */
void exh_params_rollback(struct exh_params *p, const int32_t *was, uint8_t pending);

/* Both arrays through a cursor, for a keyframe: each active value, and after a slewed one its
 * staged value. On reading, all values are checked as by exh_params_stage(). If one fails, the
 * cursor fails and p keeps its values. */
void exh_params_serialize(struct exh_bytes *c, struct exh_params *p);

/* Redundancy for a guard (exhand/integrity.h). Seal records both arrays as they are now. Each
 * verify checks the next value. It returns 1 if another piece of code changed the value while
 * nothing slews. It also returns 1 if the checksum of both arrays disagrees at the end of a round.
 * One flipped bit in either array is found within two rounds, even while a value slews. */
void exh_params_seal(struct exh_params *p);
int exh_params_verify(struct exh_params *p);

/* Saves the staged values as an image, little-endian: "EXHP", version u16, count u16, CRC of the
 * table u32, values i32..., CRC u32. Returns the bytes written, or -EXH_E_SHORT. */
int32_t exh_params_save(const struct exh_params *p, void *buf, size_t cap_B);

/* Stages a whole image or nothing; before the set-up ends. Ignores the image's values of
 * EXH_WHEN_PERSON, since no image may say how much force a person tolerates. Returns -EXH_E_SHORT,
 * -EXH_E_VERSION (another version or table), -EXH_E_CRC, -EXH_E_RANGE or -EXH_E_STATE. For the last
 * two, *bad is the index of the refused value; bad may be NULL. */
int exh_params_load(struct exh_params *p, const void *buf, size_t len_B, uint32_t *bad);

/* exh_params_load() including values of EXH_WHEN_PERSON: for a replay, from the log's header. */
int exh_params_restore(struct exh_params *p, const void *buf, size_t len_B, uint32_t *bad);

#ifdef __cplusplus
}
#endif
#endif
