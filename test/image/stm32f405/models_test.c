/* SPDX-License-Identifier: MIT */
/* The models alone: what each part does, and does wrong, by its registers. */
#include "da.h"
#include "stm.h"

#include "check.h"

#include "../../../ports/stm32f405/da_code.h"

#include <stdio.h>

#define RCC    0x40023800u
#define FLASH  0x40023C00u
#define TIM1   0x40010000u
#define TIM2   0x40000000u
#define ADC1   0x40012000u
#define SPI2   0x40003800u
#define USART3 0x40004800u
#define DMA1   0x40026000u
#define DMA2   0x40026400u
#define GPIOB  0x40020400u
#define IWDG   0x40003000u
#define CRC    0x40023000u
#define SYST   0xE000E010u
#define US     (STM_HZ / 1000000)

static struct stm s;
static uint8_t flash[STM_FLASH_B], ram[STM_RAM_B];

static uint32_t get(uint32_t at) { return stm_read(&s, at, 4); }
static void put(uint32_t at, uint32_t v) { stm_write(&s, at, 4, v); }
static void pass(uint64_t units)
{
    const uint64_t end = s.now + units;
    while (stm_next(&s) <= end) {
        s.now = stm_next(&s) > s.now ? stm_next(&s) : s.now;
        stm_go_on(&s);
    }
    s.now = end;
    stm_go_on(&s);
}

static uint16_t analog(void *ctx, unsigned channel)
{
    (void)ctx;
    return (uint16_t)(100 * channel);
}
static uint8_t out[64];
static unsigned outs;
static void sent(void *ctx, unsigned usart, uint8_t byte)
{
    (void)ctx;
    (void)usart;
    out[outs++ % 64] = byte;
}
static uint16_t last_word;
static void spi_out(void *ctx, unsigned n, uint16_t word, unsigned bits)
{
    (void)ctx;
    (void)n;
    (void)bits;
    last_word = word;
}

static void power_on(void)
{
    memset(&s, 0, sizeof s);
    memset(flash, 0xFF, sizeof flash);
    stm_outside = (struct stm_outside){
        .flash = flash, .ram = ram, .analog = analog, .sent = sent, .spi = spi_out};
    outs = 0;
    stm_reset(&s, STM_POWER_ON);
}

static void clocks_on(void)
{
    put(RCC + 0x30, 0x0060000F | 0x00100000);
    put(RCC + 0x40, 0x100E401F);
    put(RCC + 0x44, 0x103);
}

/* As the port does it: crystal, PLL, flash, switch. */
static void run_at_168_MHz(void)
{
    put(RCC, 0x10083);
    pass(3000 * US);
    put(RCC + 4, 8 | 336u << 6 | 1u << 22 | 7u << 24);
    put(RCC, 0x01010083);
    pass(400 * US);
    put(FLASH, 5);
    put(RCC + 8, 5u << 10 | 4u << 13 | 2);
}

/* crate.tsv: peripheral, base, register, offset, reset, rights */
TEST(reset_values_are_those_of_the_crate)
{
    FILE *f = fopen("test/image/stm32f405/crate.tsv", "r");
    char line[2000], p[32], reg[32], right[8];
    unsigned base, off, reset, seen = 0;
    CHECK(f != NULL, "run from the root");
    power_on();
    put(RCC + 0x30, UINT32_MAX);
    put(RCC + 0x40, UINT32_MAX);
    put(RCC + 0x44, UINT32_MAX);
    while (fgets(line, sizeof line, f)) {
        if (sscanf(line, "%31s 0x%x %31s 0x%x 0x%x %7s", p, &base, reg, &off, &reset, right) != 6 ||
            base >= 0xE0000000u || strchr(right, 'r') == NULL || strstr(reg, "ENR")) {
            continue;
        }
        /* what the description leaves open, a reset does not set alone, or the manual has
         * otherwise (OSPEEDR, PWR, ARR) */
        if (!strcmp(reg, "IDR") || !strcmp(reg, "OSPEEDR") || !strcmp(reg, "ARR") ||
            !strcmp(p, "PWR") || !strcmp(reg, "ACR")) {
            continue;
        }
        CHECK(get(base + off) == reset, "%s %s: 0x%x, not 0x%x", p, reg, (unsigned)get(base + off),
            reset);
        seen++;
    }
    fclose(f);
    CHECK(seen > 150, "%u registers", seen);
    CHECK_EQ_I64((int64_t)s.unknown, 0);
}

