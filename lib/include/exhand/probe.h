/* SPDX-License-Identifier: MIT */
/* Probe: the motions of a calibration, one finger each. They pull gently, watch the encoder, and
 * stop at the first unexpected event. Current, travel and time are bounded:
 *
 *   probe   raises (or lowers) the current in steps until the string moves in (out):
 *           polarity check, pull-back force F0, a mass that lifts or sinks
 *   weigh   lifts a mass, lets it sink, holds it between the two with the help of
 *           friction, and averages there: one point of a table
 *   home    pulls the slack string in to its end with one low current
 *
 * A motion requests a current and reads counts; the current passes drive and gate as any other.
 * Counts grow when the string is pulled out; a current > 0 pulls it in. Each motion has a set-up, a
 * start, and a step per tick, which returns its result. From the first result other than BUSY, it
 * keeps the result and requests no current. After a DONE probe, the caller chooses the current.
 *
 *   exh_weigh_start(&weigh, &cfg, cnt);
 *   while (exh_weigh_step(&weigh, &cfg, cnt, coded_A_q26, mon_A_q26) == EXH_PROBE_BUSY) { tick(); }
 *   point = exh_weigh_point(&weigh, force_N_q20); */
#ifndef EXHAND_PROBE_H
#define EXHAND_PROBE_H

#include "exhand/calibrate.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Progress or result of a motion. */
enum exh_probe_result {
    EXH_PROBE_BUSY,      /* in progress */
    EXH_PROBE_DONE,      /* reached its goal */
    EXH_PROBE_WRONG_WAY, /* moves out although the motor pulls: reversed, or a person pulls */
    EXH_PROBE_STILL,     /* no movement at the last current */
    EXH_PROBE_TRAVEL,    /* moved farther from the start than allowed */
    EXH_PROBE_TIME,      /* took too long */
    EXH_PROBE_JAM,       /* stopped before the end is possible */
    EXH_PROBE_RESULTS    /* number of results */
};

/* Text for a result, such as "went the wrong way". Never NULL. */
const char *exh_probe_result_text(unsigned result);

/* Units of a count and a tick. */
struct exh_probe_scale {
    int32_t step_m_q42;  /* m per count, > 0 */
    struct exh_period T; /* period of the loop */
};

/* Number of whole ticks in ms > 0, at least 1. Set-up only (divides). */
uint32_t exh_probe_ticks(int32_t ms, struct exh_period T);

#define EXH_PROBE_CUR_MAX_A_Q26 EXH_Q(33, 10, EXH_Q_CUR) /* continuous current of the drive */

/* --- probe --- */

