/* SPDX-License-Identifier: MIT */
/* Detects whether the run before this boot ended in order. A mark in memory is set while ticks run
 * and removed at an orderly end. A reset by the watchdog or a person after a crash leaves it.
 * Memory survives a reset, but no power-off. Some firmware clears it, and then this boot looks like
 * the first. Only the watchdog's contact is certain (docs/CARDS.md).
 *
 * The page of the mark is not cached, since a reset drops cache lines that are not written back. In
 * a large cache nothing would push the mark out, so it or its removal would be lost. */
#include "pc104.h"

/* 14 MiB: above the image and loaded modules, below the memory that firmware and GRUB use at the
 * upper end. (SeaBIOS clears the lowest 576 KiB at each boot.) */
#define MARK_AT   0x00E00000u
#define BELOW_KIB 1024u /* not in mem_upper */
#define MB_LOADED 0x2BADB002u
#define HAS_SIZES 1u
enum { RUNS = 0x52554E53, NOT_RUNS = ~RUNS };

static volatile uint32_t *mark(void) { return (volatile uint32_t *)MARK_AT; }

/* Is there so much memory? The loader says. */
static int is_there(void)
{
    const struct {
        uint32_t flags, lower_KiB, upper_KiB;
    } *info = (const void *)pc104_boot_info;
    if (pc104_boot_magic != MB_LOADED || !(info->flags & HAS_SIZES)) { return 0; }
    return info->upper_KiB > MARK_AT / 1024 - BELOW_KIB;
}

static uint8_t kept, fired;

/* Both words: memory at power-on is anything. */
void pc104_restart_look(void)
{
    kept = (uint8_t)(is_there() && pc104_guard_device(MARK_AT) == 0);
    fired = kept && mark()[0] == (uint32_t)RUNS && mark()[1] == (uint32_t)NOT_RUNS;
    if (fired) {
        pc104_say("restart: the run before did not end: the watchdog fired, or it crashed; "
                  "switch the power off and on\n");
    }
}

void pc104_restart_begin(void)
{
    if (!kept) { return; }
    mark()[0] = (uint32_t)RUNS;
    mark()[1] = (uint32_t)NOT_RUNS;
}

/* What was found stays found until the power goes. */
void pc104_restart_end(void)
{
    if (kept && !fired) { mark()[0] = mark()[1] = 0; }
}

int pc104_restart_fired(void) { return fired; }
