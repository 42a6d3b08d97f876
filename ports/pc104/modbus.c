/* SPDX-License-Identifier: MIT */
/* The scene's registers on COM2, by the library's slave: modbus=com2,ADDRESS,BAUD[,write][,remote].
 * Polled once per tick after the outputs, a few characters at a time. Without the option COM2 is
 * not touched. The FIFO of 16 must not overflow between two ticks, nor run empty during a response,
 * since a gap would end the frame. So a baud rate with more than 14 characters per tick is refused.
 * The hardware hides the transmitter's fill level; software counts it, slightly too high. */
#include "pc104.h"

#include "box.h"
#include "io.h"
#include "uart.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/modbus_rtu.h"
#include "exhand/regs.h"

#include <string.h>

#define VALUES     1024u /* parameters of a scene */
#define TICK_B     14u   /* characters in a tick, at most */
#define REMOTE     (1u << EXH_COIL_RUN | 1u << EXH_COIL_CLEAR | 1u << EXH_COIL_OFF)
#define FORM       "com2,ADDRESS,BAUD[,write][,remote]"
#define COM2(what) ((uint16_t)(UART_COM2 + (what)))

static struct {
    int32_t address, baud;
    uint8_t asked_for, remote, write;
} par;

static struct exh_regs regs;
static struct exh_modbus_rtu line;
static struct exh_trace trace;
static struct exh_trace_frame frame[EXH_TRACE_FRAMES];
static const struct exh_scene *scene;
static struct exh_params *params;
static int (*scene_allows)(void);
static const struct exh_safety *safety;
static int32_t staged[VALUES];
static uint32_t touched[EXH_REGS_WORDS(VALUES)];

static uint8_t open;
static uint32_t tick_us, most; /* characters moved a tick, at most */
static uint32_t tick_B_q16;    /* characters that go out in a tick, a little too few */

static uint8_t answer[EXH_MODBUS_ADU_B];
static uint32_t answer_B, sent_B; /* sent_B < answer_B: there is more to send */
static uint32_t in_fifo_q16;
static uint8_t sending; /* until the last character is out */
static uint8_t command;
static uint32_t answers;

/* --- option --- */

static void refuse(const char *value, const char *why)
{
    pc104_say("option modbus=");
    pc104_say(value);
    pc104_say(": ");
    pc104_say(why);
    pc104_say("\n");
    pc104_halt(PC104_EXIT_OPTION, "option refused: nothing was started");
}

/* Copies the text up to the next comma to word; returns the rest, or NULL. */
static const char *word_of(const char *text, char word[12])
{
    unsigned n = 0;
    while (*text != '\0' && *text != ',') {
        if (n < 11) { word[n++] = *text; }
        text++;
    }
    word[n] = '\0';
    return *text == ',' ? text + 1 : NULL;
}

int pc104_modbus_option(const char *name, const char *value)
{
    char word[12];
    const char *rest;
    if (!pc104_same_text(name, "modbus")) { return 0; }
    rest = word_of(value, word);
    if (!pc104_same_text(word, "com2") || rest == NULL) { refuse(value, FORM); }
    rest = word_of(rest, word);
    if (pc104_number(word, 0, &par.address) < 0 || par.address < 1 || par.address > 247) {
        refuse(value, "address 1..247");
    }
    if (rest == NULL) { refuse(value, FORM); }
    rest = word_of(rest, word);
    if (pc104_number(word, 0, &par.baud) < 0 || par.baud < 1200 || par.baud > 115200 ||
        exh_udiv64(UART_BASE_BAUD, (uint32_t)par.baud, NULL) * (uint32_t)par.baud !=
            UART_BASE_BAUD) {
        refuse(value, "baud: 115200 and whole parts of it, down to 1200");
    }
    par.write = par.remote = 0;
    while (rest != NULL) {
        uint8_t *may;
        rest = word_of(rest, word);
        may = pc104_same_text(word, "write")    ? &par.write
              : pc104_same_text(word, "remote") ? &par.remote
                                                : NULL;
        if (may == NULL) { refuse(value, FORM); }
        *may = 1;
    }
    par.asked_for = 1;
    return 1;
}

