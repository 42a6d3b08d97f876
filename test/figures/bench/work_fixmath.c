/* SPDX-License-Identifier: MIT */
/* libfixmath by hand into the rules that the plain ones have: its products, sines and
 * interpolation. Lengths are in millimetres and speeds in decimetres a second: the units in which
 * 16 fraction bits lose least. */
#include "peers_fixmath.h"
#include "work.h"

#include "exhand/hand.h"

#define CASES 200000u
#define MM    1000.0L

/* --- the law --- */

static const struct {
    fix16_t k_Npmm, b_Nspdm, f0_N, lim_mm, f_max_N;
} wall = {F16(WALL_K_NPM / 1000), F16(WALL_B_NSPM / 10), 0, 0, F16(100)};
static fix16_t op_mm[BENCH_OPS][WORK_FINGERS], op_dmps[BENCH_OPS][WORK_FINGERS];
static long double last_m;

static fix16_t law(fix16_t q_mm, fix16_t v_dmps)
{
    fix16_t f = v_dmps < 0 ? wall.f0_N : 0;
    if (q_mm >= wall.lim_mm) {
        f += fix16_mul(wall.k_Npmm, q_mm - wall.lim_mm) + fix16_mul(wall.b_Nspdm, v_dmps);
    }
    return fix16_clamp(f, 0, wall.f_max_N);
}

static fix16_t dmps(long double from_m, long double to_m)
{
    return fixmath_of(10 * (to_m - from_m) / (long double)WALL_T_S);
}

static void law_setup(void)
{
    wall_seed();
    last_m = 0;
    for (uint32_t i = 0; i < BENCH_OPS; i++) {
        for (uint32_t f = 0; f < WORK_FINGERS; f++) {
            const long double m = wall_cnt() * (long double)WALL_STEP_M;
            op_mm[i][f] = fixmath_of(MM * m);
            op_dmps[i][f] = dmps(last_m, m);
            last_m = m;
        }
    }
    wall_seed();
    last_m = 0;
}

static void law_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) { bench_sink = law(op_mm[i][f], op_dmps[i][f]); }
}

static long double law_off(uint32_t i)
{
    const long double m = wall_cnt() * (long double)WALL_STEP_M, from = last_m;
    (void)i;
    last_m = m;
    return law(fixmath_of(MM * m), dmps(from, m)) / 65536.0L - bench_clamp(wall_N(m, from), 0, 100);
}

/* --- the table, knots evenly spaced: 16 or 32 bits of the way to the next one --- */

static fix16_t lerp16(int32_t x)
{
    const int32_t *y = &curve_y[x >> 26];
    return fix16_lerp16(y[0], y[1], (uint16_t)(x >> 10));
}

static fix16_t lerp32(int32_t x)
{
    const int32_t *y = &curve_y[x >> 26];
    return fix16_lerp32(y[0], y[1], (uint32_t)x << 6);
}

#define CURVE(name) \
    static void name##_op(uint32_t i) { bench_sink = name(curve_at[i]); } \
    static long double name##_off(uint32_t i) \
    { \
        const int32_t x = bench_in(0, (int32_t)((CURVE_KNOTS - 1) << 26) - 1); \
        (void)i; \
        return 1e6L * (name(x) - curve_exact(x)) / 1073741824; \
    }
CURVE(lerp16)
CURVE(lerp32)

/* --- fingertips --- */

static struct {
    fix16_t len_mm[3], rot[3][3], base_mm[3];
} bones[WORK_FINGERS];
static fix16_t joint[BENCH_OPS][WORK_FINGERS][3];

