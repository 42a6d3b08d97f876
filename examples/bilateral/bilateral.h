/* SPDX-License-Identifier: MIT */
/* The full box as a scene (the paper's bilateral controller): glove to fingertips, fingertips over
 * a link to a world, planes back, virtual contacts frozen before they are touched, forces. A
 * finger that is not in use costs nothing. */
#ifndef EXAMPLES_BILATERAL_H
#define EXAMPLES_BILATERAL_H

#include "exhand/run/calib_set.h"
#include "../glove/cal.h"
#include "exhand/run/scene.h"

#include "exhand/exhand.h"

#define BILATERAL_FINGERS   EXH_FINGERS
#define BILATERAL_MATERIALS 8

/* A rule of `exhand advise gains` is of one rate; one that is scaled is a guess for others. */
enum bilateral_rule_on { BILATERAL_RULE_OFF, BILATERAL_RULE_AS_IT_IS, BILATERAL_RULE_SCALED };

/* Rows of the scene's own parameters. */
struct bilateral_own_par {
    int32_t fingers;     /* mask: which are in use, thumb in bit 0 */
    int32_t state_every; /* ticks from one state packet to the next */
    int32_t session;     /* of the link; 0: made up at set-up, of the board's cycle counter */
    int32_t quiet_ms;    /* nothing heard for so long: a HELLO begins anew */
    int32_t f0_rest_ms;  /* a string that has run out no farther for so long is wound in */
    int32_t glove_ms;    /* nothing known of a finger in use for so long: a fault; 0: never */
    int32_t link_ms;     /* no planes for so long: a fault; 0: never, contacts are local */
    int32_t rule_on;     /* enum bilateral_rule_on: k and b of materials outside are refused */
};

/* All parameters, in the order of the scene's table. */
struct bilateral_par {
    struct exh_quad_par quad[BILATERAL_FINGERS];
    struct exh_velocity_par velocity[BILATERAL_FINGERS];
    struct exh_contact_par contact[BILATERAL_FINGERS]; /* k and b are the material's */
    struct exh_drive_par drive[BILATERAL_FINGERS];
    struct exh_tracking_par track[BILATERAL_FINGERS];
    struct exh_motion_par watch[BILATERAL_FINGERS];
    int32_t kf_NpA_q20[BILATERAL_FINGERS];
    struct exh_hand_par hand[BILATERAL_FINGERS];
    struct exh_precontact_par precontact[BILATERAL_FINGERS];
    struct exh_material_par material[BILATERAL_MATERIALS];
    struct exh_safety_par safety;
    struct exh_polarity_par polarity;
    struct exh_supply_par supply;
    struct exh_glove_par glove;
    struct bilateral_own_par own;
    struct exh_calib_set_par calib;
    struct glove_own_par glove_own;
    struct glove_sensor_par sensor[EXH_GLOVE_SENSORS];
    struct exh_tune_par tune;
    struct exh_chatter_par chatter[BILATERAL_FINGERS];
    struct exh_gains_par gains; /* of materials; not looked at with rule_on 0 */
};

/* The paper's nine are these and time. */
struct bilateral_paper {
    int32_t q_m_q30;
    int32_t qd_mps_q27;
    int32_t f_des_N_q20;
    int32_t i_des_A_q26;
    int32_t c;
    int32_t f_mon_N_q20;
    int32_t d_m_q30;     /* INT32_MIN: there is no plane */
    int32_t q_lim_m_q30; /* EXH_PRECONTACT_NO_LIM: no contact can be */
};

struct bilateral_more {
    int32_t bits;   /* enum exh_precontact_bit */
    int32_t limits; /* enum exh_limit */
    int32_t joint_turn_q32[EXH_HAND_JOINTS];
    int32_t clamped; /* bit j: joint j at a limit */
    struct exh_vec3 tip_m_q30;
    int32_t freezes, born, refused, ignored, stale, let_go, late; /* counts, of exh_precontact */
    int32_t late_m_q30; /* d where the last late contact began */
};

