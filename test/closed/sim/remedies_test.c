/* SPDX-License-Identifier: MIT */
/* The basis of `make remedies`: its short loop equals the bilateral scene's, bit by bit. It
 * distinguishes a silent contact from one that is not. */
#include "check.h"

#include "said.h"

#include "box/hand_options.h"
#include "lab/contact/held.h"
#include "lab/contact/nailed.h"
#include "lab/lab.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct bilateral_options o;

static struct bilateral_run_cfg one_approach(const char *speed)
{
    struct bilateral_run_cfg c;
    bilateral_defaults(&o);
    o.approaches = 1;
    o.run.rate_Hz = 2000;
    o.run.k_Npm = 20000;
    o.run.b_Nspm = 60;
    c = bilateral_at_speed(&o, sim_path_speed(speed));
    c.keep = 1;
    return c;
}

/* Behind the last tick of the hold. */
static size_t hold_end(const struct bilateral_track *t)
{
    size_t i = t->n;
    while (i > 0 && !t->at[i - 1].holds) { i--; }
    return i;
}

/* First tick of contact; n: there was none. */
static size_t touches(const struct bilateral_track *t)
{
    size_t i = 0;
    while (i < t->n && !t->at[i].raw.c) { i++; }
    return i;
}

TEST(it_is_the_scenes_loop_bit_by_bit)
{
    static const char *const speed[] = {"slow", "natural", "fast"};
    for (int v = 0; v < 3; v++) {
        struct bilateral_run_cfg c = one_approach(speed[v]);
        const struct bilateral_track *a, *b;
        struct held_law law = {"", 2000, 1, 20000, 60, HELD_WINDOW, 1, HELD_EVERY, 0, 0, 0, 0, 0};
        struct bilateral_run scene, held;
        size_t at, ticks = 0;
        CHECK(bilateral_run(&c, &scene) == 0, "%s", speed[v]);
        a = &scene.finger[EXH_INDEX];
        at = touches(a);
        CHECK(at < a->n, "%s: no contact", speed[v]);
        c.at_m = a->touch_m; /* what the finger believes */
        c.board.glove = 1;   /* the device is then integrated to the same instants */
        law.lim_m_q30 = at < a->n ? a->at[at].raw.q_lim_m_q30 : 1;
        CHECK(held_run(&law, &c, &held, NULL) == 0, "%s", speed[v]);
        b = &held.finger[EXH_INDEX];
        CHECK(touches(b) == at, "%s: at %zu, the scene at %zu", speed[v], touches(b), at);
        for (size_t i = at; i < hold_end(a) && i < b->n; i++, ticks++) {
            const struct bilateral_paper *p = &a->at[i].raw, *q = &b->at[i].raw;
            if (p->q_lim_m_q30 != law.lim_m_q30) { break; } /* it bounced, and froze anew */
            if (p->q_m_q30 != q->q_m_q30 || p->qd_mps_q27 != q->qd_mps_q27 ||
                p->f_des_N_q20 != q->f_des_N_q20 || p->i_des_A_q26 != q->i_des_A_q26) {
                CHECK(0, "%s: tick %zu differs, contact since %zu", speed[v], i, at);
                break;
            }
        }
        CHECK(ticks >= 50, "%s: %zu ticks of contact", speed[v], ticks);
        check_note("%s: %zu ticks of contact, the same bits", speed[v], ticks);
        bilateral_run_free(&scene);
        bilateral_run_free(&held);
    }
}

/* Against the textbook: a finger let go into a string that is nailed rings down by its damping. */
TEST(a_nailed_string_rings_as_its_damping_says)
{
    struct bilateral_run_cfg c = one_approach("natural");
    double s[2], light_s;
    c.board.device.mu_mass = 0;
    c.board.exo.finger[EXH_INDEX].mass_kg = 0.1;
    c.board.exo.finger[EXH_INDEX].b_Nspm = 2;
    CHECK(nailed_settle(&c, s, 2) == 1, "one approach");
    light_s = s[0];
    c.board.exo.finger[EXH_INDEX].b_Nspm = 2 + (2 + c.board.device.cable_nspm);
    CHECK(nailed_settle(&c, s, 2) == 1, "one approach");
    /* Twice the damping: the same decay in half of the time, give or take a swing. */
    CHECK(light_s > 0 && fabs(light_s / s[0] - 2) < 0.5, "%g s, then %g s", light_s, s[0]);
}

static char row[2][400];

/* Row n of the table by one hand: what it says of silence. */
static void silence(const char *n, int *slow, int *natural, double *settled_ms, int keep)
{
    static struct said s;
    char *dir = said_dir();
    const char *at;
    int cell = 0;
    said(&s, dir, lab_bilateral,
        WORDS("bilateral", "--remedies", n, "--approaches", "5", "--jobs", "2"));
    CHECK(s.status == 0, "%s: %d: %s", n, s.status, s.err);
    at = strrchr(s.out, '\n');
    while (at && at > s.out && at[-1] != '\n') { at--; }
    (void)snprintf(row[keep], sizeof row[keep], "%s", at ? at : "");
    for (const char *p = row[keep]; *p; p++) {
        if (*p != '|') { continue; }
        cell++;
        if (cell == 6) { *settled_ms = atof(p + 1); }
        if (cell == 13) { *slow = atoi(p + 1); }
        if (cell == 14) { *natural = atoi(p + 1); }
    }
    said_clean(dir);
}

TEST(a_silent_contact_is_told_from_one_that_is_not)
{
    int slow = -1, natural = -1, rings_slow = -1, rings_natural = -1;
    double ms = 0, rings_ms = 0;
    silence("6", &rings_slow, &rings_natural, &rings_ms, 0);
    silence("21", &slow, &natural, &ms, 1);
    CHECK(strstr(row[1], "5 kHz x4"), "%s", row[1]);
    CHECK(strstr(row[0], "difference"), "%s", row[0]);
    CHECK(
        rings_slow < 50 && rings_natural < 95, "%d, %d %%: %s", rings_slow, rings_natural, row[0]);
    CHECK(slow >= 99 && natural >= 99, "%d, %d %%: %s", slow, natural, row[1]);
    CHECK(ms > 20 && ms < 200 && rings_ms > 20, "%g ms, the one that rings %g ms", ms, rings_ms);
}

TEST_MAIN("sim/remedies", it_is_the_scenes_loop_bit_by_bit,
    a_nailed_string_rings_as_its_damping_says, a_silent_contact_is_told_from_one_that_is_not);
