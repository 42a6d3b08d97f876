/* SPDX-License-Identifier: MIT */
/* exhand-lab bilateral --remedies: what makes a contact settle and be silent. Each remedy alone, at
 * the paper's rate and gains, then the best together, over hands and speeds. */
#include "lab/contact/hands.h"
#include "lab/contact/held.h"
#include "lab/contact/nailed.h"
#include "lab/contact/studies.h"

#include "base/option.h"
#include "base/outfile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SPEEDS   3
#define KEEP     8   /* contacts of a run */
#define HELD_S   0.5 /* of the hold's end */
#define SILENT_N 0.5 /* peak to peak while held */
#define NEVER_S  1e9

#define PAPER    2000, 1, 20000, 60
#define WINDOW_2 HELD_WINDOW, 1

/* Name; rate, counts a line, k, b; estimator; damper, hysteresis, passivity, pulse. */
static const struct held_law remedy[] = {
    {"(no controller: nailed)", 0, 0, 0, 0, WINDOW_2, HELD_EVERY, 0, 0, 0, 0, 0},
    {"as the paper has it", PAPER, WINDOW_2, HELD_EVERY, 0, 0, 0, 0, 0},
    {"x4 counting", 2000, 4, 20000, 60, WINDOW_2, HELD_EVERY, 0, 0, 0, 0, 0},
    {"5 kHz, window 4", 5000, 1, 20000, 60, HELD_WINDOW, 2, HELD_EVERY, 0, 0, 0, 0, 0},
    {"10 kHz, window 8", 10000, 1, 20000, 60, HELD_WINDOW, 3, HELD_EVERY, 0, 0, 0, 0, 0},
    {"difference", PAPER, HELD_WINDOW, 0, HELD_EVERY, 0, 0, 0, 0, 0},
    {"window 4", PAPER, HELD_WINDOW, 2, HELD_EVERY, 0, 0, 0, 0, 0},
    {"pole 1 ms", PAPER, HELD_POLE, 1000, HELD_EVERY, 0, 0, 0, 0, 0},
    {"FOAW 8", PAPER, HELD_FOAW, 8, HELD_EVERY, 0, 0, 0, 0, 0},
    {"tracking 0.3 ms", PAPER, HELD_TRACK, 300, HELD_EVERY, 0, 0, 0, 0, 0},
    {"edge times", PAPER, HELD_EDGES, 16, HELD_EVERY, 0, 0, 0, 0, 0},
    {"damper deaf to one count", PAPER, WINDOW_2, HELD_STILL, 0, 0, 0, 0, 0},
    {"damper with play", PAPER, WINDOW_2, HELD_PLAY, 0, 0, 0, 0, 0},
    {"hysteresis 0.2 mm", PAPER, WINDOW_2, HELD_EVERY, 0.2e-3, 0, 0, 0, 0},
    {"passivity", PAPER, WINDOW_2, HELD_EVERY, 0, 1, 0, 0, 0},
    {"passivity, late outputs", PAPER, WINDOW_2, HELD_EVERY, 0, 2, 0, 0, 0},
    {"pulse 20 Ns/m, 5 ms", PAPER, WINDOW_2, HELD_EVERY, 0, 0, 20, 0.005, 0},
    {"2 kHz x4, difference", 2000, 4, 41000, 40, HELD_WINDOW, 0, HELD_EVERY, 0, 0, 0, 0, 0},
    {"  the same, passivity", 2000, 4, 41000, 40, HELD_WINDOW, 0, HELD_EVERY, 0, 2, 0, 0, 0},
    {"  the same, deaf to one", 2000, 4, 41000, 40, HELD_WINDOW, 0, HELD_STILL, 0, 0, 0, 0, 0},
    {"5 kHz x4, window 2", 5000, 4, 41000, 60, WINDOW_2, HELD_EVERY, 0, 0, 0, 0, 0},
    {"  the same, pulse 10 Ns/m", 5000, 4, 41000, 60, WINDOW_2, HELD_EVERY, 0, 0, 10, 0.005, 0},
    {"10 kHz x4, window 4", 10000, 4, 41000, 60, HELD_WINDOW, 2, HELD_EVERY, 0, 0, 0, 0, 0},
};
#define REMEDIES ((int)(sizeof remedy / sizeof remedy[0]))

static const char *const speed[SPEEDS] = {"slow", "natural", "fast"};

/* One hand at one speed. */
struct cell {
    int done, contacts;
    double settle_s[KEEP], ripple_N[KEEP], given_W[KEEP]; /* of each contact */
    double stiffness_Npm, r2;                             /* of all; 0: no line */
    double ticks;
};

/* Of one remedy at one speed, over all hands. */
struct over {
    int contacts, silent, never, failed, lines;
    double settle_s, ripple_N, given_W;       /* median; 95 %; 95 % */
    double stiffness_Npm, lo_Npm, hi_Npm, r2; /* medians of the hands, 95 % of the first */
    double ticks;
};

