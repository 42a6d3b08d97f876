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
        if (end == at || !(v >= 1 && v <= 20000) || (*end != ',' && *end != '\0')) { break; }
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
    return assign_device(&a->o.device, "drop", text);
}

/* What the drop scene has when nobody says otherwise. */
static double of_scene(const char *name)
{
    const struct exh_signal *row = cli_signal_find(exh_scene_drop.params->table, name, NULL);
    return cli_signal_value(row, row->dflt);
}

static void defaults(struct gains_options *a)
{
    memset(a, 0, sizeof *a);
    exh_scene_drop.defaults();
    a->o.device = sim_device_default();
    a->o.wall.f0_N = of_scene("f0");
    a->o.wall.f0_band_m = of_scene("f0_band");
    a->o.wall.f_max_N = of_scene("f_max");
    a->o.wall.slew_Nps = of_scene("slew_up");
    a->window = INT64_C(1) << (int)of_scene("vel_p");
    a->cases = 32;
    a->margin_percent = 3;
    a->k_Npm = a->b_Nspm = -1;
    a->rate_Hz[0] = 2000;
    a->rates = 1;
    a->jobs = jobs_cores();
}

static int refuse(struct gains_options *a)
{
    struct sim_device *d = &a->o.device;
    if (assign_step(d, 0, 0)) { return 2; }
    if (assign_grid(a->grid ? a->grid : "64x48", &a->o.columns, &a->o.rows)) { return 2; }
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
    a->o.off = a->off_percent / 100;
    a->o.margin = a->margin_percent / 100;
    a->o.cases = (int)a->cases;
    a->o.wall.window = (int)a->window;
    a->o.jobs = (int)a->jobs;
    return 0;
}

/* --- what is said of a rate --- */

/* How far pieces from i, j on are allowed, so many at a time along k or b: the last one. */
static int along(struct region *r, int i, int j, int di, int dj)
{
    int n = 0;
    while (region_piece(r, i + di, j + dj)) {
        i += di;
        j += dj;
        n++;
    }
    return n;
}

/* Whether everything from k/room to k room and b/room to b room is allowed. */
static int has_room(struct region *r, int i, int j, double room)
{
    const double k = region_k(r, i + 1), b = (region_b(r, j) + region_b(r, j + 1)) / 2;
    int i0, j0, i1, j1;
    if (!region_find(r, k / room, b / room, &i0, &j0) ||
        !region_find(r, k * room, b * room, &i1, &j1)) {
        return 0;
    }
    for (int m = j0; m <= j1; m++) {
        for (int n = i0; n <= i1; n++) {
            if (!region_piece(r, n, m)) { return 0; }
        }
    }
    return 1;
}

static void print_best(struct region *r)
{
    static const double room[] = {1, 1.25, 1.5};
    printf("  stiffest pairs, allowed as far as k and b both times and by so much:");
    for (size_t n = 0; n < sizeof room / sizeof room[0]; n++) {
        int found = 0;
        for (int i = r->o.columns - 1; i >= 0 && !found; i--) {
            for (int j = 0; j < r->o.rows && !found; j++) {
                found = has_room(r, i, j, room[n]);
                if (!found) { continue; }
                printf("%s x%.4g: k %.5g b %.3g", n ? "," : "", room[n], region_k(r, i + 1),
                    (region_b(r, j) + region_b(r, j + 1)) / 2);
            }
        }
        if (!found) { printf("%s x%.4g: none", n ? "," : "", room[n]); }
    }
    printf("\n");
}

/* Both gains raised together, by hundredths. */
static double together(struct region *r, double k, double b)
{
    double g = 1;
    while (region_allows(r, (g + 0.01) * k, (g + 0.01) * b)) { g += 0.01; }
    return g;
}

/* The lowest piece of a row or column that is allowed, and the end of what hangs together with it.
 */
static double first_run(struct region *r, int i, int j, int of_k)
{
    const int n = of_k ? r->o.columns : r->o.rows;
    for (int m = 0; m < n; m++) {
        const int at_i = of_k ? m : i, at_j = of_k ? j : m;
        if (!region_piece(r, at_i, at_j)) { continue; }
        m += along(r, at_i, at_j, of_k, !of_k);
        return of_k ? region_k(r, m + 1) : region_b(r, m + 1);
    }
    return 0;
}

