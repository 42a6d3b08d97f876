/* SPDX-License-Identifier: MIT */
/* Clock tree: crystal or HSI to 1 MHz, times 336, half of it: 168 MHz. APB1 has 42 MHz, APB2 84.
 * Source: RM0090 (RCC: the PLL's equations and limits; FLASH: five wait states at 168 MHz, 3.3 V).
 * TIM5 runs freely. If the crystal stops, the clock security system raises an NMI. */
#include "stm.h"

#ifndef STM_HSE_MHz
#define STM_HSE_MHz 8 /* what is soldered: make HSE=12 */
#endif
#define HSI_MHz     16u
#define POLLS       200000u /* 100 ms and more at 16 MHz: a crystal takes some 2 ms */
#define SW_PLL      2u
#define WAIT_STATES 5u
#define APB_QUARTER 5u
#define APB_HALF    4u
#define SUPPLY_2V9  7u

static enum stm_clock source;

enum stm_clock stm_clock(void) { return source; }

static int comes(uint32_t offset, uint32_t mask, uint32_t want)
{
    for (uint32_t n = 0; n < POLLS; n++) {
        if ((REG(BASE_RCC, offset) & mask) == want) { return 1; }
    }
    return 0;
}

/* 1: the core runs at 168 MHz by this source. */
static int pll(uint32_t MHz, int crystal)
{
    REG(BASE_RCC, RCC_CR) &= ~RCC_CR_PLLON;
    if (!comes(RCC_CR, RCC_CR_PLLRDY, 0)) { return 0; }
    REG(BASE_RCC, RCC_PLLCFGR) = PUT(RCC_PLLCFGR_PLLM, MHz) | PUT(RCC_PLLCFGR_PLLN, 336) |
                                 PUT(RCC_PLLCFGR_PLLQ, 7) |
                                 (crystal ? RCC_PLLCFGR_PLLSRC : 0); /* PLLP 0: halved */
    REG(BASE_RCC, RCC_CR) |= RCC_CR_PLLON;
    if (!comes(RCC_CR, RCC_CR_PLLRDY, RCC_CR_PLLRDY)) { return 0; }
    REG(BASE_FLASH, FLASH_ACR) =
        PUT(FLASH_ACR_LATENCY, WAIT_STATES) | FLASH_ACR_PRFTEN | FLASH_ACR_ICEN | FLASH_ACR_DCEN;
    if (GET(FLASH_ACR_LATENCY, REG(BASE_FLASH, FLASH_ACR)) != WAIT_STATES) { return 0; }
    REG(BASE_RCC, RCC_CFGR) =
        PUT(RCC_CFGR_PPRE1, APB_QUARTER) | PUT(RCC_CFGR_PPRE2, APB_HALF) | PUT(RCC_CFGR_SW, SW_PLL);
    return comes(RCC_CFGR, RCC_CFGR_SWS, PUT(RCC_CFGR_SWS, SW_PLL));
}

static void count_freely(void)
{
    REG(BASE_RCC, RCC_AHB1ENR) |= RCC_AHB1ENR_CRCEN;
    REG(BASE_RCC, RCC_APB1ENR) |= RCC_APB1ENR_TIM5EN | RCC_APB1ENR_PWREN;
    (void)REG(BASE_RCC, RCC_APB1ENR);
    REG(BASE_TIM5, TIM_PSC) = 0;
    REG(BASE_TIM5, TIM_ARR) = UINT32_MAX;
    REG(BASE_TIM5, TIM_EGR) = TIM_EGR_UG;
    REG(BASE_TIM5, TIM_CR1) = TIM_CR1_CEN;
    REG(BASE_PWR, PWR_CR) |= PUT(PWR_CR_PLS, SUPPLY_2V9) | PWR_CR_PVDE;
}

void stm_clock_open(void)
{
    source = STM_CLOCK_NONE;
    if (REG(BASE_RCC, RCC_CR) & RCC_CR_HSIRDY) {
        REG(BASE_RCC, RCC_CR) |= RCC_CR_HSEON;
        if (comes(RCC_CR, RCC_CR_HSERDY, RCC_CR_HSERDY) && pll(STM_HSE_MHz, 1)) {
            REG(BASE_RCC, RCC_CR) |= RCC_CR_CSSON;
            source = STM_CLOCK_CRYSTAL;
        } else {
            stm_clock_hsi();
        }
    }
    count_freely();
}

void stm_clock_hsi(void)
{
    source = STM_CLOCK_HSI;
    REG(BASE_RCC, RCC_CR) &= ~(RCC_CR_HSEON | RCC_CR_CSSON);
    REG(BASE_RCC, RCC_CIR) = RCC_CIR_CSSC;
    REG(BASE_RCC, RCC_CFGR) = RESET_RCC_CFGR;
    (void)comes(RCC_CFGR, RCC_CFGR_SWS, 0);
    (void)pll(HSI_MHz, 0);
}

uint32_t stm_now(void) { return REG(BASE_TIM5, TIM_CNT); }

void stm_delay_us(uint32_t us)
{
    const uint32_t from = stm_now();
    for (uint32_t n = 0; n < us * 32u; n++) { /* a read is two cycles of APB1 and more */
        if (stm_now() - from >= us * (STM_TIM5_HZ / 1000000u)) { return; }
    }
}
