/* SPDX-License-Identifier: MIT */
/* exhand-lab bilateral --contacts: every shipped scene, every finger, three speeds, good and bad
 * links, several seeds. No contact may be missed. A frozen contact depends on no link. The distance
 * from each contact to the object is printed as a distribution. */
#include "lab/contact/studies.h"

#include "base/option.h"
#include "base/outfile.h"

#include "world/world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define APPROACHES 2
#define LINKS_MAX  16
#define TRIES      (BILATERAL_FINGERS * APPROACHES)
#define SCENES     ((int)(sizeof scene / sizeof scene[0]))

static const struct {
    const char *name, *pose; /* a thumb that lies along the hand would close beside the object */
} scene[] = {{"collision", "flat"}, {"explore", "flat"}, {"gem", "thumb_out"},
    {"grasp", "thumb_out"}, {"rehabilitation", "thumb_out"}};

static const struct {
    const char *name, *spec;
    int may_miss; /* more than the link was promised for */
} link[] = {{"perfect", "none", 0}, {"20 ms", "delay=0.02", 0},
    {"50 +- 30 ms, 30 % lost", "delay=0.05,jitter=0.03,loss=0.3", 0}, {"100 ms", "delay=0.1", 1}};
#define LINKS ((int)(sizeof link / sizeof link[0]))

static struct {
    const struct bilateral_options *given;
    struct bilateral_options o[LINKS_MAX]; /* one a link, as its recording is kept there */
    const char *name[LINKS_MAX];
    int links, seeds;
} is;

/* Of one run: all fingers, APPROACHES each. */
struct cell {
    int done, tries, felt, missed, around, late, nothing, unfrozen, faults;
    int fingers, same; /* that froze; with every bit as over the perfect link from then on */
    int stood, broke;  /* fingers frozen when the world died; whose bits that changed */
    int places;
    float place_m[TRIES];
};

static struct bilateral_run_cfg cfg_of(int i, struct bilateral_options *o)
{
    const int l = i % is.links, v = i / is.links % is.given->speeds,
              s = i / is.links / is.given->speeds % SCENES;
    struct bilateral_run_cfg c;
    char path[200], why[700];
    *o = is.o[l];
    o->approaches = APPROACHES;
    o->seed = 1 + i / is.links / is.given->speeds / SCENES;
    (void)bilateral_take_pose(o, scene[s].pose);
    c = bilateral_at_speed(o, o->speed[v].mps);
    c.board.exo.fingers = 31;
    c.k_Npm = c.b_Nspm = -1;
    c.keep = 1;
    snprintf(path, sizeof path, "%s/%s.world", is.given->scene, scene[s].name);
    c.scene = world_load_file(path, why, sizeof why);
    if (c.scene == NULL) { cli_complain("--scene: %s", why); }
    return c;
}

static void count(struct cell *to, const struct bilateral_run *r, int hand_moves)
{
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        struct bilateral_contact contact[APPROACHES];
        const int n = bilateral_judge(r, f, contact, APPROACHES);
        for (int k = 0; k < n && k < APPROACHES; k++) {
            const struct bilateral_contact *c = &contact[k];
            to->tries++;
            to->felt += c->t_s > 0;
            /* Where the hand itself is moved, objects come onto fingers that rest: by the rule they
             * are not felt until they were left. */
            to->around += c->missed && c->around && hand_moves;
            to->missed += c->missed && !(c->around && hand_moves);
            to->late += c->t_s > 0 && c->late;
            to->nothing += c->t_s > 0 && c->nothing;
            if (c->t_s > 0 && !isnan(c->off_m)) { to->place_m[to->places++] = (float)c->off_m; }
        }
        to->unfrozen += r->finger[f].unfrozen > 0;
    }
    to->faults |= r->faults != 0;
}

/* The same approaches over a perfect link. */
static void beside_perfect(
    struct cell *to, const struct bilateral_run_cfg *given, const struct bilateral_run *r)
{
    struct bilateral_run_cfg c = *given;
    struct bilateral_run perfect;
    c.keep = 0;
    c.board.line = posix_line_default();
    if (bilateral_run(&c, &perfect) == 0) {
        for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
            to->fingers += r->finger[f].freezes > 0;
            to->same += r->finger[f].freezes > 0 && r->finger[f].digest == perfect.finger[f].digest;
        }
    }
    bilateral_run_free(&perfect);
}

/* Tick of its first freeze; its run's end if there is none. */
static size_t first_freeze(const struct bilateral_track *t)
{
    size_t i = 0;
    while (i < t->n && !(t->at[i].bits & EXH_PRECONTACT_FREEZE)) { i++; }
    return i;
}

/* A frozen finger then has the same bits in both runs until its release, all but d. The fingers
 * beside bend the glove's sensors a little, and they felt nothing in the second run. */