struct bilateral_box {
    int32_t state;        /* enum exh_state */
    int32_t faults;       /* enum exh_fault, latched */
    int32_t present;      /* enum exh_fault: why RUN or CLEAR is refused */
    int32_t glove_faults; /* bit i: sensor i */
    int32_t glove_age;    /* ticks */
    int32_t age;          /* ticks since the newest planes came; INT32_MAX: never */
    int32_t trip_us;      /* how old the question was that they answered */
    int32_t set;          /* parameters set over the link */
    int32_t accepted, missing, duplicate, reordered, old, stranger, corrupt, version, unknown;
    int32_t far, silences;
    int32_t differs;  /* enum exh_wire_difference, of the newest HELLO */
    int32_t odd;      /* HELLOs that differed */
    int32_t arm_step; /* enum exh_arm: on which arming is, or was refused */
};

struct bilateral_signals {
    struct bilateral_paper paper[BILATERAL_FINGERS];
    struct bilateral_more more[BILATERAL_FINGERS];
    struct bilateral_box box;
};

extern const struct exh_signal_table bilateral_params, bilateral_outputs;

/* --- one finger --- */

struct bilateral_finger_cfg {
    struct exh_quad_cfg quad;
    struct exh_velocity_window_cfg velocity;
    struct exh_hand_finger hand;
    struct exh_precontact_cfg precontact;
    struct exh_tracking_cfg track;
    struct exh_motion_cfg watch;
    struct exh_polarity_cfg polarity;
    struct exh_chatter_cfg chatter;
    struct exh_calib_tables calib;
    uint32_t sensors; /* bit i: sensor i moves it */
};

struct bilateral_finger {
    struct exh_quad quad;
    struct exh_velocity_window velocity;
    struct exh_contact contact;
    struct exh_drive drive;
    struct exh_tracking track;
    struct exh_motion watch;
    struct exh_chatter chatter;
    struct exh_precontact precontact;
    int32_t out_m_q30;                       /* how far the string has run out */
    uint32_t rest_ticks;                     /* since then */
    int32_t joint_turn_q32[EXH_HAND_JOINTS]; /* these four of the newest glove frame */
    struct exh_vec3 tip_m_q30, slope_q24;
    uint8_t clamped;
};

/* --- a glove frame --- */

#define BILATERAL_PARTS 7

/* A part of a frame is sensors and places of fingers up to these, from those of the one before. */
struct bilateral_part {
    uint8_t sensors, places;
};

/* The newest, on its way through the ticks until the next. */
struct bilateral_frame {
    int32_t angle_turn_q32[EXH_GLOVE_SENSORS]; /* codes q16, until they are angles */
    uint32_t faults;                           /* sensors that it does not believe */
    uint32_t before_ticks; /* how old the frame before is; UINT32_MAX: there is none */
    uint8_t left;          /* parts still to be computed */
    uint8_t places;        /* made anew in every tick: fingers at these places are of it */
};

/* --- the link --- */

struct bilateral_wire_cfg {
    uint64_t tick_us_q20; /* a tick */
    uint32_t ticks_per_us_q32;
    uint32_t ms_per_tick_q20;
    struct exh_wire_hello hello; /* ours */
};

#define BILATERAL_FRAMES 16 /* of a trace, in memory: more than a packet holds */

/* Signals of every n-th tick, as the world asks for them, behind all else that goes out. */
struct bilateral_trace {
    struct exh_trace of;
    struct exh_trace_frame frame[BILATERAL_FRAMES];
    uint32_t request_seq; /* of the newest packet that asked */
    uint32_t next;        /* number of the first frame that has not gone out */
    uint32_t wait_ticks;  /* since then there have been such */
    int16_t result;       /* of what was asked */
    uint8_t answer;       /* 1: it is still to be told */
};

#define BILATERAL_HELLO 1u
#define BILATERAL_STATE 2u

struct bilateral_wire {
    struct exh_wire_tx tx;
    struct exh_wire_rx rx;
    uint64_t now_us_q20; /* our clock: ticks since set-up, missed ones too; modulo 2^44 us */
    uint32_t age_ticks;  /* since the newest planes; UINT32_MAX: never */
    uint32_t trip_us;
    uint32_t exchanges;
    uint32_t set;
    uint32_t wait_ticks; /* to the next exchange */
    uint32_t differs;    /* enum exh_wire_difference, of the newest HELLO */
    uint32_t odd;        /* HELLOs that differed */
    uint8_t due;         /* still to be sent: BILATERAL_HELLO, BILATERAL_STATE */
    uint8_t heard;       /* 1: packets came in this tick */
    uint8_t acks;        /* answers to be given at the end of this tick */
    struct exh_wire_ack ack[EXH_SCENE_PACKETS];
    struct bilateral_trace trace;
};

/* --- all --- */