TEST(a_part_without_its_clock_does_not_answer)
{
    power_on();
    put(TIM2 + 0x24, 77);
    CHECK_EQ_I64(get(TIM2 + 0x24), 0);
    CHECK_EQ_I64((int64_t)s.unclocked, 2);
    clocks_on();
    put(TIM2 + 0x24, 77);
    CHECK_EQ_I64(get(TIM2 + 0x24), 77);
    CHECK_EQ_I64((int64_t)s.unclocked, 2);
}

TEST(the_clock_is_switched_when_its_source_is_ready)
{
    power_on();
    CHECK_EQ_I64(s.clk.hclk_Hz, 16000000);
    put(RCC, 0x10083);
    CHECK_EQ_I64(get(RCC) >> 17 & 1, 0);
    put(RCC + 8, 1);
    CHECK_EQ_I64(get(RCC + 8) >> 2 & 3, 0);
    pass(2001 * US);
    CHECK_EQ_I64(get(RCC + 8) >> 2 & 3, 1);
    CHECK_EQ_I64(s.clk.hclk_Hz, 8000000);
    run_at_168_MHz();
    CHECK_EQ_I64(get(RCC + 8) >> 2 & 3, 2);
    CHECK_EQ_I64(s.clk.hclk_Hz, 168000000);
    CHECK_EQ_I64(s.clk.pclk1_Hz, 42000000);
    CHECK_EQ_I64(s.clk.pclk2_Hz, 84000000);
    CHECK_EQ_I64(s.clk.tim1_Hz, 84000000);
    CHECK_EQ_I64(s.clk.tim2_Hz, 168000000);
    CHECK_EQ_I64(s.flash.latency_Hz, 0);
}

TEST(too_few_wait_states_are_seen)
{
    power_on();
    run_at_168_MHz();
    put(FLASH, 4);
    put(RCC + 8, 5u << 10 | 4u << 13 | 2);
    CHECK_EQ_I64(s.flash.latency_Hz, 168000000);
}

TEST(a_dead_crystal_is_never_ready)
{
    power_on();
    s.wrong = 1u << STM_HSE_DEAD;
    put(RCC, 0x10083);
    pass(100000 * US);
    CHECK_EQ_I64(get(RCC) >> 17 & 1, 0);
}

TEST(a_crystal_that_stops_makes_an_nmi_if_it_is_watched)
{
    power_on();
    run_at_168_MHz();
    put(RCC, get(RCC) | 1u << 19);
    stm_hse_fails(&s);
    CHECK_EQ_I64(stm_wanted(&s, 1), STM_NMI);
    CHECK_EQ_I64(s.clk.hclk_Hz, 16000000);
    CHECK_EQ_I64(get(RCC + 0xC) & 0x80, 0x80);
    put(RCC + 0xC, 1u << 23);
    CHECK_EQ_I64(get(RCC + 0xC) & 0x80, 0);
}

TEST(the_supply_is_watched_when_asked)
{
    power_on();
    clocks_on();
    stm_supply_low(&s, 1);
    CHECK_EQ_I64(get(0x40007004) & 4, 0);
    put(0x40007000, 0x4010);
    stm_supply_low(&s, 1);
    CHECK_EQ_I64(get(0x40007004) & 4, 4);
}

static void encoder(uint32_t base, uint32_t ccer)
{
    put(base + 0x18, 0x0101);
    put(base + 0x20, ccer);
    put(base + 0x08, 3);
    put(base, 1);
}

TEST(encoders_count_every_edge_round_their_width)
{
    power_on();
    clocks_on();
    encoder(TIM1, 0);
    encoder(TIM2, 0);
    stm_tim_turn(&s, 1, -3);
    CHECK_EQ_I64(get(TIM1 + 0x24), 0xFFFD);
    stm_tim_turn(&s, 1, 70000);
    CHECK_EQ_I64(get(TIM1 + 0x24), 70000 - 3 - 65536);
    stm_tim_turn(&s, 2, -3);
    CHECK_EQ_I64(get(TIM2 + 0x24), 0xFFFFFFFDu);
    put(TIM1 + 0x20, 2); /* one input inverted: the other way */
    stm_tim_turn(&s, 1, 10);
    CHECK_EQ_I64(get(TIM1 + 0x24), 70000 - 13 - 65536);
}

