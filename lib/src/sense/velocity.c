/* SPDX-License-Identifier: MIT */
/* Velocity from a count: window, pole, adaptive window and observer. */
#include "exhand/velocity.h"

#include "exhand/error.h"
#include "exhand/fix.h"

const struct exh_signal exh_velocity_rows[EXH_VELOCITY_ROWS] = {
    {0x0301, 0, EXH_WHEN_SETUP, 0, 4, 1, "vel_p", "", "velocity window of 2^p ticks"},
};

/* Gain from a difference m to m/s q27, where v = m * step / (T * n). n < 2^13. */
static int scale(struct exh_gain *g, struct exh_velocity_scale s, uint32_t n)
{
    const uint64_t period = ((uint64_t)s.T.num * n) << (EXH_Q_STEP - EXH_Q_VEL);
    if (!exh_period_ok(s.T)) { return -EXH_E_RATE; }
    if (s.step_m_q42 <= 0) { return -EXH_E_RANGE; }
    return exh_gain_set(g, (uint64_t)(uint32_t)s.step_m_q42 * s.T.den, period);
}

/* T / (T + tau) in q31, at most 1 - 2^-31. */
static int32_t share_q31(struct exh_period T, uint32_t tau_us)
{
    const uint64_t t = (uint64_t)T.num * 1000000u;
    struct exh_gain g;
    /* For an invalid period; the caller has checked it. */
    if (exh_gain_set(&g, t, t + (uint64_t)T.den * tau_us) < 0 || g.shift < 31) { return INT32_MAX; }
    return g.shift == 31 ? g.mant : (int32_t)exh_shr_round(g.mant, g.shift - 31u);
}

int exh_velocity_window_setup(struct exh_velocity_window_cfg *cfg, struct exh_velocity_scale s,
    const struct exh_velocity_par *par)
{
    if (par->p < 0 || par->p > 4) { return -EXH_E_RANGE; }
    cfg->n = (uint8_t)(1u << par->p);
    return scale(&cfg->gain, s, cfg->n);
}

int32_t exh_velocity_window_step(
    struct exh_velocity_window *s, const struct exh_velocity_window_cfg *cfg, int32_t cnt)
{
    int32_t moved;
    if (!s->started) {
        for (unsigned i = 0; i < EXH_VELOCITY_N; i++) { s->cnt[i] = cnt; }
        s->started = 1;
    }
    moved = exh_wrap_diff(cnt, s->cnt[s->at]);
    s->cnt[s->at] = cnt;
    s->at =
        (uint8_t)((s->at + 1u) & (cfg->n - 1u) & (EXH_VELOCITY_N - 1u)); /* n: damaged, perhaps */
    return exh_sat32(exh_gain_mul(cfg->gain, moved));
}

void exh_velocity_window_serialize(struct exh_bytes *c, struct exh_velocity_window *s)
{
    for (unsigned i = 0; i < EXH_VELOCITY_N; i++) { exh_bytes_i32(c, &s->cnt[i]); }
    exh_bytes_u8(c, &s->at);
    exh_bytes_u8(c, &s->started);
    s->at %= EXH_VELOCITY_N; /* an index; bytes may be damaged */
}

#define POLE_MAX_MPS_Q55 (INT64_C(16) << 55)

int exh_velocity_pole_setup(
    struct exh_velocity_pole_cfg *cfg, struct exh_velocity_scale s, uint32_t tau_us)
{
    if (tau_us > 1000000u) { return -EXH_E_RANGE; }
    cfg->a_q31 = share_q31(s.T, tau_us);
    return scale(&cfg->gain, s, 1);
}

int32_t exh_velocity_pole_step(
    struct exh_velocity_pole *s, const struct exh_velocity_pole_cfg *cfg, int32_t cnt)
{
    const int32_t moved = s->started ? exh_wrap_diff(cnt, s->cnt) : 0;
    const int64_t diff_q55 =
        (int64_t)exh_sat32(exh_gain_mul(cfg->gain, moved)) * (INT32_C(1) << 28);
    s->cnt = cnt;
    s->started = 1;
    /* Modulo 2^64: a damaged share may have any value. */
    s->v_mps_q55 = exh_wrap_add64(
        s->v_mps_q55, exh_mul64_q31(exh_wrap_diff64(diff_q55, s->v_mps_q55), cfg->a_q31));
    return exh_sat32(exh_shr_round(s->v_mps_q55, 28));
}

void exh_velocity_pole_serialize(struct exh_bytes *c, struct exh_velocity_pole *s)
{
    exh_bytes_i64(c, &s->v_mps_q55);
    s->v_mps_q55 = exh_clamp64(s->v_mps_q55, POLE_MAX_MPS_Q55);
    exh_bytes_i32(c, &s->cnt);
    exh_bytes_u8(c, &s->started);
}

int exh_velocity_foaw_setup(
    struct exh_velocity_foaw_cfg *cfg, struct exh_velocity_scale s, unsigned n, unsigned tol_cnt)
{
    int err = n < 1 || n > EXH_VELOCITY_N || tol_cnt < 1 || tol_cnt > 255 ? -EXH_E_RANGE : 0;
    uint32_t sum = 0, weight = 0; /* sum of the weights m(m+1)(m+2)/6 */
    cfg->n = (uint8_t)n;
    cfg->tol_cnt = (uint8_t)tol_cnt;
    for (uint32_t m = 1; err == 0 && m <= n; m++) {
        sum += m;
        weight += sum;
        err = scale(&cfg->gain[m - 1], s, weight);
    }
    return err;
}

/* Slopes as integers, in units of M = 12252240. Each n and each n(n+1)(n+2)/6 up to 16 divides M;
 * the table contains M/n and M divided by the latter. */
