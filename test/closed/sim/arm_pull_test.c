/* SPDX-License-Identifier: MIT */
/* Arming's small pull in the full box. It arms with a free hand. Anything exchanged since the
 * calibration makes it refuse at polarity, at a small force, for any finger. */
#include "check.h"

#include "box/hand.h"

#include <math.h>
#include <string.h>

#define PULL_N 0.3
#define THREE  (1u << EXH_THUMB | 1u << EXH_INDEX | 1u << EXH_LITTLE)

enum fault { WELL, MOTOR, ENCODER, BOTH, DEAD_ENCODER };

static struct {
    enum fault fault;
    unsigned finger;
    uint32_t first; /* count of its encoder at first */
    int counted;
} wrong;

static struct {
    double most_A, most_m, run_s; /* of all fingers until it ran; how far a string moved */
    int32_t first_m_q30[EXH_FINGERS];
    int ran;
} saw;

static void wires_in(struct exh_drive_in *in)
{
    uint32_t *enc = &in->enc_raw[wrong.finger];
    if (!wrong.counted) { wrong.first = *enc; }
    wrong.counted = 1;
    if (wrong.fault == ENCODER || wrong.fault == BOTH) { *enc = 2 * wrong.first - *enc; }
    if (wrong.fault == DEAD_ENCODER) { *enc = wrong.first; }
    if (wrong.fault == MOTOR || wrong.fault == BOTH) {
        in->mon_raw[wrong.finger] = (int16_t)-in->mon_raw[wrong.finger];
    }
}

/* Zero is the default parameters'. The drive's own monitor does not see where its leads go. */
static void wires_out(struct exh_drive_out *out)
{
    uint16_t *dac = &out->dac_raw[wrong.finger];
    if (wrong.fault == MOTOR || wrong.fault == BOTH) { *dac = (uint16_t)(65536 - *dac); }
}

static void begin(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    (void)board;
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    const struct bilateral_signals *sig = (const void *)exh_scene_signals(&exh_scene_bilateral);
    in->command = tick == 10 ? EXH_CMD_RUN : EXH_CMD_NONE;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const double m = (sig->paper[f].q_m_q30 - saw.first_m_q30[f]) * 0x1p-30;
        if (tick == 5) { saw.first_m_q30[f] = sig->paper[f].q_m_q30; }
        if (tick <= 5 || saw.ran) { continue; }
        saw.most_A = fmax(saw.most_A, sig->paper[f].i_des_A_q26 * 0x1p-26);
        saw.most_m = fmax(saw.most_m, fabs(m));
    }
    if (sig->box.state == EXH_STATE_RUN && !saw.ran) {
        saw.ran = 1;
        saw.run_s = posix_time_s();
    }
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    (void)tick;
    (void)in;
    (void)out;
}

/* Two seconds of a hand that does not press; pull 0: without. */
static struct bilateral_box arm(enum fault fault, unsigned finger, uint32_t rate_Hz, double pull_N)
{
    static const struct exh_loop_hooks more = {begin, before, after};
    const struct run_setting set[] = {{"arm_pull", pull_N}, {"glove_fc", rate_Hz < 500 ? 20 : 200}};
    struct bilateral_run_cfg c;
    struct bilateral_run r;
    memset(&c, 0, sizeof c);
    memset(&saw, 0, sizeof saw);
    memset(&wrong, 0, sizeof wrong);
    wrong.fault = fault;
    wrong.finger = finger;
    c.rate_Hz = rate_Hz;
    c.board = posix_config_default();
    c.board.exo = sim_exo_default();
    c.board.exo.fingers = THREE;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        c.board.exo.path[f].first_s = 9;
        c.board.exo.path[f].approaches = 1;
    }
    c.board.max_ticks = 2 * rate_Hz;
    c.board.wires_in = wires_in;
    c.board.wires_out = wires_out;
    c.setting = set;
    c.settings = LEN(set);
    c.k_Npm = 200; /* inside the rule of gains at each of the rates */
    c.b_Nspm = 2;
    c.at_m = 0.03;
    c.fps = 100;
    c.until_s = 1e30;
    c.more = &more;
    (void)bilateral_run(&c, &r);
    bilateral_run_free(&r);
    return r.box;
}

TEST(a_free_hand_arms)
{
    static const uint32_t rate_Hz[] = {90, 500, 2000};
    for (size_t i = 0; i < LEN(rate_Hz); i++) {
        const struct bilateral_box without = arm(WELL, 0, rate_Hz[i], 0);
        const double run_s = saw.run_s;
        struct bilateral_box box;
        CHECK(saw.ran && without.faults == 0, "%u Hz: state %d", (unsigned)rate_Hz[i],
            (int)without.state);
        box = arm(WELL, 0, rate_Hz[i], PULL_N);
        printf("    %u Hz: runs %.3f s later, at up to %.4f A, %.2f mm\n", (unsigned)rate_Hz[i],
            saw.run_s - run_s, saw.most_A, saw.most_m * 1e3);
        CHECK(saw.ran && box.faults == 0 && box.arm_step == 0, "%u Hz: state %d, refused at %d",
            (unsigned)rate_Hz[i], (int)box.state, (int)box.arm_step);
        CHECK(saw.run_s - run_s > 0.1 && saw.run_s - run_s < 0.4, "%.3f s", saw.run_s - run_s);
    }
}

TEST(what_is_exchanged_refuses_at_polarity)
{
    static const enum fault fault[] = {MOTOR, ENCODER, DEAD_ENCODER};
    static const unsigned finger[] = {EXH_THUMB, EXH_INDEX, EXH_LITTLE};
    for (size_t i = 0; i < LEN(fault); i++) {
        for (size_t f = 0; f < LEN(finger); f++) {
            const struct bilateral_box box = arm(fault[i], finger[f], 500, PULL_N);
            printf("    fault %d, finger %u: %.4f A, %.2f mm\n", (int)fault[i], finger[f],
                saw.most_A, saw.most_m * 1e3);
            CHECK(!saw.ran && box.arm_step == EXH_ARM_POLARITY && box.state == EXH_STATE_OFF,
                "fault %d, finger %u: state %d, refused at %d, faults %x", (int)fault[i], finger[f],
                (int)box.state, (int)box.arm_step, (unsigned)box.faults);
            CHECK(saw.most_A < 1.05 * PULL_N / 3.339, "%.4f A", saw.most_A);
        }
    }
}

/* Without the pull, a box with exchanged leads runs. The pull does not detect two exchanges. */
TEST(without_it_nothing_is_seen)
{
    const struct bilateral_box box = arm(MOTOR, EXH_INDEX, 500, 0);
    CHECK(saw.ran && box.arm_step != EXH_ARM_POLARITY, "refused at %d", (int)box.arm_step);
    (void)arm(BOTH, EXH_INDEX, 500, PULL_N);
    CHECK(saw.ran, "both exchanged were told: say so in polarity.h");
}

TEST_MAIN("sim/arm_pull", a_free_hand_arms, what_is_exchanged_refuses_at_polarity,
    without_it_nothing_is_seen);
