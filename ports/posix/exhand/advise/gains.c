/* SPDX-License-Identifier: MIT */
/* exhand advise gains: the k and b that come to rest at a rate on a device, with friction. */
#include "advise/gains.h"

#include "base/assign.h"
#include "base/cli.h"
#include "base/jobs.h"
#include "base/option.h"
#include "base/param.h"
#include "base/scenes.h"

#include "sim/linear.h"

#include <stdlib.h>
#include <string.h>

/* --- options --- */

static int take_rates(void *ctx, const char *text)
{
    struct gains_options *a = ctx;
    a->rates = 0;
    a->rates_given = 1;
    for (const char *at = text; a->rates < GAINS_RATES; at++) {
        char *end;
        const double v = strtod(at, &end);
        if (end == at || *at == ' ' || strpbrk(at, "xX") || !(v >= 1 && v <= 20000) ||
            (*end != ',' && *end != '\0')) {
            break;
        }
        a->rate_Hz[a->rates++] = v;
        if (*end == '\0') { return 0; }
        at = end;
    }
    cli_complain("--rate: %s (1..20000 Hz, at most %d of them, with commas): e.g. --rate 500,2000",
        text, GAINS_RATES);
    return 2;
}

static int take_device(void *ctx, const char *text)
{
    struct gains_options *a = ctx;
    if (strchr(text, '=') != NULL) { return assign_device(&a->o.device[0], "drop", text); }
    a->has_file = 1;
    return result_read(&a->file, text);
}

/* The default of the drop scene. */
static double of_scene(const char *name)
{
    const struct exh_signal *row = cli_signal_find(exh_scene_drop.params->table, name, NULL);
    return cli_signal_value(row, row->dflt);
}

void gains_defaults(struct gains_options *a)
{
    memset(a, 0, sizeof *a);
    exh_scene_drop.defaults();
    a->o.device[0] = sim_device_default();
    a->o.devices = 1;
    a->o.wall.f0_N = of_scene("f0");
    a->o.wall.f0_band_m = of_scene("f0_band");
    a->o.wall.f_max_N = of_scene("f_max");
    a->o.wall.slew_Nps = of_scene("slew_up");
    a->window = INT64_C(1) << (int)of_scene("vel_p");
    a->cases = 32;
    a->k_Npm = a->b_Nspm = a->phase = -1;
    a->margin_percent = -1;
    a->rate_Hz[0] = 2000;
    a->rates = 1;
    a->jobs = jobs_cores();
}

/* Adds a heavier and a lighter mass, both with less friction, to the given device. */
static void around(struct region_opt *o, double off)
{
    for (int i = -1; i <= 1; i += 2) {
        struct sim_device *d = &o->device[o->devices++];
        *d = o->device[0];
        d->mass_kg *= 1 + i * off;
        d->viscous_nspm *= 1 - off;
        d->mu_motor *= 1 - off;
        d->mu_mass *= 1 - off;
        d->coulomb_n *= 1 - off;
    }
}

int gains_refuse(struct gains_options *a)
{
    struct sim_device *d = &a->o.device[0];
    if (assign_step(d, 0, 0)) { return 2; }
    if ((a->k_Npm >= 0) != (a->b_Nspm >= 0)) {
        cli_complain("--k and --b: a pair is judged: give both");
        return 2;
    }
    if (a->window & (a->window - 1)) {
        cli_complain("--window: %d: 1, 2, 4, 8 or 16 ticks", (int)a->window);
        return 2;
    }
    for (int i = 0; i < a->rates; i++) {
        /* What is on its way to the drive has to fit the model, as it has to fit the simulated box.
         */
        if ((d->delay_tick / a->rate_Hz[i] + d->delay_s) * a->rate_Hz[i] > 200) {
            cli_complain("%.6g Hz: outputs are more than 200 ticks late: a lower --rate or delay",
                a->rate_Hz[i]);
            return 2;
        }
    }
    if (a->has_file && a->off_percent > 0) {
        cli_complain("--off: a file has its own intervals: --off is for --device NAME=VALUE");
        return 2;
    }
    if (a->off_percent > 0) { around(&a->o, a->off_percent / 100); }
    /* A device without measurements gets a margin; a device file has intervals. */
    if (a->margin_percent < 0) { a->margin_percent = a->has_file ? 0 : 3; }
    a->o.margin = a->margin_percent / 100;
    a->o.cases = (int)a->cases;
    a->o.at_phase = a->phase >= 0;
    a->o.phase = a->phase;
    a->o.wall.velocity.window = (int)a->window;
    a->o.jobs = (int)a->jobs;
    return 0;
}

/* --- what is said of a rate --- */

static double si(int32_t raw, int frac) { return (double)raw / (double)(INT32_C(1) << frac); }

