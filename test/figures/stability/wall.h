/* SPDX-License-Identifier: MIT */
/* Wall: one mass in sustained contact with the library's law, tick by tick.
 *
 * The plant is exact: between two ticks the force is constant, so speed and way are closed forms,
 * with a stop where dry friction stops. It shares nothing with ports/posix/sim/linear.c, which says
 * what must come of it. The law is the library's as it is shipped; what a device adds is switched
 * on one by one. */
#ifndef STABILITY_WALL_H
#define STABILITY_WALL_H

#include "exhand/exhand.h"

#include <stdint.h>

#define WALL_DELAY_MAX 3

struct wall {
    /* set by the caller */
    struct exh_period T;
    double k_Npm, b_Nspm, mass_kg;
    int delay;                      /* whole ticks until a command acts */
    double viscous_Nspm, coulomb_N; /* 0: no friction */
    double step_m;                  /* encoder; 0: the position itself, to 0.93 nm */
    double phase;                   /* of the encoder, counts */
    double f_max_N;                 /* 0: none; else the string only pulls, and so far */
    double load_N;                  /* pulls into the wall */
    double x_m, v_mps;              /* where it begins, from rest in the wall */
    /* its state */
    struct exh_contact_par par;
    struct exh_contact contact;
    struct exh_quad_par quad;
    struct exh_velocity_window_cfg velocity_cfg;
    struct exh_velocity_window velocity;
    struct exh_drive_par drive_par;
    struct exh_drive_cfg drive_cfg;
    struct exh_drive drive;
    struct exh_knot knot[2];
    double T_s, bias_N, queue_N[WALL_DELAY_MAX + 1];
    int32_t lim_m_q30, pos_m_q30;
    int at;
};

/* 0, or -EXH_E_... of a module that refuses. */
int wall_start(struct wall *w);

/* A tick, and the plant to the next. x_m and v_mps move. */
void wall_tick(struct wall *w);

#endif
