/* SPDX-License-Identifier: MIT */
/* First power-up of a device, one finger at a time, as a scene. docs/BRINGUP.md is its manual.
 *
 *   stage 1  no motors, no drives: rest, encoder turned by hand, inputs, D/A into a meter
 *   stage 2  a dummy load on the drive: rest, small currents, off again
 *   stage 3  one motor, nothing on its string: rest, polarity, speed, stop
 *   stage 4  its string: home, then on a spring balance: forces, table; or a known mass: kf
 *   stage 5  one finger, small forces
 *
 * A run is one stage with several phases. A finished stage prints a number, which the next stage
 * requires (parameter `shown`). The number depends on finger, scales and limits of the stages so
 * far (crc_limits in setup.c), so a change of these requires a new start. The person answers by
 * releasing and holding the dead-man switch after a question.
 *
 * Any doubt ends the run: no current and the drive disabled in the same tick, permanently. Current
 * passes drive, safety and gate; the force table ends at the limit of the stage. Reasons for doubt
 * are
 *
 *   - a fault of safety, or a released switch in a phase that needs it
 *   - the mean of the monitor over `doubt` ms differs from the mean commanded
 *   - faster than v_max for three ticks; farther than `travel` (stage 2: `move`)
 *   - a limit of the drive acts, except slew
 *   - a check of the phase itself, a timeout, or no response of the person */
#ifndef EXAMPLES_BRINGUP_H
#define EXAMPLES_BRINGUP_H

#include "exhand/run/scene.h"

#include "exhand/exhand.h"

/* Axes of the device; 1 for a device with board A alone (docs/CARDS.md). */
#ifndef BRINGUP_FINGERS
#define BRINGUP_FINGERS EXH_FINGERS
#endif

#define BRINGUP_STAGES 5
#define BRINGUP_WEIGHS 6 /* list of the phases of stage 4 with a mass */
#define BRINGUP_LEVELS 3 /* a third, two thirds and all of the stage's limit */

/* Why a run ended: enum exh_probe_result (DONE: the stage is finished), or */
enum bringup_result {
    BRINGUP_OFF = EXH_PROBE_RESULTS, /* the device left RUN, or did not reach it */
    BRINGUP_LIMITED,                 /* a limit of the drive acts */
    BRINGUP_NOBODY,                  /* no response of the person */
    BRINGUP_NOT_SHOWN,               /* the previous stage was not shown */
    BRINGUP_MONITOR,                 /* the monitor does not show the current commanded */
    BRINGUP_SPEED,
    BRINGUP_INPUT,   /* an input was not seen to open and close */
    BRINGUP_READING, /* the balance shows another force than commanded */
    BRINGUP_RESULTS
};

/* The action required of the person in a phase. */
enum bringup_ask {
    BRINGUP_ASK_NOTHING,
    BRINGUP_ASK_TURN,   /* pull the encoder out and back */
    BRINGUP_ASK_INPUTS, /* open and close every input */
    BRINGUP_ASK_HOLD,   /* hold the dead-man switch */
    BRINGUP_ASK_HOOK    /* release it, change the load on the string, hold it again */
};

struct bringup_own_par {
    int32_t stage, finger, shown;
    int32_t loop;                          /* 1: stage 1 has the D/A wired to the monitor input */
    int32_t kf_NpA_q20;                    /* string force per motor current, stages 4 and 5 */
    int32_t da_max_A_q26;                  /* limits: of stage 1, */
    int32_t load_max_A_q26, run_max_A_q26; /* 2, 3 */
    int32_t f_max_N_q20, f_finger_N_q20;   /* 4, 5 */
    int32_t step_A_q26;                    /* polarity: step of the current */
    int32_t pol_max_A_q26, home_A_q26;
    int32_t ramp_ps;                /* A/s in stages 1 to 3, N/s above */
    int32_t zero_A_q26;             /* monitor without current: largest offset */
    int32_t mon_A_q26, mon_percent; /* allowed difference to the command, sum of both */
    int32_t read_percent;           /* allowed difference of the balance */
    int32_t v_max_mps_q27, v_trip_mps_q27;
    int32_t turn_m_q30, move_m_q30, travel_m_q30, home_min_m_q30, home_max_m_q30;
    int32_t hold_ms, doubt_ms, dwell_ms, stop_ms, time_ms, wait_ms;
    int32_t mass_kg_q20; /* stage 4: weighs this mass instead of a balance; 0: no mass */
    int32_t read_N_q20[BRINGUP_LEVELS]; /* readings of the balance; 0: not yet */
};

