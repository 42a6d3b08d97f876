/* SPDX-License-Identifier: MIT */
/* regs.h and modbus.h: the slave, request by request. The examples of the Modbus specification
 * (V1.1b3, chapter 6) with its addresses replaced by ours, each exception, and each edge of a
 * count. */
#include "exhand/modbus.h"
#include "exhand/regs.h"

#include "exhand/error.h"
#include "exhand/exhand.h"

#include "check.h"

#define VALUES  100 /* parameters: enough for the longest request */
#define SIGNALS 70

static const struct exh_signal par_row[4] = {
    {0x7101, 10, EXH_WHEN_ANY, -1024000, 1024000, 1024, "k", "n_per_m", "may change at any time"},
    {0x7102, 0, EXH_WHEN_SETUP, 0, 1000, 500, "window", "", "before the loop"},
    {0x7103, 20, EXH_WHEN_ANY, INT32_MIN, INT32_MAX, 0, "wide", "n", "any raw value"},
    {0x7104, 30, EXH_WHEN_ANY, 5 - INT32_MAX, INT32_MAX - 5, 0, "long", "m",
        "ends between two binary32"},
};
static const struct exh_signal out_row[7] = {
    {0x7201, 30, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "q", "m", ""},
    {0x7202, 27, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "qd", "m_per_s", ""},
    {0x7203, 20, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "f", "n", ""},
    {0x7204, 26, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "i", "a", ""},
    {0x7205, 0, EXH_WHEN_OUTPUT, 0, 1, 0, "c", "", ""},
    {0x7206, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "limits", "", ""},
    {0x7207, 0, EXH_WHEN_OUTPUT, 0, 5, 0, "state", "", ""},
};
static const struct exh_signal_group par_group[] = {{par_row, 4, 5}, {par_row, 4, 20}};
static const struct exh_signal_group out_group[] = {{out_row, 7, 10}};
static const struct exh_signal_table par_table = {par_group, 2}, out_table = {out_group, 1};

struct rig {
    struct exh_params p;
    struct exh_regs r;
    int32_t active[VALUES], wanted[VALUES], staged[VALUES], signal[SIGNALS];
    uint32_t touched[EXH_REGS_WORDS(VALUES)];
    uint8_t resp[EXH_MODBUS_PDU_B + 8]; /* with a fence */
    int len;
};

static struct rig g;

static void begin(void)
{
    memset(&g, 0, sizeof g);
    exh_params_setup(&g.p, &par_table, g.active, g.wanted);
    g.r.name = "unit_test";
    g.r.signals = &out_table;
    g.r.params = &par_table;
    g.r.signal = g.signal;
    g.r.active = g.active;
    g.r.wanted = g.wanted;
    g.r.staged = g.staged;
    g.r.touched = g.touched;
    g.r.T.num = 1;
    g.r.T.den = 2000;
    g.r.may = EXH_REGS_MAY;
    g.r.fingers = 5;
    for (int32_t i = 0; i < SIGNALS; i++) { g.signal[i] = 0x01020304 * (i + 1); }
    CHECK_EQ_I64(exh_regs_setup(&g.r), 0);
}

static void ask(const uint8_t *req, size_t len_B)
{
    memset(g.resp, 0xA5, sizeof g.resp);
    g.len = exh_modbus_answer(&g.r, req, len_B, g.resp, EXH_MODBUS_PDU_B);
    CHECK(g.len >= 0 && g.len <= EXH_MODBUS_PDU_B, "answer of %d bytes", g.len);
    for (size_t i = EXH_MODBUS_PDU_B; i < sizeof g.resp; i++) {
        CHECK(g.resp[i] == 0xA5, "fence at %u", (unsigned)i);
    }
}
#define ASK(...) \
    do { \
        static const uint8_t req[] = {__VA_ARGS__}; \
        ask(req, sizeof req); \
    } while (0)

static void gives(const uint8_t *want, int len, int line)
{
    CHECK(
        g.len == len, "line %d: %d bytes, want %d; the second is %u", line, g.len, len, g.resp[1]);
    for (int i = 0; i < len && i < g.len; i++) {
        CHECK(g.resp[i] == want[i], "line %d: byte %d is %02x, want %02x", line, i,
            (unsigned)g.resp[i], (unsigned)want[i]);
    }
}
#define GIVES(...) \
    do { \
        static const uint8_t want[] = {__VA_ARGS__}; \
        gives(want, (int)sizeof want, __LINE__); \
    } while (0)

TEST(head_says_what_this_is)
{
    begin();
    ASK(4, 0, 0, 0, 8);
    GIVES(4, 16, 0x45, 0x58, 0x48, 0x31, 0, 1, 0, 1, 0x12, 0x34, 0x56, 0x78, 0x3F, 0x80, 0, 0);
    ASK(4, 0, 2 * EXH_HEAD_SIGNALS, 0, 4);
    GIVES(4, 8, 0, 0, 0, SIGNALS, 0, 0, 0, VALUES);
    ASK(4, 0, 2 * EXH_HEAD_PERIOD_NUM, 0, 8);
    GIVES(4, 16, 0, 0, 0, 1, 0, 0, 0x07, 0xD0, 0, EXH_VERSION_MAJOR, EXH_VERSION_MINOR,
        EXH_VERSION_PATCH, 0, 0, 0, 5);
    ASK(4, 0, 2 * EXH_HEAD_NAME_0, 0, 8);
    GIVES(4, 16, 'u', 'n', 'i', 't', '_', 't', 'e', 's', 't', 0, 0, 0, 0, 0, 0, 0);
    ASK(4, 0, 2 * EXH_HEADS - 1, 0, 2);
    GIVES(0x84, 2);
}

