/* SPDX-License-Identifier: MIT */
/* One run of the bilateral scene: hand, glove, motors, link and world in virtual time. */
#ifndef CLI_BILATERAL_RUN_H
#define CLI_BILATERAL_RUN_H

#include "falls/analysis.h"
#include "box/hand_peer.h"
#include "box/images.h"
#include "posix.h"
#include "box/run.h"

#include "bilateral/bilateral.h"

struct bilateral_run_cfg {
    uint32_t rate_Hz;
    struct posix_config board;     /* device, seed, log, exo (fingers, paths), line (ways) */
    double k_Npm, b_Nspm;          /* of every material; < 0: the scene's own, over the link */
    const struct run_setting *own; /* what the simulated hand needs other than the scene has it */
    int owns;
    const struct run_setting *setting; /* further parameters, of all fingers; behind an image */
    int settings;
    const struct exh_wire_param *want; /* what the world sets over the link */
    int wants;
    double param_from_s; /* not before */
    int hostile;
    int trace_every; /* ticks: the world asks for q, F_des, i, c of the lowest finger; 0: not */
    double jump_s, jump_m;                       /* of walls (peer_world) */
    struct world *scene;                         /* NULL: a wall in front of each finger */
    double at_m;                                 /* where, as string */
    double fps, from_s, until_s, again_s, ray_m; /* of the world (peer_cfg); ray 0: no end */
    int32_t session; /* of the controller; 0: of the seed, over UDP of the clock */
    int trial;       /* an experiment with gains: no rule of gains, no fault for chatter */
    int keep;        /* keep samples */
    int bare;        /* 1: contacts and faults alone, without digests and ranges */
    const struct exh_glove_cal *glove_cal; /* of board.glove_tty; NULL: default */
    const struct images *images;       /* calibrations of fingers; NULL, or none: uncalibrated */
    const char *blackbox;              /* dumps go there (dumpfile.h); NULL: no black box */
    const struct exh_loop_hooks *more; /* behind the run's own; NULL: none */
    struct run_live live;
};

/* One finger in one tick, as the scene says it, and as it is. */
struct bilateral_sample {
    struct bilateral_paper raw;
    int32_t bits;     /* enum exh_precontact_bit */
    int32_t approach; /* from 1; 0: at rest between two */
    int32_t holds;    /* pressing */
    double x_m;       /* string, at the finger */
    /* In the world of this process; NAN if not evaluated. */
    double inside_m; /* how far the pad is in something, each 10 ms */
    double touch_m;  /* where c sets: the string at which the pad touches now; -1: nowhere */
};

/* What a finger did, tick by tick, and what is counted without keeping it. */
struct bilateral_track {
    struct bilateral_sample *at;
    size_t n, cap;
    double touch_m; /* string at which pad and object touch at first; < 0: never */
    double scale;   /* s of the last freeze */
    long freezes;
    long contacts;   /* times that c set */
    long unfrozen;   /* ticks with c but without a frozen q_lim: must stay 0 */
    long refused;    /* planes */
    uint32_t digest; /* CRC of force, current and position from the first freeze on */
    int frozen_yet, c;
    /* what it went through */
    struct bilateral_range {
        double lo_m, hi_m; /* string at the finger */
        int32_t lo_turn_q32[EXH_HAND_JOINTS], hi_turn_q32[EXH_HAND_JOINTS];
        int32_t f_max_N_q20;
        uint64_t touched; /* ticks */
    } range;
};

struct bilateral_run {
    struct exh_period T;
    struct bilateral_track finger[BILATERAL_FINGERS];
    struct bilateral_box box; /* at the end */
    uint64_t ticks;
    uint32_t lost, faults;
    int32_t unarmed; /* enum exh_arm: the step at which arming was; faults: its causes */
    int dumps;       /* of the black box; -1: one could not be written */
    struct sim_link_counts way[SIM_LINK_WAYS];
    uint64_t frames, answers;
    struct peer_trace trace;
    int params, acked, refused; /* over the link */
};

/* Set up: sensors of no finger in use are not simulated, unless codes are recorded. */
void bilateral_leave_out(const struct bilateral_run_cfg *c);

/* The scene's parameters as a run has them from its start. 0 or -EXH_E… after a line on stderr. */
int bilateral_stage(const struct bilateral_run_cfg *c);

/* 0 or -EXH_E… after a line on stderr. Free it after an error, too. */
int bilateral_run(const struct bilateral_run_cfg *c, struct bilateral_run *r);
void bilateral_run_free(struct bilateral_run *r);

/* The glove as it is, perfectly calibrated. */
void bilateral_cal_of(struct exh_glove_cal *cal, const struct sim_glove_par *p);

/* A finger in the exoskeleton: which, the string's arms, and the pose of the rest of the hand. */
struct bilateral_finger_is {
    unsigned f;
    const double *arm_m;
    int pose;
};

/* A wall across its way where it has drawn x_m out. */
void bilateral_wall(struct exh_wire_plane *to, const struct bilateral_finger_is *w, double x_m);

/* String metres per fingertip metre over the last d_m > 0 of its way to where it has drawn x_m out.
 */
double bilateral_scale(const struct bilateral_finger_is *w, double x_m, double d_m);

/* d of it where it has drawn x_m out: of its wall, or of the nearest surface of the scene at
 * t_s; -1e3: nothing. */
double bilateral_gap_m(
    const struct peer_world *world, const struct bilateral_finger_is *w, double x_m, double t_s);

/* The string at which d first is d_m; -1: nowhere. */
double bilateral_string_m(
    const struct peer_world *world, const struct bilateral_finger_is *w, double t_s, double d_m);

#endif
