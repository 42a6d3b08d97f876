/* SPDX-License-Identifier: MIT */
/* Wiring, opening and the tick of the box. What is refused of a configuration is config.c. */
#include "box.h"

#include "exhand/error.h"

#include <string.h>

/* --- wiring: this is all of it (docs/CARDS.md) --- */

struct place {
    uint8_t card, at; /* at: counter and D/A and A/D channel, or pin, or A/D channel */
};
struct wiring {
    struct place axis[EXH_FINGERS], ready[EXH_FINGERS], enable[EXH_FINGERS];
    struct place estop, deadman, watchdog, alive, supply;
};

#define A(n) \
    { \
        EXH_BOX_A, n \
    }
#define B(n) \
    { \
        EXH_BOX_B, n \
    }
static const struct wiring one_finger = {
    .axis = {A(0)},
    .ready = {A(0)},
    .enable = {A(4)},
    .estop = A(1),
    .deadman = A(2),
    .watchdog = A(3),
    .alive = A(5),
    .supply = A(4),
};
static const struct wiring all_fingers = {
    .axis = {A(0), A(1), A(2), A(3), B(0)},
    .ready = {A(0), A(1), A(2), A(3), B(0)},
    .enable = {A(4), A(5), A(6), A(7), B(4)},
    .estop = B(1),
    .deadman = B(2),
    .watchdog = B(3),
    .alive = B(5),
    .supply = B(4),
};
#undef A
#undef B

static struct {
    struct exh_box_config cfg;
    const struct wiring *wiring;
    struct exh_s526 s526[2];
    struct exh_mm32xat mm32xat;
    unsigned boards;       /* S526 in use */
    unsigned axes[2];      /* fingers on each */
    uint8_t lines_off[2];  /* output pins with nothing active */
    uint8_t open, started; /* started: an A/D scan begun by the last read */
    struct exh_box_error error;
    struct exh_box_counts counts;
    int16_t frame[EXH_MM32XAT_CHANNELS]; /* the last of the glove */
    uint32_t frame_read, scan_read;      /* counts.reads when it and the running scan began */
    uint8_t framed, fresh;               /* fresh: taken in parts, and not yet handed over */
    int16_t ad_code[2][EXH_S526_AD];     /* as last converted */
    volatile uint32_t safe_calls;
} box;

void exh_box_safe(void)
{
    box.safe_calls++;
    exh_s526_safe(box.s526, 2);
}

/* Outputs first, then the words. The first fault stays. */
static int fail(unsigned card, uint16_t base, int code, const struct exh_card_fault *f)
{
    exh_box_safe();
    if (box.error.code == 0) {
        box.error.code = (int16_t)code;
        box.error.card = (uint8_t)card;
        box.error.base = base;
        box.error.fault = *f;
    }
    return code;
}

/* Of an S526 in a tick; one that died answers all sorts of questions wrongly. */
static int board_fails(unsigned i, int err, struct exh_card_fault *f)
{
    struct exh_card_fault dead = *f;
    exh_box_safe();
    if (exh_s526_alive(&box.s526[i], &dead) < 0 && dead.what == EXH_CARD_EMPTY) {
        f->what = dead.what;
        f->lo = f->hi = 0;
    }
    return fail(i, box.s526[i].base, err, f);
}

/* --- opening --- */

static void wire(const struct exh_box_config *c)
{
    const struct wiring *w = c->fingers == 1 && !c->full ? &one_finger : &all_fingers;
    box.cfg = *c;
    box.wiring = w;
    box.boards = w == &one_finger ? 1 : 2;
    for (unsigned i = 0; i < 2; i++) {
        box.axes[i] = 0;
        box.lines_off[i] = c->out_invert[i];
    }
    for (unsigned i = 0; i < c->fingers; i++) { box.axes[w->axis[i].card]++; }
}

/* A/D channels of a board: its fingers' monitors, and the supply where it is wired. */
static unsigned ad_mask(unsigned board)
{
    unsigned mask = 0;
    if (box.cfg.monitor == EXH_BOX_NEVER) { return 0; }
    for (unsigned i = 0; i < box.cfg.fingers; i++) {
        if (box.wiring->axis[i].card == board) { mask |= 1u << box.wiring->axis[i].at; }
    }
    if (box.cfg.supply && box.wiring->supply.card == board) { mask |= 1u << box.wiring->supply.at; }
    return mask;
}

