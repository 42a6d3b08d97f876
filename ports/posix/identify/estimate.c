/* SPDX-License-Identifier: MIT */
#include "identify/estimate.h"

#include "identify/identify.h"
#include "identify/result.h"

#include "base/progress.h"

#include "sim/random.h"

#include <math.h>
#include <string.h>

/* Starts that are tried, the best of them first. */
#define STARTS_MAX 128
#define TRIED      6
#define ROUNDS     3   /* of more starts, while the model does not fit: */
#define BESIDE     41  /* stiffnesses beside the one that was found, from -40 to 65 %, */
#define BEST       3   /* of which so many are tried, */
#define SHAKEN     4   /* and so many a little way off */
#define GOOD       0.1 /* a start that came so far is the one */
#define AGAIN      4   /* from what was found, at most */
#define LAG_S      200e-6
#define DENIED     1.25 /* a cost so much larger with the monitor's delay: the motion has another */
#define SHARP_S    6e-6 /* the monitor tells the delay better than the motion, */
#define SURE_S     50e-6 /* and closer lags the motion does not tell from each other */
#define WEIGHED    3     /* times what counts is told by the last fit */
#define CALM       0.5   /* a cost as of a device that never slackens */
#define HOPELESS   20    /* a cost from which plain steps lead nowhere */

struct starts {
    struct model m[STARTS_MAX];
    double cost[STARTS_MAX];
    int n;
};

static void add(struct starts *s, const struct model *m, double cost)
{
    int i = s->n < STARTS_MAX ? s->n++ : s->n - 1;
    for (; i > 0 && s->cost[i - 1] > cost; i--) {
        s->m[i] = s->m[i - 1];
        s->cost[i] = s->cost[i - 1];
    }
    s->m[i] = *m;
    s->cost[i] = cost;
}

/* The free rotor alone, which a few pulses tell. */
static int rotor(struct fit *f, const struct identify_data *d)
{
    static const struct fit_how rough = {FIT_ROTOR, 2e-4, 15, 0, 1e-3, 0},
                                fine = {FIT_ROTOR, 0, 10, 0, 1e-3, 0};
    static const double heavier[] = {0.6, 1, 1.6}, stop_s[] = {0.01, 0.05, 0.3},
                        late_s[] = {0.5e-3, 1e-3};
    const struct model first = fit_start(d);
    struct observations o;
    struct starts s;
    int err = observe(&o, d, 1u << IDENTIFY_SLACK, 0, 10);
    s.n = 0;
    for (int i = 0; i < 18 && err == 0; i++) {
        struct model m = first;
        m.value[MODEL_ROTOR] *= heavier[i % 3];
        m.value[MODEL_VISCOUS] = m.value[MODEL_ROTOR] / stop_s[i / 3 % 3];
        m.value[MODEL_DELAY] = late_s[i / 9] + d->T_s / 2;
        add(&s, &m, fit_cost(&m, d, &o, 7e-4));
    }
    f->cost = (double)INFINITY;
    for (int i = 0; i < 3 && err == 0; i++) {
        struct fit one = *f;
        one.at = s.m[i];
        err = fit_run(&one, d, &o, rough);
        if (err == 0) { err = fit_run(&one, d, &o, fine); }
        if (one.cost < f->cost) { *f = one; }
    }
    observe_free(&o);
    return err;
}

/* Where the string's stiffness, its damping and the place of the friction may be. */
static void lattice(struct starts *s, const struct fit *f, const struct identify_data *d,
    const struct observations *o)
{
    static const double cable_npm[] = {1000, 1800, 3200, 6000, 11000, 20000, 40000},
                        cable_nspm[] = {1.5, 5, 20}, share[] = {0.1, 0.3, 0.5, 0.7, 0.9};
    s->n = 0;
    for (int i = 0; i < 105; i++) {
        struct model m = f->at;
        m.value[MODEL_CABLE_K] = cable_npm[i % 7];
        m.value[MODEL_CABLE_B] = cable_nspm[i / 35];
        fit_split(&m, d, share[i / 7 % 5]);
        add(s, &m, fit_cost(&m, d, o, 2e-3));
    }
}

/* One more of the descents, of which nobody knows how many there are. */
static void show(int over)
{
    static int done;
    done += !over;
    progress_show("descents", done, 0, over);
}