struct bilateral_cfg {
    const struct bilateral_par *par;
    struct exh_glove_cal cal;
    struct exh_glove_cfg glove;
    struct bilateral_finger_cfg finger[BILATERAL_FINGERS];
    /* By place: fingers in use come first, then the others. */
    struct exh_drive_cfg drive[BILATERAL_FINGERS];
    struct exh_safety_cfg safety;
    struct exh_supply_cfg supply;
    uint32_t glove_ticks, link_ticks;                /* glove_ms, link_ms; 0: never */
    uint8_t at[BILATERAL_FINGERS];                   /* which finger is at this place */
    uint8_t n;                                       /* in use */
    uint8_t parts;                                   /* of a frame */
    struct bilateral_part part[BILATERAL_PARTS + 1]; /* from part[p] to part[p + 1] */
    uint32_t rest_ticks;                             /* f0_rest */
    uint8_t tested;                                  /* 1: known answers came out at set-up */
    uint8_t vouches; /* enum exh_arm: by calibrations of all fingers in use, or waived */
    struct bilateral_wire_cfg wire;
    struct exh_gains_par gains; /* the rule that materials are held against */
};

struct bilateral {
    struct bilateral_finger finger[BILATERAL_FINGERS];
    struct exh_safety safety;
    struct exh_glove glove;
    struct bilateral_frame frame;
    struct bilateral_wire wire;
    uint8_t worn;          /* a glove frame has come */
    uint32_t glove_faults; /* in the newest, or in one that fingers are still of */
    struct exh_supply supply;
    uint32_t unsure_ticks; /* nothing new known of a finger in use since */
    uint8_t broken;        /* 1: configuration or parameters changed (guard.h); of whoever looks */
    /* Made anew in every tick: currents of the monitors; how old what the glove says is,
     * UINT32_MAX: it has not said anything, or not for very long. */
    int32_t mon_A_q26[BILATERAL_FINGERS];
    uint32_t glove_age_ticks;
    uint8_t pulls;                                   /* 1: arming pulls, and no law is asked */
    struct exh_polarity polarity[BILATERAL_FINGERS]; /* arming's pull, of each finger */
};

/* Configuration from parameters, and of the calibrations that calib has of fingers in use (NULL:
 * none); cfg keeps pointers to par and to s. 0 or -EXH_E….
 * Materials are not held against the rule: the scene's own set-up does that. */
int bilateral_setup(struct bilateral_cfg *cfg, struct bilateral *s, const struct bilateral_par *par,
    struct exh_scene_board board, struct exh_scene_calib *calib);

/* One tick; params: where packets stage what they ask for. Of sig it fills in what its state does
 * not keep. */
void bilateral_tick(struct bilateral *s, const struct bilateral_cfg *cfg,
    const struct exh_scene_in *in, const struct exh_scene_mail *mail, struct exh_params *params,
    struct exh_drive_out *out, struct bilateral_signals *sig);

/* The rest of it, for whoever reads it before the next tick. */
void bilateral_tell(
    const struct bilateral *s, const struct bilateral_cfg *cfg, struct bilateral_signals *sig);

/* Behind a tick: the packets that go out. */
void bilateral_write(struct bilateral *s, const struct bilateral_cfg *cfg,
    struct bilateral_signals *sig, struct exh_scene_mail *out);

/* All but arming's pull, which is behind it where a run is kept. */
void bilateral_bytes(struct exh_bytes *c, struct bilateral *s);

/* How many fingers are in use, and which is at a place k < 5. Of damaged memory they are wrong,
 * until the guard tells, but no index beyond an array. */
static inline unsigned bilateral_n(const struct bilateral_cfg *cfg)
{
    const unsigned n = cfg->n < BILATERAL_FINGERS ? cfg->n : BILATERAL_FINGERS;
    return n > 0 ? n : 1;
}
static inline unsigned bilateral_at(const struct bilateral_cfg *cfg, unsigned k)
{
    const unsigned f = cfg->at[k];
    return f & (0u - (f < BILATERAL_FINGERS)); /* a branch would double whatever indexes by it */
}

/* The parts of the finger f = bilateral_at(cfg, k) at a place k. */
static inline struct exh_axis bilateral_axis(
    struct bilateral *s, const struct bilateral_cfg *cfg, unsigned k, unsigned f)
{
    struct bilateral_finger *now = &s->finger[f];
    const struct bilateral_finger_cfg *c = &cfg->finger[f];
    return (struct exh_axis){&now->quad, &c->quad, &now->velocity, &c->velocity, &now->watch,
        &c->watch, &now->track, &c->track, &now->drive, &cfg->drive[k], &now->chatter, &c->chatter};
}

