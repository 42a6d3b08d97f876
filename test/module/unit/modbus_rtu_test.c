/* SPDX-License-Identifier: MIT */
/* modbus_rtu.h: a serial line, byte by byte and silence by silence. */
#include "exhand/modbus_rtu.h"
#include "exhand/regs.h"

#include "exhand/error.h"

#include "check.h"

static const struct exh_signal row[1] = {
    {0x7101, 0, EXH_WHEN_ANY, INT32_MIN, INT32_MAX, 0, "a", "", ""}};
static const struct exh_signal_group group[1] = {{row, 1, 8}};
static const struct exh_signal_table table = {group, 1};

struct rig {
    struct exh_modbus_rtu u;
    struct exh_regs r;
    int32_t value[8], staged[8];
    uint32_t touched[1];
    uint8_t resp[EXH_MODBUS_ADU_B];
};
static struct rig g;

static void begin(uint32_t address, uint32_t baud)
{
    memset(&g, 0, sizeof g);
    g.r.params = &table;
    g.r.active = g.value;
    g.r.wanted = g.value;
    g.r.staged = g.staged;
    g.r.touched = g.touched;
    g.r.may = EXH_REGS_MAY;
    CHECK_EQ_I64(exh_regs_setup(&g.r), 0);
    CHECK_EQ_I64(exh_modbus_rtu_setup(&g.u, address, baud), 0);
}

/* A frame with its CRC, and the silence after it: 1 if it was for us. */
static int hear(const uint8_t *frame, size_t len_B)
{
    const uint16_t crc = exh_crc16(frame, len_B);
    for (size_t i = 0; i < len_B; i++) { exh_modbus_rtu_receive(&g.u, frame[i]); }
    exh_modbus_rtu_receive(&g.u, (uint8_t)(crc & 0xFFu));
    exh_modbus_rtu_receive(&g.u, (uint8_t)(crc >> 8));
    return exh_modbus_rtu_poll(&g.u, g.u.silence_us);
}

TEST(crc_is_the_known_one)
{
    static const uint8_t digits[] = "123456789", read[] = {1, 3, 0, 0, 0, 10}, spec[] = {2, 7};
    CHECK_EQ_I64(exh_crc16(digits, 9), 0x4B37);
    CHECK_EQ_I64(exh_crc16(read, 6), 0xCDC5);
    CHECK_EQ_I64(exh_crc16(spec, 2), 0x1241); /* the serial line's specification */
    CHECK_EQ_I64(exh_crc16(spec, 0), 0xFFFF);
}

TEST(silence_by_baud)
{
    static const struct {
        uint32_t baud, us;
    } want[] = {{300, 128334}, {9600, 4011}, {9625, 4000}, {7521, 5120}, {19200, 2006},
        {19201, 1750}, {115200, 1750}};
    for (size_t i = 0; i < sizeof want / sizeof want[0]; i++) {
        begin(1, want[i].baud);
        CHECK_EQ_I64(g.u.silence_us, want[i].us);
    }
    CHECK_EQ_I64(exh_modbus_rtu_setup(&g.u, 0, 9600), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_modbus_rtu_setup(&g.u, 248, 9600), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_modbus_rtu_setup(&g.u, 247, 299), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_modbus_rtu_setup(&g.u, 247, 10000001), -EXH_E_RANGE);
}

TEST(a_request_is_answered_once)
{
    static const uint8_t req[] = {17, 3, 0x50, 0, 0, 2};
    begin(17, 9600);
    g.value[0] = 0x01020304;
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, sizeof g.resp), 0);
    CHECK_EQ_I64(hear(req, sizeof req), 1);
    exh_modbus_rtu_receive(&g.u, 0x55); /* while it waits: lost */
    CHECK_EQ_I64(exh_modbus_rtu_poll(&g.u, 1), 1);
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, EXH_MODBUS_ADU_B - 1), -EXH_E_SHORT);
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, sizeof g.resp), 9);
    CHECK(g.resp[0] == 17 && g.resp[1] == 3 && g.resp[2] == 4 && g.resp[3] == 1 && g.resp[6] == 4,
        "answer");
    CHECK_EQ_I64(exh_crc16(g.resp, 9), 0); /* a frame with its CRC has CRC 0 */
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, sizeof g.resp), 0);
    CHECK_EQ_I64(exh_modbus_rtu_poll(&g.u, 1000000), 0);
    CHECK_EQ_I64(g.u.taken, 1);
    CHECK_EQ_I64(g.u.damaged + g.u.others, 0);
}