/* Each would take what is meant for the other. */
void pc104_modbus_check(const struct exh_scene *sc)
{
    if (par.asked_for) { pc104_box_leave(sc, "modbus", UART_COM2, COM2(UART_SCRATCH)); }
}

/* --- start --- */

static int is_there(void)
{
    static const uint8_t pattern[] = {0x5A, 0xA5};
    for (unsigned i = 0; i < sizeof pattern; i++) {
        pc104_out8(COM2(UART_SCRATCH), pattern[i]);
        if (pc104_in8(COM2(UART_SCRATCH)) != pattern[i]) { return 0; }
    }
    return 1;
}

static void map(const struct exh_scene *sc)
{
    memset(&regs, 0, sizeof regs);
    regs.name = sc->name;
    scene = sc;
    regs.signals = sc->values ? sc->signals : NULL;
    regs.signal = sc->values;
    regs.fingers = sc->fingers;
    regs.may = (par.write ? EXH_REGS_MAY : 0u) | (par.remote ? REMOTE : 0u);
    params = sc->params;
    scene_allows = sc->allowed;
    safety = sc->safety;
    if (params == NULL) { return; }
    regs.params = params->table;
    regs.active = params->active;
    regs.wanted = params->staged;
    regs.staged = staged;
    regs.touched = touched;
}

/* As many characters as come in a tick at this rate, and two: what is moved in one. */
static uint32_t most_of(uint32_t num, uint32_t den)
{
    const uint32_t n =
        (uint32_t)exh_udiv64((uint64_t)(uint32_t)par.baud * num, UINT64_C(10) * den, NULL) + 2;
    return n < UART_FIFO_B ? n : UART_FIFO_B;
}

void pc104_modbus_open(const struct exh_scene *sc)
{
    const uint32_t rate_Hz = pc104_par.rate_Hz ? (uint32_t)pc104_par.rate_Hz : sc->rate_Hz;
    if (!par.asked_for) { return; }
    map(sc);
    if ((params && exh_signal_count(params->table) > VALUES) || exh_regs_setup(&regs) < 0) {
        pc104_halt(
            PC104_EXIT_OPTION, "option modbus: the scene's tables are larger than this port's map");
    }
    if (safety && exh_trace_setup(&trace, frame, EXH_TRACE_FRAMES, regs.signals_n) == 0) {
        regs.trace = &trace;
    }
    (void)exh_modbus_rtu_setup(&line, (uint32_t)par.address, (uint32_t)par.baud);
    most = most_of(1, rate_Hz);
    if (!is_there() || !pc104_uart_set(UART_COM2,
                           (uint16_t)exh_udiv64(UART_BASE_BAUD, (uint32_t)par.baud, NULL))) {
        pc104_say("modbus: no 16550 with a FIFO at COM2: goes on without\n");
        return;
    }
    open = 1;
    pc104_say("modbus: COM2, 8N1, address ");
    pc104_say_u32((uint32_t)par.address);
    pc104_say(", baud ");
    pc104_say_u32((uint32_t)par.baud);
    pc104_say("\n");
}

/* A tick must be no longer than TICK_B characters. Says what would do. */
static void check_rate(struct exh_period T)
{
    const uint64_t allowed = exh_udiv64(UINT64_C(10) * TICK_B * T.den, T.num, NULL);
    uint32_t divisor = 1;
    if ((uint32_t)par.baud <= allowed) { return; }
    while (UART_BASE_BAUD > allowed * divisor && divisor < 96) { divisor *= 2; }
    pc104_say("option modbus: baud ");
    pc104_say_u32((uint32_t)par.baud);
    pc104_say(": its FIFO overflows in a tick of this rate: take at most ");
    pc104_say_u32((uint32_t)exh_udiv64(UART_BASE_BAUD, divisor, NULL));
    pc104_say(", or a rate of at least ");
    pc104_say_u32((uint32_t)exh_udiv64((uint32_t)par.baud + 10 * TICK_B - 1, 10 * TICK_B, NULL));
    pc104_say(" Hz\n");
    pc104_halt(PC104_EXIT_OPTION, "option refused: nothing was started");
}

