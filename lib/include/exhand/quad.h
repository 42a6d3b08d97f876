/* Quadrature: A/B lines or a hardware counter to a count, a count to metres. */
#ifndef EXHAND_QUAD_H
#define EXHAND_QUAD_H

#include "exhand/bytes.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters of one encoder; rows in exh_quad_rows[]. */
struct exh_quad_par {
    int32_t step_m_q42;        /* string per count, m, 1 .. 488 um, LSB 0.23 pm */
    int32_t speed_max_mps_q27; /* faster is no hand, m/s, 0.1 .. 16            */
};
#define EXH_QUAD_ROWS 2
extern const struct exh_signal exh_quad_rows[EXH_QUAD_ROWS];

/* Software decoding of the two lines, for ports without a counter. */
enum exh_quad_mode { EXH_QUAD_X1, EXH_QUAD_X2, EXH_QUAD_X4 };

struct exh_quad_ab {
    int32_t cnt;       /* counts since the first sample; wraps modulo 2^32      */
    uint32_t edges;    /* legal transitions seen                               */
    uint32_t illegal;  /* both lines changed at once: direction lost           */
    int32_t index_cnt; /* cnt at the last rising edge of the index             */
    uint32_t indices;  /* rising edges of the index seen                       */
    uint8_t ab;        /* last A<<1 | B                                        */
    uint8_t index;     /* last index level                                     */
    uint8_t started;   /* the first sample sets the state and counts nothing   */
};

/* One sample: a, b, index are 0 or 1; 00 01 11 10 counts up. x1 counts only the
 * A edges at B = 1, x2 all A edges, x4 all. An illegal step (both lines at once)
 * counts 0 and is counted. Feed it faster than the shortest edge distance.
 * Index is latched after the step of the same sample. */
void exh_quad_ab_step(struct exh_quad_ab *s, enum exh_quad_mode mode, unsigned a, unsigned b,
                      unsigned index);

/* Extension of a hardware counter of 16 to 32 bits across its wrap. */
struct exh_quad_cfg {
    const struct exh_quad_par *par;
    int32_t jump_cnt; /* what speed_max moves in one tick, rounded, plus 1; a
                         smaller error of the encoder is not seen              */
    uint8_t unused;   /* 32 less the counter's width                           */
};
struct exh_quad {
    uint32_t raw;    /* last counter value, low bits                          */
    int32_t cnt;     /* counts since the first sample; wraps modulo 2^32       */
    uint8_t started; /* the first sample is count 0                            */
    uint8_t lost;    /* 1: a sample moved more than speed_max. cnt left it out and
                        is not to be trusted until the next set-up: a fault    */
};

/* Set-up (divides); par must outlive cfg. bits: the counter's width, from the
 * board. -EXH_E_RANGE: bits not 16 .. 32, step or speed_max outside its range
 * above, or speed_max moves the counter by a quarter of its width or more in one
 * tick: so a movement of up to three times that speed is still told as too fast. */
int exh_quad_setup(struct exh_quad_cfg *cfg, const struct exh_quad_par *par, struct exh_period T,
                   unsigned bits);

/* The extended count. Right as long as the counter moves less than half its
 * width between two calls; bits of raw above the width are ignored. A movement
 * of more than jump_cnt is not counted and sets `lost`. */
int32_t exh_quad_extend(struct exh_quad *s, const struct exh_quad_cfg *cfg, uint32_t raw);

/* Position of a count, m, q30; rounded half up, saturates at +-2 m with the
 * right sign. Error <= 1/2 LSB = 0.47 nm. */
int32_t exh_quad_pos_m_q30(const struct exh_quad_par *par, int32_t cnt);

/* State through a cursor (bytes.h). */
void exh_quad_ab_bytes(struct exh_bytes *c, struct exh_quad_ab *s);
void exh_quad_bytes(struct exh_bytes *c, struct exh_quad *s);

#ifdef __cplusplus
}
#endif
#endif
