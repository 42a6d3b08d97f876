/* SPDX-License-Identifier: MIT */
/* The full box in closed loop with a hand, a link and a world: the contact depends on the plane
 * known before it, and not on the link during it. */
#include "felt.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Every bit of what finger f felt, moved and was commanded from its freeze to the end, and how it
 * moved before. q_lim and d: while the plane of this approach is held. */
static void check_same(
    const struct bilateral_run *a, const struct bilateral_run *b, unsigned f, const char *what)
{
    const struct bilateral_track *s = &a->finger[f], *t = &b->finger[f];
    const size_t freeze = freeze_of(s);
    CHECK(s->n == t->n, "%s: %zu ticks, %zu", what, s->n, t->n);
    CHECK(freeze_of(t) == freeze, "%s: frozen in tick %zu, %zu", what, freeze, freeze_of(t));
    for (size_t i = 0; i < s->n && i < t->n; i++) {
        if (same_felt(&s->at[i].raw, &t->at[i].raw) && s->at[i].x_m == t->at[i].x_m &&
            (i < freeze || !(s->at[i].bits & EXH_PRECONTACT_STANDS) ||
                (s->at[i].raw.d_m_q30 == t->at[i].raw.d_m_q30 &&
                    s->at[i].raw.q_lim_m_q30 == t->at[i].raw.q_lim_m_q30))) {
            continue;
        }
        CHECK(0, "%s: tick %zu differs, %zd after the freeze: F %d and %d, q_lim %d and %d", what,
            i, (ssize_t)(i - freeze), s->at[i].raw.f_des_N_q20, t->at[i].raw.f_des_N_q20,
            s->at[i].raw.q_lim_m_q30, t->at[i].raw.q_lim_m_q30);
        return;
    }
}

/* ---- Whatever the link does --------------------------------------------------------------- */

static struct bilateral_run perfect;

static void over(struct bilateral_run_cfg c, const char *what)
{
    struct bilateral_run r = run(&c);
    CHECK(r.box.accepted > 20, "%s: %d packets", what, r.box.accepted);
    CHECK(r.finger[EXH_INDEX].contacts > 0, "%s: no contact", what);
    check_same(&perfect, &r, EXH_INDEX, what);
    bilateral_run_free(&r);
}

static void over_recorded(struct bilateral_run_cfg c, const char *file, enum sim_trace_kind kind)
{
    const char *data = getenv("EXH_DATA") ? getenv("EXH_DATA") : "$EXH_DATA";
    struct sim_trace trace = {NULL, 0};
    char path[512], why[256];
    snprintf(path, sizeof path, "%s/%s", data, file);
    if (access(path, R_OK) != 0) {
        check_note("%s: not there: not tested; EXH_DATA names the place of data", path);
        return;
    }
    CHECK(sim_trace_read(&trace, path, kind, why, sizeof why) == 0, "%s", why);
    for (int w = 0; w < SIM_LINK_WAYS; w++) {
        c.board.line.trace[w] = &trace;
        c.board.line.way[w].trace_scale = 0.5;
    }
    over(c, file);
    sim_trace_free(&trace);
}

TEST(the_force_is_the_same_to_the_bit_over_every_link)
{
    static const double speed[] = {0.05, 0.87, 1.2};
    for (size_t i = 0; i < LEN(speed); i++) {
        const struct bilateral_run_cfg c = plain(1u << EXH_INDEX, speed[i], 2);
        struct bilateral_run_cfg bad = c;
        perfect = run(&c);
        CHECK(perfect.finger[EXH_INDEX].freezes >= 2, "%ld freezes",
            perfect.finger[EXH_INDEX].freezes);
        over_recorded(c, "net-ethernet-direct/ethernet-no_load.csv.xz", SIM_TRACE_ROUND);
        over_recorded(c, "net-internet-ping/experimental.dat", SIM_TRACE_MS);
        for (int w = 0; w < SIM_LINK_WAYS; w++) {
            struct sim_link_par *p = &bad.board.line.way[w];
            p->hole_at_s =
                0.45; /* it begins before the first approach, and nothing is known of the contact */
            p->hole_s = 1;
            p->hole_every_s = 1.25;
        }
        over(bad, "holes of a second");
        bad = c;
        for (int w = 0; w < SIM_LINK_WAYS; w++) {
            struct sim_link_par *p = &bad.board.line.way[w];
            p->delay_s = 0.08;
            p->jitter = SIM_LINK_UNIFORM;
            p->jitter_s = 0.08;
            p->loss = 0.3;
            p->duplicate = p->reorder = 0.2;
        }
        over(bad, "0..160 ms each way, 30 % lost, doubled, reordered");
        bad = c;
        bad.fps = 60;
        over(bad, "60 frames a second");
        bilateral_run_free(&perfect);
    }
}

