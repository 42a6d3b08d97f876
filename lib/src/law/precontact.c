/* SPDX-License-Identifier: MIT */
/* Virtual contact of a finger: follows planes from the world and freezes before contact. */
#include "exhand/precontact.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define MATERIALS_MAX    255u
#define HALF_Q60         (INT64_C(1) << 29) /* half an LSB of d, for rounding */
#define SCALE_MIN_Q24    (INT32_C(1) << 21)
#define SCALE_MAX_Q24    (INT32_C(1) << 27)
#define TOUCH_M_Q30      (-8)                     /* closer than this, s*d may be below an LSB */
#define RUNS_OUT_MPS_Q27 EXH_Q(1, 100, EXH_Q_VEL) /* faster than the tremor of a finger */
#define LATE_SCALE       2                        /* most string metres per fingertip metre */
#define SLEW_MAX_NPS     10000000

const struct exh_signal exh_material_rows[EXH_MATERIAL_ROWS] = {
    {EXH_MATERIAL_K_ID, EXH_Q_K, EXH_WHEN_MATERIAL, 0, EXH_K_MAX_NPM_Q10, EXH_Q(20000, 1, EXH_Q_K),
        "mat_k", "n_per_m", "stiffness of the material"},
    {0x0B02, EXH_Q_B, EXH_WHEN_MATERIAL, 0, EXH_B_MAX_NSPM_Q20, EXH_Q(60, 1, EXH_Q_B), "mat_b",
        "ns_per_m", "damping of the material"},
    {0x0B03, EXH_Q_FORCE, EXH_WHEN_MATERIAL, 0, EXH_FORCE_MAX_N_Q20, EXH_Q(12, 1, EXH_Q_FORCE),
        "mat_f_max", "n", "force limit of the material"},
};

const struct exh_signal exh_precontact_rows[EXH_PRECONTACT_ROWS] = {
    {0x0C01, EXH_Q_POS, EXH_WHEN_REST, -EXH_Q(2, 10, EXH_Q_POS), -EXH_Q(1, 10000, EXH_Q_POS),
        -EXH_Q(45, 10000, EXH_Q_POS), "d_lim", "m", "q_lim is frozen at this distance, < 0"},
    {0x0C02, EXH_Q_POS, EXH_WHEN_REST, 0, EXH_Q(5, 100, EXH_Q_POS), EXH_Q(1, 1000, EXH_Q_POS),
        "d_hyst", "m", "released this far before d_lim"},
    {0x0C03, 24, EXH_WHEN_REST, SCALE_MIN_Q24, SCALE_MAX_Q24, INT32_C(1) << 24, "string_per_tip",
        "", "string metres per fingertip metre"},
    {0x0C04, 0, EXH_WHEN_REST, 0, 1, 0, "string_from_slope", "", "1: that of the joints instead"},
    {0x0C05, 0, EXH_WHEN_SETUP, 0, 1, 0, "d_printed", "", "1: the sign of the pad as printed"},
    {0x0C06, 0, EXH_WHEN_SETUP, 1, 60000, 2000, "age_max", "ms", "an older plane is none"},
    {0x0C07, EXH_Q_POS, EXH_WHEN_REST, 0, EXH_Q(5, 100, EXH_Q_POS), EXH_Q(5, 1000, EXH_Q_POS),
        "d_doubt", "m", "touching so far before d_lim and d_hyst is in doubt"},
    {0x0C08, 0, EXH_WHEN_SETUP, 1, 60000, 100, "doubt_max", "ms",
        "a contact longer in doubt is let go"},
    {0x0C09, 0, EXH_WHEN_SETUP, 1, 60000, 50, "tip_age_max", "ms", "an older fingertip is unknown"},
    {0x0C0A, 0, EXH_WHEN_BOUND, 1, SLEW_MAX_NPS, 100, "late_slew", "n_per_s",
        "rise of force where a plane came too late"},
};

/* The smallest number of ticks longer than ms. At most 1.2 million: one minute at 20 kHz. */
static uint32_t more_than(int32_t ms, struct exh_period T) { return exh_ticks_in(ms, T) + 1; }

