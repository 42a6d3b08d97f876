/* SPDX-License-Identifier: MIT */
/* precontact: the distance to a plane sent, q_lim frozen before contact; advice. */
#include "modules.h"

#include "exhand/fix.h"
#include "exhand/precontact.h"

#define FINGERS 4
#define OBJECTS 4
#define MOST    3 /* materials */

struct object {
    int32_t n[3], point[3];
    uint16_t number;
    uint8_t material;
};

static struct world {
    struct exh_material_par material[256]; /* but for the first ones zeros, which may be */
    struct exh_precontact_par par[FINGERS];
    struct exh_precontact_cfg cfg[FINGERS];
    struct exh_precontact s[FINGERS];
    struct object object[OBJECTS];
    uint32_t at[FINGERS]; /* the object before each finger */
} world;

static int32_t smaller(struct golden_rng *r, int64_t lo, int64_t hi, int64_t shift)
{
    const int64_t any = golden_draw(r, lo, hi);
    return (int32_t)(any >> golden_draw(r, 0, shift));
}

static struct exh_vec3 vec(const int32_t *v) { return (struct exh_vec3){v[0], v[1], v[2]}; }

/* --- set-up --- */

static void any_object(struct object *o, struct golden_rng *r)
{
    const struct golden_turn t = golden_any_turn(r);
    const struct golden_turn u = golden_any_turn(r);
    const int64_t n[3] = {t.c * u.c, t.s * u.c, u.s * t.d};
    for (int i = 0; i < 3; i++) { o->n[i] = golden_q30(n[i], t.d * u.d); }
    for (int i = 0; i < 3; i++) {
        o->point[i] = (int32_t)golden_draw(r, -(INT32_C(1) << 28), INT32_C(1) << 28);
    }
    o->number = (uint16_t)golden_draw(r, 0, 65535);
    o->material = (uint8_t)golden_draw(r, 0, 2);
}

static void any_materials(struct golden_rng *r)
{
    for (int i = 0; i < MOST; i++) {
        world.material[i].k_Npm_q10 = (int32_t)golden_draw(r, 0, 1024000000);
        world.material[i].b_Nspm_q20 = (int32_t)golden_draw(r, 0, 1048576000);
        world.material[i].f_max_N_q20 = (int32_t)golden_draw(r, 0, 104857600);
    }
}

/* What may change without set-up. */
static void again(struct exh_precontact_par *p, struct golden_rng *r)
{
    const int32_t d = smaller(r, 107375, 214748364, 4);
    p->d_lim_m_q30 = d < 107375 ? -107375 : -d;
    p->hyst_m_q30 = smaller(r, 0, 53687091, 3);
    p->scale_q24 = (int32_t)golden_draw(r, INT32_C(1) << 21, INT32_C(1) << 27);
    p->doubt_m_q30 = smaller(r, 0, 53687091, 6);
}

/* Milliseconds of a few ticks. */
static int32_t any_ms(struct golden_rng *r, int64_t lo, int64_t hi, uint32_t rate_Hz)
{
    const int32_t ms = (int32_t)(golden_draw(r, lo, hi) * 1000 / rate_Hz);
    return ms < 1 ? 1 : ms;
}

/* All parameters and set-up; the options are the bits of the finger's number. */
static void any_setup(unsigned f, struct golden_rng *r, uint32_t rate_Hz, struct exh_period T)
{
    struct exh_precontact_par *p = &world.par[f];
    unsigned materials;
    int32_t pad;
    p->from_slope = (int32_t)(f & 1);
    p->printed_sign = (int32_t)(f >> 1 & 1);
    again(p, r);
    p->age_max_ms = any_ms(r, 2, 60, rate_Hz);
    p->doubt_ms = any_ms(r, 1, 3, rate_Hz);
    p->tip_age_max_ms = any_ms(r, 1, 8, rate_Hz);
    p->late_slew_Nps = 100;
    pad = (int32_t)golden_draw(r, 0, 26843545);
    materials = (unsigned)golden_draw(r, 1, MOST);
    CHECK_EQ_I64(exh_precontact_setup(&world.cfg[f], p, world.material, materials, pad, T), 0);
}