static double k_min(const struct exh_gains_par *r) { return si(r->k_min_Npm_q10, EXH_Q_K); }
static double b_of(const struct exh_gains_par *r, int i) { return si(r->b_Nspm_q20[i], EXH_Q_B); }

/* The smallest of the largest k from b0 to b1; 0: not all of these b are inside. */
static double least_k(const struct exh_gains_par *r, double b0, double b1)
{
    const double k0 = gains_k_max(r, b0), k1 = gains_k_max(r, b1);
    double least = k0 < k1 ? k0 : k1;
    for (int i = 0; i < r->knots; i++) {
        const double k = si(r->k_Npm_q10[i], EXH_Q_K);
        if (b_of(r, i) > b0 && b_of(r, i) < b1 && k < least) { least = k; }
    }
    return least;
}

#define STEPS 400 /* of b, where something is looked for along it */

/* The stiffest k so that all from k/room to k room and b/room to b room is allowed, and its b. */
static double stiffest(const struct exh_gains_par *r, double room, double *b)
{
    double best = 0;
    for (int i = 0; i <= STEPS; i++) {
        const double at = b_of(r, 0) + (b_of(r, r->knots - 1) - b_of(r, 0)) * i / STEPS;
        const double k = least_k(r, at / room, at * room) / room;
        if (k <= best || k / room < k_min(r)) { continue; }
        best = k;
        *b = at;
    }
    return best;
}

static void print_rule(const struct exh_gains_par *r)
{
    printf("  allowed: k from %.5g N/m up to, straight in between:\n    b, Ns/m", k_min(r));
    for (int i = 0; i < r->knots; i++) { printf(" %8.4g", b_of(r, i)); }
    printf("\n    k, N/m ");
    for (int i = 0; i < r->knots; i++) { printf(" %8.5g", si(r->k_Npm_q10[i], EXH_Q_K)); }
    printf("\n");
}

static void print_best(const struct exh_gains_par *r)
{
    static const double room[] = {1, 1.25, 1.5};
    printf("  stiffest pairs, allowed as far as k and b both times and by so much:");
    for (size_t n = 0; n < sizeof room / sizeof room[0]; n++) {
        double b = 0;
        const double k = stiffest(r, room[n], &b);
        printf("%s x%.4g: ", n ? "," : "", room[n]);
        if (k > 0) {
            printf("k %.5g b %.3g", k, b);
        } else {
            printf("none");
        }
    }
    printf("\n");
}

/* How far b may go from an allowed pair, in steps of its whole range. */
static double as_far(const struct exh_gains_par *r, double k, double b, int up)
{
    const double step = (b_of(r, r->knots - 1) - b_of(r, 0)) / STEPS * (up ? 1 : -1);
    while (gains_allows(r, k, b + step)) { b += step; }
    return b;
}

/* Both gains raised together, by hundredths. */
static double together(const struct exh_gains_par *r, double k, double b)
{
    double g = 1;
    while (gains_allows(r, (g + 0.01) * k, (g + 0.01) * b)) { g += 0.01; }
    return g;
}

static void print_margin(const struct exh_gains_par *r, double k, double b)
{
    const double k_up = gains_k_max(r, b);
    printf("  margin: k %.6g .. %.6g N/m (x%.2f) at this b; b %.4g .. %.4g Ns/m at this k; both "
           "together x%.2f\n",
        k_min(r), k_up, k_up / k, as_far(r, k, b, 0), as_far(r, k, b, 1), together(r, k, b));
}

/* Why the rule does not have it: what such falls do. */
static void print_reason(const struct gains_rate *x, double k, double b)
{
    const struct region_opt *o = &x->region.o;
    const struct region_pair p = region_try(o, k, b);
    if (p.rest == p.falls) {
        printf(
            "  why: all %d falls of the model rest at it; weaker gains next to it do not, or the "
            "rule's straight pieces leave it out\n",
            p.falls);
    } else {
        printf("  why: %d of %d falls of the model do not come to rest; the first has the wall "
               "%.2f counts above a count%s\n",
            p.falls - p.rest, p.falls, p.at.wall,
            p.device ? ", on a device that is off by what was said" : "");
    }
    printf("  largest k at this b: %.6g N/m (0: none)\n", gains_k_max(&x->rule, b));
}

/* Whether it is allowed. */
static int print_pair(const struct gains_options *a, const struct gains_rate *x)
{
    const struct region_opt *o = &x->region.o;
    const double k = a->k_Npm, b = a->b_Nspm;
    const double rho = linear_rho(&o->device[0], o->wall.T_s, k, b, o->wall.velocity.window);
    const int ok = gains_allows(&x->rule, k, b);
    printf("  k %.6g N/m, b %.6g Ns/m: %s (linear model alone: spectral radius rho %.4f, %s; "
           "energy: %s)\n",
        k, b, ok ? "allowed" : "NOT allowed", rho, rho >= 0 && rho < 1 ? "stable" : "not stable",
        region_energy(o, k, b) ? "stable" : "not stable");
    if (ok) {
        print_margin(&x->rule, k, b);
    } else {
        print_reason(x, k, b);
    }
    return ok;
}

