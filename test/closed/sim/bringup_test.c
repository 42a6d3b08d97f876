/* SPDX-License-Identifier: MIT */
/* First power-up, rehearsed. Every stage passes if all is well, with any finger, with and without
 * the cards. A fault ends a stage within stated limits of time, current and travel. After that no
 * current flows. */
#include "said.h"

#include "bench/bringup_run.h"
#include "posix.h"

#include "exhand/error.h"

static struct bringup_run r;

static const char *const reads[BRINGUP_STAGES + 1] = {
    "", "", "", "", " read1=0.4 read2=0.85 read3=1.29", ""};

static struct bringup_run_cfg config(uint64_t seed)
{
    struct bringup_run_cfg c;
    memset(&c, 0, sizeof c);
    c.rate_Hz = 1000;
    c.wrong_phase = -1;
    c.board = posix_config_default();
    c.board.seed = seed;
    return c;
}

static int run_stage(
    struct bringup_run_cfg c, int stage, int finger, uint32_t shown, const char *more)
{
    char boot[200];
    snprintf(boot, sizeof boot, "stage=%d finger=%d shown=%lu%s%s", stage, finger,
        (unsigned long)shown, reads[stage], more);
    c.boot = boot;
    return bringup_run(&c, &r);
}

/* What the stages below this one print. */
static uint32_t shown_before(int stage, int finger)
{
    static uint32_t number[EXH_FINGERS][BRINGUP_STAGES + 1];
    for (int k = 1; k < stage; k++) {
        if (number[finger][k] != 0) { continue; }
        CHECK_EQ_I64(run_stage(config(1), k, finger, number[finger][k - 1], ""), 0);
        CHECK(r.result == EXH_PROBE_DONE, "stage %d, finger %d: %s", k, finger,
            bringup_result_text(r.result));
        number[finger][k] = r.number;
    }
    return number[finger][stage - 1];
}

TEST(every_stage_comes_through)
{
    for (int finger = 0; finger < EXH_FINGERS; finger++) {
        for (int stage = 1; stage <= BRINGUP_STAGES; stage++) {
            const uint32_t shown = shown_before(stage, finger);
            for (unsigned seed = 1; seed <= 4; seed++) {
                struct bringup_run_cfg c = config(seed);
                c.board.cards.how = seed == 4 ? POSIX_CARDS_INSTANT : POSIX_CARDS_NONE;
                CHECK_EQ_I64(run_stage(c, stage, finger, shown, ""), 0);
                CHECK(r.result == EXH_PROBE_DONE && r.unsafe == 0 && r.number > 0,
                    "stage %d, finger %d, seed %u: %s, %lu", stage, finger, seed,
                    bringup_result_text(r.result), r.unsafe);
                CHECK((stage > 1) == (r.most_A > 0), "stage %d: %.3f A", stage, r.most_A);
            }
        }
    }
}

TEST(at_any_rate)
{
    static const uint32_t rate_Hz[] = {200, 500, 2000, 10000};
    for (size_t i = 0; i < LEN(rate_Hz); i++) {
        for (int stage = 1; stage <= BRINGUP_STAGES; stage++) {
            struct bringup_run_cfg c = config(1);
            c.rate_Hz = rate_Hz[i];
            CHECK_EQ_I64(run_stage(c, stage, 0, shown_before(stage, 0), ""), 0);
            CHECK(r.result == EXH_PROBE_DONE, "%lu Hz, stage %d: %s", (unsigned long)rate_Hz[i],
                stage, bringup_result_text(r.result));
        }
    }
}

/* Highest current a stage may have put out: its limit, and a code. */
static double limit_A(int stage)
{
    static const double A[BRINGUP_STAGES + 1] = {0, 0, 0.3, 0.2, 1.5 / 3.339, 1 / 3.339};
    return A[stage] + 0.0006;
}

