/* SPDX-License-Identifier: MIT */
/* Quadrature decoding; counts of a board extended to 32 bits and scaled to metres. */
#include "exhand/quad.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/units.h"

#define STEP_MIN_M_Q42    EXH_Q(1, 1000000, EXH_Q_STEP)
#define SPEED_MIN_MPS_Q27 EXH_Q(1, 10, EXH_Q_VEL)

const struct exh_signal exh_quad_rows[EXH_QUAD_ROWS] = {
    {0x0201, EXH_Q_STEP, EXH_WHEN_SETUP, STEP_MIN_M_Q42, INT32_MAX,
        EXH_Q(6632, 100000000, EXH_Q_STEP), "step", "m", "string per encoder count"},
    /* Above the fastest hand: a larger step is no movement. */
    {0x0202, EXH_Q_VEL, EXH_WHEN_SETUP, SPEED_MIN_MPS_Q27, INT32_MAX, EXH_Q(10, 1, EXH_Q_VEL),
        "speed_max", "m_per_s", "faster is an encoder fault"},
};

/* --- two lines --- */

/* Three sums of up to 255 samples fit into one word. The count may fall, so it is the top one and
 * borrows from no other. */
#define RUN_MAX 255u
#define EDGE    0x100u
#define UP      (EDGE + 0x10000u)
#define DOWN    (EDGE - 0x10000u)
#define ILL     1u
const struct exh_quad_mode exh_quad_x1 = {
    {0, EDGE, EDGE, ILL, EDGE, 0, ILL, UP, EDGE, ILL, 0, EDGE, ILL, DOWN, EDGE, 0}};
const struct exh_quad_mode exh_quad_x2 = {
    {0, EDGE, DOWN, ILL, EDGE, 0, ILL, UP, UP, ILL, 0, EDGE, ILL, DOWN, EDGE, 0}};
const struct exh_quad_mode exh_quad_x4 = {
    {0, UP, DOWN, ILL, DOWN, 0, ILL, UP, UP, ILL, 0, DOWN, ILL, DOWN, UP, 0}};

static void add(struct exh_quad_ab *s, uint32_t sums)
{
    s->cnt = exh_wrap_add(s->cnt, exh_from_u32(sums) >> 16);
    s->edges += sums >> 8 & 0xFF;
    s->illegal += sums & 0xFF;
}

void exh_quad_ab_step(struct exh_quad_ab *s, const struct exh_quad_mode *mode, unsigned ab)
{
    const unsigned now = ab & 3u;
    if (s->started) { add(s, mode->adds[(unsigned)s->ab << 2 | now]); }
    s->ab = (uint8_t)now;
    s->started = 1;
}

void exh_quad_ab_run(
    struct exh_quad_ab *s, const struct exh_quad_mode *mode, const uint8_t *ab, size_t n)
{
    uint32_t past; /* samples, the last one in the low bits */
    if (n == 0) { return; }
    past = s->started ? s->ab : ab[0];
    while (n > 0) {
        const uint8_t *const end = ab + (n < RUN_MAX ? n : RUN_MAX);
        uint32_t sums = 0;
        n -= (size_t)(end - ab);
        do {
            past = past << 2 | (*ab++ & 3u);
            sums += mode->adds[past & 15u];
        } while (ab != end);
        add(s, sums);
    }
    s->ab = past & 3u;
    s->started = 1;
}

/* Number of ones in 64 bits: sums of 2, 4 and 8 in parallel, then all. */
static uint32_t ones(uint64_t x)
{
    x -= x >> 1 & UINT64_C(0x5555555555555555);
    x = (x & UINT64_C(0x3333333333333333)) + (x >> 2 & UINT64_C(0x3333333333333333));
    x = (x + (x >> 4)) & UINT64_C(0x0F0F0F0F0F0F0F0F);
    return ((uint32_t)x + (uint32_t)(x >> 32)) * 0x01010101u >> 24;
}