TEST(a_value_is_high_word_first_and_starts_anywhere)
{
    begin();
    g.signal[2] = 5 * (1 << 20) + (1 << 19); /* f, 5.5 N */
    g.active[4] = 0x7F0000 + 3;
    ASK(4, 0x10, 0x04, 0, 2);
    GIVES(4, 4, 0x00, 0x58, 0x00, 0x00);
    ASK(4, 0x30, 0x04, 0, 2);
    GIVES(4, 4, 0x40, 0xB0, 0x00, 0x00);
    ASK(4, 0x30, 0x05, 0, 1);
    GIVES(4, 2, 0x00, 0x00);
    ASK(4, 0x10, 0x03, 0, 2); /* a half of each of two */
    GIVES(4, 4, 0x06, 0x08, 0x00, 0x58);
    ASK(4, 0x50, 0x09, 0, 1);
    GIVES(4, 2, 0x00, 0x03);
}

/* --- the specification's examples --- */

TEST(reads_as_in_the_examples)
{
    begin();
    g.r.box.faults = 0x35DBAC;
    ASK(2, 0, 0, 0, 22);
    GIVES(2, 3, 0xAC, 0xDB, 0x35);
    g.r.asked = 0x21;
    ASK(1, 0, 0, 0, 6);
    GIVES(1, 1, 0x21);
    ASK(1, 0, 5, 0, 1);
    GIVES(1, 1, 0x01);
    g.wanted[2] = 0x022B0000;
    g.wanted[3] = 0x0064FFFF;
    ASK(3, 0x50, 0x04, 0, 3);
    GIVES(3, 6, 0x02, 0x2B, 0x00, 0x00, 0x00, 0x64);
    g.signal[4] = 0x000A0000;
    ASK(4, 0x10, 0x08, 0, 1);
    GIVES(4, 2, 0x00, 0x0A);
}

TEST(writes_as_in_the_examples)
{
    begin();
    ASK(6, 0x50, 0x03, 0, 3);
    GIVES(6, 0x50, 0x03, 0, 3);
    CHECK_EQ_I64(g.staged[1], 3);
    ASK(16, 0x50, 0x04, 0, 2, 4, 0x00, 0x0A, 0x01, 0x02);
    GIVES(16, 0x50, 0x04, 0, 2);
    CHECK_EQ_I64(g.staged[2], 0x000A0102);
    CHECK_EQ_I64(g.touched[0], 6);
    CHECK_EQ_I64(g.wanted[2], 0);
    ASK(5, 0, 0, 0xFF, 0);
    GIVES(5, 0, 0, 0xFF, 0);
    CHECK_EQ_I64(g.r.asked, 1u << EXH_COIL_APPLY);
    ASK(15, 0, 0, 0, 6, 1, 0x09);
    GIVES(15, 0, 0, 0, 6);
    CHECK_EQ_I64(g.r.asked, 9);
}

TEST(mask_and_both_as_in_the_examples)
{
    begin();
    g.wanted[2] = 0x12;
    ASK(22, 0x50, 0x05, 0x00, 0xF2, 0x00, 0x25);
    GIVES(22, 0x50, 0x05, 0x00, 0xF2, 0x00, 0x25);
    CHECK_EQ_I64(g.staged[2], 0x17);
    g.wanted[6] = 0x00FE0ACD;
    g.wanted[7] = 0x00010003;
    g.wanted[8] = 0x000D0000;
    ASK(23, 0x50, 0x0C, 0, 6, 0x50, 0x11, 0, 1, 2, 0x00, 0xFF);
    GIVES(23, 12, 0x00, 0xFE, 0x0A, 0xCD, 0x00, 0x01, 0x00, 0x03, 0x00, 0x0D, 0x00, 0xFF);
    CHECK_EQ_I64(g.staged[8], 0x000D00FF);
}

TEST(says_who_it_is)
{
    begin();
    ASK(43, 14, 1, 0);
    GIVES(43, 14, 1, 0x81, 0, 0, 3, 0, 6, 'e', 'x', 'h', 'a', 'n', 'd', 1, 6, 'e', 'x', 'h', 'a',
        'n', 'd', 2, 5, '0' + EXH_VERSION_MAJOR, '.', '0' + EXH_VERSION_MINOR, '.',
        '0' + EXH_VERSION_PATCH);
    ASK(43, 14, 4, 2);
    GIVES(43, 14, 4, 0x81, 0, 0, 1, 2, 5, '0' + EXH_VERSION_MAJOR, '.', '0' + EXH_VERSION_MINOR,
        '.', '0' + EXH_VERSION_PATCH);
    for (int i = g.len; i < EXH_MODBUS_PDU_B; i++) {
        CHECK(g.resp[i] == 0xA5, "behind the answer, at %d", i);
    }
    ASK(43, 14, 3, 2);
    CHECK_EQ_I64(g.len, 14);
    ASK(43, 14, 1, 77); /* unknown: from the first on */
    CHECK_EQ_I64(g.resp[6], 3);
    ASK(43, 14, 4, 3);
    GIVES(0xAB, 2);
    ASK(43, 14, 5, 0);
    GIVES(0xAB, 3);
    ASK(43, 13, 1, 0);
    GIVES(0xAB, 1);
    ASK(43);
    GIVES(0xAB, 1);
    ASK(43, 14, 1);
    GIVES(0xAB, 3);
}