/* Each fault in each phase of each stage in which it can be met: how late, what it did. In s, m. */
struct limit {
    enum bringup_wrong wrong;
    int stage, phase; /* -1: at power-on */
    int result;       /* enum bringup_result */
    double s, m;
};

static void ends(const struct limit *l, int cards)
{
    struct bringup_run_cfg c = config(3);
    const char *name = bringup_wrong_row[l->wrong].name;
    c.wrong = l->wrong;
    c.wrong_phase = l->phase;
    c.board.cards.how = cards ? POSIX_CARDS_INSTANT : POSIX_CARDS_NONE;
    CHECK_EQ_I64(
        run_stage(c, l->stage, cards ? 4 : 0, shown_before(l->stage, cards ? 4 : 0), ""), 0);
    CHECK(r.result == (unsigned)l->result, "stage %d, phase %d, %s: %s in phase %u", l->stage,
        l->phase, name, bringup_result_text(r.result), r.phase);
    CHECK(r.took_s <= l->s, "stage %d, phase %d, %s: after %.3f s", l->stage, l->phase, name,
        r.took_s);
    CHECK(r.unsafe == 0, "stage %d, phase %d, %s: %lu", l->stage, l->phase, name, r.unsafe);
    CHECK(r.most_A <= limit_A(l->stage), "stage %d, phase %d, %s: %.4f A", l->stage, l->phase, name,
        r.most_A);
    CHECK(r.moved_m <= l->m && r.moved_m >= -l->m, "stage %d, phase %d, %s: %.4f m", l->stage,
        l->phase, name, r.moved_m);
}

static void end_all(const struct limit *l, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        ends(&l[i], 0);
        ends(&l[i], 1);
    }
}

TEST(wrong_polarity)
{
    static const struct limit row[] = {
        {BRINGUP_ENCODER_REVERSED, 1, -1, EXH_PROBE_WRONG_WAY, 2, 0},
        {BRINGUP_ENCODER_REVERSED, 3, -1, EXH_PROBE_WRONG_WAY, 2, 0},
        {BRINGUP_MOTOR_REVERSED, 3, -1, EXH_PROBE_WRONG_WAY, 1, 0.001},
        {BRINGUP_MOTOR_REVERSED, 4, -1, EXH_PROBE_WRONG_WAY, 0.1, 0.002},
    };
    end_all(row, LEN(row));
}

TEST(encoder_unplugged)
{
    static const struct limit row[] = {
        {BRINGUP_UNPLUGGED, 1, -1, EXH_PROBE_STILL, 120.1, 0},
        {BRINGUP_UNPLUGGED, 3, -1, EXH_PROBE_STILL, 120.1, 0},
        {BRINGUP_UNPLUGGED, 5, -1, EXH_PROBE_STILL, 120.1, 0},
        {BRINGUP_COMES_OFF, 3, 2, EXH_PROBE_STILL, 3.2, 0.151}, /* the string is in */
        {BRINGUP_COMES_OFF, 4, 2, EXH_PROBE_JAM, 0.1, 0.151},   /* 0.2 s into home */
        {BRINGUP_COMES_OFF, 4, 3, EXH_PROBE_STILL, 6, 0.001},
        {BRINGUP_COMES_OFF, 5, 2, EXH_PROBE_STILL, 6, 0.003},
        {BRINGUP_STUCK, 3, -1, EXH_PROBE_STILL, 3.2, 0},
        {BRINGUP_STUCK, 4, -1, EXH_PROBE_JAM, 0.1, 0},
    };
    end_all(row, LEN(row));
}

