/* SPDX-License-Identifier: MIT */
/* Distance to a plane and the freeze rule, five fingers. */
#include "plain.h"
#include "work.h"

#include "exhand/error.h"
#include "exhand/precontact.h"

#include <math.h>

#define CASES 300000u
#define MM(x) EXH_Q(x, 1000, EXH_Q_POS)

static const struct exh_material_par material[1] = {{1 << 24, 1 << 24, 1 << 22}};
static const struct exh_precontact_par par = {
    -MM(5), MM(1), 1 << 24, 0, 0, 60000, MM(5), 100, 50, 100};
static struct exh_precontact_cfg cfg;
static struct exh_precontact finger[WORK_FINGERS];
static struct plain_freeze_double in_double[WORK_FINGERS];
static struct plain_freeze_float in_float[WORK_FINGERS];
static struct exh_precontact_in at[BENCH_OPS][WORK_FINGERS];
static double tip[BENCH_OPS][WORK_FINGERS][4]; /* and the string */
static float tip_f[BENCH_OPS][WORK_FINGERS][4];
static const struct exh_plane plane = {
    EXH_PLANE_HIT, 0, 1, {644245094, 0, 858993459}, {MM(60), 0, MM(80)}};

static double si(int32_t raw) { return raw * 0x1p-30; }

static void tell(uint32_t f, const struct exh_plane *p)
{
    const double n[3] = {si(p->normal_q30.x), si(p->normal_q30.y), si(p->normal_q30.z)};
    finger[f] = (struct exh_precontact){0};
    EXH_ASSERT(exh_precontact_update(&finger[f], &cfg, p, 0) == 0);
    in_double[f] = (struct plain_freeze_double){{n[0], n[1], n[2]}, 0, -0.005, 0.001, 0, 1, 0};
    in_double[f].offset = n[0] * si(p->point_m_q30.x) + n[1] * si(p->point_m_q30.y) +
                          n[2] * si(p->point_m_q30.z) + si(MM(7));
    in_float[f] = (struct plain_freeze_float){{(float)n[0], (float)n[1], (float)n[2]},
        (float)in_double[f].offset, -0.005f, 0.001f, 0, 1, 0};
}

/* 64 mm down and up again over 1024 ticks, onto (0.6, 0, 0.8). */
static struct exh_precontact_in on_path(uint32_t i, uint32_t f)
{
    const int32_t u = (int32_t)((i + 205 * f) % BENCH_OPS);
    const int32_t off = MM(60) - MM(70) / 512 * (u < 512 ? u : 1024 - u);
    return (struct exh_precontact_in){{MM(60) + off / 10 * 6, MM(3), MM(80) + off / 10 * 8},
        {0, 0, 0}, MM(100) - off, 0, off < -MM(7), 1, 0};
}

static void setup(void)
{
    EXH_ASSERT(
        exh_precontact_setup(&cfg, &par, material, 1, MM(7), (struct exh_period){1, 2000}) == 0);
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        for (uint32_t i = 0; i < BENCH_OPS; i++) {
            const struct exh_precontact_in in = on_path(i, f);
            const int32_t raw[4] = {in.tip_m_q30.x, in.tip_m_q30.y, in.tip_m_q30.z, in.pos_m_q30};
            at[i][f] = in;
            for (int k = 0; k < 4; k++) { tip_f[i][f][k] = (float)(tip[i][f][k] = si(raw[k])); }
        }
        tell(f, &plane);
    }
    bench_seed();
}

static void ours_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        bench_sink =
            exh_precontact_step(&finger[f], &cfg, &at[i][f]) + (int64_t)finger[f].lim_m_q30;
    }
}

static volatile double sink_double;
static volatile float sink_float;

static void double_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        plain_freeze_double(&in_double[f], tip[i][f], tip[i][f][3], at[i][f].touching);
        sink_double = in_double[f].lim;
    }
}

static void float_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        plain_freeze_float(&in_float[f], tip_f[i][f], tip_f[i][f][3], at[i][f].touching);
        sink_float = in_float[f].lim;
    }
}