/* --- exceptions, one by one --- */

/* Nothing staged, nothing commanded. */
static void untouched(int line)
{
    for (uint32_t w = 0; w < EXH_REGS_WORDS(VALUES); w++) {
        CHECK(g.touched[w] == 0, "line %d: word %" PRIu32 " touched", line, w);
    }
    CHECK(g.r.asked == 0, "line %d: asked %" PRIx32, line, g.r.asked);
}
#define REFUSES(exception, ...) \
    do { \
        static const uint8_t refused[] = {__VA_ARGS__}; \
        static const uint8_t answer[2] = { \
            (uint8_t)(0x80u | refused_first(__VA_ARGS__, 0)), exception}; \
        ask(refused, sizeof refused); \
        gives(answer, 2, __LINE__); \
        untouched(__LINE__); \
    } while (0)
#define refused_first(a, ...) (a)

TEST(no_such_function)
{
    begin();
    for (unsigned fc = 0; fc < 256; fc++) {
        static const uint8_t ours[] = {1, 2, 3, 4, 5, 6, 15, 16, 22, 23, 43};
        uint8_t req[5] = {0};
        int known = 0;
        for (size_t i = 0; i < sizeof ours; i++) { known |= ours[i] == fc; }
        if (known) { continue; }
        req[0] = (uint8_t)fc;
        for (size_t len_B = 1; len_B <= sizeof req; len_B++) {
            ask(req, len_B);
            CHECK(g.len == 2 && g.resp[0] == (fc | 0x80u) && g.resp[1] == 1,
                "function %u: %d bytes, %u %u", fc, g.len, g.resp[0], g.resp[1]);
        }
    }
}

TEST(counts_end_where_the_specification_says)
{
    static const struct {
        uint8_t fc;
        uint16_t most;
    } read[] = {{1, 2000}, {2, 2000}, {3, 125}, {4, 125}};
    begin();
    for (size_t i = 0; i < sizeof read / sizeof read[0]; i++) {
        for (unsigned k = 0; k < 4;
             k++) { /* from 0x5000: nothing there for bits: 2 comes after 3 */
            const uint16_t n = k == 0 ? 0 : (uint16_t)(read[i].most + k - 2u);
            const uint8_t req[5] = {read[i].fc, 0x50, 0, (uint8_t)(n >> 8), (uint8_t)(n & 0xFFu)};
            const int bad = n == 0 || n > read[i].most;
            ask(req, 5);
            if (bad) {
                CHECK(g.len == 2 && g.resp[1] == 3, "function %u of %u: %u", req[0], n, g.resp[1]);
            } else if (req[0] < 3) {
                CHECK(g.len == 2 && g.resp[1] == 2, "function %u of %u: %u", req[0], n, g.resp[1]);
            } else {
                CHECK(g.len == 2 + 2 * n && g.resp[1] == 2 * n, "function %u of %u: %d", req[0], n,
                    g.len);
            }
        }
    }
}

/* A request of function 15, 16 or 23 for n, of which it says it has count bytes, and has len. */
static size_t long_request(uint8_t *req, uint8_t fc, unsigned n, unsigned count, unsigned len)
{
    const uint8_t head[10] = {
        fc, 0x50, 0, 0, 1, 0x50, 0, (uint8_t)(n >> 8), (uint8_t)(n & 0xFFu), (uint8_t)count};
    const unsigned at = fc == 23 ? 10 : 6;
    for (unsigned i = 0; i < 300; i++) { req[i] = 0; }
    for (unsigned i = 0; i < 10; i++) { req[i] = head[i]; }
    if (fc != 23) { /* one address and count less */
        req[3] = head[7];
        req[4] = head[8];
        req[5] = head[9];
        for (unsigned i = 6; i < 10; i++) { req[i] = 0; }
    }
    return at + len;
}

TEST(counts_of_writes_end_there_too)
{
    static const struct {
        uint8_t fc;
        unsigned most;
    } w[] = {{15, 1968}, {16, 123}, {23, 121}};
    uint8_t req[300];
    for (size_t i = 0; i < sizeof w / sizeof w[0]; i++) {
        for (unsigned n = 0; n <= w[i].most + 2; n++) {
            const unsigned bytes = w[i].fc == 15 ? (n + 7) / 8 : 2 * n;
            const int good = n >= 1 && n <= w[i].most;
            for (int off = -1; off <= 1; off++) {
                const unsigned count = bytes + (unsigned)off;
                begin(); /* zeros are in range of all rows */
                ask(req, long_request(req, w[i].fc, n, count, bytes));
                if (good && off == 0 && w[i].fc != 15) {
                    CHECK(g.resp[0] == w[i].fc, "function %u of %u: exception %u", w[i].fc, n,
                        g.resp[1]);
                } else {
                    CHECK(g.len == 2 && g.resp[1] == (good && off == 0 ? 2 : 3),
                        "function %u of %u, %u bytes: %u", w[i].fc, n, count, g.resp[1]);
                    untouched(__LINE__);
                }
            }
        }
    }
}