TEST(an_exception_is_an_answer)
{
    static const uint8_t req[] = {1, 3, 0, 0, 0, 2};
    begin(1, 9600);
    CHECK_EQ_I64(hear(req, sizeof req), 1);
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, sizeof g.resp), 5);
    CHECK(g.resp[1] == 0x83 && g.resp[2] == 2, "%u %u", g.resp[1], g.resp[2]);
    CHECK_EQ_I64(exh_crc16(g.resp, 5), 0);
}

TEST(what_is_said_to_all_is_done_and_not_answered)
{
    static const uint8_t write[] = {0, 6, 0x50, 1, 0, 7}, read[] = {0, 3, 0x50, 0, 0, 2},
                         both[] = {0, 23, 0x50, 0, 0, 2, 0x50, 1, 0, 1, 2, 0, 9};
    begin(5, 9600);
    CHECK_EQ_I64(hear(write, sizeof write), 1);
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, sizeof g.resp), 0);
    CHECK_EQ_I64(g.staged[0], 7);
    CHECK_EQ_I64(hear(read, sizeof read), 1);
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, sizeof g.resp), 0);
    CHECK_EQ_I64(hear(both, sizeof both), 1);
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, sizeof g.resp), 0);
    CHECK_EQ_I64(g.staged[0], 7);
}

TEST(somebody_elses_is_left_alone)
{
    static const uint8_t req[] = {2, 6, 0x50, 1, 0, 7};
    begin(1, 9600);
    CHECK_EQ_I64(hear(req, sizeof req), 0);
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, sizeof g.resp), 0);
    CHECK_EQ_I64(g.u.others, 1);
    CHECK_EQ_I64(g.u.damaged, 0);
    CHECK_EQ_I64(g.touched[0], 0);
}

TEST(every_damaged_bit_is_dropped)
{
    static const uint8_t req[] = {1, 6, 0x50, 1, 0, 7, 0, 0};
    uint8_t frame[8];
    uint32_t damaged = 0;
    begin(1, 115200);
    memcpy(frame, req, sizeof frame);
    frame[6] = (uint8_t)(exh_crc16(req, 6) & 0xFFu);
    frame[7] = (uint8_t)(exh_crc16(req, 6) >> 8);
    for (unsigned bit = 0; bit < 64; bit++) {
        for (unsigned i = 0; i < 8; i++) {
            exh_modbus_rtu_receive(
                &g.u, (uint8_t)(frame[i] ^ (bit >> 3 == i ? 1u << (bit & 7u) : 0u)));
        }
        CHECK(exh_modbus_rtu_poll(&g.u, 1750) == 0, "bit %u", bit);
        CHECK_EQ_I64(g.u.damaged, ++damaged);
    }
    for (unsigned len_B = 1; len_B < 8; len_B++) { /* cut off anywhere */
        for (unsigned i = 0; i < len_B; i++) { exh_modbus_rtu_receive(&g.u, frame[i]); }
        CHECK(exh_modbus_rtu_poll(&g.u, 1750) == 0, "of %u bytes", len_B);
        CHECK_EQ_I64(g.u.damaged, ++damaged);
    }
    CHECK_EQ_I64(g.touched[0], 0);
    for (unsigned i = 0; i < 8; i++) { exh_modbus_rtu_receive(&g.u, frame[i]); }
    CHECK_EQ_I64(exh_modbus_rtu_poll(&g.u, 1750), 1); /* and the next is whole */
}

/* A frame of n bytes whose CRC is right, be it as long as it may or longer. */
static int hear_long(unsigned n)
{
    static uint8_t frame[400];
    memset(frame, 0, sizeof frame);
    frame[0] = 1;
    frame[1] = 99;
    return hear(frame, n - 2);
}

TEST(frames_have_an_end)
{
    begin(1, 115200);
    CHECK_EQ_I64(hear_long(EXH_MODBUS_ADU_B), 1);
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, sizeof g.resp), 5);
    CHECK_EQ_I64(hear_long(EXH_MODBUS_ADU_B + 1), 0);
    CHECK_EQ_I64(hear_long(400), 0);
    CHECK_EQ_I64(g.u.damaged, 2);
    CHECK_EQ_I64(hear_long(4), 1);
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, sizeof g.resp), 5);
    CHECK_EQ_I64(hear_long(3), 0); /* no function */
    CHECK_EQ_I64(g.u.damaged, 3);
}