static void set_up(struct golden_rng *r, uint32_t rate_Hz, uint32_t k)
{
    if (k == 0 || k == GOLDEN_AGAIN) {
        (void)memset(world.s, 0, sizeof world.s);
        (void)memset(world.at, 0, sizeof world.at);
        for (int i = 0; i < OBJECTS; i++) { any_object(&world.object[i], r); }
    }
    if (k % 32 == 0) { any_materials(r); }
    for (unsigned f = 0; f < FINGERS; f++) {
        if (k % 64 == 0 || k % 76 == 8) { /* 8 and 236: just before a step to the far rail */
            any_setup(f, r, rate_Hz, golden_period(rate_Hz, k));
        } else if (k % 32 == 0) {
            again(&world.par[f], r);
        }
    }
}

/* What set-up says of parameters of which one is changed. */
static int refused(int64_t how, struct exh_period T)
{
    struct exh_precontact_par p = world.par[0];
    struct exh_precontact_cfg cfg;
    unsigned materials = 256 - (how != 2);
    int32_t pad = INT32_C(1) << 24;
    int err;
    const int32_t was = world.material[254].k_Npm_q10;
    switch ((int)how) {
    case 1: p.age_max_ms = 60000; break;
    case 3: p.d_lim_m_q30 = 0; break;
    case 4: p.d_lim_m_q30 = -(INT32_C(1) << 28); break;
    case 5: p.hyst_m_q30 = -1; break;
    case 6: p.hyst_m_q30 = INT32_C(1) << 26; break;
    case 7: p.scale_q24 = (INT32_C(1) << 21) - 1; break;
    case 8: p.scale_q24 = (INT32_C(1) << 27) + 1; break;
    case 9: p.from_slope = 2; break;
    case 10: p.printed_sign = -1; break;
    case 11: p.age_max_ms = (T.num & 1) != 0 ? 0 : 60001; break;
    case 12: materials = 0; break;
    case 13: pad = -1; break;
    case 14: pad = INT32_C(1) << 25; break;
    case 15: world.material[254].k_Npm_q10 = -1; break;
    case 16: p.doubt_m_q30 = -1; break;
    case 17: p.doubt_m_q30 = INT32_C(1) << 26; break;
    case 18: p.doubt_ms = (T.num & 1) != 0 ? 0 : 60001; break;
    case 19: p.tip_age_max_ms = (T.num & 1) != 0 ? 0 : 60001; break;
    case 20: p.late_slew_Nps = 0; break;
    case 21: p.late_slew_Nps = 10000001; break;
    default: break;
    }
    err = exh_precontact_setup(&cfg, &p, world.material, materials, pad, T);
    world.material[254].k_Npm_q10 = was;
    return err;
}

/* --- a tick --- */

/* A plane as sent. The finger may go on to another object. */
static struct exh_plane any_plane(unsigned f, int64_t how, struct golden_rng *r)
{
    const uint8_t materials = world.cfg[f].materials;
    struct object o;
    struct exh_plane plane;
    int64_t i;
    uint8_t kind = EXH_PLANE_HIT;
    if (how == 27) { world.at[f] = (uint32_t)golden_draw(r, 0, OBJECTS - 1); }
    o = world.object[world.at[f]];
    o.material %= materials;
    if (how < 10) { kind = EXH_PLANE_UNTOLD; }
    if (how == 24) { kind = EXH_PLANE_NONE; }
    if (how == 23 || how == 25) {
        i = golden_draw(r, 0, 2);
        o.n[i] += (int32_t)golden_draw(r, -24576, 24576);
    }
    if (how == 26) { o.material = (uint8_t)(materials + golden_draw(r, 0, 2)); }
    if (how == 28) {
        i = golden_draw(r, 0, 2);
        o.point[i] += (int32_t)golden_draw(r, -(INT32_C(1) << 26), INT32_C(1) << 26);
    }
    if (how == 30) { kind = (uint8_t)golden_draw(r, 3, 255); }
    if (how == 31) { o.number ^= 1; }
    plane.kind = kind;
    plane.material = o.material;
    plane.object = o.number;
    plane.normal_q30 = vec(o.n);
    plane.point_m_q30 = vec(o.point);
    return plane;
}