TEST(a_request_of_another_length_is_refused)
{
    static const uint8_t good[][16] = {{5, 1, 0, 0, 0, 6}, {5, 2, 0, 0, 0, 192},
        {5, 3, 0x50, 0, 0, 2}, {5, 4, 0, 0, 0, 8}, {5, 5, 0, 3, 0, 0}, {5, 6, 0x50, 5, 0, 7},
        {7, 15, 0, 0, 0, 3, 1, 0}, {8, 16, 0x50, 5, 0, 1, 2, 0, 7}, {7, 22, 0x50, 5, 0, 0, 0, 7},
        {12, 23, 0x50, 0, 0, 2, 0x50, 5, 0, 1, 2, 0, 7}, {4, 43, 14, 1, 0}};
    uint8_t req[300];
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        for (unsigned len_B = 0; len_B <= 260; len_B++) {
            begin();
            for (unsigned k = 0; k < sizeof req; k++) { req[k] = k < 15 ? good[i][k + 1] : 0; }
            ask(req, len_B);
            if (len_B == 0) {
                CHECK_EQ_I64(g.len, 0);
            } else if (len_B == good[i][0]) {
                CHECK(g.resp[0] == req[0], "function %u: exception %u", req[0], g.resp[1]);
            } else {
                CHECK(g.len == 2 && g.resp[0] == (req[0] | 0x80u) &&
                          g.resp[1] == (req[0] == 43 && len_B < 2 ? 1 : 3),
                    "function %u of %u bytes: %u %u", req[0], len_B, g.resp[0], g.resp[1]);
                untouched(__LINE__);
            }
        }
    }
}

TEST(an_answer_needs_room)
{
    static const uint8_t req[5] = {5, 0, 3, 0xFF, 0};
    begin();
    CHECK_EQ_I64(exh_modbus_answer(&g.r, req, 5, g.resp, EXH_MODBUS_PDU_B - 1), -EXH_E_SHORT);
    CHECK_EQ_I64(g.resp[0], 0);
    untouched(__LINE__);
}

TEST(nothing_is_there)
{
    begin();
    REFUSES(2, 1, 0, 0, 0, 7);
    REFUSES(2, 1, 0, 6, 0, 1);
    REFUSES(2, 2, 0, 0, 0, 193);
    REFUSES(2, 2, 0, 192, 0, 1);
    REFUSES(2, 2, 0xFF, 0xFF, 0, 2);
    REFUSES(2, 4, 0, 0x3E, 0, 1);    /* behind the head */
    REFUSES(2, 4, 0x04, 0x00, 0, 1); /* kept for traces */
    REFUSES(2, 4, 0x0F, 0xFF, 0, 2); /* into the outputs */
    REFUSES(2, 4, 0x10, 0x8C, 0, 1); /* behind the outputs */
    REFUSES(2, 4, 0x10, 0x8B, 0, 2);
    REFUSES(2, 4, 0x2F, 0xFF, 0, 2);
    REFUSES(2, 4, 0x50, 0xC8, 0, 1);
    REFUSES(2, 4, 0x70, 0xC7, 0, 2);
    REFUSES(2, 4, 0x90, 0x00, 0, 1);
    REFUSES(2, 4, 0xFF, 0xFF, 0, 1);
    REFUSES(2, 4, 0xFF, 0xFF, 0, 2); /* and not round to 0 */
    REFUSES(2, 3, 0, 0, 0, 1);
    REFUSES(2, 3, 0x10, 0, 0, 1);
    REFUSES(2, 3, 0x30, 0, 0, 1);
    REFUSES(2, 3, 0x50, 0xC7, 0, 2);
    REFUSES(2, 5, 0, 6, 0xFF, 0);
    REFUSES(2, 6, 0x50, 0xC8, 0, 0);
    REFUSES(2, 6, 0x10, 0, 0, 0);
    REFUSES(2, 6, 0xFF, 0xFF, 0, 0);
    REFUSES(2, 15, 0, 3, 0, 4, 1, 0x0F);
    REFUSES(2, 15, 0xFF, 0xFF, 0, 2, 1, 3);
    REFUSES(2, 16, 0x50, 0xC7, 0, 2, 4, 0, 0, 0, 0);
    REFUSES(2, 22, 0x50, 0xC8, 0, 0, 0, 0);
    REFUSES(2, 23, 0x10, 0, 0, 2, 0x50, 4, 0, 1, 2, 0, 9); /* what is read decides, too */
    REFUSES(2, 23, 0x50, 0, 0, 2, 0x50, 0xC8, 0, 1, 2, 0, 9);
}

