/* SPDX-License-Identifier: MIT */
/* The map: with friction, saturation and steps off, is the wall stable where rho < 1, and as fast?
 */
#include "stability.h"

#include "sim/linear.h"

#include <math.h>
#include <stdlib.h>

#define NEAR  0.005
#define GROWN 64.0 /* and shrunk: by so much it is decided */
#define START_S \
    0.125 /* metres a second of period: grown, it is twice as fast as 16 m/s at most, the end of \
             the format */
#define WINDOW   128
#define WINDOWS  32
#define DISAGREE 8 /* shown */

static const uint32_t rate_Hz[] = {90, 100, 200, 500, 1000, 2000, 5000, 10000, 20000};
static const double mass_kg[] = {0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 2, 5};

struct seen {
    int stable;
    double rho; /* of the peaks of windows; 0: decayed or grown too soon */
};

struct peak {
    double m;
    int at; /* tick */
};

/* What the peaks of two windows say a tick does. */
static double per_tick(struct peak a, struct peak b)
{
    return b.at - a.at >= 2 * WINDOW ? pow(b.m / a.m, 1.0 / (b.at - a.at)) : 0;
}

/* Peaks of windows of 128 ticks, until they are 64 times what it began with, or a 64th, or 4096
 * ticks are over. */
static struct seen watch(struct wall *w)
{
    const double start_m = START_S * w->T_s;
    struct peak peak[WINDOWS];
    struct seen y;
    int n = 0, from;
    for (; n < WINDOWS; n++) {
        peak[n] = (struct peak){0, 0};
        for (int i = 0; i < WINDOW && peak[n].m <= GROWN * start_m; i++) {
            wall_tick(w);
            if (fabs(w->x_m) > peak[n].m) { peak[n] = (struct peak){fabs(w->x_m), n * WINDOW + i}; }
        }
        if (peak[n].m > GROWN * start_m || peak[n].m < start_m / GROWN) { break; }
    }
    n -= n == WINDOWS;
    from = n / 2; /* what decays faster has gone by then */
    y.stable = peak[n].m < start_m && (n == 0 || peak[n].m < peak[from].m);
    y.rho = n > 3 ? per_tick(peak[from], peak[n]) : 0;
    return y;
}

struct tally {
    long far, agree, near, near_agree, rates;
    double worst_rho;
    int shown;
};

static void cell(struct wall w, FILE *csv, struct tally *t)
{
    const double T = (double)w.T.num / w.T.den, rho = rho_of(&w);
    const int far = fabs(rho - 1) >= NEAR;
    struct seen y;
    w.x_m = START_S * T;
    w.v_mps = 0;
    if (wall_start(&w) != 0) { abort(); }
    y = watch(&w);
    if (far) {
        t->far++;
        t->agree += y.stable == (rho < 1);
    } else {
        t->near++;
        t->near_agree += y.stable == (rho < 1);
    }
    if (far && y.stable != (rho < 1) && t->shown++ < DISAGREE) {
        printf("    %g Hz, %g kg, %d ticks, k %g, b %g: rho %.4f, simulated: %s\n", 1 / T,
            w.mass_kg, w.delay, w.k_Npm, w.b_Nspm, rho, y.stable ? "decays" : "grows");
    }
    if (y.rho > 0 && far && fabs(y.rho - rho) > t->worst_rho) { t->worst_rho = fabs(y.rho - rho); }
    t->rates += y.rho > 0 && far;
    fprintf(csv, "%g,%g,%d,%g,%g,%.4g,%.4g,%.6f,%d,%.6f\n", 1 / T, w.mass_kg, w.delay, w.k_Npm,
        w.b_Nspm, w.k_Npm * T * T / w.mass_kg, w.b_Nspm * T / w.mass_kg, rho, y.stable, y.rho);
}

/* The largest alpha with rho < 1 at beta: what the picture draws as a line. */
static void borders(void)
{
    FILE *csv = csv_open("stability_border", "delay,beta,alpha");
    for (int delay = 0; delay <= WALL_DELAY_MAX; delay++) {
        for (int i = 0; i < 400; i++) {
            struct wall w = {.T = {1, 1000}, .mass_kg = 1, .delay = delay};
            double low = 0, high = 1;
            w.b_Nspm = 1000 * spaced(1e-4, 2, i, 400);
            for (int n = 0; n < 40; n++) {
                w.k_Npm = 1e6 * (low + high) / 2;
                *(rho_of(&w) < 1 ? &low : &high) = (low + high) / 2;
            }
            if (low > 1e-7) { fprintf(csv, "%d,%g,%g\n", delay, w.b_Nspm / 1000, low); }
        }
    }
    csv_close(csv);
}

int linear_map(enum size size)
{
    static const int cells[] = {4, 11, 31};
    const int n = cells[size];
    FILE *csv = csv_open(
        "stability", "rate_hz,mass_kg,delay,k_n_per_m,b_ns_per_m,alpha,beta,rho,stable,rho_seen");
    struct tally t = {0, 0, 0, 0, 0, 0, 0};
    int failed;
    for (size_t r = 0; r < LEN(rate_Hz); r++) {
        for (size_t m = 0; m < LEN(mass_kg); m++) {
            for (int i = 0; i < n * n * (WALL_DELAY_MAX + 1); i++) {
                struct wall w = {.T = {1, rate_Hz[r]}, .mass_kg = mass_kg[m], .delay = i / (n * n)};
                w.k_Npm = spaced(10, 1e6, i % n, n);
                w.b_Nspm = i / n % n == 0 ? 0 : spaced(0.1, 1e3, i / n % n - 1, n - 1);
                cell(w, csv, &t);
            }
        }
    }
    csv_close(csv);
    borders();
    failed = must((double)t.agree >= 0.99 * (double)t.far,
        "map: grows or decays as rho says, where rho is 0.005 off 1: 99 %",
        "%ld of %ld (%.2f %%); nearer %ld of %ld", t.agree, t.far,
        100.0 * (double)t.agree / (double)t.far, t.near_agree, t.near);
    return failed + must(t.worst_rho < 0.02,
                        "map: and by as much a tick, where 512 ticks or more show it: within 0.02",
                        "%.4f, %ld cells", t.worst_rho, t.rates);
}
