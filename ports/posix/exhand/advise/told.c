/* SPDX-License-Identifier: MIT */
/* The result of exhand identify as input of the advisor: its values, the worst corners of its
 * intervals, and points between. */
#include "advise/gains.h"

#include "base/assign.h"

#define TOLD    12
#define INWARDS 0.015
#define ROOT \
    0.93303299153680741 /* 2^(-1/10): as many steps, none of them a multiple of another \
                         */

/* Moves both frictions towards their values until their sum is inside its own interval: a corner
 * of the two alone is a device that the run ruled out. */
static void keep_sum(struct model *m, const struct result_file *f)
{
    const double value = model_mu(&f->value), sum = model_mu(m);
    const double most = sum < f->mu_low ? f->mu_low : f->mu_high;
    if (!(sum < f->mu_low || sum > f->mu_high)) { return; }
    for (int i = MODEL_MU_MOTOR; i <= MODEL_MU_MASS; i++) {
        const double v = f->value.value[i];
        m->value[i] = v + (m->value[i] - v) * (most - value) / (sum - value);
    }
}

/* In turn the shortest, the longest and the middle, which may be none, all and half of the delay.
 */
static double lag(const struct result_file *f, int turn)
{
    static const double share[] = {0, 1, 0.5};
    const double low = f->low.value[MODEL_LAG], high = f->high.value[MODEL_LAG];
    return low + share[turn % 3] * (high - low);
}

/* Of its intervals, what is worse for rest: less inertia and friction, later, coarser. */
static struct model corner(const struct result_file *f, int stiff)
{
    struct model m = f->low;
    m.value[MODEL_DELAY] = f->high.value[MODEL_DELAY];
    m.value[MODEL_STEP] = f->high.value[MODEL_STEP];
    m.value[MODEL_KF] = f->value.value[MODEL_KF];
    if (stiff) { m.value[MODEL_CABLE_K] = f->high.value[MODEL_CABLE_K]; }
    keep_sum(&m, f);
    return m;
}

/* The n-th of a sequence that fills the box of its intervals evenly. */
static struct model within(const struct result_file *f, int n)
{
    struct model m = f->value;
    double step = 1;
    for (int i = 0; i < MODEL_PARS; i++) {
        double share;
        step *= ROOT;
        share = 0.5 + n * step;
        share -= (double)(int)share;
        m.value[i] = f->low.value[i] + share * (f->high.value[i] - f->low.value[i]);
    }
    keep_sum(&m, f);
    return m;
}

static int is_corner(int n) { return n % 4 == 1; }

/* Of four: the given device, a corner, two points inside. Likely devices are tested as often as the
 * worst. A limit cycle of one count appears without an order that a corner would show. */
static struct model told(const struct result_file *f, int n)
{
    struct model m = is_corner(n) ? corner(f, n / 4 % 2) : n % 4 == 0 ? f->value : within(f, n);
    if (n % 4 < 2) { m.value[MODEL_LAG] = lag(f, n / 4); }
    return m;
}

/* What of the delay goes with the tick is not known at another rate than the file's: none or all,
 * and at a corner what is later. */
int gains_told(struct region_opt *o, const struct result_file *f, double rate_Hz)
{
    const double more = f->rate_Hz / rate_Hz;
    const int far = more > 1.01 || more < 0.99;
    o->devices = 0;
    o->inwards = INWARDS;
    for (int i = 0; i < TOLD; i++) {
        const struct model m = told(f, i);
        struct sim_device d = model_device(&m, 1 / rate_Hz, sim_device_default().servo_hz);
        d.mon_lag_s = f->monitor_lag_s;
        if (assign_step(&d, 0, 0)) { return 2; }
        if (far && (is_corner(i) ? more > 1 : (i / 4 + i) % 2)) { d.delay_s *= more; }
        o->device[o->devices++] = d;
    }
    return 0;
}
