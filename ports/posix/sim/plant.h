/* SPDX-License-Identifier: MIT */
/* Plant: a mass on an elastic string that only pulls, wound on the rotor of a motor.
 *
 *   T    = max(0, kc (x - q) + bc (x' - q')), 0 when x < q
 *   m x''  = m g - T - dry(mu_mass T)
 *   mr q'' = T - kf i - bv q' - dry(fc + mu_motor T)
 *   i'   = 2 pi fbw (iref - i)            monitor' = (i - monitor) / lag
 *
 * dry() is Coulomb friction with stiction. Integration by leapfrog: half a step by the old speeds,
 * the forces there, half a step by the new speeds. Friction is an impulse that can only reduce a
 * velocity towards zero, so it cannot chatter. Damped forces use the mean speed; the two
 * first-order lags are exact. The order is 2 where no event occurs. + - x / only: the same digits
 * on every machine. */
#ifndef SIM_PLANT_H
#define SIM_PLANT_H

#include "device.h"
#include "grid.h"

#define SIM_GRAVITY 9.81

struct plant {
    double x_m, v_mps; /* mass, down positive, 0 = virtual contact */
    double q_m, w_mps; /* string at the motor */
    double cur_A;      /* motor current */
    double mon_A;      /* behind the monitor's lag */
};

/* Advances by dt_s >= 0 with the current loop's reference held. held: the mass and
 * the string are in the experimenter's hand and do not move. */
void plant_advance(
    struct plant *p, const struct sim_device *d, double dt_s, double ref_A, int held);

/* The same for callers with many steps of equal length: the parts that depend on length and device
 * only are computed once. */
struct plant_piece {
    int n; /* sub-steps of h_s */
    double h_s, half_s;
    double keep_cur, keep_mon, cur_to_mon, mean_cur; /* shares of what was off the reference */
    double h_mass, h_rotor;                          /* of a force, the change of speed */
    double half_mass, half_rotor;                    /* the same of half a step */
    double rub_mass, rub_half;                       /* of a tension, by friction at the mass */
    double damp_mass, damp_rotor; /* what linear friction leaves in half a step, implicit */
};
struct plant_piece plant_piece_of(const struct sim_device *d, double dt_s);
void plant_advance_piece(
    struct plant *p, const struct sim_device *d, const struct plant_piece *s, double ref_A);

/* The currents alone: mass and string are held. */
void plant_hold_piece(struct plant *p, const struct plant_piece *s, double ref_A);

/* Those that were last in use; all 0: none yet. Of one device, and one hand (0: none). */
#define PLANT_PIECES 256
struct plant_pieces {
    double dt_s[PLANT_PIECES];
    struct plant_piece piece[PLANT_PIECES];
};
/* Works out the one at this place. */
const struct plant_piece *plant_pieces_put(
    struct plant_pieces *c, unsigned at, const struct sim_device *d, double dt_s, double hand_nspm);
/* dt_s > 0, of sim_grid_s(). */
static inline const struct plant_piece *plant_pieces_find(
    struct plant_pieces *c, const struct sim_device *d, double dt_s, double hand_nspm)
{
    const unsigned at = sim_grid_slot(dt_s, PLANT_PIECES);
    return c->dt_s[at] == dt_s ? &c->piece[at] : plant_pieces_put(c, at, d, dt_s, hand_nspm);
}

/* A hand moves the mass, which is then a finger: instead of its weight the force
 *   k (target - x) + b (target' - x').
 * The target is at x_m when the piece begins and moves at v_mps. Neither
 * finger nor string goes beyond end_m, the straight finger: they stop there. */
struct plant_hand {
    double k_Npm, b_Nspm;
    double x_m, v_mps;
    double end_m;
};
void plant_advance_hand(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
    const struct plant_hand *hand);
void plant_advance_hand_piece(struct plant *p, const struct sim_device *d,
    const struct plant_piece *s, double ref_A, const struct plant_hand *hand);

/* Whether sub-steps of substep_s are short enough: at most half of the stability limit. That is at
 * least six per period of string and rotor, which then is 5 % too short. It is also at least one in
 * the time in which the damping of string, motor or hand reduces a speed to 1/e. hand_npm,
 * hand_nspm: stiffness and damping of a hand at the mass, 0 without. */
int plant_step_will_do(const struct sim_device *d, double hand_npm, double hand_nspm);

/* A round number that will, at most the device's longest; 0: none that it may have. */
double plant_step_that_will_do(const struct sim_device *d, double hand_npm, double hand_nspm);

/* The table's own step becomes one that will do. 0; -1: the step is another, or none will do. */
int plant_take_step(struct sim_device *d, double hand_npm, double hand_nspm);

/* exp(-x) for x >= 0, from + - x /; relative error < 1e-12. */
double sim_exp_neg(double x);

#endif
