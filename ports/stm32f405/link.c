/* SPDX-License-Identifier: MIT */
/* The wire's packets (docs/WIRE.md) over USART3, each a frame of COBS: no byte of it is 0, and a 0
 * ends it (Cheshire and Baker, "Consistent Overhead Byte Stuffing", 1999). A packet has a CRC of
 * its own, so a damaged frame is the scene's to refuse; one too long for a packet is dropped here.
 */
#include "stm.h"

#include "exhand/board.h"

#include <string.h>

#define FRAME_B (EXH_SCENE_PACKET_B + EXH_SCENE_PACKET_B / 254u + 2u)
#define OUT_B   4096u
#define RUN_MAX 255u

static uint8_t out_memory[OUT_B];
static struct stm_fifo out = {out_memory, OUT_B, 0, 0, 0, STM_LINK};
static uint8_t frame[FRAME_B]; /* the bytes received of one */
static uint32_t frame_B;       /* FRAME_B + 1: too long */
static struct {
    uint32_t in, damaged, too_long, sent, unsent;
} counts;

static uint32_t encode(uint8_t *to, const uint8_t *from, uint32_t n)
{
    uint32_t code_at = 0, at = 1;
    uint8_t code = 1;
    for (uint32_t i = 0; i < n; i++) {
        if (from[i]) {
            to[at++] = from[i];
            code++;
        }
        if (from[i] == 0 || code == RUN_MAX) {
            to[code_at] = code;
            code_at = at++;
            code = 1;
        }
    }
    to[code_at] = code;
    to[at++] = 0;
    return at;
}

/* In place, since the result is never longer than the bytes read. 0: damaged. */
static uint32_t decode(uint8_t *byte, uint32_t n)
{
    uint32_t at = 0, i = 0;
    while (i < n) {
        const uint32_t code = byte[i++];
        if (i + code - 1 > n) { return 0; }
        for (uint32_t k = 1; k < code; k++) { byte[at++] = byte[i++]; }
        if (code < RUN_MAX && i < n) { byte[at++] = 0; }
    }
    return at;
}

int exh_board_link_send(const void *buf, size_t len_B)
{
    uint8_t coded[FRAME_B];
    const int fits = len_B > 0 && len_B <= EXH_SCENE_PACKET_B;
    const int taken = fits && stm_fifo_put(&out, coded, encode(coded, buf, (uint32_t)len_B)) > 0;
    counts.sent += (uint32_t)taken;
    counts.unsent += (uint32_t)!taken;
    stm_fifo_out(&out);
    return taken ? (int)len_B : 0;
}

/* A 0 has come: the packet's length, or 0. */
static uint32_t packet(void)
{
    const uint32_t coded_B = frame_B, n = coded_B <= FRAME_B ? decode(frame, coded_B) : 0;
    frame_B = 0;
    counts.too_long += coded_B > FRAME_B;
    counts.damaged += coded_B > 0 && coded_B <= FRAME_B && n == 0;
    return n;
}

static uint32_t until_0(const uint8_t *from, uint32_t n)
{
    uint32_t i = 0;
    while (i < n && from[i]) { i++; }
    return i;
}

/* Of a frame too long for a packet the length alone says so. */
static void keep(const uint8_t *from, uint32_t n)
{
    const uint32_t at = frame_B < FRAME_B ? frame_B : FRAME_B, room = FRAME_B - at;
    if (n == 0) { return; }
    memcpy(frame + at, from, n < room ? n : room);
    frame_B = n > room ? FRAME_B + 1 : at + n;
}

int exh_board_link_recv(void *buf, size_t cap_B)
{
    const uint8_t *from;
    uint32_t n;
    while ((n = stm_uart_look(STM_LINK, &from)) > 0) {
        const uint32_t before = until_0(from, n);
        keep(from, before);
        stm_uart_skip(STM_LINK, before + (before < n));
        if (before < n && (n = packet()) > 0 && n <= cap_B) {
            memcpy(buf, frame, n);
            counts.in++;
            return (int)n;
        }
    }
    return 0;
}

void stm_link_out(void) { stm_fifo_out(&out); }

static void say_count(const char *what, uint32_t n)
{
    stm_say(what);
    stm_say_u32(n);
}

void stm_link_report(void)
{
    say_count("link in ", counts.in);
    say_count(", damaged ", counts.damaged);
    say_count(", too long ", counts.too_long);
    say_count(", sent ", counts.sent);
    say_count(", not sent ", counts.unsent);
    stm_say("\n");
}
