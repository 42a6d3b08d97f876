/* SPDX-License-Identifier: MIT */
/* exhand advise: gains is in gains.c; freeze is d_lim and the length of the ray, for a hand and a
 * link. */
#include "advise/gains.h"

#include "base/cli.h"
#include "box/hand_need.h"
#include "box/hand_options.h"
#include "base/option.h"

#include "exhand/precontact.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct asked {
    double speed_mps, rate_Hz, scale, lag_ms, noise_mm, fps, link_ms,
        jitter_ms; /* < 0: not given */
    double object_mps, slide_mm, radius_mm, d_lim_mm, ray_mm;
};

static int32_t raw(double si, unsigned frac) { return (int32_t)floor(ldexp(si, (int)frac) + 0.5); }

static double mm(int32_t m_q30) { return ldexp(1000.0 * m_q30, -EXH_Q_POS); }

/* The options that were not given have the values of `exhand bilateral`: wall, glove and scene. */
static int fill(struct asked *a)
{
    static struct bilateral_options o;
    struct bilateral_run_cfg c;
    struct exh_precontact_need n;
    bilateral_defaults(&o);
    o.run.rate_Hz = (uint32_t)(a->rate_Hz + 0.5);
    c = bilateral_at_speed(&o, a->speed_mps);
    if (bilateral_stage(&c) < 0) { return 2; }
    n = hand_need(&c, 1, a->speed_mps);
    if (a->lag_ms < 0) { a->lag_ms = n.lag_us / 1000.0; }
    if (a->noise_mm < 0) { a->noise_mm = mm(n.noise_m_q30); }
    if (a->fps < 0) { a->fps = c.fps; }
    if (a->scale < 0) { a->scale = hand_scale(&c, EXH_INDEX, c.at_m); }
    return 0;
}

static struct exh_precontact_need need_of(const struct asked *a)
{
    const double age_ms = 1000.0 / a->fps + a->link_ms + a->jitter_ms;
    const struct exh_precontact_need n = {raw(a->speed_mps / a->scale, EXH_Q_VEL),
        (int32_t)ceil(1000.0 * a->lag_ms), raw(a->noise_mm / 1000, EXH_Q_POS),
        (int32_t)ceil(1000.0 * age_ms), raw(a->object_mps, EXH_Q_VEL),
        raw(a->slide_mm / 1000, EXH_Q_POS), raw(a->radius_mm / 1000, EXH_Q_POS)};
    return n;
}

/* What was asked about against what is wanted; 1 if it does not suffice. */
static int judge(const char *what, int enough, double has_mm, double wants_mm)
{
    if (enough) {
        printf("%s %.3f mm: enough\n", what, has_mm);
        return 0;
    }
    printf("%s %.3f mm: too little: make it %.3f mm\n", what, has_mm, wants_mm);
    return 1;
}

static int print(const struct asked *a, const struct exh_precontact_need *n,
    const struct exh_precontact_advice *advice, const struct exh_precontact_advice *own)
{
    /* To the micrometre, away from the finger, so that who takes the figure has enough. */
    const double d_lim_mm = floor(1000 * mm(advice->d_lim_m_q30)) / 1000;
    const double ray_mm = ceil(1000 * mm(own->ray_m_q30)) / 1000;
    int bad = 0;
    printf("d_lim_mm=%.3f ray_mm=%.3f age_ms=%.3f error_mm=%.3f speed_mps=%.4f\n", d_lim_mm, ray_mm,
        n->age_us / 1000.0, mm(own->error_m_q30), a->scale * ldexp(own->speed_mps_q27, -EXH_Q_VEL));
    printf("fingertip %.2f m/s, lag %.2f ms, noise %.2f mm, %.6g frames/s\n",
        ldexp(n->speed_mps_q27, -EXH_Q_VEL), n->lag_us / 1e3, mm(n->noise_m_q30), a->fps);
    if (a->d_lim_mm < 0) {
        bad |= judge("d_lim", raw(a->d_lim_mm / 1000, EXH_Q_POS) <= advice->d_lim_m_q30,
            a->d_lim_mm, d_lim_mm);
    }
    if (a->ray_mm > 0) {
        bad |= judge("ray", raw(a->ray_mm / 1000, EXH_Q_POS) >= own->ray_m_q30, a->ray_mm, ray_mm);
    }
    return bad;
}