/* A trace over the link changes nothing that is felt, and none of its frames is missed unseen. */
TEST(a_trace_over_the_link_is_felt_by_nobody)
{
    static const int every[] = {1, 4, 300};
    struct bilateral_run_cfg c = plain(1u << EXH_INDEX, 0.87, 2);
    perfect = run(&c);
    for (size_t i = 0; i < 2 * LEN(every); i++) {
        struct bilateral_run r;
        const struct peer_trace *t = &r.trace;
        c.trace_every = every[i % LEN(every)];
        for (int w = 0; w < SIM_LINK_WAYS; w++) {
            c.board.line.way[w].loss = i < LEN(every) ? 0 : 0.2;
        }
        r = run(&c);
        check_same(&perfect, &r, EXH_INDEX, "with a trace");
        CHECK(t->frames > 0 && t->unruly == 0, "every %d: %u frames, %u unruly", c.trace_every,
            t->frames, t->unruly);
        CHECK(
            (i < LEN(every)) == (t->missed == 0), "every %d: %u missed", c.trace_every, t->missed);
        check_note("trace of every %d: %u frames, %u missed, of %u ticks", c.trace_every,
            (unsigned)t->frames, (unsigned)t->missed, (unsigned)r.ticks);
        bilateral_run_free(&r);
    }
    bilateral_run_free(&perfect);
}

/* The reverse: another plane gives another trace. */
TEST(another_plane_makes_another_force)
{
    struct bilateral_run_cfg c = plain(1u << EXH_INDEX, 0.87, 1);
    struct bilateral_run a = run(&c), b;
    c.at_m += 100e-6;
    b = run(&c);
    CHECK(a.finger[EXH_INDEX].digest != b.finger[EXH_INDEX].digest,
        "a wall 0.1 mm off feels the same");
    bilateral_run_free(&a);
    bilateral_run_free(&b);
}

/* The slope knows the way without having been fitted: where the string says contact, there is one.
 * What is left is how far the fingertip lags behind the string. */
TEST(s_of_the_slope_finds_the_wall_with_every_finger)
{
    static const double at_m[] = {0.015, 0.03, 0.05};
    double worst_mm = 0;
    for (unsigned k = 0; k < LEN(at_m) * BILATERAL_FINGERS; k++) {
        const unsigned f = k % BILATERAL_FINGERS;
        struct bilateral_run_cfg c = plain(1u << f, 0.02, 1);
        struct bilateral_run r;
        const struct bilateral_track *t = &r.finger[f];
        const struct bilateral_sample *s;
        double off_mm;
        c.at_m = at_m[k / BILATERAL_FINGERS];
        r = run(&c);
        s = &t->at[contact_of(t)];
        off_mm = 1e3 * (s->raw.q_lim_m_q30 / 1073741824.0 - t->touch_m + t->at[0].x_m -
                           t->at[0].raw.q_m_q30 / 1073741824.0);
        if (off_mm > worst_mm || -off_mm > worst_mm) { worst_mm = off_mm > 0 ? off_mm : -off_mm; }
        CHECK(off_mm < 0.7 && off_mm > -0.7, "finger %u, wall at %g m: %.2f mm off", f, c.at_m,
            off_mm);
        bilateral_run_free(&r);
    }
    check_note(
        "s of the slope: the wall within %.2f mm of string, five fingers, three places", worst_mm);
}

/* A wall that comes 5 mm nearer while the finger presses: nothing of it until the finger has left.
 */
