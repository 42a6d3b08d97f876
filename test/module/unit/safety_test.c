/* SPDX-License-Identifier: MIT */
/* safety.h: every cell of the state machine, every fault in every state, arming, release, clearing.
 */
#include "exhand/safety.h"

#include "exhand/error.h"

#include "check.h"

#define ALL_DRIVES (31u * EXH_DIN_DRIVE0)
#define HEALTHY    (EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS | ALL_DRIVES)
#define FULL       (1 << 30)

/* 1 kHz: 4 ticks of small force, 8 of ramp, 15 of release. */
static const struct exh_safety_par par = {1, 1 << 20, 3, 7, 15};

static struct exh_safety_cfg cfg_of(struct exh_safety_par p, uint32_t rate_Hz)
{
    struct exh_safety_cfg c = {0};
    CHECK_EQ_I64(exh_safety_setup(&c, &p, (struct exh_period){1, rate_Hz}), 0);
    return c;
}

static struct exh_safety_in healthy(uint8_t command)
{
    struct exh_safety_in in = {HEALTHY, 0, 0, 0, 5, EXH_ARM_ALL};
    in.command = command;
    return in;
}

/* A cause where it comes from: a contact, missed ticks, or another module. */
static struct exh_safety_in with_cause(uint32_t fault, uint8_t command)
{
    struct exh_safety_in in = healthy(command);
    switch (fault) {
    case EXH_FAULT_ESTOP: in.din &= ~(uint32_t)EXH_DIN_ESTOP; break;
    case EXH_FAULT_DRIVE: in.din &= ~((uint32_t)EXH_DIN_DRIVE0 << 3); break;
    case EXH_FAULT_DEADMAN: in.din &= ~(uint32_t)EXH_DIN_DEADMAN; break;
    case EXH_FAULT_WATCHDOG: in.din &= ~(uint32_t)EXH_DIN_WATCHDOG; break;
    case EXH_FAULT_CARD: in.din &= ~(uint32_t)EXH_DIN_CARDS; break;
    case EXH_FAULT_OVERRUN: in.missed = 2; break;
    default: in.raised = fault; break;
    }
    return in;
}

/* --- the table, against a second one, written from what each state means --- */

#define NO EXH_STATE_FAULT /* cannot be: no such trigger in that state */
static const struct cell {
    uint8_t trigger;
    uint8_t to[EXH_STATES]; /* from off, arm, run, limit, release, fault */
} cell[] = {
    {EXH_ON_REFUSED, {0, 0, NO, NO, NO, NO}},
    {EXH_ON_CUT, {0, 5, 5, 5, 5, 5}},
    {EXH_ON_CAUSE, {0, 4, 4, 4, 4, 5}},
    {EXH_ON_OFF, {0, 4, 4, 4, 4, 5}},
    {EXH_ON_RELEASED, {NO, NO, NO, NO, 0, NO}},
    {EXH_ON_LATCHED, {NO, NO, NO, NO, 5, NO}},
    {EXH_ON_RUN, {1, 1, 2, 2, 4, 5}},
    {EXH_ON_ARMED, {NO, 2, NO, NO, NO, NO}},
    {EXH_ON_LIMITED, {NO, NO, 3, 3, NO, NO}},
    {EXH_ON_CLEAR, {NO, NO, NO, NO, NO, 0}},
    {EXH_ON_NONE, {0, 1, 2, 2, 4, 5}},
};

TEST(every_cell_is_what_it_should_be)
{
    CHECK_EQ_I64(LEN(cell), EXH_TRIGGERS);
    for (size_t c = 0; c < LEN(cell); c++) {
        for (unsigned s = 0; s < EXH_STATES; s++) {
            CHECK(exh_safety_next[s][cell[c].trigger] == cell[c].to[s], "%s, %s: %d, want %d",
                exh_state_name(s), exh_trigger_name(cell[c].trigger),
                exh_safety_next[s][cell[c].trigger], cell[c].to[s]);
        }
    }
}

