/* SPDX-License-Identifier: MIT */
/* quad.h: all transitions of the two lines, and the counter across its wraps. */
#include "exhand/quad.h"

#include "exhand/error.h"
#include "exhand/units.h"

#include "check.h"

#define ILL 99

/* Place of A<<1|B in the upward sequence 00 01 11 10. */
static const int place[4] = {0, 1, 3, 2};

static const struct {
    const struct exh_quad_mode *mode;
    int x;
} modes[] = {{&exh_quad_x1, 1}, {&exh_quad_x2, 2}, {&exh_quad_x4, 4}};

/* Counts by the header's rule. In x4 each step of the sequence counts. In x2 it counts when A
 * changes, in x1 when A changes at B = 1. */
static int counts(int x, unsigned from, unsigned to)
{
    const int moved = (place[to] - place[from] + 4) % 4;
    const int sign = moved == 3 ? -1 : moved;
    const int a_edge = ((from ^ to) & 2) != 0;
    if (moved == 2) { return ILL; }
    if (x == 4) { return sign; }
    return a_edge && (x == 2 || (to & 1)) ? sign : 0;
}

TEST(all_transitions_in_all_modes)
{
    for (size_t i = 0; i < LEN(modes) * 16; i++) {
        const struct exh_quad_mode *m = modes[i / 16].mode;
        const unsigned from = i / 4 % 4, to = i % 4;
        const int want = counts(modes[i / 16].x, from, to);
        struct exh_quad_ab s = {0};
        exh_quad_ab_step(&s, m, from);
        CHECK(s.cnt == 0 && s.edges == 0 && s.illegal == 0, "first sample %u counted", from);
        exh_quad_ab_step(&s, m, to | 0xFC);
        CHECK(s.cnt == (want == ILL ? 0 : want), "x%d %u to %u: %" PRId32, modes[i / 16].x, from,
            to, s.cnt);
        CHECK(s.illegal == (want == ILL), "x%d %u to %u", modes[i / 16].x, from, to);
        CHECK(s.edges == (want != ILL && from != to), "x%d %u to %u", modes[i / 16].x, from, to);
    }
}

TEST(a_turn_and_back)
{
    static const unsigned up[4] = {0, 1, 3, 2};
    for (size_t i = 0; i < LEN(modes); i++) {
        struct exh_quad_ab s = {0};
        for (int k = 0; k <= 4000; k++) { exh_quad_ab_step(&s, modes[i].mode, up[k % 4]); }
        CHECK_EQ_I64(s.cnt, 1000 * modes[i].x);
        CHECK_EQ_I64(s.edges, 4000);
        for (int k = 3999; k >= -4000; k--) {
            exh_quad_ab_step(&s, modes[i].mode, up[(k + 4000) % 4]);
        }
        CHECK_EQ_I64(s.cnt, -1000 * modes[i].x);
        CHECK_EQ_I64(s.illegal, 0);
    }
}

/* Chatter on one line moves no count away: x1 ignores B wholly. */
TEST(chatter_does_not_drift)
{
    for (size_t i = 0; i < LEN(modes); i++) {
        for (unsigned line = 1; line <= 2; line++) {
            for (unsigned from = 0; from < 4; from++) {
                struct exh_quad_ab s = {0};
                for (unsigned k = 0; k < 101; k++) {
                    exh_quad_ab_step(&s, modes[i].mode, k & 1 ? from ^ line : from);
                }
                CHECK(s.cnt == 0, "x%d line %u: %" PRId32, modes[i].x, line, s.cnt);
            }
        }
    }
}

TEST(count_wraps_without_a_jump)
{
    static const uint8_t there[1] = {1}, back[1] = {0};
    struct exh_quad_ab s = {INT32_MAX, UINT32_MAX, UINT32_MAX, 0, 1};
    exh_quad_ab_step(&s, &exh_quad_x4, 1);
    CHECK(s.cnt == INT32_MIN && s.edges == 0, "step up");
    exh_quad_ab_step(&s, &exh_quad_x4, 0);
    CHECK_EQ_I64(s.cnt, INT32_MAX);
    exh_quad_ab_run(&s, &exh_quad_x4, there, 1);
    CHECK_EQ_I64(s.cnt, INT32_MIN);
    exh_quad_ab_run(&s, &exh_quad_x4, back, 1);
    CHECK_EQ_I64(s.cnt, INT32_MAX);
    exh_quad_ab_word(&s, 0, UINT64_MAX);
    CHECK_EQ_I64(s.cnt, INT32_MIN);
    exh_quad_ab_word(&s, UINT64_MAX, 0);
    CHECK(s.cnt == INT32_MIN && s.illegal == 0, "illegal");
}

