/* SPDX-License-Identifier: MIT */
/* Clocks and resets (RM0090 chapter 7), power (5). */
#include "stm.h"

#include <string.h>

enum { CR = 0, PLLCFGR = 1, CFGR = 2, CIR = 3, AHB1RSTR = 4, APB1RSTR = 8, APB2RSTR = 9 };
enum { AHB1ENR = 12, APB1ENR = 16, BDCR = 28, CSR = 29 };
#define HSI_ON  0x00000001u
#define HSI_RDY 0x00000002u
#define HSE_ON  0x00010000u
#define HSE_RDY 0x00020000u
#define CSS_ON  0x00080000u
#define PLL_ON  0x01000000u
#define PLL_RDY 0x02000000u
#define CSSF    0x80u
#define HSI_HZ  16000000u
#define HSE_HZ  8000000u
/* Data sheet: the crystal takes 2 ms, the PLL 75 to 300 us. */
#define HSE_START (STM_HZ / 500)
#define PLL_LOCK  (STM_HZ / 10000 * 3)

static const struct {
    uint8_t at;
    uint32_t value;
} at_reset[] = {{CR, 0x83}, {PLLCFGR, 0x24003010}, {AHB1ENR, 0x00100000}, {20, 0x7E6791FF},
    {21, 0xF1}, {22, 1}, {24, 0x36FEC9FF}, {25, 0x00075F33}, {33, 0x20003000}};

static uint32_t pll_Hz(const struct stm *s)
{
    const uint32_t c = s->rcc.r[PLLCFGR];
    const uint32_t in = c >> 22 & 1 ? HSE_HZ : HSI_HZ, m = c & 63, n = c >> 6 & 511;
    return m < 2 ? 0 : (uint32_t)((uint64_t)in * n / m / (2 * (c >> 16 & 3) + 2));
}

static uint32_t bus_Hz(uint32_t hclk_Hz, uint32_t pre)
{
    return pre & 4 ? hclk_Hz >> ((pre & 3) + 1) : hclk_Hz;
}

static void set_clocks(struct stm *s)
{
    static const uint8_t shift[8] = {1, 2, 3, 4, 6, 7, 8, 9};
    const uint32_t cfgr = s->rcc.r[CFGR], sws = cfgr >> 2 & 3;
    struct stm_clocks *k = &s->clk;
    uint32_t sys = sws == 2 ? pll_Hz(s) : sws == 1 ? HSE_HZ : HSI_HZ;
    if (cfgr & 0x80) { sys >>= shift[cfgr >> 4 & 7]; }
    k->hclk_Hz = sys;
    k->pclk1_Hz = bus_Hz(sys, cfgr >> 10 & 7);
    k->pclk2_Hz = bus_Hz(sys, cfgr >> 13 & 7);
    k->tim1_Hz = cfgr & 1u << 12 ? 2 * k->pclk1_Hz : sys;
    k->tim2_Hz = cfgr & 1u << 15 ? 2 * k->pclk2_Hz : sys;
    k->cycle = sys ? (STM_HZ + sys / 2) / sys : 21;
    /* 30 MHz a wait state at 2.7 to 3.6 V */
    if (sys > 30000000u * ((s->flash.acr & 7) + 1) && sys > s->flash.latency_Hz) {
        s->flash.latency_Hz = sys;
    }
}

/* A switch is done when its source is ready, else it waits. */
static void switch_clock(struct stm *s)
{
    uint32_t *r = s->rcc.r;
    const uint32_t sw = r[CFGR] & 3;
    const int ready = sw == 0 ? 1 : sw == 1 ? (r[CR] & HSE_RDY) != 0 : (r[CR] & PLL_RDY) != 0;
    if (ready) { r[CFGR] = (r[CFGR] & ~0xCu) | sw << 2; }
    set_clocks(s);
}

void stm_hse_fails(struct stm *s)
{
    uint32_t *r = s->rcc.r;
    const int by_hse = (r[CFGR] >> 2 & 3) == 1 || ((r[CFGR] >> 2 & 3) == 2 && r[PLLCFGR] >> 22 & 1);
    const int watched = (r[CR] & CSS_ON) && (r[CR] & HSE_RDY);
    s->wrong |= 1u << STM_HSE_DEAD;
    s->rcc.hse_at = STM_NEVER;
    if (!watched) { return; } /* its users stop: machine.c sees the clock gone */
    r[CR] &= ~(HSE_RDY | HSE_ON);
    r[CR] |= HSI_ON | HSI_RDY;
    r[CIR] |= CSSF;
    if (by_hse) {
        r[CFGR] &= ~0xFu;
        if (r[PLLCFGR] >> 22 & 1) { r[CR] &= ~(PLL_ON | PLL_RDY); }
    }
    set_clocks(s);
    stm_pend(s, STM_NMI);
}

