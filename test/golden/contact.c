/* SPDX-License-Identifier: MIT */
/* contact: the law of one finger. */
#include "modules.h"

#include "exhand/contact.h"
#include "exhand/fix.h"

static int32_t small(struct golden_rng *r)
{
    const int64_t any = golden_draw(r, 0, 10737418);
    return (int32_t)(any >> golden_draw(r, 0, 23));
}

static struct exh_contact_par any_par(struct golden_rng *r)
{
    struct exh_contact_par p;
    p.k_Npm_q10 = (int32_t)golden_draw(r, 0, 1024000000);
    p.b_Nspm_q20 = (int32_t)golden_draw(r, 0, 1048576000);
    p.f0_N_q20 = (int32_t)golden_draw(r, 0, 20971520);
    p.f0_band_m_q30 = small(r);
    p.hyst_m_q30 = small(r);
    return p;
}

/* A band that the next movement may just reach. */
static int32_t just_reached(int64_t now, int64_t before)
{
    const int64_t moved = now > before ? now - before : before - now;
    return moved < 10737418 ? (int32_t)moved : 10737418;
}

/* Where q_lim is beside q: somewhere near, at the edges of contact, or as it was. */
static int64_t offset(
    struct golden_rng *r, const struct exh_contact_par *par, uint32_t k, int64_t before)
{
    const int64_t where = golden_draw(r, 0, 7);
    if (k % 32 == 0 || where > 5) { return golden_draw(r, -(INT32_C(1) << 24), INT32_C(1) << 24); }
    if (where > 3) { return before; }
    return (where & 2 ? par->hyst_m_q30 : 0) + (where & 1);
}

void golden_contact(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave q;
    static struct golden_wave v;
    struct golden_rng r = golden_rng("contact", rate_Hz, 0);
    struct exh_contact s = {.started = 0};
    struct exh_contact_par par = {.k_Npm_q10 = 0};
    struct exh_contact_in in = {.lim_m_q30 = 0};
    int64_t off = 0;
    golden_wave(
        &q, "contact", rate_Hz, 1, INT32_MIN, INT32_MAX, INT32_C(1) << golden_draw(&r, 8, 24));
    golden_wave(
        &v, "contact", rate_Hz, 2, INT32_MIN, INT32_MAX, INT32_C(1) << golden_draw(&r, 8, 28));
    while (g->tick < GOLDEN_TICKS) {
        struct exh_force_ledger f;
        int touching;
        if (g->tick == GOLDEN_AGAIN) { s = (struct exh_contact){.started = 0}; }
        in.pos_m_q30 = q.at[g->tick];
        in.vel_mps_q27 = v.at[g->tick];
        if (g->tick % 32 == 0) {
            par = any_par(&r);
            if (g->tick > 0) { par.f0_band_m_q30 = just_reached(in.pos_m_q30, q.at[g->tick - 1]); }
        }
        off = offset(&r, &par, g->tick, off);
        in.lim_m_q30 = exh_sat32(in.pos_m_q30 + off);
        if (g->tick >= 24 && g->tick < 28) { in.lim_m_q30 = INT32_MIN; }
        if (g->tick >= 176 && g->tick < GOLDEN_AGAIN) {
            in.lim_m_q30 = (int32_t)golden_draw(&r, INT32_MIN, INT32_MAX);
        }
        touching = exh_contact_step(&s, &par, in, &f);
        golden_put(g, in.pos_m_q30);
        golden_put(g, in.vel_mps_q27);
        golden_put(g, in.lim_m_q30);
        golden_put(g, touching);
        golden_put(g, f.spring_N_q20);
        golden_put(g, f.damper_N_q20);
        golden_put(g, f.pullback_N_q20);
        GOLDEN_STATE(g, exh_contact_serialize, &s);
        golden_tick(g);
    }
}