/* A run is as long as it likes: all its steps up, down, or illegal. */
TEST(runs_of_one_kind)
{
    static const uint8_t up[4] = {0, 1, 3, 2}, down[4] = {0, 2, 3, 1}, both[4] = {1, 2, 1, 2};
    static const size_t len[] = {1, 2, 254, 255, 256, 257, 510, 511, 512, 5000};
    static uint8_t ab[5000];
    for (size_t i = 0; i < LEN(len) * 3; i++) {
        const uint8_t *from = i % 3 == 0 ? up : i % 3 == 1 ? down : both;
        const int64_t steps = (int64_t)len[i / 3] - 1;
        struct exh_quad_ab s = {0};
        for (size_t k = 0; k < len[i / 3]; k++) { ab[k] = (uint8_t)(from[k % 4] | k << 2); }
        exh_quad_ab_run(&s, &exh_quad_x4, ab, len[i / 3]);
        CHECK_EQ_I64(s.cnt, i % 3 == 0 ? steps : i % 3 == 1 ? -steps : 0);
        CHECK_EQ_I64(s.edges, i % 3 == 2 ? 0 : steps);
        CHECK_EQ_I64(s.illegal, i % 3 == 2 ? steps : 0);
    }
}

TEST(a_run_of_nothing_starts_nothing)
{
    static const uint8_t two[1] = {2};
    struct exh_quad_ab s = {0};
    exh_quad_ab_run(&s, &exh_quad_x4, two, 0);
    CHECK(!s.started, "started");
    exh_quad_ab_run(&s, &exh_quad_x4, two, 1);
    CHECK(s.started && s.ab == 2 && s.edges == 0 && s.illegal == 0, "the first sample counted");
}

/* Both lines change in the first sample of a word, against the last sample of the word before. */
TEST(words_hang_together)
{
    struct exh_quad_ab s = {0};
    exh_quad_ab_word(&s, UINT64_MAX, 0); /* 10 all through: the first sample counts nothing */
    CHECK(s.cnt == 0 && s.edges == 0 && s.illegal == 0 && s.ab == 2, "a steady word");
    exh_quad_ab_word(&s, UINT64_MAX, UINT64_MAX - 1); /* 10, then 11: down */
    CHECK(s.cnt == -1 && s.edges == 1 && s.ab == 3, "%" PRId32, s.cnt);
    exh_quad_ab_word(&s, 0, 0);
    CHECK(s.cnt == -1 && s.illegal == 1 && s.edges == 1, "%" PRIu32 " illegal", s.illegal);
    /* 64 edges up: 01 11 10 00 */
    exh_quad_ab_word(&s, UINT64_C(0x6666666666666666), UINT64_C(0x3333333333333333));
    CHECK(s.cnt == 63 && s.edges == 65, "%" PRId32, s.cnt);
    /* and down: 10 11 01 00 */
    exh_quad_ab_word(&s, UINT64_C(0x3333333333333333), UINT64_C(0x6666666666666666));
    CHECK(s.cnt == -1 && s.edges == 129 && s.illegal == 1, "%" PRId32, s.cnt);
}

TEST(index_latches_the_count)
{
    struct exh_quad_index s = {0};
    exh_quad_index_step(&s, 7, 1);
    CHECK_EQ_I64(s.seen, 0); /* a level at the first sample is no edge */
    exh_quad_index_step(&s, 8, 0);
    exh_quad_index_step(&s, 9, 3);
    CHECK(s.seen == 1 && s.cnt == 9, "rising: %" PRId32, s.cnt);
    exh_quad_index_step(&s, 10, 1);
    CHECK(s.seen == 1 && s.cnt == 9, "still high: no new edge");
    exh_quad_index_step(&s, 11, 2); /* bit 0 is the line */
    CHECK(s.seen == 1 && s.cnt == 9, "falling");
    exh_quad_index_step(&s, -12, 1);
    CHECK(s.seen == 2 && s.cnt == -12, "again: %" PRId32, s.cnt);
}

