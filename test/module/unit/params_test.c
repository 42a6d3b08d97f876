/* SPDX-License-Identifier: MIT */
/* Parameters that go little by little (params.h): where they are in each tick, that they end where
 * they are wanted, in mid-way saved, restored and guarded. */
#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/integrity.h"
#include "exhand/params.h"
#include "exhand/signal.h"

#include "check.h"

static const struct exh_signal rows[] = {
    {0x7101, 0, EXH_WHEN_SLEWED, INT32_MIN, INT32_MAX, 0, "force", "n", "little by little"},
    {0x7102, 0, EXH_WHEN_ANY, -10, 10, 3, "bit", "", "at once"},
    {0x7103, 0, EXH_WHEN_SETUP, 0, 9, 5, "fixed", "", "before the loop"},
};
static const struct exh_signal other[] = {
    {0x7201, 0, EXH_WHEN_SLEWED, -1000, 1000, 100, "gain", "", "little by little"},
};
static const struct exh_signal_group groups[] = {{rows, LEN(rows), 2}, {other, 1, 1}};
static const struct exh_signal_table table = {groups, 2};
#define VALUES 7
#define GAIN   6

static struct exh_params p;
static int32_t active[VALUES], staged[VALUES];

static void start(unsigned shift)
{
    exh_params_setup(&p, &table, active, staged);
    p.shift = (uint8_t)shift;
    p.locked = 1;
}

TEST(steps_worked_out)
{
    static const struct {
        unsigned shift;
        int32_t now, goal, next;
    } row[] = {
        {0, 3, 100, 100},
        {0, INT32_MIN, INT32_MAX, INT32_MAX},
        {3, 0, 80, 10},
        {3, 0, 81, 11},
        {3, 0, -80, -10},
        {3, 0, -81, -11}, /* away from zero, both ways */
        {3, 0, 1, 1},
        {3, 0, -1, -1},
        {15, 7, 7, 7},
        {31, INT32_MIN, INT32_MAX, INT32_MIN + 2},
        {1, INT32_MIN, INT32_MAX, 0},
        {1, INT32_MAX, INT32_MIN, -1},
        {31, INT32_MAX, INT32_MIN, INT32_MAX - 2},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const int32_t next = exh_params_slew_step(row[i].now, row[i].goal, row[i].shift);
        CHECK(next == row[i].next, "row %zu: %" PRId32, i, next);
    }
}

/* A force moves at its slew rate. A bit is set immediately. */
TEST(slewed_and_not)
{
    start(2);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, 200), 0);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7102, 1, 7), 0);
    CHECK_EQ_I64(exh_params_apply(&p), 1);
    CHECK_EQ_I64(active[4], 7);
    CHECK_EQ_I64(active[GAIN], 125);
    CHECK_EQ_I64(p.moving, 1);
    CHECK_EQ_I64(exh_params_apply(&p), 1);
    CHECK_EQ_I64(active[GAIN], 144);                        /* 18.75 of 75 */
    CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, -100), 0); /* back again, from where it is */
    CHECK_EQ_I64(exh_params_apply(&p), 1);
    CHECK_EQ_I64(active[GAIN], 83);
    CHECK_EQ_I64(staged[GAIN], -100);
    exh_params_discard(&p);
    CHECK_EQ_I64(staged[GAIN], 83);
    CHECK_EQ_I64(exh_params_apply(&p), 0);
}

/* A value that differs without being staged is damaged. While another value moves it stays, so that
 * the guard reports it. */
TEST(damaged_while_another_moves)
{
    start(2);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, 900), 0);
    (void)exh_params_apply(&p);
    active[1] = 9;
    CHECK_EQ_I64(exh_params_apply(&p), 1);
    CHECK(active[1] == 9 && staged[1] == 3 && active[GAIN] == 450, "%d", (int)active[GAIN]);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7102, 1, 7), 0);
    CHECK_EQ_I64(exh_params_apply(&p), 1);
    CHECK(active[1] == 3 && active[4] == 7, "%d", (int)active[1]);
}

