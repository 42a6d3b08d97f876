/* SPDX-License-Identifier: MIT */
/* The table of docs/FAULTS.md is what `exhand-lab faults` says now, and nothing in it is wrong; nor
 * is anything at a few thousand random times (`make faults`: 10^5). */
#include "said.h"
#include "lab/lab.h"

#include "lab/faults/faults.h"
#include "posix.h"

static struct said s;

TEST(the_documented_table_is_the_one_made_now)
{
    char *dir = said_dir();
    said(&s, dir, cli_faults, WORDS("faults", "--jobs", "2"));
    CHECK(s.status == 0 && s.err[0] == '\0', "status %d: %s%s", s.status, s.err, s.out);
    CHECK(strstr(s.out, "\n176 cells, each at 3 rates: 0 wrong.\n") != NULL, "%s", s.out);
    CHECK(strstr(s.out, "\n8 refusals, each at 3 rates: 0 wrong.\n") != NULL, "%s", s.out);
    said_as_document(&s, "docs/FAULTS.md", "exhand faults");
    said_clean(dir);
}

/* DESIGN.md has its first table; the names are those of SAFETY.md (sim/safety_doc). */
TEST(the_documented_states_are_the_librarys)
{
    char *dir = said_dir(), *rest;
    said(&s, dir, cli_faults, WORDS("faults", "--states"));
    CHECK(s.status == 0 && s.err[0] == '\0', "status %d: %s", s.status, s.err);
    CHECK(strstr(s.out, "\n| deadman | release | ") && strstr(s.out, "\n| estop | cut | ") &&
              strstr(s.out, "\n| i2t | ") && strstr(s.out, "\n| small_force | ") &&
              strstr(s.out, "\n| limit | "),
        "%s", s.out);
    CHECK(strstr(s.out, "?") == NULL && strstr(s.out, "|  |") == NULL, "a name is missing: %s",
        s.out);
    rest = strstr(s.out, "\n\n");
    CHECK(rest != NULL, "%s", s.out);
    rest[1] = '\0';
    said_as_document(&s, "docs/DESIGN.md", "exhand faults --states");
    said_clean(dir);
}

TEST(nothing_is_wrong_at_random_times)
{
    char *dir = said_dir();
    said(&s, dir, cli_faults, WORDS("faults", "--times", "2004", "--jobs", "2"));
    CHECK(s.status == 0 && s.err[0] == '\0', "status %d: %s%s", s.status, s.err, s.out);
    CHECK(strstr(s.out, "2004 times: 0 wrong.") != NULL, "%s", s.out);
    said_clean(dir);
}

/* --- a damaged zero of the D/A --- */

struct zero {
    struct faults_base base;
    struct faults_seen seen;
    uint32_t free_for;
    int tried;
};

/* The bit of a finger's dac_zero that is worth 4.4 A. */
static uint32_t bit_of_zero(uint8_t scene, uint16_t finger)
{
    const struct faults_memory m = faults_memory(scene);
    for (uint32_t i = 0; i < m.pars; i++) {
        uint16_t instance = 0;
        if (strcmp(exh_signal_at(m.table, i, &instance)->name, "dac_zero") == 0 &&
            instance == finger) {
            return (i * 4 + 1) * 8 + 5;
        }
    }
    return 0;
}

static void damage_it(void *ctx, uint32_t tick, const struct faults_view *v)
{
    struct zero *z = ctx;
    struct faults_case c;
    z->free_for += v->state == EXH_STATE_RUN && v->force_N_q20[0] == 0;
    if (z->free_for != 5 || z->tried) { return; }
    memset(&c, 0, sizeof c);
    c.what[0].source = FAULTS_PAR;
    c.what[0].how = bit_of_zero(z->base.scene, 0);
    c.what[0].place = FAULTS_PASSED;
    c.what[1].source = FAULTS_JUMP;
    c.what[1].after_ticks = 7;
    c.follow_ticks = 300;
    if (faults_branch(&z->base, &c, tick, v, &z->seen)) { return; }
    z->tried = 1;
    posix_stop();
}

