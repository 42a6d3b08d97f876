/* SPDX-License-Identifier: MIT */
/* The kernels as anybody would write them in floating point; plain_body.h has them, once a type. */
#ifndef BENCH_PLAIN_H
#define BENCH_PLAIN_H

#include <stdint.h>

#define PLAIN(T, NAME) \
    struct plain_table_##NAME { \
        T x[16], y[16], slope[16]; \
    }; \
    T plain_table_##NAME(const struct plain_table_##NAME *t, T x); \
    struct plain_bones_##NAME { \
        T len[3], rot[3][3], base[3]; \
    }; \
    void plain_tip_##NAME(const struct plain_bones_##NAME *b, const T q[3], T tip[3]); \
    struct plain_freeze_##NAME { \
        T n[3], offset, d_lim, hyst, d, lim; \
        int frozen; \
    }; \
    void plain_freeze_##NAME(struct plain_freeze_##NAME *s, const T tip[3], T pos, int touching); \
    struct plain_energy_##NAME { \
        T step, way, f_most, energy, held; \
        int32_t cnt; \
        int touching; \
    }; \
    T plain_energy_##NAME(struct plain_energy_##NAME *s, int32_t cnt, int touching, T asked); \
    struct plain_pole_##NAME { \
        T gain, keep, v, pos; \
    }; \
    T plain_pole_##NAME(struct plain_pole_##NAME *s, T pos); \
    struct plain_window_##NAME { \
        T gain, pos[16]; \
        unsigned at, n; \
    }; \
    T plain_window_##NAME(struct plain_window_##NAME *s, T pos); \
    struct plain_foaw_##NAME { \
        T rate, band, pos[16]; \
        unsigned at, have; \
    }; \
    T plain_foaw_##NAME(struct plain_foaw_##NAME *s, T pos);

PLAIN(double, double)
PLAIN(float, float)

#endif
