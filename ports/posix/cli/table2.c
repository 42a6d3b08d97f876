#include "table2.h"

#include <string.h>

const struct table2_row table2_paper[TABLE2_ROWS] = {
    {90, 1500, 0, 1374},    {100, 2000, 0, 1506},     {200, 2000, 15, 7203},
    {500, 6000, 20, 11977}, {1000, 10000, 40, 18936}, {2000, 20000, 60, 50004},
};

const struct table2_row *table2_at(double rate_Hz)
{
    for (int i = 0; i < TABLE2_ROWS; i++) {
        if (table2_paper[i].rate_Hz == rate_Hz) { return &table2_paper[i]; }
    }
    return NULL;
}

const struct table2_row *table2_gains(double rate_Hz)
{
    int i = TABLE2_ROWS - 1;
    while (i > 0 && table2_paper[i].rate_Hz > rate_Hz) { i--; }
    return &table2_paper[i];
}

/* --- one run --- */

static void judge_rest(const struct run *run, double step_m, struct table2_result *r)
{
    struct fall_rest rest[1000];
    struct fall_rest_opt opt = fall_rest_opt_default;
    struct fall_contacts contacts;

    opt.encoder_step_m = step_m;
    r->falls = (int)run->log.falls;
    if (run->log.falls > sizeof rest / sizeof rest[0] ||
        fall_dissect(&run->log, 1, &contacts) != FALL_OK) {
        r->error = 1;
        return;
    }
    if (fall_rest(&run->log, &contacts, &opt, rest) != FALL_OK) { r->error = 1; }
    for (size_t i = 0; r->error == 0 && i < run->log.falls; i++) {
        r->oscillating += rest[i].rest == FALL_OSCILLATES;
        r->buzzing += rest[i].rest == FALL_BUZZ;
        r->incomplete += rest[i].rest == FALL_INCOMPLETE;
    }
    fall_contacts_free(&contacts);
}

static void write_plot(const struct fall_stiffness *s, const char *prefix)
{
    char name[3][512];
    const struct fall_plot_paths paths = {name[0], name[1], name[2]};
    snprintf(name[0], sizeof name[0], "%s_raw.csv", prefix);
    snprintf(name[1], sizeof name[1], "%s_averaged.csv", prefix);
    snprintf(name[2], sizeof name[2], "%s_line.csv", prefix);
    if (fall_write_plot(s, FALL_B, &paths) != FALL_OK) {
        fprintf(stderr, "%s: can't be written\n", name[0]);
    }
}

/* The first fall by itself, for the picture over time. */
static void write_fall(const struct fall_log *log, const char *prefix)
{
    char name[512];
    const size_t end = log->falls > 1 ? log->start[1] : log->samples;
    FILE *f;
    snprintf(name, sizeof name, "%s_fall.csv", prefix);
    f = log->falls > 0 ? fopen(name, "w") : NULL;
    if (f == NULL) {
        fprintf(stderr, "%s: can't be written\n", name);
        return;
    }
    fprintf(f, "t_s,q_m,qd_m_per_s,f_des_n,i_des_a,c,f_mon_n\n");
    for (size_t i = log->start[0]; i < end; i++) {
        const struct fall_sample *s = &log->sample[i];
        fprintf(f, "%.9f,%.9g,%.9g,%.9g,%.9g,%d,%.9g\n", s->t_s, s->q_m, s->qd_mps, s->f_des_N,
                s->i_des_A, s->c, s->f_mon_N);
    }
    fclose(f);
}

static void judge_stiffness(const struct run *run, size_t replicates, const char *plot_prefix,
                            struct table2_result *r)
{
    struct fall_opt opt = fall_opt_default;
    struct fall_stiffness s;

    opt.replicates = replicates;
    if (fall_stiffness(&run->log, &opt, &s) != FALL_OK) { r->error = 1; }
    if (s.fit.status == FALL_OK) {
        r->b_Npm = s.fit.b_Npm;
        r->a_Npm = s.fit.a_Npm;
        r->r2 = s.fit.r2;
        r->ci_low_Npm = s.b.lo_Npm;
        r->ci_high_Npm = s.b.hi_Npm;
        r->ci_bounded = s.b.status == FALL_OK;
    }
    if (plot_prefix != NULL && r->error == 0) {
        write_plot(&s, plot_prefix);
        write_fall(&run->log, plot_prefix);
    }
    fall_stiffness_free(&s);
    opt.lag = 0;
    opt.replicates = 0;
    if (fall_stiffness(&run->log, &opt, &s) != FALL_OK) { r->error = 1; }
    r->b_same_Npm = s.fit.b_Npm;
    r->a_same_Npm = s.fit.a_Npm;
    fall_stiffness_free(&s);
}

