/* SPDX-License-Identifier: MIT */
/* main() of an image that counts kernels: one line each, kernel,name,cycles of 1024 ops, an empty
 * op subtracted. Where virtual time is instructions, so are these. No sines in floating point:
 * they would need a C library. */
#include "law.h"
#include "plain.h"
#include "soft.h"
#include "tick.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/exhand.h"

void mps2_say(const char *s);

static uint32_t seed = 1;
volatile int64_t soft_sink;
static volatile double sink_double;
static volatile float sink_float;

static int32_t any(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (int32_t)(seed >> 3) - (1 << 28);
}

/* --- low-pass --- */

static struct exh_filter_cfg filter_cfg;
static struct exh_filter filter[CHANNELS];
static struct exh_filter_cheap_cfg cheap_cfg;
static struct exh_filter_cheap cheap[CHANNELS];
int32_t soft_x[OPS + CHANNELS], soft_y[CHANNELS];
static double b_double[5], s_double[CHANNELS][2];
static float b_float[5], s_float[CHANNELS][2];

static void filter_start(struct exh_period T)
{
    static const int32_t zero[CHANNELS];
    static const struct exh_filter_par par = {2, EXH_Q(20, 1, 16)};
    EXH_ASSERT(exh_filter_setup(&filter_cfg, &par, T) == 0);
    exh_filter_reset(filter, zero, CHANNELS);
    EXH_ASSERT(exh_filter_cheap_setup(&cheap_cfg, &par, T) == 0);
    exh_filter_cheap_reset(cheap, &cheap_cfg, zero, CHANNELS);
}

/* fc/fs = 0.01 and 0.4 */
static void low_start(void) { filter_start((struct exh_period){1, 2000}); }
static void high_start(void) { filter_start((struct exh_period){1, 50}); }

static void filter_op(uint32_t i)
{
    exh_filter_step(filter, &filter_cfg, &soft_x[i], soft_y, CHANNELS);
}

static void cheap_op(uint32_t i)
{
    exh_filter_cheap_step(cheap, &cheap_cfg, &soft_x[i], soft_y, CHANNELS);
}

#define FILTER(T) \
    static void filter_##T##_op(uint32_t i) \
    { \
        for (uint32_t k = 0; k < CHANNELS; k++) { \
            const T in = (T)soft_x[i + k], out = b_##T[0] * in + s_##T[k][0]; \
            s_##T[k][0] = b_##T[1] * in - b_##T[3] * out + s_##T[k][1]; \
            s_##T[k][1] = b_##T[2] * in - b_##T[4] * out; \
            sink_##T = out; \
        } \
    }
FILTER(double)
FILTER(float)

static void inputs(void)
{
    /* fc/fs = 0.01 */
    static const double b[5] = {0.000944691843840, 0.00188938368768, 0.000944691843840,
        -1.911197067426073, 0.914975834801433};
    for (uint32_t i = 0; i < OPS + CHANNELS; i++) { soft_x[i] = any(); }
    for (int k = 0; k < 5; k++) { b_float[k] = (float)(b_double[k] = b[k]); }
}

/* --- sine and cosine --- */

static void sine_op(uint32_t i)
{
    struct exh_sincos both;
    exh_sincos(soft_x[i], &both);
    soft_sink = both.sin_q30 + (int64_t)both.cos_q30;
}

/* --- velocity --- */

static struct exh_velocity_window_cfg window_cfg;
static struct exh_velocity_window window;
static struct exh_velocity_pole_cfg pole_cfg;
static struct exh_velocity_pole pole;
static struct exh_velocity_track_cfg track_cfg;
static struct exh_velocity_track track;
static struct plain_window_double window_double;
static struct plain_window_float window_float;

static void velocity_start(void)
{
    static const struct exh_velocity_scale scale = {291689, {1, 2000}};
    static const struct exh_velocity_par four = {2};
    EXH_ASSERT(exh_velocity_window_setup(&window_cfg, scale, &four) == 0);
    EXH_ASSERT(exh_velocity_pole_setup(&pole_cfg, scale, 1354) == 0);
    EXH_ASSERT(exh_velocity_track_setup(&track_cfg, scale, 4500) == 0);
    window_double = (struct plain_window_double){500, {0}, 0, 4};
    window_float = (struct plain_window_float){500, {0}, 0, 4};
}

static int32_t cnt(uint32_t i) { return soft_x[i] >> 20; }

static void window_op(uint32_t i)
{
    soft_sink = exh_velocity_window_step(&window, &window_cfg, cnt(i));
}

static void pole_op(uint32_t i) { soft_sink = exh_velocity_pole_step(&pole, &pole_cfg, cnt(i)); }

