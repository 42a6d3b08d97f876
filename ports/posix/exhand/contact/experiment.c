/* SPDX-License-Identifier: MIT */
/* exhand bilateral: three speeds, run, judged, printed, written. */
#include "contact/bilateral.h"

#include "base/names.h"
#include "base/option.h"
#include "base/outfile.h"
#include "base/outlog.h"
#include "box/hand_need.h"
#include "box/world_line.h"

#include <stdlib.h>
#include <string.h>

/* As many as `exhand drop` runs by default. */
#define LOCAL_RUNS 20

static void judge(const struct bilateral_run_cfg *c, const struct bilateral_run *r, unsigned f,
    const char *plot, struct bilateral_result *out)
{
    const double touch_m = r->finger[f].touch_m;
    const int n = bilateral_judge(r, f, out->contact, BILATERAL_CONTACTS_MAX);
    out->finger = f;
    out->contacts = n < BILATERAL_CONTACTS_MAX ? n : BILATERAL_CONTACTS_MAX;
    out->refused = r->finger[f].refused;
    out->scale = hand_scale(c, f, touch_m > 0 ? touch_m : c->at_m);
    bilateral_count(&out->count, out->contact, out->contacts, bilateral_stiffness(r, f, 0, plot));
    out->drawn_Npm = out->count.line.k_Npm;
}

static void local_run(const void *ctx, int i, void *result)
{
    struct run_cfg c = *(const struct run_cfg *)ctx;
    c.board.seed += (uint64_t)i;
    *(struct table2_result *)result = table2_measure(&c, NULL, TABLE2_SAME);
}

/* The drop experiment at the same rate and gains, with a random wall in each run. */
static int local_runs(const struct bilateral_options *o, struct table2_runs *out)
{
    struct run_cfg c = {.rate_Hz = o->run.rate_Hz, .k_Npm = o->run.k_Npm, .b_Nspm = o->run.b_Nspm};
    static struct table2_result r[LOCAL_RUNS];
    const struct jobs jobs = {
        LOCAL_RUNS, (int)o->jobs, sizeof r[0], r, local_run, &c, "falls", posix_interrupt};
    int err;
    memset(out, 0, sizeof *out);
    if (o->udp || c.k_Npm < 0 || c.b_Nspm < 0) { return 0; } /* of what, is not known here */
    c.board = posix_config_default();
    c.board.device = o->run.board.device;
    c.board.falls = 10;
    c.board.seed = (uint64_t)o->seed;
    c.wall = RUN_WALL_DRAWN;
    err = jobs_run(&jobs);
    if (err == 0) { *out = table2_runs(r, NULL, LOCAL_RUNS); }
    return err;
}

/* The same approaches over a perfect link: which fingers had every bit of theirs. */
static void print_beside_perfect(
    const struct bilateral_run_cfg *given, const struct bilateral_run *r)
{
    struct bilateral_run_cfg c = *given;
    struct bilateral_run perfect;
    c.board.log = NULL;
    c.blackbox = NULL;
    c.keep = 0;
    c.board.line = posix_line_default();
    c.from_s = c.again_s = 0;
    c.until_s = 1e30;
    if (bilateral_run(&c, &perfect) == 0) {
        printf("  beside a perfect link:");
        for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
            const struct bilateral_track *a = &r->finger[f], *b = &perfect.finger[f];
            if (!(c.board.exo.fingers >> f & 1)) { continue; }
            printf(" %s %s;", bilateral_finger_name[f],
                a->freezes == 0          ? "felt nothing"
                : a->digest == b->digest ? "the same bits from the first freeze on"
                                         : "not the same");
        }
        printf("\n");
    }
    bilateral_run_free(&perfect);
}

/* The files of a speed: its log, and a black box should it fault. */
static int open_log(const struct bilateral_options *o, int i, struct bilateral_run_cfg *c,
    char *path, char *fault, size_t cap)
{
    if (o->out == NULL) { return 0; }
    if (c->blackbox == NULL) {
        bilateral_out_name(fault, cap, o->out, o->speed[i].name, -1, "_fault.exh");
        c->blackbox = fault;
    }
    bilateral_out_name(path, cap, o->out, o->speed[i].name, -1, ".exh");
    c->board.log = outfile_open("out", path);
    return c->board.log == NULL;
}

/* Each finger in use: judged, printed, its table written. */
static int judge_fingers(const struct bilateral_options *o, int i, const struct bilateral_run *r,
    unsigned fingers, struct bilateral_result *result, int *n)
{
    char path[1024];
    int err = 0;
    for (unsigned f = 0; err == 0 && f < BILATERAL_FINGERS; f++) {
        struct bilateral_result *to = &result[*n];
        if (!(fingers >> f & 1)) { continue; }
        bilateral_out_name(path, sizeof path, o->out, o->speed[i].name, (int)f, "");
        to->speed = &o->speed[i];
        to->contact = calloc(BILATERAL_CONTACTS_MAX, sizeof *to->contact);
        if (to->contact == NULL) { return 1; }
        judge(&o->run, r, f, o->out ? path : NULL, to);
        bilateral_print(stdout, to);
        if (o->out) { err = bilateral_out_csv(o->out, r, f, o->speed[i].name); }
        if (r->finger[f].unfrozen) {
            cli_complain("%s, %s: %ld ticks of contact before its freeze", to->speed->name,
                bilateral_finger_name[f], r->finger[f].unfrozen);
            err = 1;
        }
        ++*n;
    }
    return err;
}