static int stands_alike(
    const struct bilateral_track *a, const struct bilateral_track *b, size_t from)
{
    for (size_t i = from; i < a->n && a->at[i].bits & EXH_PRECONTACT_STANDS; i++) {
        const struct bilateral_paper *p = &a->at[i].raw, *q = &b->at[i].raw;
        if (i >= b->n || p->q_m_q30 != q->q_m_q30 || p->qd_mps_q27 != q->qd_mps_q27 ||
            p->f_des_N_q20 != q->f_des_N_q20 || p->i_des_A_q26 != q->i_des_A_q26 || p->c != q->c ||
            p->f_mon_N_q20 != q->f_mon_N_q20 || p->q_lim_m_q30 != q->q_lim_m_q30) {
            return 0;
        }
    }
    return 1;
}

/* The same run again for each finger that froze, but the world dies in that tick. No packet after
 * it changes a bit of the contact. */
static void beside_dead(
    struct cell *to, const struct bilateral_run_cfg *given, const struct bilateral_run *r)
{
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        const size_t from = first_freeze(&r->finger[f]);
        struct bilateral_run_cfg c = *given;
        struct bilateral_run dead;
        if (from == r->finger[f].n) { continue; }
        c.until_s = ((double)from + 1) / c.rate_Hz;
        to->stood++;
        to->broke +=
            bilateral_run(&c, &dead) < 0 || !stands_alike(&r->finger[f], &dead.finger[f], from);
        bilateral_run_free(&dead);
    }
}

static void work(const void *ctx, int i, void *result)
{
    struct cell *to = result;
    struct bilateral_options o;
    struct bilateral_run_cfg c = cfg_of(i, &o);
    struct bilateral_run r;
    (void)ctx;
    memset(to, 0, sizeof *to);
    if (c.scene == NULL) { return; }
    if (bilateral_run(&c, &r) == 0) {
        to->done = !posix_interrupted();
        count(to, &r, world_scene(c.scene)->motion.kind != MOTION_NONE);
        beside_perfect(to, &c, &r);
        beside_dead(to, &c, &r);
    }
    bilateral_run_free(&r);
    world_free(c.scene);
}

/* --- the printed results --- */

static int by_size(const void *a, const void *b)
{
    const double d = *(const double *)a - *(const double *)b;
    return d < 0 ? -1 : d > 0;
}

/* Of all cells of this link and speed, and, unless < 0, of this scene. */
static void row(FILE *csv, const struct cell *cell, int n, int l, int v, int s)
{
    static double off_m[1 << 16];
    struct cell sum = {0};
    int places = 0;
    for (int i = l + v * is.links; i < n; i += is.links * is.given->speeds) {
        const struct cell *c = &cell[i];
        if (s >= 0 && i / is.links / is.given->speeds % SCENES != s) { continue; }
        sum.tries += c->tries, sum.felt += c->felt, sum.missed += c->missed, sum.late += c->late;
        sum.around += c->around;
        sum.nothing += c->nothing, sum.fingers += c->fingers, sum.same += c->same;
        sum.stood += c->stood, sum.broke += c->broke;
        for (int k = 0; k < c->places && places < (int)(sizeof off_m / sizeof off_m[0]); k++) {
            off_m[places++] = fabs((double)c->place_m[k]);
        }
    }
    qsort(off_m, (size_t)places, sizeof off_m[0], by_size);
    if (s >= 0) {
        fprintf(csv, "%s,%s,\"%s\",%d,%d,%d,%d,%d,%d,%d,%d,%d", scene[s].name,
            is.given->speed[v].name, is.name[l], sum.tries, sum.felt, sum.missed, sum.around,
            sum.late, sum.nothing, sum.fingers, sum.same, sum.broke);
        for (int q = 50; q <= 100; q += q == 50 ? 45 : 5) {
            fputc(',', csv);
            if (places) { fprintf(csv, "%.6f", off_m[(places - 1) * q / 100]); }
        }
        fputc('\n', csv);
        return;
    }
    printf("| %-23s | %-7s | %5d | %5d | %6d | %6d | %4d | %7d | %4d/%-4d | %4d/%-4d |", is.name[l],
        is.given->speed[v].name, sum.tries, sum.felt, sum.missed, sum.around, sum.late, sum.nothing,
        sum.stood - sum.broke, sum.stood, sum.same, sum.fingers);
    for (int q = 50; q <= 100; q += q == 50 ? 45 : 5) {
        printf(" %6.2f |", places ? 1e3 * off_m[(places - 1) * q / 100] : 0.0);
    }
    putchar('\n');
}

