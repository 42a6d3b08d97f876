/* SPDX-License-Identifier: MIT */
/* Contact law: spring, damper and pull-back at one virtual wall. */
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
    {0x0404, EXH_Q_POS, EXH_WHEN_REST, 0, EXH_Q(1, 100, EXH_Q_POS), EXH_Q(2, 10000, EXH_Q_POS),
        "f0_band", "m", "movement that reverses the pull-back force"},
    {0x0405, EXH_Q_POS, EXH_WHEN_REST, 0, EXH_Q(1, 100, EXH_Q_POS), 0, "hyst", "m",
        "contact ends this far before q_lim"},
};

int32_t exh_contact_wall(struct exh_contact *s, int32_t pos_m_q30, int32_t lim_m_q30)
{
    const int32_t pen = exh_diff_sat32(pos_m_q30, lim_m_q30);
    if (!s->started) {
        s->turn_m_q30 = pos_m_q30;
        s->started = 1;
    }
    return exh_wrap_diff(pos_m_q30, pen);
}

void exh_contact_step_free(struct exh_contact *s, const struct exh_contact_par *par,
    int32_t pos_m_q30, struct exh_force_ledger *out)
{
    if (!s->started) { (void)exh_contact_wall(s, pos_m_q30, pos_m_q30); }
    s->touching = 0;
    out->spring_N_q20 = out->damper_N_q20 = 0;
    out->pullback_N_q20 = exh_contact_pullback(s, par, pos_m_q30);
    out->passivity_N_q20 = 0;
}

void exh_contact_serialize(struct exh_bytes *c, struct exh_contact *s)
{
    exh_bytes_i32(c, &s->turn_m_q30);
    exh_bytes_u8(c, &s->inward);
    exh_bytes_u8(c, &s->touching);
    exh_bytes_u8(c, &s->started);
    s->inward = s->inward != 0; /* these bytes multiply forces */
    s->touching = s->touching != 0;
}
