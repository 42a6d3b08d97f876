/* SPDX-License-Identifier: MIT */
/* The complete device as a scene (the bilateral controller of the paper). The glove gives
 * fingertips, which go over a link to a world. The world returns planes. Virtual contacts are
 * frozen before they are touched and give forces. Unused fingers cost nothing. */
#ifndef EXAMPLES_BILATERAL_H
#define EXAMPLES_BILATERAL_H

#include "exhand/run/calib_set.h"
#include "../glove/cal.h"
#include "exhand/run/scene.h"

#include "exhand/exhand.h"

#define BILATERAL_FINGERS   EXH_FINGERS
#define BILATERAL_MATERIALS 8

/* A rule of `exhand advise gains` is valid for one rate; a scaled rule is a guess. */
enum bilateral_rule_on { BILATERAL_RULE_OFF, BILATERAL_RULE_AS_IT_IS, BILATERAL_RULE_SCALED };

/* Rows of the scene's own parameters. */
struct bilateral_own_par {
    int32_t fingers;     /* mask of the fingers in use, thumb in bit 0 */
    int32_t state_every; /* ticks between state packets */
    int32_t session;     /* of the link; 0: set-up takes it from the board's cycle counter */
    int32_t quiet_ms;    /* silence after which a HELLO starts a new session */
    int32_t f0_rest_ms;  /* a string that has not run out further for this time is wound in */
    int32_t glove_ms;    /* longest time without data of a finger in use, else a fault; 0: never */
    int32_t link_ms;     /* longest time without planes, else a fault; 0: never, contacts are
                          * local */
    int32_t rule_on;     /* enum bilateral_rule_on: refuse k and b of materials outside the rule */
};

/* All parameters, in the order of the scene's table. */
struct bilateral_par {
    struct exh_quad_par quad[BILATERAL_FINGERS];
    struct exh_velocity_par velocity[BILATERAL_FINGERS];
    struct exh_contact_par contact[BILATERAL_FINGERS]; /* k and b come from the material */
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
    struct exh_gains_par gains; /* rule for materials; unused if rule_on is 0 */
};

/* The nine signals of the paper are these and the time. */
struct bilateral_paper {
    int32_t q_m_q30;
    int32_t qd_mps_q27;
    int32_t f_des_N_q20;
    int32_t i_des_A_q26;
    int32_t c;
    int32_t f_mon_N_q20;
    int32_t d_m_q30;     /* INT32_MIN: no plane */
    int32_t q_lim_m_q30; /* EXH_PRECONTACT_NO_LIM: no contact possible */
};

struct bilateral_more {
    int32_t bits;   /* enum exh_precontact_bit */
    int32_t limits; /* enum exh_limit */
    int32_t joint_turn_q32[EXH_HAND_JOINTS];
    int32_t clamped; /* bit j: joint j at a limit */
    struct exh_vec3 tip_m_q30;
    int32_t freezes, born, refused, ignored, stale, let_go, late; /* counters of exh_precontact */
    int32_t late_m_q30; /* d at the start of the last late contact */
};

struct bilateral_box {
    int32_t state;        /* enum exh_state */
    int32_t faults;       /* enum exh_fault, latched */
    int32_t present;      /* enum exh_fault: why RUN or CLEAR is refused */
    int32_t glove_faults; /* bit i: sensor i */
    int32_t glove_age;    /* ticks */
    int32_t age;          /* ticks since the newest planes; INT32_MAX: never */
    int32_t trip_us;      /* age of the STATE that they answered */
    int32_t set;          /* parameters set over the link */
    int32_t accepted, missing, duplicate, reordered, old, stranger, corrupt, version, unknown;
    int32_t far, silences;
    int32_t differs;  /* enum exh_wire_difference of the newest HELLO */
    int32_t odd;      /* HELLOs that differed */
    int32_t arm_step; /* enum exh_arm: present step of arming, or last refused */
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
    int32_t out_m_q30;                       /* length of string run out */
    uint32_t rest_ticks;                     /* ticks since */
    int32_t joint_turn_q32[EXH_HAND_JOINTS]; /* these four are of the newest glove frame */
    struct exh_vec3 tip_m_q30, slope_q24;
    uint8_t clamped;
    /* Not saved, as neither changes a result: frames in which the position may still be kept, and
     * what it was computed from in addition to the joints. */
    uint8_t keep_frames, how;
};

/* A port that need not take the same time in every tick defines more, to save time while a finger
 * rests. Every choice gives the same bits. */
#ifndef BILATERAL_KEEP_FRAMES
#define BILATERAL_KEEP_FRAMES 1
#endif

/* --- a glove frame --- */

#define BILATERAL_PARTS 7

/* The end of a part of a frame: sensors and places of fingers before these. */
struct bilateral_part {
    uint8_t sensors, places;
};

