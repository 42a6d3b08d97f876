/* SPDX-License-Identifier: MIT */
/* Contact law of one finger: F = b*qd + k*q + F0 past q_lim, F0 before (eq. 1).
 *
 * q is the string pulled out, so a finger that closes makes q grow and qd
 * positive; F is the tension that pulls it back, never negative after drive.h.
 * F0 pulls the slack string in: 0 while the string runs out, f0 while it runs
 * in. The paper switches at qd = 0, where a quantised velocity chatters; here
 * F0 has two states and a dead band in position, so noise within the band
 * switches at most once per reversal.
 */
#ifndef EXHAND_CONTACT_H
#define EXHAND_CONTACT_H

#include "exhand/bytes.h"
#include "exhand/fix.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters of one finger's law; rows in exh_contact_rows[]. May change between
 * any two ticks. */
struct exh_contact_par {
    int32_t k_Npm_q10;     /* stiffness, N/m, 0 .. 10^6 */
    int32_t b_Nspm_q20;    /* damping, Ns/m, 0 .. 1000 */
    int32_t f0_N_q20;      /* pull-back force, N, 0 .. 20 */
    int32_t f0_band_m_q30; /* movement that reverses F0, m, 0 .. 10 mm */
    int32_t hyst_m_q30;    /* contact ends at q < q_lim - hyst, m, 0 .. 10 mm */
};
#define EXH_CONTACT_ROWS 5
#define EXH_CONTACT_K_ID 0x0401 /* of the row of k */
#define EXH_CONTACT_B_ID 0x0402 /* of the row of b */
extern const struct exh_signal exh_contact_rows[EXH_CONTACT_ROWS];

/* What one finger's law remembers. All zeros: no sample yet. The first position becomes the first
 * reversal point. */
struct exh_contact {
    int32_t turn_m_q30; /* farthest position since the last reversal */
    uint8_t inward;     /* 1: string runs in, F0 acts */
    uint8_t touching;   /* 1: the contact condition applies (the paper's c) */
    uint8_t started;    /* 1: turn is of a position that was seen */
};

/* What the law goes by in a tick. */
struct exh_contact_in {
    int32_t pos_m_q30;   /* string position q, any int32_t */
    int32_t vel_mps_q27; /* its velocity, any int32_t */
    int32_t lim_m_q30;   /* virtual contact q_lim, any int32_t */
};

/* The force ledger: why there is each newton. The law fills the first three,
 * drive.h the rest; force = spring + damper + pullback + passivity + clamp + slew
 * + release, exactly, always. N, q20; the terms of the law are int64_t so that none of them
 * ever saturates. */
struct exh_force_ledger {
    int64_t spring_N_q20;    /* k (q - q_lim) while it touches, below 0 within hyst; else 0 */
    int64_t damper_N_q20;    /* b qd while it touches, negative as the string runs in; else 0 */
    int64_t pullback_N_q20;  /* F0: f0 while the string runs in, else 0 */
    int64_t passivity_N_q20; /* 0 where that module is not linked */
    int64_t clamp_N_q20;     /* pull only, and the force limit */
    int64_t slew_N_q20;      /* what its rise or fall is held back by */
    int64_t release_N_q20;   /* from what was asked to what the release law gives */
    int32_t force_N_q20;     /* the force commanded: drive.h's; by the law alone, ask
                                exh_contact_force() */
};

/* Where a distance may leave 32 bits, and of the first sample: the wall to go by, no farther than
 * +-2 m. */
int32_t exh_contact_wall(struct exh_contact *s, int32_t pos_m_q30, int32_t lim_m_q30);

/* Two states: the farthest point since the last reversal moves along; a return of more than the
 * band from it is the next reversal. The distance fits uint32_t in both directions. Returns F0. */
static inline int32_t exh_contact_pullback(
    struct exh_contact *s, const struct exh_contact_par *par, int32_t pos)
{
    const int32_t turn = s->turn_m_q30;
    const uint32_t band = (uint32_t)par->f0_band_m_q30;
    if (s->inward) {
        if (pos < turn) {
            s->turn_m_q30 = pos;
        } else if ((uint32_t)pos - (uint32_t)turn > band) {
            s->turn_m_q30 = pos;
            s->inward = 0;
            return 0;
        }
        return par->f0_N_q20;
    }
    if (pos > turn) {
        s->turn_m_q30 = pos;
    } else if ((uint32_t)turn - (uint32_t)pos > band) {
        s->turn_m_q30 = pos;
        s->inward = 1;
        return par->f0_N_q20;
    }
    return 0;
}

/* One tick. Fills spring, damper and pullback, zeroes passivity; the rest is drive.h's. Each term
 * is rounded once: the sum is within 1 LSB (0.95 uN) of exact for every input; penetration q -
 * q_lim saturates at +-2 m. Returns `touching`: it sets at q >= q_lim and clears at q < q_lim -
 * hyst. Inline, as a scene has one law: a call with all that goes in costs half of it again. */