/* A box in a state, as it gets there; its ARM with the gate open, or `early` with it closed. */
static struct exh_safety box_in(const struct exh_safety_cfg *cfg, uint8_t state, int early)
{
    struct exh_safety s = {0};
    (void)exh_safety_step(&s, cfg, healthy(EXH_CMD_NONE));
    if (state == EXH_STATE_OFF) { return s; }
    (void)exh_safety_step(&s, cfg, healthy(EXH_CMD_RUN));
    if (state == EXH_STATE_ARM && early) { return s; }
    for (uint32_t k = 0; k < 6; k++) { (void)exh_safety_step(&s, cfg, healthy(EXH_CMD_NONE)); }
    if (state == EXH_STATE_ARM) { return s; }
    for (uint32_t k = 0; k < 20; k++) { (void)exh_safety_step(&s, cfg, healthy(EXH_CMD_NONE)); }
    if (state == EXH_STATE_LIMIT) {
        s.limits = EXH_LIMIT_SLEW;
        (void)exh_safety_step(&s, cfg, healthy(EXH_CMD_NONE));
    }
    if (state == EXH_STATE_RELEASE) { (void)exh_safety_step(&s, cfg, healthy(EXH_CMD_OFF)); }
    if (state == EXH_STATE_FAULT) {
        (void)exh_safety_step(&s, cfg, with_cause(EXH_FAULT_ESTOP, EXH_CMD_NONE));
    }
    s.limits = 0;
    return s;
}

TEST(every_state_is_reached)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    for (uint8_t state = 0; state < EXH_STATES; state++) {
        const struct exh_safety s = box_in(&cfg, state, 0), early = box_in(&cfg, state, 1);
        CHECK_EQ_I64(s.state, state);
        CHECK_EQ_I64(early.state, state);
        CHECK_EQ_I64(exh_safety_is_open(&s), state >= EXH_STATE_ARM && state <= EXH_STATE_RELEASE);
        CHECK_EQ_I64(
            exh_safety_is_open(&early), state >= EXH_STATE_RUN && state <= EXH_STATE_RELEASE);
    }
}

/* Every fault in every state: where to, what is latched, whether the gate is open. */
TEST(every_fault_in_every_state)
{
    static const uint8_t command[] = {EXH_CMD_NONE, EXH_CMD_RUN, EXH_CMD_OFF, EXH_CMD_CLEAR, 99};
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    for (unsigned k = 0; k < EXH_FAULTS * EXH_STATES * 2 * LEN(command); k++) {
        const uint32_t fault = 1u << k % EXH_FAULTS;
        const uint8_t state = (uint8_t)(k / EXH_FAULTS % EXH_STATES);
        const int early = k / EXH_FAULTS / EXH_STATES % 2;
        struct exh_safety s = box_in(&cfg, state, early);
        const int open = exh_safety_is_open(&s), cut = (fault & EXH_FAULT_CUT) != 0;
        const uint8_t want = state == EXH_STATE_FAULT ? EXH_STATE_FAULT
                             : !open                  ? EXH_STATE_OFF
                             : cut                    ? EXH_STATE_FAULT
                                                      : EXH_STATE_RELEASE;
        const uint32_t before = s.faults, tick = s.tick;
        const struct exh_permit p =
            exh_safety_step(&s, &cfg, with_cause(fault, command[k / EXH_FAULTS / EXH_STATES / 2]));
        const int latches = open || state == EXH_STATE_FAULT;
        CHECK(s.state == want, "%s in %s: %s", exh_fault_name(k % EXH_FAULTS),
            exh_state_name(state), exh_state_name(s.state));
        CHECK_EQ_I64(s.present, fault);
        CHECK_EQ_I64(s.faults, latches ? before | fault : 0);
        if (open) { CHECK(s.first == fault && s.first_tick == tick, "first"); }
        CHECK_EQ_I64(p.mode, want == EXH_STATE_RELEASE ? EXH_PERMIT_RELEASE : EXH_PERMIT_CLOSED);
        CHECK_EQ_I64(exh_safety_is_open(&s), want == EXH_STATE_RELEASE);
    }
}