static int table(const struct cell *cell, int n)
{
    FILE *csv = is.given->out ? bilateral_out_file(is.given->out, "contacts.csv") : NULL;
    if (is.given->out && csv == NULL) { return 1; }
    printf("| link                    | speed   | tries |  felt | missed | around | late | nothing "
           "| stood   "
           "  | same bits | median |   95 %% |  worst |\n"
           "|--|--|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    if (csv) {
        fprintf(csv,
            "scene,speed,link,tries,felt,missed,around,late,nothing_there,froze,same_bits,broke,"
            "place_median_m,place_95_m,place_worst_m\n");
    }
    for (int l = 0; l < is.links; l++) {
        for (int v = 0; v < is.given->speeds; v++) {
            row(NULL, cell, n, l, v, -1);
            for (int s = 0; csv && s < SCENES; s++) { row(csv, cell, n, l, v, s); }
        }
    }
    printf(
        "\n%d scenes, five fingers, %d approaches, %d seeds. Place: q_lim less the string at "
        "which the pad touches\nwhat is there then, mm, whatever its sign. Around: the hand's own "
        "motion brought an object onto a\nfinger that rests: by the rule not felt until it was "
        "left. Late: the finger was "
        "inside when its plane came. Nothing: a\ncontact where nothing is. Stood: first contacts "
        "whose bits stayed when the world died as they froze. Same bits:\n"
        "fingers with every bit as over the perfect link from their first freeze on: at flat "
        "faces; of a curved\nsurface the plane is of where the pad was foreseen.\n",
        SCENES, APPROACHES, is.seeds);
    return csv && outfile_close(csv);
}

/* Exit status: what must not be. */
static int judge(const struct cell *cell, int n)
{
    int missed = 0, broke = 0, unfrozen = 0, undone = 0, faults = 0;
    for (int i = 0; i < n; i++) {
        const int l = i % is.links;
        missed += is.links > 1 && l < LINKS && link[l].may_miss ? 0 : cell[i].missed;
        broke += cell[i].broke;
        unfrozen += cell[i].unfrozen;
        undone += !cell[i].done;
        faults += cell[i].faults;
    }
    if (missed + broke + unfrozen + undone + faults == 0) { return 0; }
    cli_complain(
        "%d contacts missed, %d that a dead world changed, %d before their freeze; %d runs "
        "not done, %d ended in a fault",
        missed, broke, unfrozen, undone, faults);
    return 1;
}

static int take_links(const struct bilateral_options *o, const char *networks)
{
    static char paths[LINKS_MAX][300];
    if (strcmp(o->link, "none") != 0) { /* this one alone */
        if (networks) { cli_complain("--networks: %s: not beside --link %s", networks, o->link); }
        if (networks) { return 2; }
        is.o[0] = *o;
        is.name[0] = o->link;
        is.links = 1;
        return bilateral_take_link(&is.o[0], o->link);
    }
    for (int l = 0; l < LINKS; l++) {
        is.o[l] = *o;
        is.name[l] = link[l].name;
        if (bilateral_take_link(&is.o[l], link[l].spec)) { return 2; }
    }
    is.links = LINKS;
    while (networks && *networks) {
        const char *comma = strchr(networks, ','), *slash;
        const int len = comma ? (int)(comma - networks) : (int)strlen(networks);
        char *path;
        if (is.links == LINKS_MAX) {
            cli_complain("--networks: %s: only %d beside the %d known links", networks,
                LINKS_MAX - LINKS, LINKS);
            return 2;
        }
        path = paths[is.links];
        snprintf(path, sizeof paths[0], "%.*s", len, networks);
        is.o[is.links] = *o;
        if (bilateral_take_trace(&is.o[is.links], "--networks", path)) { return 2; }
        slash = strrchr(path, '/');
        is.name[is.links++] = slash ? slash + 1 : path;
        networks += len + (comma != NULL);
    }
    return 0;
}

int bilateral_contacts(const struct bilateral_options *o, int64_t seeds, const char *networks)
{
    static struct bilateral_options given;
    struct jobs jobs = {
        0, (int)o->jobs, sizeof(struct cell), NULL, work, NULL, "runs", posix_interrupt};
    int err;
    given = *o;
    if (given.scene == NULL) { given.scene = "ports/posix/world/scenes"; }
    is.given = &given;
    is.seeds = (int)seeds;
    err = take_links(&given, networks);
    if (err) { return err; }
    jobs.n = SCENES * is.given->speeds * is.links * is.seeds;
    jobs.result = calloc((size_t)jobs.n, sizeof(struct cell));
    if (jobs.result == NULL) {
        cli_complain("out of memory: fewer seeds");
        return 1;
    }
    err = jobs_run(&jobs);
    if (err == 0) { err = table(jobs.result, jobs.n); }
    if (err == 0) { err = judge(jobs.result, jobs.n); }
    free(jobs.result);
    return err;
}
