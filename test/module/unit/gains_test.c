/* SPDX-License-Identifier: MIT */
/* gains.h: the rule's pieces and ends, what set-up refuses, and that staging refuses by name. */
#include "exhand/gains.h"

#include "exhand/contact.h"
#include "exhand/error.h"
#include "exhand/precontact.h"

#include "check.h"

#define K(v) EXH_Q(v, 1, EXH_Q_K)
#define B(v) EXH_Q(v, 1, EXH_Q_B)

/* 0: 10000, 20: 30000, 40: 20000, 50: 0; from 500 up; at 2000 Hz. */
static const struct exh_gains_par rule = {
    2000 << 8, 4, K(500), {0, B(20), B(40), B(50)}, {K(10000), K(30000), K(20000), 0}};
static const struct exh_period T = {1, 2000};

TEST(pieces_and_ends)
{
    static const struct {
        int32_t k, b;
        int ok;
    } row[] = {
        {K(10000), 0, 1},
        {K(10000) + 1, 0, 0},
        {K(500), 0, 1},
        {K(500) - 1, 0, 0},
        {0, 0, 1},
        {0, 1, 0},
        {1, 0, 0},
        {K(20000), B(10), 1},
        {K(20000) + 1, B(10), 0},
        {K(30000), B(20), 1},
        {K(30000) + 1, B(20), 0},
        {K(25000), B(30), 1},
        {K(25000) + 1, B(30), 0},
        {K(20000), B(40), 1},
        {K(20000), B(40) + 1, 0},
        {K(10000), B(45), 1},
        {K(500), B(50), 0},
        {K(500), B(49), 1},
        {K(500), B(50) + 1, 0},
        {K(500), -1, 0},
        {INT32_MAX, B(20), 0},
        {INT32_MIN, B(20), 0},
        {INT32_MIN, INT32_MIN, 0},
        {INT32_MAX, INT32_MAX, 0},
        {K(500), INT32_MAX, 0},
        {K(500), INT32_MIN, 0},
        /* On the first piece k rises by 0.977 LSB an LSB of b. */
        {K(10000) + 1, 1, 0},
        {K(10000), 1, 1},
        {K(10000) + 1, 2, 1},
        {K(10000) + 2, 2, 0},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        CHECK(exh_gains_ok(&rule, row[i].k, row[i].b) == row[i].ok, "row %d", (int)i);
    }
}

TEST(setup_refuses)
{
    struct exh_gains_par bad[12];
    static const int want[] = {-EXH_E_RANGE, -EXH_E_RANGE, -EXH_E_RANGE, -EXH_E_RANGE, -EXH_E_RANGE,
        -EXH_E_RANGE, -EXH_E_RANGE, -EXH_E_RANGE, -EXH_E_MONOTONE, -EXH_E_MONOTONE, 0, 0};
    for (size_t i = 0; i < LEN(bad); i++) { bad[i] = rule; }
    bad[0].knots = 1;
    bad[1].knots = 9;
    bad[2].rate_Hz_q8 = 255;
    bad[3].k_min_Npm_q10 = -1;
    bad[4].b_Nspm_q20[0] = -1;
    bad[5].b_Nspm_q20[3] = B(1000) + 1;
    bad[6].k_Npm_q10[2] = -1;
    bad[7].k_Npm_q10[0] = K(1000000) + 1;
    bad[8].b_Nspm_q20[2] = B(20);
    bad[9].b_Nspm_q20[1] = 0;
    bad[10].k_Npm_q10[4] = -1; /* behind the last knot */
    bad[11].b_Nspm_q20[7] = -1;
    for (size_t i = 0; i < LEN(bad); i++) {
        CHECK(exh_gains_setup(&bad[i], T) == want[i], "row %d", (int)i);
    }
}

/* What is inside hangs together: below k_min at the ends, not between. */
TEST(setup_refuses_two_halves)
{
    struct exh_gains_par r = rule;
    r.k_Npm_q10[0] = 0;
    CHECK_EQ_I64(exh_gains_setup(&r, T), 0);
    r.k_Npm_q10[0] = K(500);
    r.k_Npm_q10[1] = K(500);
    CHECK_EQ_I64(exh_gains_setup(&r, T), 0);
    r.k_Npm_q10[1]--;
    CHECK_EQ_I64(exh_gains_setup(&r, T), -EXH_E_RANGE);
    r.k_Npm_q10[0]--;
    CHECK_EQ_I64(exh_gains_setup(&r, T), 0);
    r.k_Npm_q10[2] = K(499);
    CHECK_EQ_I64(exh_gains_setup(&r, T), 0); /* nothing but no wall is inside */
}

