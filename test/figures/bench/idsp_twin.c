/* SPDX-License-Identifier: MIT */
#include "idsp_twin.h"

#include <string.h>

#define CHANNELS 22

static inline int64_t times(int32_t a, int32_t b) { return (int64_t)a * b; }

/* Wraps, as the crate's sums do. */
static inline int64_t add(int64_t a, int64_t b) { return (int64_t)((uint64_t)a + (uint64_t)b); }

struct df1 {
    int32_t k[5], x[2], y[2];
    uint32_t e;
};

static inline int64_t of_inputs(const int32_t *k, int32_t x, const int32_t *last)
{
    return add(add(times(k[0], x), times(k[1], last[0])), times(k[2], last[1]));
}

static inline int64_t products(const struct df1 *c, int32_t x)
{
    return add(add(of_inputs(c->k, x, c->x), times(c->k[3], c->y[0])), times(c->k[4], c->y[1]));
}

static inline int32_t moved(struct df1 *c, int32_t x, int32_t y)
{
    c->x[1] = c->x[0];
    c->x[0] = x;
    c->y[1] = c->y[0];
    c->y[0] = y;
    return y;
}

static inline int32_t df1_once(struct df1 *c, int32_t x)
{
    return moved(c, x, (int32_t)(products(c, x) >> 30));
}

/* The fraction that was cut off is added to the next sample's sum. */
static inline int32_t dither_once(struct df1 *c, int32_t x)
{
    const uint64_t sum = ((uint64_t)products(c, x) + c->e) << 2;
    c->e = (uint32_t)sum >> 2;
    return moved(c, x, (int32_t)(sum >> 32));
}

struct wide {
    int32_t k[5], x[2];
    int64_t y[2];
};

static inline int64_t wide_times(int32_t k, int64_t y)
{
    return ((int64_t)(uint32_t)y * k >> 32) + times((int32_t)(y >> 32), k);
}

static inline int32_t wide_once(struct wide *c, int32_t x)
{
    const int64_t sum = add(
        add(of_inputs(c->k, x, c->x), wide_times(c->k[3], c->y[0])), wide_times(c->k[4], c->y[1]));
    c->x[1] = c->x[0];
    c->x[0] = x;
    c->y[1] = c->y[0];
    c->y[0] = (int64_t)((uint64_t)sum << 2);
    return (int32_t)(c->y[0] >> 32);
}

struct lowpass {
    int32_t k[2];
    int64_t s[2];
};

static inline int32_t minus_sat(int32_t a, int32_t b)
{
    int32_t d;
    return !__builtin_sub_overflow(a, b, &d) ? d : a < 0 ? INT32_MIN : INT32_MAX;
}

static inline int32_t lowpass_once(struct lowpass *c, int32_t x)
{
    const int64_t d = add(times(minus_sat(x, (int32_t)(c->s[0] >> 32)), c->k[0]),
        times((int32_t)(c->s[1] >> 32), c->k[1]));
    int32_t y;
    c->s[1] = add(c->s[1], d);
    c->s[0] = add(c->s[0], c->s[1]);
    y = (int32_t)(c->s[0] >> 32);
    c->s[0] = add(c->s[0], c->s[1]);
    c->s[1] = add(c->s[1], d);
    return y;
}

#define TWIN(name, state) \
    static struct state name[CHANNELS]; \
    void twin_##name##_start(const int32_t *k) \
    { \
        memset(name, 0, sizeof name); \
        for (int i = 0; i < CHANNELS; i++) { memcpy(name[i].k, k, sizeof name[i].k); } \
    } \
    int32_t twin_##name##_step(int32_t x) { return name##_once(&name[0], x); } \
    void twin_##name##_tick(const int32_t *x, int32_t *y) \
    { \
        for (int i = 0; i < CHANNELS; i++) { y[i] = name##_once(&name[i], x[i]); } \
    }
TWIN(df1, df1)
TWIN(wide, wide)
TWIN(dither, df1)
TWIN(lowpass, lowpass)