/* Where the finger is: about d before its object, now and then about d_lim. */
static struct exh_precontact_in any_in(unsigned f, uint32_t k, int64_t d, struct golden_rng *r)
{
    const struct object *o = &world.object[world.at[f]];
    const struct exh_precontact_par *par = &world.par[f];
    const int extreme = (k >= 176 && k < GOLDEN_AGAIN) || k >= 248;
    struct exh_precontact_in in;
    int32_t tip[3];
    int32_t slope[3];
    int32_t g;
    if (golden_draw(r, 0, 1) == 0) {
        d = par->d_lim_m_q30 - (world.cfg[f].pad_m_q60 >> 30);
        d -= golden_draw(r, -(INT32_C(1) << 16), 2 * ((int64_t)par->hyst_m_q30 + par->doubt_m_q30));
    }
    for (int i = 0; i < 3; i++) { tip[i] = exh_sat32(o->point[i] - (o->n[i] * d >> 30)); }
    if (extreme && golden_draw(r, 0, 1) != 0) {
        for (int i = 0; i < 3; i++) { tip[i] = (int32_t)golden_draw(r, INT32_MIN, INT32_MAX); }
    }
    g = smaller(r, 0, INT32_C(1) << 28, 8);
    for (int i = 0; i < 3; i++) {
        slope[i] = (int32_t)(-((int64_t)o->n[i] * g >> 30) + golden_draw(r, -65536, 65536));
    }
    if (golden_draw(r, 0, 15) == 0) {
        for (int i = 0; i < 3; i++) { slope[i] = (int32_t)golden_draw(r, INT32_MIN, INT32_MAX); }
    }
    in.tip_m_q30 = vec(tip);
    in.slope_q24 = vec(slope);
    in.touching = 0;
    if (golden_draw(r, 0, 1) == 0) { in.touching = (uint8_t)golden_draw(r, 1, 255); }
    in.tip_age_ticks = 0;
    if (golden_draw(r, 0, 7) == 0) {
        in.tip_age_ticks = (uint32_t)(world.cfg[f].tip_ticks + golden_draw(r, 0, 2) - 1);
    }
    in.pulls = golden_draw(r, 0, 15) != 0;
    in.vel_mps_q27 = (int32_t)golden_draw(r, -1342177, 3 * INT32_C(1342177));
    return in;
}

