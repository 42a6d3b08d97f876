/* Parameters: what exh_params_apply() costs in a tick of each class. */
#include "bench.h"

#include "exhand/exhand.h"

/* As many values as five fingers and their materials have that may change while it runs, and more that may not. */
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
    exh_params_init(&p, &table, active, staged);
    exh_params_slew(&p, &par, (struct exh_period){1, 20000});
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

static void no_error(struct error *e)
{
    error_add(e, 0);
}

static const struct kernel kernels[] = {
    {"params_stage", "", 1, 0, 1, start, stage_op, no_error, "exact; one of 208 values", 0, NULL},
    {"params_apply_nothing", "", 1, 0, 1, start, apply_op, no_error,
     "a tick in which nothing moves", 0, NULL},
    {"params_apply_staged", "", 1, 0, 1, start, staged_op, no_error,
     "a tick in which something is new; 208 values", 0, NULL},
    {"params_apply_moving", "", 1, 0, 1, start_moving, apply_op, no_error,
     "a tick in which one is on its way; 20 slewed values", 0, NULL},
};
const struct kernel_group params_group = {kernels, sizeof kernels / sizeof kernels[0]};
