/* SPDX-License-Identifier: MIT */
/* The exact flow, in whatever REAL is; included by flow.c and wide.c.
 *
 * In each mode (string taut or slack, each body sliding one way or the other or stuck) the plant is
 * linear. e^(A t) is kept for t = 2^-10, 2^-11 .. 2^-50 s; any time is a sum of these. A piece
 * within which the mode would change is halved until it is the shortest: the change is then known
 * to 1e-15 s. Two changes within a piece of the longest step are not seen. */
#include "method.h"

#include <stdint.h>
#include <string.h>

#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 real_wide; /* the exponentials, whatever REAL is */
#else
typedef long double real_wide;
#endif

/* S: the stretch, small where it matters, as x - q of two doubles is not. */
enum { S, V, Q, W, I, MON, REF, ONE, STATES };

#define FIRST_BIT 10 /* the longest piece is 2^-10 s */
#define LEVELS    41
#define MODES     18
#define EVENTS    1000 /* in one call: more are a mode that hunts */

struct mode {
    int taut, mass, rotor; /* which way they slide; 0: stuck */
};

static struct {
    struct sim_device d;
    struct plant_hand hand;
    int by_hand, valid;
    unsigned char known[MODES][LEVELS];
    REAL phi[MODES][LEVELS][STATES][STATES];
} f;

#pragma GCC diagnostic ignored "-Wdouble-promotion" /* to more bits is what it is for */

/* --- e^(A t) --- */

typedef real_wide matrix[STATES][STATES];

static void generator(matrix a, struct mode m)
{
    const real_wide kg = 1 / (real_wide)f.d.mass_kg, rotor = 1 / (real_wide)f.d.rotor_kg;
    const real_wide fast = 2 * 3.14159265358979323846 * (real_wide)f.d.current_hz;
    const real_wide pull[4] = {f.d.cable_npm, f.d.cable_nspm, 0, -f.d.cable_nspm};
    memset(a, 0, sizeof(matrix));
    a[I][I] = -fast;
    a[I][REF] = fast;
    if (f.d.mon_lag_s > 0) {
        a[MON][I] = 1 / (real_wide)f.d.mon_lag_s;
        a[MON][MON] = -a[MON][I];
    }
    if (m.mass) {
        a[S][V] = 1;
        for (int i = S; m.taut && i <= W; i++) {
            a[V][i] = -pull[i] * (1 + m.mass * (real_wide)f.d.mu_mass) * kg;
        }
        if (f.by_hand) {
            a[V][S] -= f.hand.k_Npm * kg;
            a[V][Q] -= f.hand.k_Npm * kg;
            a[V][V] -= f.hand.b_Nspm * kg;
            a[V][ONE] = (real_wide)f.hand.k_Npm * f.hand.x_m * kg;
        } else {
            a[V][ONE] = SIM_GRAVITY;
        }
    }
    if (m.rotor) {
        a[Q][W] = 1;
        a[S][W] = -1;
        for (int i = S; m.taut && i <= W; i++) {
            a[W][i] = pull[i] * (1 - m.rotor * (real_wide)f.d.mu_motor) * rotor;
        }
        a[W][W] -= f.d.viscous_nspm * rotor;
        a[W][I] = -f.d.kf_npa * rotor;
        a[W][ONE] = -m.rotor * f.d.coulomb_n * rotor;
    }
}

static void multiply(matrix c, matrix a, matrix b)
{
    for (int i = 0; i < STATES; i++) {
        for (int j = 0; j < STATES; j++) { c[i][j] = 0; }
        for (int k = 0; k < STATES; k++) {
            for (int j = 0; j < STATES && a[i][k] != 0; j++) { c[i][j] += a[i][k] * b[k][j]; }
        }
    }
}

