/* SPDX-License-Identifier: MIT */
/* Arithmetic, bytes, counts, tables: exact wide integers are the reference. */
#include "bench.h"

#include "wide.h"

#include "exhand/exhand.h"

#define CASES 1000000
#define LEGAL 64u /* samples of one quadrature op, and of one word */

static int32_t x[BENCH_OPS], y[BENCH_OPS];
static int64_t wide_x[BENCH_OPS];

/* (exact - got) in units of 2^n. */
static long double off_by(struct wide exact, int64_t got, unsigned n)
{
    const struct wide d = wide_sub(exact, wide_shl(wide_of(got), n));
    return bench_q((long double)wide_sat64(d), n);
}

static void setup_numbers(void)
{
    bench_seed();
    for (uint32_t i = 0; i < BENCH_OPS; i++) {
        x[i] = bench_i32();
        y[i] = bench_in(0, INT32_MAX);
        wide_x[i] = (int64_t)bench_u64() / 4;
    }
}

/* --- products --- */

static const struct exh_gain third = {1431655765, 32}; /* 1/3: never a power of two */

static void gain_op(uint32_t i) { bench_sink = exh_gain_mul(third, x[i]); }

/* Gains num/den over 0.5..1, so that the result may fill 32 bits. */
static void gain_error(struct error *e)
{
    bench_seed();
    for (int i = 0; i < CASES; i++) {
        const int32_t num = bench_in(1 << 29, 1 << 30), den = bench_in(num, 1 << 30);
        const int32_t in = bench_i32();
        struct exh_gain g;
        if (exh_gain_set(&g, (uint64_t)(uint32_t)num, (uint64_t)(uint32_t)den) < 0) { continue; }
        error_add(e,
            (long double)exh_gain_mul(g, in) - (long double)((int64_t)in * num) / (long double)den);
    }
}

static void mul_shr_op(uint32_t i) { bench_sink = exh_mul_shr(x[i], y[i], 20); }

static void mul_shr_error(struct error *e)
{
    bench_seed();
    for (int i = 0; i < CASES; i++) {
        const int32_t a = bench_i32(), b = bench_i32();
        const unsigned n = (unsigned)bench_in(1, 62);
        error_add(e, off_by(wide_mul(a, b), exh_mul_shr(a, b, n), n));
    }
}

static void mul64_op(uint32_t i) { bench_sink = exh_mul64_q31(wide_x[i], y[i]); }

static void mul64_error(struct error *e)
{
    bench_seed();
    for (int i = 0; i < CASES; i++) {
        const int64_t full = (int64_t)bench_u64();
        const int64_t a = full >> bench_in(0, 62);
        const int32_t b = bench_in(0, INT32_MAX);
        error_add(e, off_by(wide_mul(a, b), exh_mul64_q31(a, b), 31));
    }
}

/* --- bytes --- */

static uint8_t block[BENCH_OPS + 64], frame_buf[256];

static void crc_setup(void)
{
    bench_seed();
    for (uint32_t i = 0; i < sizeof block; i++) { block[i] = (uint8_t)(bench_u64() & 0xFF); }
}

static void crc_op(uint32_t i) { bench_sink = exh_crc32(0, block + i, 64); }

static uint32_t crc_bit_by_bit(const uint8_t *p, uint32_t len)
{
    uint32_t c = UINT32_MAX;
    for (uint32_t i = 0; i < 8 * len; i++) {
        const uint32_t bit = (uint32_t)p[i / 8] >> i % 8 & 1;
        c = c >> 1 ^ ((c ^ bit) & 1 ? 0xEDB88320u : 0);
    }
    return ~c;
}

static void crc_error(struct error *e)
{
    crc_setup();
    for (uint32_t i = 0; i < BENCH_OPS; i++) {
        const uint32_t len = (uint32_t)bench_in(0, 64);
        error_add(e, exh_crc32(0, block + i, len) != crc_bit_by_bit(block + i, len));
    }
}

/* A frame of the drop scene: one finger's inputs and outputs and nine signals. */
#define FRAME_SIGNALS 9u

static void frame_fields(
    struct exh_bytes *c, struct exh_drive_in *in, struct exh_drive_out *out, int32_t *signal)
{
    exh_drive_in_serialize(c, in, 1);
    exh_drive_out_serialize(c, out, 1);
    for (uint32_t k = 0; k < FRAME_SIGNALS; k++) { exh_bytes_i32(c, &signal[k]); }
}

