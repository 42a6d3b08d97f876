/* SPDX-License-Identifier: MIT */
/* Probe: pull with little, watch the encoder, stop at the first thing that is not
 * as it should be. The motions of calibration, of one finger each, bounded in
 * current, travel and time:
 *
 *   probe   current rises (or falls) in steps until the string moves in (out):
 *           polarity check, pull-back force F0, a mass that lifts or sinks
 *   weigh   a mass on the string: lifts it, lets it sink, holds it between the two
 *           with friction's help, and takes the means there: one point of a table
 *   home    pulls the slack string in at one low current up to its end
 *
 * They ask for a current and see counts; the current goes through drive and gate as
 * any other. Counts grow when string is pulled out, a current > 0 pulls it in.
 * Each has set-up, start, and a step per tick that returns its result; from the
 * first result other than BUSY it asks for no current and keeps that result, except
 * a probe that is DONE: what its current is to be then is the caller's to say.
 */
#ifndef EXHAND_PROBE_H
#define EXHAND_PROBE_H

#include "exhand/calibrate.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How a motion stands or ended. */
enum exh_probe_result {
    EXH_PROBE_BUSY,      /* goes on */
    EXH_PROBE_DONE,      /* found what it was for */
    EXH_PROBE_WRONG_WAY, /* the string goes out though it is pulled in: motor or
                          * encoder reversed, or somebody pulls */
    EXH_PROBE_STILL,     /* nothing has moved at the last of the currents */
    EXH_PROBE_TRAVEL,    /* farther from the start than allowed */
    EXH_PROBE_TIME,      /* it took too long */
    EXH_PROBE_JAM,       /* stopped before the end can have been reached */
    EXH_PROBE_RESULTS    /* how many there are */
};

/* "went the wrong way", ...; never NULL. */
const char *exh_probe_result_text(unsigned result);

/* What a count and a millisecond are. */
struct exh_probe_scale {
    int32_t step_m_q42;  /* m per count, > 0 */
    struct exh_period T; /* of the loop */
};

/* Ticks in ms > 0 milliseconds, rounded down, at least 1. Set-up only (divides). */
uint32_t exh_probe_ticks(int32_t ms, struct exh_period T);

#define EXH_PROBE_CUR_MAX_A_Q26 EXH_Q(33, 10, EXH_Q_CUR) /* the drive's continuous one */

/* --- probe --- */

