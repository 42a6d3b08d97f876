/* SPDX-License-Identifier: MIT */
/* Quadrature: A/B lines or a hardware counter to a count, a count to metres. */
#ifndef EXHAND_QUAD_H
#define EXHAND_QUAD_H

#include "exhand/bytes.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Metres per count, q42, for an initialiser: an encoder of so many pulses a turn, four counts each,
 * on a pulley whose radius to the middle of the string is radius_um, 1 .. 400000. Truncated;
 * 2 pi radius / (4 pulses) must fit the range of step. 1000 pulses, 8 mm: EXH_QUAD_STEP(1000, 8000)
 * is 12.566 um. The factor is 2^42 pi/2 / 10^6, q10, within 5e-12 of it. Where only edges of A
 * count, give half of the pulses; behind a gear, pulses times its ratio. */
#define EXH_QUAD_STEP(pulses, radius_um) \
    ((int32_t)((radius_um)*INT64_C(7074237752) / ((pulses)*INT64_C(1024))))

/* Parameters of one encoder; rows in exh_quad_rows[]. */
struct exh_quad_par {
    int32_t step_m_q42;        /* string per count, m, 1 .. 488 um, LSB 0.23 pm */
    int32_t speed_max_mps_q27; /* faster is no hand, m/s, 0.1 .. 16 */
};
#define EXH_QUAD_ROWS 2
extern const struct exh_signal exh_quad_rows[EXH_QUAD_ROWS];

/* Software decoding of the two lines, for ports without a counter. A sample is
 * A<<1 | B in the low two bits, what is above them is ignored; 00 01 11 10 counts
 * up. x1 counts only the A edges at B = 1, so that noise on B moves nothing, x2 all
 * A edges, x4 all edges. A step in which both lines changed is illegal: it counts 0
 * and is counted. The first sample sets the state and counts nothing, a repeated one
 * counts nothing. Sample faster than the shortest distance of two edges. */
struct exh_quad_ab {
    int32_t cnt;      /* counts since the first sample; wraps modulo 2^32 */
    uint32_t edges;   /* legal transitions seen, of every mode alike; wraps */
    uint32_t illegal; /* both lines changed at once: direction lost; wraps */
    uint8_t ab;       /* the last sample */
    uint8_t started;  /* 1 after the first */
};

/* What each transition adds, index previous<<2 | now: count << 16 (two's
 * complement), edge << 8, illegal. Only the modes that are used are linked. */
struct exh_quad_mode {
    uint32_t adds[16]; /* one for each pair of samples */
};
extern const struct exh_quad_mode exh_quad_x1, exh_quad_x2,
    exh_quad_x4; /* A edges at B = 1; all A edges; all edges */

/* One sample. */
void exh_quad_ab_step(struct exh_quad_ab *s, const struct exh_quad_mode *mode, unsigned ab);

/* n samples, ab[0] the first: as n steps, at a third of their cost. */
void exh_quad_ab_run(
    struct exh_quad_ab *s, const struct exh_quad_mode *mode, const uint8_t *ab, size_t n);

/* 64 samples in x4, a line a word, bit 0 the first, as a shift register collects
 * them: as 64 steps, at a sixth of the cost of a run. To end a stream within a word,
 * repeat its last sample. */
void exh_quad_ab_word(struct exh_quad_ab *s, uint64_t a, uint64_t b);

/* Index mark: the count at its last rising edge. Only for whom it has one. */
struct exh_quad_index {
    int32_t cnt;     /* at the last rising edge */
    uint32_t seen;   /* rising edges; wraps */
    uint8_t level;   /* the last */
    uint8_t started; /* 1 after the first: a level that is high there is no edge */
};

/* One sample, after the step of the same sample: cnt is its count, bit 0 of level
 * the line. */
void exh_quad_index_step(struct exh_quad_index *s, int32_t cnt, unsigned level);

/* Extension of a hardware counter of 16 to 32 bits across its wrap. */
struct exh_quad_cfg {
    const struct exh_quad_par *par; /* the caller's */
    int32_t jump_cnt;               /* what speed_max moves in one tick, rounded, plus 1; a
                                       smaller error of the encoder is not seen */
    uint8_t unused;                 /* 32 less the counter's width */
};
struct exh_quad {
    uint32_t raw;    /* last counter value as given; its low bits count */
    int32_t cnt;     /* counts since the first sample; wraps modulo 2^32 */
    uint8_t started; /* the first sample is count 0 */
    uint8_t lost;    /* 1: a sample moved more than speed_max. cnt left it out and
                        is not to be trusted until the next set-up: a fault */
};

/* Set-up (divides); par must outlive cfg. bits: the counter's width, from the
 * board. -EXH_E_RATE: T. -EXH_E_RANGE: bits not 16 .. 32, step or speed_max outside its range
 * above, or speed_max moves the counter by a quarter of its width or more in one
 * tick: so a movement of up to three times that speed is still told as too fast. */
int exh_quad_setup(
    struct exh_quad_cfg *cfg, const struct exh_quad_par *par, struct exh_period T, unsigned bits);

/* The extended count. Right as long as the counter moves less than half its
 * width between two calls; bits of raw above the width are ignored. A movement
 * of more than jump_cnt is not counted and sets `lost`. */
int32_t exh_quad_step(struct exh_quad *s, const struct exh_quad_cfg *cfg, uint32_t raw);

/* Position of a count, m, q30; rounded half up, saturates at +-2 m with the
 * right sign. Error <= 1/2 LSB = 0.47 nm. */
int32_t exh_quad_pos_m_q30(const struct exh_quad_par *par, int32_t cnt);

/* State through a cursor (bytes.h). */
void exh_quad_ab_serialize(struct exh_bytes *c, struct exh_quad_ab *s);
void exh_quad_index_serialize(struct exh_bytes *c, struct exh_quad_index *s);
void exh_quad_serialize(struct exh_bytes *c, struct exh_quad *s);

#ifdef __cplusplus
}
#endif
#endif
