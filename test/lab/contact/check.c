/* SPDX-License-Identifier: MIT */
/* exhand-lab bilateral --check: random approaches in closed loop. */
#include "lab/contact/studies.h"

#include "box/hand_need.h"

#include "base/option.h"

#include "sim/random.h"

#include "exhand/board.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct outcome {
    int done, felt, unfrozen, early, late, missed, unplanned;
    int foreseen; /* by the advice the world looks too near, or answers too late */
    double speed_mps, at_m, off_m, want_m, ray_m, loss;
    unsigned finger;
};

static double between(struct sim_random *r, double lo, double hi)
{
    return lo + (hi - lo) * sim_random_unit(r);
}

/* As likely in each decade. */
static double decades(struct sim_random *r, double lo, double hi)
{
    return lo * exp(log(hi / lo) * sim_random_unit(r));
}

static void random_link(struct sim_random *r, struct sim_link_par *p)
{
    *p = sim_link_default();
    p->delay_s = decades(r, 1e-4, 0.3);
    p->jitter = (double)(sim_random_u64(r) % 4);
    p->jitter_s = p->delay_s * between(r, 0, 1);
    p->loss = between(r, 0, 0.6);
    p->duplicate = between(r, 0, 0.2);
    p->reorder = between(r, 0, 0.3);
    p->reorder_s = decades(r, 1e-3, 0.1);
}

/* One approach: any finger, wall, speed, hand, link and world. */
static struct bilateral_run_cfg random_cfg(
    const struct bilateral_options *o, int i, struct outcome *out)
{
    struct sim_random r = {.state = (uint64_t)o->seed * UINT64_C(0x9E3779B97F4A7C15) + (uint64_t)i};
    struct bilateral_run_cfg c = bilateral_at_speed(o, decades(&r, 0.03, 1.2));
    const unsigned f = (unsigned)(sim_random_u64(&r) % BILATERAL_FINGERS);
    c.at_m = between(&r, 0.015, 0.045);
    c.fps = decades(&r, 60, 1000);
    c.ray_m = sim_random_unit(&r) < 0.5 ? 0 : between(&r, 0.015, 0.06);
    c.board.seed = (uint64_t)o->seed * 1000003 + (uint64_t)i;
    c.board.exo.fingers = 1u << f;
    c.board.exo.path[f].approaches = 1;
    c.board.exo.path[f].hold_s = 0.1;
    c.board.exo.path[f].back_s = 0.2;
    c.board.exo.finger[f].mass_kg = decades(&r, 0.05, 0.2);
    c.board.exo.finger[f].k_Npm = decades(&r, 150, 600);
    c.board.exo.finger[f].b_Nspm = decades(&r, 2, 10);
    for (int w = 0; w < SIM_LINK_WAYS; w++) { random_link(&r, &c.board.line.way[w]); }
    c.keep = 1;
    out->finger = f;
    out->speed_mps = c.board.exo.path[f].speed_mps;
    out->at_m = c.at_m;
    return c;
}

/* The longest that what is known may be old, without loss: a state, a frame, both ways. */
static double age_s(const struct bilateral_run_cfg *c, int state_every)
{
    double s = 1 / c->fps + (1.0 + state_every) / c->rate_Hz;
    for (int w = 0; w < SIM_LINK_WAYS; w++) {
        const struct sim_link_par *p = &c->board.line.way[w];
        s += p->delay_s + (p->jitter != SIM_LINK_CONSTANT ? p->jitter_s : 0);
    }
    return s;
}

/* Whether the advice foretells that the plane may not be there in time. */
static void advise(const struct bilateral_run_cfg *c, double scale, struct outcome *out)
{
    const struct bilateral_par *par = (const void *)exh_scene_bilateral.params->active;
    const struct exh_period T = {1, c->rate_Hz};
    const double old_s = age_s(c, par->own.state_every);
    struct exh_precontact_need need;
    struct exh_precontact_advice a;
    need = hand_need(
        c, scale > 0 ? scale : 1, out->speed_mps * (1 + c->board.exo.path[out->finger].vary));
    need.age_us = old_s < 2 ? (int32_t)(1e6 * old_s) : 2000000;
    out->ray_m = c->ray_m;
    out->loss = c->board.line.way[0].loss;
    if (exh_precontact_advise(&a, &need, T, par->precontact[out->finger].d_lim_m_q30) < 0) {
        return;
    }
    out->want_m = ldexp(a.ray_m_q30, -EXH_Q_POS);
    out->foreseen =
        c->ray_m > 0 ? out->want_m > c->ray_m : old_s > c->board.exo.path[out->finger].first_s;
}

