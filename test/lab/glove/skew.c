/* SPDX-License-Identifier: MIT */
/* exhand-lab glove --skew: what the scan's skew does to the fingertips. */
#include "lab/glove/glove.h"

#include "base/option.h"

#include "exhand/error.h"

#include <stdio.h>

#define SENSORS EXH_GLOVE_SENSORS
#define PI      3.14159265358979323846
#define RATE_HZ 2000
#define MOVES   4

struct tips {
    double m[EXH_FINGERS][3];
};

struct errors {
    double most_m, squares_m2;
    long n;
};

/* Fingertips of 22 angles by the library, whose own error is 0.01 um. Binary angles, so the
 * A/D's codes are not in it. */
static struct tips tips_of(
    const struct exh_hand_finger finger[EXH_FINGERS], const double rad[SENSORS])
{
    int32_t turn[SENSORS], joint[EXH_HAND_JOINTS];
    struct tips t;
    for (int i = 0; i < SENSORS; i++) {
        const double v = rad[i] * (4294967296.0 / (2 * PI));
        turn[i] = (int32_t)(v < 0 ? v - 0.5 : v + 0.5);
    }
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        struct exh_vec3 p;
        exh_hand_joints(&exh_hit2_map, f, turn, joint);
        exh_hand_tip(&finger[f], joint, &p);
        t.m[f][0] = p.x / 1073741824.0;
        t.m[f][1] = p.y / 1073741824.0;
        t.m[f][2] = p.z / 1073741824.0;
    }
    return t;
}

static double root(double v)
{
    double r = v > 1e-9 ? v : 1e-9;
    for (int i = 0; i < 60; i++) { r = 0.5 * (r + v / r); }
    return r;
}

static void add(struct errors *e, const struct tips *a, const struct tips *b)
{
    for (int f = 0; f < EXH_FINGERS; f++) {
        double d2 = 0;
        for (int k = 0; k < 3; k++) { d2 += (a->m[f][k] - b->m[f][k]) * (a->m[f][k] - b->m[f][k]); }
        e->squares_m2 += d2;
        e->n++;
        if (d2 > e->most_m * e->most_m) { e->most_m = root(d2); }
    }
}

/* All 22 angles at t_s, or channel i earlier[i] before it. The hand has been moved up to t_s
 * at most: curves before a movement's start are gone, but it starts at rest. */
static void angles_at(
    const struct sim_glove *g, double t_s, double first_s, double step_s, double rad[SENSORS])
{
    for (int i = 0; i < SENSORS; i++) {
        const double at_s = t_s - first_s + i * step_s;
        const double start_s = g->angle_rad[i].x.start_s;
        rad[i] = sim_curve_at(&g->angle_rad[i].x, at_s > start_s ? at_s : start_s);
    }
}

/* From flat to fist and back; errors against all channels at the tick, and in the scan's middle. */
static double grasp(const struct glove_options *o, const struct exh_hand_finger *finger,
    double move_s, double interval_s, struct errors *at_tick, struct errors *mid)
{
    struct sim_operator_par hand = sim_operator_default();
    struct sim_operator op;
    struct sim_glove g;
    hand.does = SIM_GRASP;
    hand.move_s = move_s;
    sim_operator_start(&op, &hand, &g, &o->chain, 1);
    for (long n = 1; n < (long)(MOVES * move_s * RATE_HZ); n++) {
        const double t_s = (double)n / RATE_HZ, scan_s = SENSORS * interval_s;
        double skewed[SENSORS], now[SENSORS], then[SENSORS];
        struct tips a, b, c;
        sim_operator_advance(&op, &g, t_s);
        angles_at(&g, t_s, scan_s, interval_s, skewed);
        angles_at(&g, t_s, 0, 0, now);
        angles_at(&g, t_s, scan_s - (SENSORS - 1) * interval_s / 2, 0, then);
        a = tips_of(finger, skewed);
        b = tips_of(finger, now);
        c = tips_of(finger, then);
        add(at_tick, &a, &b);
        add(mid, &a, &c);
    }
    return 1.875 * 90 / move_s;
}

int glove_skew(const struct glove_options *o)
{
    static const double interval_us[] = {4, 5, 10, 15, 20};
    static const double move_s[] = {0.5, 0.2};
    static const struct exh_hand_par par = {
        EXH_Q(20, 1000, 30), EXH_Q(16, 1000, 30), EXH_Q(12, 1000, 30), 0};
    struct exh_hand_finger finger[EXH_FINGERS];
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const int err = exh_hand_setup(&finger[f], &exh_hit2_bones[f], &par);
        if (err < 0) {
            cli_complain("hand: %s", exh_error_text(err));
            return 1;
        }
    }
    printf("Fingertips from 22 channels converted one after the other, against all 22 at once:\n"
           "at the tick the scan ends at, and in the middle of the scan (skew without delay).\n"
           "Hand from flat to fist and back, minimum jerk; A/D and noise left out; %d Hz.\n\n",
        RATE_HZ);
    printf("  one way  fastest  interval   scan   against the tick     against the middle\n"
           "                                       largest     rms      largest     rms\n"
           "        s    deg/s        us     us         um      um           um      um\n");
    for (unsigned m = 0; m < sizeof move_s / sizeof move_s[0]; m++) {
        for (unsigned k = 0; k < sizeof interval_us / sizeof interval_us[0]; k++) {
            struct errors tick = {0, 0, 0}, mid = {0, 0, 0};
            const double fastest = grasp(o, finger, move_s[m], interval_us[k] * 1e-6, &tick, &mid);
            printf("%9.1f %8.0f %9.0f %6.0f %10.1f %7.1f %12.2f %7.2f\n", move_s[m], fastest,
                interval_us[k], SENSORS * interval_us[k], tick.most_m * 1e6,
                root(tick.squares_m2 / (double)tick.n) * 1e6, mid.most_m * 1e6,
                root(mid.squares_m2 / (double)mid.n) * 1e6);
        }
    }
    return 0;
}
