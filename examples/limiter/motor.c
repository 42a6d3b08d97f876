/* SPDX-License-Identifier: MIT */
/* A motor behind a limiter, and what happens without: bare C over limiter.h alone.
 *
 * The motor is played: a small arm on a motor that takes a torque, 1 kHz, with a stop at 1 rad. A
 * spring law follows a target that comes over a network. Three things go wrong with it, as they do
 * with a leader that is out of sight: it jumps, the arm is held fast, and it goes silent.
 *
 *   motor > motor.csv     each case with the limiter and without, a row each 5 ms
 *
 * On standard error: the greatest torque, the fastest turn, and which cause stopped it, if one did.
 */
#define EXH_LIMITER_FLOAT /* exh_limiter_micro() */
#include "exhand/limiter.h"

#include <stdio.h>
#include <stdlib.h>

enum { RATE_Hz = 1000, STEPS = 3000, BEGINS = 1000, ROW = 5 };

/* --- the limiter's parameters: millionths of N m, rad, rad/s --- */

static const struct exh_limiter_par par = {
    .kind = EXH_LIMITER_EFFORT,
    .uses = EXH_LIMITER_POS | EXH_LIMITER_VEL | EXH_LIMITER_DEADMAN,
    .rate_milli = RATE_Hz * 1000,
    .effort_max = EXH_MICRO(5, 10),
    .effort_up_milli = EXH_MILLI(5, 1), /* 0.5 N m in 0.1 s */
    .effort_down_milli = EXH_MILLI(50, 1),
    .ramp_ms = 500,
    .release_ms = 15,
    .pos_min = EXH_MICRO(-1, 1),
    .pos_max = EXH_MICRO(1, 1),
    .pos_over = EXH_MICRO(1, 10),
    .first_max = EXH_MICRO(1, 10),
    .age_max_us = 50000,
    .gap_max_us = 20000,
    .speed_max = EXH_MICRO(6, 1),
    .speed_ms = 5,
    .stall_effort = EXH_MICRO(3, 10),
    .stall_move = EXH_MICRO(2, 1000),
    .stall_ms = 300,
};

/* --- the motor: inertia, friction, a stop --- */

struct motor {
    double q, v; /* rad, rad/s */
    int held;    /* 1: something holds it fast */
};

static void move(struct motor *m, double torque_Nm)
{
    const double T = 1.0 / RATE_Hz, J = 0.002, b = 0.004;
    const double stop = m->q > 1 ? -200 * (m->q - 1) - 0.2 * m->v : 0;
    m->v += T * (torque_Nm + stop - b * m->v) / J;
    if (m->held) { m->v = 0; }
    m->q += T * m->v;
}

/* --- the cases, and who commands --- */

enum { JUMP, STALL, SILENCE, CASES };
static const char *const names[CASES] = {"jump", "stall", "silence"};

struct target {
    double q;        /* rad */
    uint32_t age_us; /* of the last word from it */
};

static struct target target_at(int what, int step)
{
    struct target t = {0.3, 0};
    if (step < BEGINS) { return t; }
    if (what == JUMP) { t.q = 3; }
    if (what == STALL) { t.q = 0.8; }
    if (what == SILENCE) { t.age_us = (uint32_t)(step - BEGINS) * 1000; }
    return t;
}

/* A spring and a damper towards it. With a silent target the last torque stays, as a drive keeps
 * it. */
static double law(struct target t, const struct motor *m, double last)
{
    return t.age_us > 0 ? last : 2 * (t.q - m->q) - 0.05 * m->v;
}

/* --- one case --- */

struct run {
    struct motor m;
    struct exh_limiter s;
    double sent, asked, most, fastest;
    uint32_t first;
};

static double limited(struct run *r, const struct exh_limiter_cfg *cfg, int step, struct target t)
{
    struct exh_limiter_in in = {0};
    struct exh_limiter_out out;
    in.now_us = (uint32_t)step * (1000000 / RATE_Hz);
    in.command = exh_limiter_micro(r->asked);
    in.pos = exh_limiter_micro(r->m.q);
    in.vel = exh_limiter_micro(r->m.v);
    in.age_us = t.age_us;
    in.deadman = step > 0; /* a hand takes the switch */
    in.run = 1;
    exh_limiter_step(&r->s, cfg, &in, &out);
    if (r->first == 0) { r->first = out.first; }
    return out.enable ? out.send / 1e6 : 0;
}

static void run(int what, int with, const struct exh_limiter_cfg *cfg)
{
    static const struct exh_limiter none;
    struct run r = {{0.28, 0, 0}, none, 0, 0, 0, 0, 0};
    unsigned k = 0;
    for (int step = 0; step < STEPS; step++) {
        const struct target t = target_at(what, step);
        /* A push on the arm just before silence leaves a torque on. */
        if (what == SILENCE && step == BEGINS - 20) { r.m.v = -3; }
        if (what == STALL && step >= BEGINS) { r.m.held = 1; }
        r.asked = law(t, &r.m, r.asked);
        r.sent = with ? limited(&r, cfg, step, t) : r.asked;
        move(&r.m, r.sent);
        if (r.sent > r.most) { r.most = r.sent; }
        if (r.m.v > r.fastest) { r.fastest = r.m.v; }
        if (step % ROW == 0) {
            printf("%s,%d,%.3f,%.4f,%.4f,%.4f,%.4f,%d\n", names[what], with, (double)step / RATE_Hz,
                t.q, r.m.q, r.asked, r.sent, (int)r.first);
        }
    }
    while (r.first >> k > 1) { k++; }
    fprintf(stderr, "%-8s %-8s %6.3f N m at most, %6.2f rad/s at most%s%s\n", names[what],
        with ? "limited" : "bare", r.most, r.fastest, r.first ? ", stopped: " : "",
        r.first ? exh_limiter_cause_name(k) : "");
}

int main(void)
{
    static struct exh_limiter_cfg cfg;
    const int err = exh_limiter_setup(&cfg, &par);
    if (err != 0) {
        fprintf(stderr, "motor: set %s within its range (limiter.h)\n",
            exh_limiter_field_name((unsigned)(-err - 1)));
        return EXIT_FAILURE;
    }
    printf("case,limited,t_s,target_rad,q_rad,asked_nm,sent_nm,first\n");
    for (int what = 0; what < CASES; what++) {
        run(what, 0, &cfg);
        run(what, 1, &cfg);
    }
    return EXIT_SUCCESS;
}

void exh_assert_failed(const char *file, int line)
{
    fprintf(stderr, "motor: %s:%d: an assertion of the library does not hold\n", file, line);
    abort();
}