static void work(const void *ctx, int i, void *result)
{
    const struct bilateral_options *o = ctx;
    struct outcome *out = result;
    struct bilateral_run_cfg c;
    struct bilateral_run r;
    struct bilateral_contact contact;
    memset(out, 0, sizeof *out);
    c = random_cfg(o, i, out);
    if (bilateral_run(&c, &r) == 0 && bilateral_judge(&r, out->finger, &contact, 1) == 1) {
        const struct bilateral_track *t = &r.finger[out->finger];
        out->done = 1;
        out->felt = t->contacts > 0;
        out->unfrozen = t->unfrozen > 0;
        out->missed = contact.missed;
        out->off_m = contact.off_m;
        advise(&c, t->scale, out);
        /* A finger that gets nearer than half of d_lim's way before its freeze is too late. */
        out->early = out->felt && contact.early;
        out->unplanned = out->felt && !contact.frozen;
        out->late = out->felt && contact.off_m > 2e-3;
    }
    bilateral_run_free(&r);
}

/* The policy where no plane comes in time is no contact; why it did not come, the advice says. */
static void say_missed(const struct outcome *r, int n)
{
    int missed = 0, foreseen = 0, lossy = 0, cautious = 0, told = 0;
    double shortest_m = 1, longest_m = 0;
    for (int i = 0; i < n; i++) {
        told += r[i].foreseen;
        cautious += r[i].foreseen && r[i].felt;
        if (!r[i].done || r[i].felt) { continue; }
        missed++;
        foreseen += r[i].foreseen;
        lossy += !r[i].foreseen && r[i].loss > 0;
        if (r[i].foreseen && r[i].ray_m > 0) {
            if (r[i].want_m < shortest_m) { shortest_m = r[i].want_m; }
            if (r[i].want_m > longest_m) { longest_m = r[i].want_m; }
        }
    }
    if (missed == 0) { return; }
    printf("not felt: %d, %d of them foretold by the advice (the world has to see walls from %.0f "
           ".. %.0f mm, and saw them\n"
           "from 15 .. 60), %d others with packets lost, %d without; foretold and felt all the "
           "same: %d of %d\n",
        missed, foreseen, 1e3 * shortest_m, 1e3 * longest_m, lossy, missed - foreseen - lossy,
        cautious, told);
}

int bilateral_check(const struct bilateral_options *o, int64_t approaches)
{
    const int n = (int)approaches;
    struct outcome *r = calloc((size_t)n, sizeof *r);
    const struct jobs jobs = {
        n, (int)o->jobs, sizeof *r, r, work, o, "approaches", posix_interrupt};
    int done = 0, felt = 0, unfrozen = 0, early = 0, late = 0, missed = 0, ran;
    double low_m = 0, high_m = 0;
    if (r == NULL) {
        cli_complain("out of memory: fewer approaches");
        return 1;
    }
    ran = jobs_run(&jobs);
    for (int i = 0; i < n; i++) {
        done += r[i].done;
        felt += r[i].felt;
        unfrozen += r[i].unfrozen + r[i].unplanned;
        early += r[i].early;
        late += r[i].late;
        missed += r[i].missed;
        if (r[i].felt && r[i].off_m < low_m) { low_m = r[i].off_m; }
        if (r[i].felt && r[i].off_m > high_m) { high_m = r[i].off_m; }
        if (r[i].unfrozen || r[i].unplanned) {
            printf("approach %d: %s at %.3f m/s, wall at %.4f m: felt before its freeze\n", i,
                bilateral_finger_name[r[i].finger], r[i].speed_mps, r[i].at_m);
        }
    }
    printf("%d random approaches in closed loop: %d felt, %d before the freeze; %d missed: no "
           "plane in time\n"
           "place, less where pad and object touch: %.2f .. %.2f mm of string (%d more than 1 mm "
           "early, %d "
           "more than 2 mm late)\n",
        done, felt, unfrozen, missed, 1e3 * low_m, 1e3 * high_m, early, late);
    say_missed(r, n);
    free(r);
    return ran ? ran : unfrozen || done < n ? 1 : 0;
}