static void note(
    struct exh_box_report *r, unsigned card, uint16_t base, int err, const struct exh_card_fault *f)
{
    if (err < 0) { (void)fail(card, base, err, f); }
    if (r == NULL) { return; }
    r->used[card] = 1;
    r->base[card] = base;
    r->error[card].code = (int16_t)err;
    r->error[card].card = (uint8_t)card;
    r->error[card].base = base;
    if (err < 0) { r->error[card].fault = *f; }
}

static void forget(struct exh_box_report *report)
{
    static const struct exh_box_counts no_counts;
    static const struct exh_box_error no_error;
    exh_box_safe();
    box.open = box.started = box.framed = box.fresh = 0;
    box.counts = no_counts;
    box.error = no_error;
    box.frame_read = box.scan_read = 0;
    memset(box.frame, 0, sizeof box.frame);
    for (unsigned i = 0; i < 2; i++) { box.s526[i].live = 0; }
    if (report) {
        static const struct exh_box_report nothing;
        *report = nothing;
    }
}

/* Wired for five fingers, though the configuration says for one? Then e-stop and dead-man would
 * be read where two drives say that they are ready, and alive would enable a third. */
static int other_wiring(const struct exh_box_config *c)
{
    const uint16_t a = c->s526_base[0], b = c->s526_base[1];
    uint16_t got;
    if (box.wiring != &one_finger || a == b || (b & 0x3Fu) != 0 || b < 0x100) { return 0; }
    return exh_s526_is_there(b, &got);
}

static void ad_start(void)
{
    for (unsigned i = 0; i < box.boards; i++) {
        if (box.s526[i].ad_mask) { exh_s526_ad_start(&box.s526[i]); }
    }
    box.started = 1;
}

static void glove_start(void)
{
    exh_mm32xat_start(&box.mm32xat);
    box.scan_read = box.counts.reads;
}

static int in_parts(void) { return box.cfg.glove == EXH_BOX_LAST && box.cfg.mm32xat.slice > 0; }

/* Begins the conversions that the first tick reads, so that this tick does not wait for them. A
 * scan that is read in parts begins at the first request. */
static void start(void)
{
    box.open = 1;
    if (box.cfg.monitor == EXH_BOX_LAST) { ad_start(); }
    if (box.cfg.glove == EXH_BOX_LAST && !in_parts()) { glove_start(); }
}

int exh_box_open(const struct exh_box_config *config, struct exh_box_report *report)
{
    struct exh_card_fault f = {EXH_CARD_CONFIG, 0, 0, 0, 0, 0};
    int32_t value = 0;
    unsigned row;
    forget(report);
    row = exh_box_check(config, &value);
    if (row == EXH_BOX_ROWS) {
        wire(config);
        value = config->full;
        if (other_wiring(config)) { row = EXH_BOX_ROW_FULL; }
    }
    if (row != EXH_BOX_ROWS) {
        (void)exh_card_fault(&f, EXH_CARD_BAD_VALUE, row, value, 0, 0);
        return fail(EXH_BOX_CARDS, 0, -EXH_E_RANGE, &f);
    }
    for (unsigned i = 0; i < box.boards; i++) {
        const int err = exh_s526_open(
            &box.s526[i], config->s526_base[i], ad_mask(i), box.lines_off[i], &config->s526, &f);
        note(report, i, config->s526_base[i], err, &f);
        if (report) { report->s526[i] = box.s526[i].id; }
    }
    if (config->glove != EXH_BOX_NEVER) {
        const int err = exh_mm32xat_open(&box.mm32xat, config->mm32xat_base, &config->mm32xat, &f);
        note(report, EXH_BOX_GLOVE, config->mm32xat_base, err, &f);
    }
    if (box.error.code == 0) { start(); }
    return box.error.code;
}

/* --- inputs --- */

static void counts_in(struct exh_drive_in *in)
{
    for (unsigned i = 0; i < box.cfg.fingers; i++) {
        const struct place p = box.wiring->axis[i];
        in->enc_raw[i] = exh_s526_follow(&box.s526[p.card], p.at);
    }
}

static uint32_t level(const uint8_t *pins, struct place p) { return pins[p.card] >> p.at & 1u; }