TEST(before_the_loop_at_once)
{
    start(5);
    p.locked = 0;
    CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, 200), 0);
    CHECK_EQ_I64(exh_params_apply(&p), 1);
    CHECK_EQ_I64(active[GAIN], 200);
    CHECK_EQ_I64(exh_params_apply(&p), 0);
}

TEST(shift_of_a_time)
{
    static const struct {
        int32_t ms;
        struct exh_period T;
        unsigned shift;
    } row[] = {
        {20, {1, 2000}, 6}, /* 64 ticks are 32 ms */
        {16, {1, 2000}, 5},
        {20, {1, 90}, 1},
        {11, {1, 90}, 0},
        {12, {1, 90}, 1},
        {0, {1, 20000}, 0},
        {1, {1, 1000}, 0},
        {1000, {1, 20000}, 15},
        {1000, {1, 20020}, 15},
        {1000, {1, 1}, 0},
        {-5, {1, 2000}, 0},
        {INT32_MAX, {1, 20000}, 15},
        {1000, {1, 4294967295u}, 15},
        {1000, {4294967295u, 1}, 0},
        {20, {596, 1193182}, 6},
        {512, {1, 2000}, 10},
        {513, {1, 2000}, 11},
        {512, {1, 2001}, 11},
        {512, {1, 1999}, 10},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_tune_par par = {row[i].ms};
        exh_params_slew_setup(&p, &par, row[i].T);
        CHECK(p.shift == row[i].shift, "row %zu: %u", i, p.shift);
    }
}

/* What is wanted, not what is passed on the way. */
TEST(image_in_mid_way)
{
    uint8_t image[16 + 4 * VALUES];
    start(3);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, 900), 0);
    (void)exh_params_apply(&p);
    CHECK_EQ_I64(active[GAIN], 200);
    CHECK_EQ_I64(exh_params_save(&p, image, sizeof image), sizeof image);
    start(3);
    CHECK_EQ_I64(exh_params_load(&p, image, sizeof image, NULL), -EXH_E_STATE);
    p.locked = 0;
    CHECK_EQ_I64(exh_params_load(&p, image, sizeof image, NULL), 0);
    p.locked = 1;
    (void)exh_params_apply(&p);
    CHECK_EQ_I64(active[GAIN], 200);
    CHECK_EQ_I64(staged[GAIN], 900);
}

/* A person's values come with his own image alone. */
TEST(a_persons_values)
{
    static const struct exh_signal mine[] = {
        {0x7301, 0, EXH_WHEN_PERSON, 0, 100, 50, "ceiling", "n", "nobody else's"},
        {0x7302, 0, EXH_WHEN_SETUP, 0, 100, 50, "other", "", "anybody's"}};
    static const struct exh_signal_group group = {mine, LEN(mine), 1};
    static const struct exh_signal_table of = {&group, 1};
    uint8_t image[16 + 4 * 2];
    exh_params_setup(&p, &of, active, staged);
    staged[0] = 90;
    staged[1] = 91;
    CHECK_EQ_I64(exh_params_save(&p, image, sizeof image), sizeof image);
    exh_params_setup(&p, &of, active, staged);
    CHECK_EQ_I64(exh_params_load(&p, image, sizeof image, NULL), 0);
    CHECK(staged[0] == 50 && staged[1] == 91, "%d, %d", (int)staged[0], (int)staged[1]);
    CHECK_EQ_I64(exh_params_restore(&p, image, sizeof image, NULL), 0);
    CHECK(staged[0] == 90 && staged[1] == 91, "%d, %d", (int)staged[0], (int)staged[1]);
    image[12] ^= 1u;
    CHECK_EQ_I64(exh_params_restore(&p, image, sizeof image, NULL), -EXH_E_CRC);
}

