/* SPDX-License-Identifier: MIT */
/* Calibration of one finger as a scene: the first step of the paper. A person hangs the masses on
 * the string. Each step starts when the person confirms that it is prepared (parameter `go`, a new
 * value while the step waits). Each step is limited in current and travel, each of its phases
 * in time. The first failed step ends the run, with no current from then on. The steps in order:
 *
 *   zero      no current: the monitor's zero
 *   polarity  a small pull must move the slack string in
 *   home      pulls it to its end
 *   f0        the least current at which it returns at a given speed
 *   mass i    a known force: a point of both tables
 *
 * There is no force table yet, so the drive's force represents current, 1 N for 1 A, in a table
 * that ends at i_max. So all current passes drive, safety and gate, and none exceeds the end of
 * that table. */
#ifndef EXAMPLES_CALIBRATE_H
#define EXAMPLES_CALIBRATE_H

#include "exhand/run/scene.h"

#include "exhand/exhand.h"

#define CALIBRATE_MASSES 8

enum calibrate_step {
    CALIBRATE_ZERO,
    CALIBRATE_POLARITY,
    CALIBRATE_HOME,
    CALIBRATE_F0,
    CALIBRATE_MASS /* the first mass; one step per mass */
};

/* The action required of the person before a step. */
enum calibrate_ask {
    CALIBRATE_ASK_SLACK, /* draw the string out, unload it, let go */
    CALIBRATE_ASK_MASS   /* place mass i on a support, string taut above it */
};

/* Why a run ended: enum exh_probe_result (DONE: all steps finished), or */
enum calibrate_result {
    CALIBRATE_OFF = EXH_PROBE_RESULTS, /* the device left RUN: see faults */
    CALIBRATE_LIMITED,                 /* a limit of the drive acts: the current is wrong */
    CALIBRATE_NOBODY,                  /* no person prepared the step */
    CALIBRATE_RESULTS
};

struct calibrate_own_par {
    int32_t gravity_mps2_q20; /* gravity at the place of use */
    int32_t i_max_A_q26;      /* largest current of all steps */
    int32_t step_A_q26;       /* step of the current */
    int32_t pol_max_A_q26;    /* largest current of polarity */
    int32_t home_A_q26;
    int32_t slack_A_q26;    /* makes the string of a supported mass taut */
    int32_t kf_min_NpA_q20; /* limits the current for a mass to its force divided by this */
    int32_t end_A_q26;      /* end of the tables */
    int32_t move_m_q30;     /* movement within a dwell */
    int32_t travel_m_q30;   /* travel limit of all steps except home */
    int32_t home_min_m_q30, home_max_m_q30;
    int32_t f0_speed_mps_q27;
    int32_t dwell_ms, hold_ms, time_ms, wait_ms;
    int32_t go; /* number of prepared steps: step + 1, set anew */
};

struct calibrate_par {
    struct exh_quad_par quad;
    struct exh_drive_par drive;
    struct exh_tracking_par track;
    struct exh_safety_par safety;
    struct calibrate_own_par own;
    int32_t mass_kg_q20[CALIBRATE_MASSES]; /* rising; the first 0 ends the list */
};

struct calibrate_signals {
    int32_t q_m_q30;
    int32_t i_des_A_q26;
    int32_t i_mon_A_q26;
    int32_t step;                           /* enum calibrate_step */
    int32_t waits;                          /* 1: waits for the person */
    int32_t result;                         /* why it ended; 0 while running */
    int32_t limits, state, faults, present; /* as in every scene */
};

struct calibrate_cfg {
    const struct calibrate_par *par;
    struct exh_quad_cfg quad;
    struct exh_drive_cfg drive;
    struct exh_tracking_cfg track;
    struct exh_safety_cfg safety;
    struct exh_knot one_to_one[2];
    struct exh_probe_cfg polarity, f0;
    struct exh_home_cfg home;
    struct exh_weigh_cfg weigh[CALIBRATE_MASSES];
    uint32_t zero_ticks, wait_ticks;
    uint8_t masses;
};

struct calibrate {
    struct exh_quad quad;
    struct exh_drive drive;
    struct exh_tracking track;
    struct exh_safety safety;
    struct exh_mean zero_raw; /* monitor codes without current */
    struct exh_probe polarity, f0;
    struct exh_home home;
    struct exh_weigh weigh[CALIBRATE_MASSES];
    int32_t coded_A_q26; /* in the last tick */
    int32_t start_cnt;   /* at the start of the step */
    uint32_t tick;       /* of the step or the wait */
    int32_t go;          /* value when the wait began, or the last confirmed */
    uint8_t step, busy, result;
    uint8_t word; /* 1: confirmed in this wait */
    uint8_t ran;  /* 1: the device was in RUN */
};

/* Makes the configuration from parameters. Returns 0 or -EXH_E_.... -EXH_E_RATE: a dwell has less
 * than two ticks. -EXH_E_MONOTONE: the masses do not rise. -EXH_E_RANGE: no mass, or a parameter is
 * refused. Divides. */
int calibrate_setup(
    struct calibrate_cfg *cfg, const struct calibrate_par *par, struct exh_scene_board board);

/* Power-on state: a value of go set before does not count. */
void calibrate_start(struct calibrate *s, const struct calibrate_cfg *cfg);

/* One tick. */
void calibrate_tick(struct calibrate *s, const struct calibrate_cfg *cfg,
    const struct exh_scene_in *in, struct exh_drive_out *out, struct calibrate_signals *sig);

enum calibrate_ask calibrate_ask(unsigned step);

/* Texts such as "polarity" and "mass" of a step, and "went the wrong way" of a result. Never
 * NULL. */
const char *calibrate_step_text(unsigned step);
const char *calibrate_result_text(unsigned result);

/* Writes the measurements so far to c: its points (room for c->cap) and values. The caller sets
 * device, finger, day and validity. Divides: not in a tick. */
void calibrate_points(
    const struct calibrate *s, const struct calibrate_cfg *cfg, struct exh_calib *c);

extern const struct exh_scene exh_scene_calibrate;

/* The one instance, for display. */
const struct calibrate *calibrate_state(void);
const struct calibrate_cfg *calibrate_config(void);

#endif
