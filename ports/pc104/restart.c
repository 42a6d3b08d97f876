/* SPDX-License-Identifier: MIT */
/* Did the run before this boot end? A mark in memory is set while ticks run and taken away when
 * they end in order; a reset by the watchdog, or by whoever found the box crashed, leaves it.
 * Memory outlives a reset and no power-off; some firmware clears it, and then this boot looks like
 * the first of all: what is certain is the watchdog's own contact (docs/CARDS.md).
 *
 * The mark's page is not cached. A reset drops what caches have not written back, and in a cache as
 * large as the image's data nothing pushes the mark out: it would be lost, or what took it away. */
#include "pc104.h"

/* 14 MiB: above the image and what was loaded behind it, below what firmware and GRUB take, which
 * is memory's upper end. (SeaBIOS clears the lowest 576 KiB at each boot.) */
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