TEST(an_encoder_counts_only_when_all_is_set)
{
    static const struct {
        uint32_t off, v;
    } less[] = {{0, 0}, {8, 0}, {0x18, 0x0100}, {0x18, 0x0201}};
    for (unsigned i = 0; i < 4; i++) {
        power_on();
        clocks_on();
        encoder(TIM1, 0);
        put(TIM1 + less[i].off, less[i].v);
        if (less[i].off == 8) { put(TIM1, 0); }
        stm_tim_turn(&s, 1, 5);
        CHECK_EQ_I64(get(TIM1 + 0x24), 0);
    }
}

TEST(a_timer_counts_its_clock_and_updates)
{
    power_on();
    clocks_on();
    run_at_168_MHz();
    put(TIM2 + 0x28, 83); /* 1 MHz */
    put(TIM2 + 0x2C, 99);
    put(TIM2 + 0x0C, 1);
    put(0xE000E100, 1u << 28);
    put(TIM2 + 0x14, 1);
    put(TIM2 + 0x10, 0);
    put(TIM2, 1);
    pass(50 * US);
    CHECK_EQ_I64(get(TIM2 + 0x24), 50);
    CHECK_EQ_I64(stm_wanted(&s, 0), 0);
    pass(50 * US);
    CHECK_EQ_I64(stm_wanted(&s, 0), STM_IRQ0 + 28);
    CHECK_EQ_I64(get(TIM2 + 0x10) & 1, 1);
    CHECK_EQ_I64(stm_wanted(&s, 1), 0);
}

TEST(systick_ticks_every_reload_and_one)
{
    int64_t ticks = 0;
    power_on();
    run_at_168_MHz();
    put(SYST + 4, 167999);
    put(SYST + 8, 0);
    put(SYST, 7);
    for (unsigned i = 0; i < 10; i++) {
        pass(1000 * US);
        ticks += s.core.pending[STM_SYSTICK];
        s.core.pending[STM_SYSTICK] = 0;
    }
    CHECK_EQ_I64(ticks, 10);
    CHECK_EQ_I64(get(SYST) >> 16 & 1, 1);
    CHECK_EQ_I64(get(SYST) >> 16 & 1, 0);
}

TEST(interrupts_go_by_priority)
{
    power_on();
    put(0xE000E100, 3);
    stm_write(&s, 0xE000E400, 1, 0x40);
    stm_write(&s, 0xE000E401, 1, 0x20);
    stm_pend(&s, STM_IRQ0);
    stm_pend(&s, STM_IRQ0 + 1);
    CHECK_EQ_I64(stm_wanted(&s, 0), STM_IRQ0 + 1);
    s.core.pending[STM_IRQ0 + 1] = 0;
    s.core.active[STM_IRQ0 + 1] = 1;
    CHECK_EQ_I64(stm_wanted(&s, 0), 0);
    stm_pend(&s, STM_NMI);
    CHECK_EQ_I64(stm_wanted(&s, 1), STM_NMI);
}

static void scan(void)
{
    put(DMA2 + 0x14, 6);
    put(DMA2 + 0x18, ADC1 + 0x4C);
    put(DMA2 + 0x1C, STM_RAM + 0x100);
    put(DMA2 + 0x10, 1u << 13 | 1u << 11 | 0x400 | 0x100 | 0x19);
    put(0xE000E104, 1u << 24);
    put(0x40012304, 1u << 16);
    put(ADC1 + 4, 0x100);
    put(ADC1 + 0x2C, 2u << 20);
    put(ADC1 + 0x34, 10u | 11u << 5 | 15u << 10);
    put(ADC1 + 8, 0x40000303);
}

TEST(a_scan_goes_round_through_dma)
{
    uint16_t v[6];
    power_on();
    clocks_on();
    run_at_168_MHz();
    scan();
    pass(6 * 15 * (STM_HZ / 21000000) + 1);
    memcpy(v, &ram[0x100], sizeof v);
    for (unsigned i = 0; i < 6; i++) { CHECK_EQ_I64(v[i], 100 * (i % 3 == 2 ? 15 : 10 + i % 3)); }
    CHECK_EQ_I64((int64_t)s.adc[1].conversions, 6);
    CHECK_EQ_I64(get(DMA2) & 0x3D, 0x30);
    CHECK_EQ_I64(stm_wanted(&s, 0), STM_IRQ0 + 56);
    CHECK_EQ_I64(get(ADC1) & 0x20, 0);
}

