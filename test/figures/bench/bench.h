/* SPDX-License-Identifier: MIT */
/* Bench: what each kernel of the tick costs and how wrong it is.
 *
 * A kernel is one row of a table. Its instructions are counted by callgrind, which
 * collects only inside bench_measure(): every op is reached through the same function
 * pointer, and the cost of an empty op is subtracted. Its error is taken natively,
 * against long double or exact wider integers, over a seeded set of inputs.
 */
#ifndef BENCH_H
#define BENCH_H

#include <float.h>
#include <stddef.h>
#include <stdint.h>

/* References need 64 bits: products of two int32_t must be exact. */
typedef char bench_needs_long_double_of_64_bits[LDBL_MANT_DIG >= 64 ? 1 : -1];

#define BENCH_OPS 1024u /* ops measured; inputs repeat after as many */

/* Errors of one output, in its LSB. */
struct error {
    uint64_t n;
    long double sum_squares, max;
};
void error_add(struct error *e, long double lsb);

struct kernel {
    const char *name;
    const char *unit; /* of the output whose error is taken */
    double lsb;       /* its least significant bit, in that unit; floats: q20 N */
    double bound_lsb; /* documented or derived (see `why`); more is a failure */
    uint32_t per;     /* things done by one op; counts are shown per thing */
    void (*setup)(void);
    void (*op)(uint32_t i);
    void (*error)(struct error *e);
    const char *why;    /* where the bound comes from, and over which inputs */
    double anchor;      /* instructions of a peer, 0: none; not measured here */
    const char *source; /* which peer, where */
};

struct kernel_group {
    const struct kernel *kernel;
    size_t n;
};
extern const struct kernel_group number_group, estimate_group, force_group, filter_group,
    glove_group, hand_group;
extern const struct kernel_group precontact_group, passivity_group, scene_group, modbus_group,
    params_group, keyed_group;
extern const struct kernel_group box_group, limiter_group;

/* Calls op(0) … op(n-1). Alone in its file, so that it is a call in every build. */
void bench_measure(void (*op)(uint32_t i), uint32_t n);

/* Inputs: splitmix64, seeded alike at the start of every set-up and error function. */
void bench_seed(void);
uint64_t bench_u64(void);
int32_t bench_in(int32_t lo, int32_t hi);
/* A third uniform, a third log-distributed, a third at or beside a corner. */
int32_t bench_i32(void);

/* x within lo..hi. */
static inline long double bench_clamp(long double x, long double lo, long double hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* x * 2^-q. */
static inline long double bench_q(long double x, unsigned q)
{
    return x / (long double)(UINT64_C(1) << q);
}

/* Results go here, so that no compiler removes the work. */
extern volatile int64_t bench_sink;

#endif
