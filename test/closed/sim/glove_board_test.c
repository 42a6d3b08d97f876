/* SPDX-License-Identifier: MIT */
/* Glove frames from the board through the loop and the log: when they are read, how old they
 * are, and that nothing of it touches scenes without a glove. */
#include "check.h"

#include "posix.h"

#include "exhand/run/log.h"
#include "exhand/run/loop.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/exhand.h"

#include <string.h>

#define SENSORS SIM_GLOVE_SENSORS
#define TICKS   64

/* ---- A scene that keeps what it is given ----------------------------------------------- */

static struct {
    struct exh_scene_in in[TICKS];
    unsigned ticks;
} seen;

static int setup(struct exh_scene_board board)
{
    (void)board;
    seen.ticks = 0;
    return 0;
}

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    memset(out, 0, sizeof *out);
    if (seen.ticks < TICKS) { seen.in[seen.ticks++] = *in; }
}

static struct exh_scene scene(int32_t every)
{
    static int32_t kept;
    const struct exh_scene s = {.name = "kept",
        .rate_Hz = 1000,
        .read_glove = exh_board_read_glove,
        .glove_every = every ? &kept : NULL,
        .setup = setup,
        .tick = tick};
    kept = every;
    return s;
}

static struct posix_config with_glove(void)
{
    struct posix_config c = posix_config_default();
    c.glove = 1;
    c.bench = 1;
    c.max_ticks = TICKS;
    return c;
}

static void run(const struct posix_config *c, uint32_t rate_Hz, int32_t every)
{
    const struct exh_scene s = scene(every);
    posix_configure(c);
    CHECK_EQ_I64(exh_loop(&s, rate_Hz, NULL), 0);
    CHECK_EQ_I64(seen.ticks, TICKS);
}

/* ---- The loop ---------------------------------------------------------------------------- */

TEST(a_board_without_a_glove_stops_the_loop)
{
    const struct exh_scene s = scene(1);
    struct posix_config c = with_glove();
    c.glove = 0;
    posix_configure(&c);
    CHECK_EQ_I64(exh_loop(&s, 0, NULL), -EXH_E_ABSENT);
    CHECK_EQ_I64(seen.ticks, 1); /* the last one, which gets the failure */
}

TEST(a_scene_that_names_no_glove_gets_none)
{
    struct posix_config c = with_glove();
    struct exh_scene s = scene(1);
    c.glove = 0;
    s.read_glove = NULL;
    posix_configure(&c);
    CHECK_EQ_I64(exh_loop(&s, 0, NULL), 0);
    for (unsigned n = 0; n < TICKS; n++) { CHECK_EQ_I64(seen.in[n].glove_new, 0); }
}

TEST(frames_come_every_so_many_ticks_and_age_between)
{
    static const int32_t every[] = {0, 1, 2, 3, 10, 63, 64, 65535};
    for (size_t k = 0; k < LEN(every); k++) {
        const struct posix_config c = with_glove();
        const unsigned step = every[k] ? (unsigned)every[k] : 1;
        run(&c, 1000, every[k]);
        for (unsigned n = 0; n < TICKS; n++) {
            const struct exh_scene_in *in = &seen.in[n];
            CHECK(in->glove_new == (n % step == 0), "every %u, tick %u: new %u", step, n,
                in->glove_new);
            CHECK(in->glove.age_ticks == n % step, "every %u, tick %u: age %u", step, n,
                in->glove.age_ticks);
            CHECK(
                n % step == 0 || memcmp(in->glove.raw, in[-1].glove.raw, sizeof in->glove.raw) == 0,
                "every %u, tick %u: codes changed", step, n);
        }
        CHECK(step > TICKS / 2 || memcmp(seen.in[0].glove.raw, seen.in[step].glove.raw, 44) != 0,
            "every %u: noise does not change", step);
    }
}