TEST(a_scan_that_nobody_takes_overruns)
{
    power_on();
    clocks_on();
    run_at_168_MHz();
    s.wrong = 1u << STM_ADC_LATE;
    scan();
    pass(1000 * US);
    CHECK_EQ_I64(get(ADC1) & 0x20, 0x20);
    CHECK_EQ_I64(s.adc[1].runs, 0);
    CHECK_EQ_I64(get(DMA2 + 0x14), 6);
}

TEST(dma_does_not_reach_the_coupled_memory)
{
    power_on();
    clocks_on();
    run_at_168_MHz();
    put(DMA2 + 0x1C, STM_CCM);
    scan();
    put(DMA2 + 0x10, 0);
    put(DMA2 + 0x1C, STM_CCM);
    put(DMA2 + 0x14, 6);
    put(DMA2 + 0x10, 1u << 13 | 1u << 11 | 0x400 | 0x100 | 0x19);
    pass(10 * US);
    CHECK_EQ_I64(get(DMA2) & 8, 8);
}

TEST(a_word_on_the_spi_takes_its_time)
{
    power_on();
    clocks_on();
    run_at_168_MHz();
    put(SPI2, 0x345 | 1u << 3);
    put(SPI2 + 0xC, 0xA5);
    CHECK_EQ_I64(get(SPI2 + 8) & 0x83, 0x82);
    put(SPI2 + 0xC, 0x5A);
    CHECK_EQ_I64(get(SPI2 + 8) & 2, 0);
    pass(8 * 32);
    CHECK_EQ_I64(last_word, 0xA5);
    CHECK_EQ_I64(get(SPI2 + 8) & 3, 3);
    pass(8 * 32);
    CHECK_EQ_I64(last_word, 0x5A);
    CHECK_EQ_I64(get(SPI2 + 8) & 0x82, 2);
    s.wrong = 1u << STM_SPI_STUCK;
    put(SPI2 + 0xC, 1);
    pass(1000 * US);
    CHECK_EQ_I64(get(SPI2 + 8) & 0x80, 0x80);
}

TEST(a_usart_sends_and_takes_by_dma)
{
    const uint8_t in[] = {7, 8, 9};
    power_on();
    clocks_on();
    run_at_168_MHz();
    memcpy(&ram[0x200], "hello", 5);
    put(USART3 + 8, 21); /* 2 Mbit/s */
    put(USART3 + 0xC, 0x200C);
    put(USART3 + 0x14, 0xC0);
    put(DMA1 + 0x14 + 3 * 0x18, 5);
    put(DMA1 + 0x18 + 3 * 0x18, USART3 + 4);
    put(DMA1 + 0x1C + 3 * 0x18, STM_RAM + 0x200);
    put(DMA1 + 0x10 + 3 * 0x18, 4u << 25 | 0x400 | 0x40 | 1); /* it has been asking */
    put(DMA1 + 0x14 + 0x18, 8);
    put(DMA1 + 0x18 + 0x18, USART3 + 4);
    put(DMA1 + 0x1C + 0x18, STM_RAM + 0x300);
    put(DMA1 + 0x10 + 0x18, 4u << 25 | 0x400 | 0x100 | 1);
    CHECK_EQ_I64(stm_usart_put(&s, 3, in, 3), 3);
    pass(24 * US);
    CHECK_EQ_I64(outs, 4);
    pass(2 * US);
    CHECK_EQ_I64(outs, 5);
    CHECK(memcmp(out, "hello", 5) == 0, "what was sent");
    CHECK_EQ_I64(get(USART3) & 0x40, 0x40);
    CHECK(memcmp(&ram[0x300], in, 3) == 0, "what came");
    CHECK_EQ_I64(get(DMA1 + 0x14 + 0x18), 5);
}

TEST(a_byte_that_nobody_takes_is_lost)
{
    const uint8_t in[] = {7, 8};
    power_on();
    clocks_on();
    run_at_168_MHz();
    put(USART3 + 8, 21);
    put(USART3 + 0xC, 0x2004);
    (void)stm_usart_put(&s, 3, in, 2);
    pass(11 * US);
    CHECK_EQ_I64(get(USART3) & 0x28, 0x28);
    CHECK_EQ_I64(get(USART3 + 4), 7);
    CHECK_EQ_I64(s.usart[3].lost, 1);
}