TEST(what_moves_while_it_is_touched_is_not_felt)
{
    struct bilateral_run_cfg c = plain(1u << EXH_INDEX, 0.87, 2);
    struct bilateral_run a = run(&c), b;
    const struct bilateral_track *s = &a.finger[EXH_INDEX], *t;
    size_t i;
    c.jump_s = (double)contact_of(s) / c.rate_Hz + 0.2;
    c.jump_m = 0.005;
    b = run(&c);
    t = &b.finger[EXH_INDEX];
    for (i = 0; i < s->n && i < t->n && same_felt(&s->at[i].raw, &t->at[i].raw); i++) {}
    CHECK(i < s->n && s->at[i].approach == 2, "differs in tick %zu, approach %d", i,
        s->at[i].approach);
    CHECK(((const struct bilateral_signals *)(const void *)exh_scene_signals(&exh_scene_bilateral))
                  ->more[EXH_INDEX]
                  .ignored > 100,
        "it was not seen to move");
    bilateral_run_free(&a);
    bilateral_run_free(&b);
}

/* ---- Worlds that come and go ---------------------------------------------------------------- */

TEST(a_world_that_dies_in_contact_leaves_loop_and_force_as_they_were)
{
    struct bilateral_run_cfg c = plain(1u << EXH_INDEX, 0.87, 1);
    struct bilateral_run killed;
    double contact_s;
    perfect = run(&c);
    contact_s = (double)contact_of(&perfect.finger[EXH_INDEX]) / c.rate_Hz;
    for (int k = 0; k < 3;
         k++) { /* before the contact but frozen, at its beginning, in its middle */
        c.until_s = contact_s + (k - 1) * 0.005 + (k == 2) * 0.2;
        killed = run(&c);
        CHECK(killed.answers < perfect.answers, "it was not killed");
        check_same(&perfect, &killed, EXH_INDEX, "a killed world");
        bilateral_run_free(&killed);
    }
    bilateral_run_free(&perfect);
}

/* It comes back as another process; the controller says and hears HELLO again. */
TEST(a_world_may_start_anew_in_contact)
{
    struct bilateral_run_cfg c = plain(1u << EXH_INDEX, 0.87, 2);
    struct bilateral_run again;
    perfect = run(&c);
    c.until_s = (double)contact_of(&perfect.finger[EXH_INDEX]) / c.rate_Hz + 0.1;
    c.again_s = c.until_s + 0.3;
    again = run(&c);
    CHECK(again.finger[EXH_INDEX].freezes == 2, "%ld freezes", again.finger[EXH_INDEX].freezes);
    CHECK(again.box.age < 20, "nothing has come for %d ticks", again.box.age);
    check_same(&perfect, &again, EXH_INDEX, "a world started anew");
    bilateral_run_free(&perfect);
    bilateral_run_free(&again);
}

/* Between any two good packets come three that are not. */
TEST(hostile_packets_change_nothing)
{
    struct bilateral_run_cfg c = plain(1u << EXH_INDEX, 0.87, 1);
    struct bilateral_run r;
    perfect = run(&c);
    c.hostile = 3;
    r = run(&c);
    CHECK(r.box.corrupt + r.box.version + r.box.unknown > 1000, "%d refused", r.box.corrupt);
    CHECK_EQ_I64(r.box.accepted, perfect.box.accepted);
    check_same(&perfect, &r, EXH_INDEX, "hostile packets");
    bilateral_run_free(&r);
    bilateral_run_free(&perfect);
}

/* ---- No plane in time ----------------------------------------------------------------------- */

/* What is allowed where no contact can be: to pull the slack string in. */
static void check_nothing_felt(const struct bilateral_run *r, const char *what)
{
    const struct bilateral_track *t = &r->finger[EXH_INDEX];
    const int32_t f0_N_q20 = exh_contact_rows[2].dflt;
    CHECK(t->contacts == 0 && t->freezes == 0, "%s: %ld contacts, %ld freezes", what, t->contacts,
        t->freezes);
    for (size_t i = 0; i < t->n; i++) {
        if (t->at[i].raw.f_des_N_q20 > f0_N_q20) {
            CHECK(0, "%s: %d LSB of force in tick %zu", what, t->at[i].raw.f_des_N_q20, i);
            return;
        }
    }
}