struct table2_result table2_measure(const struct run_cfg *c, size_t replicates,
                                    const char *plot_prefix)
{
    struct table2_result r;
    struct run run;

    memset(&r, 0, sizeof r);
    r.rate_Hz = c->rate_Hz;
    r.k_Npm = c->k_Npm;
    r.b_Nspm = c->b_Nspm;
    r.error = run_drop(c, &run) < 0;
    if (r.error == 0) {
        r.rate_Hz = (double)run.T.den / run.T.num;
        judge_rest(&run, c->board.device.step_m / c->board.device.decode, &r);
        judge_stiffness(&run, replicates, plot_prefix, &r);
        r.limited = run.ticks ? (double)run.limited / (double)run.ticks : 0;
        r.sim_s = (double)run.ticks / r.rate_Hz;
        r.faults = run.faults;
        r.lost = run.lost;
    }
    run_free(&run);
    return r;
}

/* --- many runs --- */

/* The value below which the share p of n values lies; sorts them. */
static double percentile(double *v, int n, double p)
{
    const double at = p * (n - 1);
    const int i = (int)at;
    for (int a = 1; a < n; a++) {
        const double x = v[a];
        int b = a;
        for (; b > 0 && v[b - 1] > x; b--) { v[b] = v[b - 1]; }
        v[b] = x;
    }
    return i + 1 < n ? v[i] + (at - i) * (v[i + 1] - v[i]) : v[n - 1];
}

#define RUNS_MAX 1000

struct table2_spread table2_spread(const struct table2_result *at_1, const struct table2_result *at_15,
                                   int runs)
{
    static double v[4][RUNS_MAX];
    struct table2_spread s;
    int falls[2] = {0, 0}, oscillating[2] = {0, 0};

    memset(&s, 0, sizeof s);
    s.runs = runs < RUNS_MAX ? runs : RUNS_MAX;
    for (int i = 0; i < s.runs; i++) {
        v[0][i] = at_1[i].b_Npm;
        v[1][i] = at_1[i].a_Npm;
        v[2][i] = at_1[i].b_same_Npm;
        v[3][i] = at_1[i].a_same_Npm;
        falls[0] += at_1[i].falls;
        falls[1] += at_15[i].falls;
        /* What was not seen to come to rest has not come to rest. */
        oscillating[0] += at_1[i].oscillating + at_1[i].incomplete;
        oscillating[1] += at_15[i].oscillating;
    }
    s.b_Npm = percentile(v[0], s.runs, 0.5);
    s.b_low_Npm = percentile(v[0], s.runs, 0.05);
    s.b_high_Npm = percentile(v[0], s.runs, 0.95);
    s.a_Npm = percentile(v[1], s.runs, 0.5);
    s.b_same_Npm = percentile(v[2], s.runs, 0.5);
    s.a_same_Npm = percentile(v[3], s.runs, 0.5);
    s.rest = falls[0] ? 1 - (double)oscillating[0] / falls[0] : 0;
    s.oscillates = falls[1] ? (double)oscillating[1] / falls[1] : 0;
    return s;
}

/* --- out --- */

void table2_csv_header(FILE *f)
{
    fprintf(f, "rate_hz,k_n_per_m,b_ns_per_m,stiffness_a_n_per_m,stiffness_b_n_per_m,ci_low,"
               "ci_high,r2,oscillating_falls,falls,paper_n_per_m,ratio\n");
}

/* A value, or an empty field where there is none. */
static void field(FILE *f, int known, double v)
{
    fputc(',', f);
    if (known) { fprintf(f, "%.6g", v); }
}

void table2_csv_line(FILE *f, const struct table2_result *r)
{
    const struct table2_row *paper = table2_at(r->rate_Hz);
    fprintf(f, "%.9g,%.9g,%.9g", r->rate_Hz, r->k_Npm, r->b_Nspm);
    field(f, r->a_Npm > 0, r->a_Npm);
    field(f, r->b_Npm > 0, r->b_Npm);
    field(f, r->ci_low_Npm > 0, r->ci_low_Npm);
    field(f, r->ci_bounded, r->ci_high_Npm);
    fprintf(f, ",%.4f,%d,%d", r->r2, r->oscillating, r->falls);
    field(f, paper != NULL, paper ? paper->stiffness_Npm : 0);
    field(f, paper != NULL && r->b_Npm > 0, paper ? r->b_Npm / paper->stiffness_Npm : 0);
    fputc('\n', f);
}

void table2_spread_csv_header(FILE *f)
{
    fprintf(f, "rate_hz,k_n_per_m,b_ns_per_m,runs,median_b_n_per_m,low_b_n_per_m,high_b_n_per_m,"
               "median_a_n_per_m,median_b_same_tick_n_per_m,median_a_same_tick_n_per_m,rest_share,"
               "oscillating_share_at_1_5x\n");
}

void table2_spread_csv_line(FILE *f, const struct table2_result *r, const struct table2_spread *s)
{
    const double value[] = {s->b_Npm, s->b_low_Npm, s->b_high_Npm};
    fprintf(f, "%.9g,%.9g,%.9g,%d", r->rate_Hz, r->k_Npm, r->b_Nspm, s->runs);
    for (int i = 0; i < 3; i++) { field(f, value[i] > 0, value[i]); }
    field(f, 1, s->a_Npm);
    field(f, s->b_same_Npm > 0, s->b_same_Npm);
    field(f, 1, s->a_same_Npm);
    fprintf(f, ",%.4f,%.4f\n", s->rest, s->oscillates);
}