TEST(several_causes_cut_if_one_of_them_does)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    struct exh_safety s = box_in(&cfg, EXH_STATE_RUN, 0);
    struct exh_safety_in in = with_cause(EXH_FAULT_SPEED | EXH_FAULT_TRACKING, EXH_CMD_OFF);
    (void)exh_safety_step(&s, &cfg, in);
    CHECK_EQ_I64(s.state, EXH_STATE_FAULT);
    CHECK_EQ_I64(s.first, EXH_FAULT_SPEED | EXH_FAULT_TRACKING);
    s = box_in(&cfg, EXH_STATE_RELEASE, 0); /* of a command; then a cause joins */
    (void)exh_safety_step(&s, &cfg, with_cause(EXH_FAULT_GLOVE, EXH_CMD_NONE));
    CHECK(s.state == EXH_STATE_RELEASE && s.faults == EXH_FAULT_GLOVE, "joined");
    for (int k = 0; k < 20; k++) { (void)exh_safety_step(&s, &cfg, healthy(EXH_CMD_RUN)); }
    CHECK_EQ_I64(s.state, EXH_STATE_FAULT);
}

TEST(power_on_is_off)
{
    static const struct exh_safety s;
    CHECK_EQ_I64(s.state, EXH_STATE_OFF);
    CHECK_EQ_I64(exh_safety_is_open(&s), 0);
}

/* --- arming --- */

TEST(each_step_is_named_where_it_does_not_hold)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    for (unsigned k = 0; k < 6; k++) {
        for (int early = 0; early < 2; early++) {
            struct exh_safety s = box_in(&cfg, early ? EXH_STATE_ARM : EXH_STATE_OFF, 1);
            struct exh_safety_in in = healthy(EXH_CMD_RUN);
            if (k < 4) { in.ready = (uint8_t)(EXH_ARM_ALL & ~(1u << k)); }
            if (k == 4) { in.din = HEALTHY & ~(uint32_t)EXH_DIN_DEADMAN; }
            if (k == 5) { s.limits = EXH_LIMIT_FORCE | EXH_LIMIT_GATE; }
            (void)exh_safety_step(&s, &cfg, in);
            CHECK(s.state == EXH_STATE_OFF && s.faults == 0, "%s: %s", exh_arm_name(k),
                exh_state_name(s.state));
            CHECK_EQ_I64(exh_safety_arm_step(&s), 1u << k);
            CHECK_EQ_I64(s.refusals, 1);
            CHECK_EQ_I64(s.trigger, EXH_ON_REFUSED);
        }
    }
}

TEST(the_first_of_several_steps_is_named)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    struct exh_safety s = box_in(&cfg, EXH_STATE_OFF, 0);
    struct exh_safety_in in = with_cause(EXH_FAULT_ESTOP, EXH_CMD_RUN);
    in.ready = EXH_ARM_SELFTEST | EXH_ARM_ENCODER;
    (void)exh_safety_step(&s, &cfg, in);
    CHECK_EQ_I64(s.refused, EXH_ARM_CALIBRATION);
}

/* Once it runs, no refused step is reported any more. Only the number of refusals stays. */
TEST(a_refusal_is_forgotten_once_it_runs)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    struct exh_safety s = box_in(&cfg, EXH_STATE_OFF, 0);
    (void)exh_safety_step(&s, &cfg, with_cause(EXH_FAULT_ESTOP, EXH_CMD_RUN));
    CHECK_EQ_I64(exh_safety_arm_step(&s), EXH_ARM_DEADMAN);
    for (int i = 0; i < 5000 && !exh_safety_is_running(&s); i++) {
        (void)exh_safety_step(&s, &cfg, healthy(i == 0 ? EXH_CMD_RUN : EXH_CMD_NONE));
    }
    CHECK(exh_safety_is_running(&s), "%s", exh_state_name(s.state));
    CHECK_EQ_I64(exh_safety_arm_step(&s), 0);
    CHECK_EQ_I64(s.refusals, 1);
}

/* A step of arming may be lost while the limit rises: the force is released, not cut. */
TEST(a_step_lost_in_the_ramp_releases)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    struct exh_safety s = box_in(&cfg, EXH_STATE_ARM, 0);
    struct exh_safety_in in = healthy(EXH_CMD_NONE);
    CHECK_EQ_I64(exh_safety_arm_step(&s), EXH_ARM_RAMP);
    s.limits = EXH_LIMIT_FORCE; /* nothing to arming any more */
    (void)exh_safety_step(&s, &cfg, in);
    CHECK_EQ_I64(s.state, EXH_STATE_ARM);
    in.ready = EXH_ARM_ALL ^ EXH_ARM_POLARITY;
    (void)exh_safety_step(&s, &cfg, in);
    CHECK(s.state == EXH_STATE_RELEASE && s.faults == 0, "%s", exh_state_name(s.state));
}