static uint32_t din(const uint8_t *pins)
{
    const struct wiring *w = box.wiring;
    uint32_t bits = EXH_DIN_CARDS | /* the failed glove delivers no frame */
                    level(pins, w->estop) * EXH_DIN_ESTOP |
                    level(pins, w->deadman) * EXH_DIN_DEADMAN;
    if (!box.cfg.watchdog || level(pins, w->watchdog)) { bits |= EXH_DIN_WATCHDOG; }
    for (unsigned i = 0; i < box.cfg.fingers; i++) {
        bits |= level(pins, w->ready[i]) * (uint32_t)EXH_DIN_DRIVE0 << i;
    }
    return bits;
}

/* Lines and quadrature errors of one board. */
static int lines_in(unsigned i, uint8_t *pins, struct exh_card_fault *f)
{
    int err = exh_s526_lines(&box.s526[i], pins, f);
    *pins ^= box.cfg.din_invert[i];
    if (err == 0 && box.axes[i]) { err = exh_s526_check(&box.s526[i], box.axes[i], f); }
    return err;
}

/* Results of the scan; a board without one is asked whether it is still there. What it answered
 * before, it answered if it is. */
static int monitors_in(unsigned i, struct exh_card_fault *f)
{
    return box.s526[i].ad_mask ? exh_s526_ad_read(&box.s526[i], box.ad_code[i], f)
                               : exh_s526_alive(&box.s526[i], f);
}

static void monitors_out(struct exh_drive_in *in)
{
    const struct place s = box.wiring->supply;
    if (box.cfg.monitor == EXH_BOX_NEVER) { return; }
    for (unsigned i = 0; i < box.cfg.fingers; i++) {
        in->mon_raw[i] = box.ad_code[box.wiring->axis[i].card][box.wiring->axis[i].at];
    }
    if (box.cfg.supply) { in->supply_raw = box.ad_code[s.card][s.at]; }
}

/* --- glove --- */

static void glove_framed(void)
{
    box.frame_read = box.scan_read;
    box.framed = 1;
    box.counts.glove_frames++;
}

/* Of a scan that ended a part a tick, so that no tick has all of it. */
static int glove_some(void)
{
    struct exh_card_fault f = {EXH_CARD_SCAN, 0, 0, 0, 0, 0};
    int got;
    if (!in_parts()) { return 0; }
    got = exh_mm32xat_some(&box.mm32xat, box.frame, &f);
    if (got > 0) {
        box.fresh = 1;
        glove_framed();
    }
    return got < 0 ? fail(EXH_BOX_GLOVE, box.mm32xat.base, got, &f) : 0;
}

/* The conversion runs while the counters are read. */
int exh_box_read_drive(struct exh_drive_in *in)
{
    static const struct exh_drive_in nothing;
    struct exh_card_fault f = {0, 0, 0, 0, 0, 0};
    uint8_t pins[2] = {0, 0};
    *in = nothing;
    if (box.error.code) { return -EXH_E_IO; }
    if (!box.open) { return -EXH_E_ABSENT; }
    if (!box.started) { ad_start(); }
    counts_in(in);
    for (unsigned i = 0; i < box.boards; i++) {
        const int err = lines_in(i, &pins[i], &f);
        if (err < 0) { return board_fails(i, err, &f); }
    }
    for (unsigned i = 0; i < box.boards; i++) {
        const int err = monitors_in(i, &f);
        if (err < 0) { return board_fails(i, err, &f); }
    }
    box.started = 0;
    if (box.cfg.monitor == EXH_BOX_LAST) { ad_start(); }
    in->din = din(pins);
    monitors_out(in);
    box.counts.reads++;
    return glove_some();
}

/* --- outputs --- */

static uint16_t clamped(uint16_t raw)
{
    const int32_t zero = EXH_S526_DA_ZERO, span = box.cfg.dac_span_raw;
    if (raw >= zero - span && raw <= zero + span) { return raw; }
    box.counts.clamped++;
    return (uint16_t)(raw < zero ? zero - span : zero + span);
}

/* What the scene takes for 0 A has to be that here, before a drive is enabled on top of it: its
 * limits of current count from there. */
static int at_rest(const struct exh_drive_out *out)
{
    const int32_t zero = EXH_S526_DA_ZERO, rest = box.cfg.dac_rest_raw;
    struct exh_card_fault f = {EXH_CARD_CONFIG, 0, 0, 0, 0, 0};
    for (unsigned i = 0; i < box.cfg.fingers; i++) {
        const int32_t raw = out->dac_raw[i];
        if (out->enable >> i & 1u || (raw >= zero - rest && raw <= zero + rest)) { continue; }
        (void)exh_card_fault(&f, EXH_CARD_REST, i, raw, zero - rest, zero + rest);
        return fail(EXH_BOX_CARDS, 0, -EXH_E_IO, &f);
    }
    return 0;
}