TEST(setup_asks_for_its_rate)
{
    static const struct {
        struct exh_period T;
        int err;
    } row[] = {
        {{1, 2000}, 0},
        {{100, 202000}, 0},
        {{100, 198000}, 0},
        {{597, 1193182}, 0},
        {{100, 202001}, -EXH_E_RATE},
        {{100, 197999}, -EXH_E_RATE},
        {{1, 1000}, -EXH_E_RATE},
        {{0, 2000}, -EXH_E_RATE},
        {{1, 0}, -EXH_E_RATE},
        {{UINT32_MAX, 1}, -EXH_E_RATE},
        {{1, UINT32_MAX}, -EXH_E_RATE},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        CHECK(exh_gains_setup(&rule, row[i].T) == row[i].err, "row %d", (int)i);
    }
}

/* --- staging --- */

static const struct exh_signal_group group[] = {
    {exh_gains_rows, EXH_GAINS_ROWS, 1}, {exh_contact_rows, EXH_CONTACT_ROWS, 2}};
static const struct exh_signal_table table = {group, 2};

struct values {
    struct exh_gains_par rule;
    struct exh_contact_par contact[2];
};
static struct values active, staged;
static struct exh_params params;

static void start(void)
{
    exh_params_setup(&params, &table, (int32_t *)&active, (int32_t *)&staged);
    active.rule = staged.rule = rule;
}

TEST(staging_refuses_what_is_outside)
{
    start();
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0401, 1, K(20000)), -EXH_E_GAINS);
    CHECK(staged.contact[1].k_Npm_q10 == K(1500) && !params.pending, "something was staged");
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0402, 1, B(20)), 0);
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0401, 1, K(20000)), 0);
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0402, 1, 0), -EXH_E_GAINS);
    CHECK(staged.contact[1].b_Nspm_q20 == B(20) && params.pending, "b went back");
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0401, 0, K(10000)), 0);
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0401, 0, K(10001)), -EXH_E_GAINS);
    /* All other answers stay the same. */
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0401, 0, -1), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0401, 2, K(500)), -EXH_E_UNKNOWN);
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0403, 1, B(1)), 0);
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x9999, 0, 0), -EXH_E_UNKNOWN);
    CHECK_EQ_I64(exh_params_apply(&params), 1);
    CHECK_EQ_I64(active.contact[1].k_Npm_q10, K(20000));
    /* A pair that is outside already, as of damaged memory: what is wrong with the value comes
     * first, and others go. */
    staged.contact[1].b_Nspm_q20 = 0;
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0401, 1, -1), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0401, 1, K(20000)), -EXH_E_GAINS);
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0403, 1, B(2)), 0);
}

/* A scene with materials has no separate contact to stage. */
TEST(materials_are_asked_by_index)
{
    static const struct exh_signal_group of[] = {{exh_material_rows, EXH_MATERIAL_ROWS, 2}};
    static const struct exh_signal_table materials = {of, 1};
    static const struct exh_authority person = {EXH_FROM_PERSON, 1, 1};
    struct exh_params p;
    int32_t is[2 * EXH_MATERIAL_ROWS], wanted[2 * EXH_MATERIAL_ROWS];
    exh_params_setup(&p, &materials, is, wanted);
    CHECK_EQ_I64(exh_gains_stage_by(&p, &rule, person, 1, B(20)), 0);
    CHECK_EQ_I64(exh_gains_stage_by(&p, &rule, person, 0, K(30000)), 0);
    CHECK_EQ_I64(exh_gains_stage_by(&p, &rule, person, 0, K(30001)), -EXH_E_GAINS);
    CHECK_EQ_I64(wanted[0], K(30000));
    CHECK_EQ_I64(exh_gains_stage_by(&p, &rule, person, 2 * EXH_MATERIAL_ROWS, 0), -EXH_E_UNKNOWN);
}

