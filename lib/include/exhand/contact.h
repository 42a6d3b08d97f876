/* SPDX-License-Identifier: MIT */
/* Contact law of one finger, eq. 1 of the paper: F = b*qd + k*q + F0 beyond q_lim, F0 before it.
 *
 * q is the length of string pulled out. Closing the finger increases q and makes qd positive. F is
 * the tension that pulls the string back; drive.h keeps it from becoming negative. F0 winds in the
 * slack string: it is 0 while the string runs out, f0 while it runs in. The paper switches F0 at
 * qd = 0, where a quantised velocity chatters. Here F0 has two states and a dead band in position,
 * so noise within the band switches it at most once per reversal.
 *
 * exh_contact_step() is the law with hysteresis and band, exh_contact_law() the law as printed.
 * Both fill a ledger that drive.h completes. Without drive.h, call exh_contact_force():
 *
 *   struct exh_contact_par par = {EXH_Q(1500, 1, EXH_Q_K), EXH_Q(5, 1, EXH_Q_B)};
 *   struct exh_contact_in in = {pos_m_q30, vel_mps_q27, EXH_Q(30, 1000, EXH_Q_POS)};
 *   int32_t force_N_q20 = exh_contact_force(&par, in); */
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

/* Parameters of one finger's law; rows in exh_contact_rows[]. Changeable between any two ticks. */
struct exh_contact_par {
    int32_t k_Npm_q10;     /* stiffness, N/m, 0 .. 10^6 */
    int32_t b_Nspm_q20;    /* damping, Ns/m, 0 .. 1000 */
    int32_t f0_N_q20;      /* pull-back force, N, 0 .. 20 */
    int32_t f0_band_m_q30; /* movement that reverses F0, m, 0 .. 10 mm */
    int32_t hyst_m_q30;    /* contact ends at q < q_lim - hyst, m, 0 .. 10 mm */
};
#define EXH_CONTACT_ROWS 5
#define EXH_CONTACT_K_ID 0x0401 /* id of the row of k */
#define EXH_CONTACT_B_ID 0x0402 /* id of the row of b */
extern const struct exh_signal exh_contact_rows[EXH_CONTACT_ROWS];

/* State of one finger's law. All zeros: no sample yet. The first one is a reversal point. */
struct exh_contact {
    int32_t turn_m_q30; /* farthest position since the last reversal */
    uint8_t inward;     /* 1: string runs in, F0 is active */
    uint8_t touching;   /* 1: the contact condition applies (the paper's c) */
    uint8_t started;    /* 1: turn_m_q30 holds a measured position */
};

/* Inputs of the law in a tick. */
struct exh_contact_in {
    int32_t pos_m_q30;   /* string position q, any int32_t */
    int32_t vel_mps_q27; /* its velocity, any int32_t */
    int32_t lim_m_q30;   /* virtual contact q_lim, any int32_t */
};

/* The force ledger: the sum of reasons for the force, in N, q20. Always and exactly,
 * force = spring + damper + pullback + passivity + clamp + slew + release. The law sets the first
 * four and leaves the others, force_N_q20 too, unchanged; drive.h sets those. The first three are
 * int64_t so that they never saturate. */
struct exh_force_ledger {
    int64_t spring_N_q20;    /* k (q - q_lim) in contact, negative within hyst; else 0 */
    int64_t damper_N_q20;    /* b qd in contact, negative while the string runs in; else 0 */
    int64_t pullback_N_q20;  /* F0: f0 while the string runs in, else 0 */
    int64_t passivity_N_q20; /* set by passivity.h; else 0 */
    int64_t clamp_N_q20;     /* correction to 0 .. force limit */
    int64_t slew_N_q20;      /* correction to the allowed rise or fall */
    int64_t release_N_q20;   /* correction by the release law */
    int32_t force_N_q20;     /* the force to command; only drive.h sets it. Without drive.h,
                                call exh_contact_force() */
};

/* The wall that exh_contact_step() uses on the first sample, or where the distance may leave 32
 * bits: q_lim moved to at most 2 m from the position. */
int32_t exh_contact_wall(struct exh_contact *s, int32_t pos_m_q30, int32_t lim_m_q30);

