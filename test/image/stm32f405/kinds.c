/* SPDX-License-Identifier: MIT */
#include "kinds.h"

#define ASTRAY 0x08080000u /* an endless loop is there */

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

/* Of the finger that is pulled most. */
static unsigned pressing(void)
{
    unsigned most = 0;
    for (unsigned i = 1; i < loop.cfg.scene->fingers; i++) {
        if (da_uV(&loop.board.da, i) > da_uV(&loop.board.da, most)) { most = i; }
    }
    return most;
}
static void stuck_pressing(unsigned chance)
{
    (void)chance;
    stuck(pressing());
}
static void swapped_pressing(unsigned chance)
{
    (void)chance;
    swapped(pressing());
}
static void half_pressing(unsigned chance)
{
    (void)chance;
    half(pressing());
}

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
void kind_overruns(unsigned chance)
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

/* The D/A alone starts anew. */
static void da_reset(unsigned chance)
{
    (void)chance;
    da_power_on(&loop.board.da);
}

static uint32_t misread(void) { return loop.board.misread; }
static uint32_t bites(void) { return (uint32_t)stm_iwdg_period(&m->s); }

const struct kind kinds[] = {
    {"emergency stop", "estop", ENDS_OFF, estop, NULL, NULL, SET_MANY},
    {"a drive not ready", "drive", ENDS_OFF, drive, NULL, NULL, SET_MANY},
    {"dead-man let go", "deadman", ENDS_OFF, deadman, NULL, NULL, SET_MANY},
    {"encoder jumps", "encoder", ENDS_OFF, jumped, NULL, misread, SET_MANY},
    {"encoder stuck", "", ENDS_BOUND, stuck, NULL, misread, SET_MANY},
    {"encoder, A and B exchanged", "", ENDS_BOUND, swapped, NULL, misread, SET_MANY},
    {"encoder, line B dead", "", ENDS_BOUND, half, NULL, misread, SET_MANY},
    {"A/D transfers stop", "card", ENDS_OFF, adc_stops, NULL, NULL, SET_MANY},
    {"A/D transfer 3 us late", "card", ENDS_OFF, adc_stops, adc_goes_on, NULL, SET_MANY},
    {"D/A silent", "card", ENDS_OFF, da_silent, NULL, NULL, SET_MANY},
    {"D/A reset", "card", ENDS_OFF, da_reset, NULL, NULL, SET_MANY},
    {"SPI stuck", "card", ENDS_OFF, spi_stuck, NULL, NULL, SET_MANY},
    {"crystal stops", "crystal", ENDS_WORDS, clock_lost, NULL, NULL, SET_MANY},
    {"supply low", "card", ENDS_OFF, supply_low, NULL, NULL, SET_MANY},
    {"brown-out", "reset", ENDS_OFF, brown_out, NULL, NULL, SET_MANY},
    {"program astray", "reset", ENDS_OFF, astray, NULL, NULL, SET_MANY},
    {"the same, interrupts off", "reset", ENDS_OFF, masked, NULL, NULL, SET_MANY},
    {"the same, LSI at 47 kHz", "reset", ENDS_OFF, astray_fast, NULL, bites, SET_MANY},
    {"the same, LSI at 17 kHz", "reset", ENDS_OFF, astray_slow, NULL, bites, SET_MANY},
    {"program well, LSI at 47 kHz", "", ENDS_WELL, lsi_fast, NULL, bites, SET_MANY},
    {"program well, LSI at 17 kHz", "", ENDS_WELL, lsi_slow, NULL, bites, SET_MANY},
    {"stack overrun", "exception", ENDS_WORDS, kind_overruns, NULL, NULL, SET_MANY},
    {"jump out of memory", "exception", ENDS_WORDS, jump_out, NULL, NULL, SET_MANY},
    {"stuck before arming, arm_pull", "polarity", ENDS_ARM, stuck, NULL, misread, SET_ARM},
    {"A and B exchanged before arming, arm_pull", "polarity", ENDS_ARM, swapped, NULL, misread,
        SET_ARM},
    {"line B dead before arming, arm_pull", "polarity", ENDS_ARM, half, NULL, misread, SET_ARM},
    {"encoder stuck in a contact, glove", "let go", ENDS_LETGO, stuck_pressing, NULL, misread,
        SET_GLOVE},
    {"A and B exchanged in a contact, glove", "let go", ENDS_LETGO, swapped_pressing, NULL, misread,
        SET_GLOVE},
    {"line B dead in a contact, glove", "let go", ENDS_LETGO, half_pressing, NULL, misread,
        SET_GLOVE},
    {"A and B exchanged for 4 s", "", ENDS_BOUND, swapped, NULL, misread, SET_LONG},
    {"encoder stuck for 4 s", "", ENDS_BOUND, stuck, NULL, misread, SET_LONG},
    {"line B dead for 4 s", "", ENDS_BOUND, half, NULL, misread, SET_LONG},
    {"A and B exchanged for 1 s, person_i 1 A", "", ENDS_BOUND, swapped, NULL, misread, SET_PERSON},
};
const unsigned kind_count = sizeof kinds / sizeof kinds[0];

static void set(const char *name, double value)
{
    loop.cfg.setting[loop.cfg.settings++] = (struct ref_setting){name, value};
}

void kinds_set(enum kind_set which)
{
    if (which == SET_ARM) {
        set("arm_pull", KIND_ARM_N);
        set("arm_pull_time", KIND_ARM_MS);
    }
    if (which == SET_PERSON) { set("person_i", KIND_PERSON_A); }
}
