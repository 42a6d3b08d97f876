/* SPDX-License-Identifier: MIT */
#include "custom.h"

const struct exh_signal custom_input_rows[CUSTOM_INPUT_ROWS] = {
    {0x8B01, EXH_Q_POS, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "q", "m", "position"},
    {0x8B02, EXH_Q_VEL, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "qd", "m_per_s", "velocity"},
    {0x8B03, EXH_Q_POS, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "d", "m", "into the wall"},
    {0x8B04, 0, EXH_WHEN_OUTPUT, 0, 1, 0, "c", "", "contact condition applies"},
    {0x8B05, 0, EXH_WHEN_OUTPUT, 0, 1, 0, "on", "", "what is asked for goes out"},
};

static const struct exh_signal own_rows[] = {
    {0x8B11, EXH_Q_FORCE, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "ask", "n",
        "force that the controller asked for; the least value: none"},
};

static const struct exh_signal_group param_groups[] = {DROP_PARAM_GROUPS};
static const struct exh_signal_table param_table = {param_groups, DROP_PARAM_N};

static const struct exh_signal_group signal_groups[] = {DROP_SIGNAL_GROUPS, {own_rows, 1, 1}};
static const struct exh_signal_table signal_table = {signal_groups, DROP_SIGNAL_N + 1};

static const struct exh_signal_group input_groups[] = {{custom_input_rows, CUSTOM_INPUT_ROWS, 1}};
static const struct exh_signal_table input_table = {input_groups, 1};

EXH_STATIC_ASSERT(
    custom_inputs_match_rows, sizeof(struct custom_inputs) == CUSTOM_INPUT_ROWS * sizeof(int32_t));

/* --- the one instance of this image --- */

static struct drop_par active, staged;
static struct exh_params params;
static struct custom_signals signals;
static struct custom_inputs inputs;
static struct drop_cfg cfg;
static struct custom state;
static struct exh_integrity guard;
static struct exh_scene_calib calib;
static struct slot_wire wire[SLOT_INPUTS];
static const char *unknown;
static uint8_t runs;     /* 1 between init and terminate */
static uint8_t answered; /* 1: a replay has set the answer of the coming tick */
static int32_t answer;

static void defaults(void)
{
    exh_params_setup(&params, &param_table, (int32_t *)&active, (int32_t *)&staged);
}

static int same(const char *a, const char *b)
{
    while (*a != '\0' && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

/* Looks up a name in a table. 1: found. */
static int find(
    const struct exh_signal_table *t, const int32_t *value, const char *name, struct slot_wire *w)
{
    const uint32_t n = exh_signal_count(t);
    for (uint32_t i = 0; i < n; i++) {
        const struct exh_signal *row = exh_signal_at(t, i, NULL);
        if (same(row->name, name)) {
            *w = (struct slot_wire){row, &value[i]};
            return 1;
        }
    }
    return 0;
}

const char *custom_unknown(void) { return unknown; }

static void end(void)
{
    if (runs) { slot.terminate(); }
    runs = 0;
}

static int plug_in(struct exh_period T)
{
    int err;
    unknown = NULL;
    if (slot.inputs > SLOT_INPUTS) { return -EXH_E_RANGE; }
    if (slot.rate_Hz && (uint64_t)slot.rate_Hz * T.num != T.den) { return -EXH_E_RATE; }
    for (unsigned i = 0; i < slot.inputs; i++) {
        if (!find(&input_table, (const int32_t *)&inputs, slot.input[i], &wire[i]) &&
            !find(&param_table, (const int32_t *)&active, slot.input[i], &wire[i])) {
            unknown = slot.input[i];
            return -EXH_E_UNKNOWN;
        }
    }
    err = slot.init(wire, T);
    runs = err == 0;
    return err;
}

static int setup(struct exh_scene_board board)
{
    static const struct custom_inputs no_inputs;
    int err;
    end();
    state = (struct custom){0};
    inputs = no_inputs;
    answered = 0;
    err = exh_calib_set_load(&calib, &params, &active.calib, 1u);
    if (err == 0) { err = drop_setup(&cfg, &active, board, &calib); }
    if (err == 0) { err = plug_in(board.T); }
    exh_params_slew_setup(&params, &active.tune, board.T);
    exh_integrity_seal(&guard, &cfg, sizeof cfg, &params);
    return err;
}

/* The recorded answer, or the controller's. */
static int32_t ask(void)
{
    const int32_t f = answered ? answer : slot.step();
    answered = 0;
    return f;
}

/* The answer replaces spring and damper. The pull-back force belongs to the string, not to a wall,
 * so the law computes it. No answer gives no force in this tick, and a fault that cuts in the
 * next. */
static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    struct drop_now now;
    state.drop.broken = (uint8_t)exh_integrity_step(&guard);
    state.drop.more = state.dumb ? (uint32_t)EXH_FAULT_LOGIC : 0;
    drop_law(&state.drop, &cfg, in, &now, &signals.drop);
    inputs.q_m_q30 = signals.drop.q_m_q30;
    inputs.qd_mps_q27 = signals.drop.qd_mps_q27;
    inputs.d_m_q30 = exh_sat32((int64_t)signals.drop.q_m_q30 - active.own.q_lim_m_q30);
    inputs.c = signals.drop.c;
    inputs.on = now.permit.mode == EXH_PERMIT_OPEN;
    signals.ask_N_q20 = ask();
    state.dumb = signals.ask_N_q20 == SLOT_NONE;
    now.f.spring_N_q20 = state.dumb ? 0 : signals.ask_N_q20;
    now.f.damper_N_q20 = 0;
    drop_out(&state.drop, &cfg, &now, out, &signals.drop);
}

/* The memory of the controller is not saved. Its answers are logged, and a replay uses them. */
static void state_bytes(struct exh_bytes *c)
{
    drop_bytes(c, &state.drop);
    exh_bytes_u8(c, &state.dumb);
    state.dumb &= 1u;
}

static void was_answered(const int32_t *signal)
{
    answer = signal[sizeof(struct drop_signals) / sizeof(int32_t)];
    answered = 1;
}

const struct exh_scene exh_scene_custom = {
    .name = "custom",
    .rate_Hz = 2000,
    .fingers = 1,
    .params = &params,
    .apply = exh_params_apply,
    .safety = &state.drop.safety,
    .signals = &signal_table,
    .values = (int32_t *)&signals,
    .calib = &calib,
    .defaults = defaults,
    .setup = setup,
    .tick = tick,
    .state = state_bytes,
    .answered = was_answered,
    .end = end,
};