/* --- extension --- */

/* A counter alone: no movement is too fast. */
static struct exh_quad_cfg counter(int32_t bits)
{
    const struct exh_quad_cfg cfg = {NULL, INT32_MAX, (uint8_t)(32 - bits)};
    return cfg;
}

TEST(first_value_is_count_zero)
{
    static const int32_t bits[] = {16, 24, 32};
    for (size_t i = 0; i < LEN(bits); i++) {
        const struct exh_quad_cfg cfg = counter(bits[i]);
        for (size_t k = 0; k < CHECK_CORNERS; k++) {
            struct exh_quad s = {0};
            CHECK_EQ_I64(exh_quad_step(&s, &cfg, (uint32_t)check_corner[k]), 0);
            CHECK_EQ_I64(exh_quad_step(&s, &cfg, (uint32_t)check_corner[k]), 0);
        }
    }
}

/* Largest moves either way from places next to both ends of the counter. */
TEST(wraps_at_both_ends)
{
    static const int32_t bits[] = {16, 24, 32};
    for (size_t i = 0; i < LEN(bits); i++) {
        const struct exh_quad_cfg cfg = counter(bits[i]);
        const uint32_t top = UINT32_MAX >> (32 - bits[i]);
        const int64_t half = (int64_t)(top / 2) + 1;
        const int64_t move[] = {1, -1, 2, -2, half - 1, -(half - 1), 1000, -1000};
        const uint32_t start[] = {0, 1, top, top - 1, top / 2, top / 2 + 1};
        for (size_t k = 0; k < LEN(move) * LEN(start); k++) {
            const int64_t m = move[k / LEN(start)];
            const uint32_t from = start[k % LEN(start)];
            struct exh_quad s = {0};
            (void)exh_quad_step(&s, &cfg, from);
            CHECK_EQ_I64(exh_quad_step(&s, &cfg, ((uint32_t)(from + m)) & top), m);
            CHECK_EQ_I64(exh_quad_step(&s, &cfg, from), 0);
        }
    }
}

/* A board may hand over more bits than the counter has. */
TEST(bits_above_the_counter_are_ignored)
{
    static const int32_t bits[] = {16, 24};
    for (size_t i = 0; i < LEN(bits); i++) {
        const struct exh_quad_cfg cfg = counter(bits[i]);
        const uint32_t junk = UINT32_MAX << bits[i];
        struct exh_quad s = {0};
        (void)exh_quad_step(&s, &cfg, 5 | junk);
        CHECK_EQ_I64(exh_quad_step(&s, &cfg, 9), 4);
        CHECK_EQ_I64(exh_quad_step(&s, &cfg, 7 | junk), 2);
    }
}

/* Long walks, many wraps, against the position kept in 64 bits. */
TEST(long_walks)
{
    static const int32_t bits[] = {16, 24, 32};
    for (size_t i = 0; i < LEN(bits); i++) {
        const struct exh_quad_cfg cfg = counter(bits[i]);
        const int32_t half = (int32_t)((UINT32_MAX >> (32 - bits[i])) / 2);
        const uint32_t mask = UINT32_MAX >> (32 - bits[i]);
        struct exh_quad s = {0};
        uint64_t pos = 12345; /* unsigned: the reference wraps by definition */
        (void)exh_quad_step(&s, &cfg, (uint32_t)pos & mask);
        for (int k = 0; k < 20000; k++) {
            const uint64_t moved = pos += (uint64_t)(int64_t)check_i32_in(-half, half);
            const uint32_t want = (uint32_t)(moved - 12345);
            const int32_t got = exh_quad_step(&s, &cfg, (uint32_t)pos & mask);
            CHECK((uint32_t)got == want, "bits %" PRId32 " step %d", bits[i], k);
        }
    }
}