TEST(monitor_dead_or_half)
{
    static const struct limit row[] = {
        {BRINGUP_MONITOR_DEAD, 1, 3, BRINGUP_MONITOR, 0.1, 0},
        {BRINGUP_MONITOR_DEAD, 2, -1, BRINGUP_MONITOR, 0.2, 0},
        {BRINGUP_MONITOR_DEAD, 2, 1, BRINGUP_MONITOR, 0.1, 0},
        {BRINGUP_MONITOR_DEAD, 3, -1, BRINGUP_MONITOR, 0.1, 0.005},
        {BRINGUP_MONITOR_DEAD, 4, 3, BRINGUP_MONITOR, 0.1, 0.001},
        {BRINGUP_MONITOR_DEAD, 5, 2, BRINGUP_MONITOR, 0.1, 0.003},
        {BRINGUP_MONITOR_HALF, 1, 3, BRINGUP_MONITOR, 0.1, 0},
        {BRINGUP_MONITOR_HALF, 2, -1, BRINGUP_MONITOR, 0.2, 0},
        {BRINGUP_MONITOR_HALF, 3, -1, BRINGUP_MONITOR, 0.1, 0.005},
        {BRINGUP_MONITOR_HALF, 5, 2, BRINGUP_MONITOR, 0.1, 0.003},
    };
    end_all(row, LEN(row));
}

/* It keeps what it has; seen when it should change. */
TEST(da_never_moves)
{
    static const struct limit row[] = {
        {BRINGUP_DA_STILL, 1, -1, BRINGUP_MONITOR, 0.2, 0},
        {BRINGUP_DA_STILL, 2, -1, BRINGUP_MONITOR, 0.2, 0},
        {BRINGUP_DA_STILL, 3, -1, BRINGUP_MONITOR, 1, 0},
        {BRINGUP_DA_STILL, 5, -1, BRINGUP_MONITOR, 0.2, 0},
        {BRINGUP_DA_STILL, 2, 1, BRINGUP_MONITOR, 3, 0},
        {BRINGUP_DA_STILL, 4, 3, BRINGUP_MONITOR, 3, 0.001},
        {BRINGUP_DA_STILL, 5, 2, BRINGUP_MONITOR, 3, 0.003},
    };
    end_all(row, LEN(row));
}

/* Of drive, emergency stop and dead-man: in the tick that sees it. */
TEST(what_is_open_ends_it_at_once)
{
    for (int stage = 1; stage <= BRINGUP_STAGES; stage++) {
        for (int phase = 0; bringup_phase((unsigned)stage, (unsigned)phase) != NULL; phase++) {
            const struct bringup_phase *p = bringup_phase((unsigned)stage, (unsigned)phase);
            for (enum bringup_wrong w = BRINGUP_NOT_READY; w <= BRINGUP_LET_GO; w++) {
                const struct limit l = {
                    w, stage, phase, BRINGUP_OFF, 0.0011, stage == 5 ? 0.004 : 0.004};
                if (p->hands || (stage == 1 && w == BRINGUP_NOT_READY)) { continue; }
                if (p->ask == BRINGUP_ASK_NOTHING && stage == 3 && phase > 2) {
                    continue;
                } /* shorter than 0.2 s */
                if (stage == 4 && phase == 2) {
                    continue;
                } /* homing: it moves as far as it is in */
                ends(&l, 0);
                ends(&l, 1);
            }
        }
    }
}

/* The code is 0 A in that tick even where forces may fall no faster than 1 N a tick. */
TEST(no_slope_delays_the_end)
{
    static const char slow[] = " slew_down=1000 f_string=10 ramp=1000";
    for (enum bringup_wrong w = BRINGUP_MONITOR_DEAD; w <= BRINGUP_LET_GO; w++) {
        struct bringup_run_cfg c = config(1);
        CHECK_EQ_I64(run_stage(c, 4, 0, 0, slow), 0);
        c.wrong = w;
        c.wrong_phase = 3;
        CHECK_EQ_I64(run_stage(c, 4, 0, bringup_config()->before, slow), 0);
        CHECK(r.result > EXH_PROBE_DONE && r.phase == 3 && r.most_A > 0.9 && r.unsafe == 0,
            "%s: %s, %.3f A, %lu", bringup_wrong_row[w].name, bringup_result_text(r.result),
            r.most_A, r.unsafe);
    }
}