static void judge_zero(uint32_t rate_Hz, uint32_t told_by)
{
    static struct zero z;
    int err;
    memset(&z, 0, sizeof z);
    z.base = (struct faults_base){.scene = FAULTS_DROP, .gentle = 1, .seed = 3};
    z.base.rate_Hz = rate_Hz;
    err = faults_run(&z.base, damage_it, &z);
    CHECK(err == 0 && z.tried, "%d", err);
    CHECK(z.seen.bad == 0, "%#x", (unsigned)z.seen.bad);
    CHECK_EQ_I64(z.seen.seen_ticks[1], 0);
    CHECK_EQ_I64(z.seen.state[1], EXH_STATE_RELEASE);
    CHECK_EQ_I64(z.seen.end.state, EXH_STATE_FAULT);
    CHECK(z.seen.end.faults & told_by, "%#x", (unsigned)z.seen.end.faults);
    CHECK(z.seen.zero_s > 0.008 && z.seen.zero_s < 0.030, "%g s", z.seen.zero_s);
}

/* No force is commanded, and the motor pulls by the damaged zero. It ends when tracking or the
 * guard reports it, whichever is earlier. Nothing else is wrong. */
TEST(a_damaged_zero_of_the_da_pulls_until_it_is_told)
{
    judge_zero(200, EXH_FAULT_TRACKING);
    judge_zero(1000, EXH_FAULT_CONFIG);
}

/* The thumb is not in use, and the index presses. */
static void damage_idle(void *ctx, uint32_t tick, const struct faults_view *v)
{
    struct zero *z = ctx;
    struct faults_case c;
    z->free_for += v->force_N_q20[FAULTS_FINGER] > EXH_Q(1, 1, EXH_Q_FORCE);
    if (z->free_for != 20 || z->tried) { return; }
    memset(&c, 0, sizeof c);
    c.what[0].source = FAULTS_PAR;
    c.what[0].how = bit_of_zero(z->base.scene, EXH_THUMB);
    c.what[0].place = FAULTS_PASSED;
    c.follow_ticks = 1000;
    if (faults_branch(&z->base, &c, tick, v, &z->seen)) { return; }
    z->tried = 1;
    posix_stop();
}

/* Its code is no zero, but its drive stays disabled: only the index's motor has a current. The
 * guard reports it. On cards the driver does so immediately, and the run has ended safe. */
TEST(a_damaged_zero_of_an_idle_finger_pulls_nothing)
{
    for (int cards = 0; cards < 2; cards++) {
        static struct zero z;
        int err;
        memset(&z, 0, sizeof z);
        z.base = (struct faults_base){.scene = FAULTS_BILATERAL, .gentle = 1, .seed = 3};
        z.base.rate_Hz = 1000;
        z.base.cards = (uint8_t)cards;
        err = faults_run(&z.base, damage_idle, &z);
        CHECK(err == 0 && z.tried && z.seen.bad == 0, "%d, %d, %#x", err, z.tried,
            (unsigned)z.seen.bad);
        CHECK_EQ_I64(z.seen.ended, cards);
        if (cards) { continue; }
        CHECK_EQ_I64(z.seen.end.faults, EXH_FAULT_CONFIG);
        CHECK(z.seen.seen_ticks[0] > 20 &&
                  z.seen.seen_ticks[0] <=
                      (int32_t)faults_seen_within(FAULTS_BILATERAL, FAULTS_PAR, 1000),
            "seen after %d", (int)z.seen.seen_ticks[0]);
    }
}

TEST_MAIN("sim/faults", the_documented_table_is_the_one_made_now,
    the_documented_states_are_the_librarys, nothing_is_wrong_at_random_times,
    a_damaged_zero_of_the_da_pulls_until_it_is_told,
    a_damaged_zero_of_an_idle_finger_pulls_nothing);
