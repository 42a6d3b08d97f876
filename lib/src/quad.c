#include "exhand/quad.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/units.h"

#define STEP_MIN_M_Q42    EXH_Q(1, 1000000, EXH_Q_STEP)
#define SPEED_MIN_MPS_Q27 EXH_Q(1, 10, EXH_Q_VEL)

const struct exh_signal exh_quad_rows[EXH_QUAD_ROWS] = {
    {0x0201, EXH_Q_STEP, EXH_WHEN_SETUP, STEP_MIN_M_Q42, INT32_MAX,
     EXH_Q(6632, 100000000, EXH_Q_STEP), "step", "m", "string per encoder count"},
    /* Beyond the fastest hand: what moves more is no movement. */
    {0x0202, EXH_Q_VEL, EXH_WHEN_SETUP, SPEED_MIN_MPS_Q27, INT32_MAX,
     EXH_Q(10, 1, EXH_Q_VEL), "speed_max", "m_per_s", "faster is an encoder fault"},
};

/* Step of each transition, index previous<<2 | now of A<<1 | B; ILL = both lines
 * changed. Up is 00 01 11 10. x1 counts between 01 and 11 only, so that noise on
 * B cannot move the count. */
#define ILL 2
static const int8_t step_of[3][16] = {
    [EXH_QUAD_X1] = {0, 0, 0, ILL, 0, 0, ILL, 1, 0, ILL, 0, 0, ILL, -1, 0, 0},
    [EXH_QUAD_X2] = {0, 0, -1, ILL, 0, 0, ILL, 1, 1, ILL, 0, 0, ILL, -1, 0, 0},
    [EXH_QUAD_X4] = {0, 1, -1, ILL, -1, 0, ILL, 1, 1, ILL, 0, -1, ILL, -1, 1, 0},
};

void exh_quad_ab_step(struct exh_quad_ab *s, enum exh_quad_mode mode, unsigned a, unsigned b,
                      unsigned index)
{
    const uint8_t now = (uint8_t)((a & 1) << 1 | (b & 1));
    const uint8_t idx = (uint8_t)(index & 1);

    if (s->started) {
        const int8_t d = step_of[mode][s->ab << 2 | now];
        if (d == ILL) {
            s->illegal++;
        } else {
            s->edges += now != s->ab;
            s->cnt = exh_wrap_add(s->cnt, d);
        }
        if (idx > s->index) {
            s->index_cnt = s->cnt;
            s->indices++;
        }
    }
    s->ab = now;
    s->index = idx;
    s->started = 1;
}

int exh_quad_setup(struct exh_quad_cfg *cfg, const struct exh_quad_par *par, struct exh_period T,
                   unsigned bits)
{
    struct exh_gain per_tick; /* counts per m/s q27 */
    int64_t jump;
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

int32_t exh_quad_extend(struct exh_quad *s, const struct exh_quad_cfg *cfg, uint32_t raw)
{
    /* At the top of the word the counter's own wrap is the word's. */
    const int32_t moved = exh_from_u32((raw - s->raw) << cfg->unused) >> cfg->unused;

    const int jump = moved > cfg->jump_cnt || moved < -cfg->jump_cnt;

    /* Where the string is after a jump nobody knows: that outlives the jump. */
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

void exh_quad_bytes(struct exh_bytes *c, struct exh_quad *s)
{
    exh_bytes_u32(c, &s->raw);
    exh_bytes_i32(c, &s->cnt);
    exh_bytes_u8(c, &s->started);
    exh_bytes_u8(c, &s->lost);
}

void exh_quad_ab_bytes(struct exh_bytes *c, struct exh_quad_ab *s)
{
    exh_bytes_i32(c, &s->cnt);
    exh_bytes_u32(c, &s->edges);
    exh_bytes_u32(c, &s->illegal);
    exh_bytes_i32(c, &s->index_cnt);
    exh_bytes_u32(c, &s->indices);
    exh_bytes_u8(c, &s->ab);
    exh_bytes_u8(c, &s->index);
    exh_bytes_u8(c, &s->started);
    s->ab &= 3; /* an index into a table, from bytes */
    s->index &= 1;
}
