/* SPDX-License-Identifier: MIT */
/* PROVES: contact law
 * The contact law: any state, position and velocity, with parameters in range. The law without
 * memory, whose commanded force is 0 .. 100 N.
 *
 * PLANT: lib/include/exhand/contact.h: (uint32_t)pos - (uint32_t)turn -> (uint32_t)(pos - turn)
 * PLANT: lib/src/law/contact.c: exh_diff_sat32(pos_m_q30, lim_m_q30) -> pos_m_q30 - lim_m_q30
 * PLANT: lib/include/exhand/contact.h: return f < 0 ? 0 : EXH_FORCE_MAX_N_Q20; -> return f < 0 ? -1 : 0;
 * PLANT: lib/include/exhand/contact.h: (uint32_t)in.pos_m_q30 - (uint32_t)in.lim_m_q30; -> (uint32_t)(in.pos_m_q30 - in.lim_m_q30);
 */
#include "law/contact.c"

#include "any.h"

static void laws(struct exh_force_ledger *f)
{
    static struct exh_contact s;
    struct exh_contact_par par;
    struct exh_contact_in in;
    int32_t force_N_q20;
    ANY(s);
    ANY(in);
    par.k_Npm_q10 = Frama_C_interval(0, 1024000000);
    par.b_Nspm_q20 = Frama_C_interval(0, 1048576000);
    par.f0_N_q20 = Frama_C_interval(0, 20 << 20);
    par.f0_band_m_q30 = Frama_C_interval(0, 10737418);
    par.hyst_m_q30 = Frama_C_interval(0, 10737418);
    (void)exh_contact_step(&s, &par, in, f);
    /*@ assert law_is_finite: -(1 << 52) * 256 <= f->spring_N_q20 <= (1 << 52) * 256; */
    exh_contact_step_free(&s, &par, in.pos_m_q30, f);
    /*@ assert free_of_contact: f->spring_N_q20 == 0 && f->damper_N_q20 == 0 && s.touching == 0; */
    (void)exh_contact_law(&par, in, f);
    /*@ assert plain_spring: 0 <= f->spring_N_q20 <= (1 << 30) * 4096; */
    /*@ assert plain_damper: -(1 << 30) * 16 <= f->damper_N_q20 <= (1 << 30) * 16; */
    force_N_q20 = exh_contact_force(&par, in);
    /*@ assert commanded: 0 <= force_N_q20 <= (100 << 20); */
}

int main(void)
{
    static struct exh_force_ledger f;
    laws(&f);
    END();
    return 0;
}
