/* SPDX-License-Identifier: MIT */
/* A box with registers, and requests for them: right, at the edges, damaged. */
#include "modbus_box.h"

#include "exhand/error.h"
#include "exhand/fix.h"

static const struct exh_signal out_rows[] = {
    {0x7011, 0, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "count", "", ""},
    {0x7012, 26, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "current", "", ""},
    {0x7013, 42, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "small", "", ""},
};
static const struct exh_signal end_rows[] = {
    {0x7021, 126, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "least", "", ""},
};
static const struct exh_signal_group out_groups[] = {{out_rows, 3, 20}, {end_rows, 1, 4}};
static const struct exh_signal_table out_table = {out_groups, 2};

static const struct exh_signal par_rows[] = {
    {0x7201, 10, EXH_WHEN_ANY, 0, 1024000000, 1536000, "some", "", ""},
    {0x7202, 0, EXH_WHEN_SETUP, -5, 5, 0, "fixed", "", ""},
    {0x7203, 30, EXH_WHEN_SLEWED, INT32_MIN, INT32_MAX, 0, "free", "", ""},
    {0x7204, 42, EXH_WHEN_LIMIT, -70000, 70000, 1, "limit", "", ""},
    {0x7205, 0, EXH_WHEN_REST, 0, 1, 0, "bit", "", ""},
    {0x7206, 24, EXH_WHEN_WALL, 16777217, INT32_MAX, 16777219, "odd", "",
        ""}, /* no binary32 is an end */
};
static const struct exh_signal last_rows[] = {
    {0x7301, 126, EXH_WHEN_SETUP, INT32_MIN, INT32_MAX, -1, "last", "", ""},
};
static const struct exh_signal_group par_groups[] = {{par_rows, 6, 11}, {last_rows, 1, 2}};
static const struct exh_signal_table par_table = {par_groups, 2};

static int32_t any_i32(struct golden_rng *r)
{
    return (int32_t)golden_draw(r, INT32_MIN, INT32_MAX);
}

void golden_box_setup(struct golden_box *b, struct golden_rng *r, struct exh_period T)
{
    static const char *const name[] = {NULL, "x", "bilateral", "seventeen letters"};
    const int no_trace = golden_draw(r, 0, 7) == 0;
    const int no_signals = golden_draw(r, 0, 15) == 0;
    exh_params_setup(&b->params, &par_table, b->active, b->wanted);
    for (uint32_t i = 0; i < BOX_SIGNALS; i++) { b->signal[i] = exh_from_u32(i * 0x9E3779B1u); }
    CHECK_EQ_I64(exh_trace_setup(&b->trace, b->frame, BOX_FRAMES, BOX_SIGNALS), 0);
    b->regs = (struct exh_regs){.name = name[golden_draw(r, 0, 3)],
        .signals = no_signals ? NULL : &out_table,
        .signal = b->signal,
        .params = &par_table,
        .active = b->active,
        .wanted = b->wanted,
        .staged = b->staged,
        .touched = b->touched,
        .T = T,
        .trace = no_trace ? NULL : &b->trace};
    b->regs.may = EXH_REGS_MAY | (uint32_t)golden_draw(r, 0, 63);
    b->regs.fingers = (uint8_t)golden_draw(r, 1, 5);
    CHECK_EQ_I64(exh_regs_setup(&b->regs), 0);
}

static int is_staged(const struct golden_box *b, uint32_t i)
{
    return (int)(b->touched[i >> 5] >> (i & 31) & 1);
}

static int32_t held(const struct golden_box *b, uint32_t i)
{
    return is_staged(b, i) ? b->staged[i] : b->wanted[i];
}