static real_wide norm(matrix a)
{
    real_wide most = 0;
    for (int i = 0; i < STATES; i++) {
        real_wide sum = 0;
        for (int j = 0; j < STATES; j++) { sum += a[i][j] < 0 ? -a[i][j] : a[i][j]; }
        if (sum > most) { most = sum; }
    }
    return most;
}

/* By Taylor at a norm below 1/2 (2^-26 / 26! < 1e-34), then squared back. */
static void exponential(matrix e, matrix a, real_wide t)
{
    matrix term, next;
    int squarings = 0;
    for (; norm(a) * t > 0.5; t /= 2) { squarings++; }
    memset(e, 0, sizeof(matrix));
    for (int i = 0; i < STATES; i++) { e[i][i] = 1; }
    memcpy(term, e, sizeof term);
    for (int k = 1; k <= 26; k++) {
        multiply(next, term, a);
        for (int i = 0; i < STATES; i++) {
            for (int j = 0; j < STATES; j++) {
                term[i][j] = next[i][j] * t / k;
                e[i][j] += term[i][j];
            }
        }
    }
    for (; squarings > 0; squarings--) {
        multiply(next, e, e);
        memcpy(e, next, sizeof next);
    }
}

static void learn(int number, int level, struct mode m)
{
    matrix a, e;
    real_wide t = 1;
    for (int i = 0; i < FIRST_BIT + level; i++) { t /= 2; }
    generator(a, m);
    exponential(e, a, t);
    for (int i = 0; i < STATES; i++) {
        for (int j = 0; j < STATES; j++) { f.phi[number][level][i][j] = (REAL)e[i][j]; }
    }
    f.known[number][level] = 1;
}

/* --- the modes --- */

static REAL tension(const REAL z[])
{
    return f.d.cable_npm * z[S] + f.d.cable_nspm * (z[V] - z[W]);
}

static int pulls(const REAL z[]) { return z[S] >= 0 && tension(z) >= 0; }

/* The way of a body at speed v. At rest: the way it will go. */
static int way(REAL v, REAL net_N, REAL dry_N)
{
    if (v != 0) { return v > 0 ? 1 : -1; }
    return net_N > dry_N ? 1 : net_N < -dry_N ? -1 : 0;
}

static REAL net_mass(const REAL z[], REAL T)
{
    const REAL push = f.by_hand ? f.hand.k_Npm * (f.hand.x_m - z[Q] - z[S]) - f.hand.b_Nspm * z[V]
                                : (REAL)f.d.mass_kg * SIM_GRAVITY;
    return push - T;
}

static REAL net_rotor(const REAL z[], REAL T)
{
    return T - f.d.kf_npa * z[I] - f.d.viscous_nspm * z[W];
}

static int mass_rubs(void) { return f.d.mu_mass > 0; }

static int rotor_rubs(void) { return f.d.mu_motor > 0 || f.d.coulomb_n > 0; }

static struct mode mode_of(const REAL z[])
{
    struct mode m;
    REAL T;
    m.taut = pulls(z);
    T = m.taut ? tension(z) : 0;
    m.mass = mass_rubs() ? way(z[V], net_mass(z, T), f.d.mu_mass * T) : 1;
    m.rotor = rotor_rubs() ? way(z[W], net_rotor(z, T), f.d.coulomb_n + f.d.mu_motor * T) : 1;
    return m;
}

static int turned(int way_was, REAL v) { return way_was * v < 0; }

/* Whether the mode has ended by z. */
static int ended(const REAL z[], struct mode m)
{
    REAL T;
    if (pulls(z) != m.taut) { return 1; }
    if (mass_rubs() && turned(m.mass, z[V])) { return 1; }
    if (rotor_rubs() && turned(m.rotor, z[W])) { return 1; }
    if (m.mass && m.rotor) { return 0; }
    T = m.taut ? tension(z) : 0;
    return (!m.mass && way(0, net_mass(z, T), f.d.mu_mass * T)) ||
           (!m.rotor && way(0, net_rotor(z, T), f.d.coulomb_n + f.d.mu_motor * T));
}