/* --- runs --- */

static void held_end(const struct bilateral_run *r, const struct bilateral_contact *k,
    const double *work_J, struct cell *to)
{
    const struct bilateral_track *t = &r->finger[EXH_INDEX];
    const size_t most = (size_t)(HELD_S * r->T.den / r->T.num);
    const size_t from = k->hold_end - k->first > most ? k->hold_end - most : k->first;
    int32_t lo = INT32_MAX, hi = INT32_MIN;
    for (size_t i = from; i < k->hold_end; i++) {
        const int32_t f = t->at[i].raw.f_des_N_q20;
        if (f < lo) { lo = f; }
        if (f > hi) { hi = f; }
    }
    to->settle_s[to->contacts] = k->settle_s >= 0 ? k->settle_s : NEVER_S;
    to->ripple_N[to->contacts] = ldexp((double)hi - lo, -EXH_Q_FORCE);
    to->given_W[to->contacts++] = (work_J[k->hold_end - 1] - work_J[from]) / HELD_S;
}

struct study {
    const struct bilateral_options *o;
    int first, n; /* remedies */
    int hands;    /* HANDS, or 1: that of the options */
};

static void nailed(const struct bilateral_run_cfg *c, struct cell *to)
{
    to->contacts = nailed_settle(c, to->settle_s, KEEP);
    to->done = !posix_interrupted();
    for (int k = 0; k < to->contacts; k++) {
        if (to->settle_s[k] < 0) { to->settle_s[k] = NEVER_S; }
    }
}

static void controlled(
    const struct held_law *law, const struct bilateral_run_cfg *c, struct cell *to)
{
    static struct bilateral_contact contact[KEEP];
    struct bilateral_run r;
    struct bilateral_line line;
    double *work_J = NULL;
    int n = 0;
    if (held_run(law, c, &r, &work_J) == 0) {
        to->done = !posix_interrupted();
        to->ticks = (double)r.ticks;
        n = bilateral_judge(&r, EXH_INDEX, contact, KEEP);
        line = bilateral_stiffness(&r, EXH_INDEX, 0, NULL);
        to->stiffness_Npm = line.k_Npm;
        to->r2 = line.r2;
    }
    for (int k = 0; k < n && k < KEEP; k++) {
        if (contact[k].t_s > 0) { held_end(&r, &contact[k], work_J, to); }
    }
    bilateral_run_free(&r);
    free(work_J);
}

static void work(const void *ctx, int i, void *result)
{
    const struct study *is = ctx;
    const struct held_law *law = &remedy[is->first + i / SPEEDS / is->hands];
    const int hand = i / SPEEDS % is->hands;
    struct bilateral_run_cfg c = bilateral_at_speed(is->o, sim_path_speed(speed[i % SPEEDS]));
    memset(result, 0, sizeof(struct cell));
    if (is->hands == HANDS) { lab_hand(&c, hand, NULL); }
    c.board.seed += (uint64_t)hand;
    if (law->rate_Hz) {
        controlled(law, &c, result);
    } else {
        nailed(&c, result);
    }
}

/* --- over hands --- */

static int by_size(const void *a, const void *b)
{
    const double d = *(const double *)a - *(const double *)b;
    return d < 0 ? -1 : d > 0;
}

/* The value that so large a share does not exceed. Sorts. */
static double within(double *v, int n, double share)
{
    qsort(v, (size_t)n, sizeof *v, by_size);
    return n ? v[(int)ceil(share * n) - 1] : 0;
}

/* The median, and the order statistics that hold that of all hands in 95 %. */
static void median_of(double *v, int n, struct over *to)
{
    const double off = 0.98 * sqrt(n);
    to->stiffness_Npm = within(v, n, 0.5);
    if (n == 0) { return; }
    to->lo_Npm = v[(int)fmax(0, floor(0.5 * n - off))];
    to->hi_Npm = v[(int)fmin(n - 1, ceil(0.5 * n + off))];
}

static struct over over_hands(const struct cell *cell, int hands, int v)
{
    static double settle[HANDS], stiff[HANDS], r2[HANDS], ripple[HANDS * KEEP], given[HANDS * KEEP];
    struct over to = {0};
    for (int h = 0; h < hands; h++) {
        struct cell c = cell[h * SPEEDS + v];
        to.failed += !c.done;
        to.ticks += c.ticks;
        for (int k = 0; k < c.contacts; k++) {
            ripple[to.contacts] = c.ripple_N[k];
            given[to.contacts++] = c.given_W[k];
            to.silent += c.ripple_N[k] <= SILENT_N;
            to.never += c.settle_s[k] >= NEVER_S;
        }
        settle[h] = c.contacts ? within(c.settle_s, c.contacts, 0.5) : NEVER_S;
        if (c.stiffness_Npm > 0) {
            r2[to.lines] = c.r2;
            stiff[to.lines++] = c.stiffness_Npm;
        }
    }
    to.settle_s = within(settle, hands, 0.5);
    to.ripple_N = within(ripple, to.contacts, 0.95);
    to.given_W = within(given, to.contacts, 0.95);
    to.r2 = within(r2, to.lines, 0.5);
    median_of(stiff, to.lines, &to);
    return to;
}

