/* SPDX-License-Identifier: MIT */
/* First power-up of a box, one finger at a time, as a scene: docs/BRINGUP.md is its manual.
 *
 *   stage 1  no motors, no drives: rest, encoder turned by hand, inputs, D/A into a meter
 *   stage 2  a dummy load on the drive: rest, small currents, off again
 *   stage 3  one motor, nothing on its string: rest, polarity, speed, stop
 *   stage 4  its string: home, then on a spring balance: forces, table; or a known mass: kf
 *   stage 5  one finger, small forces
 *
 * A run is one stage, of phases. A stage that is done prints a number; the next one does not
 * begin without it (parameter `shown`). The number belongs to finger, scales and the limits of the
 * stages so far (crc_limits in setup.c): whoever changes them begins again. The person's word is
 * the dead-man switch, let go and taken behind the question.
 *
 * Any doubt ends it: no current and the drive disabled in the same tick, for good. Current goes
 * through drive, safety and gate, whose table ends at the stage's limit. Doubt is
 *
 *   - a fault of safety's, or the switch let go, within a phase that needs it
 *   - the mean of the monitor over `doubt` ms not being the mean commanded
 *   - faster than v_max, for three ticks; farther than `travel` (stage 2: `move`)
 *   - a limit of the drive that acts, but for slew
 *   - what the phase itself checks; what takes too long; nobody who does it
 */
#ifndef EXAMPLES_BRINGUP_H
#define EXAMPLES_BRINGUP_H

#include "exhand/run/scene.h"

#include "exhand/exhand.h"

/* Axes of the box; 1 for one that has board A alone (docs/CARDS.md). */
#ifndef BRINGUP_FINGERS
#define BRINGUP_FINGERS EXH_FINGERS
#endif

#define BRINGUP_STAGES 5
#define BRINGUP_WEIGHS 6 /* the list of phases of stage 4 with a mass */
#define BRINGUP_LEVELS 3 /* a third, two thirds and all of a stage's limit */

/* Why it ended: enum exh_probe_result (DONE: the stage is done), or */
enum bringup_result {
    BRINGUP_OFF = EXH_PROBE_RESULTS, /* the box left RUN, or did not come into it */
    BRINGUP_LIMITED,                 /* a limit of the drive acts */
    BRINGUP_NOBODY,                  /* nobody did what was asked */
    BRINGUP_NOT_SHOWN,               /* the stage before was not */
    BRINGUP_MONITOR,                 /* the monitor does not show the current commanded */
    BRINGUP_SPEED,
    BRINGUP_INPUT,   /* an input was not seen to open and to close */
    BRINGUP_READING, /* the balance does not read what was commanded */
    BRINGUP_RESULTS
};

/* What the person has to do in a phase. */
enum bringup_ask {
    BRINGUP_ASK_NOTHING,
    BRINGUP_ASK_TURN,   /* the encoder out, and back */
    BRINGUP_ASK_INPUTS, /* open and close every input */
    BRINGUP_ASK_HOLD,   /* hold the dead-man switch */
    BRINGUP_ASK_HOOK    /* let it go, change what is on the string, hold it again */
};

struct bringup_own_par {
    int32_t stage, finger, shown;
    int32_t loop;         /* 1: the D/A is wired to the monitor's input in stage 1 */
    int32_t kf_NpA_q20;   /* string force per motor current: stages 4 and 5 */
    int32_t da_max_A_q26; /* limits: of the stages 1, */
    int32_t load_max_A_q26, run_max_A_q26; /* 2, 3 */
    int32_t f_max_N_q20, f_finger_N_q20;   /* 4, 5 */
    int32_t step_A_q26;                    /* polarity: currents rise by this */
    int32_t pol_max_A_q26, home_A_q26;
    int32_t ramp_ps;                /* A/s in stages 1 to 3, N/s above */
    int32_t zero_A_q26;             /* the monitor at no current: not farther from 0 */
    int32_t mon_A_q26, mon_percent; /* off what is commanded by no more than both */
    int32_t read_percent;           /* the balance, likewise */
    int32_t v_max_mps_q27, v_trip_mps_q27;
    int32_t turn_m_q30, move_m_q30, travel_m_q30, home_min_m_q30, home_max_m_q30;
    int32_t hold_ms, doubt_ms, dwell_ms, stop_ms, time_ms, wait_ms;
    int32_t mass_kg_q20; /* stage 4: weighs this instead of the balance; 0: does not */
    int32_t read_N_q20[BRINGUP_LEVELS]; /* of the balance; 0: not yet */
};

struct bringup_par {
    struct exh_quad_par quad;
    struct exh_drive_par drive;
    struct exh_safety_par safety;
    struct bringup_own_par own;
};

struct bringup_signals {
    int32_t q_m_q30, v_mps_q27, i_des_A_q26, i_mon_A_q26;
    int32_t phase, result; /* of the stage; enum bringup_result, 0 while it goes on */
    int32_t limits, state, faults, present; /* as in every scene */
};