/* Before anything runs: what the person learns when the switch is taken. */
TEST(nothing_begins_with_an_open_loop)
{
    for (int stage = 1; stage <= BRINGUP_STAGES; stage++) {
        const struct limit stop = {
            BRINGUP_ESTOP, stage, -1, stage == 1 ? BRINGUP_INPUT : BRINGUP_OFF, 120.1, 0.0};
        const struct limit ready = {BRINGUP_NOT_READY, stage, -1, stop.result, 120.1, 0.0};
        const struct limit away = {BRINGUP_AWAY, stage, -1,
            stage == 2 ? (int)BRINGUP_NOBODY : (int)EXH_PROBE_STILL, 120.1, 0.0};
        ends(&stop, 0);
        ends(&ready, 1);
        ends(&away, 0);
        CHECK(r.most_A <= 0, "stage %d: %.4f A", stage, r.most_A);
    }
}

/* What a limit cuts down, though no doubt was before the gate, is not put out either. */
TEST(a_limit_that_acts_ends_it_at_once)
{
    static const char *const low[] = {" f_max=0.7", " i_cont=0.1 i_peak=0.25"};
    for (int stage = 4; stage <= BRINGUP_STAGES; stage++) {
        for (size_t i = 0; i < LEN(low); i++) {
            const char *more = stage == 4 ? "" : " f_finger=2";
            char boot[80];
            snprintf(boot, sizeof boot, "%s%s", low[i], more);
            CHECK_EQ_I64(run_stage(config(1), stage, 0, 0, boot), 0);
            CHECK_EQ_I64(run_stage(config(1), stage, 0, bringup_config()->before, boot), 0);
            CHECK(r.result == BRINGUP_LIMITED && r.most_A > 0.1 && r.unsafe == 0,
                "stage %d,%s: %s, %.3f A, %lu", stage, boot, bringup_result_text(r.result),
                r.most_A, r.unsafe);
        }
    }
}

/* A switch that was taken in the phase before says nothing about what this one asks. */
TEST(held_before_the_question_is_no_answer)
{
    static const struct limit row[] = {
        {BRINGUP_HELD, 1, 2, BRINGUP_NOBODY, 120.1, 0},
        {BRINGUP_HELD, 2, -1, BRINGUP_NOBODY, 120.1, 0},
        {BRINGUP_HELD, 3, 0, BRINGUP_NOBODY, 120.1, 0},
        {BRINGUP_HELD, 4, 0, BRINGUP_NOBODY, 120.1, 0},
        {BRINGUP_HELD, 5, 0, BRINGUP_NOBODY, 120.1, 0.004},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        for (int cards = 0; cards < 2; cards++) {
            ends(&row[i], cards);
            CHECK(r.most_A <= 0, "stage %d: %.4f A", row[i].stage, r.most_A);
        }
    }
}

TEST(a_string_let_loose_ends_it)
{
    static const struct limit row[] = {{BRINGUP_SLIPPED, 4, 3, EXH_PROBE_TRAVEL, 2, 0.035}};
    end_all(row, LEN(row));
}

/* A D/A that says it moved and did not, in the card itself. */
TEST(a_mute_card_is_seen_by_the_monitor)
{
    for (int stage = 2; stage <= BRINGUP_STAGES; stage++) {
        struct bringup_run_cfg c = config(1);
        c.board.cards.how = POSIX_CARDS_INSTANT;
        c.board.cards.fault.kind = EMU_DA_MUTE;
        c.board.cards.fault.card = EMU_S526_A;
        c.board.cards.fault.phase = EMU_PHASE_WRITE;
        c.board.cards.fault.after = 1;
        CHECK_EQ_I64(run_stage(c, stage, 0, shown_before(stage, 0), ""), 0);
        CHECK(r.result == BRINGUP_MONITOR && r.took_s < 1 && r.unsafe == 0,
            "stage %d: %s after %.3f s", stage, bringup_result_text(r.result), r.took_s);
    }
}

