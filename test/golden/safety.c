/* safety: the box's state, and the gate to the D/A. */
#include "modules.h"

#include "exhand/safety.h"

#define HEALTHY 0x1F03u /* both switches, all five drives                       */

struct box {
    struct exh_safety s;
    struct exh_safety_par par;
    struct exh_safety_in in;
    struct exh_drive_par axis[EXH_FINGERS];
    struct exh_drive_cfg cfg[EXH_FINGERS];
};

static void box_setup(struct box *b, struct golden_rng *r, uint32_t rate_Hz, uint32_t k)
{
    static struct exh_knot knot[2] = {{0, 0, {0, 0}}, {1 << 25, 1 << 28, {0, 0}}};
    (void)memset(b, 0, sizeof *b);
    CHECK_EQ_I64(exh_table_set(knot, 2), 0);
    b->par.missed_max = (int32_t)golden_draw(r, -1, 2);
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
static void any_in(struct exh_safety_in *in, struct golden_rng *r, uint32_t k)
{
    static const uint8_t command[] = {EXH_CMD_NONE,  EXH_CMD_OFF,   4,
                                      EXH_CMD_RUN,   EXH_CMD_CLEAR, EXH_CMD_RUN,
                                      EXH_CMD_CLEAR, EXH_CMD_RUN};
    if (golden_draw(r, 0, 31) == 0) {
        in->din ^= 1u << golden_draw(r, 0, 12);
    } else if (golden_draw(r, 0, 7) == 0) {
        in->din = HEALTHY;
    }
    in->raised = 0;
    in->missed = 0;
    if (golden_draw(r, 0, 31) == 0) { in->raised = 1u << golden_draw(r, 0, 5); }
    if (golden_draw(r, 0, 63) == 0) { in->missed = (uint32_t)golden_draw(r, 0, 2); }
    if (k == 188 || k == 190) { in->missed = (uint32_t)golden_draw(r, 0, UINT32_MAX); }
    in->command = command[golden_draw(r, 0, 7)];
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
        golden_wave(&cur[f], "safety", rate_Hz, 1 + f, -end, end, 1 << golden_draw(&r, 10, 26));
    }
    while (g->tick < GOLDEN_TICKS) {
        struct exh_current_ledger i[EXH_FINGERS];
        struct exh_drive_out out;
        uint32_t limits[EXH_FINGERS] = {0};
        if (g->tick == 0 || g->tick == GOLDEN_AGAIN) { box_setup(&b, &r, rate_Hz, g->tick); }
        any_in(&b.in, &r, g->tick);
        (void)memset(i, 0, sizeof i);
        for (unsigned f = 0; f < b.in.fingers; f++) { i[f].table_A_q26 = cur[f].at[g->tick]; }
        golden_put(g, b.in.din);
        golden_put(g, b.in.raised);
        golden_put(g, b.in.missed);
        golden_put(g, b.in.command);
        golden_put(g, exh_safety_step(&b.s, &b.par, b.in));
        exh_gate(&b.s, b.cfg, b.in.fingers, i, limits, &out);
        golden_put(g, out.enable);
        golden_put(g, out.alive);
        put_axes(g, b.in.fingers, i, limits, &out);
        GOLDEN_STATE(g, exh_safety_bytes, &b.s);
        golden_tick(g);
    }
}
