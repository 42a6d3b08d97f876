/* SPDX-License-Identifier: MIT */
/* The registers of a box, read as a Modbus client. */
#include "live/watch.h"

#include "slave/libmodbus.h"
#include "base/option.h"
#include "base/until.h"

#include <arpa/inet.h>
#include <errno.h>
#include <string.h>

#define WHERE_B  256
#define ADDRESS  1                                /* on a serial line */
#define AT_ONCE  (MODBUS_MAX_READ_REGISTERS / 2u) /* values a request */
#define AGAIN_S  1.0                              /* between attempts at a link that is gone */
#define REPLY_US 500000

static struct {
    modbus_t *ctx;
    int connected, known; /* known: it was the right box once */
    double tried_s;
    int traces;         /* the trace is ours */
    uint32_t run, next; /* ours, and its frame that is to be read next */
} client;

static uint32_t value_of(const uint16_t *word, unsigned i)
{
    return (uint32_t)word[2 * i] << 16 | word[2 * i + 1];
}

/* --- opening --- */

static int bad(const char *where)
{
    cli_complain("--modbus: %s: give tcp:ADDRESS:PORT (as tcp:127.0.0.1:1502) or rtu:DEVICE:BAUD "
                 "(as rtu:/dev/ttyUSB0:115200; 300..4000000)",
        where);
    return 2;
}

static modbus_t *context_of(const char *where)
{
    char text[WHERE_B];
    struct in_addr any;
    long number;
    if (strlen(where) >= sizeof text) { return NULL; }
    strcpy(text, where);
    if (strncmp(text, "tcp:", 4) == 0) {
        number = modbus_cut_number(text, 65535);
        if (number < 1 || inet_pton(AF_INET, text + 4, &any) != 1) { return NULL; }
        return modbus_new_tcp(text + 4, (int)number);
    }
    number = modbus_cut_number(text, 4000000);
    if (strncmp(text, "rtu:", 4) != 0 || number < 300 || text[4] == '\0') { return NULL; }
    return modbus_new_rtu(text + 4, (int)number, 'E', 8, 1);
}

static int link_up(void)
{
    client.tried_s = until_now_s();
    client.connected = modbus_connect(client.ctx) == 0;
    return client.connected;
}

int watch_modbus_open(const char *where)
{
    client.ctx = context_of(where);
    if (client.ctx == NULL) { return bad(where); }
    (void)modbus_set_slave(client.ctx, ADDRESS);
    (void)modbus_set_response_timeout(client.ctx, 0, REPLY_US);
    if (link_up()) { return 0; }
    cli_complain("--modbus: %s: %s: is the box there, and does it serve (exhand run --modbus)?",
        where, modbus_strerror(errno));
    return 3;
}

void watch_modbus_close(void)
{
    if (client.ctx == NULL) { return; }
    modbus_close(client.ctx);
    modbus_free(client.ctx);
    client.ctx = NULL;
}

/* --- reading --- */

static int lose(struct watch_box *b)
{
    b->trouble = modbus_strerror(errno);
    b->breaks += b->heard > 0;
    modbus_close(client.ctx);
    client.connected = client.known = client.traces = 0; /* it may be another box */
    return 0;
}

/* Once it is the right box there is no need to look again, until it has been away. */
static int know(struct watch_box *b, const uint16_t *word)
{
    char name[17] = {0};
    if (value_of(word, EXH_HEAD_MAGIC) != EXH_REGS_MAGIC ||
        value_of(word, EXH_HEAD_TEST_INT) != 0x12345678u ||
        value_of(word, EXH_HEAD_VERSION) >> 16 != EXH_REGS_VERSION >> 16) {
        cli_complain(
            "--modbus: what is there is no box of this map: magic %08lx, version %08lx: give "
            "another address",
            (unsigned long)value_of(word, EXH_HEAD_MAGIC),
            (unsigned long)value_of(word, EXH_HEAD_VERSION));
        return 1;
    }
    for (unsigned i = 0; i < 16; i++) {
        name[i] = (char)(value_of(word, EXH_HEAD_NAME_0 + i / 4) >> (24 - 8 * (i % 4)) & 0xFFu);
    }
    b->T.num = value_of(word, EXH_HEAD_PERIOD_NUM);
    b->T.den = value_of(word, EXH_HEAD_PERIOD_DEN);
    if (b->T.num == 0 || b->T.den == 0) { return 0; } /* not yet set up */
    client.known = 1;
    return watch_scene(
        b, name, value_of(word, EXH_HEAD_SIGNALS_CRC), value_of(word, EXH_HEAD_SIGNALS));
}

#define TRIES 4 /* to read all of one tick */

/* Values from..to; more than a request holds may be of more than one tick. */
static int read_values(struct watch_box *b)
{
    const uint32_t end = b->all_values ? exh_signal_count(b->scene->signals) : b->to + 1;
    uint32_t from = b->all_values ? 0 : b->from;
    while (from < end) {
        const uint32_t n = end - from < AT_ONCE ? end - from : AT_ONCE;
        uint16_t word[2 * AT_ONCE];
        if (modbus_read_input_registers(client.ctx, (int)(EXH_REGS_SIGNAL_AT + 2 * from),
                (int)(2 * n), word) != (int)(2 * n)) {
            return 0;
        }
        for (uint32_t i = 0; i < n; i++) { b->value[from + i] = (int32_t)value_of(word, i); }
        from += n;
    }
    return 1;
}

/* --- a trace --- */

#define FRAME_WORDS    (2u * EXH_REGS_FRAME_VALUES)
#define FRAMES_AT_ONCE (MODBUS_MAX_READ_REGISTERS / FRAME_WORDS)

