/* SPDX-License-Identifier: MIT */
/* exhand bilateral: the same approaches with other seeds, so that no figure depends on one. */
#include "contact/bilateral.h"

#include "falls/jackknife.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SEEDS_MAX 100

/* One seed. */
struct seed {
    int done;
    struct bilateral_count finger[BILATERAL_FINGERS];
};

typedef char a_seed_fits_a_job[sizeof(struct seed) <= 1024 ? 1 : -1];

struct asked {
    const struct bilateral_options *o;
    double mps;
};

static void work(const void *ctx, int i, void *result)
{
    static struct bilateral_contact contact[BILATERAL_CONTACTS_MAX];
    const struct asked *is = ctx;
    struct bilateral_run_cfg c = bilateral_at_speed(is->o, is->mps);
    struct seed *to = result;
    struct bilateral_run r;
    c.board.seed += (uint64_t)i + 1;
    c.board.cards.how = POSIX_CARDS_NONE; /* the same bits, in a tenth of the time */
    c.blackbox = NULL;
    c.keep = 1;
    to->done = bilateral_run(&c, &r) == 0 && r.faults == 0 && !posix_interrupted();
    for (unsigned f = 0; to->done && f < BILATERAL_FINGERS; f++) {
        if (c.board.exo.fingers >> f & 1) {
            const int n = bilateral_judge(&r, f, contact, BILATERAL_CONTACTS_MAX);
            bilateral_count(&to->finger[f], contact,
                n < BILATERAL_CONTACTS_MAX ? n : BILATERAL_CONTACTS_MAX,
                bilateral_stiffness(&r, f, 0, NULL));
        }
    }
    bilateral_run_free(&r);
}

static int by_size(const void *a, const void *b)
{
    const double d = *(const double *)a - *(const double *)b;
    return d < 0 ? -1 : d > 0;
}

/* Mean of n, and half its 95 % interval; 0 of one. */
static double mean_of(const double *v, int n, double *half)
{
    double sum = 0, square = 0;
    for (int i = 0; i < n; i++) { sum += v[i]; }
    for (int i = 0; i < n; i++) { square += (v[i] - sum / n) * (v[i] - sum / n); }
    *half = n > 1 ? fall_t((size_t)n - 1) * sqrt(square / (n - 1) / n) : 0;
    return n ? sum / n : 0;
}

/* Of one finger: that of the first seed and those of the others. */
static void add(struct bilateral_count *to, const struct seed *seed, int n, unsigned f)
{
    double settle_s[SEEDS_MAX] = {0}, k_Npm[SEEDS_MAX] = {0}, r2[SEEDS_MAX], half;
    int settles = 0, lines = 0;
    for (int i = -1; i < n; i++) {
        const struct bilateral_count *c = i < 0 ? to : &seed[i].finger[f];
        if (c->settled) { settle_s[settles++] = c->settle_s; }
        if (c->line.k_Npm > 0) {
            k_Npm[lines] = c->line.k_Npm;
            r2[lines++] = c->line.r2;
        }
        if (i < 0) { continue; }
        to->contacts += c->contacts;
        to->settled += c->settled;
        to->missed += c->missed;
        to->early += c->early;
        to->late += c->late;
    }
    to->settle_s = mean_of(settle_s, settles, &half);
    to->settle_lo_s = to->settle_s - half;
    to->settle_hi_s = settles > 1 ? to->settle_s + half : 0;
    if (lines == 0) { return; }
    qsort(r2, (size_t)lines, sizeof r2[0], by_size);
    to->line.r2 = r2[lines / 2];
    to->line.k_Npm = mean_of(k_Npm, lines, &half);
    if (lines > 1) {
        to->line.lo_Npm = to->line.k_Npm - half;
        to->line.hi_Npm = to->line.k_Npm + half;
    }
}

int bilateral_seeds(
    const struct bilateral_options *o, double mps, struct bilateral_count count[BILATERAL_FINGERS])
{
    static struct seed seed[SEEDS_MAX];
    const struct asked is = {o, mps};
    const int n = (int)o->seeds - 1;
    const struct jobs jobs = {
        n, (int)o->jobs, sizeof seed[0], seed, work, &is, "seeds", posix_interrupt};
    int err;
    memset(seed, 0, sizeof seed);
    if (n <= 0) { return 0; }
    err = jobs_run(&jobs);
    for (int i = 0; err == 0 && i < n; i++) {
        if (!seed[i].done) {
            cli_complain("--seeds: the run of seed %.0f failed", (double)(o->seed + i + 1));
            err = 1;
        }
    }
    for (unsigned f = 0; err == 0 && f < BILATERAL_FINGERS; f++) { add(&count[f], seed, n, f); }
    return err;
}
