/* SPDX-License-Identifier: MIT */
#include "lab/certificate/one.h"

#include "lab/certificate/draw.h"

#include "advise/gains.h"
#include "base/assign.h"
#include "box/table2.h"
#include "identify/estimate.h"
#include "identify/observe.h"
#include "identify/fit.h"
#include "identify/result.h"
#include "identify/session.h"

#include "identify/identify.h"

#include "sim/codes.h"
#include "sim/random.h"

#include <string.h>

#define FALLS  10     /* of a run */
#define INSIDE 24     /* runs inside of the rule, */
#define LINE   12     /* and on its line */
#define B_MAX  1000.0 /* N/(m/s), */
#define K_MAX  1e6    /* N/m: what the scene takes */

/* The person takes a lighter mass where the box cannot lift one. */
static int session(struct one *r, struct identify_session *s, struct identify_data *data)
{
    r->failed = 1;
    s->mass_kg = 0.5;
    for (int i = 0; i < ONE_LIGHTER && r->failed && !posix_interrupted(); i++, s->mass_kg /= 2) {
        identify_data_free(data);
        if (identify_session(s, data)) { return 1; }
        r->mass_kg = s->mass_kg;
        r->device_s += (double)data->n * data->T_s;
        r->failed = data->result != EXH_PROBE_DONE ? (int)data->result : 0;
    }
    return r->failed;
}

static void keep(struct one *r, const struct model *truth, const struct result_file *file)
{
    memcpy(r->truth, truth->value, sizeof truth->value);
    memcpy(r->value, file->value.value, sizeof file->value.value);
    memcpy(r->low, file->low.value, sizeof file->low.value);
    memcpy(r->high, file->high.value, sizeof file->high.value);
    r->truth[ONE_MU_BOTH] = model_mu(truth);
    r->value[ONE_MU_BOTH] = model_mu(&file->value);
    r->low[ONE_MU_BOTH] = file->mu_low;
    r->high[ONE_MU_BOTH] = file->mu_high;
}

/* 0: it was identified, and the model fits. */
static int tell(struct one *r, const struct one_opt *o, const struct sim_device *d, uint64_t seed,
    struct result_file *file)
{
    static struct identify_data data;
    struct identify_session s;
    struct estimate_of e;
    int err;
    memset(&s, 0, sizeof s);
    s.board = posix_config_default();
    s.board.seed = seed;
    s.board.device = *d;
    s.rate_Hz = (uint32_t)o->rate_Hz;
    s.repeats = (int)o->repeats;
    err = session(r, &s, &data) || identify_estimate(&e, &data);
    if (!err) { r->residual = e.fit.cost; }
    r->fits = !err && r->residual <= RESULT_RESIDUAL_MAX;
    err = err || !r->fits || identify_resample(&e, &data, 1);
    if (!err) {
        const struct model truth = model_of(d, data.T_s);
        result_take(file, &e, data.T_s, data.mass_kg);
        keep(r, &truth, file);
    }
    identify_data_free(&data);
    return err;
}

/* The falls that come to rest, in a run of the drop scene on the device itself. The wall is at this
 * place between two counts, 0 .. 1. */
static int rests(const struct one_opt *o, const struct sim_device *d, uint64_t seed, double k,
    double b, double place)
{
    /* The mass falls from the height given to the advisor. The bench counts a contact from a place
     * in front of the wall on. It would never see a mass that rests before that place. */
    const double step_m = d->step_m / d->decode;
    const double before = (double)sim_floor(2 * d->height_jitter_m / step_m) + 1;
    const struct run_setting wall = {"q_lim", sim_wall_m(d, place)};
    struct sim_device nearer = *d;
    struct run_cfg c;
    struct table2_result t;
    nearer.height_m -= before * step_m;
    memset(&c, 0, sizeof c);
    c.setting = &wall;
    c.settings = 1;
    c.rate_Hz = (uint32_t)o->rate_Hz;
    c.k_Npm = k;
    c.b_Nspm = b;
    c.board = posix_config_default();
    c.board.device = nearer;
    c.board.seed = seed;
    c.board.falls = FALLS;
    t = table2_measure(&c, NULL, TABLE2_REST);
    return t.done && t.falls == FALLS ? t.falls - t.oscillating - t.incomplete : 0;
}

/* A run with this b and this share of the largest k there. */
static void run_at(struct one *r, const struct one_opt *o, const struct sim_device *d,
    const struct gains_rate *x, struct sim_random *chance, double b, double share, int where)
{
    const double k = share * gains_k_max(&x->rule, b);
    uint64_t seed;
    int n;
    if (!gains_allows(&x->rule, k, b)) { return; }
    seed = sim_random_u64(chance) >> 1;
    n = rests(o, d, seed, k, b, sim_random_unit(chance));
    r->runs[where]++;
    r->single[where] += n == FALLS - 1;
    r->unstable[where] += n < FALLS - 1;
}