/* The pull-back force F0 at this position, N, q20. In each of two states the reversal point
 * follows the farthest position. A return by more than the band switches the state. Distances fit
 * uint32_t. */
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

/* One tick of the law: sets spring, damper, pullback, and passivity to 0. Call
 * exh_drive_force_step() for the rest. Each term is rounded once; their sum is within 1 LSB (0.95
 * uN) of exact for every input. The penetration q - q_lim saturates at +-2 m. Returns touching,
 * which sets at q >= q_lim and clears at q < q_lim - hyst. Inline: a call would cost half more. */
static inline int exh_contact_step(struct exh_contact *s, const struct exh_contact_par *par,
    struct exh_contact_in in, struct exh_force_ledger *out)
{
    /* Half of the format's range: the difference of two positions within it does not wrap. */
    const uint32_t half = UINT32_C(1) << 30;
    const uint32_t beyond =
        (((uint32_t)in.pos_m_q30 + half) | ((uint32_t)in.lim_m_q30 + half)) >> 31;
    const int32_t hyst = par->hyst_m_q30 & -(int32_t)s->touching;
    int32_t pen, on;
    if (beyond || !s->started) { in.lim_m_q30 = exh_contact_wall(s, in.pos_m_q30, in.lim_m_q30); }
    pen = exh_wrap_diff(in.pos_m_q30, in.lim_m_q30);
    /* All bits set unless pen is below 0 and below -hyst. A negative hysteresis acts as none. */
    on = ~((pen & (exh_wrap_add(pen, hyst) | hyst)) >> 31);
    s->touching = (uint8_t)-on;

    /* Computes both products in every tick, so that the cost does not depend on contact. Stores
     * each before the next begins, since a small CPU lacks registers for both. */
    out->spring_N_q20 = exh_mul_shr(par->k_Npm_q10, pen & on, EXH_Q_K + EXH_Q_POS - EXH_Q_FORCE);
    out->damper_N_q20 =
        exh_mul_shr(par->b_Nspm_q20, in.vel_mps_q27 & on, EXH_Q_B + EXH_Q_VEL - EXH_Q_FORCE);
    out->passivity_N_q20 = 0;
    out->pullback_N_q20 = exh_contact_pullback(s, par, in.pos_m_q30);
    return -on;
}

/* The law where no contact is possible; no q_lim is far enough for every position. Contact ends,
 * and only the pull-back force remains. */
void exh_contact_step_free(struct exh_contact *s, const struct exh_contact_par *par,
    int32_t pos_m_q30, struct exh_force_ledger *out);

/* --- the law without memory --- */

/* Eq. 1 as printed: contact begins and ends at q_lim, and F0 acts while the velocity is below 0.
 * The hysteresis and the band of F0 are not used. It suits a wall without F0, and an encoder whose
 * velocity does not chatter about 0. The functions accept every int32_t.
 *
 * Returns 1 at q >= q_lim. *past is the penetration in 2^-30 m, 0 .. 4 m; undefined if it returns
 * 0. */
static inline int exh_contact_past(struct exh_contact_in in, uint32_t *past)
{
    *past = (uint32_t)in.pos_m_q30 - (uint32_t)in.lim_m_q30;
    return in.pos_m_q30 >= in.lim_m_q30;
}

/* The terms of the force, for drive.h. It does not set force_N_q20: exh_contact_force() below gives
 * the force to command. Sets spring, damper, pullback, and passivity to 0. Each term is rounded
 * once, so their sum is within 1 LSB of exact. Returns 1 in contact. */
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

/* The force to command, N, q20, in one call, by the law of exh_contact_law() but without a ledger
 * and without drive.h. Limited to 0 .. EXH_FORCE_MAX_N_Q20; within 0.51 LSB of exact. */
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
    const uint64_t pull = (uint64_t)f; /* above the limit if f is negative */
    if (pull <= EXH_FORCE_MAX_N_Q20) { return (int32_t)pull; }
    return f < 0 ? 0 : EXH_FORCE_MAX_N_Q20;
}

/* State through a cursor (bytes.h). */
void exh_contact_serialize(struct exh_bytes *c, struct exh_contact *s);

#ifdef __cplusplus
}
#endif
#endif