void stm_rcc_go_on(struct stm *s)
{
    uint32_t *r = s->rcc.r;
    if (s->rcc.hse_at <= s->now) {
        s->rcc.hse_at = STM_NEVER;
        r[CR] |= HSE_RDY;
    }
    if (s->rcc.pll_at <= s->now) {
        s->rcc.pll_at = STM_NEVER;
        r[CR] |= PLL_RDY;
    }
    switch_clock(s);
}

uint64_t stm_rcc_next(const struct stm *s)
{
    return s->rcc.hse_at < s->rcc.pll_at ? s->rcc.hse_at : s->rcc.pll_at;
}

static void write_cr(struct stm *s, uint32_t v)
{
    uint32_t *r = s->rcc.r;
    const uint32_t was = r[CR];
    r[CR] = (was & (HSI_RDY | HSE_RDY | PLL_RDY | 0xFF00u)) | (v & 0x010D00F9u);
    r[CR] = v & HSI_ON ? r[CR] | HSI_RDY : r[CR];
    if (!(v & HSE_ON)) {
        r[CR] &= ~HSE_RDY;
        s->rcc.hse_at = STM_NEVER;
    } else if (!(was & HSE_ON) && !(s->wrong & 1u << STM_HSE_DEAD)) {
        s->rcc.hse_at = s->now + HSE_START;
    }
    if (!(v & PLL_ON)) {
        r[CR] &= ~PLL_RDY;
        s->rcc.pll_at = STM_NEVER;
    } else if (!(was & PLL_ON) && (!(r[PLLCFGR] >> 22 & 1) || r[CR] & HSE_RDY)) {
        s->rcc.pll_at = s->now + PLL_LOCK;
    }
}

/* A part that is held in reset loses all its settings. */
static void reset_parts(struct stm *s, uint32_t at, uint32_t v)
{
    for (unsigned i = 0; at == APB1RSTR && i < 6; i++) {
        if (v >> i & 1) { stm_tim_reset(s, i + 2); }
    }
    if (at == APB2RSTR && v & 1) { stm_tim_reset(s, 1); }
    if (at == APB2RSTR && v & 2) { stm_tim_reset(s, 8); }
    for (unsigned i = 0; at == AHB1RSTR && i < STM_PORTS; i++) {
        if (v >> i & 1) { memset(s->port[i].r, 0, sizeof s->port[i].r); }
    }
}

uint32_t stm_rcc_read(struct stm *s, uint32_t off) { return off < 144 ? s->rcc.r[off >> 2] : 0; }

void stm_rcc_write(struct stm *s, uint32_t off, uint32_t v)
{
    uint32_t *r = s->rcc.r;
    const unsigned at = off >> 2;
    s->wake = 0;
    switch (at) {
    case CR: write_cr(s, v); break;
    case PLLCFGR:
        if (!(r[CR] & PLL_ON)) { r[PLLCFGR] = v; }
        break;
    case CFGR: r[CFGR] = (r[CFGR] & 0xCu) | (v & ~0xCu); break;
    case CIR:
        r[CIR] = (r[CIR] & 0xFFu) | (v & 0x7F00u);
        r[CIR] &= ~(v >> 16 & 0xFFu);
        break;
    case CSR:
        r[CSR] = v & 1 ? r[CSR] | 3 : r[CSR] & ~3u;
        if (v & 1u << 24) { r[CSR] &= 3; }
        break;
    default:
        if (at < 36) { r[at] = v; }
        reset_parts(s, at, v);
        break;
    }
    switch_clock(s);
}

void stm_rcc_reset(struct stm *s)
{
    memset(&s->rcc, 0, sizeof s->rcc);
    for (unsigned i = 0; i < sizeof at_reset / sizeof at_reset[0]; i++) {
        s->rcc.r[at_reset[i].at] = at_reset[i].value;
    }
    s->rcc.hse_at = s->rcc.pll_at = STM_NEVER;
    s->rcc.r[CSR] = s->reset_flags;
    s->rcc.pwr[0] = 0x4000;
    set_clocks(s);
}

/* --- power: the voltage detector --- */

#define PVDE 0x10u
#define PVDO 0x4u

void stm_supply_low(struct stm *s, int low)
{
    s->rcc.pwr[1] = low && s->rcc.pwr[0] & PVDE ? PVDO : 0;
}

uint32_t stm_pwr_read(struct stm *s, uint32_t off)
{
    if (off == 4) { return s->rcc.pwr[1] | 0x4000u; } /* VOSRDY */
    return off == 0 ? s->rcc.pwr[0] : 0;
}

void stm_pwr_write(struct stm *s, uint32_t off, uint32_t v)
{
    if (off == 0) { s->rcc.pwr[0] = v & 0xC3FFu & ~0xCu; }
}