TEST(off_while_arming)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    struct exh_safety s = box_in(&cfg, EXH_STATE_ARM, 1);
    (void)exh_safety_step(&s, &cfg, healthy(EXH_CMD_OFF));
    CHECK(s.state == EXH_STATE_OFF && s.refusals == 0, "closed: %s", exh_state_name(s.state));
    s = box_in(&cfg, EXH_STATE_ARM, 0);
    (void)exh_safety_step(&s, &cfg, healthy(EXH_CMD_OFF));
    CHECK_EQ_I64(s.state, EXH_STATE_RELEASE);
}

/* The ramp from both sides, at every rate: not below its line, not above by more than a step. */
TEST(arming_takes_its_time_at_every_rate)
{
    static const struct exh_safety_par normal = {1, 1 << 20, 50, 500, 15};
    for (uint32_t rate_Hz = 1; rate_Hz <= 2000; rate_Hz++) {
        const struct exh_safety_cfg cfg = cfg_of(normal, rate_Hz);
        const uint32_t small = rate_Hz * 50 / 1000 + 1 > 2 ? rate_Hz * 50 / 1000 + 1 : 2;
        const int64_t ramp = rate_Hz * 500 / 1000 + 1;
        struct exh_safety s = {0};
        int64_t last = 0;
        struct exh_permit p = exh_safety_step(&s, &cfg, healthy(EXH_CMD_RUN));
        for (uint32_t k = 1; k < small; k++) {
            CHECK(
                p.mode == EXH_PERMIT_CLOSED && p.small_N_q20 == 1 << 20, "early, tick %" PRIu32, k);
            p = exh_safety_step(&s, &cfg, healthy(EXH_CMD_NONE));
        }
        for (int64_t k = 1; k <= ramp; k++) {
            p = exh_safety_step(&s, &cfg, healthy(EXH_CMD_NONE));
            CHECK(p.mode == EXH_PERMIT_OPEN && s.state == EXH_STATE_ARM, "rate %" PRIu32, rate_Hz);
            CHECK(p.share_q30 * ramp >= k * FULL, "below the line, %" PRIu32 " Hz", rate_Hz);
            CHECK((p.share_q30 - k) * ramp <= k * FULL, "above the line, %" PRIu32 " Hz", rate_Hz);
            CHECK(p.share_q30 > last, "stands");
            last = p.share_q30;
        }
        CHECK_EQ_I64(last, FULL);
        p = exh_safety_step(&s, &cfg, healthy(EXH_CMD_NONE));
        CHECK(s.state == EXH_STATE_RUN && p.share_q30 == FULL, "rate %" PRIu32, rate_Hz);
    }
}

/* --- running --- */

TEST(limits_are_told_and_counted)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    for (unsigned k = 0; k < EXH_LIMITS; k++) {
        struct exh_safety s = box_in(&cfg, EXH_STATE_RUN, 0);
        memset(s.held, 0, sizeof s.held);
        for (int n = 0; n < 3; n++) {
            s.limits = 1u << k;
            (void)exh_safety_step(&s, &cfg, healthy(n == 1 ? EXH_CMD_RUN : EXH_CMD_CLEAR));
            CHECK_EQ_I64(s.state, 1u << k == EXH_LIMIT_PULL ? EXH_STATE_RUN : EXH_STATE_LIMIT);
        }
        for (unsigned j = 0; j < EXH_LIMITS; j++) { CHECK_EQ_I64(s.held[j], j == k ? 3 : 0); }
        s.limits = 0;
        (void)exh_safety_step(&s, &cfg, healthy(EXH_CMD_NONE));
        CHECK_EQ_I64(s.state, EXH_STATE_RUN);
        s.held[k] = UINT32_MAX;
        s.limits = 1u << k;
        (void)exh_safety_step(&s, &cfg, healthy(EXH_CMD_NONE));
        CHECK_EQ_I64(s.held[k], UINT32_MAX);
    }
}

