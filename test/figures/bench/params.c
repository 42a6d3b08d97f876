/* SPDX-License-Identifier: MIT */
/* Parameters: what exh_params_apply() costs in a tick of each class, and exh_gains_step() behind
 * it. */
#include "bench.h"

#include "exhand/exhand.h"

/* As many values as five fingers and their materials have that may change while it runs, and more
 * that may not. */
static const struct exh_signal_group groups[] = {
    {exh_quad_rows, EXH_QUAD_ROWS, 5},
    {exh_contact_rows, EXH_CONTACT_ROWS, 5},
    {exh_drive_rows, EXH_DRIVE_ROWS, 5},
    {exh_hand_rows, EXH_HAND_ROWS, 5},
    {exh_precontact_rows, EXH_PRECONTACT_ROWS, 5},
    {exh_material_rows, EXH_MATERIAL_ROWS, 16},
    {exh_safety_rows, EXH_SAFETY_ROWS, 1},
};
static const struct exh_signal_table table = {groups, sizeof groups / sizeof groups[0]};
static struct exh_params p;
static int32_t active[512], staged[512];

static void start(void)
{
    static const struct exh_tune_par par = {1000};
    exh_params_setup(&p, &table, active, staged);
    exh_params_slew_setup(&p, &par, (struct exh_period){1, 20000});
    p.locked = 1;
}

static void start_moving(void)
{
    start();
    (void)exh_params_stage(&p, 0x0401, 3, EXH_Q(1000000, 1, EXH_Q_K));
    (void)exh_params_apply(&p);
}

static void stage_op(uint32_t i)
{
    bench_sink = exh_params_stage(&p, 0x0401, 3, (int32_t)(i & 1023u));
}

static void staged_op(uint32_t i)
{
    (void)i;
    p.pending = 1;
    bench_sink = exh_params_apply(&p);
}

static void apply_op(uint32_t i)
{
    (void)i;
    bench_sink = exh_params_apply(&p);
}

/* Five walls on their way below a rule of as many knots as there may be, each with a knot in the
 * way. */
static struct exh_gains_par rule;

static void start_led(void)
{
    start();
    rule.knots = EXH_GAINS_KNOTS;
    for (int i = 0; i < EXH_GAINS_KNOTS; i++) {
        rule.b_Nspm_q20[i] = (i + 1) * EXH_Q(10, 1, EXH_Q_B);
        rule.k_Npm_q10[i] = EXH_Q(5000, 1, EXH_Q_K) - (i & 1) * EXH_Q(2000, 1, EXH_Q_K);
    }
    exh_gains_enable(&p, 1);
    for (uint16_t k = 0; k < 5; k++) {
        const int32_t at = exh_signal_find(&table, 0x0401, k),
                      b = exh_signal_find(&table, 0x0402, k);
        exh_params_set_active(&p, (uint32_t)at, EXH_Q(5000, 1, EXH_Q_K));
        exh_params_set_active(&p, (uint32_t)b, EXH_Q(10, 1, EXH_Q_B));
        (void)exh_params_stage_at(&p, (uint32_t)at, EXH_Q(3000, 1, EXH_Q_K));
        (void)exh_params_stage_at(&p, (uint32_t)b, EXH_Q(80, 1, EXH_Q_B));
    }
    (void)exh_params_apply(&p);
}

static void led_op(uint32_t i)
{
    (void)i;
    exh_gains_step(&p, &rule);
    bench_sink = p.moving;
}

static void no_error(struct error *e) { error_add(e, 0); }

static const struct kernel kernels[] = {
    {"params_stage", "", 1, 0, 1, start, stage_op, no_error, "exact; one of 208 values", 0, NULL},
    {"params_apply_nothing", "", 1, 0, 1, start, apply_op, no_error,
        "a tick in which nothing moves", 0, NULL},
    {"params_apply_staged", "", 1, 0, 1, start, staged_op, no_error,
        "a tick in which something is new; 208 values", 0, NULL},
    {"params_apply_moving", "", 1, 0, 1, start_moving, apply_op, no_error,
        "a tick in which one is on its way; 20 slewed values", 0, NULL},
    {"gains_step", "", 1, 0, 1, start_led, led_op, no_error,
        "five walls on their way, 8 knots; every tick of a scene with a rule", 0, NULL},
};
const struct kernel_group params_group = {kernels, sizeof kernels / sizeof kernels[0]};
