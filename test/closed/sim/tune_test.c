/* SPDX-License-Identifier: MIT */
/* Parameters that change while a finger presses. No force step exceeds the slew limit, for any
 * value staged in any tick. One test has what a finger feels of a change; one replays a log from
 * the middle of a change. */
#include "logs.h"

#include "box/run.h"
#include "posix.h"

#include "drop/drop.h"

#include "exhand/fix.h"

#include <inttypes.h>

enum how {
    ONE,    /* k from 500 to 5000 N/m, in equal parts */
    HALT,   /* as ONE in one part, and where it is 40 ticks later it is to stay */
    FORCE,  /* every slewed row at random, in every tick */
    ALL,    /* every row that may change, in every tick */
    SELDOM, /* the slewed ones every 10 ticks */
    LOWER   /* f_max to 0.5 N, with a tune_time of a second */
};

static struct {
    enum how how;
    uint32_t at, parts; /* ONE: from this tick on, in so many parts */
    uint64_t seed;
    struct exh_period T;
    int32_t last_N_q20, k_Npm_q10;
    int was_open;
    uint32_t open_ticks, contact_ticks, over;
    int64_t most_N_q20, most_part; /* step of force; as a part of what is allowed, q10 */
    int64_t tuned_N_q20;           /* step of force by k alone, where the finger is */
    uint32_t settled;              /* the last tick with a value on its way */
} see;

