/* SPDX-License-Identifier: MIT */
/* Identification of a device: one motor with a string on a bench, as a scene. It makes the motions
 * to which `exhand identify` fits a model. The scene estimates nothing. Stages:
 *
 *   slack   string drawn out and unloaded: the rotor alone. The current rises until it
 *           moves, then come pulses, each until rest
 *   mass    a known mass on a support, its string just taut. The current rises until it
 *           hangs and falls until it sinks. Then repeatedly: slow pull up and down, steps
 *           up and down, a square wave with shrinking half period, a release and a catch
 *
 * A motor with a string can only pull; downwards the weight moves the mass. Weight and inertia of
 * the known mass are the references for newton and metre; the log contains counts and amperes only.
 *
 * Each part ends by distance or time, never by a force that would have to be known. Any doubt ends
 * the run, with no current and a cause. Causes are a fault of safety, a released dead-man switch,
 * too far, too fast, no movement, no mass, an acting drive limit, or no person at the bench. The
 * person confirms by parameter `go`, as in calibration. Current passes drive, safety and gate; the
 * drive's table, 1 N for 1 A, ends at i_max. */
#ifndef EXAMPLES_IDENTIFY_H
#define EXAMPLES_IDENTIFY_H

#include "exhand/run/scene.h"

#include "exhand/exhand.h"

enum identify_stage { IDENTIFY_SLACK, IDENTIFY_MASS, IDENTIFY_STAGES };

/* Why a run ended: enum exh_probe_result (DONE: all stages finished), or */
enum identify_result {
    IDENTIFY_OFF = EXH_PROBE_RESULTS, /* the device left RUN: see faults */
    IDENTIFY_LIMITED,                 /* a limit of the drive acts */
    IDENTIFY_NOBODY,                  /* no person prepared the stage */
    IDENTIFY_SPEED,
    IDENTIFY_NO_MASS, /* no mass on the string */
    IDENTIFY_RESULTS
};

struct identify_own_par {
    int32_t mass_kg_q20; /* mass on the string, which the log passes to the estimator */
    int32_t i_max_A_q26; /* largest current of all parts */
    int32_t ramp_A_q26;  /* rate of slow pulls, A/s */
    int32_t pulse_A_q26; /* first pulse: current above that of the rotor's start */
    int32_t v_max_mps_q27;
    int32_t slack_m_q30;  /* pulses end after winding in this length */
    int32_t travel_m_q30; /* highest position; a tenth of it is the lowest below the start */
    int32_t repeats, wait_ms;
    int32_t go; /* prepared stages: stage + 1, set anew */
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
    int32_t part, repeat;                   /* as in part.c; 0 in the first round */
    int32_t waits, result;                  /* waits for the person; why it ended, 0 while
                                             * running */
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
    int32_t slack_cnt, travel_cnt, fast_cnt; /* the last one within fast_ticks */
    int32_t ramp_A_q26;                      /* per tick */
    int32_t half_per_s_q31;                  /* one tick as share of half a second */
    uint32_t fast_ticks, still_ticks, short_ticks, long_ticks, wait_ticks, half_ticks;
};

/* Progress and results of the parts. All of it is state, in every keyframe. */
struct identify_run {
    int32_t cur_A_q26;                        /* current requested */
    int32_t free_A_q26, up_A_q26, down_A_q26; /* current that moves the rotor; the mass up; down */
    int32_t pulse_A_q26;
    int32_t start_cnt, part_cnt, low_cnt, high_cnt; /* at start of the stage, of the part; its
                                                     * extremes */
    int32_t seen_cnt, fast_cnt;                     /* last changed count; at start of the window */
    uint32_t tick, still, fast;      /* of the part; since the last count; of the window */
    uint32_t half, flip, long_ticks; /* square wave; random length of a rest */
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

/* Starts a stage. */
void identify_begin(struct identify_run *r, const struct identify_cfg *cfg, int32_t cnt);
/* One tick of the present part. Returns enum identify_result; DONE: the stage is finished. */
uint8_t identify_step(struct identify_run *r, const struct identify_cfg *cfg, int32_t cnt);
/* First part of a round with the mass. */
#define IDENTIFY_PART_ROUND 7
#define IDENTIFY_PART_UP    10 /* a slow pull up, */
#define IDENTIFY_PART_DOWN  12 /* and down */
#define IDENTIFY_PART_WAVE  17

/* Text such as "pulse", "release"; NULL: no such part. The stage of a part. */
const char *identify_part_text(unsigned part);
unsigned identify_part_stage(unsigned part);

/* Text such as "too fast"; never NULL. */
const char *identify_result_text(unsigned result);

extern const struct exh_scene exh_scene_identify;

/* The one instance, for display. */
const struct identify *identify_state(void);
const struct identify_cfg *identify_config(void);

#endif