/* What the run was like beside its contacts. */
static void print_run(const struct bilateral_options *o, const struct bilateral_run_cfg *c,
    const struct bilateral_run *r)
{
    printf("  packets: %d came, %d missing, %d reordered, %d duplicate, %d too old, %d "
           "refused; newest trip "
           "%.1f ms\n",
        r->box.accepted, r->box.missing, r->box.reordered, r->box.duplicate, r->box.old,
        r->box.corrupt + r->box.version + r->box.unknown + r->box.stranger, r->box.trip_us / 1e3);
    if (r->refused) {
        printf(
            "  materials: %d of %d values asked for were refused (at this rate the rule of gains "
            "may be narrower): the box's own hold\n",
            r->refused, r->params);
    }
    if (c->trace_every) {
        printf("  trace: %lu frames of every %d ticks, ticks %lu to %lu; %lu missed\n",
            (unsigned long)r->trace.frames, c->trace_every, (unsigned long)r->trace.first_tick,
            (unsigned long)r->trace.last_tick, (unsigned long)r->trace.missed);
    }
    if (o->scene || o->record || o->udp) {
        bilateral_print_session(stdout, r, c->board.exo.fingers);
    }
    if (o->udp == NULL && (strcmp(o->link, "none") != 0 || c->from_s > 0 || c->until_s < 1e29)) {
        print_beside_perfect(c, r);
    }
}

/* What one seed gave is chance: the others, for those results. */
static int more_seeds(
    const struct bilateral_options *o, int i, struct bilateral_result *result, int n)
{
    struct bilateral_count count[BILATERAL_FINGERS] = {{0}};
    int err;
    if (o->udp || o->record || posix_interrupted()) { return 0; }
    for (int k = 0; k < n; k++) { count[result[k].finger] = result[k].count; }
    err = bilateral_seeds(o, o->speed[i].mps, count);
    for (int k = 0; k < n; k++) { result[k].count = count[result[k].finger]; }
    return err;
}

/* One speed: its results of all fingers in use behind the others'. */
static int one_speed(
    const struct bilateral_options *o, int i, struct bilateral_result *result, int *n)
{
    struct bilateral_run_cfg c = bilateral_at_speed(o, o->speed[i].mps);
    struct bilateral_run r;
    char path[1024], fault[1024], what[NAMES_B];
    const int first = *n;
    int err;
    c.keep = 1;
    if (open_log(o, i, &c, path, fault, sizeof path) != 0) { return 1; }
    err = bilateral_run(&c, &r) < 0 ? 2 : 0;
    if (err == 0 && r.dumps == 0 && c.blackbox == fault) { (void)remove(fault); } /* an earlier's */
    if (c.board.log && outlog_close(c.board.log) != 0 && err == 0) { err = 1; }
    if (err == 0) { err = judge_fingers(o, i, &r, c.board.exo.fingers, result, n); }
    if (err == 0 && r.faults) {
        names_faults(what, sizeof what, r.faults);
        cli_complain(
            "%s: the box stopped with faults %#x: %s", o->speed[i].name, (unsigned)r.faults, what);
        err = 1;
    }
    if (err == 0) { print_run(o, &c, &r); }
    bilateral_run_free(&r);
    return err ? err : more_seeds(o, i, &result[first], *n - first);
}

int bilateral_experiment(const struct bilateral_options *o)
{
    static struct bilateral_result result[BILATERAL_SPEEDS_MAX * BILATERAL_FINGERS];
    struct table2_runs local;
    FILE *csv;
    int n = 0, heard = 0, err = local_runs(o, &local);
    if (err) { return err; }
    memset(result, 0, sizeof result);
    if (o->run.k_Npm < 0 || o->run.b_Nspm < 0) {
        printf("%.6g Hz, %s's own k and b", (double)o->run.rate_Hz, o->scene);
    } else {
        printf("%.6g Hz, k %.6g N/m, b %.6g Ns/m", (double)o->run.rate_Hz, o->run.k_Npm,
            o->run.b_Nspm);
    }
    printf(", link %s, world at %.6g frames/s\n\n", o->udp ? o->udp : o->link, o->run.fps);
    bilateral_print_head(stdout);
    for (int i = 0; err == 0 && i < o->speeds && !posix_interrupted(); i++) {
        err = one_speed(o, i, result, &n);
        heard |= world_line_heard();
    }
    if (err == 0 && n > 0) {
        bilateral_print_advice(stdout, o, result, n);
        bilateral_print_paper(stdout, o, result, n, &local);
    }
    if (err == 0 && o->out) {
        csv = bilateral_out_file(o->out, "contacts.csv");
        if (csv == NULL) { return 1; }
        bilateral_csv_head(csv);
        for (int i = 0; i < n; i++) { bilateral_csv(csv, &result[i]); }
        err = outfile_close(csv);
        err |= bilateral_out_pictures(o->out, result, n, o->run.k_Npm, o->run.b_Nspm, o->link);
    }
    for (int i = 0; i < n; i++) { free(result[i].contact); }
    if (err == 0 && o->udp && !heard) { err = 1; } /* no world answered; this was reported */
    return err ? err : posix_interrupted() ? 130 : 0;
}