/* --- errors: d of random planes and fingertips within half a metre --- */

static struct exh_vec3 any_vec(void)
{
    const int32_t x = bench_in(-MM(500), MM(500)), y = bench_in(-MM(500), MM(500));
    return (struct exh_vec3){x, y, bench_in(-MM(500), MM(500))};
}

static struct exh_vec3 any_unit(void)
{
    const struct exh_vec3 v = any_vec();
    const double x = v.x + 0.5, y = v.y, z = v.z, len = sqrt(x * x + y * y + z * z) * 0x1p-30;
    return (struct exh_vec3){(int32_t)(x / len), (int32_t)(y / len), (int32_t)(z / len)};
}

static long double dot(const struct exh_vec3 *a, const struct exh_vec3 *b)
{
    return (long double)((int64_t)a->x * b->x) + (long double)((int64_t)a->y * b->y) +
           (long double)((int64_t)a->z * b->z);
}

/* n P_C + t, m */
static long double offset_of(const struct exh_plane *p)
{
    return dot(&p->normal_q30, &p->point_m_q30) * 0x1p-60L + bench_q(MM(7), 30);
}

/* A plane and a fingertip; the exact d, m. */
static long double any_case(struct exh_plane *any, struct exh_vec3 *p)
{
    *any = plane;
    any->normal_q30 = any_unit();
    any->point_m_q30 = any_vec();
    *p = any_vec();
    return offset_of(any) - dot(&any->normal_q30, p) * 0x1p-60L;
}

/* The same, and it sends the plane. The tip is in *p. */
static long double next(struct exh_vec3 *p)
{
    struct exh_plane any;
    const long double d = any_case(&any, p);
    tell(0, &any);
    return d;
}

static void as_case(
    struct freeze_case *c, const struct exh_plane *p, const struct exh_precontact_in *in)
{
    for (int k = 0; k < 3; k++) {
        c->normal[k] = bench_q((&p->normal_q30.x)[k], 30);
        c->tip_m[k] = bench_q((&in->tip_m_q30.x)[k], 30);
    }
    c->offset_m = offset_of(p);
    c->pos_m = bench_q(in->pos_m_q30, 30);
    c->touching = (int)in->touching;
}

void freeze_path(uint32_t i, uint32_t f, struct freeze_case *c)
{
    const struct exh_precontact_in in = on_path(i, f);
    as_case(c, &plane, &in);
}

long double freeze_any(struct freeze_case *c)
{
    struct exh_precontact_in in = {{0, 0, 0}, {0, 0, 0}, 0, 0, 0, 1, 0};
    struct exh_plane any;
    const long double d = any_case(&any, &in.tip_m_q30);
    as_case(c, &any, &in);
    return d;
}

static long double ours_off(uint32_t i)
{
    struct exh_precontact_in in = {{0, 0, 0}, {0, 0, 0}, 0, 0, 0, 1, 0};
    const long double d = next(&in.tip_m_q30);
    (void)i;
    (void)exh_precontact_step(&finger[0], &cfg, &in);
    return bench_q(finger[0].d_m_q30, 30) - d;
}

static long double double_off(uint32_t i)
{
    struct exh_vec3 p;
    const long double d = next(&p);
    (void)i;
    plain_freeze_double(&in_double[0], (double[3]){si(p.x), si(p.y), si(p.z)}, 0, 0);
    return in_double[0].d - d;
}

static long double float_off(uint32_t i)
{
    struct exh_vec3 p;
    const long double d = next(&p);
    (void)i;
    plain_freeze_float(
        &in_float[0], (float[3]){(float)si(p.x), (float)si(p.y), (float)si(p.z)}, 0, 0);
    return in_float[0].d - d;
}

static const struct work works[] = {
    {"precontact", "exhand precontact", "ours", "m", CASES, setup, ours_op, ours_off},
    {"precontact", "plain double freeze", "float", "m", CASES, setup, double_op, double_off},
    {"precontact", "plain float freeze", "float", "m", CASES, setup, float_op, float_off},
};
const struct work_group freeze_works = {works, sizeof works / sizeof works[0]};