TEST(a_whole_image_is_asked_and_dropped)
{
    uint16_t instance = 7;
    start();
    CHECK_EQ_I64(exh_gains_validate(&params, &rule, &instance), 0);
    CHECK_EQ_I64(exh_params_stage(&params, 0x0401, 1, K(20000)), 0);
    CHECK_EQ_I64(exh_gains_validate(&params, &rule, &instance), -EXH_E_GAINS);
    CHECK_EQ_I64(exh_gains_validate(&params, &rule, NULL), -EXH_E_GAINS);
    CHECK_EQ_I64(instance, 1);
    exh_params_discard(&params);
    CHECK_EQ_I64(exh_params_apply(&params), 0);
    CHECK_EQ_I64(staged.contact[1].k_Npm_q10, K(1500));
    CHECK_EQ_I64(exh_gains_validate(&params, &rule, &instance), 0);
}

/* k goes with the rate, b where the loop is slower. */
TEST(a_rule_for_another_rate)
{
    static const struct {
        struct exh_period T;
        int32_t k, b, k_min;
    } row[] = {{{1, 2000}, K(30000), B(20), K(500)}, {{1, 500}, K(7500), B(5), K(125)},
        {{1, 4000}, K(60000), B(20), K(1000)}, {{1, 1}, K(15), B(20) / 2000, K(500) / 2000}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_gains_par r = rule;
        CHECK_EQ_I64(exh_gains_scale(&r, row[i].T), 0);
        CHECK(r.k_Npm_q10[1] == row[i].k && r.b_Nspm_q20[1] - row[i].b <= 1 &&
                  r.k_min_Npm_q10 == row[i].k_min,
            "row %d: %d %d %d", (int)i, (int)r.k_Npm_q10[1], (int)r.b_Nspm_q20[1],
            (int)r.k_min_Npm_q10);
        CHECK_EQ_I64(exh_gains_setup(&r, row[i].T), 0);
    }
    {
        struct exh_gains_par r = rule, stiff = rule;
        CHECK_EQ_I64(exh_gains_scale(&r, (struct exh_period){0, 1}), -EXH_E_RATE);
        stiff.k_Npm_q10[1] = K(900000);
        CHECK_EQ_I64(exh_gains_scale(&stiff, (struct exh_period){1, 4000}), 0);
        CHECK_EQ_I64(stiff.k_Npm_q10[1], EXH_K_MAX_NPM_Q10);
        r.knots = 9;
        CHECK_EQ_I64(exh_gains_scale(&r, T), -EXH_E_RANGE);
    }
}

TEST(the_largest_k)
{
    for (int32_t b = -B(1); b < B(52); b += B(1) / 7) {
        const int32_t k = exh_gains_k_max(&rule, b);
        CHECK(k == 0 || (exh_gains_ok(&rule, k, b) && !exh_gains_ok(&rule, k + 1, b)), "b %d: k %d",
            (int)b, (int)k);
        CHECK((k > 0) == exh_gains_ok(&rule, K(500), b), "b %d: k %d", (int)b, (int)k);
    }
    CHECK_EQ_I64(exh_gains_k_max(&rule, B(20)), K(30000));
}

/* From (10000, 0) over the valley to the same k at b = 40. k falls to the valley's, passes, and
 * rises again. It never alternates. A change that is dropped half way ends inside. */
TEST(through_a_valley)
{
    static const struct exh_gains_par valley = {
        2000 << 8, 3, K(500), {0, B(20), B(40)}, {K(10000), K(2000), K(10000)}};
    struct exh_contact_par *now = &active.contact[0];
    int32_t was = K(10000), low = was;
    start();
    exh_gains_enable(&params, 1);
    CHECK_EQ_I64(exh_params_stage(&params, 0x0401, 0, K(10000)), 0);
    CHECK_EQ_I64(exh_params_apply(&params), 1); /* not locked: immediately */
    CHECK_EQ_I64(now->k_Npm_q10, K(10000));
    params.locked = 1;
    params.shift = 3;
    CHECK_EQ_I64(exh_gains_stage(&params, &valley, 0x0402, 0, B(40)), 0);
    for (int n = 0; exh_params_apply(&params); n++) {
        const int beyond = now->b_Nspm_q20 >= B(20);
        exh_gains_step(&params, &valley);
        CHECK(exh_gains_ok(&valley, now->k_Npm_q10, now->b_Nspm_q20), "tick %d outside", n);
        CHECK(beyond ? now->k_Npm_q10 >= was : now->k_Npm_q10 <= was, "tick %d", n);
        was = now->k_Npm_q10;
        low = was < low ? was : low;
        if (n == 20) {
            exh_params_discard(&params);
            CHECK(exh_gains_ok(&valley, now->k_Npm_q10, now->b_Nspm_q20), "dropped outside");
            CHECK_EQ_I64(exh_params_stage(&params, 0x0401, 0, K(10000)), 0);
            CHECK_EQ_I64(exh_params_stage(&params, 0x0402, 0, B(40)), 0);
        }
        CHECK(n < 1000, "no end");
    }
    CHECK(low < K(2500) && was == K(10000) && now->b_Nspm_q20 == B(40), "low %d", (int)low);
}

