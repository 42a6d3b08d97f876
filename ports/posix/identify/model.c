/* SPDX-License-Identifier: MIT */
#include "identify/model.h"

#include "sim/plant.h"

#include "identify/identify.h"

#include <stddef.h>

#define TWO_PI    6.283185307179586
#define SUBSTEP_S 250e-6
#define FAR_M     1.0 /* a slack string: its end is that far from taut */

const struct model_row model_row[MODEL_PARS] = {
    {"rotor", "kg", 1e-4, 1, 1},
    {"coulomb", "n", 0, 10, 0},
    {"viscous", "ns_per_m", 0, 100, 0},
    {"delay", "s", 0, 0.05, 0},
    {"kf", "n_per_a", 0.5, 50, 1},
    {"step", "m", 1e-6, 480e-6, 1},
    {"cable_k", "n_per_m", 100, 1e6, 1},
    {"cable_b", "ns_per_m", 0, 1000, 0},
    {"mu_motor", "", 0, 2, 1},
    {"mu_mass", "", 0, 2, 1},
    {"lag", "s", 10e-6, 0.01, 1},
};

double model_mu(const struct model *m)
{
    return m->value[MODEL_MU_MOTOR] + m->value[MODEL_MU_MASS];
}

struct model model_of(const struct sim_device *d, double T_s)
{
    const double late_s =
        d->delay_tick * T_s + d->delay_s + 0.5 / d->servo_hz + 1 / (TWO_PI * d->current_hz);
    const struct model m = {
        {d->rotor_kg, d->coulomb_n, d->viscous_nspm, late_s, d->kf_npa, d->step_m / d->decode,
            d->cable_npm, d->cable_nspm, d->mu_motor, d->mu_mass, 1 / (TWO_PI * d->current_hz)}};
    return m;
}

struct sim_device model_device(const struct model *m, double T_s, double servo_Hz)
{
    struct sim_device d = sim_device_default();
    const double rest_s = m->value[MODEL_DELAY] - 0.5 / servo_Hz - m->value[MODEL_LAG];
    (void)T_s;
    d.rotor_kg = m->value[MODEL_ROTOR];
    d.coulomb_n = m->value[MODEL_COULOMB];
    d.viscous_nspm = m->value[MODEL_VISCOUS];
    d.kf_npa = m->value[MODEL_KF];
    d.step_m = m->value[MODEL_STEP];
    d.decode = 1;
    d.cable_npm = m->value[MODEL_CABLE_K];
    d.cable_nspm = m->value[MODEL_CABLE_B];
    d.mu_motor = m->value[MODEL_MU_MOTOR];
    d.mu_mass = m->value[MODEL_MU_MASS];
    d.current_hz = 1 / (TWO_PI * m->value[MODEL_LAG]);
    d.servo_hz = servo_Hz;
    d.delay_tick = 0;
    d.delay_s = rest_s > 0 ? rest_s : 0;
    return d;
}

struct sim {
    struct sim_device device;
    struct plant plant;
    double stand_m;
    int slack;
};

static void advance(struct sim *s, const struct plant_piece *piece, double ref_A)
{
    struct plant *p = &s->plant;
    if (!(piece->h_s > 0)) { return; }
    plant_advance_piece(p, &s->device, piece, ref_A);
    if (s->slack) {
        p->x_m = p->q_m - FAR_M;
        p->v_mps = 0;
    } else if (p->x_m > s->stand_m) {
        p->x_m = s->stand_m;
        if (p->v_mps > 0) { p->v_mps = 0; }
    }
}

static double coded_A(const struct identify_data *d, ptrdiff_t i)
{
    return i < 0 ? 0 : (double)d->sample[i].coded_A;
}

void model_run(const struct model *m, const struct identify_data *d, size_t n, float *q_cnt)
{
    const struct plant rest = {0};
    const double per_m = 1 / m->value[MODEL_STEP], T_s = d->T_s;
    const double late_s = m->value[MODEL_DELAY] - m->value[MODEL_LAG];
    const double some_s = late_s > 0 ? late_s : 0;
    const ptrdiff_t ticks = (ptrdiff_t)(some_s / T_s);
    const double phase_s = some_s - (double)ticks * T_s;
    struct sim s = {.device = model_device(m, T_s, d->servo_Hz)};
    struct plant_piece before, behind; /* in a tick, of the older and of the newer command */
    int busy = 0;
    double most_s = 0;
    s.device.mass_kg = d->mass_kg;
    s.device.substep_s = SUBSTEP_S;
    s.device.mon_lag_s = 0; /* nobody looks at it */
    most_s = plant_step_that_will_do(&s.device, 0, 0);
    if (most_s > 0 && most_s < SUBSTEP_S) { s.device.substep_s = most_s; }
    before = plant_piece_of(&s.device, phase_s);
    behind = plant_piece_of(&s.device, T_s - phase_s);
    for (size_t i = 0; i < n; i++) {
        const struct identify_sample *x = &d->sample[i];
        if (!busy && x->busy) { /* where the hand left it */
            s.plant = rest;
            s.plant.q_m = x->cnt / per_m;
            s.slack = x->stage == IDENTIFY_SLACK;
            s.stand_m = s.plant.q_m;
            s.plant.x_m = s.slack ? s.plant.q_m - FAR_M : s.plant.q_m;
        }
        busy = x->busy;
        q_cnt[i] = (float)(s.plant.q_m * per_m);
        if (!busy) { continue; }
        advance(&s, &before, coded_A(d, (ptrdiff_t)i - ticks - 1));
        advance(&s, &behind, coded_A(d, (ptrdiff_t)i - ticks));
    }
}
