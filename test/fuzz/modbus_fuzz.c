/* SPDX-License-Identifier: MIT */
/* The slave gets any requests from a Modbus client or a serial line.
 *
 * An input is a sequence of requests. Before each are two bytes: repairs, and its length. Repairs
 * by bit: 0 a function that exists, 1 an address of a block, 2 a count that fits, 3 the length. Bit
 * 4: the request comes over the serial line as a frame with its CRC. Bit 5: the CRC is wrong. Bit
 * 6: the bytes go to the line unchanged. Bit 7: the command is carried out afterwards.
 *
 * Rules: No read or write is outside. An answer has at most 253 bytes, an exception two. A request
 * that got an exception changes nothing. Nothing is staged outside its range or against a lock. No
 * command is given that is not allowed.
 *
 * LLVMFuzzerTestOneInput() is libFuzzer's; the rest makes inputs without it: [SECONDS [SEED]]. */
#include "fails.h"
#include "must.h"

#include "exhand/error.h"
#include "exhand/modbus.h"
#include "exhand/modbus_rtu.h"
#include "exhand/regs.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define FIX_FUNCTION 1u
#define FIX_ADDRESS  2u
#define FIX_COUNT    4u
#define FIX_LENGTH   8u
#define SERIAL       16u
#define WRONG_CRC    32u
#define BYTES        64u
#define CARRY_OUT    128u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* --- a box --- */

#define PARAMS  70
#define SIGNALS 64
static const struct exh_signal par_row[5] = {
    {0x7101, 10, EXH_WHEN_ANY, -1024000, 1024000, 1024, "k", "", ""},
    {0x7102, 0, EXH_WHEN_SETUP, 0, 1000, 500, "window", "", ""},
    {0x7103, 20, EXH_WHEN_ANY, INT32_MIN, INT32_MAX, 0, "wide", "", ""},
    {0x7104, 42, EXH_WHEN_SETUP, 1, INT32_MAX - 5, 77, "fine", "", ""},
    {0x7105, 0, EXH_WHEN_ANY, 5, 5, 5, "one", "", ""},
};
static const struct exh_signal out_row[4] = {
    {0x7201, 30, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "q", "", ""},
    {0x7202, 27, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "qd", "", ""},
    {0x7203, 20, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "f", "", ""},
    {0x7204, 0, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "n", "", ""},
};
static const struct exh_signal_group par_group[2] = {{par_row, 5, 4}, {par_row, 5, 10}};
static const struct exh_signal_group out_group[1] = {{out_row, 4, 16}};
static const struct exh_signal_table par_table = {par_group, 2}, out_table = {out_group, 1};

struct box {
    struct exh_regs r;
    struct exh_params p;
    struct exh_modbus_rtu u;
    int32_t active[PARAMS], wanted[PARAMS], staged[PARAMS + 1], signal[SIGNALS];
    uint32_t touched[EXH_REGS_WORDS(PARAMS) + 1];
    struct exh_trace trace;
    struct exh_trace_frame frame[16];
};
static struct box b;

static void start(void)
{
    memset(&b, 0, sizeof b);
    exh_params_setup(&b.p, &par_table, b.active, b.wanted);
    b.p.locked = 1;
    b.r = (struct exh_regs){.name = "fuzz",
        .signals = &out_table,
        .signal = b.signal,
        .params = &par_table,
        .active = b.active,
        .wanted = b.wanted,
        .staged = b.staged,
        .touched = b.touched,
        .may = EXH_REGS_MAY,
        .locked = 1};
    for (int i = 0; i < SIGNALS; i++) { b.signal[i] = i * 0x01234567; }
    b.staged[PARAMS] = 0x5A5A;
    b.touched[EXH_REGS_WORDS(PARAMS)] = 0x5A5A;
    MUST(exh_regs_setup(&b.r) == 0);
    MUST(exh_trace_setup(&b.trace, b.frame, 16, SIGNALS) == 0);
    b.r.trace = &b.trace;
    MUST(exh_modbus_rtu_setup(&b.u, 17, 115200) == 0);
}

static void must_be_sound(void)
{
    for (uint32_t i = 0; i < 32 * EXH_REGS_WORDS(PARAMS); i++) {
        const struct exh_signal *row = exh_signal_at(&par_table, i, NULL);
        if (!(b.touched[i >> 5] >> (i & 31u) & 1u)) { continue; }
        MUST(row != NULL && b.staged[i] >= row->min && b.staged[i] <= row->max);
        MUST(row->when == EXH_WHEN_ANY && b.staged[i] != b.wanted[i]);
    }
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) { MUST(b.trace.what.index[i] < SIGNALS); }
    exh_trace_step(&b.trace, 1, b.signal);
    MUST(b.staged[PARAMS] == 0x5A5A && b.touched[EXH_REGS_WORDS(PARAMS)] == 0x5A5A);
    MUST((b.r.asked & ~(1u << EXH_COIL_APPLY | 1u << EXH_COIL_OFF)) == 0);
}