/* --- a piece of time --- */

#define DOT(a, z) \
    ((a)[S] * (z)[S] + (a)[V] * (z)[V] + (a)[Q] * (z)[Q] + (a)[W] * (z)[W] + (a)[I] * (z)[I] + \
        (a)[REF] * (z)[REF] + (a)[ONE])

static void flow(REAL to[], const REAL z[], struct mode m, int level)
{
    const int number = m.taut * 9 + (m.mass + 1) * 3 + m.rotor + 1;
    REAL(*a)[STATES];
    if (!f.known[number][level]) { learn(number, level, m); }
    a = f.phi[number][level];
    to[S] = DOT(a[S], z);
    to[V] = DOT(a[V], z);
    to[Q] = DOT(a[Q], z);
    to[W] = DOT(a[W], z);
    to[I] = a[I][I] * z[I] + a[I][REF] * z[REF];
    to[MON] = a[MON][I] * z[I] + a[MON][MON] * z[MON] + a[MON][REF] * z[REF];
    to[REF] = z[REF];
    to[ONE] = 1;
}

static void prepare(const struct sim_device *d, const struct plant_hand *hand)
{
    struct sim_device same = *d;
    same.substep_s = 0; /* pieces are kept for all steps */
    if (f.valid && f.by_hand == (hand != NULL) && memcmp(&f.d, &same, sizeof same) == 0 &&
        (hand == NULL || memcmp(&f.hand, hand, sizeof *hand) == 0)) {
        return;
    }
    memset(f.known, 0, sizeof f.known);
    f.d = same;
    f.by_hand = hand != NULL;
    if (hand) { f.hand = *hand; }
    f.valid = 1;
}

/* n pieces of the shortest. */
static void advance(REAL z[], uint64_t n, int longest)
{
    struct mode m = mode_of(z);
    int level = longest, closer = 1, events = 0;
    while (n > 0) {
        REAL to[STATES];
        while (UINT64_C(1) << (LEVELS - 1 - level) > n) { level++; }
        flow(to, z, m, level);
        if (events < EVENTS && ended(to, m)) {
            closer = 1;
            if (level < LEVELS - 1) {
                level++;
                continue;
            }
            if (mass_rubs() && turned(m.mass, to[V])) { to[V] = 0; }
            if (rotor_rubs() && turned(m.rotor, to[W])) { to[W] = 0; }
            m = mode_of(to);
            level = longest;
            events++;
            n--;
        } else {
            n -= UINT64_C(1) << (LEVELS - 1 - level);
            /* Within the piece twice as long the mode ends: in its second half, then. If it has not
             * by the last of these, that is below a position's last bit, and it is looked for in
             * longer pieces. */
            if (level == LEVELS - 1) { closer = 0; }
            if (level > longest) { level += closer ? 1 : -1; }
        }
        memcpy(z, to, sizeof to);
    }
}

void FLOW_ADVANCE(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
    const struct plant_hand *hand)
{
    REAL z[STATES] = {
        (REAL)p->x_m - p->q_m, p->v_mps, p->q_m, p->w_mps, p->cur_A, p->mon_A, ref_A, 1};
    double piece_s = 1.0 / (1 << FIRST_BIT);
    int longest = 0;
    prepare(d, hand);
    for (; piece_s > d->substep_s && longest < 30; piece_s /= 2) { longest++; }
    /* Times are taken to 2^-40 s, so that no piece below is spent on a double's last bits. */
    advance(z, (uint64_t)(dt_s * 1099511627776.0 + 0.5) << 10, longest);
    p->x_m = (double)(z[Q] + z[S]);
    p->v_mps = (double)z[V];
    p->q_m = (double)z[Q];
    p->w_mps = (double)z[W];
    p->cur_A = (double)z[I];
    p->mon_A = d->mon_lag_s > 0 ? (double)z[MON] : p->cur_A;
}