TEST(silence_is_added_up_and_a_byte_ends_it)
{
    static const uint8_t req[] = {1, 3, 0x50, 0, 0, 2};
    const uint16_t crc = exh_crc16(req, 6);
    begin(1, 115200);
    for (size_t i = 0; i < 6; i++) {
        exh_modbus_rtu_receive(&g.u, req[i]);
        CHECK_EQ_I64(exh_modbus_rtu_poll(&g.u, 1749), 0);
    }
    exh_modbus_rtu_receive(&g.u, (uint8_t)(crc & 0xFFu));
    exh_modbus_rtu_receive(&g.u, (uint8_t)(crc >> 8));
    CHECK_EQ_I64(exh_modbus_rtu_poll(&g.u, 1000), 0);
    CHECK_EQ_I64(exh_modbus_rtu_poll(&g.u, 749), 0);
    CHECK_EQ_I64(exh_modbus_rtu_poll(&g.u, 1), 1);
    begin(1, 115200);
    CHECK_EQ_I64(exh_modbus_rtu_poll(&g.u, UINT32_MAX), 0); /* a long silence does not wrap */
    CHECK_EQ_I64(exh_modbus_rtu_poll(&g.u, UINT32_MAX), 0);
    CHECK_EQ_I64(g.u.quiet_us, UINT32_MAX);
    CHECK_EQ_I64(g.u.damaged, 0);
}

TEST(a_byte_that_came_damaged_drops_its_frame)
{
    static const uint8_t req[] = {1, 3, 0x50, 0, 0, 2};
    begin(1, 115200);
    exh_modbus_rtu_discard(&g.u);
    CHECK_EQ_I64(hear(req, sizeof req), 0);
    CHECK_EQ_I64(g.u.damaged, 1);
    CHECK_EQ_I64(hear(req, sizeof req), 1);
}

/* A request behind 2^16 bytes without a silence is the end of one that is too long. */
TEST(a_frame_of_65536_bytes_is_none)
{
    static const uint8_t req[] = {17, 3, 0x50, 0, 0, 2};
    begin(17, 9600);
    for (uint32_t n = 0; n < 65536; n++) { exh_modbus_rtu_receive(&g.u, 17); }
    CHECK_EQ_I64(hear(req, sizeof req), 0);
    CHECK(g.u.damaged == 1 && g.u.taken == 0, "taken %" PRIu32, g.u.taken);
    CHECK_EQ_I64(hear(req, sizeof req), 1);
}

TEST(short_silences_are_added_up)
{
    begin(17, 9600);
    exh_modbus_rtu_receive(&g.u, 17);
    for (uint32_t n = 1; n <= 4; n++) {
        CHECK_EQ_I64(exh_modbus_rtu_poll(&g.u, 1000), 0);
        CHECK(g.u.quiet_us == 1000 * n && g.u.len_B == 1, "%" PRIu32 " ms", n);
    }
    CHECK_EQ_I64(exh_modbus_rtu_poll(&g.u, 11), 0);
    CHECK(g.u.len_B == 0 && g.u.damaged == 1, "4.011 ms are the end");
}

TEST(however_much_room_is_told)
{
    static const uint8_t req[] = {17, 3, 0x50, 0, 0, 2};
    begin(17, 9600);
    CHECK_EQ_I64(hear(req, sizeof req), 1);
    CHECK_EQ_I64(exh_modbus_rtu_answer(&g.u, &g.r, g.resp, SIZE_MAX), 9);
}

TEST_MAIN("modbus_rtu", crc_is_the_known_one, silence_by_baud, a_request_is_answered_once,
    an_exception_is_an_answer, what_is_said_to_all_is_done_and_not_answered,
    somebody_elses_is_left_alone, every_damaged_bit_is_dropped, frames_have_an_end,
    silence_is_added_up_and_a_byte_ends_it, a_byte_that_came_damaged_drops_its_frame,
    a_frame_of_65536_bytes_is_none, short_silences_are_added_up, however_much_room_is_told);
