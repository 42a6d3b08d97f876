/* SPDX-License-Identifier: MIT */
/* Emulated cards inside an image, and at their connectors what a log of the same scene recorded:
 * counts, monitors, lines and glove of each tick, and the log's parameters. The log comes as a
 * multiboot module (qemu: -initrd). The drivers, the timer and the network card's driver are the
 * image's own; with the same planes it must make the same outputs as where the log was made. */
#include "cards/io.h"

#include "pc104/pc104.h"

#include "posix/emu/emu.h"

#include "exhand/run/log.h"

#include "exhand/error.h"
#include "exhand/record.h"

#define HAS_MODULES (1u << 3)
#define LOOSE_TICKS 120u /* the dead-man switch is not held before: it must be seen open */
#define SIGNALS_MAX 512u
#define MAX_PASS_US 1000000u

extern const struct exh_scene EXH_SCENE;

struct boot_info {
    uint32_t flags, memory[2], device, cmdline, modules, module_at;
};
struct module {
    const uint8_t *start, *end;
};

static struct emu_box box;
static const uint8_t *tape, *tape_end;
static uint32_t last_us, shown; /* shown: ticks of the tape at the connectors */
static int on;

/* --- the tape --- */

/* The next record of that type. 0: there is none. It reads the head alone. The starting program has
 * checked the log, and its sums would cost the tick more than the scene does. */
static int next(struct exh_record *r, uint8_t type)
{
    while (tape_end - tape >= EXH_RECORD_OVERHEAD) {
        const uint32_t len_B = (uint32_t)tape[4] | (uint32_t)tape[5] << 8;
        if ((tape[0] | tape[1] << 8) != (int)EXH_RECORD_SYNC) { return 0; }
        if (len_B + EXH_RECORD_OVERHEAD > (uint32_t)(tape_end - tape)) { return 0; }
        *r = (struct exh_record){.type = tape[2], .len_B = (uint16_t)len_B, .payload = tape + 14};
        tape += len_B + EXH_RECORD_OVERHEAD;
        if (r->type == type) { return 1; }
    }
    return 0;
}

static void find_tape(void)
{
    const struct boot_info *info = (const struct boot_info *)pc104_boot_info;
    if (info->flags & HAS_MODULES && info->modules > 0) {
        const struct module *m = (const struct module *)info->module_at;
        tape = m->start;
        tape_end = m->end;
    }
    if (tape == NULL) { pc104_halt(PC104_EXIT_ABSENT, "tape: no module was loaded"); }
}

static void take_params(void)
{
    struct exh_record_header h;
    struct exh_record r;
    struct exh_bytes c;
    int err = -EXH_E_UNKNOWN;
    if (next(&r, EXH_RECORD_HEADER)) {
        c = exh_bytes_reader(r.payload, r.len_B);
        exh_record_header_serialize(&c, &h);
        err = exh_params_restore(EXH_SCENE.params, r.payload + c.at, r.len_B - c.at, NULL);
    }
    if (err < 0) { pc104_halt(PC104_EXIT_ABSENT, "tape: not a log of this scene"); }
}

/* --- the connectors (docs/CARDS.md) --- */

static void show_drive(const struct exh_drive_in *in)
{
    struct emu_pins *p = &box.pins;
    const int held = shown > LOOSE_TICKS && (in->din & EXH_DIN_DEADMAN);
    p->din[0] = p->din[1] = 0;
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        const unsigned card = i / EMU_AXES, axis = i % EMU_AXES;
        p->enc_cnt[card][axis] = (int32_t)in->enc_raw[i];
        p->ad_uV[card][axis] = emu_ad_uV(in->mon_raw[i]);
        p->din[card] |= (uint8_t)((in->din / EXH_DIN_DRIVE0 >> i & 1) << axis);
    }
    p->din[1] |= (uint8_t)((in->din & EXH_DIN_ESTOP ? 2 : 0) | (held ? 4 : 0) |
                           (in->din & EXH_DIN_WATCHDOG ? 8 : 0));
    p->ad_uV[1][4] = emu_ad_uV(in->supply_raw);
}

static void show(struct exh_bytes c)
{
    static struct exh_scene_in in;
    static int32_t signal[SIGNALS_MAX];
    struct exh_drive_out out;
    exh_log_frame_serialize(&c, &EXH_SCENE, &in, &out, signal);
    if (!exh_bytes_ok(&c)) { pc104_halt(PC104_EXIT_FAILED, "tape: a frame that is none"); }
    show_drive(&in.drive);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        box.pins.glove_uV[i] = emu_ad_uV(in.glove.raw[i]);
    }
}

static void power_on(void)
{
    const struct emu_config c = emu_box_config();
    emu_box_open(&box, &c);
    box.pins.din[0] = 15;
    box.pins.din[1] = 3 | 8;
    on = 1;
    find_tape();
    take_params();
}

/* The cards' clock goes on with their accesses, a microsecond each, and here up to the timer's. At
 * the first access of a tick that tick's inputs are at the connectors. */
static void follow(void)
{
    const uint32_t now_us = exh_io_time_us(), passed_us = now_us - last_us;
    struct exh_record r;
    if (!on) { power_on(); }
    if (shown == pc104_tick()) { return; }
    if (shown == 0) { emu_hasten(&box); } /* a conversion's time is not what is looked at */
    if (passed_us < MAX_PASS_US) { emu_advance_ns(&box, (uint64_t)passed_us * 1000); }
    last_us = now_us;
    for (; shown < pc104_tick(); shown++) {
        if (!next(&r, EXH_RECORD_FRAME)) { continue; } /* its end: all stays as it is */
        if (shown + 1 == pc104_tick()) { show(exh_bytes_reader(r.payload, r.len_B)); }
    }
}

uint8_t exh_io_in8(uint16_t port)
{
    follow();
    return (uint8_t)emu_in(&box, port, 1);
}

void exh_io_out8(uint16_t port, uint8_t value)
{
    follow();
    emu_out(&box, port, 1, value);
}

uint16_t exh_io_in16(uint16_t port)
{
    follow();
    return (uint16_t)emu_in(&box, port, 2);
}

void exh_io_out16(uint16_t port, uint16_t value)
{
    follow();
    emu_out(&box, port, 2, value);
}
