/* SPDX-License-Identifier: MIT */
/* Modbus: the longest reads and writes of a box with 420 parameters and 140 outputs, from the bytes
 * of a request to those of its answer; instructions per register. And the binary32 mirror. */
#include "bench.h"

#include "exhand/error.h"
#include "exhand/modbus.h"
#include "exhand/modbus_rtu.h"
#include "exhand/regs.h"

#include <math.h>
#include <string.h>

#define ROWS    7
#define PARAMS  (12 * ROWS * 5)
#define SIGNALS (4 * ROWS * 5)
#define READ    124
#define WRITE   122

static struct exh_signal row[ROWS];
static struct exh_signal_group par_group[12], out_group[4];
static const struct exh_signal_table par_table = {par_group, 12}, out_table = {out_group, 4};
static struct exh_params params;
static struct exh_regs regs;
static int32_t active[PARAMS], wanted[PARAMS], staged[PARAMS], signal[SIGNALS];
static uint32_t touched[EXH_REGS_WORDS(PARAMS)];
static uint8_t req[EXH_MODBUS_PDU_B], resp[EXH_MODBUS_PDU_B];
static struct exh_modbus_rtu line;

static void start(uint8_t function, uint32_t at, uint32_t n)
{
    const uint8_t head[6] = {
        function, (uint8_t)(at >> 8), (uint8_t)(at & 0xFFu), 0, (uint8_t)n, (uint8_t)(2 * n)};
    bench_seed();
    for (uint16_t i = 0; i < ROWS; i++) {
        row[i] = (struct exh_signal){
            i, (uint8_t)(10 + 3 * i), EXH_WHEN_ANY, INT32_MIN, INT32_MAX, 0, "x", "", ""};
    }
    for (uint32_t g = 0; g < 12; g++) { par_group[g] = (struct exh_signal_group){row, ROWS, 5}; }
    for (uint32_t g = 0; g < 4; g++) { out_group[g] = (struct exh_signal_group){row, ROWS, 5}; }
    exh_params_setup(&params, &par_table, active, wanted);
    for (uint32_t i = 0; i < SIGNALS; i++) { signal[i] = bench_i32(); }
    for (uint32_t i = 0; i < PARAMS; i++) { wanted[i] = bench_i32(); }
    regs = (struct exh_regs){.signals = &out_table,
        .signal = signal,
        .params = &par_table,
        .active = active,
        .wanted = wanted,
        .staged = staged,
        .touched = touched,
        .may = EXH_REGS_MAY};
    EXH_ASSERT(exh_regs_setup(&regs) == 0);
    memset(req, 0, sizeof req);
    memcpy(req, head, sizeof head);
}

static void start_raw(void) { start(4, EXH_REGS_SIGNAL_AT + 2 * 78, READ); }
static void start_float(void) { start(4, EXH_REGS_SIGNAL_FLOAT_AT + 2 * 78, READ); }
static void start_staged(void) { start(3, EXH_REGS_PARAM_FLOAT_AT + 2 * 350, READ); }
static void start_write(void) { start(16, EXH_REGS_PARAM_FLOAT_AT + 2 * 350, WRITE); }

static void read_op(uint32_t i)
{
    (void)i;
    bench_sink = exh_modbus_answer(&regs, req, 5, resp, sizeof resp);
}

static void write_op(uint32_t i)
{
    req[7] = (uint8_t)i; /* other values each time */
    bench_sink = exh_modbus_answer(&regs, req, 6 + 2 * WRITE, resp, sizeof resp);
}

/* From the first byte of the request to the last of the answer. */
static void start_line(void)
{
    start_staged();
    EXH_ASSERT(exh_modbus_rtu_setup(&line, 1, 115200) == 0);
}

static void line_op(uint32_t i)
{
    static uint8_t frame[8] = {1}, out[EXH_MODBUS_ADU_B];
    uint16_t crc;
    (void)i;
    memcpy(&frame[1], req, 5);
    crc = exh_crc16(frame, 6);
    frame[6] = (uint8_t)(crc & 0xFFu);
    frame[7] = (uint8_t)(crc >> 8);
    for (uint32_t k = 0; k < 8; k++) { exh_modbus_rtu_receive(&line, frame[k]); }
    (void)exh_modbus_rtu_poll(&line, 2000);
    bench_sink = exh_modbus_rtu_answer(&line, &regs, out, sizeof out);
}

/* --- binary32 --- */

static uint32_t bits[BENCH_OPS];

static void start_numbers(void)
{
    bench_seed();
    for (uint32_t i = 0; i < BENCH_OPS; i++) { signal[i % SIGNALS] = bench_i32(); }
    for (uint32_t i = 0; i < BENCH_OPS; i++) { bits[i] = exh_float_from_raw(bench_i32(), 30); }
}

static void float_of_op(uint32_t i) { bench_sink = exh_float_from_raw(signal[i % SIGNALS], 30); }

static void float_raw_op(uint32_t i)
{
    int32_t raw = 0;
    bench_sink = exh_float_to_raw(bits[i], 30, &raw);
}

static float as_float(uint32_t b)
{
    float f;
    memcpy(&f, &b, sizeof f);
    return f;
}

/* Against the host's own conversion, which rounds to nearest even, too: the bits must be the same.
 */
static void float_of_error(struct error *e)
{
    bench_seed();
    for (uint32_t i = 0; i < 1000000; i++) {
        const int32_t raw = bench_i32();
        const int frac = bench_in(0, 126);
        const float want = (float)ldexpl((long double)raw, -frac);
        error_add(e, as_float(exh_float_from_raw(raw, (unsigned)frac)) == want ? 0 : 1);
    }
}

static void float_raw_error(struct error *e)
{
    bench_seed();
    for (uint32_t i = 0; i < 1000000; i++) {
        const uint32_t b = (uint32_t)bench_u64();
        const int frac = bench_in(0, 126);
        const long double want = rintl(ldexpl((long double)as_float(b), frac));
        const int may = want >= -2147483648.0L && want <= 2147483647.0L; /* no number is neither */
        int32_t raw = 0;
        const int err = exh_float_to_raw(b, (unsigned)frac, &raw);
        error_add(e, may ? (err == 0 ? (long double)raw - want : 1) : err == 0);
    }
}

static void no_error(struct error *e) { error_add(e, 0); }

static const struct kernel kernels[] = {
    {"modbus_read_raw", "", 1, 0, READ, start_raw, read_op, no_error,
        "exact; per register; 124 of a table", 0, NULL},
    {"modbus_read_float", "", 1, 0, READ, start_float, read_op, no_error,
        "per register; 124 of a table", 0, NULL},
    {"modbus_read_staged", "", 1, 0, READ, start_staged, read_op, no_error,
        "floats; per register; 124 of the end of 420 parameters", 0, NULL},
    {"modbus_write_float", "", 1, 0, WRITE, start_write, write_op, no_error,
        "per register; 122 of them", 0, NULL},
    {"modbus_rtu_read_staged", "", 1, 0, READ, start_line, line_op, no_error,
        "the same with both CRCs; per register", 0, NULL},
    {"float_of", "", 1, 0, 1, start_numbers, float_of_op, float_of_error,
        "modbus.h: the host's bits, any fraction", 0, NULL},
    {"float_raw", "", 1, 0, 1, start_numbers, float_raw_op, float_raw_error,
        "modbus.h: nearest, of two the even one; any bits, any fraction", 0, NULL},
};
const struct kernel_group modbus_group = {kernels, sizeof kernels / sizeof kernels[0]};