/* A scan takes 88 us: at 50 us a tick every other read finds the one before. */
TEST(a_scan_that_does_not_fit_is_older)
{
    static const struct {
        uint32_t rate_Hz;
        double interval_s;
        unsigned every;
    } row[] = {{20000, 4e-6, 2}, {10000, 4e-6, 1}, {11360, 4e-6, 1}, {11370, 4e-6, 2},
        {2000, 20e-6, 1}, {2500, 20e-6, 2}, {10000, 20e-6, 5}};
    for (size_t k = 0; k < LEN(row); k++) {
        struct posix_config c = with_glove();
        c.glove_par.interval_s = row[k].interval_s;
        run(&c, row[k].rate_Hz, 1);
        for (unsigned n = 0; n < TICKS; n++) {
            const unsigned age = n % row[k].every;
            CHECK(seen.in[n].glove.age_ticks == age && seen.in[n].glove_new == (age == 0),
                "row %zu, tick %u: age %u, new %u", k, n, seen.in[n].glove.age_ticks,
                seen.in[n].glove_new);
        }
    }
}

/* ---- The board ----------------------------------------------------------------------------- */

/* The codes of the first tick are those of the pose. */
TEST(codes_are_the_poses)
{
    struct posix_config c = with_glove();
    c.glove_par.noise_V = c.glove_par.couple = c.glove_par.settle_s = 0;
    for (int pose = 0; pose < sim_poses; pose++) {
        c.hand.pose = pose;
        run(&c, 1000, 1);
        for (unsigned i = 0; i < SENSORS; i++) {
            const struct sim_glove_sensor *s = &sim_glove_sensor[i];
            const double share = s->lo + (sim_pose[pose].deg[i] - s->lo_deg) /
                                             (s->hi_deg - s->lo_deg) * (s->hi - s->lo);
            const double code = (-9 + 18 * share) * 3276.8;
            for (unsigned n = 0; n < TICKS; n++) {
                const double off = seen.in[n].glove.raw[i] - code;
                CHECK(off <= 0.501 && off >= -0.501, "%s, %s: %.3f codes off", sim_pose[pose].name,
                    s->name, off);
            }
        }
    }
}

TEST(the_hand_goes_where_it_is_asked)
{
    struct posix_config c = with_glove();
    struct exh_period T;
    struct exh_glove_in in;
    int16_t first;
    unsigned ticks = 0;
    posix_configure(&c);
    CHECK_EQ_I64(exh_board_init(1000, &T), 0);
    for (int n = 0; n < 10; n++) {
        CHECK_EQ_I64(exh_board_wait(), 0);
        CHECK_EQ_I64(exh_board_read_glove(&in), 0);
    }
    CHECK(posix_hand_ready(), "at rest at first");
    first = in.raw[4];
    c.max_ticks = 0;
    posix_configure(&c);
    posix_hand(sim_pose_find("fist"));
    CHECK(!posix_hand_ready(), "asked");
    while (!posix_hand_ready() && ticks < 2000) {
        CHECK_EQ_I64(exh_board_wait(), 0);
        CHECK_EQ_I64(exh_board_read_glove(&in), 0);
        ticks++;
    }
    CHECK(ticks > 500 && ticks < 520, "%u ticks", ticks);
    CHECK(in.raw[4] - first > 13240 && in.raw[4] - first < 13305, "%d codes", in.raw[4] - first);
    posix_glove()->fault[4] = SIM_GLOVE_OPEN;
    CHECK_EQ_I64(exh_board_wait(), 0);
    CHECK_EQ_I64(exh_board_read_glove(&in), 0);
    CHECK_EQ_I64(in.raw[4], 32767);
}

TEST(recorded_frames_come_one_a_read)
{
    static int16_t frame[3][SENSORS];
    struct posix_config c = with_glove();
    for (int n = 0; n < 3; n++) {
        for (int i = 0; i < SENSORS; i++) { frame[n][i] = (int16_t)(1000 * n + i); }
    }
    c.frame = (const int16_t(*)[SENSORS])frame;
    c.frames = 3;
    run(&c, 1000, 2);
    for (unsigned n = 0; n < TICKS; n++) {
        const unsigned row = n / 2 < 2 ? n / 2 : 2;
        CHECK(memcmp(seen.in[n].glove.raw, frame[row], sizeof frame[row]) == 0, "tick %u", n);
    }
}