TEST(missed_ticks_are_tolerated_up_to_the_limit)
{
    static const struct {
        int32_t max;
        uint32_t missed;
        uint8_t want;
    } row[] = {{0, 0, EXH_STATE_RUN}, {0, 1, EXH_STATE_RELEASE}, {1, 1, EXH_STATE_RUN},
        {1, 2, EXH_STATE_RELEASE}, {1, UINT32_MAX, EXH_STATE_RELEASE}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_safety_par p = par;
        struct exh_safety_cfg cfg;
        struct exh_safety s;
        struct exh_safety_in in = healthy(EXH_CMD_NONE);
        p.missed_max = row[i].max;
        cfg = cfg_of(p, 1000);
        s = box_in(&cfg, EXH_STATE_RUN, 0);
        in.missed = row[i].missed;
        (void)exh_safety_step(&s, &cfg, in);
        CHECK(s.state == row[i].want, "row %zu", i);
        CHECK_EQ_I64(s.missed, row[i].missed);
        in.missed = 7;
        (void)exh_safety_step(&s, &cfg, in);
        CHECK_EQ_I64(s.missed, row[i].missed > UINT32_MAX - 7 ? UINT32_MAX : row[i].missed + 7);
    }
}

/* Two missed in 64 ticks, or three, are too many; a tick that takes one and a half
 * periods misses every other one. */
TEST(late_too_often_is_an_overrun)
{
    static const struct {
        uint32_t every; /* one missed in so many ticks */
        int fault;
    } row[] = {{1, 1}, {2, 1}, {3, 1}, {5, 1}, {20, 1}, {63, 1}, {65, 0}, {1000, 0}};
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_safety s = box_in(&cfg, EXH_STATE_RUN, 0);
        for (uint32_t n = 0; n < 10000; n++) {
            struct exh_safety_in in = healthy(EXH_CMD_NONE);
            in.missed = n % row[i].every == 0;
            (void)exh_safety_step(&s, &cfg, in);
        }
        CHECK((s.state == EXH_STATE_FAULT) == row[i].fault, "one in %" PRIu32, row[i].every);
        CHECK((s.first == EXH_FAULT_OVERRUN) == row[i].fault, "one in %" PRIu32, row[i].every);
    }
}

/* However long it was late, it is over when it has been in time for 4 times 64 ticks. */
TEST(an_overrun_is_gone_in_time)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    struct exh_safety s = box_in(&cfg, EXH_STATE_RUN, 0);
    struct exh_safety_in in = healthy(EXH_CMD_NONE);
    in.missed = 1;
    for (int n = 0; n < 10000; n++) { (void)exh_safety_step(&s, &cfg, in); }
    in.missed = 0;
    for (int n = 0; n < 4 * EXH_LATE_TICKS; n++) {
        (void)exh_safety_step(&s, &cfg, in);
        if (n < EXH_LATE_TICKS) { CHECK(s.present & EXH_FAULT_OVERRUN, "gone after %d", n); }
    }
    CHECK_EQ_I64(s.present, 0);
    CHECK_EQ_I64(s.faults, EXH_FAULT_OVERRUN);
}

TEST(only_drives_in_use_count)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    for (uint8_t n = 1; n <= 5; n++) {
        for (unsigned d = 0; d < 5; d++) {
            struct exh_safety s = box_in(&cfg, EXH_STATE_RUN, 0);
            struct exh_safety_in in = healthy(EXH_CMD_NONE);
            in.fingers = n;
            in.din &= ~((uint32_t)EXH_DIN_DRIVE0 << d);
            (void)exh_safety_step(&s, &cfg, in);
            CHECK(
                s.state == (d < n ? EXH_STATE_FAULT : EXH_STATE_RUN), "%u fingers, drive %u", n, d);
        }
    }
}

/* --- the release --- */

/* Ticks of RELEASE for a cause that stays and for a command that is given on and on: neither holds
 * the gate open. Missed ticks count. Below 500 Hz there are 4 at most. */