struct bringup_cfg {
    const struct bringup_par *par;
    struct exh_drive_par drive_par; /* with the stage's ramp */
    struct exh_quad_cfg quad;
    struct exh_velocity_window_cfg vel;
    struct exh_drive_cfg drive;
    struct exh_safety_cfg safety;
    struct exh_knot to_cur[2];
    struct exh_probe_cfg polarity; /* its travel and move are everybody's */
    struct exh_home_cfg home;
    struct exh_weigh_cfg weigh;
    int32_t mass_N_q20; /* the mass's weight */
    int32_t kf_NpA_q20; /* 1 below stage 4: current stands for force */
    int32_t level_N_q20[BRINGUP_LEVELS];
    struct exh_gain looped_A_q26; /* per code of a monitor input that sees the D/A */
    int32_t turn_cnt;
    uint32_t hold_ticks, doubt_ticks, dwell_ticks, stop_ticks, time_ticks, wait_ticks;
    uint8_t list;            /* of phases: the stage, or BRINGUP_WEIGHS */
    uint32_t number, before; /* what this stage prints, what it needs */
};

/* What there is to tell behind a tick, bits. */
enum bringup_tell { BRINGUP_TELL_START = 1, BRINGUP_TELL_LEVEL = 2, BRINGUP_TELL_PHASE = 4 };

struct bringup {
    struct exh_quad quad;
    struct exh_velocity_window vel;
    struct exh_drive drive;
    struct exh_safety safety;
    struct exh_probe probe;
    struct exh_home homing;
    struct exh_weigh weigh;
    struct exh_mean mon, coded;         /* of what is measured in a phase */
    int64_t off_A_q26, sum_A_q26;       /* monitor - commanded, and commanded, in this window */
    int32_t coded_A_q26;                /* in the last tick */
    int32_t start_cnt, far_cnt, at_cnt; /* of the phase; farthest out; in a dwell */
    uint32_t tick, window, fast;        /* of phase, window; ticks too fast */
    uint32_t opened, closed;            /* inputs seen so, bits 0 .. 2 */
    uint32_t was, steady;               /* how they are, and for how many ticks */
    uint8_t phase, level, result;
    uint8_t busy;   /* the phase has begun */
    uint8_t said;   /* that it ended */
    uint8_t let_go; /* the switch was, since the phase was asked for */
    /* For tell: */
    uint8_t tell, told_phase, told_level;
    int32_t tell_A_q26, tell_mon_A_q26, tell_cnt, tell_mps_q27;
    uint16_t code_raw, tell_raw;
    struct exh_mean told_mon, told_coded; /* of the level */
};

/* What a phase may see of a tick. */
struct bringup_view {
    int32_t cnt, v_mps_q27, mon_A_q26;
    uint32_t din; /* e-stop, dead-man, ready: bits 0 .. 2 */
};

enum bringup_far { BRINGUP_FAR_TRAVEL, BRINGUP_FAR_MOVE, BRINGUP_FAR_OWN };

enum bringup_step {
    BRINGUP_REST,
    BRINGUP_TURN,
    BRINGUP_INPUTS,
    BRINGUP_LEVEL,
    BRINGUP_POLARITY,
    BRINGUP_RUN,
    BRINGUP_STOP,
    BRINGUP_HOME,
    BRINGUP_WEIGH,
    BRINGUP_TABLE
};

/* One phase of a stage. */
struct bringup_phase {
    uint8_t stage, ask; /* enum bringup_ask */
    uint8_t step;       /* enum bringup_step */
    uint8_t hands;      /* 1: hands are at it, the box need not run, no current */
    uint8_t far;        /* enum bringup_far: how far it may move */
    const char *name, *text;
};
const struct bringup_phase *bringup_phase(unsigned list, unsigned phase); /* NULL: no more */

/* One tick of it, its result; the force asked for, or the current that stands for it, goes to
 * *f_N_q20. */
uint8_t bringup_step(struct bringup *s, const struct bringup_cfg *cfg,
    const struct bringup_phase *p, struct bringup_view v, int32_t *f_N_q20);

/* 0 or -EXH_E_RANGE. Divides. */
int bringup_setup(
    struct bringup_cfg *cfg, const struct bringup_par *par, struct exh_scene_board board);
void bringup_start(struct bringup *s);
void bringup_tick(struct bringup *s, const struct bringup_cfg *cfg, const struct exh_scene_in *in,
    struct exh_drive_out *out, struct bringup_signals *sig);

/* "the monitor does not show the current commanded"; never NULL. */
const char *bringup_result_text(unsigned result);

/* What there is to tell of the last tick, lines with their ends, into text: its length, 0 if
 * nothing. Divides: not in a tick. */
#define BRINGUP_TEXT_B 400
unsigned bringup_text(
    char text[BRINGUP_TEXT_B], const struct bringup *s, const struct bringup_cfg *cfg);

extern const struct exh_scene exh_scene_bringup;

/* The one instance, for whoever shows it. */
const struct bringup *bringup_state(void);
const struct bringup_cfg *bringup_config(void);

#endif
