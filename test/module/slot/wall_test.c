/* SPDX-License-Identifier: MIT */
/* The example's model, a spring and a damper in doubles, is drop's law: in every tick, and in what
 * comes of it. */
#include "rig.h"

static struct exh_contact law;
static int64_t worst;
static int contact;

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    (void)board;
    memset(&law, 0, sizeof law);
    worst = contact = 0;
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
    const struct exh_contact_in q = {s->drop.q_m_q30, s->drop.qd_mps_q27, p->own.q_lim_m_q30};
    struct exh_force_ledger f;
    (void)tick;
    (void)in;
    (void)out;
    if (exh_contact_step(&law, &p->contact, q, &f)) {
        const int64_t off = s->ask_N_q20 - (f.spring_N_q20 + f.damper_N_q20);
        contact++;
        if (llabs(off) > worst) { worst = llabs(off); }
    } else if (s->ask_N_q20 != 0) {
        worst = INT64_MAX;
    }
}

/* Each of the law's two terms is rounded once, the model's sum once: 1.5 LSB and a double's own. */
TEST(asks_what_the_law_asks)
{
    static const struct exh_loop_hooks hooks = {start, before, after};
    for (int i = 0; i < TABLE2_ROWS; i++) {
        struct run_cfg c = rig(table2_paper[i].rate_Hz, -1, -1);
        struct run r;
        c.more = &hooks;
        CHECK_EQ_I64(run_drop(&c, &r), 0);
        run_free(&r);
        CHECK(contact > 100 && worst <= 1, "%g Hz: %d ticks in contact, off by %lld LSB",
            table2_paper[i].rate_Hz, contact, (long long)worst);
    }
}

TEST(its_table_is_drops)
{
    for (int i = 0; i < TABLE2_ROWS; i++) {
        struct run_cfg c = rig(table2_paper[i].rate_Hz, -1, -1);
        const struct table2_result ours = table2_measure(&c, NULL, TABLE2_SAME);
        struct table2_result drop;
        c.scene = &exh_scene_drop;
        drop = table2_measure(&c, NULL, TABLE2_SAME);
        CHECK(ours.done && drop.done && ours.oscillating == drop.oscillating && ours.faults == 0,
            "%g Hz", ours.rate_Hz);
        CHECK(ours.b_Npm >= 0.999 * drop.b_Npm && ours.b_Npm <= 1.001 * drop.b_Npm,
            "%g Hz: %g and %g N/m", ours.rate_Hz, ours.b_Npm, drop.b_Npm);
    }
}

TEST(its_log_replays) { rig_replays(rig(2000, -1, -1)); }

TEST_MAIN("slot/wall", asks_what_the_law_asks, its_table_is_drops, its_log_replays);