static uint32_t write_frame(uint32_t tick, const int32_t *from)
{
    struct exh_bytes c = exh_bytes_writer(frame_buf, sizeof frame_buf);
    struct exh_drive_in in = {.enc_raw = {(uint32_t)from[9]}, .din = (uint32_t)from[10]};
    struct exh_drive_out out = {.dac_raw = {(uint16_t)(from[11] & 0xFFFF)}};
    int32_t signal[FRAME_SIGNALS];
    for (uint32_t k = 0; k < FRAME_SIGNALS; k++) { signal[k] = from[k]; }
    exh_record_begin(&c, EXH_RECORD_FRAME, tick, tick);
    frame_fields(&c, &in, &out, signal);
    return exh_record_end(&c);
}

static void frame_op(uint32_t i) { bench_sink = write_frame(i, &x[i % (BENCH_OPS - 12)]); }

static void frame_error(struct error *e)
{
    setup_numbers();
    for (uint32_t i = 0; i < BENCH_OPS - 12; i++) {
        const uint32_t len = write_frame(i, &x[i]);
        struct exh_drive_in in;
        struct exh_drive_out out;
        struct exh_record r;
        struct exh_bytes c;
        int32_t signal[FRAME_SIGNALS];
        int wrong = exh_record_decode(frame_buf, len, &r) != (int32_t)len || r.tick != i;
        if (!wrong) {
            c = exh_bytes_reader(r.payload, r.len_B);
            frame_fields(&c, &in, &out, signal);
            wrong += in.enc_raw[0] != (uint32_t)x[i + 9] || in.din != (uint32_t)x[i + 10];
            wrong += out.dac_raw[0] != (uint16_t)(x[i + 11] & 0xFFFF);
            for (uint32_t k = 0; k < FRAME_SIGNALS; k++) { wrong += signal[k] != x[i + k]; }
        }
        error_add(e, wrong);
    }
}

/* --- counts --- */

static uint8_t ab[BENCH_OPS * 8]; /* A<<1 | B of a legal walk, with dwells and reversals */
static int32_t truth[BENCH_OPS * 8];
static struct exh_quad_ab lines;
static struct exh_quad counter;
static const struct exh_quad_par encoder = {EXH_Q(6632, 100000000, EXH_Q_STEP), INT32_MAX};
static struct exh_quad_cfg encoder_cfg;

static void lines_setup(void)
{
    static const uint8_t gray[4] = {0, 1, 3, 2};
    int32_t cnt = 0;
    bench_seed();
    lines = (struct exh_quad_ab){0};
    for (uint32_t i = 0; i < BENCH_OPS * 8; i++) {
        ab[i] = gray[cnt & 3];
        truth[i] = cnt;
        cnt += bench_in(0, 3) < 3 ? (i / 300 & 1 ? -1 : 1) : bench_in(-1, 1);
    }
}

/* The same walk, a line a word. */
static uint64_t word[BENCH_OPS * 8 / LEGAL][2];

static void words_setup(void)
{
    lines_setup();
    for (uint32_t i = 0; i < BENCH_OPS * 8; i++) {
        uint64_t *w = word[i / LEGAL];
        w[0] = (i % LEGAL ? w[0] : 0) | (uint64_t)(ab[i] >> 1) << i % LEGAL;
        w[1] = (i % LEGAL ? w[1] : 0) | (uint64_t)(ab[i] & 1) << i % LEGAL;
    }
}

static const uint8_t *stretch(uint32_t i) { return &ab[i * LEGAL % (BENCH_OPS * 8)]; }

static void lines_run_op(uint32_t i) { exh_quad_ab_run(&lines, &exh_quad_x4, stretch(i), LEGAL); }

static void lines_step_op(uint32_t i)
{
    const uint8_t *p = stretch(i);
    for (uint32_t k = 0; k < LEGAL; k++) { exh_quad_ab_step(&lines, &exh_quad_x4, p[k]); }
}

static void lines_word_op(uint32_t i)
{
    const uint64_t *w = word[i % (BENCH_OPS * 8 / LEGAL)];
    exh_quad_ab_word(&lines, w[0], w[1]);
}

