/* SPDX-License-Identifier: MIT */
/* What is this device? One motor with a string, on a bench, as a scene: it makes the motions that
 * `exhand identify` fits a model to. The scene itself estimates nothing.
 *
 *   slack   the string drawn out, nothing on it: the rotor alone. A current that rises until it
 *           moves, then pulses, each let run out
 *   mass    a known mass that stands on something, its string just taut. A current that rises until
 *           it hangs and falls until it sinks. Then again and again: a slow pull up and down, steps
 *           up and down, a square wave whose half period shrinks, a release and a catch
 *
 * A motor with a string only pulls: down is the mass's weight. Weight and inertia of the known mass
 * are the references of newton and metre; in the log there are counts and amperes alone.
 *
 * Each part ends by distance or time, never by a force that had to be known before. Doubt ends all
 * of it, with no current and a cause: a fault of safety's or the dead-man switch let go, too far,
 * too fast, nothing moved, nothing hangs there, a limit of the drive acts, nobody at the bench.
 * The person's word is parameter `go`, as in calibration. Current goes through drive, safety and
 * gate; the table of the drive, 1 N for 1 A, ends at i_max.
 */
#ifndef EXAMPLES_IDENTIFY_H
#define EXAMPLES_IDENTIFY_H

#include "exhand/run/scene.h"

#include "exhand/exhand.h"

enum identify_stage { IDENTIFY_SLACK, IDENTIFY_MASS, IDENTIFY_STAGES };

/* Why it ended: enum exh_probe_result (DONE: all of it is done), or */
enum identify_result {
    IDENTIFY_OFF = EXH_PROBE_RESULTS, /* the box left RUN: see faults */
    IDENTIFY_LIMITED,                 /* a limit of the drive acts */
    IDENTIFY_NOBODY,                  /* nobody prepared the stage */
    IDENTIFY_SPEED,
    IDENTIFY_NO_MASS, /* nothing hangs on the string */
    IDENTIFY_RESULTS
};

struct identify_own_par {
    int32_t mass_kg_q20; /* what hangs there: the log tells the estimator */
    int32_t i_max_A_q26; /* no part goes beyond */
    int32_t ramp_A_q26;  /* slow pulls: A/s */
    int32_t pulse_A_q26; /* the first pulse: so much above what moves the rotor */
    int32_t v_max_mps_q27;
    int32_t slack_m_q30;  /* pulses end when so much string is in */
    int32_t travel_m_q30; /* not higher than this, nor a tenth of it lower than it stood */
    int32_t repeats, wait_ms;
    int32_t go; /* this stage is prepared: stage + 1, newly said */
};

struct identify_par {
    struct exh_quad_par quad;
    struct exh_drive_par drive;
    struct exh_tracking_par track;
    struct exh_safety_par safety;
    struct identify_own_par own;
};

struct identify_signals {
    int32_t q_m_q30, i_des_A_q26, i_mon_A_q26;
    int32_t part, repeat;                   /* from part.c; 0 in the first round */
    int32_t waits, result;                  /* for the person; why it ended, 0 while it goes on */
    int32_t limits, state, faults, present; /* as in every scene */
};

/* Distances that end parts. */
enum identify_far {
    IDENTIFY_MM1,
    IDENTIFY_MM2,
    IDENTIFY_MM6,
    IDENTIFY_MM12,
    IDENTIFY_MM15,
    IDENTIFY_LOW,
    IDENTIFY_MID,
    IDENTIFY_HIGH,
    IDENTIFY_FARS
};

struct identify_cfg {
    const struct identify_par *par;
    struct exh_quad_cfg quad;
    struct exh_drive_cfg drive;
    struct exh_tracking_cfg track;
    struct exh_safety_cfg safety;
    struct exh_knot one_to_one[2];
    struct exh_period T;
    int32_t far_cnt[IDENTIFY_FARS];
    int32_t slack_cnt, travel_cnt, fast_cnt; /* the last within fast_ticks */
    int32_t ramp_A_q26;                      /* a tick */
    int32_t half_per_s_q31;                  /* half a second's share that a tick is */
    uint32_t fast_ticks, still_ticks, short_ticks, long_ticks, wait_ticks, half_ticks;
};

/* What the parts have learned and where they are. All of it is state: keyframes hold it. */
struct identify_run {
    int32_t cur_A_q26;                        /* asked for */
    int32_t free_A_q26, up_A_q26, down_A_q26; /* what moves the rotor; the mass up, down */
    int32_t pulse_A_q26;
    int32_t start_cnt, part_cnt, low_cnt, high_cnt; /* of the stage, the part; its extremes */
    int32_t seen_cnt, fast_cnt;                     /* last count that changed; at the window */
    uint32_t tick, still, fast;      /* of the part; since it changed; of the window */
    uint32_t half, flip, long_ticks; /* square wave; length of a rest by chance */
    uint32_t chance;
    uint8_t part, stage, repeat, sign;
};

struct identify {
    struct exh_quad quad;
    struct exh_drive drive;
    struct exh_tracking track;
    struct exh_safety safety;
    struct identify_run run;
    int32_t go;
    uint32_t wait;
    uint8_t busy, word, ran, result;
};

/* 0 or -EXH_E_…. Divides. */
int identify_setup(
    struct identify_cfg *cfg, const struct identify_par *par, struct exh_scene_board board);
void identify_start(struct identify *s, const struct identify_cfg *cfg);
void identify_tick(struct identify *s, const struct identify_cfg *cfg,
    const struct exh_scene_in *in, struct exh_drive_out *out, struct identify_signals *sig);

/* --- parts (part.c) --- */

/* A stage begins here. */
void identify_begin(struct identify_run *r, const struct identify_cfg *cfg, int32_t cnt);
/* One tick of the part that goes on: enum identify_result; DONE: the stage is. */
uint8_t identify_step(struct identify_run *r, const struct identify_cfg *cfg, int32_t cnt);
/* The first part of a round of the mass. */
#define IDENTIFY_PART_ROUND 7
#define IDENTIFY_PART_UP    10 /* a slow pull up, */
#define IDENTIFY_PART_DOWN  12 /* and down */
#define IDENTIFY_PART_WAVE  17

/* "pulse", "release"; NULL: no such part. The stage it belongs to. */
const char *identify_part_text(unsigned part);
unsigned identify_part_stage(unsigned part);

/* "nothing hangs on the string"; never NULL. */
const char *identify_result_text(unsigned result);

extern const struct exh_scene exh_scene_identify;

/* The one instance, for whoever shows it. */
const struct identify *identify_state(void);
const struct identify_cfg *identify_config(void);

#endif
