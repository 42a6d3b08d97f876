/* SPDX-License-Identifier: MIT */
/* Contact law: spring, damper and pullback at one virtual wall. */
#include "exhand/contact.h"

#include "exhand/fix.h"
#include "exhand/units.h"

const struct exh_signal exh_contact_rows[EXH_CONTACT_ROWS] = {
    {EXH_CONTACT_K_ID, EXH_Q_K, EXH_WHEN_SLEWED, 0, EXH_K_MAX_NPM_Q10, EXH_Q(1500, 1, EXH_Q_K), "k",
        "n_per_m", "stiffness of the virtual wall"},
    {EXH_CONTACT_B_ID, EXH_Q_B, EXH_WHEN_SLEWED, 0, EXH_B_MAX_NSPM_Q20, 0, "b", "ns_per_m",
        "damping of the virtual wall"},
    {0x0403, EXH_Q_FORCE, EXH_WHEN_SLEWED, 0, EXH_Q(20, 1, EXH_Q_FORCE),
        EXH_Q(107, 1000, EXH_Q_FORCE), "f0", "n", "pull-back force while the string runs in"},
    {0x0404, EXH_Q_POS, EXH_WHEN_ANY, 0, EXH_Q(1, 100, EXH_Q_POS), EXH_Q(2, 10000, EXH_Q_POS),
        "f0_band", "m", "movement that reverses the pull-back force"},
    {0x0405, EXH_Q_POS, EXH_WHEN_ANY, 0, EXH_Q(1, 100, EXH_Q_POS), 0, "hyst", "m",
        "contact ends this far before q_lim"},
};

/* Two states: the farthest point since the last reversal moves along; a return of more than the
 * band from it is the next reversal. The distance fits uint32_t in both directions. */
static inline void follow_reversals(struct exh_contact *s, int32_t pos, int32_t band)
{
    const int32_t turn = s->turn_m_q30;
    if (!s->started) {
        s->turn_m_q30 = pos;
        s->started = 1;
    } else if (s->inward ? pos < turn : pos > turn) {
        s->turn_m_q30 = pos;
    } else if ((s->inward ? (uint32_t)pos - (uint32_t)turn : (uint32_t)turn - (uint32_t)pos) >
               (uint32_t)band) {
        s->turn_m_q30 = pos;
        s->inward = !s->inward;
    }
}

int exh_contact_step(struct exh_contact *s, const struct exh_contact_par *par,
    struct exh_contact_in in, struct exh_force_ledger *out)
{
    const int32_t pen = exh_diff_sat32(in.pos_m_q30, in.lim_m_q30);
    int touching;
    int32_t on;

    follow_reversals(s, in.pos_m_q30, par->f0_band_m_q30);
    touching = pen >= 0 ||
               (s->touching && pen > ~par->hyst_m_q30); /* ~h is -h - 1, which fits for any h */
    s->touching = (uint8_t)touching;

    /* Both products in every tick: the cost must not depend on contact. */
    on = -(int32_t)touching;
    out->spring_N_q20 = exh_mul_shr(par->k_Npm_q10 & on, pen, EXH_Q_K + EXH_Q_POS - EXH_Q_FORCE);
    out->damper_N_q20 =
        exh_mul_shr(par->b_Nspm_q20 & on, in.vel_mps_q27, EXH_Q_B + EXH_Q_VEL - EXH_Q_FORCE);
    out->pullback_N_q20 = par->f0_N_q20 & -(int32_t)s->inward;
    out->passivity_N_q20 = 0;
    return touching;
}

void exh_contact_step_free(struct exh_contact *s, const struct exh_contact_par *par,
    int32_t pos_m_q30, struct exh_force_ledger *out)
{
    const struct exh_contact_in far = {pos_m_q30, 0, INT32_MAX};
    (void)exh_contact_step(s, par, far, out);
    s->touching = 0; /* at the end of the format it met */
    out->spring_N_q20 = 0;
}

void exh_contact_serialize(struct exh_bytes *c, struct exh_contact *s)
{
    exh_bytes_i32(c, &s->turn_m_q30);
    exh_bytes_u8(c, &s->inward);
    exh_bytes_u8(c, &s->touching);
    exh_bytes_u8(c, &s->started);
    s->inward = s->inward != 0; /* factors of a force, from bytes */
    s->touching = s->touching != 0;
}
