/* SPDX-License-Identifier: MIT */
/* Board: the eleven functions of a port. Only the loop and the ports include this header. Each
 * function is defined once, at link time. Frames carry raw codes; the library scales them. Start a
 * port from ports/template, which documents each function and does nothing. */
#ifndef EXHAND_BOARD_H
#define EXHAND_BOARD_H

#include "exhand/frame.h"
#include "exhand/glove.h"
#include "exhand/units.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Version of these functions and frames. The loop refuses a port with another version. */
#define EXH_BOARD_VERSION 1

/* Constant properties of a port. The loop reads them first. */
struct exh_board_info {
    const char *name;     /* at most 15 characters */
    uint16_t version;     /* EXH_BOARD_VERSION at compile time of the port */
    uint8_t fingers;      /* number of axes */
    uint8_t enc_bits;     /* width of the counters, 16 .. 32 */
    uint32_t rate_max_Hz; /* highest accepted sample rate */
};
extern const struct exh_board_info exh_board_info;

/* Finds the cards, disables the drives, sets the timer as near rate_Hz as possible, and stores the
 * period in *achieved. Returns 0, -EXH_E_RATE (deviation above 1000 ppm), -EXH_E_ABSENT or
 * -EXH_E_IO. Called once, before the others. */
int exh_board_init(uint32_t rate_Hz, struct exh_period *achieved);

/* Waits for the next tick. Returns the ticks missed before it (0 = on time); < 0 stops. */
int exh_board_wait(void);

/* Latches all axes at the same time and reads them. Returns 0 or -EXH_E_IO. */
int exh_board_read_drive(struct exh_drive_in *in);

/* Applies all codes and enables together. Returns 0 or -EXH_E_IO. */
int exh_board_write_drive(const struct exh_drive_out *out);

/* Sets zero current and disables the drives. Callable at any time, in any context, repeatedly. */
void exh_board_safe(void);

/* Calls exh_board_safe(), reports why if possible, and stops. Does not return. */
void exh_board_halt(const char *why);

/* --- used only by scenes that call them --- */

/* Reads the newest frame of the glove (glove.h) and its age. Returns 0 or -EXH_E_IO. */
int exh_board_read_glove(struct exh_glove_in *in);

/* A free-running cycle or instruction counter, modulo 2^32. If it restarts at each start, a scene
 * with a link needs another source for session (docs/WIRE.md). */
uint32_t exh_board_cycles(void);

/* Takes a whole record or nothing, without blocking. Returns the bytes taken; 0: full. */
int exh_board_log(const void *rec, size_t len_B);

/* Sends or receives a whole packet or nothing, without blocking. Returns its bytes, 0: none, or
 * -EXH_E_IO. */
int exh_board_link_send(const void *buf, size_t len_B);
int exh_board_link_recv(void *buf, size_t cap_B);

#ifdef __cplusplus
}
#endif
#endif