/* From the best TRIED starts over two rounds of the mass, then of all. */
static int from_starts(struct fit *best, const struct fit *rotor_told, const struct starts *s,
    const struct identify_data *d, const struct observations *few)
{
    static const struct fit_how rough = {FIT_MASS & ~(1u << MODEL_STEP), 2e-3, 12, 0, 1e-2, 1},
                                finer = {FIT_MASS, 2e-4, 12, 0, 1e-2, 1},
                                all = {FIT_ALL, 7e-5, 30, 0, 3e-3, 1};
    int err = 0;
    best->cost = (double)INFINITY;
    for (int i = 0; i < TRIED && err == 0 && best->cost > GOOD; i++) {
        struct fit one = *rotor_told;
        one.at = s->m[i];
        err = fit_run(&one, d, few, rough);
        if (err == 0) { err = fit_run(&one, d, few, finer); }
        if (one.cost < best->cost) { *best = one; }
        show(0);
    }
    return err ? err : fit_run(best, d, few, all);
}

/* Down to where no step lowers the cost; from there the plain steps, which a rough cost does not
 * hold, and down again, as long as that is worth it. At last the mean of plain steps. */
int estimate_finish(struct fit *f, const struct identify_data *d, const struct observations *o)
{
    static const struct fit_how near = {FIT_ALL & ~(1u << MODEL_LAG), 5e-5, 20, 0, 3e-2, 1},
                                down = {FIT_ALL, 0, 40, 0, 1e-4, 0},
                                plain = {FIT_ALL, 0, 4, 1, 0, 0}, mean = {FIT_ALL, 0, 24, 2, 0, 0};
    struct fit next;
    int err = fit_run(f, d, o, near);
    if (err == 0) { err = fit_run(f, d, o, down); }
    if (err || f->cost > HOPELESS) { return err; }
    for (int i = 0; i < 3 && err == 0; i++) {
        next = *f;
        err = fit_run(&next, d, o, plain);
        if (err == 0) { err = fit_run(&next, d, o, down); }
        if (!(next.cost < 0.98 * f->cost)) { break; }
        *f = next;
    }
    if (err == 0 && next.cost < f->cost) { *f = next; }
    next = *f;
    if (err == 0) { err = fit_run(&next, d, o, mean); }
    if (err == 0 && next.cost < 1.1 * f->cost) { *f = next; }
    return err;
}

/* Lags close to each other, or one that may be wait, leave the delay to the motion. */
static void hold(struct fit *f, const struct lag *lag)
{
    f->at.value[MODEL_LAG] = lag->drive_s;
    f->held = 1u << MODEL_LAG;
    if (fabs(lag->drive_s - lag->monitor_s) > SURE_S && lag->monitor_error_s < SHARP_S) {
        f->held |= 1u << MODEL_DELAY;
        f->at.value[MODEL_DELAY] = lag->run_s + lag->drive_s;
    }
}

int estimate_lag(struct fit *f, struct lag *lag, const struct identify_data *d)
{
    const int err = lag_tell(lag, d, f->at.value[MODEL_DELAY]);
    if (err == 0) { hold(f, lag); }
    return err;
}

void estimate_lag_end(struct fit *f, struct lag *lag, const struct identify_data *d)
{
    if (!(f->held >> MODEL_DELAY & 1)) { lag_order(lag, f->at.value[MODEL_DELAY]); }
    f->at.value[MODEL_LAG] = lag->drive_s;
    f->at.value[MODEL_DELAY] += lag->wait_s + 0.5 / d->servo_Hz - lag->run_s;
}

/* With what the monitor tells, either lag the drive's, unless the motion denies both. */
static int with_monitor(
    struct estimate_of *e, const struct identify_data *d, const struct observations *o)
{
    struct fit best = e->fit;
    struct lag lag;
    int err = lag_tell(&lag, d, e->fit.at.value[MODEL_DELAY]), held = 1;
    best.cost *= DENIED;
    for (int i = 0; i < 2 && err == 0 && held; i++) {
        struct fit f = e->fit;
        hold(&f, &lag);
        held = f.held >> MODEL_DELAY & 1;
        err = estimate_finish(&f, d, o);
        show(0);
        if (err == 0 && f.cost < best.cost) {
            best = f;
            e->lag = lag;
            e->lag_told = 1;
        }
        lag_swap(&lag);
    }
    if (e->lag_told) { e->fit = best; }
    return err < 0 ? err : 0;
}

/* The lag is what the motion tells least. One that is wrong keeps all others in a ditch of the
 * cost. */