/* The newest frame, processed over the ticks until the next. */
struct bilateral_frame {
    int32_t angle_turn_q32[EXH_GLOVE_SENSORS]; /* codes q16, then angles if needed */
    uint32_t faults;                           /* faulty sensors */
    uint32_t before_ticks;                     /* age of the previous frame; UINT32_MAX: none */
    uint8_t left;                              /* parts left to compute */
    uint8_t places; /* set in every tick: fingers at these places use it */
};

/* --- the link --- */

struct bilateral_wire_cfg {
    uint64_t tick_us_q20; /* per tick */
    uint32_t ticks_per_us_q32;
    uint32_t ms_per_tick_q20;
    struct exh_wire_hello hello; /* ours */
};

#define BILATERAL_FRAMES 16 /* trace frames in memory, more than a packet holds */

/* Signals of every n-th tick, as the world requests them, sent after all other packets. */
struct bilateral_trace {
    struct exh_trace of;
    struct exh_trace_frame frame[BILATERAL_FRAMES];
    uint32_t request_seq; /* of the newest request */
    uint32_t next;        /* number of the first frame not yet sent */
    uint32_t wait_ticks;  /* ticks since */
    int16_t result;       /* of the request */
    uint8_t answer;       /* 1: the result is not yet sent */
};

#define BILATERAL_HELLO 1u
#define BILATERAL_STATE 2u

struct bilateral_wire {
    struct exh_wire_tx tx;
    struct exh_wire_rx rx;
    uint64_t now_us_q20; /* clock: ticks since set-up including missed ones, modulo 2^44 us */
    uint32_t age_ticks;  /* since the newest planes; UINT32_MAX: never */
    uint32_t trip_us;
    uint32_t exchanges;
    uint32_t set;
    uint32_t wait_ticks; /* ticks to the next exchange */
    uint32_t differs;    /* enum exh_wire_difference of the newest HELLO */
    uint32_t odd;        /* HELLOs that differed */
    uint8_t due;         /* packets to send: BILATERAL_HELLO, BILATERAL_STATE */
    uint8_t heard;       /* 1: packets came in this tick */
    uint8_t acks;        /* answers to send after this tick */
    struct exh_wire_ack ack[EXH_SCENE_PACKETS];
    struct bilateral_trace trace;
};

/* --- all --- */

struct bilateral_cfg {
    const struct bilateral_par *par;
    struct exh_glove_cal cal;
    struct exh_glove_cfg glove;
    struct bilateral_finger_cfg finger[BILATERAL_FINGERS];
    /* By place: fingers in use first, then the others. */
    struct exh_drive_cfg drive[BILATERAL_FINGERS];
    struct exh_safety_cfg safety;
    struct exh_supply_cfg supply;
    uint32_t glove_ticks, link_ticks;                /* glove_ms, link_ms; 0: never */
    uint8_t at[BILATERAL_FINGERS];                   /* finger at this place */
    uint8_t n;                                       /* number of fingers in use */
    uint32_t sensors;                                /* bit i: a finger in use needs sensor i */
    uint8_t parts;                                   /* parts of a frame */
    struct bilateral_part part[BILATERAL_PARTS + 1]; /* from part[p] to part[p + 1] */
    uint32_t rest_ticks;                             /* f0_rest */
    uint8_t tested;                                  /* 1: the self-test passed at set-up */
    uint8_t vouches; /* enum exh_arm: confirmed by calibrations of all fingers in use, or waived */
    struct bilateral_wire_cfg wire;
    struct exh_gains_par gains; /* the rule for materials */
};

struct bilateral {
    struct bilateral_finger finger[BILATERAL_FINGERS];
    struct exh_safety safety;
    struct exh_glove glove;
    struct bilateral_frame frame;
    struct bilateral_wire wire;
    uint8_t worn;          /* a glove frame was received */
    uint32_t glove_faults; /* of the newest frame, or of one that fingers still use */
    struct exh_supply supply;
    uint32_t unsure_ticks; /* ticks without new data of a finger in use */
    uint8_t broken;        /* 1: configuration or parameters changed (integrity.h); set by the
                            * caller */
    /* Set in every tick: monitor currents, and the age of the glove's data. UINT32_MAX: none, or
     * not for very long. */
    int32_t mon_A_q26[BILATERAL_FINGERS];
    uint32_t glove_age_ticks;
    uint8_t pulls;                                   /* 1: arming pulls and the law is off */
    struct exh_polarity polarity[BILATERAL_FINGERS]; /* the pull of each finger */
};

/* Makes the configuration from parameters, and from calibrations in calib for fingers in use (NULL:
 * none). cfg keeps pointers to par and to s. Returns 0 or -EXH_E_.... Does not check materials
 * against the rule; the scene's own set-up does. */
int bilateral_setup(struct bilateral_cfg *cfg, struct bilateral *s, const struct bilateral_par *par,
    struct exh_scene_board board, struct exh_scene_calib *calib);

