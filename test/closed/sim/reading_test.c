/* SPDX-License-Identifier: MIT */
/* The readings of the analysis: each takes the samples its name says, and gives what the
 * analysis itself gives. */
#include "falls.h"

#include "lab/drop/reading.h"
#include "box/run.h"
#include "box/table2.h"

#define STEP_M 1e-3

/* A fall: before contact, a contact of two samples, a gap, one of five whose last three
 * stay within one count. q in steps. */
static void fall_of(struct log_builder *b)
{
    static const struct {
        double q;
        int c;
    } at[] = {{-3, 0}, {-1, 0}, {1, 1}, {4, 1}, {-1, 0}, {1, 1}, {4, 1}, {6, 1}, {7, 1}, {6, 1}};
    begin_fall(b);
    for (size_t i = 0; i < sizeof at / sizeof at[0]; i++) {
        add(b, 1e-3, at[i].q * STEP_M, 1.0 + (double)i, at[i].c);
    }
}

static size_t samples_of(const struct fall_log *log, enum fall_scope scope, size_t *contacts)
{
    struct fall_opt opt = fall_opt_default;
    struct fall_contacts c;
    size_t n = 0;
    opt.scope = scope;
    opt.step_m = STEP_M;
    CHECK(fall_dissect_scope(log, &opt, &c) == FALL_OK, "scope %d", (int)scope);
    for (size_t i = 0; i < c.n; i++) { n += c.at[i].end - c.at[i].first; }
    *contacts = c.n;
    fall_contacts_free(&c);
    return n;
}

TEST(scopes_take_what_they_say)
{
    static const struct {
        size_t samples, contacts; /* of one fall */
    } want[FALL_SCOPES] = {{7, 2}, {2, 1}, {4, 2}, {10, 1}};
    struct log_builder b = {0};
    for (int i = 0; i < 3; i++) { fall_of(&b); }
    const struct fall_log log = built(&b);
    for (int scope = 0; scope < FALL_SCOPES; scope++) {
        size_t contacts;
        const size_t n = samples_of(&log, (enum fall_scope)scope, &contacts);
        CHECK(n == 3 * want[scope].samples && contacts == 3 * want[scope].contacts,
            "scope %d: %zu samples in %zu contacts", scope, n, contacts);
    }
    drop(&b);
}

/* A motor that never stops is never cut; one that never moves is cut to nothing. */
TEST(the_stop_is_where_counting_ends)
{
    for (int moving = 0; moving < 2; moving++) {
        struct log_builder b = {0};
        size_t contacts, n;
        begin_fall(&b);
        for (int i = 0; i < 20; i++) { add(&b, 1e-3, moving ? i % 2 * 2 * STEP_M : 0, 1, 1); }
        const struct fall_log log = built(&b);
        n = samples_of(&log, FALL_SCOPE_MOVES, &contacts);
        CHECK(n == (moving ? 19u : 0u), "moving %d: %zu samples", moving, n);
        drop(&b);
    }
}

TEST(names_are_found)
{
    for (int i = 0; i < READINGS; i++) { CHECK_EQ_I64(reading_find(reading_table[i].name), i); }
    CHECK_EQ_I64(reading_find("a-same"), -1);
    CHECK(strcmp(reading_table[READING_DEFAULT].name, "b-aligned-all") == 0, "%s",
        reading_table[READING_DEFAULT].name);
}

/* On a run of the simulation: every reading, by the analysis and by reading_all(). */
TEST(all_at_once_is_one_by_one)
{
    double all[READINGS];
    struct run_cfg c;
    struct run r;
    memset(&c, 0, sizeof c);
    c.rate_Hz = 500;
    c.k_Npm = 6000;
    c.b_Nspm = 20;
    c.board = posix_config_default();
    c.board.falls = 10;
    c.board.device.observe_s = 1;
    CHECK_EQ_I64(run_drop(&c, &r), 0);
    CHECK(reading_all(&r.log, c.board.device.step_m, all) == FALL_OK, "status");
    for (int i = 0; i < READINGS; i++) {
        const struct reading *x = &reading_table[i];
        struct fall_opt opt = fall_opt_default;
        struct fall_stiffness s;
        opt.lag = x->lag;
        opt.scope = x->scope;
        opt.step_m = c.board.device.step_m;
        CHECK(fall_stiffness(&r.log, &opt, &s) == FALL_OK, "%s", x->name);
        const double one = s.fit.status != FALL_OK  ? 0
                           : x->direction == FALL_A ? s.fit.a_Npm
                                                    : s.fit.b_Npm;
        CHECK(all[i] == one, "%s: %.17g, alone %.17g", x->name, all[i], one);
        fall_stiffness_free(&s);
    }
    run_free(&r);
}

TEST_MAIN("reading", scopes_take_what_they_say, the_stop_is_where_counting_ends, names_are_found,
    all_at_once_is_one_by_one);