TEST(release_ends_at_every_rate)
{
    static const int32_t ms[] = {5, 15, 18};
    for (uint32_t k = 0; k < 2000 * LEN(ms) * 3; k++) {
        const uint32_t rate_Hz = 1 + k % 2000, missed = k / 2000 / LEN(ms) == 2;
        const struct exh_safety_par p = {1, 1 << 20, 3, 7, ms[k / 2000 % LEN(ms)]};
        const struct exh_safety_cfg cfg = cfg_of(p, rate_Hz);
        const uint32_t floor = (uint32_t)p.release_ms * rate_Hz / 1000,
                       most = rate_Hz < 500 ? 4 : 36;
        const uint32_t want = floor < 3 ? 3 : floor > most ? most : floor;
        const int fault = k / 2000 / LEN(ms) > 0;
        struct exh_safety s = {0};
        uint32_t n = 0;
        s.state = EXH_STATE_RUN;
        do {
            struct exh_safety_in in =
                fault ? with_cause(EXH_FAULT_DEADMAN, EXH_CMD_RUN) : healthy(EXH_CMD_OFF);
            in.missed = missed;
            (void)exh_safety_step(&s, &cfg, in);
        } while (s.state == EXH_STATE_RELEASE && n++ < 10000);
        CHECK(
            n == (missed ? (want + 1) / 2 : want), "%" PRIu32 " Hz: %" PRIu32 " ticks", rate_Hz, n);
        CHECK_EQ_I64(s.state, fault ? EXH_STATE_FAULT : EXH_STATE_OFF);
    }
}

/* --- clearing --- */

/* All sequences of six ticks. Each tick is healthy with a command to clear, healthy, let go, or has
 * the cause. The first tick leaves FAULT that clears, is held, has no cause, and follows a tick let
 * go after the last cause. */
TEST(clearing_in_every_order)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    unsigned cleared = 0;
    for (unsigned code = 0; code < 4096; code++) {
        struct exh_safety s = box_in(&cfg, EXH_STATE_FAULT, 0); /* e-stop */
        int opened = 0, left = 0;
        for (unsigned k = 0; k < 6 && !left; k++) {
            const unsigned what = code >> 2 * k & 3u;
            const uint32_t fault = what == 2 ? EXH_FAULT_DEADMAN : what == 3 ? EXH_FAULT_LINK : 0;
            struct exh_safety_in in = with_cause(fault, what == 1 ? EXH_CMD_RUN : EXH_CMD_CLEAR);
            if (what >= 2) { opened = what == 2; }
            (void)exh_safety_step(&s, &cfg, in);
            left = what == 0 && opened;
            CHECK((s.state == EXH_STATE_OFF) == left, "sequence %u, tick %u", code, k);
        }
        if (left) { CHECK_EQ_I64(s.faults, 0); }
        cleared += (unsigned)left;
    }
    CHECK(cleared > 500 && cleared < 3500, "%u of 4096 cleared", cleared);
}

/* The cause of the fault itself comes back, while the switch is open or held: one more grip. */
TEST(a_cause_that_comes_back_asks_for_the_hand_again)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    const uint32_t open = EXH_FAULT_DEADMAN;
    for (int held = 0; held < 2; held++) {
        struct exh_safety s = box_in(&cfg, EXH_STATE_FAULT, 0); /* e-stop */
        struct exh_safety_in again = with_cause(EXH_FAULT_ESTOP, EXH_CMD_NONE);
        if (!held) { again.din &= ~(uint32_t)EXH_DIN_DEADMAN; }
        (void)exh_safety_step(&s, &cfg, with_cause(open, EXH_CMD_NONE));
        (void)exh_safety_step(&s, &cfg, again);
        (void)exh_safety_step(&s, &cfg, healthy(EXH_CMD_CLEAR));
        CHECK(s.state == EXH_STATE_FAULT && s.opened == 0, "held %d: cleared unseen", held);
        (void)exh_safety_step(&s, &cfg, with_cause(open, EXH_CMD_CLEAR));
        CHECK_EQ_I64(s.state, EXH_STATE_FAULT);
        (void)exh_safety_step(&s, &cfg, healthy(EXH_CMD_CLEAR));
        CHECK_EQ_I64(s.state, EXH_STATE_OFF);
    }
}

