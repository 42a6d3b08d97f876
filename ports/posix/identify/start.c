/* SPDX-License-Identifier: MIT */
/* The start of a fit, directly from currents and times of a run. */
#include "identify/fit.h"

#include "identify/identify.h"

#include "sim/plant.h"

/* Currents at the ends of the slow pulls, and how fast the pulses were. */
struct seen {
    double free_A, up_A, down_A, pulse_A;
    double pulse_mps2; /* with the stated step */
    int pulses;
};

static struct seen look(const struct identify_data *d)
{
    struct seen s = {0, 0, 0, 0, 0, 0};
    size_t began = 0;
    for (size_t i = 1; i < d->n; i++) {
        const struct identify_sample *a = &d->sample[i - 1], *b = &d->sample[i];
        const int ends = a->part != b->part || a->repeat != b->repeat || !b->busy;
        if (!a->busy || !ends) { continue; }
        if (a->part == 0) { s.free_A = (double)a->coded_A; }
        if (a->part == IDENTIFY_PART_UP) { s.up_A = (double)a->coded_A; }
        if (a->part == IDENTIFY_PART_DOWN) { s.down_A = (double)a->coded_A; }
        if (a->part == 2) {
            const double t_s = (double)(i - began) * d->T_s - 1e-3;
            const double far_m = (d->sample[began].cnt - b->cnt) * d->step_m;
            if (t_s > 0) { s.pulse_mps2 += 2 * far_m / (t_s * t_s); }
            s.pulse_A += (double)a->coded_A - s.free_A;
            s.pulses++;
        }
        began = i;
    }
    if (s.pulses) {
        s.pulse_A /= s.pulses;
        s.pulse_mps2 /= s.pulses;
    }
    return s;
}

struct model fit_start(const struct identify_data *d)
{
    const struct seen s = look(d);
    const double hang_A = (s.up_A + s.down_A) / 2, weight_N = d->mass_kg * SIM_GRAVITY;
    const double kf = hang_A > 0.01 ? weight_N / hang_A : 3;
    const double mu = hang_A > 0.01 ? (s.up_A - s.down_A) / 2 / hang_A : 0.2;
    const double kg = s.pulse_mps2 > 0 ? 0.8 * kf * s.pulse_A / s.pulse_mps2 : 0.05;
    const struct model m = {{kg, 0.7 * kf * s.free_A, kg / 0.02, d->T_s + 300e-6, kf, d->step_m,
        3000, 4, 0.6 * mu, 0.3 * mu, 160e-6}};
    return m;
}
