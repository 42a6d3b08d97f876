/* SPDX-License-Identifier: MIT */
/* Peers: low-passes and sines of others, run beside ours on the same inputs. */
#ifndef BENCH_PEERS_H
#define BENCH_PEERS_H

#include "bench.h"

#define CHANNELS 22u
#define BLOCK    64u

/* Second-order Butterworth by the bilinear transform, gain 1 at 0 Hz:
 * y = b0 x + b1 x1 + b2 x2 - a1 y1 - a2 y2. */
struct butterworth {
    uint32_t fc, fs; /* Hz */
    long double b0, b1, b2, a1, a2;
};

struct filter_peer {
    const char *name;
    void (*setup)(const struct butterworth *f); /* CHANNELS channels at rest */
    long double (*native)(long double x);       /* x, 1 = full scale, as the peer can take it */
    long double (*step)(long double x);         /* channel 0, one such sample */
    void (*tick)(uint32_t i);                   /* all channels, one sample each */
    void (*block)(uint32_t i);                  /* channel 0, BLOCK samples */
    uint32_t ram_B;                             /* of a channel, here */
    long double most;                           /* fc/fs it can be set up for; 0: any */
};

struct sine_peer {
    const char *name;
    void (*both)(uint32_t turn_q32, long double *sine, long double *cosine);
    void (*op)(uint32_t i);
    uint32_t table_B;
};

struct peer_group {
    const struct filter_peer *filter;
    size_t filters;
    const struct sine_peer *sine;
    size_t sines;
};
extern const struct peer_group plain_peers, cmsis_peers, fixmath_peers, idsp_peers;

/* Does the crate idsp what its twins do? */
int idsp_twins_same(const struct butterworth *f);

/* Inputs of the ops: 0.37 of full scale, in every format. */
extern int32_t peer_x_q31[BENCH_OPS + BLOCK];
extern int16_t peer_x_q15[BENCH_OPS + BLOCK];
extern float peer_x_f32[BENCH_OPS + BLOCK];
extern double peer_x_f64[BENCH_OPS + BLOCK];

/* x to the nearest multiple of 2^-q, within -1 .. 1 - 2^-q. */
long double peer_round(long double x, unsigned q);

#endif