/* One tick. params: where packets stage values. Sets those of sig that the state does not hold. */
void bilateral_tick(struct bilateral *s, const struct bilateral_cfg *cfg,
    const struct exh_scene_in *in, const struct exh_scene_mail *mail, struct exh_params *params,
    struct exh_drive_out *out, struct bilateral_signals *sig);

/* Sets the rest of sig; call it before the next tick. */
void bilateral_tell(
    const struct bilateral *s, const struct bilateral_cfg *cfg, struct bilateral_signals *sig);

/* Call it after a tick: writes the packets to send. */
void bilateral_write(struct bilateral *s, const struct bilateral_cfg *cfg,
    struct bilateral_signals *sig, struct exh_scene_mail *out);

/* The state except the pull of arming, which follows it in a keyframe. */
void bilateral_bytes(struct exh_bytes *c, struct bilateral *s);

/* Number of fingers in use, and the finger at a place k < 5. If memory is damaged they are wrong
 * until the guard reports it, but stay within array bounds. */
static inline unsigned bilateral_n(const struct bilateral_cfg *cfg)
{
    const unsigned n = cfg->n < BILATERAL_FINGERS ? cfg->n : BILATERAL_FINGERS;
    return n > 0 ? n : 1;
}
static inline unsigned bilateral_at(const struct bilateral_cfg *cfg, unsigned k)
{
    const unsigned f = cfg->at[k];
    return f & (0u - (f < BILATERAL_FINGERS)); /* a branch would double the code that indexes by
                                                * it */
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
/* Queues one packet if there is room. */
void bilateral_wire_put(
    struct bilateral_wire *w, struct exh_scene_mail *out, struct exh_wire_packet *p);
/* Stops the trace: no request, or its sender has gone. */
void bilateral_trace_stop(struct bilateral_trace *t);
void bilateral_trace_ask(struct bilateral_trace *t, const struct exh_wire_packet *p);
/* Call it after a tick: records its frame, queues at most one packet. */
void bilateral_trace_write(struct bilateral *s, const struct bilateral_cfg *cfg,
    struct bilateral_signals *sig, struct exh_scene_mail *out);
void bilateral_trace_bytes(struct exh_bytes *c, struct bilateral_trace *t);
void bilateral_finger_bytes(struct exh_bytes *c, struct bilateral_finger *s);

void bilateral_frame_setup(struct bilateral_cfg *cfg);
/* Adds a tick and those missed before it; UINT32_MAX stays. */
uint32_t bilateral_later(uint32_t ticks, uint32_t missed);
/* Call it in every tick before any use of an age. */
void bilateral_age(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_scene_in *in);
/* Call it in every tick: takes a new frame, and computes a part of the newest. */
void bilateral_see(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_scene_in *in);
void bilateral_frame_bytes(struct exh_bytes *c, struct bilateral_frame *s);

/* Age of the position of the finger at a place; UINT32_MAX: unknown, since one of its sensors is
 * faulty: a distance from held angles would be wrong. */
uint32_t bilateral_finger_age(
    const struct bilateral *s, const struct bilateral_cfg *cfg, unsigned place);
/* Causes of the device, apart from fingers: enum exh_fault. */
int bilateral_cause_setup(struct bilateral_cfg *cfg, struct exh_period T);
uint32_t bilateral_causes(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_scene_in *in);

/* Makes the rule for this period. 0, or an error of exh_gains_setup(). */
int bilateral_gains_setup(
    struct exh_gains_par *rule, const struct bilateral_par *par, struct exh_period T);
/* Moves a default material outside the rule into it. */
void bilateral_soften(const struct exh_gains_par *rule, struct exh_material_par *m);
/* As exh_params_stage_by(), or exh_gains_stage_by() with rule_on. -EXH_E_UNKNOWN: no such row. */
int bilateral_gains_stage(const struct bilateral_cfg *cfg, struct exh_params *params,
    struct exh_authority who, const struct exh_wire_param *ask);
extern const struct exh_gains_par bilateral_rule;

/* Uses the newest glove frame. */
void bilateral_finger_see(struct bilateral_finger *s, const struct bilateral_cfg *cfg, unsigned f,
    const int32_t *angle_turn_q32);
/* Position to force and current. Returns limit bits. */
uint32_t bilateral_finger_feel(struct bilateral *s, const struct bilateral_cfg *cfg, unsigned place,
    const struct exh_permit *permit, struct exh_current_ledger *i, struct bilateral_paper *p,
    int32_t *bits);

/* Stages a calibration in the scene's parameters, between defaults() and set-up. Returns 0, or
 * -EXH_E_RANGE with the reason in *bad (may be NULL). */
int bilateral_stage_cal(const struct exh_glove_cal *cal, struct exh_glove_error *bad);

/* Memory of the one instance, for tests that damage it. */
struct bilateral *bilateral_memory(struct bilateral_cfg **cfg);
struct exh_integrity *bilateral_guard(void);

extern const struct exh_scene exh_scene_bilateral;

#endif
