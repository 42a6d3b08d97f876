/* SPDX-License-Identifier: MIT */
#include "linear.h"

#include <string.h>

#define TWO_PI 6.283185307179586

struct linear_plant linear_one_mass(double mass_kg, double viscous_nspm, double tau_s)
{
    struct linear_plant p;
    memset(&p, 0, sizeof p);
    p.a[0][1] = 1;
    p.a[1][1] = -viscous_nspm / mass_kg;
    if (tau_s > 0) {
        p.n = 3;
        p.a[1][2] = -1 / mass_kg;
        p.a[2][2] = -1 / tau_s;
        p.b[2] = 1 / tau_s;
    } else {
        p.n = 2;
        p.b[1] = -1 / mass_kg;
    }
    return p;
}

struct linear_plant linear_two_mass(const struct sim_device *d)
{
    enum { Q, W, X, V, F }; /* rotor, its speed, mass, its speed, force of the motor */
    struct linear_plant p;
    memset(&p, 0, sizeof p);
    p.n = 5;
    p.a[Q][W] = 1;
    p.a[W][Q] = -d->cable_npm / d->rotor_kg;
    p.a[W][X] = d->cable_npm / d->rotor_kg;
    p.a[W][W] = -(d->cable_nspm + d->viscous_nspm) / d->rotor_kg;
    p.a[W][V] = d->cable_nspm / d->rotor_kg;
    p.a[W][F] = -1 / d->rotor_kg;
    p.a[X][V] = 1;
    p.a[V][Q] = d->cable_npm / d->mass_kg;
    p.a[V][X] = -d->cable_npm / d->mass_kg;
    p.a[V][W] = d->cable_nspm / d->mass_kg;
    p.a[V][V] = -d->cable_nspm / d->mass_kg;
    p.a[F][F] = -TWO_PI * d->current_hz;
    p.b[F] = TWO_PI * d->current_hz;
    return p;
}

/* --- matrices: of the plant and its input, which is one more state that does not change --- */

#define FLOW (LINEAR_PLANT + 1)
typedef double flow_matrix[FLOW][FLOW];

static double size_of(double v) { return v < 0 ? -v : v; }

/* c = a b */
static void multiply(flow_matrix c, flow_matrix a, flow_matrix b, int n)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) { c[i][j] = 0; }
        for (int k = 0; k < n; k++) {
            const double f = a[i][k];
            for (int j = 0; j < n && f != 0; j++) { c[i][j] += f * b[k][j]; }
        }
    }
}

/* The largest sum of sizes along a row. */
static double norm(flow_matrix a, int n)
{
    double most = 0;
    for (int i = 0; i < n; i++) {
        double sum = 0;
        for (int j = 0; j < n; j++) { sum += size_of(a[i][j]); }
        if (sum > most) { most = sum; }
    }
    return most;
}

/* e^(a t) = (e^(a t / 2^s))^(2^s), the inner one by Taylor at a norm below 1/2. */
struct linear_flow linear_flow(const struct linear_plant *p, double t_s)
{
    flow_matrix a, e, term, next;
    struct linear_flow f;
    const int n = p->n + 1;
    double scale = t_s;
    int squarings = 0;

    memset(a, 0, sizeof a);
    for (int i = 0; i < p->n; i++) {
        for (int j = 0; j < p->n; j++) { a[i][j] = p->a[i][j]; }
        a[i][p->n] = p->b[i];
    }
    for (; norm(a, n) * scale > 0.5; scale /= 2) { squarings++; }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            a[i][j] *= scale;
            e[i][j] = term[i][j] = i == j;
        }
    }
    for (int k = 1; k <= 16; k++) { /* 2^-16 / 16! < 1e-18 */
        multiply(next, term, a, n);
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                term[i][j] = next[i][j] / k;
                e[i][j] += term[i][j];
            }
        }
    }
    for (; squarings > 0; squarings--) {
        multiply(next, e, e, n);
        memcpy(e, next, sizeof e);
    }
    memset(&f, 0, sizeof f);
    for (int i = 0; i < p->n; i++) {
        for (int j = 0; j < p->n; j++) { f.phi[i][j] = e[i][j]; }
        f.gamma[i] = e[i][p->n];
    }
    return f;
}

/* --- one tick --- */

/* The plant over a tick, and before and after a new force begins in it: the parts that do not
 * depend on the wall, reused for many gains. */
struct tick {
    struct linear_plant p;
    double T_s, part_s;
    struct linear_flow all, before, after;
};

static const struct tick *tick_of(const struct linear_plant *p, double T_s, double part_s)
{
    static struct tick last;
    if (memcmp(&last.p, p, sizeof *p) != 0 || last.T_s != T_s || last.part_s != part_s) {
        last = (struct tick){*p, T_s, part_s, linear_flow(p, T_s), linear_flow(p, part_s),
            linear_flow(p, T_s - part_s)};
    }
    return &last;
}

int linear_monodromy(struct matrix *M, const struct linear_plant *p, const struct linear_wall *w)
{
    const double ticks = w->delay_s / w->T_s;
    const int whole = ticks < EIGEN_MAX ? (int)ticks : EIGEN_MAX;
    const double part_s = (ticks - whole) * w->T_s;
    const struct tick *const t = tick_of(p, w->T_s, part_s);
    const int u1 = p->n;           /* u[k-1]; u[k-d-1] is the last of them */
    const int q1 = u1 + whole + 1; /* q[k-1] */
    double law[EIGEN_MAX] = {0};   /* u[k] from z */

    M->n = q1 + w->window;
    if (M->n > EIGEN_MAX || w->window < 1) { return -1; }
    memset(M->m, 0, sizeof M->m);
    law[0] = w->k_Npm + w->b_Nspm / (w->window * w->T_s);
    law[M->n - 1] = -w->b_Nspm / (w->window * w->T_s);
    for (int i = 0; i < p->n; i++) {
        for (int j = 0; j < p->n; j++) {
            M->m[i][j] = t->all.phi[i][j];
            M->m[i][q1 - 1] += t->after.phi[i][j] * t->before.gamma[j];
        }
        if (whole > 0) {
            M->m[i][u1 + whole - 1] += t->after.gamma[i];
        } else {
            for (int j = 0; j < M->n; j++) { M->m[i][j] += t->after.gamma[i] * law[j]; }
        }
    }
    memcpy(M->m[u1], law, sizeof law);
    for (int i = u1 + 1; i < q1; i++) { M->m[i][i - 1] = 1; }
    M->m[q1][0] = 1;
    for (int i = q1 + 1; i < M->n; i++) { M->m[i][i - 1] = 1; }
    return 0;
}

double linear_rho(const struct sim_device *d, double T_s, double k_Npm, double b_Nspm, int window)
{
    static struct matrix M;
    const struct linear_plant p = linear_two_mass(d);
    const struct linear_wall w = {
        T_s, k_Npm, b_Nspm, d->delay_tick * T_s + d->delay_s + 0.5 / d->servo_hz, window};
    return linear_monodromy(&M, &p, &w) == 0 ? eigen_radius(&M) : -1;
}