TEST(position_by_hand)
{
    static const struct {
        int32_t step_m_q42, cnt, want;
    } row[] = {
        {4096, 7, 7}, {4096, -7, -7}, {2048, 1, 1}, {2048, -1, 0}, /* halves go up */
        {1, 2047, 0}, {1, 2048, 1}, {INT32_MAX, 1, 524288}, {INT32_MAX, INT32_MAX, INT32_MAX},
        {INT32_MAX, INT32_MIN, INT32_MIN}, {4096, INT32_MIN, INT32_MIN},
        {4097, INT32_MIN, INT32_MIN}, {4097, INT32_MAX, INT32_MAX},
        {43980465, 100000, 1073741821}, /* 10 um a count, 1 m */
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_quad_par par = {row[i].step_m_q42, INT32_MAX};
        CHECK_EQ_I64(exh_quad_pos_m_q30(&par, row[i].cnt), row[i].want);
    }
}

/* 2 pi radius / (4 pulses) 2^42, worked out to 20 digits and truncated. */
TEST(step_of_an_encoder)
{
    static const int32_t step[] = {EXH_QUAD_STEP(1000, 8000), EXH_QUAD_STEP(1024, 5000),
        EXH_QUAD_STEP(100, 31000), EXH_QUAD_STEP(1, 1), EXH_QUAD_STEP(10000, 29000),
        EXH_QUAD_STEP(4 * 100000, 400000)};
    static const int32_t want[] = {55267482, 33732594, 2141614944, 6908435, 20034462, 6908435};
    for (size_t i = 0; i < LEN(step); i++) { CHECK_EQ_I64(step[i], want[i]); }
}

TEST(state_round_trip)
{
    struct exh_quad s = {0xDEADBEEFu, -123456789, 1, 1};
    struct exh_quad back = {0};
    uint8_t buf[16];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_quad_serialize(&c, &s);
    CHECK_EQ_I64(c.at, 10);
    c = exh_bytes_reader(buf, c.at);
    exh_quad_serialize(&c, &back);
    CHECK(exh_bytes_ok(&c), "reader");
    CHECK(
        back.raw == s.raw && back.cnt == s.cnt && back.started == s.started && back.lost == s.lost,
        "state differs");
}

TEST(lines_round_trip)
{
    struct exh_quad_ab s = {-5, 6, 7, 3, 1}, back = {0};
    uint8_t buf[32];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_quad_ab_serialize(&c, &s);
    CHECK_EQ_I64(c.at, 14);
    c = exh_bytes_reader(buf, c.at);
    exh_quad_ab_serialize(&c, &back);
    CHECK(exh_bytes_ok(&c) && back.cnt == -5 && back.edges == 6 && back.illegal == 7 &&
              back.ab == 3 && back.started == 1,
        "state differs");
    memset(buf, 0xFF, sizeof buf); /* damaged: the lines are an index into a table */
    c = exh_bytes_reader(buf, sizeof buf);
    exh_quad_ab_serialize(&c, &back);
    CHECK_EQ_I64(back.ab, 3);
    exh_quad_ab_step(&back, &exh_quad_x4, 1);
    CHECK_EQ_I64(back.ab, 1);
}

TEST(index_round_trip)
{
    struct exh_quad_index s = {-8, 9, 1, 1}, back = {0};
    uint8_t buf[16];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_quad_index_serialize(&c, &s);
    CHECK_EQ_I64(c.at, 10);
    c = exh_bytes_reader(buf, c.at);
    exh_quad_index_serialize(&c, &back);
    CHECK(exh_bytes_ok(&c) && back.cnt == -8 && back.seen == 9 && back.level == 1 &&
              back.started == 1,
        "state differs");
    memset(buf, 0xFE, sizeof buf);
    c = exh_bytes_reader(buf, sizeof buf);
    exh_quad_index_serialize(&c, &back);
    CHECK_EQ_I64(back.level, 0);
}

/* --- set-up: what no hand can do --- */