/* --- parts (finger.c, frame.c, wire.c, trace.c) --- */

int bilateral_finger_setup(struct bilateral_cfg *cfg, unsigned place, struct exh_scene_board board,
    struct exh_scene_calib *calib);
void bilateral_wire_setup(struct bilateral_wire_cfg *cfg, struct bilateral_wire *s,
    uint32_t session, struct exh_period T);
void bilateral_wire_take(struct bilateral *s, const struct bilateral_cfg *cfg,
    const struct exh_scene_mail *in, uint32_t missed, struct exh_params *params);
void bilateral_wire_bytes(struct exh_bytes *c, struct bilateral_wire *s);
/* One packet, if there is room. */
void bilateral_wire_put(
    struct bilateral_wire *w, struct exh_scene_mail *out, struct exh_wire_packet *p);
/* Nobody has asked, or who did has gone. */
void bilateral_trace_stop(struct bilateral_trace *t);
void bilateral_trace_ask(struct bilateral_trace *t, const struct exh_wire_packet *p);
/* Behind a tick: its frame, and one packet at most. */
void bilateral_trace_write(struct bilateral *s, const struct bilateral_cfg *cfg,
    struct bilateral_signals *sig, struct exh_scene_mail *out);
void bilateral_trace_bytes(struct exh_bytes *c, struct bilateral_trace *t);
void bilateral_finger_bytes(struct exh_bytes *c, struct bilateral_finger *s);

void bilateral_frame_setup(struct bilateral_cfg *cfg);
/* Ticks since something, behind a tick and those missed before it; UINT32_MAX stays. */
uint32_t bilateral_later(uint32_t ticks, uint32_t missed);
/* In every tick, before anybody asks for an age. */
void bilateral_age(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_scene_in *in);
/* In every tick: takes a frame that is new, and computes a part of the newest. */
void bilateral_see(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_scene_in *in);
void bilateral_frame_bytes(struct exh_bytes *c, struct bilateral_frame *s);

/* The age of what is known of where the finger at a place is; UINT32_MAX: nothing, as one of its
 * sensors is not believed: held angles make a distance that is not. */
uint32_t bilateral_finger_age(
    const struct bilateral *s, const struct bilateral_cfg *cfg, unsigned place);
/* Of the box, behind link and glove: enum exh_fault. */
int bilateral_cause_setup(struct bilateral_cfg *cfg, struct exh_period T);
uint32_t bilateral_causes(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_scene_in *in);

/* The rule for this period. 0, or what exh_gains_setup() says. */
int bilateral_gains_setup(
    struct exh_gains_par *rule, const struct bilateral_par *par, struct exh_period T);
/* A material of the rows' default values that is outside becomes what is inside. */
void bilateral_soften(const struct exh_gains_par *rule, struct exh_material_par *m);
/* As exh_params_stage_by(), or exh_gains_stage_by() with rule_on; -EXH_E_UNKNOWN: no such row. */
int bilateral_gains_stage(const struct bilateral_cfg *cfg, struct exh_params *params,
    struct exh_authority who, const struct exh_wire_param *ask);
extern const struct exh_gains_par bilateral_rule;

/* From the newest glove frame. */
void bilateral_finger_see(struct bilateral_finger *s, const struct bilateral_cfg *cfg, unsigned f,
    const int32_t *angle_turn_q32);
/* Position to force and current. Returns limit bits. */
uint32_t bilateral_finger_feel(struct bilateral *s, const struct bilateral_cfg *cfg, unsigned place,
    const struct exh_permit *permit, struct exh_current_ledger *i, struct bilateral_paper *p,
    int32_t *bits);

/* Stages a calibration in the scene's parameters, between defaults() and set-up: 0, or
 * -EXH_E_RANGE with *bad (may be NULL). */
int bilateral_stage_cal(const struct exh_glove_cal *cal, struct exh_glove_error *bad);

/* The memory of the one instance, for who damages it to see what happens. */
struct bilateral *bilateral_memory(struct bilateral_cfg **cfg);
struct exh_integrity *bilateral_guard(void);

extern const struct exh_scene exh_scene_bilateral;

#endif
