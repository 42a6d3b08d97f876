/* SPDX-License-Identifier: MIT */
/* The parts of an STM32F405 that an image may touch, by what the reference manual (RM0090) says of
 * their registers; written from that, not from a driver.
 *
 * All state is in one struct without pointers to itself: a copy of it is a snapshot. Time is a
 * number of units of 1/336 MHz, by which all clocks of a chip with the usual crystal divide.
 */
#ifndef STM_H
#define STM_H

#include <stdint.h>

#define STM_HZ      336000000u
#define STM_NEVER   UINT64_MAX
#define STM_FLASH   0x08000000u
#define STM_FLASH_B (1u << 20)
#define STM_RAM     0x20000000u
#define STM_RAM_B   (128u << 10)
#define STM_CCM     0x10000000u
#define STM_CCM_B   (64u << 10)

enum { STM_TIMS = 14, STM_ADCS = 3, STM_SPIS = 3, STM_USARTS = 6, STM_PORTS = 9, STM_STREAMS = 8 };
enum { STM_IRQS = 82, STM_EXCEPTIONS = 16 + STM_IRQS };
/* exceptions by their numbers */
enum {
    STM_NMI = 2,
    STM_HARDFAULT = 3,
    STM_MEMMANAGE = 4,
    STM_BUSFAULT = 5,
    STM_USAGEFAULT = 6,
    STM_SVCALL = 11,
    STM_PENDSV = 14,
    STM_SYSTICK = 15,
    STM_IRQ0 = 16
};

/* Faults, from their start on. */
enum stm_wrong {
    STM_WELL,
    STM_HSE_DEAD,  /* the crystal stops, or never starts */
    STM_ADC_LATE,  /* no transfer of an A/D converter's is done any more */
    STM_SPI_STUCK, /* no word on the SPI ever ends */
    STM_DA_SILENT, /* the D/A takes no word */
    STM_LSI_FAST,  /* the watchdog's clock is at its upper limit, 47 kHz, */
    STM_LSI_SLOW,  /* or at its lower, 17 kHz */
    STM_FLASH_CUT, /* the supply fails in the middle of a programming or an erasure */
    STM_WRONGS
};

struct stm_clocks {
    uint32_t hclk_Hz, pclk1_Hz, pclk2_Hz, tim1_Hz, tim2_Hz; /* timers of bus 1 and of bus 2 */
    uint32_t cycle;                                         /* units of time */
};

struct stm_rcc {
    uint32_t r[36];
    uint64_t hse_at, pll_at; /* ready then */
    uint32_t pwr[2];
};

struct stm_flash {
    uint32_t acr, sr, cr, optcr;
    uint8_t keys;        /* taken: 2 unlock it; 0xFF: a wrong one, until a reset */
    uint64_t busy_until; /* an operation runs */
    uint32_t programmed, erased;
    uint32_t cut_after;  /* operations, until the supply fails in one; 0: never */
    uint32_t latency_Hz; /* the highest clock seen with too few wait states, or 0 */
};

struct stm_port {
    uint32_t r[10];
    uint16_t in; /* levels at the pins from outside */
};

struct stm_tim {
    uint32_t r[24];
    uint64_t from; /* the counter was 0 then, if it counts time */
};

struct stm_adc {
    uint32_t r[20];
    uint64_t done_at;
    uint8_t at, runs;
    uint64_t conversions;
};

struct stm_dma {
    uint32_t isr[2];
    struct {
        uint32_t cr, ndtr, par, m0ar, m1ar, fcr, reload, done;
    } stream[STM_STREAMS];
};

struct stm_spi {
    uint32_t r[9];
    uint64_t done_at;
    uint16_t shift, next, back;   /* on the line, behind it, the answer */
    uint8_t shifts, waits, taken; /* taken: DR was read, SR not yet behind it */
    uint64_t words;
};

#define STM_RX_B 4096u
struct stm_usart {
    uint32_t r[7];
    uint64_t tx_at, rx_at;
    uint8_t sends, waits, shift, next;
    uint32_t lost; /* bytes that came in and found the last unread */
    uint8_t rx[STM_RX_B];
    uint32_t rx_put, rx_got; /* what the other end sends */
    uint64_t sent, received;
};

