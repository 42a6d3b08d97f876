/* SPDX-License-Identifier: MIT */
#include "identify/model.h"

#include "sim/plant.h"
#include "sim/random.h"

#include "identify/identify.h"

#include <stddef.h>
#include <string.h>

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

/* The models that run side by side. */
struct lanes {
    int n, slack;
    struct sim_lanes plant;
    struct plant_piece whole[2][MODEL_LANES]; /* in a tick, of the older and the newer command, */
    struct sim_lane_pieces piece[2];          /* and the same side by side */
    ptrdiff_t ticks[MODEL_LANES];             /* of delay */
    double per_m[MODEL_LANES], stand_m[MODEL_LANES];
};

static struct plant_piece piece_of(const struct sim_device *d, double dt_s)
{
    struct plant_piece s = plant_piece_of(d, dt_s);
    if (!(s.h_s > 0)) { s.n = 0; }
    return s;
}

static void set_piece(struct lanes *l, int behind, int k, struct plant_piece piece)
{
    l->whole[behind][k] = piece;
    sim_lane_pieces_set(&l->piece[behind], k, &piece);
}

static void add(struct lanes *l, const struct model *m, const struct identify_data *d)
{
    const double late_s = m->value[MODEL_DELAY] - m->value[MODEL_LAG];
    const double some_s = late_s > 0 ? late_s : 0;
    const struct plant still = {0};
    struct sim_device device = model_device(m, d->T_s, d->servo_Hz);
    double most_s, phase_s;
    device.mass_kg = d->mass_kg;
    device.substep_s = SUBSTEP_S;
    device.mon_lag_s = 0; /* unused */
    most_s = plant_step_that_will_do(&device, 0, 0);
    if (most_s > 0 && most_s < SUBSTEP_S) { device.substep_s = most_s; }
    sim_lanes_set(&l->plant, l->n, &still, &device);
    l->per_m[l->n] = 1 / m->value[MODEL_STEP];
    l->ticks[l->n] = (ptrdiff_t)(some_s / d->T_s);
    phase_s = some_s - (double)l->ticks[l->n] * d->T_s;
    set_piece(l, 0, l->n, piece_of(&device, phase_s));
    set_piece(l, 1, l->n, piece_of(&device, d->T_s - phase_s));
    l->n++;
}

/* Where the hand left it. */
static void release(struct lanes *l, const struct identify_sample *x)
{
    struct sim_lanes *p = &l->plant;
    l->slack = x->stage == IDENTIFY_SLACK;
    for (int k = 0; k < l->n; k++) {
        p->q_m[k] = l->stand_m[k] = x->cnt / l->per_m[k];
        p->x_m[k] = l->slack ? p->q_m[k] - FAR_M : p->q_m[k];
        p->v_mps[k] = p->w_mps[k] = p->cur_A[k] = 0;
    }
}

static double coded_A(const struct identify_data *d, ptrdiff_t i)
{
    return i < 0 ? 0 : (double)d->sample[i].coded_A;
}

/* A slack string's end follows; a taut one's mass comes no lower than where the hand left it. */
static void bound(struct sim_lanes *p, int k, int slack, double stand_m)
{
    if (slack) {
        p->x_m[k] = p->q_m[k] - FAR_M;
        p->v_mps[k] = 0;
    } else if (p->x_m[k] > stand_m) {
        p->x_m[k] = stand_m;
        if (p->v_mps[k] > 0) { p->v_mps[k] = 0; }
    }
}

/* Before or behind the place in tick i at which the newer command arrives. */
static void advance(struct lanes *l, const struct identify_data *d, size_t i, int behind)
{
    double ref_A[MODEL_LANES] = {0};
    for (int k = 0; k < l->n; k++) { ref_A[k] = coded_A(d, (ptrdiff_t)i - l->ticks[k] - !behind); }
    sim_lanes_advance(&l->plant, &l->piece[behind], ref_A, l->n);
    for (int k = 0; k < l->n; k++) {
        if (l->whole[behind][k].n > 0) { bound(&l->plant, k, l->slack, l->stand_m[k]); }
    }
}

/* Each lane takes the next command over when another would have. */
static void change_turns(struct lanes *l, struct sim_random *chance)
{
    for (int k = l->n - 1; k > 0; k--) {
        const int other = (int)(sim_random_u64(chance) >> 33) % (k + 1);
        const ptrdiff_t ticks = l->ticks[k];
        l->ticks[k] = l->ticks[other];
        l->ticks[other] = ticks;
        for (int part = 0; part < 2; part++) {
            const struct plant_piece piece = l->whole[part][k];
            set_piece(l, part, k, l->whole[part][other]);
            set_piece(l, part, other, piece);
        }
    }
}

static void run(struct lanes *l, const struct identify_data *d, size_t n, struct sim_random *chance,
    float *const *q_cnt)
{
    int busy = 0;
    for (size_t i = 0; i < n; i++) {
        const struct identify_sample *x = &d->sample[i];
        if (chance && i > 0 && !(x->coded_A == x[-1].coded_A)) { change_turns(l, chance); }
        if (!busy && x->busy) { release(l, x); }
        busy = x->busy;
        for (int k = 0; k < l->n; k++) { q_cnt[k][i] = (float)(l->plant.q_m[k] * l->per_m[k]); }
        if (!busy) { continue; }
        advance(l, d, i, 0);
        advance(l, d, i, 1);
    }
}

void model_run(
    const struct model *m, int models, const struct identify_data *d, size_t n, float *const *q_cnt)
{
    struct lanes l;
    memset(&l, 0, sizeof l);
    while (l.n < models) { add(&l, &m[l.n], d); }
    run(&l, d, n, NULL, q_cnt);
}

void model_chances(const struct model *m, const struct identify_data *d, size_t n,
    struct sim_random *chance, float *const *q_cnt)
{
    struct lanes l;
    memset(&l, 0, sizeof l);
    while (l.n < MODEL_CHANCES) {
        struct model late = *m;
        late.value[MODEL_DELAY] += ((l.n + 0.5) / MODEL_CHANCES - 0.5) / d->servo_Hz;
        add(&l, &late, d);
    }
    run(&l, d, n, chance, q_cnt);
}
