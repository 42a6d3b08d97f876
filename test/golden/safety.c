/* SPDX-License-Identifier: MIT */
/* safety: the box's state, and the gate to the D/A. */
#include "modules.h"

#include "exhand/fix.h"
#include "exhand/safety.h"

#define HEALTHY 0x1F0Fu /* both switches, watchdog, cards, all five drives */

struct box {
    struct exh_safety s;
    struct exh_safety_cfg safety;
    struct exh_safety_in in;
    struct exh_drive_par axis[EXH_FINGERS];
    struct exh_drive_cfg cfg[EXH_FINGERS];
};

static int32_t some_ticks(
    struct golden_rng *r, int64_t lo, int64_t hi, uint32_t rate_Hz, int32_t most_ms)
{
    return exh_clamp(golden_draw(r, lo, hi) * 1000 / rate_Hz, 1, most_ms);
}

void golden_safety_par(struct exh_safety_par *p, struct golden_rng *r, uint32_t rate_Hz)
{
    p->missed_max = (int32_t)golden_draw(r, 0, 1);
    p->arm_force_N_q20 = (int32_t)golden_draw(r, 104858, 10485760);
    p->arm_ms = some_ticks(r, 2, 6, rate_Hz, 1000);
    p->ramp_ms = some_ticks(r, 2, 16, rate_Hz, 5000);
    p->release_ms = (int32_t)golden_draw(r, 5, 18);
}

static void box_setup(struct box *b, struct golden_rng *r, uint32_t rate_Hz, uint32_t k)
{
    static struct exh_knot knot[2] = {{0, 0, {0, 0}}, {INT32_C(1) << 25, INT32_C(1) << 28, {0, 0}}};
    struct exh_safety_par par;
    (void)memset(b, 0, sizeof *b);
    CHECK_EQ_I64(exh_table_setup(knot, 2), 0);
    golden_safety_par(&par, r, rate_Hz);
    CHECK_EQ_I64(exh_safety_setup(&b->safety, &par, golden_period(rate_Hz, k)), 0);
    b->in.fingers = (uint8_t)golden_draw(r, 1, EXH_FINGERS);
    b->in.din = HEALTHY;
    for (unsigned i = 0; i < b->in.fingers; i++) {
        golden_drive_par(&b->axis[i], r, rate_Hz);
        CHECK_EQ_I64(exh_drive_setup(&b->cfg[i], &b->axis[i], golden_period(rate_Hz, k),
                         (struct exh_table){knot, 2}, (struct exh_table){NULL, 0}),
            0);
    }
}

/* What crosses inward in tick k. */
static void any_in(struct box *b, struct golden_rng *r, uint32_t k)
{
    static const uint8_t command[] = {EXH_CMD_RUN, EXH_CMD_CLEAR, EXH_CMD_RUN, EXH_CMD_CLEAR, 4,
        EXH_CMD_NONE, EXH_CMD_NONE, EXH_CMD_NONE};
    static const uint8_t often[EXH_STATES] = {63, 127, 15, 15, 15, 31}; /* by state: a cause */
    const int release = b->s.state == EXH_STATE_RELEASE;
    struct exh_safety_in *in = &b->in;
    if (golden_draw(r, 0, 127) == 0) {
        in->din ^= UINT32_C(1) << golden_draw(r, 0, 12);
    } else if (golden_draw(r, 0, 1) == 0) {
        in->din = HEALTHY;
    }
    if (b->s.state == EXH_STATE_FAULT && golden_draw(r, 0, 1) == 0) { in->din ^= 2; }
    in->raised = 0;
    in->missed = 0;
    if (golden_draw(r, 0, often[b->s.state]) == 0) {
        in->raised = UINT32_C(1) << golden_draw(r, 0, 14);
    }
    if (golden_draw(r, 0, release ? 7 : 63) == 0) { in->missed = (uint32_t)golden_draw(r, 0, 2); }
    if (k == 188 || k == 190) { in->missed = (uint32_t)golden_draw(r, 0, UINT32_MAX); }
    in->command = command[golden_draw(r, 0, 7)];
    if (golden_draw(r, 0, 63) == 0) { in->command = EXH_CMD_OFF; }
    in->ready = 15;
    if (golden_draw(r, 0, b->s.state == EXH_STATE_OFF ? 7 : 63) == 0) {
        in->ready = (uint8_t)golden_draw(r, 0, 15);
    }
}

static void put_permit(struct golden *g, const struct exh_permit *p)
{
    golden_put(g, p->mode);
    golden_put(g, p->share_q30);
    golden_put(g, p->small_N_q20);
    golden_put(g, p->ticks);
    golden_put(g, p->fall.mant);
    golden_put(g, p->fall.shift);
}

static void put_axes(struct golden *g, unsigned n, const struct exh_current_ledger *i,
    const uint32_t *limits, const struct exh_drive_out *out)
{
    static const struct exh_current_ledger none;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const struct exh_current_ledger *l = f < n ? &i[f] : &none;
        golden_put(g, f < n ? limits[f] : 0);
        golden_put(g, l->gate_A_q26);
        golden_put(g, l->dac_A_q26);
        golden_put(g, l->coded_A_q26);
        golden_put(g, out->dac_raw[f]);
    }
}

void golden_safety(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave cur[EXH_FINGERS];
    static struct box b;
    struct golden_rng r = golden_rng("safety", rate_Hz, 0);
    const int32_t end = 442918502;
    for (uint32_t f = 0; f < EXH_FINGERS; f++) {
        golden_wave(
            &cur[f], "safety", rate_Hz, 1 + f, -end, end, INT32_C(1) << golden_draw(&r, 10, 26));
    }
    while (g->tick < GOLDEN_TICKS) {
        struct exh_current_ledger i[EXH_FINGERS];
        struct exh_permit permit;
        struct exh_drive_out out;
        uint32_t limits[EXH_FINGERS] = {0};
        uint8_t before;
        if (g->tick == 0 || g->tick == GOLDEN_AGAIN) { box_setup(&b, &r, rate_Hz, g->tick); }
        before = b.s.state;
        any_in(&b, &r, g->tick);
        (void)memset(i, 0, sizeof i);
        for (unsigned f = 0; f < EXH_FINGERS; f++) {
            i[f].table_A_q26 = f < b.in.fingers ? cur[f].at[g->tick] : 0;
            if (f < b.in.fingers && before == EXH_STATE_RELEASE) { /* what should fall does not */
                i[f].table_A_q26 = (int32_t)golden_draw(&r, -end, end);
            }
            if (f < b.in.fingers && golden_draw(&r, 0, 15) == 0) {
                limits[f] = UINT32_C(1) << golden_draw(&r, 0, 10);
            }
            if (f == 0 && golden_draw(&r, 0, 3) == 0) { limits[f] |= EXH_LIMIT_PULL; }
        }
        golden_put(g, b.in.din);
        golden_put(g, b.in.raised);
        golden_put(g, b.in.missed);
        golden_put(g, b.in.command);
        golden_put(g, b.in.ready);
        permit = exh_safety_step(&b.s, &b.safety, b.in);
        put_permit(g, &permit);
        exh_gate_step(&b.s, b.cfg, b.in.fingers, i, limits, &out);
        golden_put(g, out.enable);
        golden_put(g, out.alive);
        put_axes(g, b.in.fingers, i, limits, &out);
        GOLDEN_STATE(g, exh_safety_serialize, &b.s);
        golden_tick(g);
    }
}