/* One draws nothing from the other's chance. */
TEST(a_glove_changes_nothing_of_the_drive)
{
    struct exh_drive_in with[TICKS];
    struct posix_config c = with_glove();
    struct exh_scene s = scene(1);
    run(&c, 1000, 1);
    for (unsigned n = 0; n < TICKS; n++) { with[n] = seen.in[n].drive; }
    c.glove = 0;
    s.read_glove = NULL;
    posix_configure(&c);
    CHECK_EQ_I64(exh_loop(&s, 1000, NULL), 0);
    for (unsigned n = 0; n < TICKS; n++) {
        CHECK(with[n].mon_raw[0] == seen.in[n].drive.mon_raw[0] &&
                  with[n].enc_raw[0] == seen.in[n].drive.enc_raw[0],
            "tick %u", n);
    }
}

TEST(encoder_jitter_is_one_step)
{
    static const double jitter[] = {0, 0.3, 1, 2};
    for (size_t k = 0; k < LEN(jitter); k++) {
        int64_t lo = INT64_MAX, hi = INT64_MIN;
        int steps = 0;
        for (uint64_t seed = 1; seed < 20; seed++) {
            struct posix_config c = with_glove();
            c.enc_jitter_cnt = jitter[k];
            c.seed = seed;
            run(&c, 1000, 1);
            lo = INT64_MAX;
            hi = INT64_MIN;
            for (unsigned n = 0; n < TICKS; n++) {
                const int64_t v = seen.in[n].drive.enc_raw[0];
                if (v < lo) { lo = v; }
                if (v > hi) { hi = v; }
            }
            CHECK(hi - lo <= (jitter[k] > 0) + (jitter[k] > 1), "%g: %d steps", jitter[k],
                (int)(hi - lo));
            steps += hi > lo;
        }
        CHECK(jitter[k] < 1 || steps >= 15, "%g: %d of 19 jitter", jitter[k], steps);
        CHECK(jitter[k] > 0 || steps == 0, "%g: %d of 19 jitter", jitter[k], steps);
    }
}

/* ---- The log -------------------------------------------------------------------------------- */

TEST(only_frames_with_a_glove_hold_one)
{
    uint8_t buf[256];
    struct exh_scene s = scene(1);
    struct exh_scene_in in, back;
    struct exh_drive_out out, out_back;
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    uint32_t with;
    memset(&in, 0, sizeof in);
    memset(&out, 0, sizeof out);
    memset(&back, 0, sizeof back);
    in.drive.din = 0x12345678;
    in.glove_new = 1;
    in.glove.age_ticks = 0xABCD;
    for (int i = 0; i < SENSORS; i++) { in.glove.raw[i] = (int16_t)(i * 1489 - 15000); }
    exh_log_frame_serialize(&c, &s, &in, &out, NULL);
    with = c.at;
    c = exh_bytes_reader(buf, with);
    exh_log_frame_serialize(&c, &s, &back, &out_back, NULL);
    CHECK(exh_bytes_ok(&c) && c.at == with, "%u bytes", (unsigned)c.at);
    CHECK(memcmp(&back.glove, &in.glove, sizeof in.glove) == 0 && back.glove_new == 1, "the frame");
    CHECK(back.drive.din == in.drive.din, "the drive's");
    s.read_glove = NULL;
    c = exh_bytes_measure();
    exh_log_frame_serialize(&c, &s, &in, &out, NULL);
    CHECK_EQ_I64(with - c.at, 1 + 2 + 2 * SENSORS);
}

TEST_MAIN("glove_board", a_board_without_a_glove_stops_the_loop,
    a_scene_that_names_no_glove_gets_none, frames_come_every_so_many_ticks_and_age_between,
    a_scan_that_does_not_fit_is_older, codes_are_the_poses, the_hand_goes_where_it_is_asked,
    recorded_frames_come_one_a_read, a_glove_changes_nothing_of_the_drive,
    encoder_jitter_is_one_step, only_frames_with_a_glove_hold_one);