int exh_precontact_setup(struct exh_precontact_cfg *cfg, const struct exh_precontact_par *par,
    const struct exh_material_par *material, unsigned materials, int32_t pad_m_q30,
    struct exh_period T)
{
    if (!exh_period_ok(T)) { return -EXH_E_RATE; }
    if (materials < 1 || materials > MATERIALS_MAX || pad_m_q30 < 0 ||
        pad_m_q30 > EXH_PAD_MAX_M_Q30 ||
        !exh_rows_validate(exh_precontact_rows, EXH_PRECONTACT_ROWS, par)) {
        return -EXH_E_RANGE;
    }
    for (unsigned i = 0; i < materials; i++) {
        if (!exh_rows_validate(exh_material_rows, EXH_MATERIAL_ROWS, &material[i])) {
            return -EXH_E_RANGE;
        }
    }
    cfg->par = par;
    cfg->material = material;
    cfg->materials = (uint8_t)materials;
    cfg->pad_m_q60 =
        (int64_t)(par->printed_sign ? -pad_m_q30 : pad_m_q30) * (INT64_C(1) << EXH_Q_POS);
    cfg->age_ticks = more_than(par->age_max_ms, T);
    cfg->doubt_ticks = more_than(par->doubt_ms, T);
    cfg->tip_ticks = more_than(par->tip_age_max_ms, T);
    return 0;
}

/* --- planes --- */

static int64_t dot(const struct exh_vec3 *a, const struct exh_vec3 *b)
{
    return (int64_t)a->x * b->x + (int64_t)a->y * b->y + (int64_t)a->z * b->z;
}

/* | |n|^2 - 1 | <= 2^-16: then no product with any vector overflows, and d at 5 mm is exact to 0.04
 * um. A normal in float has 2^-23. */
static int is_unit(const struct exh_vec3 *n_q30)
{
    const uint64_t one_q60 = UINT64_C(1) << 60, tol_q60 = UINT64_C(1) << 44;
    const uint64_t square_q60 = (uint64_t)((int64_t)n_q30->x * n_q30->x) +
                                (uint64_t)((int64_t)n_q30->y * n_q30->y) +
                                (uint64_t)((int64_t)n_q30->z * n_q30->z);
    return square_q60 - (one_q60 - tol_q60) <= 2 * tol_q60;
}

static int is_same(const struct exh_precontact_plane *a, const struct exh_precontact_plane *b)
{
    return a->offset_m_q60 == b->offset_m_q60 && a->normal_q30.x == b->normal_q30.x &&
           a->normal_q30.y == b->normal_q30.y && a->normal_q30.z == b->normal_q30.z &&
           a->object == b->object && a->material == b->material;
}

int exh_precontact_update(struct exh_precontact *s, const struct exh_precontact_cfg *cfg,
    const struct exh_plane *plane, uint32_t age_ticks)
{
    struct exh_precontact_plane now = {0, {0, 0, 0}, 0, 0};
    uint32_t left = 0;
    if (plane->kind == EXH_PLANE_UNTOLD) { return 0; }
    if (plane->kind == EXH_PLANE_NONE) {
        s->met = 1; /* if the device pulls in the next tick */
    } else {
        if (plane->kind != EXH_PLANE_HIT || plane->material >= cfg->materials ||
            !is_unit(&plane->normal_q30)) {
            s->refused_n++;
            return -EXH_E_RANGE;
        }
        now.normal_q30 = plane->normal_q30;
        now.offset_m_q60 =
            exh_wrap_add64(dot(&plane->normal_q30, &plane->point_m_q30) + HALF_Q60, cfg->pad_m_q60);
        now.object = plane->object;
        now.material = plane->material;
        left = age_ticks < cfg->age_ticks ? cfg->age_ticks - age_ticks : 0;
    }
    s->told = (uint8_t)(left > 0 && s->told > 0 && now.object == s->newest.object ? 2 : left > 0);
    if (s->phase == EXH_PRECONTACT_FROZEN) {
        s->ignored_n += !is_same(&now, &s->held);
    } else if (left == 0 || now.object != s->newest.object) {
        s->phase = EXH_PRECONTACT_IDLE;
    }
    s->newest = now;
    s->left_ticks = left;
    return 0;
}

/* --- the tick --- */

