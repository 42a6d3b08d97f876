/* SPDX-License-Identifier: MIT */
#include "lab/drop/reach.h"

#include "sim/linear.h"

#include <string.h>

#define K_MAX_NPM  1e6 /* what the scene takes */
#define B_MAX_NSPM 1e3

struct linear {
    const struct sim_device *d;
    int window;
    double rate_Hz, from, across; /* where the other gain is scanned */
    double at;                    /* where it was found stable */
};

static int linear_stable(struct linear *x, double k, double b)
{
    const double rho = linear_rho(x->d, 1 / x->rate_Hz, k, b, x->window);
    return rho >= 0 && rho < 1;
}

#define ACROSS 100 /* values of the other gain: b in equal steps, k in equal ratios from 1 up */

static int any_b(struct linear *x, double k)
{
    for (int i = 0; i <= ACROSS; i++) {
        const double b = x->from + (x->across - x->from) * i / ACROSS;
        if (!linear_stable(x, k, b)) { continue; }
        x->at = b;
        return 1;
    }
    return 0;
}

static int any_k(struct linear *x, double b)
{
    double ratio = 2, k = 1;
    for (double low = 1, high = 2;
         high - low > 1e-9;) { /* ratio^ACROSS = across, without a library */
        double v = 1;
        ratio = (low + high) / 2;
        for (int i = 0; i < ACROSS; i++) { v *= ratio; }
        if (v < x->across) {
            low = ratio;
        } else {
            high = ratio;
        }
    }
    for (int i = 0; i <= ACROSS; i++, k *= ratio) {
        if (linear_stable(x, k, b)) { return 1; }
    }
    return 0;
}

static double halve(
    struct linear *x, int (*any)(struct linear *x, double v), double v, double above, double most)
{
    for (int n = 0; n < 7 && above <= most; n++) {
        const double mid = (v + above) / 2;
        if (any(x, mid)) {
            v = mid;
        } else {
            above = mid;
        }
    }
    return v;
}

/* From a value that is stable: 3 % steps, looking eight of them ahead, then halves. */
static double climb(struct linear *x, int (*any)(struct linear *x, double v), double v, double most)
{
    for (int ahead = 8; v > 0 && ahead > 0; ahead--) {
        double next = v;
        for (int i = 0; i < ahead; i++) { next *= 1.03; }
        if (next > most) { next = most; }
        if (next > v && any(x, next)) {
            v = next;
            ahead = 9;
        }
    }
    return halve(x, any, v, v > 0 ? 1.03 * v : 0.5, most);
}

struct reach reach_of(const struct sim_device *d, double rate_Hz, int window)
{
    struct linear x = {d, window, rate_Hz, 0, 0, 0};
    struct reach p;
    memset(&p, 0, sizeof p);
    for (double k = 1; k <= K_MAX_NPM; k *= 1.25) {
        for (double b = 0; b <= B_MAX_NSPM; b = b > 0 ? 1.4 * b : 0.5) {
            if (!linear_stable(&x, k, b)) { continue; }
            p.k_Npm = k;
            p.b_Nspm = b > p.b_Nspm ? b : p.b_Nspm;
        }
    }
    if (p.k_Npm > 0) {
        x.across = 1.4 * p.b_Nspm + 0.5;
        p.k_Npm = climb(&x, any_b, p.k_Npm, K_MAX_NPM);
        x.from = x.at - x.across / ACROSS; /* the tip lies between two b */
        x.from = x.from > 0 ? x.from : 0;
        x.across = x.at + x.across / ACROSS;
        p.k_Npm = halve(&x, any_b, p.k_Npm, 1.01 * p.k_Npm, K_MAX_NPM);
        x.across = 1.03 * p.k_Npm;
        p.b_Nspm = climb(&x, any_k, p.b_Nspm, B_MAX_NSPM);
    }
    return p;
}