void golden_box_tick(struct golden_box *b, struct golden_rng *r, uint32_t k)
{
    const uint64_t u = golden_u64(r);
    const uint64_t v = golden_u64(r);
    struct exh_safety s;
    (void)memset(&s, 0, sizeof s);
    s.tick = (uint32_t)(u & UINT32_MAX);
    s.missed = (uint32_t)(u >> 32);
    s.first_tick = (uint32_t)(u >> 16 & UINT32_MAX);
    s.refused = (uint8_t)(u & 0x7F);
    s.share_q30 = (int32_t)(u >> 40 & 1);
    s.faults = (uint32_t)(v & 0x7FFF);
    s.present = (uint32_t)(v >> 15 & 0x7FFF);
    s.limits = (uint32_t)(v >> 30 & 0x7FF);
    s.first = (uint32_t)(v >> 41 & 0x7FFF);
    s.state = (uint8_t)(v >> 56 & 0x27);
    exh_regs_update(&b->regs, &s, (uint32_t)(u >> 8 & 0x1FFF));
    for (unsigned i = 0; i < 2; i++) {
        const int64_t at = golden_draw(r, 0, BOX_SIGNALS - 1);
        const int32_t any = any_i32(r);
        b->signal[at] = any >> golden_draw(r, 0, 31);
    }
    exh_trace_step(&b->trace, s.tick, b->signal);
    b->params.locked = (k + 3) >> 4 & 1; /* before the registers know */
    b->regs.locked = k >> 4 & 1;
    if (golden_draw(r, 0, 7) == 0) { /* another source stages a value */
        uint32_t i = (uint32_t)golden_draw(r, 0, BOX_PARAMS - 1);
        const struct exh_signal *row = exh_signal_at(&par_table, i, NULL);
        const int32_t any = (int32_t)golden_draw(r, row->min, row->max);
        const int same = golden_draw(r, 0, 1) == 0; /* as what is staged first from there on */
        while (same && i < BOX_PARAMS - 1 && !is_staged(b, i)) { i++; }
        (void)exh_params_stage_at(&b->params, i, same ? held(b, i) : any);
    }
}

/* --- what a request asks for --- */

struct place {
    uint32_t at, n;
};

/* A count at a limit, beside it, or of nothing. */
static uint32_t edge(struct golden_rng *r)
{
    static const uint32_t count[] = {
        0, 121, 122, 123, 124, 125, 126, 1968, 1969, 2000, 2001, 65535};
    return count[golden_draw(r, 0, 11)];
}

/* The same, of registers. */
static uint32_t edge_of(struct golden_rng *r, uint32_t function)
{
    static const uint32_t written[] = {123, 124, 0, 124}, both[] = {121, 122, 125, 126},
                          read[] = {125, 126, 0, 125};
    const int64_t i = golden_draw(r, 0, 3);
    return function == 16 ? written[i] : function == 23 ? both[i] : read[i];
}

/* A block: where it begins, its registers. */
static struct place block(struct golden_rng *r, uint32_t function)
{
    static const struct place held[16] = {{0x0400, 10}, {0x0400, 10}, {0x0400, 10}, {0x5000, 136},
        {0x5000, 136}, {0x5000, 136}, {0x5000, 136}, {0x5000, 136}, {0x7000, 136}, {0x7000, 136},
        {0x7000, 136}, {0x7000, 136}, {0x7000, 136}, {0x7000, 136}, {0x7000, 136}, {0, 65535}};
    static const struct place shown[16] = {{0x0000, 60}, {0x0000, 60}, {0x0400, 18}, {0x0440, 96},
        {0x0440, 96}, {0x1000, 128}, {0x1000, 128}, {0x3000, 128}, {0x3000, 128}, {0x5000, 136},
        {0x5000, 136}, {0x5000, 136}, {0x7000, 136}, {0x7000, 136}, {0x7000, 136}, {0, 65535}};
    const int64_t i = golden_draw(r, 0, 15);
    return function == 4 ? shown[i] : held[i];
}