static int32_t distance_m_q30(const struct exh_precontact_plane *p, const struct exh_vec3 *tip)
{
    return exh_sat32(exh_wrap_diff64(p->offset_m_q60, dot(&p->normal_q30, tip)) >> EXH_Q_POS);
}

/* s from the slope of the string: when q grows by 1, d changes by -(n.slope), and it must change by
 * -d. For a finger that does not approach, s is the end of its range. */
static int32_t scale_of_slope(
    const struct exh_vec3 *normal_q30, const struct exh_vec3 *slope_q24, uint32_t *bits)
{
    const int64_t g_q24 = exh_shr_round(-dot(normal_q30, slope_q24), 30);
    const int32_t kept_q24 = exh_clamp(g_q24, SCALE_MIN_Q24, SCALE_MAX_Q24);
    if (kept_q24 != g_q24) { *bits |= EXH_PRECONTACT_BENT; }
    return exh_recip_q24(kept_q24);
}

static uint32_t place(struct exh_precontact *s, const struct exh_precontact_par *par,
    const struct exh_precontact_in *in)
{
    uint32_t bits = 0;
    const int32_t scale_q24 = par->from_slope
                                  ? scale_of_slope(&s->newest.normal_q30, &in->slope_q24, &bits)
                                  : par->scale_q24;
    s->lim_m_q30 = exh_clamp(
        in->pos_m_q30 - exh_mul_shr(scale_q24, s->d_m_q30, 24), INT32_MIN, EXH_PRECONTACT_NO_LIM);
    return bits;
}

/* The d below which q_lim moves. For a finger that has been there with this plane: d_lim. For one
 * that has not: the touch. For one that was inside: a hysteresis before the touch. */
static int32_t follows_until(const struct exh_precontact *s, const struct exh_precontact_par *par)
{
    const int32_t out_m_q30 = s->phase == EXH_PRECONTACT_INSIDE ? -par->hyst_m_q30 : 0;
    if (s->phase == EXH_PRECONTACT_TRACK && !s->near) { return par->d_lim_m_q30; }
    return exh_clamp32(out_m_q30, par->d_lim_m_q30, TOUCH_M_Q30);
}

static uint32_t track(struct exh_precontact *s, const struct exh_precontact_par *par,
    const struct exh_precontact_in *in)
{
    s->near = s->d_m_q30 >= par->d_lim_m_q30;
    s->met = in->pulls != 0;
    s->phase = EXH_PRECONTACT_TRACK;
    return EXH_PRECONTACT_TRACKS | place(s, par, in);
}

/* Freezes q_lim, which stays unchanged. */
static uint32_t freeze(struct exh_precontact *s, const struct exh_precontact_cfg *cfg,
    const struct exh_precontact_in *in)
{
    const uint8_t m = s->newest.material;
    s->held = s->newest;
    /* A restored state may contain a larger index. */
    s->taken = cfg->material[m < cfg->materials ? m : 0];
    s->frozen_n++;
    s->ahead_m_q30 = exh_clamp((int64_t)s->lim_m_q30 - in->pos_m_q30, INT32_MIN, INT32_MAX);
    s->phase = EXH_PRECONTACT_FROZEN;
    return EXH_PRECONTACT_STANDS | EXH_PRECONTACT_FREEZE;
}

static uint32_t be_inside(struct exh_precontact *s)
{
    s->born_n += s->phase != EXH_PRECONTACT_INSIDE;
    s->lim_m_q30 = EXH_PRECONTACT_NO_LIM;
    s->phase = EXH_PRECONTACT_INSIDE;
    return EXH_PRECONTACT_AROUND;
}

/* A wall far before the finger would pull it there. So a finger that does not move inwards is not
 * late, nor one whose string moves much more than its fingertip. */
static uint32_t be_late(struct exh_precontact *s, const struct exh_precontact_cfg *cfg,
    const struct exh_precontact_in *in)
{
    const uint32_t bits = place(s, cfg->par, in);
    if ((bits & EXH_PRECONTACT_BENT) ||
        (int64_t)in->pos_m_q30 - s->lim_m_q30 > LATE_SCALE * (int64_t)s->d_m_q30) {
        return be_inside(s);
    }
    s->late_n++;
    s->late_m_q30 = s->d_m_q30;
    s->late = 1;
    s->near = 0;
    return EXH_PRECONTACT_LATE | freeze(s, cfg, in);
}

