/* SPDX-License-Identifier: MIT */
/* Quadrature: A/B lines or a hardware counter to a count, a count to metres.
 *
 * With a hardware counter, call exh_quad_setup() once and exh_quad_step() per tick. Without one,
 * call exh_quad_ab_step() per sample of the lines; it needs no set-up. Both counts go to
 * exh_quad_pos_m_q30(), which reads step_m_q42 alone. 500 pulses per turn in x4 mode on a pulley of
 * 32 mm diameter are 100.531 mm / 2000 per count:
 *
 *   struct exh_quad_par par = {EXH_Q(100531, 2000 * INT64_C(1000000), EXH_Q_STEP),
 *                              EXH_Q(4, 1, EXH_Q_VEL)};
 *   int err = exh_quad_setup(&cfg, &par, (struct exh_period){1, 2000}, 16);
 *   int32_t pos_m_q30 = exh_quad_pos_m_q30(&par, exh_quad_step(&quad, &cfg, raw)); */
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

/* Metres per count, q42, truncated, for an initialiser. pulses: of the encoder in a turn, each four
 * counts. radius_um: of the pulley, to the middle of the string, 1 .. 400000.
 * 2 pi radius / (4 pulses) must fit the range of step. 1000 pulses, 8 mm: EXH_QUAD_STEP(1000, 8000)
 * is 12.566 um. The factor is 2^42 pi/2 / 10^6, q10, within 5e-12 of it. If only edges of A count,
 * give half of the pulses. Behind a gear, give the pulses times its ratio. */
#define EXH_QUAD_STEP(pulses, radius_um) \
    ((int32_t)((radius_um)*INT64_C(7074237752) / ((pulses)*INT64_C(1024))))

/* Parameters of one encoder; rows in exh_quad_rows[]. */
struct exh_quad_par {
    int32_t step_m_q42;        /* string length per count, m, 1 .. 488 um, LSB 0.23 pm */
    int32_t speed_max_mps_q27; /* fastest plausible movement, m/s, 0.1 .. 16 */
};
#define EXH_QUAD_ROWS 2
extern const struct exh_signal exh_quad_rows[EXH_QUAD_ROWS];

/* Software decoder of one encoder, for ports without a hardware counter. A sample is A<<1 | B in
 * the low two bits; higher bits are ignored. The sequence 00 01 11 10 counts up. x1 counts the A
 * edges at B = 1, so noise on B has no effect. x2 counts all A edges, x4 all edges. If both lines
 * change in one step, the step is illegal: cnt stays and illegal rises. The first sample sets the
 * state. Sample faster than the shortest time between two edges. */
struct exh_quad_ab {
    int32_t cnt;      /* counts since the first sample; wraps modulo 2^32 */
    uint32_t edges;   /* legal transitions seen, in every mode; wraps */
    uint32_t illegal; /* steps in which both lines changed: direction unknown; wraps */
    uint8_t ab;       /* the last sample */
    uint8_t started;  /* 1 after the first sample */
};

/* What each transition adds, indexed by previous<<2 | now: count << 16 (two's complement), edge <<
 * 8, illegal. Only the modes that the program uses are linked. */
struct exh_quad_mode {
    uint32_t adds[16]; /* one for each pair of samples */
};
extern const struct exh_quad_mode exh_quad_x1, exh_quad_x2,
    exh_quad_x4; /* A edges at B = 1; all A edges; all edges */

/* Processes one sample. */
void exh_quad_ab_step(struct exh_quad_ab *s, const struct exh_quad_mode *mode, unsigned ab);

/* Processes n samples, ab[0] first. Same result as n steps, at a third of their cost. */
void exh_quad_ab_run(
    struct exh_quad_ab *s, const struct exh_quad_mode *mode, const uint8_t *ab, size_t n);

/* Processes 64 samples in x4 mode, one word per line, bit 0 first, as a shift register collects
 * them. Same result as 64 steps, at a sixth of the cost of a run. To end a stream within a word,
 * repeat its last sample. */
void exh_quad_ab_word(struct exh_quad_ab *s, uint64_t a, uint64_t b);

/* Index mark: the count at its last rising edge. Only for encoders with an index line. */
struct exh_quad_index {
    int32_t cnt;     /* count at the last rising edge */
    uint32_t seen;   /* number of rising edges; wraps */
    uint8_t level;   /* level of the last sample */
    uint8_t started; /* 1 after the first sample; a high first level is no edge */
};

/* Processes one sample; call it after the decoder's step of the same sample. cnt is the count of
 * that step, bit 0 of level is the index line. */
void exh_quad_index_step(struct exh_quad_index *s, int32_t cnt, unsigned level);

/* Extends a hardware counter of 16 to 32 bits to a 32-bit count across its wrap. This is the
 * set-up, struct exh_quad the state of one encoder. */
struct exh_quad_cfg {
    const struct exh_quad_par *par; /* the caller's */
    int32_t jump_cnt;               /* counts per tick at speed_max, rounded, plus 1 */
    uint8_t unused;                 /* 32 minus the counter's width */
};
struct exh_quad {
    uint32_t raw;    /* last counter value as given; the low bits count */
    int32_t cnt;     /* counts since the first sample; wraps modulo 2^32 */
    uint8_t started; /* 1 after the first sample, which is count 0 */
    uint8_t lost;    /* 1: a sample moved too fast: cnt is wrong until the next set-up */
};

/* Set-up (divides); par must outlive cfg. bits is the counter's width, which the board states.
 * -EXH_E_RATE: T. -EXH_E_RANGE: bits not 16 .. 32, or step or speed_max outside its range above.
 * Also -EXH_E_RANGE: speed_max moves the counter by a quarter of its range or more per tick. The
 * limit ensures that movements of up to three times speed_max are detected as too fast. */
int exh_quad_setup(
    struct exh_quad_cfg *cfg, const struct exh_quad_par *par, struct exh_period T, unsigned bits);

/* The extended count after reading raw. Correct while the counter moves by less than half its
 * range between two calls. Bits of raw above the width are ignored. A step above jump_cnt only
 * sets lost. */
int32_t exh_quad_step(struct exh_quad *s, const struct exh_quad_cfg *cfg, uint32_t raw);

/* The position of a count, m, q30; rounded half up. Saturates at +-2 m and keeps the sign. The
 * error is at most 1/2 LSB = 0.47 nm. */
int32_t exh_quad_pos_m_q30(const struct exh_quad_par *par, int32_t cnt);

/* State through a cursor (bytes.h). */
void exh_quad_ab_serialize(struct exh_bytes *c, struct exh_quad_ab *s);
void exh_quad_index_serialize(struct exh_bytes *c, struct exh_quad_index *s);
void exh_quad_serialize(struct exh_bytes *c, struct exh_quad *s);

#ifdef __cplusplus
}
#endif
#endif
