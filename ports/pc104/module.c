/* SPDX-License-Identifier: MIT */
/* Calibrations of fingers as multiboot modules. The loader puts files into memory beside the image
 * (GRUB: module; QEMU: -initrd). They are copied, so that other memory may be reused. */
#include "pc104.h"

#include "exhand/calibrate.h"

#include <string.h>

#define MB_LOADED       0x2BADB002u
#define HAS_MODULES     (1u << 3)
#define UNCALIBRATED_ID 0x8903 /* lib/src/run/calib_set */

/* Head of the structure that the loader left. */
struct boot_info {
    uint32_t flags, memory[2], device, cmdline, modules, module_at;
};
struct module {
    const uint8_t *start, *end;
    uint32_t text, reserved;
};

static uint8_t image[EXH_FINGERS][EXH_CALIB_IMAGE_B];

static void say_module(unsigned i, const char *what)
{
    pc104_say("module ");
    pc104_say_u32(i + 1);
    pc104_say(what);
}

/* One that is no longer than an image is meant as one, whatever is in it: set-up refuses it by
 * name. */
static void take(struct exh_scene_calib *k, unsigned i, const struct module *m)
{
    const uint32_t len_B = (uint32_t)(m->end - m->start);
    if (len_B > EXH_CALIB_IMAGE_B) {
        say_module(i, ": longer than a calibration: left alone\n");
    } else if (k->images == EXH_FINGERS) {
        say_module(i, ": a calibration more than there are fingers\n");
        pc104_halt(PC104_EXIT_OPTION, "module refused: nothing was started");
    } else {
        memcpy(image[k->images], m->start, len_B);
        k->image[k->images].byte = image[k->images];
        k->image[k->images++].len_B = len_B;
        say_module(i, ": calibration, ");
        pc104_say_u32(len_B);
        pc104_say(" bytes\n");
    }
}

/* Said before anything runs, since nothing is said while it does. */
static void say_none(const struct exh_scene *sc)
{
    const int32_t at = exh_signal_find(sc->params->table, UNCALIBRATED_ID, 0);
    if (sc->calib->images == 0 && at >= 0 && sc->params->active[at] == 0) {
        pc104_say(
            "no calibration: arming will be refused at calibration (uncalibrated=1: without)\n");
    }
}

void pc104_modules(const struct exh_scene *sc)
{
    const struct boot_info *info = (const struct boot_info *)pc104_boot_info;
    const int has = pc104_boot_magic == MB_LOADED && info->flags & HAS_MODULES;
    if (sc->calib == NULL) { return; }
    for (unsigned i = 0; has && i < info->modules; i++) {
        take(sc->calib, i, (const struct module *)info->module_at + i);
    }
    say_none(sc);
}
