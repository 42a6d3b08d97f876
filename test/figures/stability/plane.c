/* SPDX-License-Identifier: MIT */
/* The sigma-beta plane: a virtual spring alone, encoder steps of D, dry friction Fc = sigma K D,
 * viscous friction c = beta K T. Where does it rest, where has it a cycle of about a step, and
 * where does it grow? Theory:
 *
 *   It rests at sigma >= 1/2.
 *   Nothing grows where rho < 1. If the oscillation is slow compared to the rate, that is from
 *   beta = 1/2 + d on.
 *   Below that, amplitudes above A* = 4 sigma D / (pi sqrt(alpha) (1/2 + d - beta)) grow, with
 *   alpha = K T^2 / m.
 *   Without dry friction cycles have at most (2 / pi) (1 + d) / beta steps to either side. */
#include "stability.h"

#include <math.h>
#include <stdlib.h>

#define STEP_M  20e-6
#define K_NPM   1000.0
#define OFFSETS 8
#define LARGE   20.0 /* steps from rest, where it begins */
#define PI      3.14159265358979323846

enum ends { REST, CYCLE, GROWS };
static const char *const end_name[] = {"rest", "cycle", "grows"};

struct result {
    enum ends ends;
    double steps; /* peak to peak, of the worst load */
};

static double range_of(struct wall *w, int ticks)
{
    double low = w->x_m, high = w->x_m;
    for (int i = 0; i < ticks; i++) {
        wall_tick(w);
        low = fmin(low, w->x_m);
        high = fmax(high, w->x_m);
    }
    return (high - low) / STEP_M;
}

/* One load: at rest between two counts, `offset` of a step from one of them. */
static struct result run_one(
    double alpha, int delay, double sigma, double beta, double offset, double from)
{
    struct wall w = {.T = {1, 1000}, .k_Npm = K_NPM, .step_m = STEP_M, .delay = delay};
    struct result y = {CYCLE, 0};
    double before = HUGE_VAL;
    w.mass_kg = K_NPM * 1e-6 / alpha;
    w.viscous_Nspm = beta * K_NPM * 1e-3;
    w.coulomb_N = sigma * K_NPM * STEP_M;
    w.load_N = offset * K_NPM * STEP_M;
    w.x_m = from * STEP_M;
    if (wall_start(&w) != 0) { abort(); }
    for (int i = 0; i < 40; i++) {
        y.steps = range_of(&w, 1000);
        if (y.steps > 3 * LARGE) { return (struct result){GROWS, y.steps}; }
        if (!(y.steps > 0)) { return (struct result){REST, 0}; }
        /* A cycle is as large as before; what still falls or grows is watched on, 40 s at most. */
        if (i > 2 && y.steps < 8 && y.steps > 0.999 * before) { break; }
        before = y.steps;
    }
    if (y.steps > from && y.steps > 20) { y.ends = GROWS; }
    return y;
}

/* The worst of eight loads. */
static struct result run(double alpha, int delay, double sigma, double beta, double from)
{
    struct result worst = {REST, 0};
    for (int i = 0; i < OFFSETS; i++) {
        const struct result y =
            run_one(alpha, delay, sigma, beta, (i + 1.0) / OFFSETS - 0.0013, from);
        if (y.ends > worst.ends || (y.ends == worst.ends && y.steps > worst.steps)) { worst = y; }
    }
    return worst;
}

/* Where rho is 1: 1/2 + d where the swing is slow beside the rate (alpha small), a little less
 * where it is not. */
static double border_of(double alpha, int delay)
{
    double low = 0, high = 2 + delay;
    for (int n = 0; n < 40; n++) {
        struct wall w = {.T = {1, 1000}, .k_Npm = K_NPM, .delay = delay};
        w.mass_kg = K_NPM * 1e-6 / alpha;
        w.viscous_Nspm = (low + high) / 2 * K_NPM * 1e-3;
        *(rho_of(&w) < 1 ? &high : &low) = (low + high) / 2;
    }
    return low;
}