/* One bit of the staged values flips. No value moves to it, and the guard reports it in one
 * round. */
TEST(a_damaged_goal_is_not_gone_to)
{
    const struct exh_contact_par *now = &active.contact[0];
    int told = 0;
    start();
    exh_gains_enable(&params, 1);
    params.locked = 1;
    params.shift = 3;
    (void)exh_params_apply(&params);
    exh_params_seal(&params);
    staged.contact[0].k_Npm_q10 ^= 1 << 23; /* 9692 N/m: inside, too */
    CHECK_EQ_I64(exh_gains_validate(&params, &rule, NULL), 0);
    for (uint32_t n = 0; n < params.count; n++) {
        (void)exh_params_apply(&params);
        exh_gains_step(&params, &rule);
        told |= exh_params_verify(&params);
        CHECK_EQ_I64(now->k_Npm_q10, K(1500));
    }
    CHECK(told, "never told");
}

/* The goal damaged while they are on their way: they stay, and are not let go of. */
TEST(a_goal_that_became_none_is_waited_for)
{
    int32_t at;
    start();
    exh_gains_enable(&params, 1);
    params.locked = 1;
    params.shift = 3;
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0401, 0, K(9000)), 0);
    (void)exh_params_apply(&params);
    exh_gains_step(&params, &rule);
    at = active.contact[0].k_Npm_q10;
    CHECK(at > K(1500) && at < K(9000), "k %" PRId32, at);
    staged.contact[0].k_Npm_q10 = K(900000);
    for (int n = 0; n < 3; n++) {
        (void)exh_params_apply(&params);
        exh_gains_step(&params, &rule);
        CHECK_EQ_I64(active.contact[0].k_Npm_q10, at);
    }
}

/* Nothing lies between no wall and the rule's least k. */
TEST(no_wall_is_a_jump_away)
{
    struct exh_contact_par *now = &active.contact[0];
    start();
    exh_gains_enable(&params, 1);
    params.locked = 1;
    params.shift = 3;
    CHECK_EQ_I64(exh_params_stage(&params, 0x0401, 0, 0), 0);
    while (exh_params_apply(&params)) {
        exh_gains_step(&params, &rule);
        CHECK(now->k_Npm_q10 == 0 || now->k_Npm_q10 >= K(500), "between");
    }
    CHECK_EQ_I64(now->k_Npm_q10, 0);
    CHECK_EQ_I64(exh_params_stage(&params, 0x0401, 0, K(8000)), 0);
    CHECK_EQ_I64(exh_params_stage(&params, 0x0402, 0, B(10)), 0);
    CHECK_EQ_I64(exh_params_apply(&params), 1);
    CHECK_EQ_I64(now->k_Npm_q10, 0); /* apply() does not move it */
    exh_gains_step(&params, &rule);
    CHECK(now->k_Npm_q10 == K(500) && now->b_Nspm_q20 == B(10), "k %d", (int)now->k_Npm_q10);
}