/* One message may be an error of the world; two in a row are accepted. */
static uint32_t be_told_again(struct exh_precontact *s)
{
    s->lim_m_q30 = EXH_PRECONTACT_NO_LIM;
    return EXH_PRECONTACT_AROUND;
}

static uint32_t be_idle(struct exh_precontact *s, uint32_t left)
{
    const struct exh_vec3 *n = &s->newest.normal_q30;
    const int stale = left == 0 && (n->x | n->y | n->z) != 0;
    s->stale_n += stale && s->phase == EXH_PRECONTACT_TRACK;
    s->d_m_q30 = INT32_MIN;
    s->lim_m_q30 = EXH_PRECONTACT_NO_LIM;
    s->phase = EXH_PRECONTACT_IDLE;
    return stale ? EXH_PRECONTACT_STALE : 0;
}

/* For a finger that moved around or through the frozen surface, the string alone decides. */
static int went_back(const struct exh_precontact *s, const struct exh_precontact_par *par,
    const struct exh_precontact_in *in)
{
    const int64_t ahead_m_q30 = (int64_t)s->lim_m_q30 - in->pos_m_q30;
    return ahead_m_q30 > (int64_t)s->ahead_m_q30 - par->d_lim_m_q30;
}

/* A tick of a frozen finger. Sets EXH_PRECONTACT_RELEASE if the freeze ends. */
static uint32_t stand(struct exh_precontact *s, const struct exh_precontact_cfg *cfg,
    const struct exh_precontact_in *in, uint32_t blind)
{
    const int64_t free_m_q30 =
        (s->near ? 0 : (int64_t)cfg->par->d_lim_m_q30) - cfg->par->hyst_m_q30;
    const uint32_t late = s->late ? EXH_PRECONTACT_LATE : 0u;
    s->d_m_q30 = distance_m_q30(&s->held, &in->tip_m_q30);
    if (blind || (in->touching && s->d_m_q30 < free_m_q30 - cfg->par->doubt_m_q30)) {
        s->doubt_ticks += s->doubt_ticks < UINT32_MAX;
        if (s->doubt_ticks <= cfg->doubt_ticks) {
            return EXH_PRECONTACT_STANDS | EXH_PRECONTACT_DOUBT | late;
        }
        s->let_go_n++;
        s->late = 0;
        s->lim_m_q30 = EXH_PRECONTACT_NO_LIM;
        s->phase = EXH_PRECONTACT_IDLE;
        return EXH_PRECONTACT_RELEASE | EXH_PRECONTACT_DOUBT | EXH_PRECONTACT_LETGO;
    }
    s->doubt_ticks = 0;
    if (in->touching || (s->d_m_q30 >= free_m_q30 && !went_back(s, cfg->par, in))) {
        return EXH_PRECONTACT_STANDS | late;
    }
    s->phase = EXH_PRECONTACT_IDLE;
    return EXH_PRECONTACT_RELEASE;
}

void exh_precontact_advance(struct exh_precontact *s, uint32_t missed)
{
    s->left_ticks -= missed < s->left_ticks ? missed : s->left_ticks;
    if (s->doubt_ticks > 0) {
        s->doubt_ticks +=
            missed < UINT32_MAX - s->doubt_ticks ? missed : UINT32_MAX - s->doubt_ticks;
    }
}