/* Runs anywhere inside of the rule, and on its line, where it is the likeliest to be wrong. */
static void inside(struct one *r, const struct one_opt *o, const struct sim_device *d,
    const struct gains_rate *x, struct sim_random *chance)
{
    const double first = (double)x->rule.b_Nspm_q20[0] / 1048576;
    const double last = (double)x->rule.b_Nspm_q20[x->rule.knots - 1] / 1048576;
    for (int i = 0; i < INSIDE && !posix_interrupted(); i++) {
        const double b = first + (last - first) * sim_random_unit(chance);
        run_at(r, o, d, x, chance, b, sim_random_unit(chance), ONE_INSIDE);
    }
    for (int i = 0; i < LINE && !posix_interrupted(); i++) {
        run_at(r, o, d, x, chance, first + (last - first) * (i + 0.5) / LINE, 1, ONE_LINE);
    }
}

/* The places, a run each, at which every fall rests, up to the first at which one does not. The
 * order is four places, then the eight with those between, then all. A pair that chatters at one of
 * eight places is seldom seen at four. */
static int places(const struct one_opt *o, const struct sim_device *d, struct sim_random *chance,
    double k, double b)
{
    static const int in_turn[] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
    const int most = (int)(sizeof in_turn / sizeof in_turn[0]);
    for (int n = 0; n < most; n++) {
        const uint64_t seed = sim_random_u64(chance) >> 1;
        const double place = (in_turn[n] + sim_random_unit(chance)) / most;
        if (rests(o, d, seed, k, b, place) < FALLS) { return n; }
    }
    return most;
}

/* The stable area, and what of it the rule allows. */
static void area(struct one *r, const struct one_opt *o, const struct sim_device *d,
    const struct gains_rate *x, struct sim_random *chance)
{
    const double b_top = 1.5 * x->region.row[REGION_ROWS].b_Nspm;
    double k_top = 0;
    for (int j = 0; j <= REGION_ROWS; j++) {
        const double k = 1.5 * x->region.row[j].high_Npm;
        k_top = k > k_top ? k : k_top;
    }
    for (int j = 0; j < o->grid && !posix_interrupted(); j++) {
        const double b = b_top * (j + 0.5) / o->grid;
        if (o->map) { printf("\nb %6.1f ", b); }
        for (int i = 0; i < o->grid; i++) {
            const double k = k_top * (i + 0.5) / o->grid;
            const int allowed = gains_allows(&x->rule, k, b);
            const int n = b <= B_MAX && k <= K_MAX ? places(o, d, chance, k, b) : 0;
            if (o->map) { putchar(".o+#"[(n >= 4 << ONE_SIXTEEN) + 2 * allowed]); }
            for (int p = 0; p < ONE_PLACES; p++) {
                r->stable[p] += n >= 4 << p;
                r->covered[p] += n >= 4 << p && allowed;
            }
        }
    }
    fflush(stdout); /* we may be the child of another process */
}

static void advise(struct one *r, const struct one_opt *o, const struct sim_device *d,
    const struct result_file *file, uint64_t seed)
{
    static struct gains_options a;
    static struct gains_rate x;
    struct sim_random chance = {seed ^ 0x616476697365};
    memset(&x, 0, sizeof x);
    gains_defaults(&a);
    a.jobs = 1;
    a.has_file = 1;
    if (gains_refuse(&a)) { return; }
    x.rate_Hz = (double)o->rate_Hz;
    a.o.wall.T_s = 1 / x.rate_Hz;
    if (gains_told(&a.o, file, x.rate_Hz) == 0 && region_fill(&x.region, &a.o) == 0 &&
        gains_proved(&x) == 0) {
        r->advised = 1;
        inside(r, o, d, &x, &chance);
        area(r, o, d, &x, &chance);
    }
}

void one_run(struct one *r, const struct one_opt *o, int i)
{
    const uint64_t seed = (uint64_t)o->seed * 1000003u + (uint64_t)i;
    struct sim_device d = draw_device(seed);
    struct result_file file;
    memset(r, 0, sizeof *r);
    if (assign_step(&d, 0, 0)) { return; }
    if (o->told) {
        memset(&file, 0, sizeof file);
        file.rate_Hz = (double)o->rate_Hz;
        file.value = file.low = file.high = model_of(&d, 1 / file.rate_Hz);
        file.mu_low = file.mu_high = model_mu(&file.value);
        file.monitor_lag_s = d.mon_lag_s;
        advise(r, o, &d, &file, seed);
    } else if (tell(r, o, &d, seed, &file) == 0 && o->grid > 0) {
        advise(r, o, &d, &file, seed);
    }
    r->done = !posix_interrupted();
}
