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
#define DRAWN      2000
#define ROUGH      40 /* of them go down roughly, */
#define TRIED      6  /* and of these so many all the way */
#define ROUNDS     3  /* of more starts, while the model does not fit: */
#define BESIDE     41 /* stiffnesses beside the one that was found, from -40 to 65 %, */
#define BEST       3  /* of which so many are tried, */
#define SHAKEN     4  /* and so many a little way off */
#define AGAIN      4  /* from what was found, at most */
#define LAG_S      200e-6
#define FAR_M      2e-3 /* where a start may be by so much beside the string */
#define DENIED     1.25 /* a cost so much larger with the monitor's delay: the motion has another */
#define SHARP_S    6e-6 /* the monitor gives the delay more exactly than the motion, */
#define SURE_S     50e-6 /* and the motion does not separate closer lags */
#define WEIGHED    3     /* weights are updated from the last fit this often */
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

static void add_all(struct starts *s, const struct model *m, int models,
    const struct identify_data *d, const struct observations *o, double floor_m)
{
    double cost[STARTS_MAX];
    fit_costs(m, models, d, o, floor_m, cost);
    for (int i = 0; i < models; i++) { add(s, &m[i], cost[i]); }
}

/* The free rotor alone, from a few pulses. */
static int rotor(struct fit *f, const struct identify_data *d)
{
    static const struct fit_how rough = {FIT_ROTOR, 2e-4, 15, 0, 1e-3, 0},
                                fine = {FIT_ROTOR, 0, 10, 0, 1e-3, 0};
    static const double heavier[] = {0.6, 1, 1.6}, stop_s[] = {0.01, 0.05, 0.3},
                        late_s[] = {0.5e-3, 1e-3};
    const struct model first = fit_start(d);
    struct observations o;
    struct model m[18];
    struct starts s;
    int err = observe(&o, d, 1u << IDENTIFY_SLACK, 0, 10);
    for (int i = 0; i < 18; i++) {
        m[i] = first;
        m[i].value[MODEL_ROTOR] *= heavier[i % 3];
        m[i].value[MODEL_VISCOUS] = m[i].value[MODEL_ROTOR] / stop_s[i / 3 % 3];
        m[i].value[MODEL_DELAY] = late_s[i / 9] + d->T_s / 2;
    }
    s.n = 0;
    if (err == 0) { add_all(&s, m, 18, d, &o, 7e-4); }
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

/* Between low and high, as often at half as at twice the middle. */
static double anywhere(struct sim_random *chance, double low, double high)
{
    return low * exp(sim_random_unit(chance) * log(high / low));
}

/* Parameters that the free rotor does not determine: force constant, string, friction in proportion
 * and the motor's share of it. Those it determines are relative to the force constant. */
static struct model draw(const struct model *told, struct sim_random *chance)
{
    struct model m = *told;
    double *v = m.value;
    const double share = sim_random_unit(chance), mu = anywhere(chance, 0.03, 0.9);
    const double kf = anywhere(chance, 0.7, 1.4);
    v[MODEL_KF] *= kf;
    v[MODEL_ROTOR] *= kf;
    v[MODEL_COULOMB] *= kf;
    v[MODEL_VISCOUS] *= kf;
    v[MODEL_MU_MOTOR] = mu * share;
    v[MODEL_MU_MASS] = mu * (1 - share);
    v[MODEL_CABLE_K] = anywhere(chance, 1000, 60000);
    v[MODEL_CABLE_B] = anywhere(chance, 1, 80);
    return m;
}

/* Many random starts; rough descents of the best. The force constant stays as drawn, since it moves
 * with the parameters of the rotor. */
static int starts(struct starts *s, const struct model *told, const struct identify_data *d,
    const struct observations *few, struct sim_random *chance)
{
    static const struct fit_how rough = {
        FIT_MASS & ~(1u << MODEL_STEP | 1u << MODEL_KF), FAR_M, 12, 0, 1e-2, 1};
    struct model m[STARTS_MAX];
    struct starts drawn;
    int err = 0;
    drawn.n = s->n = 0;
    for (int i = 0; i < DRAWN; i += STARTS_MAX) {
        const int n = DRAWN - i < STARTS_MAX ? DRAWN - i : STARTS_MAX;
        for (int k = 0; k < n; k++) { m[k] = draw(told, chance); }
        add_all(&drawn, m, n, d, few, FAR_M);
    }
    for (int i = 0; i < ROUGH && err == 0; i++) {
        struct fit one = {.at = drawn.m[i]};
        err = fit_run(&one, d, few, rough);
        add(s, &one.at, one.cost);
    }
    return err;
}

/* Shows one more descent; the total is unknown. */
static void show(int over)
{
    static int done;
    done += !over;
    progress_show("descents", done, 0, over);
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

/* Uses the lag from the monitor as either lag of the drive, unless the motion contradicts both. */
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

/* The motion determines the lag least. A wrong lag keeps all others in a local minimum of the
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
    struct model m[3 * BESIDE];
    int n = 0;
    for (int i = 0; i < 3 * BESIDE; i++) {
        if (i == BESIDE / 2) { continue; } /* f itself */
        m[n] = f->at;
        m[n].value[MODEL_CABLE_K] *= exp(0.025 * (i % BESIDE - BESIDE / 2));
        m[n++].value[MODEL_CABLE_B] *= damped[i / BESIDE];
    }
    s->n = 0;
    add_all(s, m, n, d, o, 0);
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

/* From the best starts, until the model fits what a string does that never slackens. */
static int from_starts(struct fit *best, const struct starts *s, const struct identify_data *d,
    const struct observations *calm)
{
    static const struct fit_how finer = {FIT_ALL & ~(1u << MODEL_LAG), 2e-4, 20, 0, 1e-2, 1};
    int err = 0;
    best->cost = (double)INFINITY;
    for (int i = 0; i < TRIED && err == 0 && best->cost > CALM; i++) {
        struct fit one = *best;
        one.at = s->m[i];
        err = fit_run(&one, d, calm, finer);
        if (err == 0) { err = from(best, &one.at, d, calm); }
    }
    return err;
}

/* Down from starts, then from beside what was found and from a little way off, as long. */
static int begin(struct fit *best, const struct fit *told, const struct identify_data *d,
    const struct observations *calm, struct sim_random *chance)
{
    struct observations few;
    struct starts s;
    int err = observe_calm(&few, d, 1u << IDENTIFY_MASS, 2, 0.06);
    if (err == 0) { err = starts(&s, &told->at, d, &few, chance); }
    if (err == 0) { err = from_starts(best, &s, d, calm); }
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
