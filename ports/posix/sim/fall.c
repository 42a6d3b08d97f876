/* SPDX-License-Identifier: MIT */
#include "fall.h"

#define LIFT_S    0.5
#define HOLD_S    0.1
#define GIVE_UP_S 3.0  /* a mass that has not reached the contact by then */
#define CATCH_S   0.2  /* reaction time of a person who sees a light go out */
#define MARGIN_S  0.15 /* or two ticks: by so much may the log's contact be later */

static double start_height(const struct sim_device *d, struct sim_random *r)
{
    return -d->height_m + d->height_jitter_m * (2 * sim_random_unit(r) - 1);
}

static double longer(double a, double b) { return a > b ? a : b; }

/* The instant of release is not tied to the tick: up to 50 ms of chance, or half a tick. */
static void hold(struct fall *f, struct sim_random *r, double t_s)
{
    f->phase = FALL_HOLD;
    f->held_s = t_s;
    f->until_s = t_s + longer(HOLD_S, f->T_s) * (1 + 0.5 * sim_random_unit(r));
}

void fall_start(struct fall *f, struct plant *p, const struct sim_device *d, struct sim_random *r,
    int falls, double T_s)
{
    const struct plant rest = {0};
    *p = rest;
    p->x_m = p->q_m = start_height(d, r);
    f->number = 1;
    f->falls = falls;
    f->T_s = T_s;
    f->waits = 0;
    hold(f, r, 0);
}

/* Nothing else ends a fall in which there is no force: it would be metres deep, and the lift out of
 * it faster than an encoder can be. */
void fall_catch(struct fall *f, double t_s)
{
    f->waits = 1;
    if (f->phase == FALL_FREE && t_s + CATCH_S < f->until_s) { f->until_s = t_s + CATCH_S; }
}

void fall_ready(struct fall *f, double t_s)
{
    if (fall_waits(f)) { f->until_s += t_s - f->held_s; }
    f->waits = 0;
}

static void lift(const struct fall *f, struct plant *p, double t_s)
{
    const double u = t_s < f->until_s ? (t_s - f->lift_s) / (f->until_s - f->lift_s) : 1;
    const double s = u * u * (3 - 2 * u); /* starts and ends at rest */
    p->x_m = f->from_x_m + s * (f->to_m - f->from_x_m);
    p->q_m = f->from_q_m + s * (f->to_m - f->from_q_m);
    p->v_mps = p->w_mps = 0;
}

static void end_of_phase(
    struct fall *f, struct plant *p, const struct sim_device *d, struct sim_random *r, double t_s)
{
    if (f->phase == FALL_HOLD) {
        f->phase = FALL_FREE;
        f->contact_s = -1;
        f->until_s = t_s + GIVE_UP_S;
    } else if (f->phase == FALL_LIFT) {
        hold(f, r, t_s);
    } else if (f->number == f->falls) {
        f->phase = FALL_DONE;
    } else {
        f->phase = FALL_LIFT;
        f->number++;
        f->lift_s = t_s;
        f->until_s = t_s + LIFT_S;
        f->from_x_m = p->x_m;
        f->from_q_m = p->q_m;
        f->to_m = start_height(d, r);
    }
}

int fall_step(
    struct fall *f, struct plant *p, const struct sim_device *d, struct sim_random *r, double t_s)
{
    const enum fall_phase before = f->phase;
    if (f->phase == FALL_FREE && f->contact_s < 0 && p->q_m >= 0 && !f->waits) {
        f->contact_s = t_s;
        f->until_s = t_s + d->observe_s + longer(MARGIN_S, 2 * f->T_s);
    }
    if (f->phase == FALL_LIFT) { lift(f, p, t_s); }
    if (t_s >= f->until_s && !fall_waits(f) && f->phase != FALL_DONE) {
        end_of_phase(f, p, d, r, t_s);
    }
    return before == FALL_HOLD && f->phase == FALL_FREE;
}