TEST(the_crc_unit_takes_words_from_ones)
{
    power_on();
    CHECK_EQ_I64(get(CRC), 0);
    put(RCC + 0x30, 1u << 12);
    CHECK_EQ_I64(get(CRC), 0xFFFFFFFF);
    put(CRC, 0);
    CHECK_EQ_I64(get(CRC), 0xC704DD7B);
    put(CRC + 8, 1);
    put(CRC, 0);
    put(CRC, 0xC704DD7B); /* what it holds, once more */
    CHECK_EQ_I64(get(CRC), 0);
}

TEST(the_watchdog_bites_unless_it_is_fed)
{
    power_on();
    put(IWDG, 0x5555);
    put(IWDG + 4, 0);
    put(IWDG + 8, 79); /* 80 of 4/32 ms: 10 ms */
    put(IWDG, 0xCCCC);
    for (unsigned i = 0; i < 5; i++) {
        pass(9900 * US);
        CHECK_EQ_I64(s.resets, 0);
        put(IWDG, 0xAAAA);
    }
    pass(10100 * US);
    CHECK_EQ_I64(s.resets, 1);
    CHECK_EQ_I64(s.reset_flags, STM_WATCHDOG);
}

static void unlock(void)
{
    put(FLASH + 4, 0x45670123);
    put(FLASH + 4, 0xCDEF89AB);
}

static void store(uint32_t off, uint32_t v)
{
    uint32_t was;
    memcpy(&was, &flash[off], 4);
    memcpy(&flash[off], &v, 4);
    stm_flash_store(&s, off, 4, was, v);
}

TEST(flash_is_programmed_from_one_to_zero_alone)
{
    uint32_t v;
    power_on();
    store(0xE0000, 1);
    CHECK_EQ_I64(get(FLASH + 0xC) & 0x80, 0x80);
    unlock();
    put(FLASH + 0x10, 2u << 8 | 1);
    store(0xE0000, 0x12345678);
    CHECK_EQ_I64(get(FLASH + 0xC) >> 16 & 1, 1);
    pass(17 * US);
    CHECK_EQ_I64(get(FLASH + 0xC) >> 16 & 1, 0);
    store(0xE0000, 0x0F0F0F0F);
    memcpy(&v, &flash[0xE0000], 4);
    CHECK_EQ_I64(v, 0x12345678 & 0x0F0F0F0F);
    pass(17 * US);
    put(FLASH + 0x10, 11u << 3 | 2);
    put(FLASH + 0x10, 11u << 3 | 2 | 1u << 16);
    memcpy(&v, &flash[0xE0000], 4);
    CHECK_EQ_I64(v, UINT32_MAX);
    CHECK_EQ_I64(get(FLASH + 0xC) >> 16 & 1, 1);
    pass(1000001ull * US);
    CHECK_EQ_I64(get(FLASH + 0xC) >> 16 & 1, 0);
}

TEST(a_wrong_key_locks_the_flash_until_a_reset)
{
    power_on();
    put(FLASH + 4, 1);
    unlock();
    CHECK_EQ_I64(get(FLASH + 0x10) >> 31, 1);
    stm_reset(&s, STM_SOFT);
    unlock();
    CHECK_EQ_I64(get(FLASH + 0x10) >> 31, 0);
}

TEST(a_supply_that_fails_while_programming_leaves_a_half)
{
    uint32_t v;
    power_on();
    s.flash.cut_after = 2;
    unlock();
    put(FLASH + 0x10, 2u << 8 | 1);
    store(0xE0000, 0);
    CHECK_EQ_I64(s.resets, 0);
    store(0xE0004, 0);
    memcpy(&v, &flash[0xE0004], 4);
    CHECK_EQ_I64(s.resets, 1);
    CHECK(v != 0 && v != UINT32_MAX, "0x%x", (unsigned)v);
}

TEST(pins_show_what_drives_them)
{
    power_on();
    clocks_on();
    s.port[1].in = 0x0030;
    put(GPIOB, 1u << 10); /* pin 5 is an output */
    put(GPIOB + 0x18, 1u << 20);
    CHECK_EQ_I64(get(GPIOB + 0x10) & 0x30, 0x10);
    put(GPIOB + 0x18, 1u << 5 | 1u << 21); /* to set wins */
    CHECK_EQ_I64(get(GPIOB + 0x10) & 0x30, 0x30);
    CHECK_EQ_I64(stm_port_out(&s, 1), 0x20);
}