/* From a keyframe in mid-way it goes on with the same values. */
TEST(keyframe_in_mid_way)
{
    for (int at = 0; at < 40; at++) {
        uint8_t b[8 * VALUES];
        int32_t then[60], k;
        struct exh_bytes c = exh_bytes_writer(b, sizeof b);
        start(2);
        CHECK_EQ_I64(exh_params_stage(&p, 0x7101, 1, -1000000), 0);
        CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, 900), 0);
        for (k = 0; k < at; k++) { (void)exh_params_apply(&p); }
        exh_params_serialize(&c, &p);
        CHECK(exh_bytes_ok(&c) && c.at == 4 * (VALUES + 3), "%u bytes", (unsigned)c.at);
        for (k = 0; k < 60; k++) {
            (void)exh_params_apply(&p);
            then[k] = active[3] ^ active[GAIN];
        }
        start(2);
        c = exh_bytes_reader(b, 4 * (VALUES + 3));
        exh_params_serialize(&c, &p);
        CHECK(exh_bytes_ok(&c) && c.at == 4 * (VALUES + 3), "read");
        for (k = 0; k < 60; k++) {
            (void)exh_params_apply(&p);
            CHECK((active[3] ^ active[GAIN]) == then[k], "from %d on, tick %" PRId32, at, k);
        }
        CHECK(active[3] == -1000000 && active[GAIN] == 900 && !p.moving, "end");
    }
}

/* The same bytes with room to spare, with just enough, and counted; with less it fails. */
TEST(keyframe_wherever_it_fits)
{
    const uint32_t len_B = 4 * (VALUES + 3);
    uint8_t whole[8 * VALUES], b[8 * VALUES];
    struct exh_bytes c = exh_bytes_writer(whole, sizeof whole);
    start(2);
    exh_params_serialize(&c, &p);
    for (uint32_t cap_B = 0; cap_B <= sizeof b; cap_B++) {
        memset(b, 0xAA, sizeof b);
        c = exh_bytes_writer(b, cap_B);
        exh_params_serialize(&c, &p);
        CHECK(exh_bytes_ok(&c) == (cap_B >= len_B), "%u bytes", (unsigned)cap_B);
        CHECK(cap_B < len_B || (c.at == len_B && memcmp(b, whole, len_B) == 0), "%u bytes",
            (unsigned)cap_B);
        for (uint32_t i = cap_B; i < sizeof b; i++) { CHECK(b[i] == 0xAA, "%u", (unsigned)i); }
        exh_params_serialize(&c, &p);
        CHECK(cap_B >= len_B || !exh_bytes_ok(&c), "%u bytes", (unsigned)cap_B);
    }
    c = exh_bytes_measure();
    exh_params_serialize(&c, &p);
    CHECK_EQ_I64(c.at, len_B);
}

/* All or nothing: shorter, or with one value that its row forbids. */
TEST(bad_keyframes)
{
    static const struct {
        unsigned word;
        int32_t value;
    } bad[] = {{2, 11}, {3, 6}, {6, -11}, {8, 1001}, {8, -1001}, {9, 1001}, {9, INT32_MIN}};
    uint8_t b[8 * VALUES], whole[8 * VALUES];
    const uint32_t len_B = 4 * (VALUES + 3);
    struct exh_bytes c = exh_bytes_writer(whole, sizeof whole);
    start(2);
    exh_params_serialize(&c, &p);
    for (unsigned i = 0; i < LEN(bad) + len_B; i++) {
        const uint32_t n = i < len_B ? i : len_B;
        memcpy(b, whole, sizeof b);
        c = exh_bytes_writer(b, sizeof b);
        if (i >= len_B) {
            int32_t v = bad[i - len_B].value;
            c.at = 4 * bad[i - len_B].word;
            exh_bytes_i32(&c, &v);
        }
        start(2);
        active[0] = staged[0] = 4711;
        c = exh_bytes_reader(b, n);
        exh_params_serialize(&c, &p);
        CHECK(
            !exh_bytes_ok(&c) && active[0] == 4711 && staged[0] == 4711 && !p.moving && !p.pending,
            "case %u", i);
    }
}