static uint64_t any(void)
{
    uint64_t z = see.seed += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

static double newton(int64_t q20) { return (double)q20 / (1 << EXH_Q_FORCE); }

static void stage_any(int all)
{
    struct exh_params *p = exh_scene_drop.params;
    for (uint32_t i = 0; i < p->count; i++) {
        const struct exh_signal *row = exh_signal_at(p->table, i, NULL);
        const uint64_t span = (uint64_t)((int64_t)row->max - row->min) + 1, u = any();
        int64_t v = row->min + (int64_t)(u % span);
        if (!exh_signal_is_slewed(row) && (!all || exh_signal_is_fixed(row))) { continue; }
        if (u >> 60 < 4) { v = u >> 60 & 1 ? row->max : row->min; }
        if (u >> 60 == 4) { v = row->dflt; }
        CHECK_EQ_I64(exh_params_stage(p, row->id, 0, (int32_t)v), 0);
    }
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    struct exh_params *p = exh_scene_drop.params;
    const struct drop_signals *s = (const void *)exh_scene_signals(&exh_scene_drop);
    const uint32_t n = tick - see.at;
    if (tick == 0) { in->command = EXH_CMD_RUN; }
    if (tick > 0 && s->state == EXH_STATE_OFF) { in->command = EXH_CMD_RUN; }
    if (see.how == FORCE || see.how == ALL) { stage_any(see.how == ALL); }
    if (see.how == SELDOM && tick % 10 == 0) { stage_any(0); }
    if (see.how == LOWER && tick == see.at) {
        CHECK(s->f_des_N_q20 > EXH_Q(1, 1, EXH_Q_FORCE), "%.3f N to be lowered",
            newton(s->f_des_N_q20));
        CHECK_EQ_I64(exh_params_stage(p, 0x0501, 0, EXH_Q(1, 2, EXH_Q_FORCE)), 0);
    }
    if (see.how == HALT && n == 40) {
        CHECK_EQ_I64(exh_params_stage(p, 0x0401, 0, see.k_Npm_q10), 0);
    }
    if ((see.how == ONE || see.how == HALT) && tick >= see.at && n < see.parts) {
        const int64_t part = (int64_t)EXH_Q(4500, 1, EXH_Q_K) * (n + 1) / see.parts;
        CHECK_EQ_I64(exh_params_stage(p, 0x0401, 0, EXH_Q(500, 1, EXH_Q_K) + (int32_t)part), 0);
    }
}

/* A slew limit is force a tick, rounded down, one LSB at least. */
static int64_t allowed_N_q20(int32_t slew_Nps)
{
    return (int64_t)slew_Nps * (1 << EXH_Q_FORCE) * see.T.num / see.T.den + 1;
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const struct drop_signals *s = (const void *)exh_scene_signals(&exh_scene_drop);
    const struct drop_par *par = (const void *)exh_scene_drop.params->active;
    const int open = s->state == EXH_STATE_RUN || s->state == EXH_STATE_LIMIT;
    const int64_t step = (int64_t)s->f_des_N_q20 - see.last_N_q20;
    const int64_t most =
        allowed_N_q20(step < 0 ? par->drive.slew_down_Nps : par->drive.slew_up_Nps);
    (void)in;
    (void)out;
    const int64_t tuned = s->c * exh_mul_shr(par->contact.k_Npm_q10 - see.k_Npm_q10,
                                     exh_sat32((int64_t)s->q_m_q30 - par->own.q_lim_m_q30),
                                     EXH_Q_K + EXH_Q_POS - EXH_Q_FORCE);
    if (see.how == LOWER && tick >= see.at) {
        CHECK(s->f_des_N_q20 <= EXH_Q(1, 2, EXH_Q_FORCE), "tick %" PRIu32 ": %.3f N", tick,
            newton(s->f_des_N_q20));
    }
    if (exh_scene_drop.params->moving) { see.settled = tick; }
    if (open && see.was_open && tick >= see.at) {
        const int64_t size = step < 0 ? -step : step;
        see.open_ticks++;
        see.contact_ticks += s->c != 0;
        CHECK(size <= most, "tick %" PRIu32 ": a step of %.4f N, allowed %.4f", tick,
            (double)step / (1 << EXH_Q_FORCE), (double)most / (1 << EXH_Q_FORCE));
        if (tuned > see.tuned_N_q20) { see.tuned_N_q20 = tuned; }
        if (size > see.most_N_q20) { see.most_N_q20 = size; }
        if (size * 1024 / most > see.most_part) { see.most_part = size * 1024 / most; }
    }
    see.k_Npm_q10 = par->contact.k_Npm_q10;
    see.was_open = open;
    see.last_N_q20 = s->f_des_N_q20;
}

static void begin(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    see.T = board.T;
}

/* A finger goes to the wall at 30 mm and presses 15 mm beyond for so long. */
static struct run_cfg pressing(
    uint32_t rate_Hz, double seconds, const struct run_setting *set, int n)
{
    static const struct exh_loop_hooks hooks = {begin, before, after};
    struct run_cfg c;
    memset(&c, 0, sizeof c);
    c.rate_Hz = rate_Hz;
    c.k_Npm = 500;
    c.b_Nspm = 2;
    c.board = posix_config_default();
    c.board.exo = sim_exo_default();
    c.board.exo.fingers = 1;
    c.board.exo.path[0].speed_mps = 0.1;
    c.board.exo.path[0].hold_s = seconds;
    c.board.exo.path[0].vary = 0;
    c.board.max_ticks = (uint32_t)((seconds + 0.8) * rate_Hz);
    c.more = &hooks;
    c.live.on = 1;
    c.setting = set;
    c.settings = n;
    return c;
}

static void press(const struct run_cfg *c, enum how how, uint32_t at, uint32_t parts)
{
    struct run r;
    memset(&see, 0, sizeof see);
    see.how = how;
    see.at = at;
    see.parts = parts;
    see.seed = c->rate_Hz + (uint64_t)how;
    CHECK_EQ_I64(run_drop(c, &r), 0);
    run_free(&r);
}

/* k changes from 500 to 5000 N/m under a finger that presses. Printed is the largest step of force
 * in a tick, first due to k alone at the finger's place, then of the commanded force. The latter
 * also moves the finger: at 90 Hz a wall of 5000 N/m oscillates. Three ways to change k: in one
 * tick; 2^-s of the rest a tick; a straight ramp that takes as long as 95 % of the second way. */
TEST(what_a_finger_feels)
{
    static const struct {
        uint32_t rate_Hz, parts[3];
        int tune_ms[3];
    } row[] = {{90, {1, 1, 6}, {0, 20, 0}}, {2000, {1, 1, 192}, {0, 20, 0}}};
    static const char *const name[] = {"at once", "2^-s of the rest", "straight ramp"};
    for (size_t i = 0; i < LEN(row); i++) {
        const uint32_t at = row[i].rate_Hz * 2;
        int64_t tuned[3];
        for (int k = 0; k < 3; k++) {
            const struct run_setting set[] = {{"q_lim", 0.03}, {"arm_time", 1}, {"ramp_time", 1},
                {"tune_time", row[i].tune_ms[k]}};
            const struct run_cfg c = pressing(row[i].rate_Hz, 2.5, set, LEN(set));
            press(&c, ONE, at, row[i].parts[k]);
            tuned[k] = see.tuned_N_q20;
            check_note(
                "%" PRIu32
                " Hz, k 500 -> 5000 N/m, %s: %.3f N a tick by k, %.3f N in all; there in %" PRIu32
                " ticks",
                row[i].rate_Hz, name[k], newton(tuned[k]), newton(see.most_N_q20),
                k == 1 ? see.settled + 2 - at : row[i].parts[k]);
            if (k == 1) {
                CHECK(see.settled > at && see.settled < at + row[i].rate_Hz,
                    "there at tick %" PRIu32, see.settled);
            }
        }
        CHECK(tuned[1] * (row[i].rate_Hz == 90 ? 3 : 20) < tuned[0] * 2, "%.3f N of %.3f",
            newton(tuned[1]), newton(tuned[0]));
    }
}

/* For anything staged in any tick, the drive's slew limit applies to it. It is set low, so that it
 * acts. */
TEST(no_step_beyond_the_slew_limit)
{
    static const uint32_t rates[] = {90, 100, 200, 500, 1000, 2000};
    static const enum how hows[] = {FORCE, ALL, SELDOM};
    for (size_t i = 0; i < LEN(rates); i++) {
        for (size_t h = 0; h < LEN(hows); h++) {
            for (int tune = 0; tune < 2; tune++) {
                const struct run_setting set[] = {
                    {"q_lim", 0.03},
                    {"arm_time", 1},
                    {"ramp_time", 1},
                    {"tune_time", 20 * tune},
                    {"slew_up", 1000},
                    {"slew_down", 1000},
                    {"speed_limit", 10},
                    {"speed_time", 1000},
                    {"arm_force", 10},
                };
                const struct run_cfg c = pressing(rates[i], 3, set, LEN(set));
                press(&c, hows[h], 0, 0);
                CHECK(see.open_ticks > rates[i] / 2, "%" PRIu32 " Hz: open for %" PRIu32 " ticks",
                    rates[i], see.open_ticks);
                CHECK(see.contact_ticks > rates[i] / 8,
                    "%" PRIu32 " Hz: %" PRIu32 " ticks of contact", rates[i], see.contact_ticks);
                if (hows[h] == FORCE) {
                    CHECK(see.most_part > 1000, "%" PRIu32 " Hz: never near the limit: %ld/1024",
                        rates[i], (long)see.most_part);
                }
                if (tune) {
                    check_note("%" PRIu32 " Hz, %s: %" PRIu32 " ticks of %" PRIu32
                               " in contact, largest step %.3f N,"
                               " %.4f of what is allowed",
                        rates[i],
                        hows[h] == ALL     ? "all rows"
                        : hows[h] == FORCE ? "force rows"
                                           : "every 10 ticks",
                        see.contact_ticks, see.open_ticks, newton(see.most_N_q20),
                        (double)see.most_part / 1024);
                }
            }
        }
    }
}

/* Lowered under a finger that presses, the limit holds in the same tick: slew_down is 100 N a tick
 * here. */
TEST(a_lowered_limit_is_never_late)
{
    static const struct run_setting set[] = {
        {"q_lim", 0.03}, {"arm_time", 1}, {"ramp_time", 1}, {"tune_time", 1000}};
    const struct run_cfg c = pressing(2000, 2.5, set, LEN(set));
    press(&c, LOWER, 4000, 0);
    CHECK(see.contact_ticks > 100, "%" PRIu32 " ticks of contact", see.contact_ticks);
}

/* A keyframe is due at tick 1024, some values on their way. */
TEST(replay_from_mid_way)
{
    static const struct run_setting set[] = {{"q_lim", 0.03}, {"arm_time", 1}, {"ramp_time", 1}};
    static const enum how hows[] = {ONE, HALT, SELDOM, FORCE};
    for (size_t h = 0; h < LEN(hows); h++) {
        struct run_cfg c = pressing(1000, 2.5, set, LEN(set));
        const char *path = log_path();
        c.board.log = fopen(path, "wb");
        CHECK(c.board.log != NULL, "%s", path);
        press(&c, hows[h], hows[h] <= HALT ? 1010 : 0, 1);
        CHECK_EQ_I64(fclose(c.board.log), 0);
        CHECK(see.settled > 1040, "still at %" PRIu32, see.settled);
        CHECK_EQ_I64(replay(path, NULL), 0);
        CHECK_EQ_I64(replay(path, "1024"), 0);
        CHECK_EQ_I64(replay(path, "2100"), 0);
        remove(path);
    }
}

TEST_MAIN("sim/tune", what_a_finger_feels, no_step_beyond_the_slew_limit,
    a_lowered_limit_is_never_late, replay_from_mid_way);