/* --- the table --- */

static void print_ms(double s)
{
    if (s < NEVER_S) {
        printf(" %6.0f |", 1e3 * s);
    } else {
        printf("  never |");
    }
}

static void print_row(const struct held_law *l, const struct over *v)
{
    const struct over *slow = &v[0], *natural = &v[1];
    if (l->rate_Hz == 0) {
        printf("| %-25s | | | | |", l->name);
        for (int k = 1; k < SPEEDS; k++) { print_ms(v[k].settle_s); }
        printf(" | | | | | | | | |\n");
        return;
    }
    printf("| %-25s | %5.0f | x%d | %5.0f | %4.0f |", l->name, (double)l->rate_Hz, l->decode,
        l->k_Npm, l->b_Nspm);
    for (int k = 1; k < SPEEDS; k++) { print_ms(v[k].settle_s); }
    printf(" %3.0f %% | %6.0f | %6.0f..%-6.0f | %.2f |", 100.0 * natural->never / natural->contacts,
        natural->stiffness_Npm, natural->lo_Npm, natural->hi_Npm, natural->r2);
    printf(" %5.2f |", slow->ripple_N);
    for (int k = 0; k < SPEEDS; k++) {
        printf(" %3.0f %% |", floor(100.0 * v[k].silent / v[k].contacts));
    }
    printf(" %6.1f |\n", fmax(0, 1e3 * slow->given_W));
}

static void print_head(void)
{
    printf(
        "| remedy                    |    Hz |    |     k |    b | settled, natural, ms | fast, ms "
        "| never, natural | stiffness, natural | 95 %% | r2 | ripple, slow, N | silent, slow | "
        "natural | fast | given, slow, mW |\n"
        "|--|--:|--|--:|--:|--:|--:|--:|--:|:-:|--:|--:|--:|--:|--:|--:|\n");
}

static int write_csv(
    const struct bilateral_options *o, const struct study *is, const struct over (*over)[SPEEDS])
{
    FILE *f = o->out ? bilateral_out_file(o->out, "remedies.csv") : NULL;
    if (f == NULL) { return o->out != NULL; }
    fprintf(f, "remedy,rate_hz,decode,k_n_per_m,b_ns_per_m,speed,contacts,settle_s,never,"
               "stiffness_n_per_m,low_n_per_m,high_n_per_m,r2,ripple_n,silent,given_w,ticks\n");
    for (int i = 0; i < is->n; i++) {
        const struct held_law *l = &remedy[is->first + i];
        for (int v = 0; v < SPEEDS; v++) {
            const struct over *w = &over[i][v];
            fprintf(f, "\"%s\",%u,%d,%g,%g,%s,%d,", l->name, (unsigned)l->rate_Hz, l->decode,
                l->k_Npm, l->b_Nspm, speed[v], w->contacts);
            if (w->settle_s < NEVER_S) { fprintf(f, "%.6g", w->settle_s); }
            fprintf(f, ",%d,%.6g,%.6g,%.6g,%.4g,%.6g,%d,%.6g,%.0f\n", w->never, w->stiffness_Npm,
                w->lo_Npm, w->hi_Npm, w->r2, w->ripple_N, w->silent, w->given_W, w->ticks);
        }
    }
    return outfile_close(f);
}

/* --- who asks --- */

int bilateral_remedies(const struct bilateral_options *o, int64_t which)
{
    static struct over over[REMEDIES][SPEEDS];
    const struct study is = {
        o, which ? (int)which - 1 : 0, which ? 1 : REMEDIES, which ? 1 : HANDS};
    struct cell *cell;
    struct jobs jobs = {is.n * is.hands * SPEEDS, (int)o->jobs, sizeof *cell, NULL, work, &is,
        "runs", posix_interrupt};
    int err, failed = 0;
    if (which > REMEDIES) {
        cli_complain("--remedies: %d: there are %d", (int)which, REMEDIES);
        return 2;
    }
    jobs.result = cell = calloc((size_t)jobs.n, sizeof *cell);
    err = cell ? jobs_run(&jobs) : 1;
    if (err == 0) { print_head(); }
    for (int i = 0; err == 0 && i < is.n; i++) {
        for (int v = 0; v < SPEEDS; v++) {
            over[i][v] = over_hands(&cell[i * is.hands * SPEEDS], is.hands, v);
            failed += over[i][v].failed;
        }
        if (!failed) { print_row(&remedy[is.first + i], over[i]); }
    }
    free(cell);
    if (err == 0 && failed) {
        cli_complain("--remedies: %d runs of %d failed", failed, jobs.n);
        err = 1;
    }
    return err ? err : write_csv(o, &is, (const struct over(*)[SPEEDS])over);
}