static double a_star(double alpha, double border, double sigma, double beta)
{
    return 4 * sigma / (PI * sqrt(alpha) * (border - beta));
}

struct tally {
    int rest, rest_of, bounded, bounded_of, cycles, cycles_of, star, star_of;
    double amplitude; /* share of the bound */
};

static void judge(struct tally *t, double alpha, int delay, double border, double sigma,
    double beta, struct result y)
{
    if (beta >= border + 0.1) {
        t->bounded_of++;
        t->bounded += y.ends != GROWS;
        if (sigma >= 0.55) {
            t->rest_of++;
            t->rest += y.ends == REST;
        }
        if (sigma <= 0.45) {
            t->cycles_of++;
            t->cycles += y.ends == CYCLE;
        }
    } else if (beta <= border - 0.1) { /* within a third of A*, the load decides */
        const double star = a_star(alpha, border, sigma, beta);
        if (star < LARGE / 1.33 || star > LARGE * 1.33) {
            t->star_of++;
            t->star += (y.ends == GROWS) == (star < LARGE);
        }
    }
    if (sigma == 0 &&
        beta >= 1.2 * (1 + delay)) { /* half of peak to peak against (2 / pi) (1 + d) / beta */
        const double share = y.steps / 2 / (2 / PI * (1 + delay) / beta);
        if (share > t->amplitude) { t->amplitude = share; }
    }
}

int quantized_plane(enum size size)
{
    static const int columns[] = {6, 40, 79}, rows[] = {7, 25, 49};
    static const double alphas[] = {0.05, 0.4};
    FILE *csv = csv_open("plane", "panel,alpha,delay,beta,sigma,ends,steps");
    FILE *lines = csv_open("plane_border", "panel,alpha,delay,beta");
    struct tally t = {0, 0, 0, 0, 0, 0, 0, 0, 0};
    int failed;
    for (int panel = 0; panel < 4; panel++) {
        const double alpha = alphas[panel / 2];
        const int delay = panel % 2;
        const double border = border_of(alpha, delay);
        fprintf(lines, "%d,%g,%d,%.4f\n", panel, alpha, delay, border);
        for (int i = 0; i < columns[size] * rows[size]; i++) {
            const double beta = 0.05 + delay + 1.95 * (i % columns[size]) / (columns[size] - 1);
            const double sigma = 1.2 * (i / columns[size]) / (rows[size] - 1);
            const struct result y = run(alpha, delay, sigma, beta, LARGE);
            judge(&t, alpha, delay, border, sigma, beta, y);
            fprintf(csv, "%d,%g,%d,%.4f,%.4f,%s,%.3f\n", panel, alpha, delay, beta, sigma,
                end_name[y.ends], y.steps);
        }
    }
    csv_close(csv);
    csv_close(lines);
    failed = must(t.rest == t.rest_of,
        "plane: rests at sigma >= 0.55, beta 0.1 beyond rho = 1, any load", "%d of %d", t.rest,
        t.rest_of);
    failed += must(t.cycles == t.cycles_of,
        "plane: cycles at some load at sigma <= 0.45, beta 0.1 beyond rho = 1", "%d of %d",
        t.cycles, t.cycles_of);
    failed += must(t.bounded == t.bounded_of, "plane: does not grow at beta 0.1 beyond rho = 1",
        "%d of %d", t.bounded, t.bounded_of);
    failed += must(t.star >= 0.98 * t.star_of,
        "plane: below, grows exactly where 20 steps are more than A*: 98 %", "%d of %d", t.star,
        t.star_of);
    return failed + must(t.amplitude <= 1.05,
                        "plane: sigma = 0, beta >= 1.2 (1 + d): amplitude (2 / pi) (1 + d) / beta "
                        "at most, 5 %",
                        "%.2f of it", t.amplitude);
}