TEST(a_fault_never_clears_by_itself)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    struct exh_safety s = box_in(&cfg, EXH_STATE_FAULT, 0);
    const uint32_t first_tick = s.first_tick;
    for (int k = 0; k < 1000; k++) {
        (void)exh_safety_step(
            &s, &cfg, with_cause(k % 7 ? 0 : EXH_FAULT_DEADMAN, k % 3 ? EXH_CMD_RUN : EXH_CMD_OFF));
        CHECK_EQ_I64(s.state, EXH_STATE_FAULT);
    }
    CHECK(s.first == EXH_FAULT_ESTOP && s.first_tick == first_tick, "first");
    (void)exh_safety_step(&s, &cfg, healthy(EXH_CMD_CLEAR));
    CHECK(s.state == EXH_STATE_OFF && s.first == EXH_FAULT_ESTOP, "cleared");
}

/* --- damaged --- */

TEST(a_state_that_cannot_be_is_a_fault)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    for (unsigned v = 0; v < 256; v++) {
        for (uint32_t faults = 0; faults < 2; faults++) {
            const int sane = v == EXH_STATE_FAULT     ? faults != 0
                             : v == EXH_STATE_RELEASE ? 1
                                                      : v < EXH_STATES && faults == 0;
            struct exh_safety s = {0};
            s.state = (uint8_t)v;
            s.faults = faults;
            s.opened = 1;
            (void)exh_safety_step(&s, &cfg, healthy(EXH_CMD_CLEAR));
            CHECK((s.state == EXH_STATE_FAULT && (s.faults & EXH_FAULT_LOGIC)) == !sane,
                "%u with %" PRIu32, v, faults);
        }
    }
}

static uint32_t bytes_of(struct exh_safety *s, uint8_t *buf, size_t cap)
{
    struct exh_bytes c = exh_bytes_writer(buf, cap);
    exh_safety_serialize(&c, s);
    CHECK(exh_bytes_ok(&c), "writer");
    return c.at;
}

/* Every value of every byte, of every state whose gate is closed: it stays so. */
TEST(no_byte_of_a_state_opens_the_gate)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    static const uint8_t closed[] = {EXH_STATE_OFF, EXH_STATE_ARM, EXH_STATE_FAULT};
    for (size_t i = 0; i < LEN(closed); i++) {
        struct exh_safety s = box_in(&cfg, closed[i], 1), back;
        uint8_t buf[128];
        const uint32_t len = bytes_of(&s, buf, sizeof buf);
        for (uint32_t at = 0; at < len; at++) {
            const uint8_t right = buf[at];
            for (unsigned v = 0; v < 256; v++) {
                struct exh_bytes c = exh_bytes_reader(buf, len);
                buf[at] = (uint8_t)v;
                memset(&back, 0xA5, sizeof back);
                exh_safety_serialize(&c, &back);
                CHECK(v == right || back.state == EXH_STATE_FAULT, "byte %" PRIu32 ": %u", at, v);
                CHECK(!exh_safety_is_open(&back), "open");
                (void)exh_safety_step(&back, &cfg, healthy(EXH_CMD_CLEAR));
                CHECK(v == right || back.state == EXH_STATE_FAULT, "stepped");
            }
            buf[at] = right;
        }
        for (uint32_t cut = 0; cut < len; cut++) {
            struct exh_bytes c = exh_bytes_reader(buf, cut);
            exh_safety_serialize(&c, &back);
            CHECK(back.state == EXH_STATE_FAULT && !exh_bytes_ok(&c), "cut at %" PRIu32, cut);
        }
    }
}

TEST(state_round_trip)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    for (uint8_t state = 0; state < EXH_STATES; state++) {
        struct exh_safety s = box_in(&cfg, state, 0), back;
        uint8_t buf[128], again[128];
        uint32_t len;
        struct exh_bytes c;
        for (unsigned k = 0; k < EXH_LIMITS; k++) { s.held[k] = 0x01020304u * (k + 1); }
        len = bytes_of(&s, buf, sizeof buf);
        CHECK_EQ_I64(len, 4 * 23 + 5 + 2 * EXH_FINGERS + 4);
        memset(&back, 0xA5, sizeof back);
        c = exh_bytes_reader(buf, len);
        exh_safety_serialize(&c, &back);
        CHECK(exh_bytes_ok(&c) && bytes_of(&back, again, sizeof again) == len, "read");
        CHECK(memcmp(buf, again, len) == 0 && back.state == state, "state %u", state);
        c = exh_bytes_measure();
        exh_safety_serialize(&c, &back);
        CHECK_EQ_I64(c.at, len);
    }
}