TEST(without_a_plane_in_time_nothing_is_felt)
{
    static const struct run_setting young[] = {{"mat_f_max", 40}, {"age_max", 200}};
    struct bilateral_run_cfg c = plain(1u << EXH_INDEX, 0.87, 1);
    struct bilateral_run r;
    c.from_s = 1e30;
    r = run(&c);
    check_nothing_felt(&r, "no world");
    CHECK_EQ_I64(r.box.age, INT32_MAX);
    CHECK_EQ_I64(r.box.accepted, 0);
    bilateral_run_free(&r);

    /* It is there, and dies before the approach: its plane becomes too old. */
    c.from_s = 0;
    c.until_s = 0.2;
    c.setting = young;
    c.settings = 2;
    r = run(&c);
    check_nothing_felt(&r, "stale");
    CHECK(
        r.finger[EXH_INDEX].at[r.finger[EXH_INDEX].n - 1].bits & EXH_PRECONTACT_STALE, "not stale");
    bilateral_run_free(&r);

    /* It comes when the finger is past the surface: not before it has left once. */
    c = plain(1u << EXH_INDEX, 0.87, 1);
    c.from_s = 0.9;
    r = run(&c);
    CHECK(r.finger[EXH_INDEX].contacts == 0, "a plane born around the finger was felt");
    CHECK(r.finger[EXH_INDEX].at[2000].bits & EXH_PRECONTACT_AROUND, "%d",
        r.finger[EXH_INDEX].at[2000].bits);
    bilateral_run_free(&r);
}

/* String that hangs between finger and motor, mm. */
static double slack_mm(const struct bilateral_track *t, size_t i)
{
    return 1e3 * ((t->at[i].raw.q_m_q30 - t->at[0].raw.q_m_q30) / 1073741824.0 - t->at[i].x_m +
                     t->at[0].x_m);
}

/* A finger that met no wall goes back faster than F0 can follow. Then it moves no string in, and
 * the string is slack. It must not stay so, or the next wall is as far too far out. */
TEST(a_slack_string_is_wound_in)
{
    struct bilateral_run_cfg c = plain(1u << EXH_INDEX, 0.87, 2);
    const struct bilateral_track *t;
    struct bilateral_run r;
    double most_mm = 0, left_mm, off_mm;
    size_t i = 0, contact, most = 0, wound = 0;
    c.from_s = 1.5; /* between the first approach and the second */
    c.board.exo.path[EXH_INDEX].rest_s = 4;
    r = run(&c);
    t = &r.finger[EXH_INDEX];
    for (; i < t->n && t->at[i].approach < 2; i++) {
        if (slack_mm(t, i) > most_mm) { most_mm = slack_mm(t, most = i); }
        if (slack_mm(t, i) > 0.5) { wound = i; }
    }
    CHECK(i > 1 && i < t->n, "no second approach");
    left_mm = slack_mm(t, i - 1);
    contact = contact_of(t);
    CHECK(t->at[contact].approach == 2, "felt in approach %d", t->at[contact].approach);
    off_mm = 1e3 * ((t->at[contact].raw.q_lim_m_q30 - t->at[0].raw.q_m_q30) / 1073741824.0 -
                       t->touch_m + t->at[0].x_m);
    CHECK(left_mm < 0.5 && off_mm < 1.5 && off_mm > -1.5,
        "%.2f mm slack of %.1f, the wall %.2f mm off", left_mm, most_mm, off_mm);
    CHECK(most_mm > 5, "it was never slack: %.2f mm", most_mm);
    check_note("slack after a missed contact: %.1f mm at most, wound in within %.2f s; %.2f mm "
               "before the next "
               "approach, whose wall is %.2f mm off",
        most_mm, (double)(wound - most) / c.rate_Hz, left_mm, off_mm);
    bilateral_run_free(&r);
}

/* ---- Five fingers --------------------------------------------------------------------------- */

/* The glove lets its channels know of each other a little: here it does not. */
static struct bilateral_run_cfg apart(unsigned fingers)
{
    struct bilateral_run_cfg c = plain(fingers, 0.87, 1);
    c.board.glove_par.couple = c.board.glove_par.settle_s = 0;
    return c;
}

TEST(five_fingers_are_in_contact_at_once_and_each_as_if_alone)
{
    struct bilateral_run_cfg c = apart(31);
    struct bilateral_run five = run(&c);
    size_t together = 0;
    for (size_t i = 0; i < five.finger[0].n; i++) {
        int n = 0;
        for (unsigned f = 0; f < BILATERAL_FINGERS; f++) { n += five.finger[f].at[i].raw.c; }
        together += n == BILATERAL_FINGERS;
    }
    CHECK(together > 1000, "%zu ticks with five contacts", together);
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        struct bilateral_run_cfg alone = apart(1u << f);
        struct bilateral_run one = run(&alone);
        const struct bilateral_track *s = &one.finger[f], *t = &five.finger[f];
        CHECK(s->n <= t->n, "%zu ticks alone, %zu", s->n, t->n);
        for (size_t i = 0; i < s->n && i < t->n; i++) {
            if (same_felt(&s->at[i].raw, &t->at[i].raw)) { continue; }
            CHECK(0, "finger %u, tick %zu: %d LSB of force alone, %d among five", f, i,
                s->at[i].raw.f_des_N_q20, t->at[i].raw.f_des_N_q20);
            break;
        }
        bilateral_run_free(&one);
    }
    bilateral_run_free(&five);
}