/* The legal walk exactly; then double steps, all of them flagged and none counted. */
static void lines_run_error(struct error *e)
{
    uint8_t both[254];
    int32_t last;
    lines_setup();
    for (uint32_t i = 0; i < BENCH_OPS * 8; i += LEGAL) {
        exh_quad_ab_run(&lines, &exh_quad_x4, &ab[i], LEGAL);
        error_add(e, (long double)lines.cnt - truth[i + LEGAL - 1]);
    }
    error_add(e, lines.illegal);
    last = lines.cnt;
    for (unsigned i = 0; i < 254; i++) { both[i] = lines.ab ^ (i & 1 ? 0u : 3u); }
    exh_quad_ab_run(&lines, &exh_quad_x4, both, 254);
    error_add(e, (long double)lines.illegal - 254);
    error_add(e, (long double)lines.cnt - last);
}

static void lines_step_error(struct error *e)
{
    int32_t last;
    lines_setup();
    for (uint32_t i = 0; i < BENCH_OPS * 8; i++) {
        exh_quad_ab_step(&lines, &exh_quad_x4, ab[i]);
        error_add(e, (long double)lines.cnt - truth[i]);
    }
    error_add(e, lines.illegal);
    last = lines.cnt;
    for (unsigned i = 0; i < 254; i++) { exh_quad_ab_step(&lines, &exh_quad_x4, lines.ab ^ 3u); }
    error_add(e, (long double)lines.illegal - 254);
    error_add(e, (long double)lines.cnt - last);
}

static void lines_word_error(struct error *e)
{
    const uint64_t both = UINT64_C(0x5555555555555555); /* from 00: 11 00 11 … */
    int32_t last;
    words_setup();
    for (uint32_t i = 0; i < BENCH_OPS * 8 / LEGAL; i++) {
        exh_quad_ab_word(&lines, word[i][0], word[i][1]);
        error_add(e, (long double)lines.cnt - truth[i * LEGAL + LEGAL - 1]);
    }
    error_add(e, lines.illegal);
    exh_quad_ab_word(&lines, 0, 0);
    lines.illegal = 0;
    last = lines.cnt;
    for (unsigned i = 0; i < 4; i++) { exh_quad_ab_word(&lines, both, both); }
    error_add(e, (long double)lines.illegal - 256);
    error_add(e, (long double)lines.cnt - last);
}

static void extend_setup(void)
{
    EXH_ASSERT(exh_quad_setup(&encoder_cfg, &encoder, (struct exh_period){1, 2000}, 24) == 0);
    encoder_cfg.jump_cnt = INT32_MAX; /* the counter alone, at any speed */
    counter = (struct exh_quad){0};
    setup_numbers();
}

static void extend_op(uint32_t i)
{
    bench_sink = exh_quad_step(&counter, &encoder_cfg, (uint32_t)i * 8191u & 0xFFFFFF);
}

/* Moves of up to half the counter's width, across its wrap and the wrap of 2^32. */
static void extend_error(struct error *e)
{
    uint32_t at = 0;
    extend_setup();
    counter = (struct exh_quad){0};
    bench_seed();
    exh_quad_step(&counter, &encoder_cfg, 0);
    for (int i = 0; i < CASES; i++) {
        at += (uint32_t)bench_in(-(1 << 23) + 1, (1 << 23) - 1);
        error_add(e,
            (long double)exh_quad_step(&counter, &encoder_cfg, at & 0xFFFFFF) - exh_from_u32(at));
    }
}

static void pos_op(uint32_t i) { bench_sink = exh_quad_pos_m_q30(&encoder, x[i]); }

static void pos_error(struct error *e)
{
    bench_seed();
    for (int i = 0; i < CASES; i++) {
        const struct exh_quad_par p = {bench_in(1 << 22, INT32_MAX), INT32_MAX};
        const int32_t cnt = i & 1 ? bench_i32() : bench_in(-32768, 32767);
        const long double exact = bench_q((long double)((int64_t)cnt * p.step_m_q42), 12);
        error_add(e, exh_quad_pos_m_q30(&p, cnt) - bench_clamp(exact, INT32_MIN, INT32_MAX));
    }
}

/* --- tables --- */

static struct exh_knot knot[16];

static void knots(unsigned n)
{
    int32_t at_x = -(1 << 28), at_y = -(1 << 27);
    bench_seed();
    for (unsigned k = 0; k < n; k++) {
        knot[k] = (struct exh_knot){at_x, at_y, {0, 0}};
        at_x += bench_in(1 << 20, 1 << 26);
        at_y += bench_in(1 << 20, 1 << 26);
    }
    if (exh_table_setup(knot, n) < 0) { knot[0].slope.mant = -1; }
}

