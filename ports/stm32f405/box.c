/* SPDX-License-Identifier: MIT */
/* The box as docs/STM32F405.md wires it. What is missing is named. */
#include "stm.h"

#include "exhand/error.h"

#define X4       3u
#define FILTER   3u /* eight samples of the timer's clock: 0.1 us */
#define COUNTERS 0xFFFFu

static const uint32_t timer[EXH_FINGERS] = {BASE_TIM1, BASE_TIM2, BASE_TIM3, BASE_TIM4, BASE_TIM8};
static uint8_t on; /* enables as they are */
static uint32_t said;

static void open_encoders(void)
{
    REG(BASE_RCC, RCC_APB1ENR) |= RCC_APB1ENR_TIM2EN | RCC_APB1ENR_TIM3EN | RCC_APB1ENR_TIM4EN;
    REG(BASE_RCC, RCC_APB2ENR) |= RCC_APB2ENR_TIM1EN | RCC_APB2ENR_TIM8EN;
    (void)REG(BASE_RCC, RCC_APB2ENR);
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        REG(timer[i], TIM_CR1) = 0;
        REG(timer[i], TIM_SMCR) = PUT(TIM_SMCR_SMS, X4);
        REG(timer[i], TIM_CCMR1) = PUT(TIM_CCMR1_CC1S, 1) | PUT(TIM_CCMR1_CC2S, 1) |
                                   PUT(TIM_CCMR1_IC1F, FILTER) | PUT(TIM_CCMR1_IC2F, FILTER);
        REG(timer[i], TIM_CCER) = 0;
        REG(timer[i], TIM_ARR) = COUNTERS;
        REG(timer[i], TIM_CNT) = 0;
        REG(timer[i], TIM_CR1) = TIM_CR1_CEN;
    }
}

static int supply_low(void) { return (REG(BASE_PWR, PWR_CSR) & PWR_CSR_PVDO) != 0; }

/* Once in a run: the contract test opens it again and again. */
static int missing(unsigned part, int is, const char *what)
{
    if (is && !(said >> part & 1u)) {
        stm_say("part ");
        stm_say(what);
        stm_say("\n");
        said |= 1u << part;
    }
    return is;
}

int stm_box_open(void)
{
    int da, adc, clock, low;
    stm_box_safe();
    open_encoders();
    da = stm_da_open();
    adc = stm_adc_open();
    clock = missing(0, stm_clock() == STM_CLOCK_NONE,
                "clock: RCC does not answer: this is no STM32F405, or an emulator without RCC") ||
            missing(1, stm_clock() == STM_CLOCK_HSI,
                "clock: the crystal does not run: see to it, or build with its MHz (HSE=12)");
    low = missing(2, supply_low(), "supply: below 2.9 V: see to the board's 3.3 V");
    (void)missing(3, da < 0, "D/A: no DAC81408 answers on SPI2: see to J4 and its supplies");
    (void)missing(4, adc < 0, "A/D: ADC1 does not convert by DMA2 stream 0");
    if (stm_clock() == STM_CLOCK_NONE || da < 0 || adc < 0) { return -EXH_E_ABSENT; }
    return clock || low ? -EXH_E_IO : 0;
}

static uint32_t inputs(void)
{
    uint32_t din = 0;
    din |= PIN_IS(ESTOP) ? EXH_DIN_ESTOP : 0u;
    din |= PIN_IS(DEADMAN) ? EXH_DIN_DEADMAN : 0u;
    din |= PIN_IS(READY0) * (EXH_DIN_DRIVE0 << 0) | PIN_IS(READY1) * (EXH_DIN_DRIVE0 << 1) |
           PIN_IS(READY2) * (EXH_DIN_DRIVE0 << 2) | PIN_IS(READY3) * (EXH_DIN_DRIVE0 << 3) |
           PIN_IS(READY4) * (EXH_DIN_DRIVE0 << 4);
    din |= stm_watchdog_bitten() ? 0u : EXH_DIN_WATCHDOG;
    din |= stm_adc_late() || stm_da_silent() || supply_low() ? 0u : EXH_DIN_CARDS;
    return din;
}

int stm_box_read_drive(struct exh_drive_in *in)
{
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        in->enc_raw[i] = REG(timer[i], TIM_CNT) & COUNTERS;
    }
    stm_adc_read(in);
    in->din = inputs();
    return 0;
}

static void enable(uint8_t drives)
{
    PIN_PUT(ENABLE0, drives & 1u);
    PIN_PUT(ENABLE1, drives & 2u);
    PIN_PUT(ENABLE2, drives & 4u);
    PIN_PUT(ENABLE3, drives & 8u);
    PIN_PUT(ENABLE4, drives & 16u);
    on = drives;
}

/* What is to go off goes first, what is to come on comes last. */
int stm_box_write_drive(const struct exh_drive_out *out)
{
    int err;
    enable(on & out->enable);
    err = stm_da_write(out->dac_raw);
    if (err == 0) { enable(out->enable); }
    return err;
}

int stm_box_read_glove(struct exh_glove_in *in, uint32_t tick) { return stm_adc_glove(in, tick); }

void stm_box_safe(void)
{
    enable(0);
    stm_da_clear();
}

void stm_box_report(void)
{
    stm_say(stm_da_silent() ? "D/A silent" : "D/A answers");
    stm_say(stm_adc_late() ? ", A/D late" : ", A/D in time");
    stm_say(stm_watchdog_bitten() ? ", watchdog has bitten since power-on\n" : "\n");
}
