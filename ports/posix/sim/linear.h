/* SPDX-License-Identifier: MIT */
/* Linear: is the sampled wall stable in sustained contact, exactly, by eigenvalues.
 *
 * The string is taut, dry friction, saturation and steps are off: between two ticks
 * the plant is linear and the command held, so one tick is one matrix M on
 *
 *   z = [plant | u[k-1] .. u[k-d-1] | q[k-1] .. q[k-n]]
 *   u[k] = k q[k] + b (q[k] - q[k-n]) / (n T), in force from (k + d + h) T on,
 *
 * and the wall is stable exactly if all eigenvalues of M lie inside the unit circle:
 * rho(M) < 1. + - x / and square roots only: the same digits on every machine.
 */
#ifndef SIM_LINEAR_H
#define SIM_LINEAR_H

#include "device.h"
#include "eigen.h"

#define LINEAR_PLANT 5 /* states of the largest plant */

/* z' = a z + b u; the encoder reads state 0, and u is the force that pulls the string. */
struct linear_plant {
    int n;
    double a[LINEAR_PLANT][LINEAR_PLANT], b[LINEAR_PLANT];
};

/* A mass with viscous friction behind a current loop of time constant tau_s (0: none). */
struct linear_plant linear_one_mass(double mass_kg, double viscous_nspm, double tau_s);

/* The simulated device: mass, taut string, rotor, current loop. */
struct linear_plant linear_two_mass(const struct sim_device *d);

struct linear_wall {
    double T_s, k_Npm, b_Nspm;
    double delay_s; /* from the tick to the force's request at the current loop */
    int window;     /* n of the velocity, ticks */
};

/* e^(a t) and the integral of e^(a s) b over 0..t, from one exponential. */
struct linear_flow {
    double phi[LINEAR_PLANT][LINEAR_PLANT], gamma[LINEAR_PLANT];
};
struct linear_flow linear_flow(const struct linear_plant *p, double t_s);

/* 0, or -1: the delay and the window need more than EIGEN_MAX states. */
int linear_monodromy(struct matrix *M, const struct linear_plant *p, const struct linear_wall *w);

/* rho of the simulated device. The servo samples the output at its own rate and at a
 * phase of chance: its mean, half a sample, counts as delay. < 0: too long a delay. */
double linear_rho(const struct sim_device *d, double T_s, double k_Npm, double b_Nspm, int window);

#endif