/* Registers, mostly of a block and whole values of it. */
static struct place registers(struct golden_rng *r, uint32_t function)
{
    const struct place of = block(r, function);
    const int many = golden_draw(r, 0, 7) == 0;
    struct place p = {0, (uint32_t)golden_draw(r, 1, many ? 125 : 8)};
    const int at_edge = golden_draw(r, 0, 3) == 0;
    if (at_edge) { p.n = edge_of(r, function); }
    if (golden_draw(r, 0, 7) == 0) {
        p.at = (of.at + (uint32_t)golden_draw(r, 0, of.n + 4) - 2) & 0xFFFFu;
    } else {
        p.at = of.at + (uint32_t)golden_draw(r, 0, of.n > p.n ? of.n - p.n : 0);
    }
    if (golden_draw(r, 0, 3) != 0) {
        p.at &= 0xFFFEu;
        if (!at_edge) { p.n = (p.n + 1) & 0xFFFEu; }
    }
    return p;
}

/* --- what a request writes --- */

static uint32_t value_of_trace(struct golden_rng *r, uint32_t i)
{
    if (i == 0) { return (uint32_t)golden_draw(r, 0, 3); }
    if (golden_draw(r, 0, 7) == 0) {
        return (uint32_t)golden_draw(r, BOX_SIGNALS - 1, BOX_SIGNALS);
    }
    return (uint32_t)golden_draw(r, 0, BOX_SIGNALS - 1);
}

/* Mostly what may be. */
static uint32_t value_of_param(
    const struct golden_box *b, struct golden_rng *r, uint32_t i, int is_float)
{
    const struct exh_signal *row = exh_signal_at(&par_table, i, NULL);
    const int64_t how = golden_draw(r, 0, 255);
    int32_t raw = (int32_t)golden_draw(r, row->min, row->max);
    if (how == 0) { return (uint32_t)any_i32(r); }
    if (how == 1) { raw = (int32_t)exh_clamp((int64_t)row->max + 1, INT32_MIN, INT32_MAX); }
    if (how >= 2 && how < 16) { raw = row->min; }
    if (how >= 16 && how < 32) { raw = row->max; }
    if (how >= 32 && how < 48) { raw = row->dflt; }
    if (how >= 96 || (how >= 2 && b->regs.locked && row->when == EXH_WHEN_SETUP)) {
        raw = how < 128 ? b->wanted[i] : held(b, i);
    }
    return is_float ? exh_float_from_raw(raw, row->frac) : (uint32_t)raw;
}

static uint32_t value_at(const struct golden_box *b, struct golden_rng *r, uint32_t at)
{
    if (at - 0x0400u < 10) { return value_of_trace(r, (at - 0x0400u) >> 1); }
    if (at >= 0x5000u && at < 0x9000u && ((at - 0x1000u) & 0x1FFFu) < 2 * BOX_PARAMS) {
        return value_of_param(b, r, ((at - 0x1000u) & 0x1FFFu) >> 1, at >= 0x7000u);
    }
    return (uint32_t)any_i32(r);
}

static uint32_t put16(uint8_t *to, uint32_t len_B, uint32_t v)
{
    to[len_B] = (uint8_t)(v >> 8 & 0xFFu);
    to[len_B + 1] = (uint8_t)(v & 0xFFu);
    return len_B + 2;
}

/* What is written to these registers, of at most 130. */
static uint32_t put_words(
    const struct golden_box *b, struct golden_rng *r, struct place p, uint8_t *to, uint32_t len_B)
{
    uint32_t v = 0;
    for (uint32_t k = 0; k < p.n && k < 130; k++) {
        const uint32_t at = p.at + k;
        if (k == 0 || !(at & 1)) { v = value_at(b, r, at); }
        len_B = put16(to, len_B, at & 1 ? v : v >> 16);
    }
    return len_B;
}

/* --- requests --- */

static uint32_t ask_bits(struct golden_rng *r, uint8_t *to)
{
    const int64_t all = to[0] == 1 ? 6 : 192;
    struct place p;
    p.at = (uint32_t)golden_draw(r, 0, all - 1);
    p.n = (uint32_t)golden_draw(r, 1, all - p.at);
    if (golden_draw(r, 0, 7) == 0) { p.n++; }
    if (golden_draw(r, 0, 15) == 0) { p.n = edge(r); }
    return put16(to, put16(to, 1, p.at), p.n);
}

