/* SPDX-License-Identifier: MIT */
/* As contract.h, for the further functions of a box with glove and link. Units precontact, hand,
 * hand_tip, glove and wire prove that they keep to these. */
#ifndef PROOF_CONTRACT_BOX_H
#define PROOF_CONTRACT_BOX_H

#include "contract.h"

/*@ predicate hand(struct exh_hand_finger *f) = \valid_read(f->bones) && -262144032 <= f->pull_radpm_q20[0] <= 262144032 &&
      -262144032 <= f->pull_radpm_q20[1] <= 262144032; */

/*@ predicate material(struct exh_material_par *m) = 0 <= m->k_Npm_q10 <= 1024000000 && 0 <= m->b_Nspm_q20 <= 1048576000 &&
      0 <= m->f_max_N_q20 <= 104857600;
    predicate precontact_par(struct exh_precontact_par *p) = -214748365 <= p->d_lim_m_q30 <= -107374 &&
      0 <= p->hyst_m_q30 <= 53687091 && 2097152 <= p->scale_q24 <= 134217728 && 0 <= p->doubt_m_q30 <= 53687091 &&
      1 <= p->late_slew_Nps <= 10000000;
    predicate precontact_made(struct exh_precontact_cfg *c) = 1 <= c->materials &&
      -(26843546 * (1 << 30)) <= c->pad_m_q60 <= 26843546 * (1 << 30);
    predicate precontact_cfg(struct exh_precontact_cfg *c) = \valid_read(c->par) && precontact_par(c->par) && precontact_made(c) &&
      \valid_read(c->material + (0 .. c->materials - 1));
    predicate component(integer v) = -1073750016 <= v <= 1073750016;
    predicate plane(struct exh_precontact_plane *p) = component(p->normal_q30.x) && component(p->normal_q30.y) &&
      component(p->normal_q30.z);
    predicate precontact(struct exh_precontact *s) = s->phase <= 3 && material(&s->taken) && plane(&s->newest) && plane(&s->held);
    predicate precontact_bits(integer v) = 0 <= v < 1 << 11; */

/*@ predicate glove_cfg(struct exh_glove_cfg *c) = \valid_read(c->cal) && 0 <= c->filter.a < 1 << 30 &&
      1 <= c->low_cause <= 2 && 1 <= c->high_cause <= 2 && 64 <= c->quantizer.half <= 1 << 30;
    predicate sensors(integer v) = 0 <= v < 1 << 22; */

static struct exh_precontact any_precontact(void)
{
    struct exh_precontact s;
    ANY(s);
    /*@ admit precontact(&s); */
    return s;
}

static struct exh_hand_finger any_hand(void)
{
    struct exh_hand_finger f;
    f.pull_radpm_q20[0] = Frama_C_interval(-262144032, 262144032);
    f.pull_radpm_q20[1] = Frama_C_interval(-262144032, 262144032);
    f.bones = exh_hit2_bones;
    return f;
}

static struct exh_glove any_glove(void)
{
    struct exh_glove s;
    ANY(s);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        s.cause[i] = (uint8_t)Frama_C_unsigned_int_interval(0, 3);
    }
    return s;
}

#endif