static void print_runs(FILE *f, const struct table2_result *r, int rows)
{
    fprintf(f, "\nOne run of %d falls a rate, beside the paper's Table II "
               "(B: position over force, monitor paired to the tick it answers)\n\n"
               "  rate      k      b   stiffness     95 %% interval      r2   oscillating  buzz   paper   "
               "ours/paper\n"
               "    Hz    N/m   Ns/m         N/m               N/m                  falls           N/m\n",
            r->falls);
    for (int i = 0; i < rows; i++, r++) {
        const struct table2_row *paper = table2_at(r->rate_Hz);
        char interval[40], ratio[20] = "-", theirs[20] = "-";
        snprintf(interval, sizeof interval, "%.0f..", r->ci_low_Npm);
        if (r->ci_bounded) {
            snprintf(interval + strlen(interval), sizeof interval - strlen(interval), "%.0f",
                     r->ci_high_Npm);
        }
        if (paper) {
            snprintf(theirs, sizeof theirs, "%.0f", paper->stiffness_Npm);
            snprintf(ratio, sizeof ratio, "%.2f", r->b_Npm / paper->stiffness_Npm);
        }
        fprintf(f, "%6.6g %6.6g %6.6g %11.0f %17s %7.2f %7d of %-3d %5d %7s %12s\n", r->rate_Hz,
                r->k_Npm, r->b_Nspm, r->b_Npm, interval, r->r2, r->oscillating, r->falls, r->buzzing,
                theirs, ratio);
    }
}

/* A stiffness, or a dash where force does not rise with position. */
static const char *stiffness_text(char text[24], double v)
{
    if (v > 0) {
        snprintf(text, 24, "%.0f", v);
    } else {
        strcpy(text, "-");
    }
    return text;
}

static void print_spread(FILE *f, const struct table2_result *r, const struct table2_spread *s,
                         int rows)
{
    fprintf(f, "\n%d further runs a rate: one run is one draw of this\n\n"
               "  rate   median B  5 %%..95 %% of runs  B/k | median A   B same tick   A same tick |"
               " at rest   1.5x gains oscillate\n",
            s->runs);
    for (int i = 0; i < rows; i++, r++, s++) {
        char range[40], a[24], b_same[24], a_same[24];
        snprintf(range, sizeof range, "%.0f..%.0f", s->b_low_Npm, s->b_high_Npm);
        fprintf(f, "%6.6g %10.0f %18s %5.2f |%9s %13s %13s |%6.1f %% %17.1f %%\n", r->rate_Hz,
                s->b_Npm, range, s->b_Npm / r->k_Npm, stiffness_text(a, s->a_Npm),
                stiffness_text(b_same, s->b_same_Npm), stiffness_text(a_same, s->a_same_Npm),
                100 * s->rest, 100 * s->oscillates);
    }
}

/* One honest sentence per row that misses the paper by more than a tenth. */
static void print_deviation(FILE *f, const struct table2_result *r)
{
    const struct table2_row *paper = table2_at(r->rate_Hz);
    const double ratio = paper ? r->b_Npm / paper->stiffness_Npm : 1;
    if (paper == NULL || (ratio > 0.9 && ratio < 1.1)) { return; }
    fprintf(f, "  %g Hz: ours %.2f k, the paper's %.2f k: ", r->rate_Hz, r->b_Npm / r->k_Npm,
            paper->stiffness_Npm / paper->k_Npm);
    if (r->b_Npm <= 0) {
        fprintf(f, "no line could be fitted (too few pairs between 0.8 and 4.5 N).\n");
    } else if (r->b_Nspm == 0) {
        fprintf(f, "without damping the command is k q, so the fit returns k whatever the device; "
                   "what took the paper's below k is not in this model.\n");
    } else if (r->ci_bounded && paper->stiffness_Npm <= r->ci_high_Npm &&
               paper->stiffness_Npm >= r->ci_low_Npm) {
        fprintf(f, "inside our 95 %% interval; ten falls do not settle it.\n");
    } else {
        fprintf(f, "the excess over k is damper force and ringing, and these hang on friction, inertia "
                   "and delay of a device nobody has published.\n");
    }
}

void table2_print(FILE *f, const struct table2_result *r, const struct table2_spread *s, int rows)
{
    const struct table2_result *slow = NULL, *fast = NULL;
    print_runs(f, r, rows);
    if (s != NULL) { print_spread(f, r, s, rows); }
    for (int i = 0; i < rows; i++) {
        if (r[i].rate_Hz == 90) { slow = &r[i]; }
        if (r[i].rate_Hz == 2000) { fast = &r[i]; }
    }
    if (slow && fast && slow->b_Npm > 0) {
        fprintf(f, "\nStiffness at 2000 Hz over 90 Hz: %.1f (paper 36).\n", fast->b_Npm / slow->b_Npm);
    }
    fprintf(f, "\nWhere ours differs from the paper by more than a tenth, and why:\n");
    for (int i = 0; i < rows; i++) { print_deviation(f, &r[i]); }
    fprintf(f, "  All: the device is simulated; its friction, inertia and delay were fitted so that the "
               "paper's points rest and 1.5x does not.\n");
}