uint32_t exh_precontact_step(struct exh_precontact *s, const struct exh_precontact_cfg *cfg,
    const struct exh_precontact_in *in)
{
    const struct exh_precontact_par *par = cfg->par;
    /* Limited: a restored state may contain more. */
    const uint32_t left = s->left_ticks < cfg->age_ticks ? s->left_ticks : cfg->age_ticks;
    const uint32_t blind = in->tip_age_ticks >= cfg->tip_ticks ? EXH_PRECONTACT_BLIND : 0;
    const int resumed = s->resumed;
    uint32_t bits = blind;
    s->resumed = 0;
    s->left_ticks = left - (left > 0);
    if (!in->pulls) { s->met = 0; }
    if (s->phase == EXH_PRECONTACT_FROZEN) {
        bits |= stand(s, cfg, in, blind);
        if (bits & (EXH_PRECONTACT_STANDS | EXH_PRECONTACT_LETGO)) { return bits; }
    }
    s->doubt_ticks = 0;
    s->late = 0;
    if (left == 0 || blind) { return bits | be_idle(s, left); }
    s->d_m_q30 = distance_m_q30(&s->newest, &in->tip_m_q30);
    if (s->d_m_q30 < follows_until(s, par)) { return bits | track(s, par, in); }
    if (s->phase == EXH_PRECONTACT_TRACK) {
        return bits |
               (resumed && in->pos_m_q30 >= s->lim_m_q30 ? be_inside(s) : freeze(s, cfg, in));
    }
    if (s->phase == EXH_PRECONTACT_IDLE && s->met && !resumed &&
        in->vel_mps_q27 > RUNS_OUT_MPS_Q27) {
        return bits | (s->told < 2 ? be_told_again(s) : be_late(s, cfg, in));
    }
    return bits | be_inside(s);
}

/* --- state --- */

/* Refuses planes that exh_precontact_update() cannot have stored. */
static int plane_bytes(struct exh_bytes *c, struct exh_precontact_plane *p)
{
    const int64_t most_q60 = INT64_C(1) << 62; /* above |n|*|P| + pad of any point */
    exh_bytes_i64(c, &p->offset_m_q60);
    exh_bytes_vec3(c, &p->normal_q30);
    exh_bytes_u16(c, &p->object);
    exh_bytes_u8(c, &p->material);
    if (is_unit(&p->normal_q30) && p->offset_m_q60 >= -most_q60 && p->offset_m_q60 <= most_q60) {
        return 1;
    }
    *p = (struct exh_precontact_plane){0, {0, 0, 0}, 0, 0};
    return 0;
}

/* In the order of the rows; brings each value into its range. */
static void taken_bytes(struct exh_bytes *c, struct exh_material_par *m)
{
    int32_t *const v[EXH_MATERIAL_ROWS] = {&m->k_Npm_q10, &m->b_Nspm_q20, &m->f_max_N_q20};
    for (int i = 0; i < EXH_MATERIAL_ROWS; i++) {
        exh_bytes_i32(c, v[i]);
        *v[i] = exh_clamp32(*v[i], exh_material_rows[i].min, exh_material_rows[i].max);
    }
}

void exh_precontact_serialize(struct exh_bytes *c, struct exh_precontact *s)
{
    int told, held;
    exh_bytes_i32(c, &s->d_m_q30);
    exh_bytes_i32(c, &s->lim_m_q30);
    taken_bytes(c, &s->taken);
    exh_bytes_u8(c, &s->phase);
    told = plane_bytes(c, &s->newest);
    held = plane_bytes(c, &s->held);
    exh_bytes_u32(c, &s->left_ticks);
    exh_bytes_u32(c, &s->frozen_n);
    exh_bytes_u32(c, &s->born_n);
    exh_bytes_u32(c, &s->refused_n);
    exh_bytes_u32(c, &s->ignored_n);
    exh_bytes_u32(c, &s->stale_n);
    exh_bytes_u32(c, &s->doubt_ticks);
    exh_bytes_u32(c, &s->let_go_n);
    exh_bytes_u32(c, &s->late_n);
    exh_bytes_i32(c, &s->late_m_q30);
    exh_bytes_i32(c, &s->ahead_m_q30);
    exh_bytes_u8(c, &s->met);
    exh_bytes_u8(c, &s->near);
    exh_bytes_u8(c, &s->late);
    exh_bytes_u8(c, &s->told);
    s->met &= 1u;
    s->near &= 1u;
    s->late &= 1u;
    if (c->mode == EXH_BYTES_READ) { s->resumed = 1; }
    if (s->phase > EXH_PRECONTACT_FROZEN || !(s->phase == EXH_PRECONTACT_FROZEN ? held : told)) {
        s->phase = EXH_PRECONTACT_IDLE;
    }
    if (!told) { s->left_ticks = s->told = 0; }
    if (s->told > 2) { s->told = 2; }
}