static void track_op(uint32_t i)
{
    soft_sink = exh_velocity_track_step(&track, &track_cfg, cnt(i));
}

static void window_double_op(uint32_t i)
{
    sink_double = plain_window_double(&window_double, cnt(i) * 66.3e-6);
}

static void window_float_op(uint32_t i)
{
    sink_float = plain_window_float(&window_float, (float)cnt(i) * 66.3e-6f);
}

/* --- law --- */

static const struct exh_contact_par wall = {
    EXH_Q(7989, 4, EXH_Q_K), EXH_Q(395, 64, EXH_Q_B), 0, 0, 0};
static const struct law_double wall_double = {1997.25, 6.171875, 0, 0, 100};
static const struct law_float wall_float = {1997.25f, 6.171875f, 0, 0, 100};
static struct exh_contact contact[FINGERS];

static void law_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        struct exh_force_ledger l;
        (void)exh_contact_step(&contact[f], &wall,
            (struct exh_contact_in){soft_x[i + f] >> 6, soft_x[i + f + 1] >> 4, 0}, &l);
        soft_sink = l.spring_N_q20 + l.damper_N_q20;
    }
}

static void force_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        soft_sink = exh_contact_force(
            &wall, (struct exh_contact_in){soft_x[i + f] >> 6, soft_x[i + f + 1] >> 4, 0});
    }
}

static void law_double_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        sink_double = law_double(&wall_double, b_double[3] + i, b_double[2]);
    }
}

static void law_float_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        sink_float = law_float(&wall_float, b_float[3] + (float)i, b_float[2]);
    }
}

/* --- table --- */

static struct exh_knot knot[16];
static struct plain_table_double table_double;
static struct plain_table_float table_float;

static void table_start(void)
{
    for (int k = 0; k < 16; k++) {
        knot[k].x = k << 26;
        knot[k].y = k * (1 << 25) + k * k * 1000003;
        table_float.x[k] = (float)(table_double.x[k] = knot[k].x);
        table_float.y[k] = (float)(table_double.y[k] = knot[k].y);
        table_float.slope[k] = (float)(table_double.slope[k] = 0.5 + k * 0.03);
    }
    EXH_ASSERT(exh_table_setup(knot, 16) == 0);
}

static void table_op(uint32_t i)
{
    soft_sink = exh_table_at((struct exh_table){knot, 16}, (int32_t)(i << 20));
}

static void table_double_op(uint32_t i)
{
    sink_double = plain_table_double(&table_double, (double)(int32_t)(i << 20));
}

static void table_float_op(uint32_t i)
{
    sink_float = plain_table_float(&table_float, (float)(int32_t)(i << 20));
}

/* --- precontact --- */

static const struct exh_material_par material = {1 << 24, 1 << 24, 1 << 22};
static const struct exh_precontact_par freeze = {-EXH_Q(5, 1000, 30), EXH_Q(1, 1000, 30), 1 << 24,
    0, 0, 60000, EXH_Q(5, 1000, 30), 100, 50, 100};
static struct exh_precontact_cfg freeze_cfg;
static struct exh_precontact plane[FINGERS];
static struct plain_freeze_double plane_double[FINGERS];
static struct plain_freeze_float plane_float[FINGERS];

static void plane_start(void)
{
    static const struct exh_plane p = {EXH_PLANE_HIT, 0, 1, {644245094, 0, 858993459},
        {EXH_Q(60, 1000, 30), 0, EXH_Q(80, 1000, 30)}};
    EXH_ASSERT(exh_precontact_setup(&freeze_cfg, &freeze, &material, 1, EXH_Q(7, 1000, 30),
                   (struct exh_period){1, 2000}) == 0);
    for (uint32_t f = 0; f < FINGERS; f++) {
        EXH_ASSERT(exh_precontact_update(&plane[f], &freeze_cfg, &p, 0) == 0);
        plane_double[f] =
            (struct plain_freeze_double){{0.6, 0.1, 0.8}, 0.1, -0.005, 0.001, 0, 1, 0};
        plane_float[f] =
            (struct plain_freeze_float){{0.6f, 0.1f, 0.8f}, 0.1f, -0.005f, 0.001f, 0, 1, 0};
    }
}

static void plane_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        const struct exh_precontact_in in = {
            {soft_x[i] >> 2, soft_x[i + 1] >> 2, soft_x[i + 2] >> 2}, {0, 0, 0}, soft_x[i + 3] >> 2,
            0, 0, 1, 0};
        soft_sink = exh_precontact_step(&plane[f], &freeze_cfg, &in);
    }
}

