/* exhand bilateral --check: random approaches in closed loop. */
#include "bilateral.h"

#include "option.h"

#include "sim/random.h"

#include "exhand/board.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct outcome {
    int done, felt, unfrozen, early, late, missed, unplanned;
    double speed_mps, at_m, off_m;
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
static struct bilateral_run_cfg random_cfg(const struct bilateral_options *o, int i, struct outcome *out)
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
        /* A finger that gets nearer than half of d_lim's way before its freeze is too late. */
        out->early = out->felt && contact.early;
        out->unplanned = out->felt && !contact.frozen;
        out->late = out->felt && contact.off_m > 2e-3;
    }
    bilateral_run_free(&r);
}

int bilateral_check(const struct bilateral_options *o)
{
    const int n = (int)o->check;
    struct outcome *r = calloc((size_t)n, sizeof *r);
    const struct jobs jobs = {n, (int)o->jobs, sizeof *r, r, work, o, "approaches", posix_interrupt};
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
    printf("%d random approaches in closed loop: %d felt, %d before the freeze; %d missed: no plane in time\n"
           "place, less where pad and object touch: %.2f .. %.2f mm of string (%d more than 1 mm early, %d "
           "more than 2 mm late)\n", done, felt, unfrozen, missed, 1e3 * low_m, 1e3 * high_m, early, late);
    free(r);
    return ran ? ran : unfrozen || done < n ? 1 : 0;
}
