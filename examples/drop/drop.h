/* SPDX-License-Identifier: MIT */
/* The identification controller of the paper (its Fig. 4) as a scene: one motor and a virtual wall
 * at q_lim. All parameters are adjustable, all signals are logged. */
#ifndef EXAMPLES_DROP_H
#define EXAMPLES_DROP_H

#include "exhand/run/calib_set.h"

#include "exhand/exhand.h"

/* Rows of the scene's own parameters. */
struct drop_own_par {
    int32_t q_lim_m_q30; /* virtual contact, relative to the first count */
    int32_t kf_NpA_q20;  /* string force per motor ampere, if there is no calibration */
};

#define DROP_OWN_ROWS   2
#define DROP_PAPER_ROWS 6
#define DROP_MORE_ROWS  5
extern const struct exh_signal drop_own_rows[DROP_OWN_ROWS];
extern const struct exh_signal drop_paper_rows[DROP_PAPER_ROWS];
extern const struct exh_signal drop_more_rows[DROP_MORE_ROWS];

/* Groups of its tables, for scenes that extend this one. */
#define DROP_PARAM_N 12
#define DROP_PARAM_GROUPS \
    {exh_quad_rows, EXH_QUAD_ROWS, 1}, {exh_velocity_rows, EXH_VELOCITY_ROWS, 1}, \
        {exh_contact_rows, EXH_CONTACT_ROWS, 1}, {exh_drive_rows, EXH_DRIVE_ROWS, 1}, \
        {exh_tracking_rows, EXH_TRACKING_ROWS, 1}, {exh_motion_rows, EXH_MOTION_ROWS, 1}, \
        {exh_safety_rows, EXH_SAFETY_ROWS, 1}, {exh_supply_rows, EXH_SUPPLY_ROWS, 1}, \
        {drop_own_rows, DROP_OWN_ROWS, 1}, {exh_calib_set_rows, EXH_CALIB_SET_ROWS, 1}, \
        {exh_tune_rows, EXH_TUNE_ROWS, 1}, \
    { \
        exh_chatter_rows, EXH_CHATTER_ROWS, 1 \
    }
/* The first group is the paper's, in its order, for the CSV. */
#define DROP_SIGNAL_N 2
#define DROP_SIGNAL_GROUPS \
    {drop_paper_rows, DROP_PAPER_ROWS, 1}, { drop_more_rows, DROP_MORE_ROWS, 1 }

/* All parameters, in the order of the scene's signal table. */
struct drop_par {
    struct exh_quad_par quad;
    struct exh_velocity_par velocity;
    struct exh_contact_par contact;
    struct exh_drive_par drive;
    struct exh_tracking_par track;
    struct exh_motion_par watch;
    struct exh_safety_par safety;
    struct exh_supply_par supply;
    struct drop_own_par own;
    struct exh_calib_set_par calib;
    struct exh_tune_par tune;
    struct exh_chatter_par chatter; /* off, since experiments include oscillating falls */
};

/* The paper's signals, then ours, in the order of the table. */
struct drop_signals {
    int32_t q_m_q30;
    int32_t qd_mps_q27;
    int32_t f_des_N_q20;
    int32_t i_des_A_q26;
    int32_t c;
    int32_t f_mon_N_q20;
    int32_t limits;   /* enum exh_limit */
    int32_t state;    /* enum exh_state */
    int32_t faults;   /* enum exh_fault, latched */
    int32_t present;  /* enum exh_fault: why RUN or CLEAR is refused */
    int32_t arm_step; /* enum exh_arm: present step of arming, or last refused */
};

struct drop_cfg {
    const struct drop_par *par;
    struct exh_quad_cfg quad;
    struct exh_velocity_window_cfg velocity;
    struct exh_drive_cfg drive;
    struct exh_tracking_cfg track;
    struct exh_motion_cfg watch;
    struct exh_chatter_cfg chatter;
    struct exh_safety_cfg safety;
    struct exh_supply_cfg supply;
    uint8_t tested; /* 1: the self-test passed */
    struct exh_calib_tables calib;
};

struct drop {
    struct exh_quad quad;
    struct exh_velocity_window velocity;
    struct exh_contact contact;
    struct exh_drive drive;
    struct exh_tracking track;
    struct exh_motion watch;
    struct exh_chatter chatter;
    struct exh_safety safety;
    struct exh_supply supply;
    uint8_t broken; /* 1: the guard found a change in configuration; not saved */
    uint32_t more;  /* enum exh_fault raised by an enclosing scene; not saved */
};

/* Makes the configuration from parameters, and from a calibration of finger 0 in calib (NULL:
 * none). Returns 0 or -EXH_E_.... */
int drop_setup(struct drop_cfg *cfg, const struct drop_par *par, struct exh_scene_board board,
    struct exh_scene_calib *calib);

/* Results of the first half of a tick for the second. Between them a scene may change the force
 * ledger. */
struct drop_now {
    int32_t cnt;
    struct exh_permit permit;
    struct exh_force_ledger f;
    struct exh_current_ledger i;
    uint32_t limits;
};

/* First half: inputs to law. Second half: from there to the outputs. */
void drop_law(struct drop *s, const struct drop_cfg *cfg, const struct exh_scene_in *in,
    struct drop_now *now, struct drop_signals *sig);
void drop_out(struct drop *s, const struct drop_cfg *cfg, struct drop_now *now,
    struct exh_drive_out *out, struct drop_signals *sig);

/* State through a cursor. */
void drop_bytes(struct exh_bytes *c, struct drop *s);

/* One tick. */
void drop_tick(struct drop *s, const struct drop_cfg *cfg, const struct exh_scene_in *in,
    struct exh_drive_out *out, struct drop_signals *sig);

/* Memory of the one instance, for tests that damage it. */
struct drop *drop_memory(struct drop_cfg **cfg);
struct exh_integrity *drop_guard(void);

extern const struct exh_scene exh_scene_drop;

#endif
