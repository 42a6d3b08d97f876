/* A model made for one rate, whose ports are named otherwise; init, step and terminate are called when they should be. */
#include "rig.h"

#include "exhand/error.h"

static uint32_t ticks;
static int64_t off;

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    (void)board;
    ticks = 0;
    off = 0;
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    (void)tick;
    (void)in;
}

/* It begins at 7 and counts a step a tick, in every state of the box: rounded to 2^-20 N. */
static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const double want = 0.001 * (7.0 + ticks++) * 1048576.0;
    (void)tick;
    (void)in;
    (void)out;
    if (want <= 2147483646.0) { off += rig_signals()->ask_N_q20 != (int32_t)(want + 0.5); }
}

TEST(a_step_a_tick)
{
    static const struct exh_loop_hooks hooks = {start, before, after};
    struct run_cfg c = rig(500, -1, -1);
    struct run r;
    c.more = &hooks;
    c.board.max_ticks = 3000;
    for (int i = 0; i < 2; i++) {
        (void)run_drop(&c, &r);
        run_free(&r);
        CHECK(ticks >= 2000 && off == 0, "run %d: %lu ticks, %lld off", i, (unsigned long)ticks, (long long)off);
    }
}

TEST(another_rate_is_refused)
{
    exh_scene_custom.defaults();
    exh_params_apply(exh_scene_custom.params);
    CHECK_EQ_I64(exh_scene_custom.setup((struct exh_scene_board){{1, 500}, 24}), 0);
    CHECK_EQ_I64(exh_scene_custom.setup((struct exh_scene_board){{2, 1000}, 24}), 0);
    CHECK_EQ_I64(exh_scene_custom.setup((struct exh_scene_board){{1, 501}, 24}), -EXH_E_RATE);
    CHECK_EQ_I64(exh_scene_custom.setup((struct exh_scene_board){{1, 1000}, 24}), -EXH_E_RATE);
}

TEST_MAIN("slot/count", a_step_a_tick, another_rate_is_refused);