TEST(what_may_not_be)
{
    begin();
    REFUSES(3, 5, 0, 0, 0x12, 0x34);
    REFUSES(3, 5, 0, 0, 0, 1);
    REFUSES(3, 5, 0, 4, 0xFF, 0);                       /* RUN, which is not allowed */
    REFUSES(3, 5, 0, 5, 0xFF, 0);                       /* CLEAR */
    REFUSES(3, 5, 0, 2, 0xFF, 0);                       /* SAVE, with no place */
    REFUSES(3, 15, 0, 0, 0, 6, 1, 0x18);                /* OFF and RUN: all or none */
    REFUSES(3, 15, 0, 0, 0, 2, 1, 3);                   /* APPLY what is discarded */
    REFUSES(3, 16, 0x50, 2, 0, 2, 4, 0, 0, 0x03, 0xE9); /* 1001 of 0..1000 */
    REFUSES(3, 6, 0x50, 2, 0x80, 0);                    /* its high half makes it negative */
    REFUSES(3, 16, 0x50, 0, 0, 4, 8, 0, 0, 0, 1, 0, 0, 0x03, 0xE9); /* the second of two */
    REFUSES(3, 23, 0x50, 0, 0, 2, 0x50, 2, 0, 2, 4, 0, 0, 0x03, 0xE9);
    REFUSES(3, 22, 0x50, 2, 0x7F, 0xFF, 0x80, 0);
    g.r.locked = 1;
    REFUSES(3, 16, 0x50, 2, 0, 2, 4, 0, 0, 0x01, 0xF5); /* 501 for 500, before the loop only */
    ASK(16, 0x50, 2, 0, 2, 4, 0, 0, 0x01, 0xF4);        /* as it is */
    GIVES(16, 0x50, 2, 0, 2);
    untouched(__LINE__);
    CHECK(g.r.refused > 8, "%u refused", (unsigned)g.r.refused);
    g.r.refused = 0x1234;
    ASK(4, 0, 2 * EXH_HEAD_REFUSED, 0, 2);
    GIVES(4, 4, 0, 0, 0x12, 0x34);
}

TEST(floats_that_may_not_be)
{
    begin();
    REFUSES(3, 6, 0x70, 4, 0x40, 0); /* halves */
    REFUSES(3, 6, 0x70, 5, 0, 0);
    REFUSES(3, 22, 0x70, 5, 0, 0, 0, 0);
    REFUSES(3, 16, 0x70, 4, 0, 3, 6, 0x40, 0, 0, 0, 0x40, 0);
    REFUSES(3, 16, 0x70, 4, 0, 2, 4, 0x7F, 0x80, 0, 0); /* infinite */
    REFUSES(3, 16, 0x70, 4, 0, 2, 4, 0xFF, 0x80, 0, 0);
    REFUSES(3, 16, 0x70, 4, 0, 2, 4, 0x7F, 0xC0, 0, 0); /* no number */
    REFUSES(3, 16, 0x70, 4, 0, 2, 4, 0x7F, 0x80, 0, 1);
    REFUSES(3, 16, 0x70, 4, 0, 2, 4, 0x45, 0x00, 0, 1); /* beyond 2048 */
    REFUSES(3, 16, 0x70, 4, 0, 2, 4, 0xC5, 0x00, 0, 1);
    REFUSES(3, 16, 0x70, 4, 0, 2, 4, 0x7F, 0x7F, 0xFF, 0xFF);
    REFUSES(3, 16, 0x70, 0, 0, 2, 4, 0x44, 0x7A, 0x08, 0); /* 1000.125 of 1000 */
    ASK(16, 0x70, 0, 0, 2, 4, 0x44, 0x7A, 0, 0);
    GIVES(16, 0x70, 0, 0, 2);
    CHECK_EQ_I64(g.staged[0], 1024000);
    ASK(16, 0x70, 6, 0, 2, 4, 0x40, 0, 0, 0); /* reads as its max: 2 m for 2 m less 6 LSB */
    GIVES(16, 0x70, 6, 0, 2);
    CHECK_EQ_I64(g.staged[3], INT32_MAX - 5);
}

TEST(what_reads_the_same_stays)
{
    begin();
    g.wanted[3] = 0x12345677; /* binary32 has no room for its last bits */
    ASK(3, 0x70, 6, 0, 2);
    GIVES(3, 4, 0x3E, 0x91, 0xA2, 0xB4);
    ASK(16, 0x70, 6, 0, 2, 4, 0x3E, 0x91, 0xA2, 0xB4);
    untouched(__LINE__);
    ASK(16, 0x70, 6, 0, 2, 4, 0x3E, 0x91, 0xA2, 0xB5);
    CHECK_EQ_I64(g.staged[3], 0x123456A0);
    ASK(16, 0x70, 6, 0, 2, 4, 0xC0, 0x00, 0x00,
        0x00); /* an end reads as -2 m, a little beyond it */
    CHECK_EQ_I64(g.staged[3], 5 - INT32_MAX);
    ASK(16, 0x70, 6, 0, 2, 4, 0x40, 0x00, 0x00, 0x00);
    CHECK_EQ_I64(g.staged[3], INT32_MAX - 5);
}

/* --- staging and commands --- */

