/* SPDX-License-Identifier: MIT */
/* Materials that are too stiff for a rate. The rule of gains refuses them, wherever they come from,
 * and softens the default one. Where the rule is waived, a contact that oscillates ends in the
 * fault chatter. */
#include "check.h"

#include "base/param.h"

#include "box/hand.h"

#include <string.h>

static double touched_s, fault_s; /* < 0: never */

static void begin(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    (void)board;
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    (void)tick;
    (void)in;
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const struct bilateral_signals *sig = (const void *)exh_scene_signals(&exh_scene_bilateral);
    (void)tick;
    (void)in;
    (void)out;
    if (sig->paper[EXH_INDEX].c && touched_s < 0) { touched_s = posix_time_s(); }
    if (sig->box.faults && fault_s < 0) { fault_s = posix_time_s(); }
}

static const struct exh_loop_hooks more = {begin, before, after};

struct approach {
    uint32_t rate_Hz;
    double k_Npm, b_Nspm, speed_mps;
    int rule, seed;
};

/* One approach and 0.9 s in contact. */
static struct bilateral_run_cfg cfg_of(const struct approach *h, const struct run_setting *set)
{
    struct bilateral_run_cfg c;
    memset(&c, 0, sizeof c);
    c.rate_Hz = h->rate_Hz;
    c.board = posix_config_default();
    c.board.seed = (uint64_t)h->seed;
    c.board.exo = sim_exo_default();
    c.board.exo.fingers = 1u << EXH_INDEX;
    c.board.exo.path[EXH_INDEX].first_s = 0.7;
    c.board.exo.path[EXH_INDEX].approaches = 1;
    c.board.exo.path[EXH_INDEX].speed_mps = h->speed_mps;
    c.board.max_ticks = h->rate_Hz * 17 / 10;
    c.setting = set;
    c.settings = 2;
    c.k_Npm = h->k_Npm;
    c.b_Nspm = h->b_Nspm;
    c.at_m = 0.03;
    c.fps = 400;
    c.until_s = 1e30;
    c.more = &more;
    return c;
}

static int run(const struct approach *h, struct bilateral_run *r)
{
    const struct run_setting set[] = {{"mat_f_max", 100}, {"rule_on", h->rule}};
    const struct bilateral_run_cfg c = cfg_of(h, set);
    int err;
    touched_s = fault_s = -1;
    err = bilateral_run(&c, r);
    bilateral_run_free(r);
    return err;
}

/* Two-sided: not at the blow, and within 0.6 s of the touch. */
TEST(a_contact_that_buzzes_is_a_fault)
{
    static const struct approach row[] = {
        {2000, 1e6, 60, 0.87, 0, 1}, {500, 20000, 60, 0.87, 0, 1}, {500, 20000, 60, 0.1, 0, 2}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct bilateral_run r;
        CHECK_EQ_I64(run(&row[i], &r), 0);
        CHECK(r.faults == EXH_FAULT_CHATTER, "row %d: faults %#x", (int)i, (unsigned)r.faults);
        CHECK(touched_s > 0 && fault_s > touched_s + 0.03 && fault_s < touched_s + 0.6,
            "row %d: touched at %g s, told at %g s", (int)i, touched_s, fault_s);
    }
}

/* The default material, as it is softened, and the stiffest that the rule has at its last knot. */
TEST(what_the_rule_allows_is_none)
{
    static const struct approach row[] = {{2000, 20000, 60, 0.87, 2, 1},
        {2000, 20000, 60, 0.1, 2, 2}, {1000, 20000, 60, 0.87, 2, 3}, {500, 20000, 60, 0.87, 2, 4},
        {5000, 20000, 60, 0.87, 2, 5}, {2000, 24000, 100, 0.87, 2, 6}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct bilateral_run r;
        CHECK_EQ_I64(run(&row[i], &r), 0);
        CHECK(r.faults == 0, "row %d: faults %#x at %g s", (int)i, (unsigned)r.faults, fault_s);
        CHECK(touched_s > 0, "row %d: no contact", (int)i);
    }
}

static int32_t active(const char *name, double one)
{
    const struct exh_params *p = exh_scene_bilateral.params;
    uint32_t i = 0;
    CHECK(cli_signal_find(p->table, name, &i) != NULL, "no %s", name);
    return (int32_t)(p->active[i] / one);
}

TEST(the_default_is_softened)
{
    static const struct {
        uint32_t rate_Hz;
        int32_t k, b;
    } row[] = {{2000, 20000, 60}, {5000, 20000, 60}, {1000, 12000, 50}, {500, 6000, 25},
        {200, 2400, 10}, {100, 1200, 5}, {1990, 20000, 60}, {1600, 19200, 60}};
    for (size_t i = 0; i < LEN(row); i++) {
        exh_scene_bilateral.defaults();
        CHECK_EQ_I64(exh_params_stage(exh_scene_bilateral.params, 0x0902, 0, 20 << 16), 0);
        (void)exh_params_apply(exh_scene_bilateral.params); /* a glove's filter for 90 Hz */
        CHECK_EQ_I64(
            exh_scene_bilateral.setup((struct exh_scene_board){{1, row[i].rate_Hz}, 24}), 0);
        CHECK(active("mat_k", 1024) == row[i].k && active("mat_b", 1048576) == row[i].b,
            "%d Hz: k %d, b %d", (int)row[i].rate_Hz, (int)active("mat_k", 1024),
            (int)active("mat_b", 1048576));
    }
}

/* From the command line or an image, staged by a register, or requested over the link. */
TEST(a_material_outside_is_refused_by_name)
{
    static const struct approach outside[] = {{2000, 24001, 60, 0.87, 2, 1},
        {2000, 1e6, 60, 0.87, 2, 1}, {500, 20000, 10, 0.87, 2, 1}, {2000, 5001, 0, 0.87, 2, 1},
        {2000, 5000, 101, 0.87, 2, 1}};
    const struct exh_wire_param want[] = {{EXH_MATERIAL_K_ID, 0, EXH_Q(1000000, 1, EXH_Q_K)},
        {EXH_MATERIAL_K_ID, 1, EXH_Q(12000, 1, EXH_Q_K)}};
    const struct run_setting set[] = {{"mat_f_max", 10}, {"rule_on", 2}};
    const struct approach h = {2000, 20000, 60, 0.3, 2, 1};
    struct bilateral_run_cfg c = cfg_of(&h, set);
    struct exh_params *p = exh_scene_bilateral.params;
    struct bilateral_run r;
    for (size_t i = 0; i < LEN(outside); i++) { CHECK_EQ_I64(run(&outside[i], &r), -EXH_E_GAINS); }
    c.want = want;
    c.wants = LEN(want);
    c.board.max_ticks = 1500;
    CHECK_EQ_I64(bilateral_run(&c, &r), 0);
    bilateral_run_free(&r);
    CHECK(r.refused == 1 && active("mat_k", 1024) == 20000, "%d refused, k %d", r.refused,
        (int)active("mat_k", 1024));
    CHECK_EQ_I64(exh_scene_bilateral.allowed(), 0);
    CHECK_EQ_I64(exh_params_stage(p, EXH_MATERIAL_K_ID, 3, EXH_Q(24001, 1, EXH_Q_K)), 0);
    CHECK_EQ_I64(exh_scene_bilateral.allowed(), -EXH_E_GAINS);
    exh_params_discard(p);
}

TEST_MAIN("sim/chatter", a_contact_that_buzzes_is_a_fault, what_the_rule_allows_is_none,
    the_default_is_softened, a_material_outside_is_refused_by_name);