struct bringup_par {
    struct exh_quad_par quad;
    struct exh_drive_par drive;
    struct exh_safety_par safety;
    struct bringup_own_par own;
};

struct bringup_signals {
    int32_t q_m_q30, v_mps_q27, i_des_A_q26, i_mon_A_q26;
    int32_t phase, result;                  /* of the stage; enum bringup_result, 0 while running */
    int32_t limits, state, faults, present; /* as in every scene */
};

struct bringup_cfg {
    const struct bringup_par *par;
    struct exh_drive_par drive_par; /* with the ramp of the stage */
    struct exh_quad_cfg quad;
    struct exh_velocity_window_cfg vel;
    struct exh_drive_cfg drive;
    struct exh_safety_cfg safety;
    struct exh_knot to_cur[2];
    struct exh_probe_cfg polarity; /* all phases use its travel and move */
    struct exh_home_cfg home;
    struct exh_weigh_cfg weigh;
    int32_t mass_N_q20; /* weight of the mass */
    int32_t kf_NpA_q20; /* 1 below stage 4: current replaces force */
    int32_t level_N_q20[BRINGUP_LEVELS];
    struct exh_gain looped_A_q26; /* per code of a monitor input wired to the D/A */
    int32_t turn_cnt;
    uint32_t hold_ticks, doubt_ticks, dwell_ticks, stop_ticks, time_ticks, wait_ticks;
    uint8_t list;            /* list of phases: the stage, or BRINGUP_WEIGHS */
    uint32_t number, before; /* number that this stage prints; that it needs */
};

/* Reports due after a tick, bits. */
enum bringup_tell { BRINGUP_TELL_START = 1, BRINGUP_TELL_LEVEL = 2, BRINGUP_TELL_PHASE = 4 };

struct bringup {
    struct exh_quad quad;
    struct exh_velocity_window vel;
    struct exh_drive drive;
    struct exh_safety safety;
    struct exh_probe probe;
    struct exh_home homing;
    struct exh_weigh weigh;
    struct exh_mean mon, coded;         /* of the measurements in a phase */
    int64_t off_A_q26, sum_A_q26;       /* monitor - command, and command, in this window */
    int32_t coded_A_q26;                /* in the last tick */
    int32_t start_cnt, far_cnt, at_cnt; /* of the phase; outermost; in a dwell */
    uint32_t tick, window, fast;        /* of phase and window; ticks too fast */
    uint32_t opened, closed;            /* inputs seen in that state, bits 0 .. 2 */
    uint32_t was, steady;               /* their state, and for how many ticks */
    uint8_t phase, level, result;
    uint8_t busy;   /* the phase has started */
    uint8_t said;   /* its end was reported */
    uint8_t let_go; /* the switch was released since the question */
    /* For bringup_text(): */
    uint8_t tell, told_phase, told_level;
    int32_t tell_A_q26, tell_mon_A_q26, tell_cnt, tell_mps_q27;
    uint16_t code_raw, tell_raw;
    struct exh_mean told_mon, told_coded; /* of the level */
};

/* Inputs of a phase in a tick. */
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
    uint8_t hands;      /* 1: hands are at the device; no RUN needed, no current */
    uint8_t far;        /* enum bringup_far: allowed movement */
    const char *name, *text;
};
const struct bringup_phase *bringup_phase(unsigned list, unsigned phase); /* NULL: no more phases */

/* One tick of a phase; returns its result. *f_N_q20 receives the requested force, or the current
 * that replaces it. */
uint8_t bringup_step(struct bringup *s, const struct bringup_cfg *cfg,
    const struct bringup_phase *p, struct bringup_view v, int32_t *f_N_q20);

/* 0 or -EXH_E_RANGE. Divides. */
int bringup_setup(
    struct bringup_cfg *cfg, const struct bringup_par *par, struct exh_scene_board board);
void bringup_start(struct bringup *s);
void bringup_tick(struct bringup *s, const struct bringup_cfg *cfg, const struct exh_scene_in *in,
    struct exh_drive_out *out, struct bringup_signals *sig);

/* Text for a result, such as "the monitor does not show the current commanded". Never NULL. */
const char *bringup_result_text(unsigned result);

/* Writes the report of the last tick as lines to text. Returns its length; 0: no report. Divides:
 * not in a tick. */
#define BRINGUP_TEXT_B 400
unsigned bringup_text(
    char text[BRINGUP_TEXT_B], const struct bringup *s, const struct bringup_cfg *cfg);

extern const struct exh_scene exh_scene_bringup;

/* The one instance, for display. */
const struct bringup *bringup_state(void);
const struct bringup_cfg *bringup_config(void);

#endif