/* Values are staged in most ticks, and the guard reports nothing. Then one bit of either array
 * flips half way. The guard reports it within two rounds, while values still move. */
TEST(guard_in_mid_way)
{
    for (unsigned bit = 0; bit < 2 * 32 * VALUES; bit++) {
        int32_t *at = bit < 32 * VALUES ? &active[bit / 32] : &staged[bit / 32 - VALUES];
        struct exh_integrity g;
        unsigned n = 0;
        start(bit % 9);
        exh_integrity_seal(&g, NULL, 0, &p);
        for (unsigned k = 0; k < 100 + bit; k++) {
            if (k % 3) {
                CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, (int32_t)(k * 7919 % 2001) - 1000), 0);
            }
            if (k % 7 == 0) {
                CHECK_EQ_I64(exh_params_stage(&p, 0x7101, 1, exh_from_u32(k * 0x9E3779B9u)), 0);
            }
            if (k % 5) { (void)exh_params_apply(&p); }
            CHECK(!exh_integrity_step(&g), "bit %u: told in tick %u", bit, k);
        }
        *at = exh_from_u32((uint32_t)*at ^ UINT32_C(1) << bit % 32);
        while (!exh_integrity_step(&g) && n < 100) {
            CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, (int32_t)(n * 71) % 1000), 0);
            (void)exh_params_apply(&p);
            n++;
        }
        CHECK(n < VALUES + 1, "bit %u: %u ticks", bit, n);
    }
}

/* A value that a rule refuses is taken back. The one that is moving goes on, and the guard reports
 * nothing. */
TEST(taken_back)
{
    int32_t was[VALUES];
    struct exh_integrity g;
    start(3);
    exh_integrity_seal(&g, NULL, 0, &p);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, 900), 0);
    (void)exh_params_apply(&p);
    memcpy(was, staged, sizeof was);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7101, 0, 4711), 0);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, -900), 0);
    exh_params_rollback(&p, was, 1);
    CHECK(p.pending && p.by, "what was pending is pending no more");
    CHECK_EQ_I64(exh_params_stage(&p, 0x7101, 0, 4711), 0);
    exh_params_rollback(&p, was, 0);
    CHECK_EQ_I64(p.by, 0);
    CHECK(staged[0] == 0 && staged[GAIN] == 900 && !p.pending && p.moving, "%d", (int)staged[GAIN]);
    for (int k = 0; k < 100; k++) {
        (void)exh_params_apply(&p);
        CHECK(!exh_integrity_step(&g), "tick %d", k);
    }
    CHECK(active[0] == 0 && active[GAIN] == 900 && !p.moving, "%d", (int)active[GAIN]);
}

/* A keyframe of values that rest takes away what was on its way, and what was to be. */
TEST(keyframe_at_rest)
{
    uint8_t b[8 * VALUES];
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    start(2);
    exh_params_serialize(&c, &p);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, 900), 0);
    (void)exh_params_apply(&p);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7102, 0, 9), 0);
    CHECK(p.moving && p.pending, "nothing to take away");
    c = exh_bytes_reader(b, c.at);
    exh_params_serialize(&c, &p);
    CHECK(
        exh_bytes_ok(&c) && !p.moving && !p.pending, "moving %d, pending %d", p.moving, p.pending);
    CHECK(active[GAIN] == 100 && staged[GAIN] == 100 && staged[1] == 3, "values");
}

/* A head alone is long enough to be of another table. */
TEST(images_of_a_head)
{
    uint8_t image[16 + 4 * VALUES];
    start(0);
    CHECK_EQ_I64(exh_params_save(&p, image, sizeof image), sizeof image);
    for (uint32_t n = 0; n < sizeof image; n++) {
        CHECK_EQ_I64(exh_params_load(&p, image, n, NULL), -EXH_E_SHORT);
    }
    CHECK_EQ_I64(exh_params_save(&p, NULL, 0), -EXH_E_SHORT); /* not looked at */
    image[0] ^= 1u;
    CHECK_EQ_I64(exh_params_load(&p, image, 11, NULL), -EXH_E_SHORT);
    CHECK_EQ_I64(exh_params_load(&p, image, 12, NULL), -EXH_E_VERSION);
}