TEST(apply_hands_over_all_or_none)
{
    begin();
    ASK(16, 0x50, 0, 0, 4, 8, 0, 0, 0, 7, 0, 0, 0, 8);
    CHECK_EQ_I64(g.active[0], 1024);
    CHECK_EQ_I64(g.wanted[0], 1024);
    g.p.locked = 1; /* meanwhile the loop has begun: the second is refused, and with it the first */
    CHECK_EQ_I64(exh_regs_apply(&g.r, &g.p), -EXH_E_STATE);
    CHECK_EQ_I64(g.wanted[0], 1024);
    CHECK_EQ_I64(g.p.pending, 0);
    untouched(__LINE__);
    g.p.locked = 0;
    ASK(16, 0x50, 0, 0, 4, 8, 0, 0, 0, 7, 0, 0, 0, 8);
    CHECK_EQ_I64(exh_regs_apply(&g.r, &g.p), 0);
    CHECK_EQ_I64(g.wanted[0], 7);
    CHECK_EQ_I64(g.active[0], 1024);
    untouched(__LINE__);
    CHECK_EQ_I64(exh_params_apply(&g.p), 1);
    CHECK_EQ_I64(g.active[0], 7);
    CHECK_EQ_I64(g.active[1], 8);
}

TEST(what_is_staged_reads_back_and_is_counted)
{
    begin();
    ASK(16, 0x50, 4, 0, 2, 4, 0, 0, 0x11, 0x22);
    ASK(3, 0x50, 4, 0, 2);
    GIVES(3, 4, 0, 0, 0x11, 0x22);
    ASK(4, 0x50, 4, 0, 2); /* in effect still */
    GIVES(4, 4, 0, 0, 0, 0);
    ASK(4, 0, 2 * EXH_HEAD_STAGED, 0, 2);
    GIVES(4, 4, 0, 0, 0, 1);
    ASK(6, 0x50, 5, 0, 0); /* as it is wanted: no longer staged */
    untouched(__LINE__);
    ASK(16, 0x50, 4, 0, 2, 4, 0, 0, 0x11, 0x22);
    ASK(5, 0, 1, 0xFF, 0);
    untouched(__LINE__);
    ASK(4, 0, 2 * EXH_HEAD_DONE, 0, 4);
    GIVES(4, 8, 0, 0, 0, 1, 0, 0, 0, 0);
    g.wanted[2] = 5; /* from another source: read while nothing is staged */
    ASK(3, 0x50, 4, 0, 2);
    GIVES(3, 4, 0, 0, 0, 5);
    ASK(16, 0x50, 4, 0, 2, 4, 0, 0, 0x11, 0x22);
    g.wanted[2] = 0x1122; /* another source stages the same value */
    ASK(4, 0, 2 * EXH_HEAD_STAGED, 0, 2);
    GIVES(4, 4, 0, 0, 0, 0);
}

TEST(while_apply_is_pending_nothing_changes)
{
    begin();
    ASK(6, 0x50, 5, 0, 7);
    ASK(5, 0, 0, 0xFF, 0);
    ASK(6, 0x50, 5, 0, 8);
    GIVES(0x86, 6);
    ASK(16, 0x50, 4, 0, 2, 4, 0, 0, 0, 8);
    GIVES(0x90, 6);
    ASK(23, 0x50, 4, 0, 2, 0x50, 4, 0, 2, 4, 0, 0, 0, 8);
    GIVES(0x97, 6);
    ASK(5, 0, 1, 0xFF, 0);
    GIVES(0x85, 6);
    ASK(5, 0, 3, 0xFF, 0); /* OFF always */
    GIVES(5, 0, 3, 0xFF, 0);
    ASK(3, 0x50, 5, 0, 1);
    GIVES(3, 2, 0, 7);
    CHECK_EQ_I64(exh_regs_poll(&g.r), 1u << EXH_COIL_APPLY | 1u << EXH_COIL_OFF);
    CHECK_EQ_I64(exh_regs_poll(&g.r), 0);
    ASK(6, 0x50, 5, 0, 8);
    GIVES(6, 0x50, 5, 0, 8);
}

TEST(commands_in_order_of_caution)
{
    const uint32_t off = 1u << EXH_COIL_OFF, run = 1u << EXH_COIL_RUN, clear = 1u << EXH_COIL_CLEAR;
    CHECK_EQ_I64(exh_regs_command(0), EXH_CMD_NONE);
    CHECK_EQ_I64(exh_regs_command(1u << EXH_COIL_APPLY), EXH_CMD_NONE);
    CHECK_EQ_I64(exh_regs_command(run), EXH_CMD_RUN);
    CHECK_EQ_I64(exh_regs_command(run | clear), EXH_CMD_CLEAR);
    CHECK_EQ_I64(exh_regs_command(run | clear | off), EXH_CMD_OFF);
    begin();
    g.r.may |= run | clear;
    ASK(15, 0, 0, 0, 6, 1, 0x38);
    GIVES(15, 0, 0, 0, 6);
    CHECK_EQ_I64(g.r.asked, off | run | clear);
    ASK(5, 0, 4, 0, 0); /* a 0 does nothing */
    CHECK_EQ_I64(g.r.asked, off | run | clear);
}