static inline int exh_contact_step(struct exh_contact *s, const struct exh_contact_par *par,
    struct exh_contact_in in, struct exh_force_ledger *out)
{
    /* Half of the format: of two positions within it no difference wraps. */
    const uint32_t half = UINT32_C(1) << 30;
    const uint32_t beyond =
        (((uint32_t)in.pos_m_q30 + half) | ((uint32_t)in.lim_m_q30 + half)) >> 31;
    const int32_t hyst = par->hyst_m_q30 & -(int32_t)s->touching;
    int32_t pen, on;
    if (beyond || !s->started) { in.lim_m_q30 = exh_contact_wall(s, in.pos_m_q30, in.lim_m_q30); }
    pen = exh_wrap_diff(in.pos_m_q30, in.lim_m_q30);
    /* All bits set unless below 0 and below -hyst; a hysteresis of damaged memory is none. */
    on = ~((pen & (exh_wrap_add(pen, hyst) | hyst)) >> 31);
    s->touching = (uint8_t)-on;

    /* Both products in every tick: the cost must not depend on contact. Each is stored before the
     * next begins: a small CPU has no registers for all. */
    out->spring_N_q20 = exh_mul_shr(par->k_Npm_q10, pen & on, EXH_Q_K + EXH_Q_POS - EXH_Q_FORCE);
    out->damper_N_q20 =
        exh_mul_shr(par->b_Nspm_q20, in.vel_mps_q27 & on, EXH_Q_B + EXH_Q_VEL - EXH_Q_FORCE);
    out->passivity_N_q20 = 0;
    out->pullback_N_q20 = exh_contact_pullback(s, par, in.pos_m_q30);
    return -on;
}

/* The same where there is nothing to touch: no q_lim is far enough away for every position. The
 * pull-back force alone is left, and the contact has ended. */
void exh_contact_step_free(struct exh_contact *s, const struct exh_contact_par *par,
    int32_t pos_m_q30, struct exh_force_ledger *out);

/* --- the law without memory --- */

/* Eq. 1 as it is printed: contact begins and ends at q_lim, and F0 acts while the velocity is below
 * 0, so the hysteresis and F0's band are not read. It suits a wall without F0, and an encoder whose
 * velocity does not chatter about 0. Both functions take every int32_t.
 *
 * 1 at q >= q_lim. *past: the penetration in 2^-30 m, 0 .. 4 m; no meaning where it returns 0. */
static inline int exh_contact_past(struct exh_contact_in in, uint32_t *past)
{
    *past = (uint32_t)in.pos_m_q30 - (uint32_t)in.lim_m_q30;
    return in.pos_m_q30 >= in.lim_m_q30;
}

/* Fills spring, damper and pullback, zeroes passivity; the rest is drive.h's, and not
 * written here: without drive.h, exh_contact_force() is the call. Each term is rounded once: their
 * sum is within 1 LSB of exact. Returns 1 in contact. */
static inline int exh_contact_law(
    const struct exh_contact_par *par, struct exh_contact_in in, struct exh_force_ledger *out)
{
    const unsigned shift = EXH_Q_K + EXH_Q_POS - EXH_Q_FORCE;
    uint32_t past;
    const int c = exh_contact_past(in, &past);
    const uint64_t spring = (uint64_t)(uint32_t)par->k_Npm_q10 * (past & (uint32_t)-c);
    out->spring_N_q20 = (int64_t)((spring + (UINT32_C(1) << (shift - 1))) >> shift);
    out->damper_N_q20 =
        exh_mul_shr(par->b_Nspm_q20, in.vel_mps_q27 & -c, EXH_Q_B + EXH_Q_VEL - EXH_Q_FORCE);
    out->pullback_N_q20 = par->f0_N_q20 & in.vel_mps_q27 >> 31;
    out->passivity_N_q20 = 0;
    return c;
}

/* The force to command by the same law, N, q20, in one call and without drive.h, where nobody asks
 * why: 0 .. EXH_FORCE_MAX_N_Q20, limited at both ends, within 0.51 LSB of exact. */
static inline int32_t exh_contact_force(const struct exh_contact_par *par, struct exh_contact_in in)
{
    const unsigned shift = EXH_Q_K + EXH_Q_POS - EXH_Q_FORCE;
    const int64_t damper =
        (int64_t)par->b_Nspm_q20 * in.vel_mps_q27 >> (EXH_Q_B + EXH_Q_VEL - EXH_Q_K - EXH_Q_POS);
    uint32_t past;
    const int c = exh_contact_past(in, &past);
    const uint64_t sum = (uint64_t)(uint32_t)par->k_Npm_q10 * past + (uint64_t)damper;
    const int64_t terms = exh_shr_round(exh_from_u64(sum), shift);
    const int64_t f = (c ? terms : 0) + (par->f0_N_q20 & in.vel_mps_q27 >> 31);
    const uint64_t pull = (uint64_t)f; /* beyond the limit where f is below 0, too */
    if (pull <= EXH_FORCE_MAX_N_Q20) { return (int32_t)pull; }
    return f < 0 ? 0 : EXH_FORCE_MAX_N_Q20;
}

/* State through a cursor (bytes.h). */
void exh_contact_serialize(struct exh_bytes *c, struct exh_contact *s);

#ifdef __cplusplus
}
#endif
#endif