static struct da da;
static void frame(uint32_t v)
{
    da_sync(&da, 0);
    for (int i = 16; i >= 0; i -= 8) { da_byte(&da, (uint8_t)(v >> i)); }
    da_sync(&da, 1);
}

TEST(the_da_is_at_ground_until_it_is_set_up_and_acts_together)
{
    da_power_on(&da);
    frame(0x14FFFFu);
    CHECK_EQ_I64(da_uV(&da, 0), 0);
    frame(0x030A84u);
    frame(0x043F00u);
    frame(0x060FF0u);
    frame(0x0CAAAAu);
    frame(0x148000u);
    frame(0x0E0010u);
    frame(0x09FE0Fu);
    CHECK_EQ_I64(da_uV(&da, 0), 0);
    frame(0x14C000u);
    CHECK_EQ_I64(da_uV(&da, 0), 0);
    frame(0x0E0010u);
    CHECK_EQ_I64(da_uV(&da, 0), 5000000);
    da_clear(&da, 0);
    CHECK_EQ_I64(da_uV(&da, 0), 0);
}

static uint32_t answer(void)
{
    uint32_t v = 0;
    da_sync(&da, 0);
    for (unsigned i = 0; i < 3; i++) {
        v = v << 8 | da_answer(&da);
        da_byte(&da, 0);
    }
    da_sync(&da, 1);
    return v;
}

TEST(the_da_answers_in_the_frame_behind)
{
    da_power_on(&da);
    frame(0x810000u);
    CHECK_EQ_I64(answer(), 0x810000u | 0x298u << 2);
    frame(0x830000u);
    CHECK_EQ_I64(answer(), 0x830AA4u);
    frame(0x14FFFFu);
    frame(0x940000u);
    CHECK_EQ_I64(answer(), 0x940000u); /* codes cannot be read */
    da_sync(&da, 0);
    da_byte(&da, 1);
    da_sync(&da, 1);
    CHECK_EQ_I64(da.torn, 1);
}

/* Off the exact product by half a code at most; in units of a code over 32490. */
TEST(each_code_of_the_library_is_the_nearest_of_the_da)
{
    for (int64_t raw = 0; raw < 65536; raw++) {
        const int64_t exact = (raw - 32768) * 32768, is = stm_da_code((uint16_t)raw) - 32768;
        const int64_t off = exact - is * 32490;
        const int beyond = exact < -32768 * INT64_C(32490) || exact > 32767 * INT64_C(32490);
        if (beyond) {
            CHECK_EQ_I64(is, exact < 0 ? -32768 : 32767);
        } else {
            CHECK(off >= -16245 && off <= 16245, "code %lld", (long long)raw);
        }
    }
    CHECK_EQ_I64(stm_da_code(32768), 32768);
}

TEST_MAIN("stm32f405 models", reset_values_are_those_of_the_crate,
    a_part_without_its_clock_does_not_answer, the_clock_is_switched_when_its_source_is_ready,
    too_few_wait_states_are_seen, a_dead_crystal_is_never_ready,
    a_crystal_that_stops_makes_an_nmi_if_it_is_watched, the_supply_is_watched_when_asked,
    encoders_count_every_edge_round_their_width, an_encoder_counts_only_when_all_is_set,
    a_timer_counts_its_clock_and_updates, systick_ticks_every_reload_and_one,
    interrupts_go_by_priority, a_scan_goes_round_through_dma, a_scan_that_nobody_takes_overruns,
    dma_does_not_reach_the_coupled_memory, a_word_on_the_spi_takes_its_time,
    a_usart_sends_and_takes_by_dma, a_byte_that_nobody_takes_is_lost,
    the_crc_unit_takes_words_from_ones, the_watchdog_bites_unless_it_is_fed,
    flash_is_programmed_from_one_to_zero_alone, a_wrong_key_locks_the_flash_until_a_reset,
    a_supply_that_fails_while_programming_leaves_a_half, pins_show_what_drives_them,
    the_da_is_at_ground_until_it_is_set_up_and_acts_together, the_da_answers_in_the_frame_behind,
    each_code_of_the_library_is_the_nearest_of_the_da);