TEST(bits_are_the_box)
{
    struct exh_safety s;
    memset(&s, 0, sizeof s);
    s.state = EXH_STATE_FAULT;
    s.faults = EXH_FAULT_ESTOP | EXH_FAULT_LOGIC;
    s.present = EXH_FAULT_LINK;
    s.limits = EXH_LIMIT_PASSIVITY;
    s.refused = EXH_ARM_DEADMAN;
    s.tick = 0xFFFFFFFF;
    s.missed = 9;
    s.first = EXH_FAULT_LOGIC;
    s.first_tick = 0x01020304;
    begin();
    exh_regs_update(&g.r, &s, EXH_DIN_DEADMAN | (uint32_t)EXH_DIN_DRIVE0 << 4);
    ASK(2, 0, 0, 0, 192);
    GIVES(2, 24, 0x01, 0x40, 0, 0, 0, 0x04, 0, 0, 0x02, 0x10, 0, 0, 0x20, 0, 0, 0, 0, 0x04, 0, 0,
        0x10, 0, 0, 0);
    ASK(2, 0, 14, 0, 30); /* across two words */
    GIVES(2, 4, 1, 0, 0, 0x10);
    g.r.box.state = 31; /* none has this number, nor the next */
    ASK(2, 0, 32 * EXH_BITS_STATE, 0, 32);
    GIVES(2, 4, 0, 0, 0, 0x80);
    g.r.box.state = 32;
    ASK(2, 0, 32 * EXH_BITS_STATE, 0, 32);
    GIVES(2, 4, 0, 0, 0, 0);
    g.r.box.state = EXH_STATE_FAULT;
    ASK(4, 0, 2 * EXH_HEAD_TICK, 0, 20);
    GIVES(4, 40, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 5, 0, 0, 0x40, 1, 0, 0, 0x40, 0, 1, 2, 3, 4, 0, 0,
        4, 0, 0, 0, 4, 0, 0, 0, 0, 0x10, 0, 0, 0x10, 2, 0, 0, 0, 9);
}

TEST(set_up_refuses)
{
    static const struct exh_signal fine[1] = {{1, 126, EXH_WHEN_ANY, 0, 9, 0, "a", "", ""}};
    static const struct exh_signal finer[1] = {{1, 127, EXH_WHEN_ANY, 0, 9, 0, "a", "", ""}};
    static const struct exh_signal_group most[1] = {{fine, 1, EXH_REGS_VALUES}},
                                         more[1] = {{fine, 1, EXH_REGS_VALUES + 1}},
                                         bits[1] = {{finer, 1, 1}}, empty[1] = {{fine, 0, 1}},
                                         none[1] = {{fine, 1, 0}};
    static const struct exh_signal_table t_most = {most, 1}, t_more = {more, 1}, t_bits = {bits, 1},
                                         t_empty = {empty, 1}, t_none = {none, 1};
    begin();
    g.r.signals = &t_most;
    CHECK_EQ_I64(exh_regs_setup(&g.r), 0);
    g.r.signals = &t_more;
    CHECK_EQ_I64(exh_regs_setup(&g.r), -EXH_E_RANGE);
    g.r.signals = &t_bits;
    CHECK_EQ_I64(exh_regs_setup(&g.r), -EXH_E_RANGE);
    g.r.signals = &t_empty;
    CHECK_EQ_I64(exh_regs_setup(&g.r), -EXH_E_RANGE);
    g.r.signals = &t_none;
    CHECK_EQ_I64(exh_regs_setup(&g.r), -EXH_E_RANGE);
    g.r.signals = &out_table;
    g.r.signal = NULL;
    CHECK_EQ_I64(exh_regs_setup(&g.r), -EXH_E_ABSENT);
    g.r.signal = g.signal;
    g.r.touched = NULL;
    CHECK_EQ_I64(exh_regs_setup(&g.r), -EXH_E_ABSENT);
    for (unsigned i = 0; i < 3; i++) {
        begin();
        if (i == 0) { g.r.active = NULL; }
        if (i == 1) { g.r.wanted = NULL; }
        if (i == 2) { g.r.staged = NULL; }
        CHECK(exh_regs_setup(&g.r) == -EXH_E_ABSENT, "without array %u", i);
    }
}

