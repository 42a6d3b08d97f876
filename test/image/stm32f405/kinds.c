/* SPDX-License-Identifier: MIT */
#include "kinds.h"

#define ASTRAY 0x08080000u /* an endless loop stands there */

static struct machine *m;

void kinds_prepare(struct machine *machine)
{
    m = machine;
    m->flash[ASTRAY - STM_FLASH] = 0xFE;
    m->flash[ASTRAY - STM_FLASH + 1] = 0xE7;
}

static unsigned finger(unsigned chance) { return chance % loop.cfg.scene->fingers; }
static void wrong(enum stm_wrong what) { m->s.wrong |= 1u << what; }

/* --- wiring --- */

static void estop(unsigned chance)
{
    (void)chance;
    loop.cut |= EXH_DIN_ESTOP;
}
static void drive(unsigned chance) { loop.cut |= (uint32_t)EXH_DIN_DRIVE0 << finger(chance); }
static void deadman(unsigned chance)
{
    (void)chance;
    loop.cut |= EXH_DIN_DEADMAN;
}
static void jumped(unsigned chance) { loop.board.jump[finger(chance)] = 20000; }
static void stuck(unsigned chance) { loop.board.stuck = (uint8_t)(1u << finger(chance)); }
static void swapped(unsigned chance) { loop.board.miswired = (uint8_t)(1u << finger(chance)); }
static void half(unsigned chance) { loop.board.half = (uint8_t)(1u << finger(chance)); }

/* --- chip --- */

static void adc_stops(unsigned chance)
{
    (void)chance;
    wrong(STM_ADC_LATE);
}
static void adc_goes_on(void) { m->s.wrong &= ~(1u << STM_ADC_LATE); }
static void da_silent(unsigned chance)
{
    (void)chance;
    wrong(STM_DA_SILENT);
}
static void spi_stuck(unsigned chance)
{
    (void)chance;
    wrong(STM_SPI_STUCK);
    if (m->s.spi[2].shifts) { m->s.spi[2].done_at = STM_NEVER; }
}
static void clock_lost(unsigned chance)
{
    (void)chance;
    stm_hse_fails(&m->s);
}
static void supply_low(unsigned chance)
{
    (void)chance;
    stm_supply_low(&m->s, 1);
}
static void brown_out(unsigned chance)
{
    (void)chance;
    m->s.resets = 1;
    m->s.reset_flags = STM_BROWNOUT;
}
static void lsi_fast(unsigned chance)
{
    (void)chance;
    wrong(STM_LSI_FAST);
}
static void lsi_slow(unsigned chance)
{
    (void)chance;
    wrong(STM_LSI_SLOW);
}

/* --- program --- */

static void astray(unsigned chance)
{
    (void)chance;
    machine_set_reg(m, UC_ARM_REG_PC, ASTRAY | 1);
}
static void masked(unsigned chance)
{
    machine_set_reg(m, UC_ARM_REG_PRIMASK, 1);
    astray(chance);
}
static void astray_fast(unsigned chance)
{
    lsi_fast(chance);
    astray(chance);
}
static void astray_slow(unsigned chance)
{
    lsi_slow(chance);
    astray(chance);
}
/* The next that uses the stack runs over its end. */
static void overrun(unsigned chance)
{
    (void)chance;
    machine_set_reg(m, UC_ARM_REG_SP, STM_RAM + 256 + 16);
}
/* A hole, peripherals, system registers, erased flash, behind the flash. */
static void jump_out(unsigned chance)
{
    static const uint32_t to[] = {0x30000001, 0x40000001, 0xE000E001, ASTRAY + 0x101, 0x08100001};
    machine_set_reg(m, UC_ARM_REG_PC, to[chance % (sizeof to / sizeof to[0])]);
}

const struct kind kinds[] = {
    {"emergency stop", "estop", ENDS_OFF, estop, NULL},
    {"a drive not ready", "drive", ENDS_OFF, drive, NULL},
    {"dead-man let go", "deadman", ENDS_OFF, deadman, NULL},
    {"encoder jumps", "encoder", ENDS_OFF, jumped, NULL},
    {"encoder stuck", "", ENDS_BOUND, stuck, NULL},
    {"encoder, A and B exchanged", "", ENDS_BOUND, swapped, NULL},
    {"encoder, line B dead", "", ENDS_BOUND, half, NULL},
    {"A/D transfers stop", "card", ENDS_OFF, adc_stops, NULL},
    {"A/D transfer 3 us late", "card", ENDS_OFF, adc_stops, adc_goes_on},
    {"D/A silent", "card", ENDS_OFF, da_silent, NULL},
    {"SPI stuck", "card", ENDS_OFF, spi_stuck, NULL},
    {"crystal stops", "crystal", ENDS_WORDS, clock_lost, NULL},
    {"supply low", "card", ENDS_OFF, supply_low, NULL},
    {"brown-out", "reset", ENDS_OFF, brown_out, NULL},
    {"program astray", "reset", ENDS_OFF, astray, NULL},
    {"the same, interrupts off", "reset", ENDS_OFF, masked, NULL},
    {"the same, LSI at 47 kHz", "reset", ENDS_OFF, astray_fast, NULL},
    {"the same, LSI at 17 kHz", "reset", ENDS_OFF, astray_slow, NULL},
    {"program well, LSI at 47 kHz", "", ENDS_WELL, lsi_fast, NULL},
    {"program well, LSI at 17 kHz", "", ENDS_WELL, lsi_slow, NULL},
    {"stack overrun", "exception", ENDS_WORDS, overrun, NULL},
    {"jump out of memory", "exception", ENDS_WORDS, jump_out, NULL},
    {"encoder stuck, stuck_time 100 ms", "stuck", ENDS_STUCK, stuck, NULL},
};
const unsigned kind_count = sizeof kinds / sizeof kinds[0] - 1;