static void plane_double_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        const double tip[3] = {b_double[3] * s_double[0][1], b_double[4], b_double[2]};
        plain_freeze_double(&plane_double[f], tip, b_double[3], (int)(i & 1));
    }
}

static void plane_float_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        const float tip[3] = {b_float[3] * s_float[0][1], b_float[4], b_float[2]};
        plain_freeze_float(&plane_float[f], tip, b_float[3], (int)(i & 1));
    }
}

/* --- the integer kernels of the paper's controller in one, as kernel integer_tick_x5 of the bench
 * --- */

static struct tick_box box;
static struct tick_in box_in[OPS];

static void tick_start(void)
{
    EXH_ASSERT(tick_setup(&box) == 0);
    for (uint32_t i = 0; i < OPS; i++) { tick_input(&box_in[i], i); }
}

static void tick_op(uint32_t i) { soft_sink = tick_once(&box, &box_in[i]); }

/* --- the tag of a STATE on a link with a key --- */

static void mac_op(uint32_t i)
{
    static const struct exh_mac_key key = {{1, 2}};
    soft_sink = (int64_t)(exh_mac(&key, &soft_x[i & 511], 252) >> 1);
}

/* --- all --- */

static void empty(uint32_t i) { (void)i; }

static uint32_t counted(void (*volatile op)(uint32_t i))
{
    const uint32_t begin = exh_board_cycles();
    for (uint32_t i = 0; i < OPS; i++) { op(i); }
    return exh_board_cycles() - begin;
}

static void say_number(uint32_t n)
{
    char text[12];
    unsigned at = sizeof text - 1;
    text[at] = 0;
    do {
        text[--at] = (char)('0' + n % 10);
        n /= 10;
    } while (n > 0);
    mps2_say(&text[at]);
}

static const struct soft_op low[] = {
    {"filter,exhand", filter_op},
    {"filter,exhand-cheap", cheap_op},
    {"filter,plain double DF2T", filter_double_op},
    {"filter,plain float DF2T", filter_float_op},
};
static const struct soft_op high[] = {
    {"filter_high,exhand", filter_op}, {"filter_high,exhand-cheap", cheap_op}};
static const struct soft_op others[] = {
    {"sine,exhand sincos", sine_op},
    {"law,exhand force alone", force_op},
    {"law,exhand contact law", law_op},
    {"law,plain double law", law_double_op},
    {"law,plain float law", law_float_op},
    {"table,exhand table", table_op},
    {"table,plain double table", table_double_op},
    {"table,plain float table", table_float_op},
    {"precontact,exhand precontact", plane_op},
    {"precontact,plain double freeze", plane_double_op},
    {"precontact,plain float freeze", plane_float_op},
    {"velocity,velocity_window_2", window_op},
    {"velocity,velocity_pole", pole_op},
    {"velocity,velocity_track", track_op},
    {"velocity,plain double window", window_double_op},
    {"velocity,plain float window", window_float_op},
    {"tick,exhand", tick_op},
    {"mac,252 bytes", mac_op},
};

static void others_start(void)
{
    table_start();
    plane_start();
    tick_start();
    velocity_start();
}

#define GROUP(ops, start) \
    { \
        ops, sizeof ops / sizeof ops[0], start \
    }
static const struct soft_group ours[] = {
    GROUP(low, low_start), GROUP(high, high_start), GROUP(others, others_start)};

static void count(const struct soft_group *g, uint32_t none)
{
    g->start();
    for (unsigned k = 0; k < g->n; k++) {
        mps2_say("soft,");
        mps2_say(g->op[k].name);
        mps2_say(",");
        say_number(counted(g->op[k].op) - none);
        mps2_say("\n");
    }
}

/* The FPU, where the code uses one, is off after a reset. */
static void fpu_on(void)
{
#ifdef __ARM_FP
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20;
    __asm__ volatile("dsb\n isb" : : : "memory");
#endif
}

void exh_assert_failed(const char *file, int line)
{
    (void)line;
    exh_board_halt(file);
}

int main(void)
{
    struct exh_period T;
    uint32_t none;
    fpu_on();
    (void)exh_board_init(1000, &T); /* starts the clock */
    inputs();
    none = counted(empty);
    for (unsigned k = 0; k < sizeof ours / sizeof ours[0]; k++) { count(&ours[k], none); }
    for (unsigned k = 0; k < 3; k++) { count(&soft_limiter[k], none); }
    count(&soft_twins, none);
    count(&soft_bare, none);
#ifdef PEERS_CMSIS
    count(&soft_cmsis, none);
#endif
    exh_board_halt("done");
    return 0;
}