static int read_trace(uint16_t word[2 * EXH_TRACE_HEADS])
{
    return modbus_read_input_registers(client.ctx, (int)EXH_REGS_TRACE_AT, 2 * EXH_TRACE_HEADS,
               word) == 2 * EXH_TRACE_HEADS;
}

static int start_trace(struct watch_box *b)
{
    uint16_t word[2 * EXH_TRACE_HEADS];
    for (unsigned i = 0; i < EXH_REGS_TRACE_SET; i++) {
        const uint32_t v = i ? b->index[i - 1] : b->every;
        word[2 * i] = (uint16_t)(v >> 16);
        word[2 * i + 1] = (uint16_t)(v & 0xFFFFu);
    }
    if (modbus_write_registers(client.ctx, (int)EXH_REGS_TRACE_AT, 2 * EXH_REGS_TRACE_SET, word) <
        0) {
        if (errno != EMBXILADD) { return lose(b); }
        cli_complain("--trace: this box has no trace registers: watch it without");
        return 1;
    }
    if (!read_trace(word)) { return lose(b); }
    client.run = value_of(word, EXH_TRACE_HEAD_RUN);
    client.next = value_of(word, EXH_TRACE_HEAD_OLDEST);
    client.traces = 1;
    return 0;
}

/* One frame, which may have been overwritten since its number was read. */
static int on_frame(struct watch_box *b, const uint16_t *word, watch_fresh fresh)
{
    const uint32_t number = value_of(word, 0);
    if (number != client.next) {
        b->lost++;
        client.next++;
        return 0;
    }
    client.next++;
    b->tick = value_of(word, 1);
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) {
        b->value[b->index[i]] = (int32_t)value_of(word, 2 + i);
    }
    b->heard++;
    b->heard_s = until_now_s();
    return fresh(b);
}

/* All frames since the last time, those that are no longer held counted. */
static int look_at_trace(struct watch_box *b, watch_fresh fresh)
{
    uint16_t word[MODBUS_MAX_READ_REGISTERS];
    uint32_t left, frames;
    int err = client.traces ? 0 : start_trace(b);
    if (err || !client.connected) { return err; }
    if (!read_trace(word)) { return lose(b); }
    if (value_of(word, EXH_TRACE_HEAD_RUN) != client.run) {
        cli_complain("--trace: another client has set another trace");
        return 1;
    }
    frames = value_of(word, EXH_TRACE_HEAD_FRAMES);
    left = value_of(word, EXH_TRACE_HEAD_NEXT) - value_of(word, EXH_TRACE_HEAD_OLDEST);
    if (value_of(word, EXH_TRACE_HEAD_NEXT) - client.next > left) {
        b->lost += value_of(word, EXH_TRACE_HEAD_OLDEST) - client.next;
        client.next = value_of(word, EXH_TRACE_HEAD_OLDEST);
    }
    left = value_of(word, EXH_TRACE_HEAD_NEXT) - client.next;
    while (err == 0 && left > 0) {
        const uint32_t slot = client.next & (frames - 1),
                       fit = frames - slot < left ? frames - slot : left;
        const uint32_t n = fit < FRAMES_AT_ONCE ? fit : FRAMES_AT_ONCE;
        if (modbus_read_input_registers(client.ctx, (int)(EXH_REGS_FRAMES_AT + FRAME_WORDS * slot),
                (int)(FRAME_WORDS * n), word) != (int)(FRAME_WORDS * n)) {
            return lose(b);
        }
        for (uint32_t i = 0; err == 0 && i < n; i++) {
            err = on_frame(b, word + FRAME_WORDS * i, fresh);
        }
        left -= n;
    }
    return err;
}

/* Reads the head and the values after it again if the tick changed in between. After TRIES they
 * stay as they are, and are counted. 0: the link is lost. */
static int read_one_tick(struct watch_box *b, uint16_t *word)
{
    uint16_t behind[2];
    for (int i = 0; i < TRIES; i++) {
        if (i > 0 && modbus_read_input_registers(
                         client.ctx, (int)EXH_REGS_HEAD_AT, 2 * EXH_HEADS, word) != 2 * EXH_HEADS) {
            return 0;
        }
        if (!read_values(b) || modbus_read_input_registers(client.ctx,
                                   (int)EXH_REGS_HEAD_AT + 2 * EXH_HEAD_TICK, 2, behind) != 2) {
            return 0;
        }
        if (value_of(behind, 0) == value_of(word, EXH_HEAD_TICK)) { return 1; }
    }
    b->mixed++;
    return 1;
}

int watch_modbus_look(struct watch_box *b, watch_fresh fresh)
{
    uint16_t word[2 * EXH_HEADS];
    uint32_t tick;
    if (!client.connected && (until_now_s() - client.tried_s < AGAIN_S || !link_up())) { return 0; }
    if (modbus_read_input_registers(client.ctx, (int)EXH_REGS_HEAD_AT, 2 * EXH_HEADS, word) !=
        2 * EXH_HEADS) {
        return lose(b);
    }
    if (!client.known) {
        const int err = know(b, word);
        if (err || !client.known) { return err; }
    }
    if (!b->every && !read_one_tick(b, word)) { return lose(b); }
    b->trouble = NULL;
    tick = value_of(word, EXH_HEAD_TICK);
    b->state = (uint8_t)value_of(word, EXH_HEAD_STATE);
    b->faults = value_of(word, EXH_HEAD_FAULTS);
    b->present = value_of(word, EXH_HEAD_PRESENT);
    b->limits = value_of(word, EXH_HEAD_LIMITS);
    if (b->every) { return look_at_trace(b, fresh); }
    if (b->heard > 0 && tick == b->tick) { return 0; } /* tick unchanged: nothing new */
    b->tick = tick;
    b->heard++;
    b->heard_s = until_now_s();
    return fresh(b);
}