static void hand_setup(void)
{
    hand_seed();
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        const struct exh_hand_bones *b = &exh_hit2_bones[f];
        for (int k = 0; k < 3; k++) {
            bones[f].len_mm[k] = fixmath_of(MM * bench_q(b->len_m_q34[k], 34));
            bones[f].base_mm[k] = fixmath_of(MM * bench_q(b->base_m_q32[k], 32));
            for (int j = 0; j < 3; j++) {
                bones[f].rot[k][j] = fixmath_of(bench_q(b->rot_q30[k][j], 30));
            }
            for (uint32_t i = 0; i < BENCH_OPS; i++) {
                joint[i][f][k] = fixmath_rad(hand_joint[i][f][k]);
            }
        }
    }
}

#define HAND(name, sine_of, cosine_of) \
    static void name##_tip(uint32_t f, const fix16_t q[3], fix16_t tip[3]) \
    { \
        const fix16_t sine0 = sine_of(q[0]), cosine0 = cosine_of(q[0]); \
        const fix16_t sine2 = sine_of(q[2]), cosine2 = cosine_of(q[2]); \
        fix16_t sine = sine_of(q[1]), cosine = cosine_of(q[1]); \
        fix16_t away = fix16_mul(bones[f].len_mm[0], cosine); \
        fix16_t up = fix16_mul(bones[f].len_mm[0], sine); \
        for (int i = 1; i < 3; i++) { \
            const fix16_t turned = fix16_mul(cosine, cosine2) - fix16_mul(sine, sine2); \
            sine = fix16_mul(sine, cosine2) + fix16_mul(cosine, sine2); \
            cosine = turned; \
            away += fix16_mul(bones[f].len_mm[i], cosine); \
            up += fix16_mul(bones[f].len_mm[i], sine); \
        } \
        for (int i = 0; i < 3; i++) { \
            const fix16_t side = \
                fix16_mul(bones[f].rot[i][0], cosine0) + fix16_mul(bones[f].rot[i][1], sine0); \
            tip[i] = \
                bones[f].base_mm[i] + fix16_mul(side, away) + fix16_mul(bones[f].rot[i][2], up); \
        } \
    } \
    static void name##_op(uint32_t i) \
    { \
        for (uint32_t f = 0; f < WORK_FINGERS; f++) { \
            fix16_t tip[3]; \
            name##_tip(f, joint[i][f], tip); \
            bench_sink = tip[0] ^ tip[1] ^ tip[2]; \
        } \
    } \
    static long double name##_off(uint32_t i) \
    { \
        int32_t q[3]; \
        fix16_t tip[3]; \
        hand_posture(q); \
        name##_tip(i % WORK_FINGERS, \
            (fix16_t[3]){fixmath_rad(q[0]), fixmath_rad(q[1]), fixmath_rad(q[2])}, tip); \
        return hand_off(i % WORK_FINGERS, q, \
            (double[3]){tip[0] / 65536e3, tip[1] / 65536e3, tip[2] / 65536e3}); \
    }
HAND(series, fix16_sin, fix16_cos)
HAND(lut, fixmath_lut_sin, fixmath_lut_cos)

/* --- distance and freeze rule --- */

static struct freeze {
    fix16_t n[3], offset, d_lim, hyst, d, lim;
    int frozen;
} plane[WORK_FINGERS];
static fix16_t tip_mm[BENCH_OPS][WORK_FINGERS][4]; /* and the string */
static int touches[BENCH_OPS][WORK_FINGERS];

static void freeze(struct freeze *s, const fix16_t tip[3], fix16_t pos, int touching)
{
    s->d = s->offset -
           (fix16_mul(s->n[0], tip[0]) + fix16_mul(s->n[1], tip[1]) + fix16_mul(s->n[2], tip[2]));
    if (s->frozen && !touching && s->d < s->d_lim - s->hyst) { s->frozen = 0; }
    if (!s->frozen && s->d >= s->d_lim) { s->frozen = 1; }
    if (!s->frozen) { s->lim = pos - s->d; }
}