TEST(a_table_of_none)
{
    static const struct exh_signal_table none = {groups, 0};
    struct exh_integrity g;
    exh_params_setup(&p, &none, NULL, NULL);
    exh_integrity_seal(&g, NULL, 0, &p);
    for (int k = 0; k < 5; k++) { CHECK_EQ_I64(exh_integrity_step(&g), 0); }
}

/* A limit of force rises little by little and has fallen in the next tick, wherever it was on its
 * way to; in a keyframe as a slewed one. */
TEST(a_limit_falls_at_once)
{
    static const struct exh_signal row[] = {
        {0x7301, 0, EXH_WHEN_LIMIT, 0, 100, 40, "most", "n", "of force"}};
    static const struct exh_signal_group group[] = {{row, 1, 2}};
    static const struct exh_signal_table limits = {group, 1};
    uint8_t b[16];
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    exh_params_setup(&p, &limits, active, staged);
    p.shift = 2;
    p.locked = 1;
    CHECK_EQ_I64(exh_params_stage(&p, 0x7301, 0, 80), 0);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7301, 1, 1), 0);
    (void)exh_params_apply(&p);
    CHECK(active[0] == 50 && active[1] == 1 && p.moving, "%d, %d", (int)active[0], (int)active[1]);
    exh_params_serialize(&c, &p);
    CHECK(exh_bytes_ok(&c) && c.at == 16, "%u bytes", (unsigned)c.at);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7301, 0, 49), 0);
    (void)exh_params_apply(&p);
    CHECK(active[0] == 49 && !p.moving, "%d", (int)active[0]);
}

TEST(what_may_be_staged)
{
    static const struct exh_signal out[] = {
        {0x7401, 0, EXH_WHEN_OUTPUT, 0, 9, 4, "out", "", "computed"}};
    static const struct exh_signal_group group[] = {{out, 1, 1}};
    static const struct exh_signal_table outputs = {group, 1};
    start(0);
    CHECK_EQ_I64(exh_params_validate(&p, VALUES - 1, 1000), 0);
    CHECK_EQ_I64(exh_params_validate(&p, VALUES - 1, 1001), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_params_validate(&p, VALUES, 0), -EXH_E_UNKNOWN);
    CHECK_EQ_I64(exh_params_validate(&p, UINT32_MAX, 0), -EXH_E_UNKNOWN);
    exh_params_setup(&p, &outputs, active, staged);
    CHECK_EQ_I64(exh_params_validate(&p, 0, 4), -EXH_E_STATE);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7401, 0, 5), -EXH_E_STATE);
    CHECK_EQ_I64(staged[0], 4);
}

/* The guard's sum multiplies each value of either array by a separate factor (NUMERICS.md). */
TEST(the_sum_is_of_both_arrays)
{
    uint32_t sum = 0;
    start(2);
    CHECK_EQ_I64(exh_params_stage(&p, 0x7201, 0, 900), 0);
    for (uint32_t i = 0; i < VALUES; i++) {
        sum += (4 * i + 1) * (uint32_t)active[i] + (4 * i + 3) * (uint32_t)staged[i];
    }
    CHECK_EQ_I64(p.sum, sum);
}

TEST_MAIN("unit/params", steps_worked_out, slewed_and_not, damaged_while_another_moves,
    before_the_loop_at_once, shift_of_a_time, image_in_mid_way, a_persons_values,
    keyframe_in_mid_way, keyframe_wherever_it_fits, bad_keyframes, guard_in_mid_way, taken_back,
    keyframe_at_rest, images_of_a_head, a_table_of_none, a_limit_falls_at_once, what_may_be_staged,
    the_sum_is_of_both_arrays);