/* --- requests --- */

static void put_right(unsigned right, uint8_t *q, uint32_t *len_B)
{
    static const uint8_t function[] = {1, 2, 3, 4, 5, 6, 15, 16, 22, 23, 43};
    static const uint8_t block[] = {0x00, 0x10, 0x30, 0x50, 0x70, 0x50, 0x70, 0x04};
    int is_bits;
    if (right & FIX_FUNCTION) { q[0] = function[q[0] % sizeof function]; }
    is_bits = q[0] == 15 || q[0] == 1 || q[0] == 2 || q[0] == 5;
    if (right & FIX_ADDRESS) {
        q[1] = is_bits ? 0 : block[q[1] & 7u];
        if (q[0] == 23) { q[5] = q[5] & 1u ? 0x50 : 0x70; }
    }
    if (right & FIX_COUNT) {
        q[3] = 0;
        q[4] = (uint8_t)(q[4] % (is_bits ? 7u : 124u));
        if (q[0] == 5) {
            q[3] = (uint8_t)(0u - (q[4] & 1u));
            q[4] = 0;
        }
        if (q[0] == 15) { q[5] = (uint8_t)((q[4] + 7) / 8); }
        if (q[0] == 16) { q[5] = (uint8_t)(2 * q[4]); }
        if (q[0] == 23) {
            q[7] = 0;
            q[8] = (uint8_t)(q[8] % 122u);
            q[9] = (uint8_t)(2 * q[8]);
        }
    }
    if (right & FIX_LENGTH) {
        *len_B = q[0] == 15 || q[0] == 16 ? 6u + q[5]
                 : q[0] == 23             ? 10u + q[9]
                 : q[0] == 22             ? 7
                 : q[0] == 43             ? 4
                                          : 5;
    }
}

/* The answer ends where it says, and nothing is behind it. */
static void must_answer(
    const struct box *was, const uint8_t *q, uint32_t len_B, const uint8_t *a, int n)
{
    struct box same = *was;
    MUST(n >= 0 && n <= EXH_MODBUS_PDU_B && (n == 0) == (len_B == 0));
    if (n == 0) { return; }
    if (a[0] & 0x80u) {
        MUST(
            n == 2 && a[0] == (q[0] | 0x80u) && (a[1] == 1 || a[1] == 2 || a[1] == 3 || a[1] == 6));
        same.r.refused = b.r.refused; /* what may not be is counted */
        MUST(b.r.refused - was->r.refused <= (a[1] == 3));
        MUST(memcmp(&same, &b, sizeof b) == 0);
    } else {
        MUST(a[0] == q[0] && n >= 3);
        MUST(q[0] > 4 || n == 2 + a[1]);
    }
}

static void ask(const uint8_t *q, uint32_t len_B)
{
    /* Just as long as they may be touched: a sanitizer sees one more. */
    uint8_t *req = malloc(len_B ? len_B : 1), *resp = malloc(EXH_MODBUS_PDU_B);
    const struct box was = b;
    if (req == NULL || resp == NULL) { exit(3); }
    memcpy(req, q, len_B);
    must_answer(&was, q, len_B, resp, exh_modbus_answer(&b.r, req, len_B, resp, EXH_MODBUS_PDU_B));
    free(req);
    free(resp);
}

static void must_reply(const uint8_t *frame, uint32_t len_B, int damaged)
{
    uint8_t *resp = malloc(EXH_MODBUS_ADU_B);
    const struct box was = b;
    const int ours = exh_modbus_rtu_poll(&b.u, b.u.silence_us);
    int n;
    if (resp == NULL) { exit(3); }
    MUST(b.u.taken + b.u.others + b.u.damaged <= was.u.taken + was.u.others + was.u.damaged + 1);
    n = exh_modbus_rtu_answer(&b.u, &b.r, resp, EXH_MODBUS_ADU_B);
    MUST(n >= 0 && n <= EXH_MODBUS_ADU_B && (ours || n == 0));
    MUST(!ours || len_B == 0 || !damaged);
    if (n > 0) { MUST(resp[0] == 17 && exh_crc16(resp, (size_t)n) == 0); }
    if (len_B > 0 && frame[0] == 0) { MUST(n == 0); }
    if (!ours) { MUST(memcmp(&was.r, &b.r, sizeof b.r) == 0); }
    MUST(b.u.len_B == 0 && !b.u.ready);
    free(resp);
}

