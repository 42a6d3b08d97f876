/* SPDX-License-Identifier: MIT */
/* BOX=none: a loop-back instead of drives, for emulators that have only a UART and timers. Each
 * commanded current flows, no string moves, and the glove is at rest. After HELD_AFTER reads a hand
 * holds the dead-man switch. */
#include "stm.h"

#define HELD_AFTER 200u
#define ZERO       32768
#define SPAN       12184 /* 3.75 V, all a drive takes */

static struct {
    int32_t ref[EXH_FINGERS];
    uint32_t reads;
    uint8_t enable;
} drives;

int stm_box_open(void)
{
    stm_box_safe();
    return 0;
}

int stm_box_read_drive(struct exh_drive_in *in)
{
    const uint32_t held = ++drives.reads > HELD_AFTER ? EXH_DIN_DEADMAN : 0u;
    *in = (struct exh_drive_in){
        .din = EXH_DIN_ESTOP | EXH_DIN_WATCHDOG | EXH_DIN_CARDS | 0x1Fu * EXH_DIN_DRIVE0 | held};
    for (unsigned i = 0; i < EXH_FINGERS; i++) { /* 0.591 V/A over 3249/V and 1.76 A/V: 67/64 */
        if (drives.enable >> i & 1) { in->mon_raw[i] = (int16_t)(drives.ref[i] * 67 / 64); }
    }
    return 0;
}

int stm_box_write_drive(const struct exh_drive_out *out)
{
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        const int32_t d = out->dac_raw[i] - ZERO;
        drives.ref[i] = d > SPAN ? SPAN : d < -SPAN ? -SPAN : d;
    }
    drives.enable = out->enable;
    return 0;
}

int stm_box_read_glove(struct exh_glove_in *in, uint32_t tick)
{
    (void)tick;
    *in = (struct exh_glove_in){.age_ticks = 0};
    return 0;
}

void stm_box_safe(void)
{
    drives.enable = 0;
    for (unsigned i = 0; i < EXH_FINGERS; i++) { drives.ref[i] = 0; }
}

void stm_box_report(void)
{
    stm_say("dac");
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        stm_say(" ");
        stm_say_u32((uint32_t)(drives.ref[i] + ZERO));
    }
    stm_say(", enable ");
    stm_say_u32(drives.enable);
    stm_say("\n");
}

/* The interrupt of an A/D that is not there. */
void stm_adc_half(void) {}
