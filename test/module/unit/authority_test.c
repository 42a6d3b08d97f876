/* SPDX-License-Identifier: MIT */
/* authority: every source, class, state and direction, in the table and on every way to a
 * parameter. The ways are the person at the box, an image, a register over TCP and over the serial
 * line, and a packet. closed/sim/modbus_writes_test.c has the command line. */
#include "exhand/exhand.h"

#include "check.h"

#include <string.h>

#define VALUES EXH_WHENS

enum { BEFORE, CALM, OPEN, PHASES };

/* By hand, and not as the library has it: down, same, up; before the loop, in OFF and FAULT, in any
 * other state. */
static const char *const want[EXH_SOURCES][EXH_WHENS] = {
    {"000 000 000", "111 010 010", "111 111 111", "111 111 111", "111 111 111", "111 010 010",
        "111 111 111", "111 111 111", "111 111 111", "111 111 111", "111 111 111"},
    {"000 000 000", "111 010 010", "111 010 010", "111 010 010", "111 010 010", "000 000 000",
        "111 010 010", "111 010 010", "111 010 010", "111 010 010", "111 010 010"},
    {"010 010 010", "111 010 010", "111 111 111", "111 111 110", "111 111 110", "010 010 010",
        "111 111 110", "111 111 011", "111 111 010", "111 111 110", "010 010 010"},
    {"000 000 000", "000 000 000", "000 000 000", "000 000 000", "000 000 000", "000 000 000",
        "000 000 000", "000 000 000", "000 000 000", "111 111 110", "000 000 000"},
};

static int may(unsigned source, unsigned when, unsigned phase, int32_t by)
{
    return want[source][when][4 * phase + (unsigned)(by + 1)] == '1';
}

TEST(the_table)
{
    for (unsigned s = 0; s < EXH_SOURCES + 1; s++) {
        for (unsigned w = 0; w < EXH_WHENS + 1; w++) {
            for (unsigned k = 0; k < 3 * PHASES; k++) {
                const unsigned phase = k / 3;
                const int32_t by = (int32_t)(k % 3) - 1;
                const struct exh_authority who = {(uint8_t)s, phase != BEFORE, phase == OPEN};
                const int ok = s < EXH_SOURCES && w < EXH_WHENS && may(s, w, phase, by);
                CHECK(exh_authority_check(who, w, 5, 5 + by) == (ok ? 0 : -EXH_E_STATE),
                    "source %u, class %u, phase %u, %+d", s, w, phase, (int)by);
            }
        }
    }
}

/* --- every way --- */

static struct exh_signal row[VALUES];
static const struct exh_signal_group group = {row, VALUES, 1};
static const struct exh_signal_table table = {&group, 1};

static struct {
    struct exh_params p;
    struct exh_regs r;
    int32_t active[VALUES], wanted[VALUES], staged[VALUES];
    uint32_t touched[EXH_REGS_WORDS(VALUES)];
} g;

static void begin(unsigned state, int locked)
{
    memset(&g, 0, sizeof g);
    for (unsigned i = 0; i < VALUES; i++) {
        row[i] = (struct exh_signal){(uint16_t)(0x7401 + i), 0, (uint8_t)i, 0, 10, 5, "a", "", ""};
    }
    exh_params_setup(&g.p, &table, g.active, g.wanted);
    g.r.params = &table;
    g.r.active = g.active;
    g.r.wanted = g.wanted;
    g.r.staged = g.staged;
    g.r.touched = g.touched;
    g.r.may = EXH_REGS_MAY;
    CHECK_EQ_I64(exh_regs_setup(&g.r), 0);
    g.p.locked = g.r.locked = (uint8_t)locked;
    g.r.box.state = (uint8_t)state;
}

/* Function 16 of value i, as the slave of TCP answers it; 0 or the exception. */
static int by_register(unsigned i, int32_t raw)
{
    const uint8_t ask[] = {16, 0x50, (uint8_t)(2 * i), 0, 2, 4, 0, 0, 0, (uint8_t)raw};
    uint8_t answer[EXH_MODBUS_PDU_B];
    (void)exh_modbus_answer(&g.r, ask, sizeof ask, answer, sizeof answer);
    return answer[0] == 16 ? 0 : answer[1];
}

