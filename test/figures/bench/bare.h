/* SPDX-License-Identifier: MIT */
/* Bare integer code: the shortest code with the same accuracy, as one would write it for one
 * device. It has no ledger, no hysteresis, and no limits of its inputs. It is inline, as CMSIS's
 * controllers are. */
#ifndef BENCH_BARE_H
#define BENCH_BARE_H

#include <stdint.h>

static inline int64_t bare_round(int64_t x, unsigned bits)
{
    return (x + (INT64_C(1) << (bits - 1))) >> bits;
}

/* The contact law: contact test, F0 by the velocity's sign, two products rounded once each, clamp.
 * N, q20, of m, q30, and m/s, q27. */
struct bare_law {
    int32_t k_q10, b_q20, f0_q20, lim_q30, f_max_q20;
};

static inline int32_t bare_law(const struct bare_law *p, int32_t pos_q30, int32_t vel_q27)
{
    int32_t f = vel_q27 < 0 ? p->f0_q20 : 0;
    if (pos_q30 >= p->lim_q30) {
        f += (int32_t)bare_round((int64_t)p->k_q10 * (pos_q30 - p->lim_q30), 20);
        f += (int32_t)bare_round((int64_t)p->b_q20 * vel_q27, 27);
    }
    return f < 0 ? 0 : f > p->f_max_q20 ? p->f_max_q20 : f;
}

/* --- velocity out of counts: m/s, q27 --- */

struct bare_scale {
    int32_t gain; /* m/s q27 of a count a tick, times 2^shift */
    unsigned shift;
};

/* The difference to the last count, through a pole of 1 - 2^-n (0: none). */
struct bare_pole {
    struct bare_scale scale;
    unsigned n;
    int32_t v, last;
};

static inline int32_t bare_pole(struct bare_pole *s, int32_t cnt)
{
    const int32_t v = (int32_t)bare_round((int64_t)(cnt - s->last) * s->scale.gain, s->scale.shift);
    s->last = cnt;
    s->v += (v - s->v) >> s->n;
    return s->v;
}

/* Alpha-beta observer: position and velocity in counts and counts a tick, q32. */
struct bare_track {
    struct bare_scale scale;
    int32_t alpha_q31, beta_q31;
    int64_t pos, vel;
};

static inline int32_t bare_track(struct bare_track *s, int32_t cnt)
{
    int64_t off_q16;
    s->pos += s->vel;
    off_q16 = ((int64_t)cnt * (INT64_C(1) << 32) - s->pos) >> 16;
    s->pos += (off_q16 * s->alpha_q31) >> 15;
    s->vel += (off_q16 * s->beta_q31) >> 15;
    return (int32_t)(((s->vel >> 10) * s->scale.gain) >> (22 + s->scale.shift));
}

#endif