TEST(setup_refuses_what_is_out_of_range)
{
    const struct exh_period T = {1, 1000}, none = {0, 1};
    for (size_t r = 0; r < EXH_SAFETY_ROWS; r++) {
        const struct exh_signal *row = &exh_safety_rows[r];
        const int32_t v[] = {row->min, row->max, row->min - 1, row->max + 1};
        for (size_t k = 0; k < LEN(v); k++) {
            struct exh_safety_par p = par;
            struct exh_safety_cfg cfg;
            ((int32_t *)&p)[r] = v[k];
            CHECK_EQ_I64(exh_safety_setup(&cfg, &p, T), k < 2 ? 0 : -EXH_E_RANGE);
            CHECK_EQ_I64(exh_safety_setup(&cfg, &p, none), k < 2 ? -EXH_E_RATE : -EXH_E_RANGE);
        }
    }
}

TEST(names_are_all_there)
{
    static const char *(*const of[])(unsigned) = {
        exh_state_name, exh_trigger_name, exh_fault_name, exh_limit_name, exh_arm_name};
    static const unsigned n[] = {EXH_STATES, EXH_TRIGGERS, EXH_FAULTS, EXH_LIMITS, EXH_ARMS};
    for (size_t k = 0; k < LEN(of); k++) {
        for (unsigned i = 0; i < n[k]; i++) { CHECK(of[k](i)[0] != '\0', "%zu %u", k, i); }
        CHECK(of[k](n[k])[0] == '\0' && of[k](UINT32_MAX)[0] == '\0', "%zu: beyond", k);
    }
    CHECK(check_same_text(exh_fault_name(14), "logic"), "logic");
    CHECK(check_same_text(exh_limit_name(10), "passivity"), "passivity");
}

/* A dump that has no room is no reason to stop. */
TEST(a_buffer_too_short_changes_no_state)
{
    const struct exh_safety_cfg cfg = cfg_of(par, 1000);
    for (uint32_t cap = 0; cap < 128; cap++) {
        struct exh_safety s = box_in(&cfg, EXH_STATE_RUN, 0);
        const uint8_t opened = s.opened;
        uint8_t buf[128];
        struct exh_bytes c = exh_bytes_writer(buf, cap);
        exh_safety_serialize(&c, &s);
        CHECK(s.state == EXH_STATE_RUN && s.faults == 0 && s.opened == opened, "%" PRIu32 " bytes",
            cap);
    }
}

/* A damaged image is a separate fault, beside those that it holds. */
TEST(damage_forgets_no_fault)
{
    struct exh_safety was = {.faults = EXH_FAULT_ENCODER, .state = EXH_STATE_FAULT}, now = {0};
    uint8_t image[256];
    struct exh_bytes c = exh_bytes_writer(image, sizeof image);
    exh_safety_serialize(&c, &was);
    image[c.at - 1] ^= 1;
    c = exh_bytes_reader(image, c.at);
    exh_safety_serialize(&c, &now);
    CHECK_EQ_I64(now.faults, EXH_FAULT_ENCODER | EXH_FAULT_LOGIC);
}

TEST_MAIN("unit/safety", every_cell_is_what_it_should_be, every_state_is_reached,
    every_fault_in_every_state, several_causes_cut_if_one_of_them_does, power_on_is_off,
    each_step_is_named_where_it_does_not_hold, the_first_of_several_steps_is_named,
    a_refusal_is_forgotten_once_it_runs, a_step_lost_in_the_ramp_releases, off_while_arming,
    arming_takes_its_time_at_every_rate, limits_are_told_and_counted,
    missed_ticks_are_tolerated_up_to_the_limit, late_too_often_is_an_overrun,
    an_overrun_is_gone_in_time, only_drives_in_use_count, release_ends_at_every_rate,
    clearing_in_every_order, a_cause_that_comes_back_asks_for_the_hand_again,
    a_fault_never_clears_by_itself, a_state_that_cannot_be_is_a_fault,
    no_byte_of_a_state_opens_the_gate, state_round_trip, setup_refuses_what_is_out_of_range,
    names_are_all_there, a_buffer_too_short_changes_no_state, damage_forgets_no_fault);