static void say(const uint8_t *q, uint32_t len_B, unsigned right)
{
    uint8_t frame[300];
    uint32_t n = len_B + 1;
    frame[0] = right & FIX_ADDRESS ? 17 : (uint8_t)(right & FIX_COUNT ? 0 : 18);
    memcpy(&frame[1], q, len_B);
    for (uint32_t i = 0; i < n; i++) { exh_modbus_rtu_receive(&b.u, frame[i]); }
    {
        const uint32_t crc = (uint32_t)exh_crc16(frame, n) ^ (right & WRONG_CRC ? 0x10u : 0u);
        exh_modbus_rtu_receive(&b.u, (uint8_t)(crc & 0xFFu));
        exh_modbus_rtu_receive(&b.u, (uint8_t)(crc >> 8));
    }
    must_reply(frame, n, (right & WRONG_CRC) != 0);
}

static void carry_out(void)
{
    const uint32_t asked = exh_regs_poll(&b.r);
    if (asked >> EXH_COIL_APPLY & 1u) {
        MUST(exh_regs_apply(&b.r, &b.p) == 0); /* all that is staged may be */
        (void)exh_params_apply(&b.p);
        exh_regs_complete(&b.r, 0);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    start();
    while (size >= 2) {
        const unsigned right = data[0];
        uint8_t q[280] = {0};
        uint32_t len_B = data[1] + (data[1] > 250 ? 10u : 0u);
        if (len_B > size - 2) { len_B = (uint32_t)size - 2; }
        memcpy(q, data + 2, len_B);
        data += 2 + len_B;
        size -= 2 + len_B;
        put_right(right, q, &len_B);
        if (right & BYTES) {
            for (uint32_t i = 0; i < len_B; i++) { exh_modbus_rtu_receive(&b.u, q[i]); }
            must_reply(q, 0, 0);
        } else if (right & SERIAL) {
            say(q, len_B, right);
        } else {
            ask(q, len_B);
        }
        if (right & CARRY_OUT) { carry_out(); }
        must_be_sound();
    }
    return 0;
}

/* --- without libFuzzer --- */

#ifndef FUZZ_NO_MAIN
#define INPUT_MAX 4096u

static uint64_t state, made_of;
static uint8_t input[INPUT_MAX];
static size_t input_n;

static uint64_t u64(void)
{
    uint64_t z = state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

static void failed(int sig)
{
    FILE *f = fopen("fuzz-modbus-failed", "wb");
    if (f != NULL) {
        fwrite(input, 1, input_n, f);
        fclose(f);
    }
    fprintf(stderr, "modbus: seed %llu; its input is in fuzz-modbus-failed\n",
        (unsigned long long)made_of);
    signal(sig, SIG_DFL);
    raise(sig);
}

static void make(uint64_t seed)
{
    state = made_of = seed;
    input_n = 0;
    for (uint64_t k = u64() % 12 + 1; k > 0; k--) {
        const uint64_t how = u64();
        uint8_t *const at = &input[input_n];
        const size_t n = how % 4 == 0 ? how >> 8 & 255 : 5 + (how >> 8 & 31);
        at[0] = (uint8_t)(how >> 16 |
                          (how % 3 ? FIX_FUNCTION | FIX_ADDRESS | FIX_COUNT | FIX_LENGTH : 0));
        at[1] = (uint8_t)n;
        for (size_t i = 0; i < n; i++) {
            const uint64_t v = u64();
            at[2 + i] = v & 0x300 ? (uint8_t)(v & (v & 0x400 ? 0xFF : 3)) : 0;
        }
        input_n += 2 + n;
    }
}

int main(int argc, char **argv)
{
    const time_t end = time(NULL) + (argc > 1 ? atol(argv[1]) : 1);
    const uint64_t seed = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    uint64_t n = 0;
    signal(SIGABRT, failed);
    if (argc > 1 && atol(argv[1]) == 0) { /* one input again */
        FILE *f = fopen(argv[1], "rb");
        if (f == NULL) {
            perror(argv[1]);
            return 3;
        }
        input_n = fread(input, 1, sizeof input, f);
        fclose(f);
        return LLVMFuzzerTestOneInput(input, input_n);
    }
    for (; n % 256 || time(NULL) < end; n++) {
        make(seed + n);
        (void)LLVMFuzzerTestOneInput(input, input_n);
    }
    printf("modbus: %llu inputs from seed %llu: nothing found\n", (unsigned long long)n,
        (unsigned long long)seed);
    return 0;
}
#endif