static void tell(struct freeze *s, const struct freeze_case *c)
{
    *s = (struct freeze){.d_lim = F16(-5), .hyst = F16(1), .frozen = 1};
    for (int k = 0; k < 3; k++) { s->n[k] = fixmath_of(c->normal[k]); }
    s->offset = fixmath_of(MM * c->offset_m);
}

static void freeze_setup(void)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        struct freeze_case c;
        for (uint32_t i = 0; i < BENCH_OPS; i++) {
            freeze_path(i, f, &c);
            for (int k = 0; k < 3; k++) { tip_mm[i][f][k] = fixmath_of(MM * c.tip_m[k]); }
            tip_mm[i][f][3] = fixmath_of(MM * c.pos_m);
            touches[i][f] = c.touching;
        }
        tell(&plane[f], &c);
    }
    bench_seed();
}

static void freeze_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        freeze(&plane[f], tip_mm[i][f], tip_mm[i][f][3], touches[i][f]);
        bench_sink = plane[f].lim;
    }
}

static long double freeze_off(uint32_t i)
{
    struct freeze_case c;
    fix16_t tip[3];
    const long double d = freeze_any(&c);
    (void)i;
    tell(&plane[0], &c);
    for (int k = 0; k < 3; k++) { tip[k] = fixmath_of(MM * c.tip_m[k]); }
    freeze(&plane[0], tip, 0, 0);
    return plane[0].d / (65536 * MM) - d;
}

/* --- energy of a contact: newtons times 32 counts, which hold an hour of it and in which a count
 * is exact --- */

static struct {
    fix16_t way, energy, held;
    int32_t cnt;
    int touching;
} energy;

static fix16_t observe(int32_t cnt, int touching, fix16_t asked)
{
    const fix16_t way = (cnt - energy.cnt) * (fix16_one / 32);
    fix16_t limit = F16(ENERGY_F_MOST_N);
    energy.energy = fix16_sadd(energy.energy, fix16_mul(energy.held, way));
    if (energy.held <= 0 && (!touching || !energy.touching)) { energy.energy = 0; }
    energy.cnt = cnt;
    energy.touching = touching;
    if (energy.energy >= 0) { return asked; }
    limit += fix16_div(energy.energy, energy.way);
    return fix16_min(asked, fix16_max(limit, 0));
}

static void energy_setup(void)
{
    energy_seed();
    energy.way = fixmath_of(ENERGY_WAY_M / energy_step_m() / 32);
    energy.energy = energy.held = 0;
    energy.cnt = energy.touching = 0;
}

static void energy_op(uint32_t i)
{
    const int32_t cnt = energy_cnt[i];
    bench_sink = energy.held = observe(cnt, 1, cnt * F16(0.14));
}

static long double energy_off(uint32_t i)
{
    int32_t cnt, asked;
    const long double want = energy_next(&cnt, &asked);
    (void)i;
    (void)observe(cnt, 1, 0);
    energy.held = asked >> 4; /* what it can hold */
    energy_hold(energy.held << 4);
    return energy.energy / 65536.0L * 32 * energy_step_m() - want;
}

static const struct work works[] = {
    {"law", "libfixmath law", "integer", "N", WORK_HOUR, law_setup, law_op, law_off},
    {"table", "libfixmath lerp16", "integer", "ppm", 300000, curve_seed, lerp16_op, lerp16_off},
    {"table", "libfixmath lerp32", "integer", "ppm", 300000, curve_seed, lerp32_op, lerp32_off},
    {"hand", "libfixmath sines", "integer", "m", CASES, hand_setup, series_op, series_off},
    {"hand", "libfixmath 205 KB table", "integer", "m", CASES, hand_setup, lut_op, lut_off},
    {"precontact", "libfixmath freeze", "integer", "m", 300000, freeze_setup, freeze_op,
        freeze_off},
    {"passivity", "libfixmath observer", "integer", "J", WORK_HOUR, energy_setup, energy_op,
        energy_off},
};
const struct work_group fixmath_works = {works, sizeof works / sizeof works[0]};