/* The same over a serial line. */
static int by_serial(unsigned i, int32_t raw)
{
    static struct exh_modbus_rtu line;
    uint8_t ask[13] = {1, 16, 0x50, (uint8_t)(2 * i), 0, 2, 4, 0, 0, 0, (uint8_t)raw};
    uint8_t answer[EXH_MODBUS_ADU_B];
    const uint16_t crc = exh_crc16(ask, 11);
    ask[11] = (uint8_t)(crc & 0xFFu);
    ask[12] = (uint8_t)(crc >> 8);
    CHECK_EQ_I64(exh_modbus_rtu_setup(&line, 1, 115200), 0);
    for (unsigned k = 0; k < sizeof ask; k++) { exh_modbus_rtu_receive(&line, ask[k]); }
    CHECK(exh_modbus_rtu_poll(&line, UINT32_MAX), "no frame");
    CHECK(exh_modbus_rtu_answer(&line, &g.r, answer, sizeof answer) > 0, "no answer");
    return answer[1] == 16 ? 0 : answer[2];
}

static int by_image(unsigned i, int32_t raw)
{
    uint8_t image[16 + 4 * VALUES];
    struct exh_bytes c = exh_bytes_writer(image, sizeof image);
    uint32_t crc;
    CHECK_EQ_I64(exh_params_save(&g.p, image, sizeof image), sizeof image);
    c.at = 12 + 4 * i;
    exh_bytes_i32(&c, &raw);
    crc = exh_crc32(0, image, sizeof image - 4);
    c.at = sizeof image - 4;
    exh_bytes_u32(&c, &crc);
    return exh_params_load(&g.p, image, sizeof image, NULL);
}

static int by_packet(unsigned i, int32_t raw)
{
    struct exh_wire_packet p = {.type = EXH_WIRE_PARAM};
    p.u.param = (struct exh_wire_param){row[i].id, 0, raw};
    return exh_wire_stage(&g.p, &p, !exh_safety_is_at_rest(g.r.box.state)).result;
}

/* Staged by a register, then applied: whether it came to be wanted. */
static void check_register(int err, unsigned i, int32_t raw, int ok)
{
    CHECK(err == (ok ? 0 : EXH_MODBUS_VALUE), "class %u: exception %d", i, err);
    CHECK(g.r.refused == (uint32_t)!ok, "class %u: %u counted", i, (unsigned)g.r.refused);
    CHECK_EQ_I64(exh_regs_apply(&g.r, &g.p), 0);
    CHECK_EQ_I64(g.wanted[i], ok ? raw : 5);
}

TEST(every_way_asks_the_table)
{
    for (unsigned state = 0; state <= EXH_STATES; state++) { /* one: before the loop */
        const int locked = state < EXH_STATES;
        const unsigned phase = !locked ? BEFORE : exh_safety_is_at_rest(state) ? CALM : OPEN;
        for (unsigned k = 0; k < 3 * (VALUES - 1); k++) {
            const unsigned i = 1 + k / 3; /* none is an output */
            const int32_t by = (int32_t)(k % 3) - 1, raw = 5 + by;
            begin(state % EXH_STATES, locked);
            check_register(by_register(i, raw), i, raw, may(EXH_FROM_REGISTER, i, phase, by));
            begin(state % EXH_STATES, locked);
            check_register(by_serial(i, raw), i, raw, may(EXH_FROM_REGISTER, i, phase, by));
            begin(state % EXH_STATES, locked);
            CHECK((by_packet(i, raw) == 0) == may(EXH_FROM_WORLD, i, phase, by), "class %u", i);
            CHECK_EQ_I64(g.wanted[i], may(EXH_FROM_WORLD, i, phase, by) ? raw : 5);
            begin(state % EXH_STATES, locked);
            CHECK((exh_params_stage_at(&g.p, i, raw) == 0) == may(EXH_FROM_PERSON, i, phase, by),
                "class %u", i);
        }
    }
}

