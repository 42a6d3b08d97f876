/* SPDX-License-Identifier: MIT */
/* Template board: compiles, does nothing, refuses to run. Copy the folder, then
 * fill one function after the other; the test in test/port says when it is done.
 *
 * A new port edits nothing outside its own folder and ldscripts/.
 */
#include "exhand/board.h"
#include "exhand/error.h"

/* What is there. rate_max_Hz is the highest rate exh_board_init() accepts. */
const struct exh_board_info exh_board_info = {
    .name = "template",
    .version = EXH_BOARD_VERSION,
    .fingers = 0,
    .enc_bits = 24,
    .rate_max_Hz = 0,
};

/* Fill in: disable the drives first. Find each card by something only that card answers; an empty
 * bus reads all ones. Divide the timer's clock as near to rate_Hz as possible. Refuse a deviation
 * beyond 1000 ppm with -EXH_E_RATE. Report the programmed period in seconds: {divisor, clock_Hz},
 * never a measured time. */
int exh_board_init(uint32_t rate_Hz, struct exh_period *achieved)
{
    (void)rate_Hz;
    *achieved = (struct exh_period){1, 1}; /* valid, even if unused */
    return -EXH_E_ABSENT;                  /* so that an unfilled port cannot run by accident */
}

/* Fill in: sleep until the timer's next tick. Count ticks where they happen (an
 * interrupt or a hardware counter), so that late arrival is seen and returned. The
 * first call starts the clock: time spent in set-up is not a missed tick. */
int exh_board_wait(void) { return -EXH_E_ABSENT; }

/* Fill in: latch all axes with as few accesses as the cards allow, then read. Raw
 * codes only, no scaling. A digital input that does not exist must not read
 * healthy: leave its bit 0 unless the wiring makes it safe. EXH_DIN_WATCHDOG is 0 from
 * a bite of the watchdog until power-off, over resets; EXH_DIN_CARDS while what is read
 * cannot be trusted, though it could be read. What could not returns -EXH_E_IO. */
int exh_board_read_drive(struct exh_drive_in *in)
{
    *in = (struct exh_drive_in){.din = 0};
    return -EXH_E_ABSENT;
}

/* Fill in: preload all codes, then apply codes and enables together. A changed
 * out->alive kicks the watchdog; an unchanged one must not. */
int exh_board_write_drive(const struct exh_drive_out *out)
{
    (void)out;
    return -EXH_E_ABSENT;
}

/* Fill in: the D/A code of zero current on every axis, all enables off. Called
 * from anywhere, also before exh_board_init() and from a fault handler: no waiting
 * without a bound, no state needed. */
void exh_board_safe(void) {}

/* Fill in: say why on whatever there is (serial line, lamp code), then stop so that
 * only a reset helps. The outputs are safe before the first word. */
void exh_board_halt(const char *why)
{
    (void)why;
    exh_board_safe();
    for (;;) {}
}

/* --- needed only by scenes that call them: delete what the board does not have,
 * and such a scene will not link, naming what is missing --- */

/* Fill in: the 22 codes of the last finished conversion, and its age in ticks. */
int exh_board_read_glove(struct exh_glove_in *in)
{
    *in = (struct exh_glove_in){.age_ticks = UINT16_MAX};
    return -EXH_E_ABSENT;
}

/* Fill in: a free-running counter. It may wrap, but must not stop. If it restarts at each start, a
 * scene with a link needs another source for `session` (docs/WIRE.md). */
uint32_t exh_board_cycles(void) { return 0; }

/* Fill in: take the whole record or nothing, now: a slow sink must not cost a tick. */
int exh_board_log(const void *rec, size_t len_B)
{
    (void)rec;
    (void)len_B;
    return 0;
}

/* Fill in: queue the whole packet or nothing, now. */
int exh_board_link_send(const void *buf, size_t len_B)
{
    (void)buf;
    (void)len_B;
    return 0;
}

/* Fill in: hand out one whole packet if one has come, else 0, now. */
int exh_board_link_recv(void *buf, size_t cap_B)
{
    (void)buf;
    (void)cap_B;
    return 0;
}
