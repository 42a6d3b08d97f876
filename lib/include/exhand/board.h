/* SPDX-License-Identifier: MIT */
/* Board: the eleven functions a port provides. Included by the loop and the
 * ports, never by a module. Each is defined exactly once, at link time.
 *
 * Frames carry raw codes; all scaling is the library's. ports/template is a port
 * that does nothing and says what each function has to do.
 */
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

/* Of these functions and frames: the loop refuses a port that was written against another. */
#define EXH_BOARD_VERSION 1

/* What a port is, constant: the loop asks it before anything else. */
struct exh_board_info {
    const char *name;     /* at most 15 characters */
    uint16_t version;     /* EXH_BOARD_VERSION it was written against */
    uint8_t fingers;      /* axes present */
    uint8_t enc_bits;     /* width of its counters, 16 .. 32 */
    uint32_t rate_max_Hz; /* highest rate it accepts */
};
extern const struct exh_board_info exh_board_info;

/* Finds the cards, disables the drives, sets the timer as near rate_Hz as it can
 * and says what it set. 0, -EXH_E_RATE (more than 1000 ppm off), -EXH_E_ABSENT,
 * -EXH_E_IO. Called once, before anything else. */
int exh_board_init(uint32_t rate_Hz, struct exh_period *achieved);

/* Waits for the next tick: ticks missed since the last (0 = on time), < 0 = stop. */
int exh_board_wait(void);

/* Latches and reads all axes at once. 0 or -EXH_E_IO. */
int exh_board_read_drive(struct exh_drive_in *in);

/* Applies all codes and enables together. 0 or -EXH_E_IO. */
int exh_board_write_drive(const struct exh_drive_out *out);

/* Zero current, drives disabled: any time, any context, any number of times. */
void exh_board_safe(void);

/* Safe, says why where it can, stops. Does not return. */
void exh_board_halt(const char *why);

/* --- only where the scene calls them --- */

/* The newest frame of the glove (glove.h) and its age. 0 or -EXH_E_IO. */
int exh_board_read_glove(struct exh_glove_in *in);

/* A free-running cycle or instruction counter, modulo 2^32. Where it begins anew with each start, a
 * scene that has a link needs a `session` that does not (docs/WIRE.md). */
uint32_t exh_board_cycles(void);

/* Takes a whole record or nothing, without blocking: bytes taken, 0 if full. */
int exh_board_log(const void *rec, size_t len_B);

/* A whole packet or nothing, without blocking: bytes, 0 if none, or -EXH_E_IO. */
int exh_board_link_send(const void *buf, size_t len_B);
int exh_board_link_recv(void *buf, size_t cap_B);

#ifdef __cplusplus
}
#endif
#endif