void pc104_modbus_start(struct exh_scene_board board)
{
    if (!par.asked_for) { return; }
    check_rate(board.T); /* also where there is no UART: it may be found tomorrow */
    if (!open) { return; }
    regs.T = board.T;
    most = most_of(board.T.num, board.T.den);
    tick_us = (uint32_t)exh_udiv64(UINT64_C(1000000) * board.T.num, board.T.den, NULL);
    /* 99 % of what the line takes */
    tick_B_q16 = (uint32_t)exh_udiv64((UINT64_C(99) << 16) * (uint32_t)par.baud * board.T.num,
        UINT64_C(1000) * board.T.den, NULL);
    pc104_out8(COM2(UART_FIFO), UART_FIFO_EMPTY); /* earlier characters are no request */
}

/* --- ticks --- */

uint8_t pc104_modbus_command(void)
{
    const uint8_t now = command;
    command = EXH_CMD_NONE;
    return now;
}

/* All that is staged or nothing: a scene's rule judges the values together. */
static int apply(void)
{
    static int32_t was[VALUES];
    uint8_t pending;
    int err;
    if (params == NULL) { return 0; }
    pending = params->pending;
    memcpy(was, params->staged, 4 * (size_t)params->count);
    if (safety) { regs.box.state = safety->state; } /* it may run by now */
    err = exh_regs_apply(&regs, params);
    if (err == 0 && scene_allows) { err = scene_allows(); }
    if (err < 0) { exh_params_rollback(params, was, pending); }
    return err;
}

/* Carries out the commands of a request, between two ticks. */
static void carry_out(void)
{
    const uint32_t asked = exh_regs_poll(&regs);
    const uint8_t wanted = exh_regs_command(asked);
    if (asked >> EXH_COIL_APPLY & 1u) { exh_regs_complete(&regs, apply()); }
    if (wanted == EXH_CMD_NONE) { return; }
    command = wanted;
    exh_regs_complete(&regs, 0);
}

/* Receives nothing meanwhile: the client waits for this answer, and later bytes wait in the
 * FIFO. */
static void send(void)
{
    const uint8_t status = pc104_in8(COM2(UART_STATUS));
    if (sent_B == answer_B) {
        sending = !(status & UART_STATUS_SILENT);
        return;
    }
    in_fifo_q16 =
        (status & UART_STATUS_EMPTY) || in_fifo_q16 < tick_B_q16 ? 0 : in_fifo_q16 - tick_B_q16;
    for (uint32_t i = 0; i < most && sent_B < answer_B && in_fifo_q16 <= (UART_FIFO_B - 1) << 16;
         i++) {
        pc104_out8(COM2(UART_DATA), answer[sent_B++]);
        in_fifo_q16 += 1u << 16;
    }
}

static uint32_t hear(void)
{
    uint32_t n = 0;
    for (; n < most; n++) {
        const uint8_t status = pc104_in8(COM2(UART_STATUS));
        if (!(status & UART_STATUS_READY)) { break; }
        if (status & UART_STATUS_BAD) { exh_modbus_rtu_discard(&line); }
        exh_modbus_rtu_receive(&line, pc104_in8(COM2(UART_DATA)));
    }
    return n;
}

void pc104_modbus_poll(const struct exh_scene_in *in)
{
    if (!open) { return; }
    if (exh_trace_reads(&trace)) { (void)exh_scene_signals(scene); }
    if (regs.trace) { exh_trace_step(&trace, safety->tick, regs.signal); }
    if (sending) {
        send();
        return;
    }
    if (hear() > 0 || !exh_modbus_rtu_poll(&line, tick_us * (1u + in->missed))) { return; }
    if (safety) { exh_regs_update(&regs, safety, in->drive.din); }
    regs.locked = params ? params->locked : 0;
    (void)exh_scene_signals(scene); /* a request may read them */
    answer_B = (uint32_t)exh_modbus_rtu_answer(&line, &regs, answer, sizeof answer);
    sent_B = 0;
    in_fifo_q16 = 0;
    sending = answer_B > 0;
    answers += sending;
    carry_out();
}

/* --- what it costs --- */

#define MOST_READ    125u /* registers; of those that function 23 writes, whole numbers */
#define MOST_WRITTEN 120u

static struct exh_modbus_rtu dearest, apply_all; /* requests that have just come whole */