/* 0, or an exit status. */
static int do_rate(const struct gains_options *a, struct gains_rate *x, int i,
    const struct gains_study *study, int *restless)
{
    struct region_opt o = a->o;
    int err, ok = 1;
    o.wall.T_s = 1 / x->rate_Hz;
    if (a->has_file && gains_told(&o, &a->file, x->rate_Hz)) { return 2; }
    err = region_fill(&x->region, &o);
    if (err == 0) { err = gains_proved(x); }
    if (err) { return err; }
    if (study->rate) { *restless |= study->rate(x, i); }
    if (a->rule) {
        gains_rule_print(stdout, &x->rule);
        return 0;
    }
    printf("%.6g Hz\n", x->rate_Hz);
    print_rule(&x->rule);
    if (a->k_Npm >= 0) { ok = print_pair(a, x); }
    print_best(&x->rule);
    return !ok;
}

static int advise(struct gains_options *a, const struct gains_study *study)
{
    static struct gains_rate rate[GAINS_RATES];
    int worst = study->begin ? study->begin(a) : 0, inside = 1, restless = 0, n = 0;
    memset(rate, 0, sizeof rate);
    for (; n < a->rates && (worst == 0 || worst == 1); n++) {
        int err;
        rate[n].rate_Hz = a->rate_Hz[n];
        err = do_rate(a, &rate[n], n, study, &restless);
        inside &= err == 0;
        if (err > 1) { worst = err; }
        fflush(stdout);
    }
    if (study->end) {
        const int err = study->end(rate, n, worst == 0);
        worst = worst ? worst : err;
    }
    if (worst == JOBS_INTERRUPTED) {
        cli_complain("interrupted: gains keeps nothing of what it has run");
    }
    return worst ? worst : !inside || restless;
}

int gains_command(int argc, char **argv, const struct gains_study *study)
{
    static struct gains_options a;
    const char *about[1] = {NULL};
    struct cli_call rates = {take_rates, &a}, device = {take_device, &a};
    const struct cli_option option[] = {
        {"rate", CLI_CALL, &rates, 0, 0, "HZ[,HZ...]", "of the control loop (2000)"},
        {"k", CLI_REAL, &a.k_Npm, 0, 1e6, "N/M",
            "judge this stiffness, with --b: exit 1 if not allowed"},
        {"b", CLI_REAL, &a.b_Nspm, 0, 1e3, "NS/M", "and this damping"},
        {"phase", CLI_REAL, &a.phase, 0, 1, "P",
            "the wall lies P counts above an encoder count (anywhere)"},
        {"window", CLI_INT, &a.window, 1, 16, "N", "ticks of the velocity (2)"},
        {"device", CLI_CALL, &device, 0, 0, "FILE | NAME=VALUE",
            "what exhand identify wrote, all its intervals; or mass, rotor, step, ...: exhand drop "
            "--params"},
        {"off", CLI_REAL, &a.off_percent, 0, 50, "PERCENT",
            "also with masses so much more and less, and friction so much less (0)"},
        {"margin", CLI_REAL, &a.margin_percent, 0, 50, "PERCENT",
            "every second fall with so much less friction (3; with a file 0)"},
        {"cases", CLI_INT, &a.cases, 2, 1000, "N", "falls of each pair; more allow less (32)"},
        {"rule", CLI_FLAG, &a.rule, 0, 0, NULL, "print only the rule, as --set takes it and as C"},
        {"jobs", CLI_INT, &a.jobs, 1, 1024, "N", "processes at a time (one a core)"},
    };
    const struct cli_command c = {"advise", "gains [options]",
        "Which stiffness k and damping b come to rest at a rate: the rule that a scene refuses all "
        "others\nby, margins, the stiffest pairs. A model of the device (string, rotor, dry "
        "friction, "
        "encoder steps,\ndelay, current lag) lets the mass fall onto ever stiffer walls, from "
        "phases "
        "that fill all there are\nevenly; allowed is the connected region from weak walls up, "
        "inside the rule. It holds for\nthe mass, friction and height told (--off: for some "
        "around "
        "them) and for nothing else.",
        option, (int)(sizeof option / sizeof option[0]), 1};
    int err;
    gains_defaults(&a);
    err = cli_parse_more(&c, &study->more, argc, argv, about);
    if (err) { return err == 1 ? 0 : err; }
    err = gains_refuse(&a);
    return err ? err : advise(&a, study);
}
