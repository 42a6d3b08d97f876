/* SPDX-License-Identifier: MIT */
#include "bare.h"

static inline int64_t rounded(int64_t x, unsigned bits)
{
    return (x + (INT64_C(1) << (bits - 1))) >> bits;
}

int32_t bare_law(const struct bare_law *p, int32_t pos_q30, int32_t vel_q27)
{
    int64_t f = vel_q27 < 0 ? p->f0_q20 : 0;
    if (pos_q30 >= p->lim_q30) {
        const int64_t spring_q40 = (int64_t)p->k_q10 * (pos_q30 - p->lim_q30);
        f += rounded(spring_q40 * 128 + (int64_t)p->b_q20 * vel_q27, 27);
    }
    return f < 0 ? 0 : f > p->f_max_q20 ? p->f_max_q20 : (int32_t)f;
}

int32_t bare_pole(struct bare_pole *s, int32_t cnt)
{
    const int32_t v = (int32_t)rounded((int64_t)(cnt - s->last) * s->scale.gain, s->scale.shift);
    s->last = cnt;
    s->v += (v - s->v) >> s->n;
    return s->v;
}

int32_t bare_track(struct bare_track *s, int32_t cnt)
{
    int64_t off_q16;
    s->pos += s->vel;
    off_q16 = ((int64_t)cnt * (INT64_C(1) << 32) - s->pos) >> 16;
    s->pos += (off_q16 * s->alpha_q31) >> 15;
    s->vel += (off_q16 * s->beta_q31) >> 15;
    return (int32_t)(((s->vel >> 10) * s->scale.gain) >> (22 + s->scale.shift));
}
