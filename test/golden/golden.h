/* SPDX-License-Identifier: MIT */
/* Golden: every module's ticks against those of the independent generator (README.md).
 *
 * A module's run is a function that plays the stimuli of README.md at one rate. It hands each
 * tick's row to a sink: values by golden_put(), the state's bytes by GOLDEN_STATE(), then
 * golden_tick(). It knows neither digests nor files.
 */
#ifndef TEST_GOLDEN_GOLDEN_H
#define TEST_GOLDEN_GOLDEN_H

#include "exhand/bytes.h"
#include "exhand/chatter.h"
#include "exhand/drive.h"
#include "exhand/glove.h"
#include "exhand/safety.h"
#include "exhand/signal.h"
#include "exhand/supply.h"
#include "exhand/tracking.h"
#include "exhand/units.h"
#include "exhand/motion.h"

#include "check.h"

#define GOLDEN_TICKS    256u
#define GOLDEN_AGAIN    192u   /* at this tick everything is set up anew, at another rate */
#define GOLDEN_RESTORE  100u   /* the state before this tick is read back from its bytes */
#define GOLDEN_RATES    2000u  /* all of these are compared, if no others are requested */
#define GOLDEN_BEYOND   20000u /* there are digests up to here */
#define GOLDEN_HUNDRED  100u   /* so many rates have one CRC of their digests */
#define GOLDEN_HUNDREDS (GOLDEN_BEYOND / GOLDEN_HUNDRED)
#define GOLDEN_COLUMNS  40u
#define GOLDEN_STATE_B  4096u

/* One tick's values and state, then what becomes of them. */
struct golden {
    int64_t v[GOLDEN_COLUMNS];
    uint8_t state[GOLDEN_STATE_B];
    uint32_t columns, state_B;
    uint32_t tick;
    uint32_t crc;                  /* of all rows so far */
    void (*see)(struct golden *g); /* the sink: called at each tick's end */
    void *file;                    /* the sink's own */
};

typedef void golden_run(struct golden *g, uint32_t rate_Hz);

/* The next column of this tick. */
void golden_put(struct golden *g, int64_t v);

/* Room for the state of this tick, behind what is there already; golden_state_end()
 * takes what was written. */
struct exh_bytes golden_state(struct golden *g);
void golden_state_end(struct golden *g, const struct exh_bytes *c);

/* The state of this tick through its module's own list of fields; at one tick it is
 * read back into a state of zeros, which must go on the same. */
#define GOLDEN_STATE(g, list, s) \
    do { \
        const uint32_t golden_from = (g)->state_B; \
        struct exh_bytes golden_c = golden_state(g); \
        list(&golden_c, (s)); \
        golden_state_end((g), &golden_c); \
        if ((g)->tick + 1 == GOLDEN_RESTORE) { \
            golden_c = exh_bytes_reader((g)->state + golden_from, (g)->state_B - golden_from); \
            (void)memset((s), 0, sizeof *(s)); \
            list(&golden_c, (s)); \
        } \
    } while (0)

/* The tick is complete. */
void golden_tick(struct golden *g);

/* The CRC-32 of four bytes more: v, little-endian. */
uint32_t golden_crc_u32(uint32_t crc, uint32_t v);

/* --- stimuli --- */

/* splitmix64, one stream of a module and rate. */
struct golden_rng {
    uint64_t state;
};
struct golden_rng golden_rng(const char *module, uint32_t rate_Hz, uint32_t stream);
uint64_t golden_u64(struct golden_rng *r);
int64_t golden_draw(struct golden_rng *r, int64_t lo, int64_t hi);
int64_t golden_corner(struct golden_rng *r);

/* GOLDEN_TICKS values within lo..hi. */
struct golden_wave {
    int32_t at[GOLDEN_TICKS];
};
void golden_wave(struct golden_wave *w, const char *module, uint32_t rate_Hz, uint32_t stream,
    int32_t lo, int32_t hi, int32_t small);

/* The loop's period from tick k on. */
struct exh_period golden_period(uint32_t rate_Hz, uint32_t k);

/* Any parameters of a drive that set-up takes, with a short peak. */
void golden_drive_par(struct exh_drive_par *p, struct golden_rng *r, uint32_t rate_Hz);

/* Any parameters of exh_tracking_setup(), with a short time. */
void golden_track_par(struct exh_tracking_par *p, struct golden_rng *r, uint32_t rate_Hz);
void golden_safety_par(struct exh_safety_par *p, struct golden_rng *r, uint32_t rate_Hz);
/* In this order: power, energy. */
void golden_chatter_par(struct exh_chatter_par *p, struct golden_rng *r);
void golden_watch_par(struct exh_motion_par *p, struct golden_rng *r, uint32_t rate_Hz);

/* The drives' supply: a code between the limits, and while it is off what it is then. */
struct golden_rail {
    int16_t good_raw, off_raw;
    int off;
};

/* Limits that are two codes, the upper as it may fall; once in seldom + 1 none. The supply is good.
 */
void golden_supply_par(struct exh_supply_par *p, struct golden_rail *rail, struct golden_rng *r,
    uint32_t rate_Hz, int64_t seldom);

/* Tick k's code: now and then for some ticks none, too high, or any; twice a run too high for
 * longer than it may be. */
int16_t golden_rail(struct golden_rail *rail, struct golden_rng *r, uint32_t k);

/* A scene's monitor: mostly the code of what was coded, now and then for a while any. */
int16_t golden_monitor(
    unsigned *astray, const struct exh_drive_par *p, struct golden_rng *r, int32_t coded_A_q26);

/* The sensors of some calibration of a glove. */
void golden_glove_sensors(struct exh_glove_cal *cal, struct golden_rng *r);

/* Any parameters of a glove read with this period. */
struct exh_glove_par golden_glove_par(struct golden_rng *r, struct exh_period T);

/* Cosine and sine of some angle: c/d and s/d. */
struct golden_turn {
    int64_t c, s, d;
};
struct golden_turn golden_any_turn(struct golden_rng *r);

/* n / d in q30, rounded half up. */
int32_t golden_q30(int64_t n, int64_t d);

/* The parameters of signal.c. */
#define GOLDEN_VALUES 8
extern const struct exh_signal_table golden_signals;

/* An encoder step, m q42. */
int32_t golden_step(struct golden_rng *r);

#endif