struct stm_core {
    uint32_t systick[4], scb[40], mpu[11], dwt[2], dcb[4];
    uint64_t systick_from;
    uint8_t pending[STM_EXCEPTIONS], active[STM_EXCEPTIONS], enabled[STM_EXCEPTIONS];
    uint8_t priority[STM_EXCEPTIONS];
    uint32_t mpu_region[8][2];
    uint64_t cycles_from;
    uint8_t wants_reset, event;
};

struct stm_crc {
    uint32_t data;
    uint8_t own; /* a byte that it keeps for any program */
};

struct stm_iwdg {
    uint32_t pr, rlr;
    uint8_t unlocked, runs;
    uint64_t fed; /* when */
    uint64_t feeds;
};

struct stm {
    uint64_t now;
    uint64_t wake; /* the next event; 0: look anew */
    struct stm_clocks clk;
    struct stm_rcc rcc;
    struct stm_flash flash;
    struct stm_port port[STM_PORTS];
    struct stm_tim tim[STM_TIMS + 1]; /* by their numbers */
    struct stm_adc adc[STM_ADCS + 1];
    uint32_t adc_ccr;
    struct stm_dma dma[3];
    struct stm_spi spi[STM_SPIS + 1];
    struct stm_usart usart[STM_USARTS + 1];
    struct stm_core core;
    struct stm_iwdg iwdg;
    struct stm_crc crc;
    uint32_t wrong;                    /* bits: 1 << enum stm_wrong */
    uint64_t accesses;                 /* to peripherals and system registers */
    uint64_t unclocked, unknown;       /* to parts whose clock is off; to none that is modelled */
    uint32_t unclocked_at, unknown_at; /* the first of them */
    uint32_t reset_flags;              /* RCC_CSR after the reset under way */
    uint8_t resets;                    /* the chip asks to be started anew */
};

/* Connections outside of the chip. Not copied by a snapshot. */
struct stm_outside {
    void *ctx;
    uint8_t *flash, *ram, *ccm;
    uint16_t (*analog)(void *ctx, unsigned channel); /* code of 12 bits at this channel */
    void (*spi)(void *ctx, unsigned spi, uint16_t word, unsigned bits); /* has gone out */
    uint16_t (*miso)(void *ctx, unsigned spi);                         /* the answer to that word */
    void (*pins)(void *ctx, unsigned port, uint16_t was, uint16_t is); /* outputs changed */
    void (*sent)(void *ctx, unsigned usart, uint8_t byte);
    void (*tick)(void *ctx); /* SysTick's instant */
};
extern struct stm_outside stm_outside;

/* --- the chip: bus.c --- */

/* Power on, or a reset with these flags in RCC_CSR. */
void stm_reset(struct stm *s, uint32_t flags);
#define STM_POWER_ON 0x0E000000u
#define STM_PIN      0x04000000u
#define STM_SOFT     0x14000000u
#define STM_WATCHDOG 0x24000000u
#define STM_BROWNOUT 0x06000000u
uint32_t stm_read(struct stm *s, uint32_t address, unsigned size);
void stm_write(struct stm *s, uint32_t address, unsigned size, uint32_t value);
/* Whatever happens up to now. */
void stm_go_on(struct stm *s);
/* The time of the next event. */
uint64_t stm_next(const struct stm *s);
/* Cycles of the processor that an access takes beyond those of its instruction (README.md). */
unsigned stm_wait_cycles(const struct stm *s, uint32_t address);