static uint32_t ask_coil(struct golden_rng *r, uint8_t *to)
{
    const uint32_t at = (uint32_t)golden_draw(r, 0, 6);
    const int64_t which = golden_draw(r, 0, 5);
    const uint32_t len_B = put16(to, 1,
        which < 2    ? EXH_COIL_APPLY
        : which == 2 ? EXH_COIL_DISCARD
                     : at);
    const int64_t how = golden_draw(r, 0, 7);
    const uint32_t any = (uint32_t)golden_draw(r, 0, 65535);
    return put16(to, len_B, how == 0 ? 0 : how == 1 ? any : 0xFF00u);
}

static uint32_t ask_coils(struct golden_rng *r, uint8_t *to)
{
    struct place p;
    uint32_t len_B;
    uint32_t bytes;
    p.at = (uint32_t)golden_draw(r, 0, 5);
    p.n = (uint32_t)golden_draw(r, 1, 6 - p.at);
    if (golden_draw(r, 0, 7) == 0) { p.n++; }
    if (golden_draw(r, 0, 7) == 0) { p.n = edge(r); }
    bytes = (p.n + 7) >> 3;
    len_B = put16(to, put16(to, 1, p.at), p.n);
    to[len_B++] = (uint8_t)(bytes & 0xFFu);
    for (uint32_t k = 0; k < bytes && k < 255; k++) { to[len_B++] = 0; }
    to[6] = (uint8_t)golden_draw(r, 0, 255);
    to[6] = (uint8_t)(to[6] & golden_draw(r, 0, 255));
    return len_B;
}

static uint32_t ask_write(const struct golden_box *b, struct golden_rng *r, uint8_t *to)
{
    const struct place p = registers(r, 16);
    uint32_t len_B = put16(to, put16(to, 1, p.at), p.n);
    to[len_B++] = (uint8_t)(2 * p.n & 0xFFu);
    return put_words(b, r, p, to, len_B);
}

static uint32_t ask_one(const struct golden_box *b, struct golden_rng *r, uint8_t *to)
{
    struct place p = registers(r, 6);
    p.n = 1;
    return put_words(b, r, p, to, put16(to, 1, p.at));
}

/* Any bits, all of them kept, or what could be written there. */
static uint32_t ask_mask(const struct golden_box *b, struct golden_rng *r, uint8_t *to)
{
    struct place p = registers(r, 22);
    const int64_t how = golden_draw(r, 0, 2);
    const uint32_t keep = (uint32_t)golden_draw(r, 0, 65535);
    uint32_t len_B = put16(to, put16(to, 1, p.at), how == 0 ? keep : how == 1 ? 0xFFFFu : 0);
    if (how == 0) { return put16(to, len_B, (uint32_t)golden_draw(r, 0, 65535)); }
    p.n = 1;
    return put_words(b, r, p, to, len_B);
}

static uint32_t ask_both(const struct golden_box *b, struct golden_rng *r, uint8_t *to)
{
    const struct place get = registers(r, 23);
    struct place put = registers(r, 23);
    uint32_t len_B = put16(to, put16(to, 1, get.at), get.n);
    if (golden_draw(r, 0, 1) == 0) {
        put = get;
        if (put.n > 122) { put.n = 122; }
    }
    len_B = put16(to, put16(to, len_B, put.at), put.n);
    to[len_B++] = (uint8_t)(2 * put.n & 0xFFu);
    return put_words(b, r, put, to, len_B);
}

static uint32_t ask_who(struct golden_rng *r, uint8_t *to)
{
    to[1] = golden_draw(r, 0, 3) == 0 ? 13 : 14;
    to[2] = (uint8_t)golden_draw(r, 0, 5);
    to[3] = (uint8_t)golden_draw(r, 0, 4);
    return 4;
}

