/* SPDX-License-Identifier: MIT */
/* Which part answers at which address, whether it has a clock, and when something happens. */
#include "stm.h"

#include <string.h>

struct stm_outside stm_outside;

/* --- the parts: address, the register and bit that give it its clock --- */

enum kind { TIM, SPI, USART, ADC, ADCC, PORT, DMA, RCC, PWR, FLASH, IWDG, CRC };
enum { ALWAYS = 0, AHB1ENR = 12, APB1ENR = 16, APB2ENR = 17 };

static const struct part {
    uint32_t at, size;
    uint8_t kind, n, enable, bit;
} parts[] = {
    {0x40000000, 0x400, TIM, 2, APB1ENR, 0},
    {0x40000400, 0x400, TIM, 3, APB1ENR, 1},
    {0x40000800, 0x400, TIM, 4, APB1ENR, 2},
    {0x40000C00, 0x400, TIM, 5, APB1ENR, 3},
    {0x40001000, 0x400, TIM, 6, APB1ENR, 4},
    {0x40001400, 0x400, TIM, 7, APB1ENR, 5},
    {0x40003000, 0x400, IWDG, 0, ALWAYS, 0},
    {0x40003800, 0x400, SPI, 2, APB1ENR, 14},
    {0x40003C00, 0x400, SPI, 3, APB1ENR, 15},
    {0x40004400, 0x400, USART, 2, APB1ENR, 17},
    {0x40004800, 0x400, USART, 3, APB1ENR, 18},
    {0x40004C00, 0x400, USART, 4, APB1ENR, 19},
    {0x40005000, 0x400, USART, 5, APB1ENR, 20},
    {0x40007000, 0x400, PWR, 0, APB1ENR, 28},
    {0x40010000, 0x400, TIM, 1, APB2ENR, 0},
    {0x40010400, 0x400, TIM, 8, APB2ENR, 1},
    {0x40011000, 0x400, USART, 1, APB2ENR, 4},
    {0x40011400, 0x400, USART, 6, APB2ENR, 5},
    {0x40012000, 0x100, ADC, 1, APB2ENR, 8},
    {0x40012100, 0x100, ADC, 2, APB2ENR, 9},
    {0x40012200, 0x100, ADC, 3, APB2ENR, 10},
    {0x40012300, 0x100, ADCC, 0, APB2ENR, 8},
    {0x40013000, 0x400, SPI, 1, APB2ENR, 12},
    {0x40020000, 0x400, PORT, 0, AHB1ENR, 0},
    {0x40020400, 0x400, PORT, 1, AHB1ENR, 1},
    {0x40020800, 0x400, PORT, 2, AHB1ENR, 2},
    {0x40020C00, 0x400, PORT, 3, AHB1ENR, 3},
    {0x40023000, 0x400, CRC, 0, AHB1ENR, 12},
    {0x40023800, 0x400, RCC, 0, ALWAYS, 0},
    {0x40023C00, 0x400, FLASH, 0, ALWAYS, 0},
    {0x40026000, 0x400, DMA, 1, AHB1ENR, 21},
    {0x40026400, 0x400, DMA, 2, AHB1ENR, 22},
};

static const struct part *part_at(uint32_t address)
{
    for (unsigned i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        if (address - parts[i].at < parts[i].size) { return &parts[i]; }
    }
    return NULL;
}

static void first(uint64_t *count, uint32_t *at, uint32_t address)
{
    if ((*count)++ == 0) { *at = address; }
}

/* 1: it answers. */
static int is_there(struct stm *s, const struct part *p, uint32_t address)
{
    if (p == NULL) {
        first(&s->unknown, &s->unknown_at, address);
        return 0;
    }
    if (p->enable == ALWAYS || s->rcc.r[p->enable] >> p->bit & 1) { return 1; }
    first(&s->unclocked, &s->unclocked_at, address);
    return 0;
}

static uint32_t read_part(struct stm *s, const struct part *p, uint32_t off)
{
    switch ((enum kind)p->kind) {
    case TIM: return stm_tim_read(s, p->n, off);
    case SPI: return stm_spi_read(s, p->n, off);
    case USART: return stm_usart_read(s, p->n, off);
    case ADC: return stm_adc_read(s, p->n, off);
    case ADCC: return stm_adc_common_read(s, off);
    case PORT: return stm_port_read(s, p->n, off);
    case DMA: return stm_dma_read(s, p->n, off);
    case RCC: return stm_rcc_read(s, off);
    case PWR: return stm_pwr_read(s, off);
    case FLASH: return stm_flash_read(s, off);
    case IWDG: return stm_iwdg_read(s, off);
    case CRC: return stm_crc_read(s, off);
    default: return 0;
    }
}