/* 66.32 um a count, 10 m/s: 1 kHz 150.8 counts a tick, 2 kHz 75.4, 1 Hz 150784. */
TEST(a_jump_is_told_at_every_rate)
{
    static const struct {
        struct exh_period T;
        int32_t jump;
    } row[] = {
        {{1, 1000}, 152}, {{1, 2000}, 76}, {{1, 20000}, 9}, {{1, 1}, 150785}, {{597, 1193182}, 76}};
    const struct exh_quad_par par = {EXH_Q(6632, 100000000, EXH_Q_STEP), EXH_Q(10, 1, EXH_Q_VEL)};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_quad_cfg cfg;
        CHECK_EQ_I64(exh_quad_setup(&cfg, &par, row[i].T, 24), 0);
        CHECK(cfg.jump_cnt == row[i].jump, "row %zu: %" PRId32, i, cfg.jump_cnt);
        for (int sign = -1; sign <= 1; sign += 2) {
            struct exh_quad s = {0};
            uint32_t raw = 0xFFFFF0; /* next to the wrap */
            const int32_t far = sign * cfg.jump_cnt;
            (void)exh_quad_step(&s, &cfg, raw);
            CHECK(!s.lost, "the first sample");
            raw += (uint32_t)far;
            CHECK_EQ_I64(exh_quad_step(&s, &cfg, raw), far);
            CHECK(!s.lost, "row %zu: as fast as allowed", i);
            raw += (uint32_t)(far + sign);
            CHECK_EQ_I64(exh_quad_step(&s, &cfg, raw), far);
            CHECK(s.lost, "row %zu: faster", i);
            raw += (uint32_t)sign;
            CHECK_EQ_I64(exh_quad_step(&s, &cfg, raw), far + sign);
            CHECK(s.lost, "row %zu: where it is now nobody knows", i);
        }
    }
}

TEST(setup_rejections)
{
    static const struct {
        int32_t step, speed;
        unsigned bits;
        struct exh_period T;
        const char *what;
    } row[] = {
        {69049330, INT32_MAX, 15, {1, 1000}, "a counter of 15 bits"},
        {69049330, INT32_MAX, 33, {1, 1000}, "a counter of 33 bits"},
        {0, INT32_MAX, 24, {1, 1000}, "no step"},
        {-1, INT32_MAX, 24, {1, 1000}, "a negative step"},
        {69049330, 0, 24, {1, 1000}, "no speed"},
        {4398045, INT32_MAX, 24, {1, 1000}, "a step below 1 um"},
        {69049330, 13421771, 24, {1, 1000}, "a speed below 0.1 m/s"},
        {69049330, INT32_MAX, 16, {1, 10}, "a quarter of 16 bits in a tick"},
        {69049330, INT32_MIN, 24, {1, 1000}, "a negative speed"},
        {69049330, INT32_MAX, 16, {1, 1}, "16 bits a second: direction can't be told"},
    };
    struct exh_quad_cfg cfg;
    const struct exh_quad_par good = {69049330, INT32_MAX};
    CHECK_EQ_I64(exh_quad_setup(&cfg, &good, (struct exh_period){1, 1000}, 16), 0);
    CHECK_EQ_I64(exh_quad_setup(&cfg, &good, (struct exh_period){1, 1}, 24), 0);
    CHECK_EQ_I64(exh_quad_setup(&cfg, &good, (struct exh_period){1, 0}, 24), -EXH_E_RATE);
    CHECK_EQ_I64(exh_quad_setup(&cfg, &good, (struct exh_period){0, 1}, 24), -EXH_E_RATE);
    CHECK_EQ_I64(exh_quad_setup(&cfg, &good, (struct exh_period){1, 40000}, 24), -EXH_E_RATE);
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_quad_par par = {row[i].step, row[i].speed};
        CHECK(exh_quad_setup(&cfg, &par, row[i].T, row[i].bits) == -EXH_E_RANGE, "%s", row[i].what);
    }
}

TEST_MAIN("unit/quad", all_transitions_in_all_modes, a_turn_and_back, chatter_does_not_drift,
    count_wraps_without_a_jump, runs_of_one_kind, a_run_of_nothing_starts_nothing,
    words_hang_together, index_latches_the_count, first_value_is_count_zero, wraps_at_both_ends,
    bits_above_the_counter_are_ignored, long_walks, position_by_hand, step_of_an_encoder,
    state_round_trip, lines_round_trip, index_round_trip, a_jump_is_told_at_every_rate,
    setup_rejections);