static int advise(const struct asked *a)
{
    const struct exh_period T = {1000, (uint32_t)floor(1000 * a->rate_Hz + 0.5)};
    const struct exh_precontact_need n = need_of(a);
    struct exh_precontact_advice advice, own;
    int32_t d_lim = a->d_lim_mm < 0 ? raw(a->d_lim_mm / 1000, EXH_Q_POS) : -1;
    int err = exh_precontact_advise(&advice, &n, T, d_lim);
    if (err == 0 && a->d_lim_mm >= 0) { d_lim = advice.d_lim_m_q30 < 0 ? advice.d_lim_m_q30 : -1; }
    if (err == 0) { err = exh_precontact_advise(&own, &n, T, d_lim); }
    if (err < 0) {
        cli_complain("freeze: the answer is beyond 2 m: a slower hand, or a younger link");
        return 1;
    }
    return print(a, &n, &advice, &own);
}

static int is_about(int argc, char **argv, const char *what)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], what) == 0) { return 1; }
    }
    return 0;
}

int advise_command(int argc, char **argv, const struct gains_study *study)
{
    struct asked a = {
        .speed_mps = 0.87, .rate_Hz = 2000, .scale = -1, .lag_ms = -1, .noise_mm = -1, .fps = -1};
    const char *about[1] = {NULL};
    const struct cli_option option[] = {
        {"speed", CLI_REAL, &a.speed_mps, 0.001, 10, "MPS",
            "fastest approach, of the string (0.87)"},
        {"rate", CLI_REAL, &a.rate_Hz, 1, 20000, "HZ", "of the control loop (2000)"},
        {"scale", CLI_REAL, &a.scale, 0.125, 8, "X",
            "string metres per fingertip metre (the index before a wall)"},
        {"lag", CLI_REAL, &a.lag_ms, 0, 2000, "MS",
            "fingertip behind the string (glove and filter of `exhand bilateral`)"},
        {"noise", CLI_REAL, &a.noise_mm, 0, 100, "MM", "of the distance, peak (the same source)"},
        {"fps", CLI_REAL, &a.fps, 1, 10000, "HZ", "frames of the world a second (400)"},
        {"link", CLI_REAL, &a.link_ms, 0, 500, "MS", "latency there and back"},
        {"jitter", CLI_REAL, &a.jitter_ms, 0, 500, "MS", "largest additional delay of a packet"},
        {"object-speed", CLI_REAL, &a.object_mps, 0, 10, "MPS", "of the object"},
        {"slide", CLI_REAL, &a.slide_mm, 0, 1000, "MM",
            "distance along the surface to the contact"},
        {"radius", CLI_REAL, &a.radius_mm, 0, 1900, "MM", "of the surface; 0: a plane"},
        {"d-lim", CLI_REAL, &a.d_lim_mm, -200, -0.1, "MM", "judge this one: exit 1 if too small"},
        {"ray", CLI_REAL, &a.ray_mm, 0.1, 1900, "MM", "judge this one: exit 1 if too short"},
    };
    const struct cli_command c = {"advise", "freeze|gains [options]",
        "How far before contact q_lim must be frozen (d_lim), and how far the world must look "
        "(ray),\n"
        "so that no wall comes late: |d_lim| >= v*(T + lag) + noise, ray >= |d_lim| + v*(T + age) "
        "+ "
        "noise,\n"
        "v = speed/scale, age = 1/fps + link + jitter. error is what moves or curves meanwhile: "
        "v_object*age +\n"
        "slide^2 / (2*radius). speed is the fastest string that d_lim allows.\n"
        "Of stiffness and damping: exhand advise gains --help.",
        option, sizeof option / sizeof option[0], 1};
    int err;
    if (is_about(argc, argv, "gains")) { return gains_command(argc, argv, study); }
    err = cli_parse(&c, argc, argv, about);
    if (err) { return err == 1 ? 0 : err; }
    if (strcmp(about[0], "freeze") != 0) {
        cli_complain("%s: nothing is known about it: freeze, gains", about[0]);
        return 2;
    }
    err = fill(&a);
    return err ? err : advise(&a);
}

int cli_advise(int argc, char **argv)
{
    static const struct gains_study none = {{NULL, 0, "judge out"}, NULL, NULL, NULL};
    return advise_command(argc, argv, &none);
}
