/* SPDX-License-Identifier: MIT */
/* PROVES: pre-contact
 * Any plane of any age, in any state read from bytes, with any fingertip, slope, string, age and
 * missed ticks. Parameters in range, read at every tick; set-up with any parameters. The tick
 * leaves such a state again: the phase is one of the four, and each plane is none or has a unit
 * normal (eva/precontact.acsl).
 *
 * EVA: -eva-slevel 300
 * PLANT: lib/src/law/precontact.c: s->phase > EXH_PRECONTACT_FROZEN || -> 0 ||
 * PLANT: lib/src/law/precontact.c: cfg->material[m < cfg->materials ? m : 0] -> cfg->material[m]
 * PLANT: lib/src/law/precontact.c: is_unit(&p->normal_q30) && p->offset -> p->offset
 * PLANT: lib/src/law/precontact.c: exh_wrap_diff64(p->offset_m_q60, dot(&p->normal_q30, tip)) -> (p->offset_m_q60 - dot(&p->normal_q30, tip))
 * PLANT: lib/src/law/precontact.c: (s->near ? 0 : (int64_t)cfg->par->d_lim_m_q30) -> (s->near ? 0 : 16 * cfg->par->d_lim_m_q30)
 * PLANT: lib/src/law/precontact.c: const int64_t ahead_m_q30 = (int64_t)s->lim_m_q30 - in->pos_m_q30; -> const int64_t ahead_m_q30 = s->lim_m_q30 - in->pos_m_q30;
 * PLANT: lib/src/law/precontact.c: exh_sat32(exh_wrap_diff64( -> (int32_t)(exh_wrap_diff64(
 */
#include "num/bytes.c"
#include "num/fix.c"
#include "num/signal.c"

#include "contract_box.h"

/* The reciprocal's own proof is eva/any_recip.c. */
static int32_t recip(int32_t x)
{
    /*@ assert recip_of: 1 << 21 <= x <= 1 << 27; */
    (void)x;
    return Frama_C_interval(1 << 21, 1 << 27);
}
#define exh_recip_q24 recip
#include "law/precontact.c"

static struct exh_precontact s;
static struct exh_precontact_cfg cfg;
static struct exh_precontact_par par;
static struct exh_material_par material[3];
static struct exh_plane plane;
static struct exh_precontact_in in;

static int32_t in_row(const struct exh_signal *row) { return Frama_C_interval(row->min, row->max); }

static void any_cfg(unsigned materials)
{
    const struct exh_signal *row = exh_precontact_rows;
    ANY(cfg);
    ANY(material);
    for (unsigned i = 0; i < 3; i++) {
        material[i].k_Npm_q10 = in_row(&exh_material_rows[0]);
        material[i].b_Nspm_q20 = in_row(&exh_material_rows[1]);
        material[i].f_max_N_q20 = in_row(&exh_material_rows[2]);
    }
    par.d_lim_m_q30 = in_row(&row[0]);
    par.hyst_m_q30 = in_row(&row[1]);
    par.scale_q24 = in_row(&row[2]);
    par.from_slope = any32();
    par.printed_sign = any32();
    par.age_max_ms = in_row(&row[5]);
    par.doubt_m_q30 = in_row(&row[6]);
    par.doubt_ms = in_row(&row[7]);
    par.tip_age_max_ms = in_row(&row[8]);
    par.late_slew_Nps = in_row(&row[9]);
    cfg.par = &par;
    cfg.material = material;
    cfg.materials = (uint8_t)materials;
    cfg.pad_m_q60 =
        Frama_C_long_long_interval(-EXH_PAD_MAX_M_Q30, EXH_PAD_MAX_M_Q30) * (INT64_C(1) << 30);
}

static void ticks(unsigned materials)
{
    uint32_t bits;
    any_cfg(materials);
    /*@ assert rows: precontact_par(&par) && material(&material[2]); */
    ANY(par);
    /*@ admit precontact_par(&par); */
    FROM_BYTES(s, exh_precontact_serialize);
    /*@ assert read: precontact(&s); */
    s = any_precontact();
    ANY(plane);
    (void)exh_precontact_update(&s, &cfg, &plane, any_u32());
    /*@ assert told: precontact(&s); */
    exh_precontact_advance(&s, any_u32());
    /*@ assert skipped: precontact(&s); */
    ANY(in);
    bits = exh_precontact_step(&s, &cfg, &in);
    (void)exh_precontact_none(&s);
    exh_precontact_forget(&s);
    exh_precontact_arrived(&s);
    /*@ assert next: precontact(&s) && precontact_bits(bits); */
}

static void set_up(void)
{
    /* What exh_period_ok() takes has a numerator; Eva does not see it through the call. */
    const struct exh_period T = {Frama_C_unsigned_int_interval(1, UINT32_MAX), any_u32()};
    ANY(par);
    ANY(material);
    if (exh_precontact_setup(
            &cfg, &par, material, Frama_C_unsigned_int_interval(0, 3), any32(), T) == 0) {
        /*@ assert made: precontact_made(&cfg); */
    }
}

int main(void)
{
    set_up();
    ticks(1);
    ticks(3);
    END();
    return 0;
}