void exh_quad_ab_word(struct exh_quad_ab *s, uint64_t a, uint64_t b)
{
    const uint64_t was_a = a << 1 | (s->started ? (uint64_t)s->ab >> 1 : a & 1);
    const uint64_t was_b = b << 1 | (s->started ? (uint64_t)s->ab & 1 : b & 1);
    const uint64_t moved_a = a ^ was_a, moved_b = b ^ was_b;
    const uint64_t edge = moved_a ^ moved_b;
    const uint64_t up = edge & (was_a ^ b); /* where a changes, b is stable, and the reverse */
    const uint32_t edges = ones(edge);

    s->cnt = exh_wrap_add(s->cnt, exh_from_u32(2 * ones(up) - edges));
    s->edges += edges;
    s->illegal += ones(moved_a & moved_b);
    s->ab = (uint8_t)((a >> 63) << 1 | b >> 63);
    s->started = 1;
}

void exh_quad_index_step(struct exh_quad_index *s, int32_t cnt, unsigned level)
{
    const uint8_t now = level & 1u;
    if (s->started && now > s->level) {
        s->cnt = cnt;
        s->seen++;
    }
    s->level = now;
    s->started = 1;
}

/* --- a counter --- */

int exh_quad_setup(
    struct exh_quad_cfg *cfg, const struct exh_quad_par *par, struct exh_period T, unsigned bits)
{
    struct exh_gain per_tick; /* counts per m/s q27 */
    int64_t jump;
    if (!exh_period_ok(T)) { return -EXH_E_RATE; }
    if (bits < 16 || bits > 32 || par->step_m_q42 < STEP_MIN_M_Q42 ||
        par->speed_max_mps_q27 < SPEED_MIN_MPS_Q27 ||
        exh_gain_set(&per_tick, (uint64_t)T.num << (EXH_Q_STEP - EXH_Q_VEL),
            (uint64_t)(uint32_t)par->step_m_q42 * T.den) < 0) {
        return -EXH_E_RANGE;
    }
    jump = exh_gain_mul(per_tick, par->speed_max_mps_q27) + 1;
    if (jump >= INT64_C(1) << (bits - 2)) { return -EXH_E_RANGE; }
    cfg->par = par;
    cfg->jump_cnt = (int32_t)jump;
    cfg->unused = (uint8_t)(32u - bits);
    return 0;
}

int32_t exh_quad_step(struct exh_quad *s, const struct exh_quad_cfg *cfg, uint32_t raw)
{
    /* At the top of the word, the wrap of the counter is the wrap of the word. */
    const int32_t moved = exh_from_u32((raw - s->raw) << (cfg->unused & 31)) >> (cfg->unused & 31);

    const int jump = moved > cfg->jump_cnt || moved < -cfg->jump_cnt;

    /* The position after a jump is unknown, so lost outlives the jump. */
    if (s->started && jump) { s->lost = 1; }
    if (s->started && !jump) { s->cnt = exh_wrap_add(s->cnt, moved); }
    s->raw = raw;
    s->started = 1;
    return s->cnt;
}

int32_t exh_quad_pos_m_q30(const struct exh_quad_par *par, int32_t cnt)
{
    return exh_sat32(exh_mul_shr(cnt, par->step_m_q42, EXH_Q_STEP - EXH_Q_POS));
}

void exh_quad_serialize(struct exh_bytes *c, struct exh_quad *s)
{
    exh_bytes_u32(c, &s->raw);
    exh_bytes_i32(c, &s->cnt);
    exh_bytes_u8(c, &s->started);
    exh_bytes_u8(c, &s->lost);
}

void exh_quad_ab_serialize(struct exh_bytes *c, struct exh_quad_ab *s)
{
    exh_bytes_i32(c, &s->cnt);
    exh_bytes_u32(c, &s->edges);
    exh_bytes_u32(c, &s->illegal);
    exh_bytes_u8(c, &s->ab);
    exh_bytes_u8(c, &s->started);
    s->ab &= 3; /* a table index; bytes may be damaged */
}

void exh_quad_index_serialize(struct exh_bytes *c, struct exh_quad_index *s)
{
    exh_bytes_i32(c, &s->cnt);
    exh_bytes_u32(c, &s->seen);
    exh_bytes_u8(c, &s->level);
    exh_bytes_u8(c, &s->started);
    s->level &= 1;
}