static uint32_t whole(const struct golden_box *b, struct golden_rng *r, uint8_t *to)
{
    static const uint8_t function[32] = {1, 1, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 4, 5, 5, 5, 6, 6,
        15, 15, 15, 16, 16, 16, 16, 16, 22, 22, 23, 23, 43};
    to[0] = function[golden_draw(r, 0, 31)];
    if (golden_draw(r, 0, 31) == 0) { to[0] = (uint8_t)golden_draw(r, 0, 255); }
    switch (to[0]) {
    case 1:
    case 2: return ask_bits(r, to);
    case 5: return ask_coil(r, to);
    case 6: return ask_one(b, r, to);
    case 15: return ask_coils(r, to);
    case 16: return ask_write(b, r, to);
    case 22: return ask_mask(b, r, to);
    case 23: return ask_both(b, r, to);
    case 43: return ask_who(r, to);
    default: {
        const struct place p = registers(r, to[0]);
        return put16(to, put16(to, 1, p.at), p.n);
    }
    }
}

uint32_t golden_request(const struct golden_box *b, struct golden_rng *r, uint8_t *req)
{
    uint32_t len_B = whole(b, r, req);
    const int64_t how = golden_draw(r, 0, 31);
    const uint32_t count_at = req[0] == 16 ? 5 : 9;
    if (how == 0) { len_B = (uint32_t)golden_draw(r, 0, len_B); }
    if (how == 1) {
        const int64_t more = golden_draw(r, 1, 4);
        for (int64_t i = 0; i < more; i++) { req[len_B++] = 0; }
    }
    if (how == 2) {
        const int64_t at = golden_draw(r, 0, (int64_t)len_B - 1);
        req[at] = (uint8_t)(req[at] ^ UINT32_C(1) << golden_draw(r, 0, 7));
    }
    if (how > 2 && how < 6 && (req[0] == 16 || req[0] == 23) && len_B > count_at + 2) {
        len_B -= 2; /* one register fewer than it says */
        req[count_at] = (uint8_t)(req[count_at] - (how == 3 ? 0 : 2));
    }
    return len_B;
}

/* --- results --- */

void golden_put_bytes(struct golden *g, const uint8_t *p, uint32_t len_B)
{
    int64_t first = 0;
    for (uint32_t i = 0; i < 6; i++) { first = first << 8 | (i < len_B ? p[i] : 0); }
    golden_put(g, len_B);
    golden_put(g, first);
    golden_put(g, exh_crc32(0, p, len_B));
}

static void box_bytes(struct exh_bytes *c, struct golden_box *b)
{
    for (unsigned i = 0; i < EXH_REGS_WORDS(BOX_PARAMS); i++) { exh_bytes_u32(c, &b->touched[i]); }
    for (unsigned i = 0; i < BOX_PARAMS; i++) {
        exh_bytes_i32(c, &b->active[i]);
        exh_bytes_i32(c, &b->wanted[i]);
        exh_bytes_i32(c, is_staged(b, i) ? &b->staged[i] : &b->wanted[i]);
    }
    exh_bytes_u32(c, &b->trace.run);
    exh_bytes_u32(c, &b->trace.what.every);
}

void golden_box_between(struct golden *g, struct golden_box *b, struct golden_rng *r)
{
    uint8_t command = 0;
    uint8_t staged[4];
    struct exh_bytes c;
    CHECK_EQ_I64(exh_regs_read(&b->regs, EXH_REGS_INPUT, 2 * EXH_HEAD_STAGED, 2, staged), 0);
    golden_put(g, staged[3]);
    golden_put(g, b->regs.asked);
    if (golden_draw(r, 0, 1) != 0) {
        const uint32_t asked = exh_regs_poll(&b->regs);
        if (asked >> EXH_COIL_APPLY & 1) {
            exh_regs_complete(&b->regs, exh_regs_apply(&b->regs, &b->params));
        }
        if (asked >> EXH_COIL_SAVE & 1) { exh_regs_complete(&b->regs, -EXH_E_IO); }
        command = exh_regs_command(asked);
        if (command != EXH_CMD_NONE) { exh_regs_complete(&b->regs, 0); }
        (void)exh_params_apply(&b->params);
    }
    golden_put(g, command);
    golden_put(g, b->regs.done);
    golden_put(g, b->regs.result);
    c = golden_state(g);
    box_bytes(&c, b);
    golden_state_end(g, &c);
}
