/* SPDX-License-Identifier: MIT */
/* Independent watchdog: its own 32 kHz clock (17 .. 47 kHz over parts and temperature, data sheet),
 * so a nominal time becomes 0.68 to 1.9 times as long. Three periods, at least 8 ms: at 1 kHz it
 * bites 5 to 15 ms after the last whole tick. After its reset pins float, and the resistors of
 * wiring.tsv hold D/A and drives at zero. */
#include "stm.h"

#include "exhand/fix.h"

#define LSI_HZ  32000u
#define LEAST   64u /* of 8 kHz / 2^prescale: 8 ms */
#define POLLS   100000u
#define RLR_MAX 0xFFFu

void stm_watchdog_start(struct exh_period T)
{
    uint32_t shift = 2; /* PR 0 divides by 4 */
    uint64_t counts = exh_udiv64(UINT64_C(3) * T.num * (LSI_HZ >> shift), T.den, NULL) + 1;
    if (counts < LEAST) { counts = LEAST; }
    for (; counts > RLR_MAX && shift < 8; shift++) { counts = (counts + 1) / 2; }
    REG(BASE_IWDG, IWDG_KR) = IWDG_KEY_START; /* starts the 32 kHz, too */
    REG(BASE_IWDG, IWDG_KR) = IWDG_KEY_ACCESS;
    REG(BASE_IWDG, IWDG_PR) = shift - 2;
    REG(BASE_IWDG, IWDG_RLR) = counts < RLR_MAX ? (uint32_t)counts : RLR_MAX;
    for (uint32_t n = 0; n < POLLS && REG(BASE_IWDG, IWDG_SR) & (IWDG_SR_PVU | IWDG_SR_RVU); n++) {}
    stm_watchdog_feed();
}

void stm_watchdog_feed(void) { REG(BASE_IWDG, IWDG_KR) = IWDG_KEY_FEED; }

/* RCC keeps it until power-off or a write to RMVF, which this port never does. */
int stm_watchdog_bitten(void) { return (REG(BASE_RCC, RCC_CSR) & RCC_CSR_IWDGRSTF) != 0; }