TEST(rows_are_of_the_struct)
{
    struct exh_signal_group g = {exh_gains_rows, EXH_GAINS_ROWS, 1};
    const struct exh_signal_table t = {&g, 1};
    struct exh_gains_par par;
    CHECK_EQ_I64(sizeof par, EXH_GAINS_ROWS * sizeof(int32_t));
    CHECK_EQ_I64(exh_signal_find(&t, 0x1210, 0), 3);
    CHECK_EQ_I64(exh_signal_find(&t, 0x1220, 0), 3 + EXH_GAINS_KNOTS);
    for (int i = 0; i < EXH_GAINS_ROWS; i++) {
        CHECK(exh_gains_rows[i].dflt >= exh_gains_rows[i].min, "row %d", i);
        for (int j = 0; j < i; j++) {
            CHECK(exh_gains_rows[i].id != exh_gains_rows[j].id, "%d %d", i, j);
        }
    }
}

/* Scenes with no contact, or half of one: nothing is asked of what is not there, and nothing moves.
 */
TEST(half_a_pair_is_none)
{
    for (unsigned k = 0; k < 2; k++) { /* k alone, b alone */
        const struct exh_signal_group half[] = {{&exh_contact_rows[k], 1, 1}};
        const struct exh_signal_table t = {half, 1};
        const int32_t v = k == 0 ? K(50000) : B(60);
        int32_t now[1], want[1];
        exh_params_setup(&params, &t, now, want);
        params.shift = 3;
        params.locked = 1;
        exh_gains_enable(&params, 1);
        CHECK_EQ_I64(exh_gains_stage(&params, &rule, exh_contact_rows[k].id, 0, v), 0);
        CHECK_EQ_I64(exh_gains_validate(&params, &rule, NULL), 0);
        (void)exh_params_apply(&params);
        exh_gains_step(&params, &rule);
        CHECK(now[0] == exh_contact_rows[k].dflt && want[0] == v, "half %u", k);
    }
}

TEST(without_the_lead_both_go_by_themselves)
{
    start();
    exh_gains_enable(&params, 1);
    CHECK(params.led[0] == 0x0401 && params.led[1] == 0x0402, "led");
    exh_gains_enable(&params, 0);
    CHECK(params.led[0] == 0 && params.led[1] == 0, "led still");
    params.locked = 1;
    params.shift = 3;
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0401, 0, K(2300)), 0);
    CHECK_EQ_I64(exh_params_apply(&params), 1);
    CHECK_EQ_I64(active.contact[0].k_Npm_q10, K(1600));
}

/* A pair in effect is outside, and no other was staged: the wall is removed. */
TEST(a_damaged_pair_becomes_none)
{
    start();
    exh_gains_enable(&params, 1);
    params.locked = 1;
    params.shift = 3;
    active.contact[0].k_Npm_q10 = 0;
    active.contact[0].b_Nspm_q20 = B(3);
    exh_gains_step(&params, &rule);
    CHECK(active.contact[0].k_Npm_q10 == 0 && active.contact[0].b_Nspm_q20 == 0, "b without k");
    CHECK(active.contact[1].k_Npm_q10 == K(1500), "the other one");
}

/* A table may have b before k, and either first of all. */
TEST(rows_may_stand_in_any_order)
{
    const struct exh_signal_group turned[] = {
        {&exh_contact_rows[1], 1, 1}, {&exh_contact_rows[0], 1, 1}};
    const struct exh_signal_table t = {turned, 2};
    int32_t now[2], want[2];
    exh_params_setup(&params, &t, now, want);
    exh_gains_enable(&params, 1);
    params.shift = 3;
    params.locked = 1;
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0401, 0, K(20000)), -EXH_E_GAINS);
    CHECK_EQ_I64(exh_gains_stage(&params, &rule, 0x0402, 0, B(20)), 0);
    for (int n = 0; exh_params_apply(&params) && n < 1000; n++) { exh_gains_step(&params, &rule); }
    CHECK(now[0] == B(20) && now[1] == K(1500), "b %d", (int)now[0]);
}

TEST_MAIN("gains", pieces_and_ends, setup_refuses, setup_refuses_two_halves,
    setup_asks_for_its_rate, staging_refuses_what_is_outside, materials_are_asked_by_index,
    a_whole_image_is_asked_and_dropped, a_rule_for_another_rate, the_largest_k, through_a_valley,
    a_damaged_goal_is_not_gone_to, a_goal_that_became_none_is_waited_for, no_wall_is_a_jump_away,
    rows_are_of_the_struct, half_a_pair_is_none, without_the_lead_both_go_by_themselves,
    a_damaged_pair_becomes_none, rows_may_stand_in_any_order);