static const struct part {
    int32_t each, fit;
} part[EXH_VELOCITY_N] = {{12252240, 12252240}, {6126120, 3063060}, {4084080, 1225224},
    {3063060, 612612}, {2450448, 350064}, {2042040, 218790}, {1750320, 145860}, {1531530, 102102},
    {1361360, 74256}, {1225224, 55692}, {1113840, 42840}, {1021020, 33660}, {942480, 26928},
    {875160, 21879}, {816816, 18018}, {765765, 15015}};

/* g*m rounded half up and saturated, for |m| < 2^42. If m needs more than 32 bits, a gain of 1 or
 * more saturates. For smaller gains the product has two parts; the first shift is a floor, so only
 * the last one rounds. */
static int32_t wide_gain(struct exh_gain g, int64_t m)
{
    if (m == exh_clamp(m, INT32_MIN, INT32_MAX)) { return exh_sat32(exh_gain_mul(g, (int32_t)m)); }
    if (g.shift < 31) { return exh_sat32(m); }
    if (g.shift == 31) { return exh_sat32(exh_mul64_q31(m, g.mant)); }
    return exh_sat32(exh_shr_round(
        (m >> 31) * g.mant + ((m & INT32_MAX) * g.mant >> 31), ((g.shift - 32u) & 31u) + 1u));
}

/* A window fits if its slope lies between those of all lines through the newest sample that pass
 * each sample within tol. The bounds accumulate from window to window, so the first misfit ends the
 * search. Windows look back, so slopes here are those of -y. */
int32_t exh_velocity_foaw_step(
    struct exh_velocity_foaw *s, const struct exh_velocity_foaw_cfg *cfg, int32_t cnt)
{
    const uint32_t longest = cfg->n < EXH_VELOCITY_N ? cfg->n : EXH_VELOCITY_N;
    const uint32_t most = longest < s->have ? longest : s->have;
    const int64_t tol = cfg->tol_cnt;
    int64_t lo = INT64_MIN / 4, hi = INT64_MAX / 4;
    int64_t sum = 0, m = 0, best = 0;
    uint32_t n = 0, at = s->at;

    while (n < most) {
        const int64_t d = exh_wrap_diff(s->cnt[at & (EXH_VELOCITY_N - 1u)], cnt);
        const int64_t low = (d - tol) * part[n].each, high = low + 2 * tol * part[n].each;
        int64_t slope;
        at--;
        m += (int64_t)(n + 1) * d - sum; /* twice the sum of each sample times its n, */
        sum += d;                        /* minus n times their sum */
        lo = lo > low ? lo : low;
        hi = hi < high ? hi : high;
        slope = m * part[n].fit;
        if (slope < lo || slope > hi) { break; }
        best = m;
        n++;
    }
    s->at = (uint8_t)((s->at + 1u) & (EXH_VELOCITY_N - 1u));
    s->cnt[s->at] = cnt;
    if (s->have < EXH_VELOCITY_N) { s->have++; }
    return wide_gain(cfg->gain[n > 0 ? n - 1 : 0], -best);
}

void exh_velocity_foaw_serialize(struct exh_bytes *c, struct exh_velocity_foaw *s)
{
    for (unsigned i = 0; i < EXH_VELOCITY_N; i++) { exh_bytes_i32(c, &s->cnt[i]); }
    exh_bytes_u8(c, &s->at);
    exh_bytes_u8(c, &s->have);
}

int exh_velocity_track_setup(
    struct exh_velocity_track_cfg *cfg, struct exh_velocity_scale s, uint32_t tf_us)
{
    const int32_t a_q31 = share_q31(s.T, tf_us); /* 1 - theta */
    if (tf_us > 1000000u) { return -EXH_E_RANGE; }
    cfg->beta_q31 = (int32_t)exh_mul_shr(a_q31, a_q31, 31);
    cfg->alpha_q31 = exh_clamp(2 * (int64_t)a_q31 - cfg->beta_q31, 1, INT32_MAX);
    return scale(&cfg->gain, s, 1);
}

#define TRACK_MAX_CNT_Q32 (INT64_C(1) << 60)

int32_t exh_velocity_track_step(
    struct exh_velocity_track *s, const struct exh_velocity_track_cfg *cfg, int32_t cnt)
{
    const int32_t moved = s->started ? exh_wrap_diff(cnt, s->cnt) : 0;
    const int64_t moved_q32 =
        exh_clamp(moved, -(INT32_C(1) << 28), INT32_C(1) << 28) * (INT64_C(1) << 32);
    const int64_t off = exh_clamp64(s->err_cnt_q32 + s->vel_cnt_q32 - moved_q32, TRACK_MAX_CNT_Q32);

    s->cnt = cnt;
    s->started = 1;
    s->err_cnt_q32 = off - exh_mul64_q31(off, cfg->alpha_q31);
    s->vel_cnt_q32 =
        exh_clamp64(s->vel_cnt_q32 - exh_mul64_q31(off, cfg->beta_q31), TRACK_MAX_CNT_Q32);
    return exh_sat32(exh_shr_round(exh_mul64_q31(s->vel_cnt_q32, cfg->gain.mant),
        (cfg->gain.shift < 62u ? cfg->gain.shift : 62u) + 1u));
}

void exh_velocity_track_serialize(struct exh_bytes *c, struct exh_velocity_track *s)
{
    exh_bytes_i64(c, &s->err_cnt_q32);
    exh_bytes_i64(c, &s->vel_cnt_q32);
    s->err_cnt_q32 = exh_clamp64(s->err_cnt_q32, TRACK_MAX_CNT_Q32);
    s->vel_cnt_q32 = exh_clamp64(s->vel_cnt_q32, TRACK_MAX_CNT_Q32);
    exh_bytes_i32(c, &s->cnt);
    exh_bytes_u8(c, &s->started);
}