static void put_lines(const struct exh_drive_out *out)
{
    const struct wiring *w = box.wiring;
    unsigned lines[2] = {0, 0};
    for (unsigned i = 0; i < box.cfg.fingers; i++) {
        lines[w->enable[i].card] |= (out->enable >> i & 1u) << w->enable[i].at;
    }
    lines[w->alive.card] |= (out->alive & 1u) << w->alive.at;
    for (unsigned i = 0; i < box.boards; i++) {
        exh_s526_lines_put(&box.s526[i], lines[i] ^ box.lines_off[i]);
    }
}

/* exh_box_safe() may interrupt this function between any two accesses. The rest of the function
 * would overwrite the safe values. So safe_calls is compared before each output takes effect, and
 * at the end exh_box_safe() is called again. */
int exh_box_write_drive(const struct exh_drive_out *out)
{
    const uint32_t calls = box.safe_calls;
    if (box.error.code) {
        exh_box_safe();
        return -EXH_E_IO;
    }
    if (!box.open) { return -EXH_E_ABSENT; }
    if (at_rest(out) < 0) { return -EXH_E_IO; }
    for (unsigned i = 0; i < box.cfg.fingers; i++) {
        const struct place p = box.wiring->axis[i];
        exh_s526_da_put(&box.s526[p.card], p.at, clamped(out->dac_raw[i]));
    }
    if (box.safe_calls == calls) {
        for (unsigned i = 0; i < box.boards; i++) {
            if (box.axes[i]) { exh_s526_da_start(&box.s526[i]); }
        }
    }
    if (box.safe_calls == calls) { put_lines(out); }
    if (box.safe_calls != calls) {
        box.counts.overtaken++;
        exh_box_safe();
    }
    return 0;
}

/* --- glove, on request --- */

/* Takes the scan that runs, if it has ended or is worth waiting for. */
static int glove_take(struct exh_card_fault *f)
{
    struct exh_mm32xat *m = &box.mm32xat;
    int got;
    if (in_parts()) {                                 /* no wait, not even for the first */
        if (m->running) { box.counts.glove_waits++; } /* begun at the last request */
        box.fresh = 0;
        if (!m->running) { glove_start(); }
        return 0;
    }
    if (box.cfg.glove == EXH_BOX_LAST && m->running) {
        got = exh_mm32xat_done(m, f);
        if (got == 0) { box.counts.glove_waits++; }
        if (got <= 0) { return got; }
    } else {
        glove_start();
        got = exh_mm32xat_wait(m, f);
        if (got < 0) { return got; }
    }
    got = exh_mm32xat_read(m, box.frame, f);
    if (got < 0) { return got; }
    if (got > 0) { glove_framed(); }
    if (box.cfg.glove == EXH_BOX_LAST) { glove_start(); }
    return 0;
}

int exh_box_read_glove(struct exh_glove_in *in)
{
    struct exh_card_fault f = {EXH_CARD_SCAN, 0, 0, 0, 0, 0};
    uint32_t age;
    int err;
    if (box.error.code) { return -EXH_E_IO; }
    if (!box.open || box.cfg.glove == EXH_BOX_NEVER) { return -EXH_E_ABSENT; }
    err = glove_take(&f);
    if (err < 0) { return fail(EXH_BOX_GLOVE, box.mm32xat.base, err, &f); }
    age = box.framed ? box.counts.reads - box.frame_read : UINT16_MAX;
    memcpy(in->raw, box.frame, sizeof in->raw);
    in->age_ticks = (uint16_t)(age < UINT16_MAX ? age : UINT16_MAX);
    return 0;
}

/* --- what happened --- */

const struct exh_box_error *exh_box_error(void) { return &box.error; }

void exh_box_counts(struct exh_box_counts *counts)
{
    *counts = box.counts;
    for (unsigned i = 0; i < EXH_FINGERS; i++) { counts->quad[i] = 0; }
    if (box.wiring) {
        for (unsigned i = 0; i < box.cfg.fingers; i++) {
            const struct place p = box.wiring->axis[i];
            counts->quad[i] = box.s526[p.card].quad[p.at];
        }
    }
    counts->glove_short = box.mm32xat.shorts;
    counts->glove_long = box.mm32xat.longs;
    counts->glove_overflow = box.mm32xat.overflows;
}
