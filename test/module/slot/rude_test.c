/* SPDX-License-Identifier: MIT */
/* For any answer of a controller the output is the gate's: not a number, infinite, huge, negative,
 * late. */
#include "rig.h"

#include "exhand/safety.h"

enum {
    GOOD,
    NOT_A_NUMBER,
    INFINITE,
    MINUS_INFINITE,
    HUGE_PULL,
    HUGE_PUSH,
    SAYS_FAILED,
    LATE,
    ROOT = 9
};

static struct {
    int code_min, code_max; /* of all ticks, from the code of 0 A */
    int32_t f_max_N_q20;
    uint32_t limits, faults;
    int dumb_at, dead_at; /* ticks: first without answer, first in FAULT */
    int still_out;        /* after that a code that is not 0 A */
    int ticks;
} seen;

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    (void)board;
    memset(&seen, 0, sizeof seen);
    seen.dumb_at = seen.dead_at = -1;
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    (void)tick;
    (void)in;
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const struct drop_par *p =
        (const struct drop_par *)(const void *)exh_scene_custom.params->active;
    const struct custom_signals *s = rig_signals();
    const int code = out->dac_raw[0] - p->drive.dac_zero_raw;
    (void)tick;
    (void)in;
    seen.ticks++;
    seen.code_min = code < seen.code_min ? code : seen.code_min;
    seen.code_max = code > seen.code_max ? code : seen.code_max;
    if (s->drop.f_des_N_q20 > seen.f_max_N_q20) { seen.f_max_N_q20 = s->drop.f_des_N_q20; }
    seen.limits |= (uint32_t)s->drop.limits;
    seen.faults |= (uint32_t)s->drop.faults;
    if (s->ask_N_q20 == SLOT_NONE && seen.dumb_at < 0) { seen.dumb_at = seen.ticks; }
    if (s->drop.state == EXH_STATE_FAULT && seen.dead_at < 0) { seen.dead_at = seen.ticks; }
    if (seen.dead_at >= 0 && code != 0) { seen.still_out++; }
    if (s->drop.state == EXH_STATE_FAULT && seen.ticks > seen.dead_at + 4) { posix_stop(); }
}

static void run_rude(int what, int pace)
{
    static const struct exh_loop_hooks hooks = {start, before, after};
    struct run_cfg c = rig(1000, what, 0);
    struct run r;
    c.more = &hooks;
    c.board.pace = pace;
    /* A busy machine may miss whole falls: the fault ends this run, not the fall. */
    c.board.falls = pace ? 1000 : 1;
    c.board.max_ticks = pace ? 600000 : 8000;
    if (pace) { c.board.device.height_m = 0.01; } /* a short fall, because the run is paced */
    /* Other programs may take the processor for a tenth of a second and more. Then the box does not
     * arm, and nothing is late. A late answer exceeds this slack in a few ticks. */
    c.board.slack_s = 0.5;
    (void)run_drop(&c, &r);
    run_free(&r);
}

static int32_t f_limit(void)
{
    const struct drop_par *p =
        (const struct drop_par *)(const void *)exh_scene_custom.params->active;
    return p->drive.f_max_N_q20;
}

TEST(good_answers_go_out)
{
    static const int what[] = {GOOD, ROOT};
    for (size_t i = 0; i < sizeof what / sizeof what[0]; i++) {
        run_rude(what[i], 0);
        CHECK(seen.faults == 0 && seen.dumb_at < 0 && seen.code_max > 0, "faults %lx",
            (unsigned long)seen.faults);
        CHECK_EQ_I64(seen.f_max_N_q20, EXH_Q(5, 1, EXH_Q_FORCE));
    }
}

/* No force from the tick that got none; the tick after it cuts. */
TEST(no_answer_is_a_fault)
{
    static const int what[] = {NOT_A_NUMBER, INFINITE, MINUS_INFINITE, SAYS_FAILED};
    for (size_t i = 0; i < sizeof what / sizeof what[0]; i++) {
        run_rude(what[i], 0);
        CHECK(seen.dumb_at > 0 && seen.dead_at == seen.dumb_at + 1, "%d: dumb at %d, FAULT at %d",
            what[i], seen.dumb_at, seen.dead_at);
        CHECK_EQ_I64(seen.faults & EXH_FAULT_LOGIC, EXH_FAULT_LOGIC);
        CHECK(seen.code_max == 0 && seen.code_min == 0 && seen.f_max_N_q20 == 0, "%d: codes %d..%d",
            what[i], seen.code_min, seen.code_max);
    }
}

TEST(what_is_too_much_is_held_back)
{
    run_rude(HUGE_PULL, 0);
    CHECK(seen.f_max_N_q20 > 0 && seen.f_max_N_q20 <= f_limit(), "%ld", (long)seen.f_max_N_q20);
    CHECK_EQ_I64(seen.limits & EXH_LIMIT_FORCE, EXH_LIMIT_FORCE);
    CHECK(seen.code_min >= 0 && seen.code_max <= 12184 && seen.dumb_at < 0, "codes %d..%d",
        seen.code_min, seen.code_max);
    run_rude(HUGE_PUSH, 0);
    CHECK_EQ_I64(seen.limits & EXH_LIMIT_PULL, EXH_LIMIT_PULL);
    CHECK(seen.code_min == 0 && seen.code_max == 0 && seen.f_max_N_q20 == 0, "codes %d..%d",
        seen.code_min, seen.code_max);
}

/* By the wall clock: each answer takes 10^8 additions, one after another. That is more than a tick
 * on any machine, and more than the slack after some ticks. */
TEST(who_takes_too_long_loses_the_force)
{
    run_rude(LATE, 1);
    CHECK_EQ_I64(seen.faults & EXH_FAULT_OVERRUN, EXH_FAULT_OVERRUN);
    CHECK(seen.dead_at > 0 && seen.still_out == 0, "FAULT at %d, then %d codes", seen.dead_at,
        seen.still_out);
}

TEST_MAIN("slot/rude", good_answers_go_out, no_answer_is_a_fault, what_is_too_much_is_held_back,
    who_takes_too_long_loses_the_force);
