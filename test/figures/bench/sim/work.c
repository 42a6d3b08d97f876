/* SPDX-License-Identifier: MIT */
/* Work and precision of the ways to integrate the simulator's plant, on three problems.
 *
 *   work errors       problem,method,step_s,error_m,reference_m of every method and step
 *   work ns           problem,method,step_s,ns of CPU for a second of the problem
 *   work count        runs each once in work_run(), for callgrind; prints
 *                     problem,method,step_s,seconds; steps down to 2^-16 s: below, a step costs
 *                     the same
 *   work check        the reference against closed form and against known facts of a bounce
 *   --short behind it: every third step
 *
 * Steps are 2^-10 .. 2^-20 s, and the simulator's own. error_m: the largest error of mass or string
 * at any multiple of 2^-10 s. reference_m: the difference of the reference from itself with steps
 * four times as long. */
#include "method.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define POINT_S    (1.0 / 1024)
#define LONGEST    10 /* 2^-10 s */
#define SHORTEST   20
#define COUNTED    16
#define OWN        (SHORTEST + 1) /* the table's, of the simulator's method alone */
#define POINTS_MAX 1024
#define REFERENCE  16
#define LOST_M     1e3 /* worse than this is no solution */

struct problem {
    const char *name;
    int points;
    struct sim_device d;
    int by_hand;
    struct plant_hand hand;
    struct plant start;
    double ref_A;
    double k_Npm, b_Nspm; /* a wall, sampled at every point; 0: the motor is held */
};

#define PROBLEMS 3

static struct sim_device without_dry_friction(void)
{
    struct sim_device d = sim_device_default();
    d.mu_motor = d.mu_mass = d.coulomb_n = 0;
    return d;
}

/* The device's mass swings on its string, which stays taut. */
static struct problem smooth(void)
{
    struct problem p = {.name = "smooth", .points = 205, .d = without_dry_friction()};
    const double weight_N = p.d.mass_kg * SIM_GRAVITY;
    p.ref_A = p.start.cur_A = weight_N / p.d.kf_npa;
    p.start.x_m = weight_N / p.d.cable_npm + 0.5e-3;
    return p;
}

/* A string of 10^6 N/m on a rotor of 1 g; at its other end a light finger in a hand of 10^6 N/m. */
static struct problem stiff(void)
{
    struct problem p = {.name = "stiff", .points = 32, .d = without_dry_friction(), .by_hand = 1};
    const double pull_N = 5;
    p.d.cable_npm = 1e6;
    p.d.rotor_kg = 1e-3;
    p.d.mass_kg = 0.1;
    p.hand = (struct plant_hand){1e6, 5, 2 * pull_N / 1e6, 0, -1};
    p.ref_A = p.start.cur_A = pull_N / p.d.kf_npa;
    p.start.x_m = pull_N / p.d.cable_npm + 2e-6;
    return p;
}

/* The paper's mass falls 7 cm onto its wall of the row of 1 kHz: slack string, bounces, stick and
 * slip. */
static struct problem ringing(void)
{
    struct problem p = {.name = "ringing", .points = 717, .d = sim_device_default()};
    p.start.x_m = p.start.q_m = -p.d.height_m;
    p.k_Npm = 10000;
    p.b_Nspm = 40;
    return p;
}

static struct problem problem_at(int i) { return i == 0 ? smooth() : i == 1 ? stiff() : ringing(); }

static double step_at(int bit)
{
    return bit == OWN ? sim_device_default().substep_s : 1.0 / (double)(1L << bit);
}

static double size_of(double v) { return v < 0 ? -v : v; }

/* --- a run --- */

struct way {
    double x_m[POINTS_MAX], q_m[POINTS_MAX];
};
static struct way way;

static double clamp(double v, double low, double high)
{
    return v < low ? low : v > high ? high : v;
}

static void run(const struct problem *p, enum method m, double step_s)
{
    struct sim_device d = p->d;
    struct plant s = p->start;
    double ref_A = p->ref_A, was_m = s.q_m;
    d.substep_s = step_s * 1.0000001; /* so many and no step more */
    for (int i = 0; i < p->points; i++) {
        if (p->k_Npm > 0) {
            const double force_N = p->k_Npm * s.q_m + p->b_Nspm * (s.q_m - was_m) / POINT_S;
            ref_A = s.q_m < 0 ? 0 : clamp(force_N / d.kf_npa, 0, d.peak_a);
            was_m = s.q_m;
        }
        method_advance(m, &s, &d, POINT_S, ref_A, p->by_hand ? &p->hand : NULL);
        way.x_m[i] = s.x_m;
        way.q_m[i] = s.q_m;
    }
}

void work_run(const struct problem *p, enum method m, double step_s);

/* What callgrind counts, behind one that it does not: exponentials are worked out once. */
__attribute__((noinline)) void work_run(const struct problem *p, enum method m, double step_s)
{
    run(p, m, step_s);
}

static double most_off(const struct way *a, const struct way *b, int points)
{
    double most = 0;
    for (int i = 0; i < points; i++) {
        const double x = size_of(a->x_m[i] - b->x_m[i]), q = size_of(a->q_m[i] - b->q_m[i]);
        if (!(x < LOST_M && q < LOST_M)) { return LOST_M; }
        if (x > most) { most = x; }
        if (q > most) { most = q; }
    }
    return most;
}

/* --- what may be asked --- */

static int every = 1;

/* The step behind this one. */
static int next_of(int m, int bit)
{
    if (bit + every <= SHORTEST) { return bit + every; }
    return m == METHOD_LEAPFROG && bit < OWN ? OWN : OWN + 1;
}