static void put_advice(struct golden *g, struct exh_period T, struct golden_rng *r)
{
    struct exh_precontact_advice a;
    struct exh_precontact_need n;
    int32_t d_lim;
    int err;
    int64_t bad;
    n.speed_mps_q27 = smaller(r, 0, INT32_MAX, 12);
    n.lag_us = smaller(r, 0, 2000000, 12);
    n.noise_m_q30 = (int32_t)golden_draw(r, 0, INT32_C(1) << 22);
    n.age_us = smaller(r, 0, 2000000, 12);
    n.object_mps_q27 = smaller(r, 0, INT32_MAX, 12);
    n.slide_m_q30 = smaller(r, 0, INT32_C(1) << 30, 8);
    n.radius_m_q30 = golden_draw(r, 0, 3) != 0 ? (int32_t)golden_draw(r, 1, INT32_C(1) << 29) : 0;
    d_lim = (int32_t)-golden_draw(r, 1, INT32_C(1) << 28);
    bad = golden_draw(r, 0, 31);
    if (bad == 0) { n.speed_mps_q27 = -1; }
    if (bad == 1) { n.lag_us = -1; }
    if (bad == 2) { n.noise_m_q30 = -1; }
    if (bad == 3) { n.age_us = -1; }
    if (bad == 4) { n.object_mps_q27 = -1; }
    if (bad == 5) { n.slide_m_q30 = -1; }
    if (bad == 6) { n.radius_m_q30 = -1; }
    if (bad == 7) { n.lag_us = 2000001; }
    if (bad == 8) { n.age_us = 2000001; }
    if (bad == 9) { d_lim = 0; }
    err = exh_precontact_advise(&a, &n, T, d_lim);
    if (err != 0) { (void)memset(&a, 0, sizeof a); }
    golden_put(g, err);
    golden_put(g, a.d_lim_m_q30);
    golden_put(g, a.ray_m_q30);
    golden_put(g, a.error_m_q30);
    golden_put(g, a.speed_mps_q27);
}

/* The columns of all fingers, one after the other. */
static void put_rows(struct golden *g, int64_t row[FINGERS][7])
{
    for (int i = 0; i < 7; i++) {
        for (int f = 0; f < FINGERS; f++) { golden_put(g, row[f][i]); }
    }
}

static void one_finger(
    unsigned f, uint32_t k, int32_t d, int32_t pos, struct golden_rng *r, int64_t row[7])
{
    const struct exh_precontact_cfg *cfg = &world.cfg[f];
    struct exh_precontact *s = &world.s[f];
    const int64_t how = golden_draw(r, 0, 31);
    const struct exh_plane plane = any_plane(f, how, r);
    const int64_t old = cfg->age_ticks;
    const int64_t age = how == 29 ? golden_draw(r, old - 1, old + 2) : golden_draw(r, 0, 3);
    struct exh_precontact_in in = any_in(f, k, d, r);
    in.pos_m_q30 = pos;
    if (golden_draw(r, 0, 2) == 0) { exh_precontact_advance(s, (uint32_t)golden_draw(r, 0, 4)); }
    row[0] = plane.kind;
    row[1] = age;
    row[2] = in.touching;
    row[3] = exh_precontact_update(s, cfg, &plane, (uint32_t)age);
    row[4] = exh_precontact_step(s, cfg, &in);
    if (golden_draw(r, 0, 7) == 0) { exh_precontact_forget(s); }
    if (golden_draw(r, 0, 3) == 0) { exh_precontact_arrived(s); }
    row[5] = s->d_m_q30;
    row[6] = s->lim_m_q30;
}

void golden_precontact(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave way[FINGERS];
    static struct golden_wave pos[FINGERS];
    struct golden_rng r = golden_rng("precontact", rate_Hz, 0);
    for (uint32_t f = 0; f < FINGERS; f++) {
        golden_wave(&way[f], "precontact", rate_Hz, 1 + f, -214748364, INT32_C(1) << 25,
            INT32_C(1) << golden_draw(&r, 16, 23));
        golden_wave(&pos[f], "precontact", rate_Hz, 5 + f, INT32_MIN, INT32_MAX, INT32_C(1) << 24);
    }
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t k = g->tick;
        const struct exh_period T = golden_period(rate_Hz, k);
        int64_t row[FINGERS][7];
        int said;
        set_up(&r, rate_Hz, k);
        said = refused(golden_draw(&r, 0, 21), T);
        for (unsigned f = 0; f < FINGERS; f++) {
            one_finger(f, k, way[f].at[k], pos[f].at[k], &r, row[f]);
        }
        put_rows(g, row);
        golden_put(g, said);
        put_advice(g, T, &r);
        for (unsigned f = 0; f < FINGERS; f++) {
            GOLDEN_STATE(g, exh_precontact_serialize, &world.s[f]);
        }
        golden_tick(g);
    }
}