static void write_part(struct stm *s, const struct part *p, uint32_t off, unsigned size, uint32_t v)
{
    switch ((enum kind)p->kind) {
    case TIM: stm_tim_write(s, p->n, off, v); break;
    case SPI: stm_spi_write(s, p->n, off, v); break;
    case USART: stm_usart_write(s, p->n, off, v); break;
    case ADC: stm_adc_write(s, p->n, off, v); break;
    case ADCC: stm_adc_common_write(s, off, v); break;
    case PORT: stm_port_write(s, p->n, off, size, v); break;
    case DMA: stm_dma_write(s, p->n, off, v); break;
    case RCC: stm_rcc_write(s, off, v); break;
    case PWR: stm_pwr_write(s, off, v); break;
    case FLASH: stm_flash_write(s, off, v); break;
    case IWDG: stm_iwdg_write(s, off, v); break;
    case CRC: stm_crc_write(s, off, v); break;
    default: break;
    }
}

uint32_t stm_read(struct stm *s, uint32_t address, unsigned size)
{
    const struct part *p;
    uint32_t v;
    s->accesses++;
    if (address >= 0xE0000000u) { return stm_core_read(s, address, size); }
    p = part_at(address);
    if (!is_there(s, p, address)) { return 0; }
    v = read_part(s, p, (address - p->at) & ~3u) >> 8 * (address & 3);
    return size == 4 ? v : v & ((1u << 8 * size) - 1);
}

void stm_write(struct stm *s, uint32_t address, unsigned size, uint32_t value)
{
    const struct part *p;
    s->accesses++;
    if (address >= 0xE0000000u) {
        stm_core_write(s, address, size, value);
        return;
    }
    p = part_at(address);
    if (is_there(s, p, address)) { write_part(s, p, address - p->at, size, value); }
}

/* --- time --- */

static const struct {
    uint64_t (*next)(const struct stm *s);
    void (*go_on)(struct stm *s);
} clocked[] = {{stm_rcc_next, stm_rcc_go_on}, {stm_core_next, stm_core_go_on},
    {stm_tim_next, stm_tim_go_on}, {stm_adc_next, stm_adc_go_on}, {stm_spi_next, stm_spi_go_on},
    {stm_usart_next, stm_usart_go_on}, {stm_iwdg_next, stm_iwdg_go_on}};
#define CLOCKED (sizeof clocked / sizeof clocked[0])

void stm_go_on(struct stm *s)
{
    for (unsigned i = 0; i < CLOCKED; i++) {
        if (clocked[i].next(s) <= s->now) { clocked[i].go_on(s); }
    }
    s->wake = stm_next(s);
}

uint64_t stm_next(const struct stm *s)
{
    uint64_t at = STM_NEVER;
    for (unsigned i = 0; i < CLOCKED; i++) {
        const uint64_t n = clocked[i].next(s);
        at = n < at ? n : at;
    }
    return at;
}

/* A bus's clock is slower than the processor's: an access waits for it twice. The CRC unit takes
 * four clocks a word. The writer of the next word has loaded it meanwhile, in two. */
unsigned stm_wait_cycles(const struct stm *s, uint32_t address)
{
    const struct stm_clocks *k = &s->clk;
    if (address >= 0xE0000000u) { return 0; }
    if (address - 0x40023000u < 0x400) { return 4; }
    if (address >= 0x40020000u) { return 1; }
    if (address >= 0x40010000u) { return 2 * (k->hclk_Hz / k->pclk2_Hz); }
    return 2 * (k->hclk_Hz / k->pclk1_Hz);
}

void stm_reset(struct stm *s, uint32_t flags)
{
    const uint64_t now = s->now;
    const uint32_t wrong = flags == STM_POWER_ON ? 0 : s->wrong;
    uint16_t in[STM_PORTS];
    for (unsigned i = 0; i < STM_PORTS; i++) { in[i] = s->port[i].in; }
    memset(s, 0, sizeof *s);
    s->now = now;
    s->wrong = wrong;
    s->reset_flags = flags;
    s->iwdg.rlr = 0xFFF;
    s->crc.data = 0xFFFFFFFFu;
    s->flash.cr = 0x80000000u;
    s->flash.optcr = 0x0FFFAAEDu;
    for (unsigned i = 0; i < STM_PORTS; i++) { s->port[i].in = in[i]; }
    s->port[0].r[0] = 0xA8000000u;
    s->port[0].r[2] = 0x0C000000u;
    s->port[0].r[3] = 0x64000000u;
    s->port[1].r[0] = 0x280u;
    s->port[1].r[2] = 0xC0u;
    s->port[1].r[3] = 0x100u;
    for (unsigned n = 1; n <= STM_TIMS; n++) { stm_tim_reset(s, n); }
    for (unsigned n = 0; n < 3; n++) {
        for (unsigned i = 0; i < STM_STREAMS; i++) { s->dma[n].stream[i].fcr = 0x21; }
    }
    for (unsigned n = 1; n <= STM_USARTS; n++) { s->usart[n].r[0] = 0xC0; }
    for (unsigned n = 1; n <= STM_ADCS; n++) { s->adc[n].r[9] = 0xFFF; }
    stm_rcc_reset(s);
    stm_core_reset(s);
}