static void table2_setup(void)
{
    setup_numbers();
    knots(2);
}

static void table16_setup(void)
{
    setup_numbers();
    knots(16);
}

static void table2_op(uint32_t i)
{
    const struct exh_table t = {knot, 2};
    bench_sink = exh_table_at(t, x[i]);
}

static void table16_op(uint32_t i)
{
    const struct exh_table t = {knot, 16};
    bench_sink = exh_table_at(t, x[i]);
}

static long double line_at(unsigned n, int32_t in)
{
    unsigned k = 0;
    int64_t rise;
    if (in <= knot[0].x) { return knot[0].y; }
    if (in >= knot[n - 1].x) { return knot[n - 1].y; }
    while (in >= knot[k + 1].x) { k++; }
    rise = (int64_t)knot[k + 1].y - knot[k].y;
    return knot[k].y + (long double)(rise * ((int64_t)in - knot[k].x)) /
                           (long double)((int64_t)knot[k + 1].x - knot[k].x);
}

static void table_error(struct error *e, unsigned n)
{
    const struct exh_table t = {knot, (uint8_t)n};
    knots(n);
    for (int i = 0; i < CASES; i++) {
        const int32_t in = i & 1 ? bench_i32() : bench_in(knot[0].x, knot[n - 1].x);
        error_add(e, exh_table_at(t, in) - line_at(n, in));
    }
}

static void table2_error(struct error *e) { table_error(e, 2); }

static void table16_error(struct error *e) { table_error(e, 16); }

#define SCALED(q) (1.0 / (double)(UINT64_C(1) << (q)))
#define QUAD_PACKED_PEER \
    "64 time samples per word, popcount, net and illegal, private probe, gcc 12.2 -O2"
#define QUAD_PEER "table + illegal count, inlined in its loop, private harness, gcc 12.2 -O2"

static const struct kernel kernels[] = {
    {"mul_shr", "", 1, 0.5, 1, setup_numbers, mul_shr_op, mul_shr_error,
        "one rounding; all of int32_t and every shift", 0, NULL},
    {"gain_mul", "", 1, 1.5, 1, setup_numbers, gain_op, gain_error,
        "one rounding + 2^-31 of the result; random ratios 0.5..1, full scale", 0, NULL},
    {"mul64_q31", "", 1, 0.5, 1, setup_numbers, mul64_op, mul64_error,
        "one rounding; all of int64_t", 0, NULL},
    {"crc32_64B", "wrong", 1, 0, 1, crc_setup, crc_op, crc_error,
        "equal to the bit-by-bit definition; 0..64 random bytes", 0, NULL},
    {"record_frame", "wrong", 1, 0, 1, setup_numbers, frame_op, frame_error,
        "reads back as written; the drop scene's frame", 0, NULL},
    {"quad_ab_run_x4", "count", 1, 0, LEGAL, lines_setup, lines_run_op, lines_run_error,
        "exact; 64 samples a run; legal walk of 8192, then 254 double steps, all flagged", 14.2,
        QUAD_PEER},
    {"quad_ab_step_x4", "count", 1, 0, LEGAL, lines_setup, lines_step_op, lines_step_error,
        "exact; one sample a call; the same samples", 0, NULL},
    {"quad_ab_word", "count", 1, 0, LEGAL, words_setup, lines_word_op, lines_word_error,
        "exact; 64 samples a word; legal walk of 8192, then 256 double steps, all flagged", 2.0,
        QUAD_PACKED_PEER},
    {"quad_extend", "count", 1, 0, 1, extend_setup, extend_op, extend_error,
        "exact; 24-bit counter, moves up to half its width", 0, NULL},
    {"quad_pos", "m", SCALED(EXH_Q_POS), 0.5, 1, setup_numbers, pos_op, pos_error,
        "one rounding; steps 1..488 um, full-scale counts", 0, NULL},
    {"table_at_2", "", 1, 1, 1, table2_setup, table2_op, table2_error,
        "drive.h; random slopes, all of int32_t", 0, NULL},
    {"table_at_16", "", 1, 1, 1, table16_setup, table16_op, table16_error,
        "drive.h; random slopes, all of int32_t", 0, NULL},
};
const struct kernel_group number_group = {kernels, sizeof kernels / sizeof kernels[0]};