/* The row of an output makes an image of this table one that may never be loaded: it is left out
 * here by being none. */
TEST(an_image_leaves_the_persons_values)
{
    for (unsigned k = 0; k < 2 * 3 * (VALUES - 1); k++) {
        const unsigned i = 1 + k / 6, phase = k & 1 ? OPEN : BEFORE;
        const int32_t by = (int32_t)(k / 2 % 3) - 1;
        const int persons = i == EXH_WHEN_PERSON;
        const int ok = persons || may(EXH_FROM_IMAGE, i, phase, by);
        begin(EXH_STATE_RUN, phase != BEFORE);
        row[0].when = EXH_WHEN_ANY;
        CHECK(by_image(i, 5 + by) == (ok ? 0 : -EXH_E_STATE), "class %u, phase %u, %+d", i, phase,
            (int)by);
        CHECK_EQ_I64(g.wanted[i], ok && !persons ? 5 + by : 5);
        CHECK_EQ_I64(g.p.by, ok ? 1u << EXH_FROM_IMAGE : 0);
    }
}

/* Between request and APPLY the box has come to run. */
TEST(what_was_staged_is_judged_again)
{
    begin(EXH_STATE_OFF, 1);
    CHECK_EQ_I64(by_register(EXH_WHEN_ANY, 6), 0);
    CHECK_EQ_I64(by_register(EXH_WHEN_LIMIT, 6), 0);
    g.r.box.state = EXH_STATE_ARM;
    CHECK_EQ_I64(exh_regs_apply(&g.r, &g.p), -EXH_E_STATE);
    CHECK_EQ_I64(g.wanted[EXH_WHEN_ANY], 5); /* all or none */
    CHECK_EQ_I64(g.wanted[EXH_WHEN_LIMIT], 5);
    CHECK_EQ_I64(g.p.pending, 0);
    CHECK_EQ_I64(g.r.refused, 1);
}

/* A server that only reads: nothing is staged, nothing commanded, each try is counted. */
TEST(without_apply_nothing_is_written)
{
    static const uint8_t coil[] = {5, 0, EXH_COIL_APPLY, 0xFF, 0};
    uint8_t answer[EXH_MODBUS_PDU_B];
    begin(EXH_STATE_OFF, 1);
    g.r.may = 0;
    CHECK_EQ_I64(by_register(EXH_WHEN_ANY, 4), EXH_MODBUS_VALUE);
    CHECK_EQ_I64(by_register(EXH_WHEN_ANY, 5), EXH_MODBUS_VALUE); /* even the present value */
    CHECK_EQ_I64(exh_modbus_answer(&g.r, coil, sizeof coil, answer, sizeof answer), 2);
    CHECK_EQ_I64(answer[1], EXH_MODBUS_VALUE);
    CHECK_EQ_I64(g.r.refused, 3);
    CHECK_EQ_I64(g.touched[0], 0);
}

/* A log says who it was. */
TEST(who_staged_is_kept_until_it_is_applied)
{
    begin(EXH_STATE_OFF, 1);
    CHECK_EQ_I64(by_packet(EXH_WHEN_MATERIAL, 4), 0);
    CHECK_EQ_I64(by_register(EXH_WHEN_ANY, 6), 0);
    CHECK_EQ_I64(exh_regs_apply(&g.r, &g.p), 0);
    CHECK_EQ_I64(g.p.by, 1u << EXH_FROM_WORLD | 1u << EXH_FROM_REGISTER);
    CHECK_EQ_I64(exh_params_apply(&g.p), 1);
    CHECK_EQ_I64(g.p.by, 0);
    CHECK_EQ_I64(exh_params_stage_at(&g.p, EXH_WHEN_ANY, 7), 0);
    CHECK_EQ_I64(g.p.by, 1u << EXH_FROM_PERSON);
}

TEST_MAIN("authority", the_table, every_way_asks_the_table, an_image_leaves_the_persons_values,
    what_was_staged_is_judged_again, without_apply_nothing_is_written,
    who_staged_is_kept_until_it_is_applied);