static void request(struct exh_modbus_rtu *u, const uint8_t *byte, uint32_t len_B)
{
    const uint16_t crc = exh_crc16(byte, len_B);
    (void)exh_modbus_rtu_setup(u, 1, (uint32_t)par.baud);
    for (uint32_t i = 0; i < len_B; i++) { exh_modbus_rtu_receive(u, byte[i]); }
    exh_modbus_rtu_receive(u, (uint8_t)(crc & 0xFFu));
    exh_modbus_rtu_receive(u, (uint8_t)(crc >> 8));
}

static void dry_answer(const struct exh_modbus_rtu *asked)
{
    static struct exh_modbus_rtu twin;
    twin = *asked;
    (void)exh_modbus_rtu_poll(&twin, UINT32_MAX);
    (void)exh_modbus_rtu_answer(&twin, &regs, answer, sizeof answer);
}

/* Function 23 reads as much as any, twice, and writes nearly as much as 16. Its values are
 * mid-range and new. */
static void prepare(void)
{
    static const uint8_t coil[] = {1, 5, 0, EXH_COIL_APPLY, 0xFF, 0};
    static uint8_t ask[11 + 2 * MOST_WRITTEN] = {1, 23};
    const uint32_t all = 2 * regs.params_n;
    const uint32_t get = all < MOST_READ ? all : MOST_READ,
                   put = all < MOST_WRITTEN ? all : MOST_WRITTEN;
    ask[2] = ask[6] = EXH_REGS_PARAM_FLOAT_AT >> 8;
    ask[5] = (uint8_t)get;
    ask[9] = (uint8_t)put;
    ask[10] = (uint8_t)(2 * put);
    for (uint32_t i = 0; i < put / 2; i++) {
        const struct exh_signal *row = exh_signal_at(regs.params, i, NULL);
        const int32_t raw = row->when == EXH_WHEN_PERSON || row->when == EXH_WHEN_WORD
                                ? params->staged[i]
                                : row->min / 2 + row->max / 2;
        const uint32_t bits = exh_float_from_raw(raw, row->frac);
        for (uint32_t k = 0; k < 4; k++) { ask[11 + 4 * i + k] = (uint8_t)(bits >> (24 - 8 * k)); }
    }
    request(&dearest, ask, 11 + 2 * put);
    request(&apply_all, coil, sizeof coil);
    dry_answer(&dearest);
    if (put > 0 && answer[1] != 23) {
        pc104_say("modbus: the dearest request is refused: not in the budget\n");
    }
}

/* All values, and a rule that refuses them in the end; none is another. */
static void dry_apply(void)
{
    const uint8_t pending = params->pending;
    memcpy(staged, params->staged, 4 * (size_t)regs.params_n);
    memset(touched, 0xFF, 4 * (size_t)EXH_REGS_WORDS(regs.params_n));
    dry_answer(&apply_all);
    carry_out();
    exh_params_rollback(params, params->staged, pending);
}

/* A tick does at most one of these. A request is answered in a tick without a character, and none
 * is received before the answer is sent. Without an answer, the next silence is a tick away. */
int pc104_modbus_dry(unsigned part)
{
    const struct exh_regs before = regs;
    if (!open) { return 0; }
    if (part > 1 || params == NULL) {
        for (uint32_t i = 0; i < 2 * most + 1; i++) { (void)pc104_in8(COM2(UART_STATUS)); }
        return params != NULL;
    }
    regs.may |= EXH_REGS_MAY; /* so that one budget is right for both */
    if (dearest.len_B == 0) { prepare(); }
    (void)pc104_in8(COM2(UART_STATUS));
    if (part == 0) {
        dry_answer(&dearest);
    } else {
        dry_apply();
    }
    memset(touched, 0, 4 * (size_t)EXH_REGS_WORDS(regs.params_n));
    regs = before;
    return 0;
}

void pc104_modbus_report(void)
{
    if (!open) { return; }
    pc104_say("modbus answers ");
    pc104_say_u32(answers);
    pc104_say(", damaged ");
    pc104_say_u32(line.damaged);
    pc104_say(", for others ");
    pc104_say_u32(line.others);
    pc104_say(", refused ");
    pc104_say_u32(regs.refused);
    pc104_say("\n");
}
