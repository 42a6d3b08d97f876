/* SPDX-License-Identifier: MIT */
/* The scenes' way from raw inputs to newtons, radians and metres, as one would write it in double,
 * in float and, for reference, in long double. pipe_body.h has it, once a type. */
#ifndef BENCH_PIPE_H
#define BENCH_PIPE_H

#include <stdint.h>

#define PIPE_SENSORS 22
#define PIPE_FINGERS 5

/* The numbers of a scene, exact as its integers have them. */
struct pipe_wall_par {
    long double step_m, period_s, speed_mps, k_Npm, b_Nspm, f0_N, band_m, hyst_m, f_max_N, up_Nps,
        down_Nps;
    long double A_per_N, code_per_A, way_m; /* passivity; way_m 0: none */
    int window;                             /* ticks */
    int rest_ticks; /* a string that runs out no farther for so long is wound in; -1: it is not */
};
struct pipe_glove_par {
    long double fc_period; /* of the low-pass: cut-off over rate */
    long double zero[PIPE_SENSORS], rad_per_code[PIPE_SENSORS], cross[PIPE_SENSORS][2];
    int of[PIPE_SENSORS][2]; /* -1: none */
    long double bias[PIPE_FINGERS][3], gain[PIPE_FINGERS][3][2], lo[PIPE_FINGERS][3],
        hi[PIPE_FINGERS][3];
    int sensor[PIPE_FINGERS][3][2];
    long double len[PIPE_FINGERS][3], rot[PIPE_FINGERS][3][3], base[PIPE_FINGERS][3];
};
/* Where a plane is and when the virtual contact freezes. */
struct pipe_plane_par {
    long double n[3], point[3], pad_m, d_lim_m, hyst_m, scale;
};
/* What the integers' state is as the comparison begins. */
struct pipe_wall_now {
    int32_t cnt;
    long double turn_m, force_N;
    int inward, touching, rest_ticks;
};

#define PIPE(T, NAME) \
    struct pipe_wall_##NAME { \
        T step, rate, speed, k, b, f0, band, hyst, f_max, up, down, A_per_N, code_per_A, way; \
        T q, v, turn, force, energy, held; \
        int32_t cnt[16], last; \
        int n, at, inward, touching, energised, rest, rest_most; \
        T out; \
    }; \
    struct pipe_glove_##NAME { \
        T b0, b1, b2, a1, a2, s1[PIPE_SENSORS], s2[PIPE_SENSORS]; \
        T zero[PIPE_SENSORS], gain[PIPE_SENSORS], cross[PIPE_SENSORS][2]; \
        int of[PIPE_SENSORS][2], sensor[PIPE_FINGERS][3][2]; \
        T bias[PIPE_FINGERS][3], term[PIPE_FINGERS][3][2], lo[PIPE_FINGERS][3], \
            hi[PIPE_FINGERS][3]; \
        T len[PIPE_FINGERS][3], rot[PIPE_FINGERS][3][3], base[PIPE_FINGERS][3]; \
        T angle[PIPE_SENSORS], joint[PIPE_FINGERS][3], tip[PIPE_FINGERS][3]; \
    }; \
    struct pipe_plane_##NAME { \
        T n[3], offset, d_lim, hyst, scale, d, lim; \
        int frozen; \
    }; \
    void pipe_wall_##NAME##_start(struct pipe_wall_##NAME *s, const struct pipe_wall_par *p, \
        const struct pipe_wall_now *now); \
    T pipe_wall_##NAME(struct pipe_wall_##NAME *s, int32_t cnt, T lim); \
    void pipe_glove_##NAME##_start( \
        struct pipe_glove_##NAME *s, const struct pipe_glove_par *p, const int16_t *raw); \
    void pipe_glove_##NAME(struct pipe_glove_##NAME *s, const int16_t *raw); \
    void pipe_plane_##NAME##_start(struct pipe_plane_##NAME *s, const struct pipe_plane_par *p); \
    void pipe_plane_##NAME(struct pipe_plane_##NAME *s, const T tip[3], T q, int touching);

PIPE(double, double)
PIPE(float, float)
PIPE(long double, exact)

#endif