TEST(speed_is_limited)
{
    CHECK_EQ_I64(run_stage(config(1), 3, 0, shown_before(3, 0), " v_max=0.05 v_trip=0.5"), 0);
    CHECK(r.result == BRINGUP_SPEED && r.took_s < 0.1 && r.unsafe == 0, "%s after %.3f s",
        bringup_result_text(r.result), r.took_s);
    CHECK(r.moved_m > -0.005, "%.4f m", r.moved_m);
}

TEST(the_balance_must_read_what_was_commanded)
{
    struct bringup_run_cfg c = config(1);
    const struct sim_device d = sim_device_default();
    char boot[160];
    snprintf(boot, sizeof boot, "stage=4 shown=%lu", (unsigned long)shown_before(4, 0));
    c.boot = boot;
    CHECK_EQ_I64(bringup_run(&c, &r), 0);
    CHECK(r.result == BRINGUP_READING && r.number == 0, "%s", bringup_result_text(r.result));
    /* What it reads is the device's: less by the motor's friction on the way up. */
    for (int k = 0; k < BRINGUP_LEVELS; k++) {
        const double F_N = 0.5 * (k + 1), T_N = (F_N - d.coulomb_n) / (1 + d.mu_motor);
        CHECK(r.balance_N[k] > T_N - 0.02 && r.balance_N[k] < T_N + 0.02, "%.3f N of %.3f",
            r.balance_N[k], T_N);
    }
    /* A kf that is wrong: what the balance reads then, given back. */
    snprintf(boot, sizeof boot, "stage=4 kf=5 shown=%lu", (unsigned long)shown_before(4, 0));
    CHECK_EQ_I64(bringup_run(&c, &r), 0);
    snprintf(boot, sizeof boot, "stage=4 kf=5 shown=%lu read1=%.2f read2=%.2f read3=%.2f",
        (unsigned long)shown_before(4, 0), r.balance_N[0], r.balance_N[1], r.balance_N[2]);
    CHECK_EQ_I64(bringup_run(&c, &r), 0);
    CHECK(r.result == BRINGUP_READING, "kf 5: %s", bringup_result_text(r.result));
}

/* Friction weighed out: kf (1 - b^2) / (1 + a b), as calibrate_test has it. No number comes of it.
 */
TEST(a_known_mass_gives_kf)
{
    static const char *const mass[] = {" mass=0.1", " mass=0.3 f_string=5 i_step=0.02"};
    for (size_t i = 0; i < LEN(mass); i++) {
        for (int cards = 0; cards < 2; cards++) {
            struct bringup_run_cfg c = config(2);
            const struct bringup *s = bringup_state();
            double N, A;
            c.board.cards.how = cards ? POSIX_CARDS_INSTANT : POSIX_CARDS_NONE;
            CHECK_EQ_I64(run_stage(c, 4, 0, shown_before(4, 0), mass[i]), 0);
            CHECK(r.result == EXH_PROBE_DONE && r.number == 0 && r.unsafe == 0, "%s: %s", mass[i],
                bringup_result_text(r.result));
            N = (double)bringup_config()->mass_N_q20 / (1 << EXH_Q_FORCE);
            A = (double)exh_weigh_point(&s->weigh, 0).cur_A_q26 / (1 << EXH_Q_CUR);
            CHECK(N / A > 3.259 * 0.98 && N / A < 3.259 * 1.02, "%s: %.4f N/A", mass[i], N / A);
        }
    }
    {
        struct bringup_run_cfg c = config(2);
        c.wrong = BRINGUP_SLIPPED; /* without a mass: it runs in */
        CHECK_EQ_I64(run_stage(c, 4, 0, shown_before(4, 0), mass[0]), 0);
        CHECK(r.result == EXH_PROBE_TRAVEL && r.unsafe == 0 && r.most_A < 0.4492, "%s",
            bringup_result_text(r.result));
        CHECK(run_stage(config(2), 4, 0, shown_before(4, 0), " mass=0.04") < 0, "a mass too light");
        CHECK(run_stage(config(2), 4, 0, shown_before(4, 0), " mass=0.16") < 0,
            "one beyond f_string");
    }
}