TEST(without_tables_the_head_alone_is_there)
{
    begin();
    g.r.signals = NULL;
    g.r.params = NULL;
    g.r.name = NULL;
    g.r.done = 3;
    g.r.result = -EXH_E_RANGE;
    CHECK_EQ_I64(exh_regs_setup(&g.r), 0);
    ASK(4, 0, 2 * EXH_HEAD_SIGNALS, 0, 8); /* numbers and CRCs of both */
    GIVES(4, 16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
    ASK(4, 0, 2 * EXH_HEAD_DONE, 0, 4); /* and nothing done yet */
    GIVES(4, 8, 0, 0, 0, 0, 0, 0, 0, 0);
    ASK(4, 0, 2 * EXH_HEAD_NAME_0, 0, 8);
    GIVES(4, 16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
    REFUSES(2, 4, 0x10, 0, 0, 1);
    REFUSES(2, 3, 0x50, 0, 0, 1);
    REFUSES(2, 16, 0x70, 0, 0, 2, 4, 0, 0, 0, 0);
    ASK(5, 0, 1, 0xFF, 0);
    GIVES(5, 0, 1, 0xFF, 0);
}

TEST(words_for_people_are_all_there)
{
    for (unsigned i = 0; i < EXH_HEADS; i++) {
        CHECK(exh_regs_head_row[i].name && exh_regs_head_row[i].help && exh_regs_head_row[i].format,
            "head %u", i);
    }
    for (unsigned i = 0; i < EXH_BITS; i++) { CHECK(exh_regs_bits_row[i].name, "bits %u", i); }
    for (unsigned i = 0; i < EXH_COILS; i++) { CHECK(exh_regs_coil_row[i].name, "coil %u", i); }
    for (unsigned i = 0; i < EXH_REGS_BLOCKS; i++) {
        CHECK(exh_regs_blocks[i].name, "block %u", i);
        CHECK(exh_regs_blocks[i].kind > EXH_REGS_DISCRETE || exh_regs_blocks[i].at == 0,
            "bits begin at 0: block %u", i);
    }
}

TEST(requests_of_nothing)
{
    static uint8_t longest[65536 + 6] = {16, 0x50, 0, 0, 2, 4};
    const uint8_t bytes[4] = {1, 2, 3, 4};
    begin();
    ASK(23, 0, 0, 0, 0, 0x50, 0, 0, 2, 4, 0, 0, 0, 1); /* reads none */
    GIVES(0x97, 3);
    CHECK_EQ_I64(exh_regs_read(&g.r, EXH_REGS_INPUT, 0, 0, g.resp), 0);
    CHECK_EQ_I64(g.resp[0], 0x97); /* unchanged */
    CHECK_EQ_I64(exh_regs_validate(&g.r, 0x5000, 0, bytes), 0);
    CHECK_EQ_I64(exh_regs_validate(&g.r, 0x1000, 1, bytes), EXH_MODBUS_ADDRESS);
    CHECK_EQ_I64(exh_regs_write(&g.r, 0x5000, 0, bytes), 0);
    CHECK_EQ_I64(exh_regs_read(&g.r, EXH_REGS_INPUT, 0x4000, 0, g.resp), EXH_MODBUS_ADDRESS);
    ask(longest, 10);
    GIVES(16, 0x50, 0, 0, 2);
    ask(longest, 65535); /* its length would be that of the shorter one modulo 2^16 and a bit */
    GIVES(0x90, 3);
    ask(longest, sizeof longest);
    GIVES(0x90, 3);
    ask(longest, 65536 + 10 - 4);
    GIVES(0x90, 3);
}

/* 32 values fill a word of bits. The next word has no meaning, whatever its value. */
TEST(a_word_full_of_values)
{
    static const struct exh_signal_group group[] = {{par_row, 1, 32}};
    static const struct exh_signal_table full = {group, 1};
    begin();
    exh_params_setup(&g.p, &full, g.active, g.wanted);
    g.r.params = &full;
    CHECK_EQ_I64(exh_regs_setup(&g.r), 0);
    g.touched[1] = UINT32_MAX;
    ASK(16, 0x50, 62, 0, 2, 4, 0, 0, 0, 7);
    GIVES(16, 0x50, 62, 0, 2);
    CHECK_EQ_I64(g.touched[0], UINT32_C(1) << 31);
    CHECK_EQ_I64(exh_regs_apply(&g.r, &g.p), 0);
    CHECK(g.wanted[31] == 7 && g.touched[0] == 0 && g.touched[1] == UINT32_MAX, "%" PRId32,
        g.wanted[31]);
}

/* A table of parameters with a row that is computed: it may be written as it reads. */
TEST(outputs_among_parameters_stay)
{
    static const struct exh_signal row[] = {{0x7401, 0, EXH_WHEN_OUTPUT, 0, 9, 4, "out", "", ""}};
    static const struct exh_signal_group group[] = {{row, 1, 1}};
    static const struct exh_signal_table outputs = {group, 1};
    const uint8_t same[4] = {0, 0, 0, 4}, other[4] = {0, 0, 0, 5};
    begin();
    g.r.params = &outputs;
    g.active[0] = g.wanted[0] = 4;
    CHECK_EQ_I64(exh_regs_setup(&g.r), 0);
    CHECK_EQ_I64(exh_regs_write(&g.r, 0x5000, 2, same), 0);
    CHECK_EQ_I64(exh_regs_write(&g.r, 0x5000, 2, other), EXH_MODBUS_VALUE);
}

TEST_MAIN("modbus", head_says_what_this_is, a_value_is_high_word_first_and_starts_anywhere,
    reads_as_in_the_examples, writes_as_in_the_examples, mask_and_both_as_in_the_examples,
    says_who_it_is, no_such_function, counts_end_where_the_specification_says,
    counts_of_writes_end_there_too, a_request_of_another_length_is_refused, an_answer_needs_room,
    nothing_is_there, what_may_not_be, floats_that_may_not_be, what_reads_the_same_stays,
    apply_hands_over_all_or_none, what_is_staged_reads_back_and_is_counted,
    while_apply_is_pending_nothing_changes, commands_in_order_of_caution, bits_are_the_box,
    set_up_refuses, without_tables_the_head_alone_is_there, words_for_people_are_all_there,
    requests_of_nothing, a_word_full_of_values, outputs_among_parameters_stay);