TEST(a_finger_that_is_off_has_no_current_and_no_drive)
{
    const struct bilateral_signals *sig = (const void *)exh_scene_signals(&exh_scene_bilateral);
    struct bilateral_run_cfg c = plain(1u << EXH_RING, 0.87, 1);
    struct bilateral_run r = run(&c);
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        const int on = f == EXH_RING;
        CHECK((sig->paper[f].q_m_q30 != 0) == on, "finger %u: q %d", f, sig->paper[f].q_m_q30);
        CHECK((sig->more[f].freezes != 0) == on, "finger %u: %d freezes", f, sig->more[f].freezes);
    }
    bilateral_run_free(&r);
}

/* ---- Parameters over the link ------------------------------------------------------------- */

TEST(parameters_come_over_the_link_are_answered_and_never_reach_a_contact)
{
    static const struct exh_wire_param want[] = {{0x0B01, 0, 5000 << 10}, {0x0B01, 1, 7000 << 10},
        {0x0B01, 200, 1 << 10}, {0x0B02, 0, -1}, {0x0601, 0, 0}, {0x9999, 0, 0}};
    struct bilateral_run_cfg c = plain(1u << EXH_INDEX, 0.87, 2);
    struct bilateral_run r;
    c.want = want;
    c.wants = (int)LEN(want);
    r = run(&c);
    CHECK_EQ_I64(r.acked, (int)LEN(want));
    CHECK_EQ_I64(
        r.refused, 4); /* no such instance, out of range, only before the loop, no such row */
    CHECK_EQ_I64(r.box.set, 2);
    /* The plane's material is 0: softer from the first contact on. */
    CHECK(((const struct bilateral_par *)(const void *)exh_scene_bilateral.params->active)
                  ->material[0]
                  .k_Npm_q10 == 5000 << 10,
        "it was not applied");
    bilateral_run_free(&r);
}

TEST(a_material_that_changes_in_contact_acts_from_the_next_freeze_on)
{
    static const struct exh_wire_param soft = {0x0B01, 0, 5000 << 10};
    struct bilateral_run_cfg c = plain(1u << EXH_INDEX, 0.87, 2);
    struct bilateral_run a = run(&c), b;
    const struct bilateral_track *s = &a.finger[EXH_INDEX], *t;
    const size_t contact = contact_of(s);
    size_t i, differ = 0;
    c.want = &soft;
    c.wants = 1;
    c.param_from_s = (double)contact / c.rate_Hz + 0.01;
    b = run(&c);
    t = &b.finger[EXH_INDEX];
    CHECK_EQ_I64(b.acked, 1);
    CHECK_EQ_I64(b.refused, 0);
    for (i = 0; i < s->n && i < t->n && differ == 0; i++) {
        if (!same_felt(&s->at[i].raw, &t->at[i].raw)) { differ = i; }
    }
    CHECK(differ > 0 && s->at[differ].approach == 2, "differs in approach %d",
        s->at[differ].approach);
    bilateral_run_free(&a);
    bilateral_run_free(&b);
}

TEST_MAIN("bilateral", a_trace_over_the_link_is_felt_by_nobody,
    the_force_is_the_same_to_the_bit_over_every_link, another_plane_makes_another_force,
    s_of_the_slope_finds_the_wall_with_every_finger, what_moves_while_it_is_touched_is_not_felt,
    a_world_that_dies_in_contact_leaves_loop_and_force_as_they_were,
    a_world_may_start_anew_in_contact, hostile_packets_change_nothing,
    without_a_plane_in_time_nothing_is_felt, a_slack_string_is_wound_in,
    five_fingers_are_in_contact_at_once_and_each_as_if_alone,
    a_finger_that_is_off_has_no_current_and_no_drive,
    parameters_come_over_the_link_are_answered_and_never_reach_a_contact,
    a_material_that_changes_in_contact_acts_from_the_next_freeze_on);