static void errors(void)
{
    static struct way reference;
    printf("problem,method,step_s,error_m,reference_m\n");
    for (int i = 0; i < PROBLEMS; i++) {
        const struct problem p = problem_at(i);
        double own;
        run(&p, METHOD_REFERENCE, step_at(REFERENCE - 2));
        reference = way;
        run(&p, METHOD_REFERENCE, step_at(REFERENCE));
        own = most_off(&way, &reference, p.points);
        reference = way;
        for (int m = 0; m < METHODS; m++) {
            for (int bit = LONGEST; bit <= OWN; bit = next_of(m, bit)) {
                run(&p, (enum method)m, step_at(bit));
                printf("%s,%s,%.9g,%.4g,%.3g\n", p.name, method_name[m], step_at(bit),
                    most_off(&way, &reference, p.points), own);
            }
        }
    }
}

static double cpu_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The shortest of three, each as often as makes a millisecond. */
static double ns(const struct problem *p, enum method m, double step_s)
{
    double best_s = 1e9;
    int times = 1;
    run(p, m, step_s); /* what is worked out once */
    for (int tries = 0; tries < 3;) {
        const double from_s = cpu_s();
        double took_s;
        for (int i = 0; i < times; i++) { run(p, m, step_s); }
        took_s = cpu_s() - from_s;
        if (took_s < 1e-3 && times < 1 << 20) {
            times *= 2;
            continue;
        }
        if (took_s / times < best_s) { best_s = took_s / times; }
        tries++;
    }
    return 1e9 * best_s / (p->points * POINT_S);
}

static void costs(int counted)
{
    if (!counted) { printf("problem,method,step_s,ns_per_s\n"); }
    for (int i = 0; i < PROBLEMS; i++) {
        const struct problem p = problem_at(i);
        for (int m = 0; m < METHODS; m++) {
            for (int bit = LONGEST; bit <= OWN; bit = next_of(m, bit)) {
                if (counted && bit > COUNTED && bit < OWN) { continue; }
                printf("%s,%s,%.9g,%.9g\n", p.name, method_name[m], step_at(bit),
                    counted ? p.points * POINT_S : ns(&p, (enum method)m, step_at(bit)));
                if (counted) { run(&p, (enum method)m, step_at(bit)); }
                if (counted) { work_run(&p, (enum method)m, step_at(bit)); }
            }
        }
    }
}

/* --- the reference itself --- */

static int failed;

static void expect(const char *what, double got, double want, double most)
{
    const int bad = !(size_of(got - want) <= most);
    printf("%-52s %.12f, want %.12f +- %.1g: %s\n", what, got, want, most, bad ? "FAIL" : "ok");
    failed |= bad;
}

/* 0.5 kg falls 7 cm onto a wall of 20 kN/m and 60 Ns/m that can't pull: a string whose rotor cannot
 * move. Contact, separation and where it is at 0.2 s: an event-exact simulation made elsewhere. */
static void check_bounce(enum method m)
{
    struct sim_device d = without_dry_friction();
    struct plant s = {.x_m = -0.07};
    d.mass_kg = 0.5;
    d.cable_npm = 20000;
    d.cable_nspm = 60;
    d.rotor_kg = 1e15;
    d.substep_s = step_at(12);
    method_advance(m, &s, &d, 0.2, 0, NULL);
    expect("bounce: x at 0.2 s, m", s.x_m, -0.01089273, 6e-9);
    expect("bounce: v at 0.2 s, m/s", s.v_mps, 0.13971607, 6e-9);
}

/* Rubbing alone: the rotor, 0.0609 kg, slack string, 0.2 N of friction at 0.1 m/s: it stops after
 * m v^2 / 2 F, and stays. */
static void check_stop(enum method m)
{
    struct sim_device d = without_dry_friction();
    struct plant s = {.x_m = -1, .w_mps = 0.1};
    d.coulomb_n = 0.2;
    d.viscous_nspm = 0;
    d.substep_s = step_at(12);
    method_advance(m, &s, &d, 0.25, 0, NULL);
    expect("friction: way until it stops, m", s.q_m, 0.5 * d.rotor_kg * 0.01 / 0.2, 1e-13);
    expect("friction: speed then, m/s", s.w_mps, 0, 0);
}

/* The same flow in doubles and wide, and wide by other pieces. */
static void check_agreement(void)
{
    static struct way wide;
    for (int i = 0; i < PROBLEMS; i++) {
        const struct problem p = problem_at(i);
        char what[64];
        run(&p, METHOD_REFERENCE, step_at(REFERENCE));
        wide = way;
        run(&p, METHOD_FLOW, step_at(REFERENCE));
        snprintf(what, sizeof what, "%s: flow in doubles off the wide one, m", p.name);
        expect(what, most_off(&way, &wide, p.points), 0, 1e-10);
        run(&p, METHOD_RK4, step_at(SHORTEST));
        snprintf(what, sizeof what, "%s: RK4 at 2^-20 s off it, m", p.name);
        expect(what, most_off(&way, &wide, p.points), 0, i < 2 ? 1e-10 : 2e-6);
    }
}

static int check(void)
{
    check_bounce(METHOD_REFERENCE);
    check_bounce(METHOD_FLOW);
    check_stop(METHOD_REFERENCE);
    check_stop(METHOD_FLOW);
    check_agreement();
    return failed;
}

int main(int argc, char **argv)
{
    const char *const what = argc > 1 ? argv[1] : "";
    if (argc > 2 && strcmp(argv[2], "--short") == 0) { every = 3; }
    if (strcmp(what, "errors") == 0) {
        errors();
    } else if (strcmp(what, "ns") == 0 || strcmp(what, "count") == 0) {
        costs(what[0] == 'c');
    } else if (strcmp(what, "check") == 0) {
        return check();
    } else {
        fprintf(stderr, "usage: work errors|ns|count|check [--short]\n");
        return 2;
    }
    return 0;
}
