/* SPDX-License-Identifier: MIT */
/* Velocity in plain floating point and bare integers: what it costs. Its noise and lag are in the
 * velocity bench. */
#include "estimators_plain.h"
#include "work.h"

static const struct exh_velocity_scale scale = {291689, {1, 2000}};
static int32_t cnt[BENCH_OPS];

static void counts(void)
{
    wall_seed();
    for (uint32_t i = 0; i < BENCH_OPS; i++) { cnt[i] = wall_cnt(); }
}

static void double_window_setup(void)
{
    counts();
    (void)double_window_start(scale, 4);
}

static void float_window_setup(void)
{
    counts();
    (void)float_window_start(scale, 4);
}

static void double_pole_setup(void)
{
    counts();
    (void)double_pole_start(scale, 1354);
}

static void float_pole_setup(void)
{
    counts();
    (void)float_pole_start(scale, 1354);
}

static void double_foaw_setup(void)
{
    counts();
    (void)double_foaw_start(scale, 16);
}

static void float_foaw_setup(void)
{
    counts();
    (void)float_foaw_start(scale, 16);
}

static void bare_difference_setup(void)
{
    counts();
    (void)bare_pole_start(scale, 0);
}

static void bare_pole_setup(void)
{
    counts();
    (void)bare_pole_start(scale, 2);
}

static void bare_track_setup(void)
{
    counts();
    (void)bare_track_start(scale, 4500);
}

static void bare_pole_op(uint32_t i) { bench_sink = bare_pole_step(cnt[i]); }
static void bare_track_op(uint32_t i) { bench_sink = bare_track_step(cnt[i]); }

#define OP(name) \
    static void name##_op(uint32_t i) { bench_sink = name##_raw(cnt[i]) > 0; }
OP(double_window)
OP(float_window)
OP(double_pole)
OP(float_pole)
OP(double_foaw)
OP(float_foaw)

static const struct work works[] = {
    {"velocity", "bare difference", "integer", "-", 0, bare_difference_setup, bare_pole_op, 0},
    {"velocity", "bare pole", "integer", "-", 0, bare_pole_setup, bare_pole_op, 0},
    {"velocity", "bare track", "integer", "-", 0, bare_track_setup, bare_track_op, 0},
    {"velocity", "plain double window", "float", "-", 0, double_window_setup, double_window_op, 0},
    {"velocity", "plain float window", "float", "-", 0, float_window_setup, float_window_op, 0},
    {"velocity", "plain double pole", "float", "-", 0, double_pole_setup, double_pole_op, 0},
    {"velocity", "plain float pole", "float", "-", 0, float_pole_setup, float_pole_op, 0},
    {"velocity", "plain double foaw", "float", "-", 0, double_foaw_setup, double_foaw_op, 0},
    {"velocity", "plain float foaw", "float", "-", 0, float_foaw_setup, float_foaw_op, 0},
};
const struct work_group speed_works = {works, sizeof works / sizeof works[0]};
