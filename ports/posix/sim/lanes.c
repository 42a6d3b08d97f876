/* SPDX-License-Identifier: MIT */
#include "lanes.h"

#define STEP_LANES
#include "step.h"

#include <stddef.h>

void sim_lanes_set(struct sim_lanes *l, int k, const struct plant *p, const struct sim_device *d)
{
    l->x_m[k] = p->x_m;
    l->v_mps[k] = p->v_mps;
    l->q_m[k] = p->q_m;
    l->w_mps[k] = p->w_mps;
    l->cur_A[k] = p->cur_A;
    l->mass_kg[k] = d->mass_kg;
    l->cable_npm[k] = d->cable_npm;
    l->cable_nspm[k] = d->cable_nspm;
    l->mu_motor[k] = d->mu_motor;
    l->coulomb_n[k] = d->coulomb_n;
    l->viscous_nspm[k] = d->viscous_nspm;
    l->kf_npa[k] = d->kf_npa;
}

void sim_lane_pieces_set(struct sim_lane_pieces *s, int k, const struct plant_piece *piece)
{
    s->n[k] = piece->n;
    s->half_s[k] = piece->half_s;
    s->keep_cur[k] = piece->keep_cur;
    s->mean_cur[k] = piece->mean_cur;
    s->h_mass[k] = piece->h_mass;
    s->h_rotor[k] = piece->h_rotor;
    s->damp_mass[k] = piece->damp_mass;
    s->damp_rotor[k] = piece->damp_rotor;
    s->half_mass[k] = piece->half_mass;
    s->half_rotor[k] = piece->half_rotor;
    s->rub_mass[k] = piece->rub_mass;
    s->rub_half[k] = piece->rub_half;
}

/* On copies that the compiler keeps in registers, and without a branch: for a loop over lanes it
 * takes vector registers, where the processor has some that will do. */
__attribute__((always_inline)) static inline void step_lane(
    struct sim_lanes *l, const struct sim_lane_pieces *s, const double *ref_A, double i, int k)
{
    struct plant p = {l->x_m[k], l->v_mps[k], l->q_m[k], l->w_mps[k], l->cur_A[k], 0};
    struct plant_piece piece = {.half_s = s->half_s[k]};
    struct sim_device d = {.mass_kg = l->mass_kg[k]};
    const int on = i < s->n[k];
    piece.keep_cur = s->keep_cur[k];
    piece.mean_cur = s->mean_cur[k];
    piece.h_mass = s->h_mass[k];
    piece.h_rotor = s->h_rotor[k];
    piece.damp_mass = s->damp_mass[k];
    piece.damp_rotor = s->damp_rotor[k];
    piece.half_mass = s->half_mass[k];
    piece.half_rotor = s->half_rotor[k];
    piece.rub_mass = s->rub_mass[k];
    piece.rub_half = s->rub_half[k];
    d.cable_npm = l->cable_npm[k];
    d.cable_nspm = l->cable_nspm[k];
    d.mu_motor = l->mu_motor[k];
    d.coulomb_n = l->coulomb_n[k];
    d.viscous_nspm = l->viscous_nspm[k];
    d.kf_npa = l->kf_npa[k];
    step_string(&p, &d, &piece, ref_A[k], NULL, 0);
    step_current(&p, &piece, ref_A[k]);
    l->x_m[k] = on ? p.x_m : l->x_m[k];
    l->v_mps[k] = on ? p.v_mps : l->v_mps[k];
    l->q_m[k] = on ? p.q_m : l->q_m[k];
    l->w_mps[k] = on ? p.w_mps : l->w_mps[k];
    l->cur_A[k] = on ? p.cur_A : l->cur_A[k];
}

static void step_lanes(struct sim_lanes *restrict l, const struct sim_lane_pieces *restrict s,
    const double *restrict ref_A, double i)
{
    for (int k = 0; k < SIM_LANES; k++) { step_lane(l, s, ref_A, i, k); }
}

void sim_lanes_advance(
    struct sim_lanes *l, const struct sim_lane_pieces *s, const double *ref_A, int lanes)
{
    double most = 0;
    for (int k = 0; k < lanes; k++) { most = s->n[k] > most ? s->n[k] : most; }
    for (double i = 0; i < most; i++) {
        if (lanes == 1) {
            step_lane(l, s, ref_A, i, 0);
        } else {
            step_lanes(l, s, ref_A, i);
        }
    }
}
