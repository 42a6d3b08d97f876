/* modbus.h: the slave, request by request. The examples of the Modbus specification (V1.1b3, chapter
 * 6) with its addresses replaced by ours, each exception, and each edge of a count. */
#include "exhand/modbus.h"

#include "exhand/error.h"
#include "exhand/exhand.h"

#include "check.h"

#define VALUES  100 /* parameters: enough for the longest request               */
#define SIGNALS 70

static const struct exh_signal par_row[4] = {
    {0x7101, 10, EXH_WHEN_ANY, -1024000, 1024000, 1024, "k", "n_per_m", "may change at any time"},
    {0x7102, 0, EXH_WHEN_SETUP, 0, 1000, 500, "window", "", "before the loop"},
    {0x7103, 20, EXH_WHEN_ANY, INT32_MIN, INT32_MAX, 0, "wide", "n", "any raw value"},
    {0x7104, 30, EXH_WHEN_ANY, 0, INT32_MAX - 5, 0, "long", "m", "an end between two binary32"},
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
    uint8_t resp[EXH_MODBUS_PDU_B + 8]; /* with a fence                        */
    int len;
};

static struct rig g;

static void begin(void)
{
    memset(&g, 0, sizeof g);
    exh_params_init(&g.p, &par_table, g.active, g.wanted);
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
    CHECK(g.len == len, "line %d: %d bytes, want %d; the second is %u", line, g.len, len,
          g.resp[1]);
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
    GIVES(4, 16, 0x45, 0x58, 0x48, 0x31, 0, 1, 0, 0, 0x12, 0x34, 0x56, 0x78, 0x3F, 0x80, 0, 0);
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

TEST_MAIN("modbus", head_says_what_this_is, a_value_is_high_word_first_and_starts_anywhere);