/* --- parts: each by its offset; a part's own file --- */
uint32_t stm_rcc_read(struct stm *s, uint32_t off);
void stm_rcc_write(struct stm *s, uint32_t off, uint32_t v);
void stm_rcc_go_on(struct stm *s);
uint64_t stm_rcc_next(const struct stm *s);
void stm_rcc_reset(struct stm *s);
void stm_hse_fails(struct stm *s);
/* The supply is below (1) or above (0) the level that PWR watches. */
void stm_supply_low(struct stm *s, int low);
uint32_t stm_pwr_read(struct stm *s, uint32_t off);
void stm_pwr_write(struct stm *s, uint32_t off, uint32_t v);
uint32_t stm_flash_read(struct stm *s, uint32_t off);
void stm_flash_write(struct stm *s, uint32_t off, uint32_t v);
/* A store into the flash's own addresses: the value there afterwards. */
void stm_flash_store(struct stm *s, uint32_t off, unsigned size, uint32_t was, uint32_t value);
uint32_t stm_port_read(struct stm *s, unsigned port, uint32_t off);
void stm_port_write(struct stm *s, unsigned port, uint32_t off, unsigned size, uint32_t v);
/* Levels at the pins, as outputs drive them; and what a pin is. */
uint16_t stm_port_out(const struct stm *s, unsigned port);
unsigned stm_pin_mode(const struct stm *s, unsigned port, unsigned pin);
unsigned stm_pin_function(const struct stm *s, unsigned port, unsigned pin);
uint32_t stm_tim_read(struct stm *s, unsigned n, uint32_t off);
void stm_tim_write(struct stm *s, unsigned n, uint32_t off, uint32_t v);
void stm_tim_go_on(struct stm *s);
uint64_t stm_tim_next(const struct stm *s);
void stm_tim_reset(struct stm *s, unsigned n);
/* An encoder at channels 1 and 2 moves by so many quarters of a line. */
void stm_tim_turn(struct stm *s, unsigned n, int32_t quarters);
uint32_t stm_adc_read(struct stm *s, unsigned n, uint32_t off);
void stm_adc_write(struct stm *s, unsigned n, uint32_t off, uint32_t v);
uint32_t stm_adc_common_read(struct stm *s, uint32_t off);
void stm_adc_common_write(struct stm *s, uint32_t off, uint32_t v);
void stm_adc_go_on(struct stm *s);
uint64_t stm_adc_next(const struct stm *s);
uint32_t stm_dma_read(struct stm *s, unsigned n, uint32_t off);
void stm_dma_write(struct stm *s, unsigned n, uint32_t off, uint32_t v);
enum stm_request {
    STM_REQ_ADC = 0x100,
    STM_REQ_SPI_TX = 0x200,
    STM_REQ_SPI_RX = 0x300,
    STM_REQ_USART_TX = 0x400,
    STM_REQ_USART_RX = 0x500
}; /* and the part's number */
/* One item is requested: 1: a stream took it. */
int stm_dma_request(struct stm *s, unsigned request);
uint32_t stm_spi_read(struct stm *s, unsigned n, uint32_t off);
void stm_spi_write(struct stm *s, unsigned n, uint32_t off, uint32_t v);
void stm_spi_go_on(struct stm *s);
uint64_t stm_spi_next(const struct stm *s);
/* A stream was enabled: waiting requests are served. */
void stm_serial_ask(struct stm *s);
uint32_t stm_usart_read(struct stm *s, unsigned n, uint32_t off);
void stm_usart_write(struct stm *s, unsigned n, uint32_t off, uint32_t v);
void stm_usart_go_on(struct stm *s);
uint64_t stm_usart_next(const struct stm *s);
/* The other end sends; bytes taken. */
unsigned stm_usart_put(struct stm *s, unsigned n, const uint8_t *byte, unsigned count);
uint32_t stm_crc_read(const struct stm *s, uint32_t off);
void stm_crc_write(struct stm *s, uint32_t off, uint32_t v);
uint32_t stm_iwdg_read(struct stm *s, uint32_t off);
void stm_iwdg_write(struct stm *s, uint32_t off, uint32_t v);
void stm_iwdg_go_on(struct stm *s);
uint64_t stm_iwdg_next(const struct stm *s);
/* From a feed to the bite, in units of time. */
uint64_t stm_iwdg_period(const struct stm *s);
uint32_t stm_core_read(struct stm *s, uint32_t address, unsigned size);
void stm_core_write(struct stm *s, uint32_t address, unsigned size, uint32_t v);
void stm_core_go_on(struct stm *s);
uint64_t stm_core_next(const struct stm *s);
void stm_core_reset(struct stm *s);
/* An exception is requested. */
void stm_pend(struct stm *s, unsigned exception);
/* The exception to be taken now, or 0. masked: PRIMASK; only higher ones are taken. */
unsigned stm_wanted(const struct stm *s, int masked);
/* The same, whatever is active: what ends a WFI. */
int stm_wakes(const struct stm *s);
#endif