/* Parameters of a probe, given by whoever calibrates. */
struct exh_probe_par {
    int32_t step_A_q26;   /* added after each dwell, A, +-1 uA .. +-0.5; < 0 lowers */
    int32_t end_A_q26;    /* not beyond this, A, 0 .. 3.3 */
    int32_t dwell_ms;     /* time at each current, ms, 1 .. 10^4; at least 2 ticks */
    int32_t time_ms;      /* of it all, ms, 1 .. 10^6 */
    int32_t move_m_q30;   /* this far within a dwell is movement, m, > 0 .. 1; at
                           * least 2 counts, as one may be noise */
    int32_t travel_m_q30; /* not farther from the start, m, > move .. 1; at most
                           * 2^30 counts */
};
/* A probe as it is set up. */
struct exh_probe_cfg {
    int32_t step_A_q26, end_A_q26; /* the parameters */
    uint32_t dwell_ticks, ticks;   /* of a dwell, 2 at least; of it all */
    int32_t move_cnt, travel_cnt;  /* in counts, rounded down; move 2 at least */
};
/* A probe from tick to tick. */
struct exh_probe {
    int32_t cur_A_q26;            /* asked for now */
    int32_t start_cnt, dwell_cnt; /* where it began; where the present dwell did */
    uint32_t dwell, tick;         /* ticks: of this dwell; of it all */
    uint8_t settled;              /* it was quiet for a dwell: from now on currents change */
    uint8_t result;               /* enum exh_probe_result */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range. */
int exh_probe_setup(
    struct exh_probe_cfg *cfg, const struct exh_probe_par *par, struct exh_probe_scale scale);

/* From a count and a current, which is limited to 0 .. 3.3 A. */
void exh_probe_start(struct exh_probe *s, int32_t cnt, int32_t cur_A_q26);

/* One tick. Rising: waits at the first current until a dwell was quiet (slack is
 * taken up), then steps; DONE when a dwell moves `move` in. Falling: steps at once;
 * DONE when a dwell moves `move` out, the other way is still the mass that was
 * lifted. The count may wrap. */
uint8_t exh_probe_step(struct exh_probe *s, const struct exh_probe_cfg *cfg, int32_t cnt);

/* --- home --- */

/* Parameters of homing, given by whoever calibrates. */
struct exh_home_par {
    int32_t cur_A_q26;   /* pulls with this, A, > 0 .. 0.5 */
    int32_t dwell_ms;    /* slower than `move` a dwell is the end, ms, 1 .. 10^4 */
    int32_t time_ms;     /* ms, 1 .. 10^6 */
    int32_t move_m_q30;  /* m, as above */
    int32_t least_m_q30; /* an end nearer than this is a jam, m, 0 .. most */
    int32_t most_m_q30;  /* travel limit, m, > move .. 1 */
};
/* Homing as it is set up. */
struct exh_home_cfg {
    int32_t cur_A_q26;                     /* the parameter */
    uint32_t dwell_ticks, ticks;           /* as of a probe */
    int32_t move_cnt, least_cnt, most_cnt; /* in counts, rounded down; move 2 at least, most 1 */
};
/* Homing from tick to tick. */
struct exh_home {
    int32_t cur_A_q26;            /* asked for now */
    int32_t start_cnt, dwell_cnt; /* where it began; where the present dwell did */
    int32_t home_cnt;             /* the end, once DONE */
    uint32_t dwell, tick;         /* ticks: of this dwell; of it all */
    uint8_t result;               /* enum exh_probe_result */
};

/* Set-up (divides). -EXH_E_RANGE as above. */
int exh_home_setup(
    struct exh_home_cfg *cfg, const struct exh_home_par *par, struct exh_probe_scale scale);

/* From a count, with no current yet. */
void exh_home_start(struct exh_home *s, int32_t cnt);

/* One tick. The current flows from the first one; the end is a dwell with less than
 * `move`, at least `least` from the start (the person draws the string out farther
 * than that before). */
uint8_t exh_home_step(struct exh_home *s, const struct exh_home_cfg *cfg, int32_t cnt);

/* --- weigh --- */

/* Parameters of weighing, given by whoever calibrates. */
struct exh_weigh_par {
    struct exh_probe_par probe; /* step > 0; it is also the step of the way down */
    int32_t slack_A_q26;        /* takes up the slack first, lifts no mass, A, 0 .. end */
    int32_t hold_ms;            /* means are taken over this, ms, 1 .. 10^5 */
};
/* Weighing as it is set up. */
struct exh_weigh_cfg {
    struct exh_probe_cfg up, down; /* that lifts; that lets sink, down to 0 A */
    int32_t slack_A_q26;           /* the parameter */
    uint32_t hold_ticks;           /* over which means are taken */
};

/* Weighing from tick to tick. */
struct exh_weigh {
    struct exh_probe probe;     /* of this phase; start_cnt is that of the first */
    int32_t cur_A_q26;          /* asked for now */
    int32_t lift_A_q26;         /* at which the mass rose */
    int32_t sink_A_q26;         /* at which it sank */
    struct exh_mean coded, mon; /* currents while it hangs still, A q26 */
    uint32_t tick;              /* of holding, in all */
    uint8_t phase;              /* 0 up, 1 down, 2 coming to rest, 3 means */
    uint8_t result;             /* enum exh_probe_result */
};

/* Set-up (divides). -EXH_E_RANGE as above. */
int exh_weigh_setup(
    struct exh_weigh_cfg *cfg, const struct exh_weigh_par *par, struct exh_probe_scale scale);

/* From a count, with the current that takes up the slack. */
void exh_weigh_start(struct exh_weigh *s, const struct exh_weigh_cfg *cfg, int32_t cnt);

/* One tick. coded and mon: the current coded in the last tick and the monitored one,
 * A. TIME also bounds each of the three phases: a mass that does not come to rest
 * between lift and sink ends so. */
uint8_t exh_weigh_step(struct exh_weigh *s, const struct exh_weigh_cfg *cfg, int32_t cnt,
    int32_t coded_A_q26, int32_t mon_A_q26);

/* The point of a mass that is DONE: currents are means (error <= 1/2 LSB), friction
 * is (lift - sink) / 2. */
struct exh_calib_point exh_weigh_point(const struct exh_weigh *s, int32_t force_N_q20);

#ifdef __cplusplus
}
#endif
#endif