/* Whether it is allowed. */
static int print_pair(const struct gains_options *a, struct region *r)
{
    const double k = a->k_Npm, b = a->b_Nspm;
    const double rho = linear_rho(&r->o.device, r->o.wall.T_s, k, b, r->o.wall.window);
    int i, j, ok;
    ok = region_find(r, k, b, &i, &j) && region_piece(r, i, j);
    printf("  k %.6g N/m, b %.6g Ns/m: %s (linear test alone: rho %.4f, %s; energy: %s)\n", k, b,
        ok ? "allowed" : "NOT allowed", rho, rho >= 0 && rho < 1 ? "stable" : "not stable",
        region_energy(&r->o, k, b) ? "stable" : "not stable");
    if (ok) {
        const double k_up = region_k(r, i + 1 + along(r, i, j, 1, 0));
        const double b_up = region_b(r, j + 1 + along(r, i, j, 0, 1));
        printf("  margin: k %.6g .. %.6g N/m (x%.2f) at this b; b %.6g .. %.6g Ns/m (+%.3g) at "
               "this k; both "
               "together x%.2f\n",
            region_k(r, i - along(r, i, j, -1, 0)), k_up, k > 0 ? k_up / k : 0,
            region_b(r, j - along(r, i, j, 0, -1)), b_up, b_up - b, together(r, k, b));
        printf("  largest k at this b %.6g N/m, largest b at this k %.6g Ns/m\n", k_up, b_up);
    } else if (region_find(r, k < region_k(r, 0) ? region_k(r, 0) : k, b, &i, &j)) {
        printf("  largest k at this b %.6g N/m, largest b at this k %.6g Ns/m (0: none)\n",
            first_run(r, i, j, 1), first_run(r, i, j, 0));
    } else {
        printf("  beyond all that comes to rest: k < %.6g N/m, b < %.6g Ns/m\n", r->k_top_Npm,
            r->b_top_Nspm);
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
    err = region_open(&x->region, &o);
    if (err == 0) { err = region_fill(&x->region); }
    if (err) { return err; }
    x->has_rule = gains_rule(&x->rule, &x->region) == 0;
    if (study->rate) { *restless |= study->rate(x, i); }
    if (a->rule) {
        if (x->has_rule) { gains_rule_print(stdout, &x->rule); }
        return !x->has_rule;
    }
    printf("%.6g Hz: k < %.6g N/m, b < %.6g Ns/m looked at, in pieces of %.4g N/m by %.3g Ns/m\n",
        x->rate_Hz, x->region.k_top_Npm, x->region.b_top_Nspm, x->region.k_top_Npm / o.columns,
        x->region.b_top_Nspm / o.rows);
    if (a->k_Npm >= 0) { ok = print_pair(a, &x->region); }
    print_best(&x->region);
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
    for (int i = 0; i < a->rates; i++) { region_free(&rate[i].region); }
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
        {"window", CLI_INT, &a.window, 1, 16, "N", "ticks of the velocity (2)"},
        {"device", CLI_CALL, &device, 0, 0, "NAME=VALUE",
            "mass, rotor, step, decode, delay, mu_motor, ...: exhand drop --params"},
        {"off", CLI_REAL, &a.off_percent, 0, 50, "PERCENT",
            "also with masses so much more and less, and friction so much less (0)"},
        {"margin", CLI_REAL, &a.margin_percent, 0, 50, "PERCENT",
            "every second fall with so much less friction (3)"},
        {"cases", CLI_INT, &a.cases, 2, 1000, "N", "falls of each node; more allow less (32)"},
        {"grid", CLI_TEXT, &a.grid, 0, 0, "KxB", "pieces along k and b (64x48)"},
        {"rule", CLI_FLAG, &a.rule, 0, 0, NULL, "print only the rule, as --set takes it and as C"},
        {"jobs", CLI_INT, &a.jobs, 1, 1024, "N", "processes at a time (one a core)"},
    };
    const struct cli_command c = {"advise", "gains [options]",
        "Which stiffness k and damping b come to rest at a rate, margins, the best pairs. A model "
        "of the\n"
        "device (string, rotor, dry friction in proportion to the tension, encoder steps, delay, "
        "current\n"
        "lag) lets the mass fall onto the wall at nodes over k and b, from phases that fill all "
        "there are\n"
        "evenly; what lies between four nodes of which every fall comes to rest is allowed. It "
        "holds for\n"
        "the mass, friction and height told (--off: for some around them) and for nothing else.",
        option, (int)(sizeof option / sizeof option[0]), 1};
    int err;
    defaults(&a);
    err = cli_parse_more(&c, &study->more, argc, argv, about);
    if (err) { return err == 1 ? 0 : err; }
    err = refuse(&a);
    return err ? err : advise(&a, study);
}