/* Parameters of a probe. */
struct exh_probe_par {
    int32_t step_A_q26;   /* change after each dwell, A, +-1 uA .. +-0.5; < 0 lowers */
    int32_t end_A_q26;    /* last current, A, 0 .. 3.3 */
    int32_t dwell_ms;     /* time at each current, ms, 1 .. 10^4; at least 2 ticks */
    int32_t time_ms;      /* limit of the whole motion, ms, 1 .. 10^6 */
    int32_t move_m_q30;   /* smallest movement within a dwell, m, > 0 .. 1; at least 2 counts */
    int32_t travel_m_q30; /* largest distance from the start, m, > move .. 1; at most 2^30 counts */
};
/* Set-up of a probe. */
struct exh_probe_cfg {
    int32_t step_A_q26, end_A_q26; /* the parameters */
    uint32_t dwell_ticks, ticks;   /* a dwell, at least 2; the whole motion */
    int32_t move_cnt, travel_cnt;  /* counts, rounded down; move at least 2 */
};
/* State of a probe. */
struct exh_probe {
    int32_t cur_A_q26;            /* current requested now */
    int32_t start_cnt, dwell_cnt; /* count at the start; at the start of this dwell */
    uint32_t dwell, tick;         /* ticks of this dwell; of the motion */
    uint8_t settled;              /* 1 after a dwell without movement */
    uint8_t result;               /* enum exh_probe_result */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range. */
int exh_probe_setup(
    struct exh_probe_cfg *cfg, const struct exh_probe_par *par, struct exh_probe_scale scale);

/* Starts at a count with a current, which is limited to 0 .. 3.3 A. */
void exh_probe_start(struct exh_probe *s, int32_t cnt, int32_t cur_A_q26);

/* One tick. Rising: waits at the first current until one dwell is quiet and the slack is taken up,
 * then steps; DONE when a dwell moves `move` in. Falling: does not wait; DONE when a dwell moves
 * `move` out. Movement in the other direction is still the lifted mass. The count may wrap. */
uint8_t exh_probe_step(struct exh_probe *s, const struct exh_probe_cfg *cfg, int32_t cnt);

/* --- home --- */

/* Parameters of homing. */
struct exh_home_par {
    int32_t cur_A_q26;   /* pull current, A, > 0 .. 0.5 */
    int32_t dwell_ms;    /* a dwell with less than move is the end, ms, 1 .. 10^4 */
    int32_t time_ms;     /* limit of the whole motion, ms, 1 .. 10^6 */
    int32_t move_m_q30;  /* smallest movement within a dwell, m, as above */
    int32_t least_m_q30; /* an end nearer than this is a jam, m, 0 .. most */
    int32_t most_m_q30;  /* travel limit, m, > move .. 1 */
};
/* Set-up of homing. */
struct exh_home_cfg {
    int32_t cur_A_q26;                     /* the parameter */
    uint32_t dwell_ticks, ticks;           /* as for a probe */
    int32_t move_cnt, least_cnt, most_cnt; /* counts, rounded down; move >= 2, most >= 1 */
};
/* State of homing. */
struct exh_home {
    int32_t cur_A_q26;            /* current requested now */
    int32_t start_cnt, dwell_cnt; /* count at the start; at the start of this dwell */
    int32_t home_cnt;             /* count at the end, once DONE */
    uint32_t dwell, tick;         /* ticks of this dwell; of the motion */
    uint8_t result;               /* enum exh_probe_result */
};

/* Set-up (divides). -EXH_E_RANGE as above. */
int exh_home_setup(
    struct exh_home_cfg *cfg, const struct exh_home_par *par, struct exh_probe_scale scale);

/* Starts at a count, without current. */
void exh_home_start(struct exh_home *s, int32_t cnt);

/* One tick. The current flows from the first tick. The end is a dwell with less than `move`, at
 * least `least` from the start; before, the person draws the string out farther than that. */
uint8_t exh_home_step(struct exh_home *s, const struct exh_home_cfg *cfg, int32_t cnt);

/* --- weigh --- */

/* Parameters of weighing. */
struct exh_weigh_par {
    struct exh_probe_par probe; /* step > 0; weighing also lowers by this step */
    int32_t slack_A_q26;        /* takes up the slack but lifts no mass, A, 0 .. end */
    int32_t hold_ms;            /* averaging time, ms, 1 .. 10^5 */
};
/* Set-up of weighing. */
struct exh_weigh_cfg {
    struct exh_probe_cfg up, down; /* lifts; lets sink, down to 0 A */
    int32_t slack_A_q26;           /* the parameter */
    uint32_t hold_ticks;           /* averaging time */
};

/* State of weighing. */
struct exh_weigh {
    struct exh_probe probe;     /* of this phase; start_cnt is that of the first */
    int32_t cur_A_q26;          /* current requested now */
    int32_t lift_A_q26;         /* current at which the mass rose */
    int32_t sink_A_q26;         /* current at which it sank */
    struct exh_mean coded, mon; /* mean currents while it is at rest, A q26 */
    uint32_t tick;              /* ticks of holding */
    uint8_t phase;              /* 0 up, 1 down, 2 settling, 3 averaging */
    uint8_t result;             /* enum exh_probe_result */
};

/* Set-up (divides). -EXH_E_RANGE as above. */
int exh_weigh_setup(
    struct exh_weigh_cfg *cfg, const struct exh_weigh_par *par, struct exh_probe_scale scale);

/* Starts at a count, with the current that takes up the slack. */
void exh_weigh_start(struct exh_weigh *s, const struct exh_weigh_cfg *cfg, int32_t cnt);

/* One tick. coded is the current coded in the last tick, mon the measured one, A. The time limit
 * also applies to each of the three phases: it ends the wait for a mass that never settles. */
uint8_t exh_weigh_step(struct exh_weigh *s, const struct exh_weigh_cfg *cfg, int32_t cnt,
    int32_t coded_A_q26, int32_t mon_A_q26);

/* The point of a mass after DONE. Currents are means (error <= 1/2 LSB), friction is (lift - sink)
 * / 2. */
struct exh_calib_point exh_weigh_point(const struct exh_weigh *s, int32_t force_N_q20);

#ifdef __cplusplus
}
#endif
#endif
