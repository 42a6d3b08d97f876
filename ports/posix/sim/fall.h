/* SPDX-License-Identifier: MIT */
/* Fall: the actions of the experimenter, who holds the mass, releases it, watches and lifts it
 * again. While held or lifted, the hand guides mass and string together. */
#ifndef SIM_FALL_H
#define SIM_FALL_H

#include "plant.h"
#include "random.h"

enum fall_phase { FALL_HOLD, FALL_FREE, FALL_LIFT, FALL_DONE };

struct fall {
    enum fall_phase phase;
    int number;       /* the fall being prepared or watched, from 1 */
    int falls;        /* how many are requested */
    double until_s;   /* end of the phase; FREE: known once contact is made */
    int waits;        /* 1: a hold goes on until fall_ready(); may be set at any time */
    double held_s;    /* start of the hold */
    double contact_s; /* first time past the virtual contact, < 0: not yet */
    double T_s;       /* the controller's period */
    double lift_s;    /* start of the lift */
    double from_x_m, from_q_m, to_m;
};

/* T_s: holds one tick and watches two ticks more than necessary, at any rate. So the controller
 * sees every fall completely, and a tick between any two. */
void fall_start(struct fall *f, struct plant *p, const struct sim_device *d, struct sim_random *r,
    int falls, double T_s);

/* The box does not run any more: a hand catches the mass soon, lifts it, and holds it until
 * fall_ready(). */
void fall_catch(struct fall *f, double t_s);

/* The device is in RUN: the holding time starts now. */
void fall_ready(struct fall *f, double t_s);

static inline int fall_waits(const struct fall *f) { return f->waits && f->phase == FALL_HOLD; }

/* When the phase ends, if known; a time far away otherwise. */
static inline double fall_next_s(const struct fall *f)
{
    return f->phase == FALL_DONE || fall_waits(f) ? 1e30 : f->until_s;
}

/* fall_step() has something to do before the phase ends: to look for the contact, or to lift. */
static inline int fall_looks(const struct fall *f)
{
    return f->phase == FALL_FREE && f->contact_s < 0;
}

static inline int fall_busy(const struct fall *f) { return f->phase == FALL_LIFT || fall_looks(f); }

/* Call it when the plant has reached time t: moves the hand, changes the phase when due. Returns 1
 * at the release of the mass. */
int fall_step(
    struct fall *f, struct plant *p, const struct sim_device *d, struct sim_random *r, double t_s);

#endif