void estimate_lag_anew(struct fit *f)
{
    const double least_s = LAG_S + 0.5 / MODEL_SERVO_HZ;
    double *v = f->at.value;
    if (f->held >> MODEL_LAG & 1) { return; }
    v[MODEL_LAG] = LAG_S;
    if (v[MODEL_DELAY] < least_s) { v[MODEL_DELAY] = least_s; }
}

/* Out of a ditch: again with the lag of a start, as long as that is worth it; at last from a little
 * way off. */
static int again(struct fit *best, const struct identify_data *d, const struct observations *o,
    struct sim_random *chance)
{
    int err = 0;
    for (int i = 0, last = 0; i < AGAIN && err == 0 && !last; i++) {
        struct fit f = *best;
        last = i == AGAIN - 1;
        if (last) { fit_shake(&f, chance); }
        estimate_lag_anew(&f);
        err = estimate_finish(&f, d, o);
        show(0);
        if (i < AGAIN - 2 && !(f.cost < 0.98 * best->cost)) { i = AGAIN - 2; }
        if (err == 0 && f.cost < best->cost) { *best = f; }
    }
    return err;
}

/* An oscillation of one cycle more or less fits, too, and nothing leads from one to the other: what
 * stiffness and damping may be beside those that were found. */
static void near(struct starts *s, const struct fit *f, const struct identify_data *d,
    const struct observations *o)
{
    static const double damped[] = {1, 0.3, 0.1};
    s->n = 0;
    for (int i = 0; i < 3 * BESIDE; i++) {
        struct model m = f->at;
        m.value[MODEL_CABLE_K] *= exp(0.025 * (i % BESIDE - BESIDE / 2));
        m.value[MODEL_CABLE_B] *= damped[i / BESIDE];
        if (i != BESIDE / 2) { add(s, &m, fit_cost(&m, d, o, 0)); }
    }
}

/* From one start more, if it leads lower. */
static int from(struct fit *best, const struct model *m, const struct identify_data *d,
    const struct observations *o)
{
    struct fit f = *best;
    int err;
    f.at = *m;
    err = estimate_finish(&f, d, o);
    show(0);
    if (err == 0 && f.cost < best->cost) { *best = f; }
    return err;
}

/* Down from starts, then from beside what was found and from a little way off, until the model fits
 * what a string does that never slackens. */
static int begin(struct fit *best, const struct fit *told, const struct identify_data *d,
    const struct observations *calm, struct sim_random *chance)
{
    struct observations few;
    struct starts s;
    int err = observe_calm(&few, d, 1u << IDENTIFY_MASS, 2, 0.06);
    if (err == 0) { lattice(&s, told, d, &few); }
    if (err == 0) { err = from_starts(best, told, &s, d, &few); }
    if (err == 0) { err = estimate_finish(best, d, calm); }
    for (int r = 0; r < ROUNDS && err == 0 && best->cost > CALM; r++) {
        near(&s, best, d, calm);
        for (int i = 0; i < BEST && err == 0; i++) { err = from(best, &s.m[i], d, calm); }
        for (int i = 0; i < SHAKEN && err == 0 && best->cost > CALM; i++) {
            struct fit f = *best;
            fit_shake(&f, chance);
            f.at.value[MODEL_LAG] = told->at.value[MODEL_LAG];
            err = from(best, &f.at, d, calm);
        }
    }
    observe_free(&few);
    return err;
}

int identify_estimate(struct estimate_of *e, const struct identify_data *d)
{
    struct observations all, calm;
    struct fit told;
    struct sim_random chance = {1};
    int err;
    memset(e, 0, sizeof *e);
    memset(&told, 0, sizeof told);
    memset(&all, 0, sizeof all);
    memset(&calm, 0, sizeof calm);
    err = rotor(&told, d);
    if (err == 0) { err = observe_calm(&calm, d, 3, 0, 0.05); }
    if (err == 0) { err = observe(&all, d, 3, 0, 0.05); }
    e->rounds = all.rounds;
    e->counts = all.n;
    if (err == 0) { err = begin(&e->fit, &told, d, &calm, &chance); }
    for (int i = 0; i < WEIGHED && err == 0; i++) {
        err = fit_weigh(&e->fit.at, d, &all);
        if (err == 0) { err = estimate_finish(&e->fit, d, &all); }
        show(0);
    }
    e->counted = all.counted;
    if (err == 0) { err = with_monitor(e, d, &all); }
    if (err == 0) { err = again(&e->fit, d, &all, &chance); }
    if (err == 0 && e->lag_told) { estimate_lag_end(&e->fit, &e->lag, d); }
    show(1);
    observe_free(&calm);
    observe_free(&all);
    return err;
}