/* The number is of stage, finger, scales and limits. */
TEST(a_stage_needs_the_one_before)
{
    static const char *const other[] = {
        " mon_scale=0.000258", " dac_scale=1700", " step=0.00003316", " i_cont=3"};
    static const char *const own[BRINGUP_STAGES][5] = {{NULL},
        {" loop=0", " da_max=0.5", " zero_tol=0.03", " mon_tol=0.03", " mon_percent=12"},
        {" load_max=0.29", " move=0.0004"},
        {" run_max=0.19", " pol_max=0.14", " v_max=0.26", " travel=0.031"},
        {" kf=3.3", " f_string=1.4", " home_cur=0.11", " read_percent=26"}};
    for (int stage = 2; stage <= BRINGUP_STAGES; stage++) {
        const uint32_t shown = shown_before(stage, 0);
        CHECK_EQ_I64(run_stage(config(1), stage, 0, shown + 1, ""), 0);
        CHECK(r.result == BRINGUP_NOT_SHOWN && r.most_A <= 0 && r.unsafe == 0, "stage %d: %s",
            stage, bringup_result_text(r.result));
        CHECK_EQ_I64(run_stage(config(1), stage, 1, shown, ""), 0);
        CHECK(r.result == BRINGUP_NOT_SHOWN, "another finger: %s", bringup_result_text(r.result));
        CHECK_EQ_I64(run_stage(config(1), stage, 0, 0, ""), 0);
        CHECK(r.result == BRINGUP_NOT_SHOWN, "none: %s", bringup_result_text(r.result));
        for (size_t i = 0; i < LEN(other); i++) {
            CHECK_EQ_I64(run_stage(config(1), stage, 0, shown, other[i]), 0);
            CHECK(r.result == BRINGUP_NOT_SHOWN, "%s: %s", other[i], bringup_result_text(r.result));
        }
    }
    for (int from = 1; from < BRINGUP_STAGES; from++) {
        for (size_t i = 0; i < LEN(own[from]) && own[from][i] != NULL; i++) {
            for (int stage = 2; stage <= BRINGUP_STAGES; stage++) {
                CHECK_EQ_I64(
                    run_stage(config(1), stage, 0, shown_before(stage, 0), own[from][i]), 0);
                CHECK((r.result == BRINGUP_NOT_SHOWN) == (stage > from), "stage %d,%s: %s", stage,
                    own[from][i], bringup_result_text(r.result));
            }
        }
    }
}

TEST(what_is_refused)
{
    static const char *const bad[] = {" f_finger=2.5", " f_string=11", " run_max=0.6", " v_max=2",
        " pol_max=0.3", " run_max=0.1", " doubt=1", " hold=99", " nothing=1", " travel=0.0003"};
    for (size_t i = 0; i < LEN(bad); i++) {
        CHECK(run_stage(config(1), 3, 0, shown_before(3, 0), bad[i]) < 0, "%s: taken", bad[i]);
    }
    {
        struct bringup_run_cfg c = config(1);
        c.rate_Hz = 20; /* no two ticks in 50 ms */
        CHECK_EQ_I64(run_stage(c, 1, 0, 0, ""), -EXH_E_RATE);
    }
}

TEST_MAIN("sim/bringup", every_stage_comes_through, at_any_rate, wrong_polarity, encoder_unplugged,
    monitor_dead_or_half, da_never_moves, what_is_open_ends_it_at_once,
    nothing_begins_with_an_open_loop, no_slope_delays_the_end, a_limit_that_acts_ends_it_at_once,
    held_before_the_question_is_no_answer, a_string_let_loose_ends_it,
    a_mute_card_is_seen_by_the_monitor, speed_is_limited, the_balance_must_read_what_was_commanded,
    a_known_mass_gives_kf, a_stage_needs_the_one_before, what_is_refused);
