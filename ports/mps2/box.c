/* SPDX-License-Identifier: MIT */
/* A box without hardware and without a watchdog: every commanded current flows, no
 * string moves, the glove is at rest. A hand takes hold of the dead-man switch after a while. Raw
 * codes, as the Sensoray cards have them. */
#include "box.h"

#include "mps2.h"

#include "exhand/error.h"

#define DEADMAN_FRAME 200u
#define DAC_ZERO      32768
#define DAC_SPAN      12184 /* 3.75 V, all a drive takes */

static volatile int16_t ref[EXH_FINGERS]; /* D/A, from zero; an interrupt may make them safe */
static volatile uint8_t enabled;
static uint32_t frames;

int mps2_box_open(void)
{
    mps2_box_safe();
    return 0;
}

int mps2_box_read_drive(struct exh_drive_in *in)
{
    *in = (struct exh_drive_in){.din = EXH_DIN_ESTOP | EXH_DIN_WATCHDOG | EXH_DIN_CARDS};
    if (frames < DEADMAN_FRAME) {
        frames++;
    } else {
        in->din |= EXH_DIN_DEADMAN;
    }
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        in->din |= (uint32_t)EXH_DIN_DRIVE0 << i;
        /* 3249 codes/V over 1.76 A/V; 0.591 V/A in codes of 305 uV: 1.049 */
        in->mon_raw[i] = (int16_t)(enabled >> i & 1 ? ref[i] * 67 / 64 : 0);
    }
    return 0;
}

static int16_t within_span(int32_t code)
{
    return (int16_t)(code > DAC_SPAN ? DAC_SPAN : code < -DAC_SPAN ? -DAC_SPAN : code);
}

int mps2_box_write_drive(const struct exh_drive_out *out)
{
    for (unsigned i = 0; i < EXH_FINGERS; i++) { ref[i] = within_span(out->dac_raw[i] - DAC_ZERO); }
    enabled = out->enable;
    return 0;
}

int mps2_box_read_glove(struct exh_glove_in *in)
{
    *in = (struct exh_glove_in){.age_ticks = 0};
    return 0;
}

void mps2_box_safe(void)
{
    enabled = 0;
    for (unsigned i = 0; i < EXH_FINGERS; i++) { ref[i] = 0; }
}

void mps2_box_report(void)
{
    mps2_say("dac");
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        mps2_say(" ");
        mps2_say_u32((uint32_t)(ref[i] + DAC_ZERO));
    }
    mps2_say(", enable ");
    mps2_say_u32(enabled);
    mps2_say("\n");
}
