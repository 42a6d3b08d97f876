/* SPDX-License-Identifier: MIT */
/* Inside of this port: what its files need from each other. */
#ifndef STM32F405_STM_H
#define STM32F405_STM_H

#include "exhand/run/scene.h"

#include "exhand/frame.h"
#include "exhand/glove.h"

#include "regs.h"
#include "wiring.h"

#include <stddef.h>
#include <stdint.h>

#define STM_CORE_HZ 168000000u
#define STM_APB1_HZ 42000000u
#define STM_TIM5_HZ 84000000u

/* --- pins.c: pins by their net, wiring.tsv --- */
#define NET_PLACE(net, port, pin, mode, function, pull, high) \
    PORT_##net = (port), PIN_##net = (pin),
enum { WIRING(NET_PLACE) NETS_END };
#define PIN_HIGH(net) (REG(GPIO_BASE(PORT_##net), GPIO_BSRR) = 1u << PIN_##net)
#define PIN_LOW(net)  (REG(GPIO_BASE(PORT_##net), GPIO_BSRR) = 0x10000u << PIN_##net)
#define PIN_PUT(net, on) \
    (REG(GPIO_BASE(PORT_##net), GPIO_BSRR) = ((on) ? 1u : 0x10000u) << PIN_##net)
#define PIN_IS(net) (REG(GPIO_BASE(PORT_##net), GPIO_IDR) >> PIN_##net & 1u)
void stm_pins_open(void);

/* --- start.c --- */
uint32_t stm_stack_B(void); /* most that was used of it so far */
void stm_mpu(int on);

/* --- clock.c --- */
enum stm_clock {
    STM_CLOCK_NONE,    /* RCC does not answer: no such chip */
    STM_CLOCK_CRYSTAL, /* 168 MHz by it */
    STM_CLOCK_HSI      /* the crystal does not run: 168 MHz by the RC oscillator, 1 % off */
};
void stm_clock_open(void);
void stm_clock_hsi(void); /* the crystal has stopped */
enum stm_clock stm_clock(void);
uint32_t stm_now(void);         /* TIM5: 84 MHz, modulo 2^32 */
void stm_delay_us(uint32_t us); /* at most 1 s; also ends if TIM5 stops */

/* --- say.c: text over USART2, polled; a line that takes no character is given up --- */
void stm_say(const char *text);
void stm_say_u32(uint32_t value);
void stm_say_hex(uint32_t value);
int stm_same(const char *a, const char *b);

/* --- uart.c: three lines by DMA --- */
enum stm_uart { STM_LOG, STM_LINK, STM_MODBUS, STM_UARTS };
void stm_uart_open(void);
int stm_uart_send(enum stm_uart u, const uint8_t *byte, uint32_t n); /* 1: started; 0: busy */
int stm_uart_busy(enum stm_uart u);
/* Bytes that have come, as many as lie in one piece; skip takes n of them. */
uint32_t stm_uart_look(enum stm_uart u, const uint8_t **from);
void stm_uart_skip(enum stm_uart u, uint32_t n);
int stm_uart_damaged(enum stm_uart u); /* 1: one came with an error */
void stm_uart_stop(enum stm_uart u);   /* what is on its way out is cut off */

/* Bytes that wait for a line; size_B is a power of two. */
struct stm_fifo {
    uint8_t *byte;
    uint32_t size_B, put, got, under_way; /* put, got: bytes in all, modulo 2^32 */
    enum stm_uart uart;
};
int stm_fifo_put(struct stm_fifo *f, const uint8_t *byte, uint32_t len_B); /* all or 0 */
void stm_fifo_out(struct stm_fifo *f);                                     /* as much as goes */

/* --- log.c, link.c --- */
void stm_log_out(void);
void stm_log_flush(void); /* what waits goes out, or is given up */
void stm_link_out(void);
void stm_link_report(void);

/* --- modbus.c: UART4, 19200 8E1, address 1 --- */
void stm_modbus_open(const struct exh_scene *sc);
void stm_modbus_start(struct exh_scene_board board);
void stm_modbus_poll(const struct exh_scene_in *in); /* behind a tick's outputs */
uint8_t stm_modbus_command(void);
int stm_modbus_save(void); /* 1: to be saved, and the answer is out */

/* --- slot.c: parameters and calibrations in flash --- */
void stm_slot_write(void);                      /* at start: what a save has left in memory */
void stm_slot_load(const struct exh_scene *sc); /* into the scene */
void stm_slot_save(const struct exh_scene *sc); /* at rest; resets, does not return */

/* --- da.c: DAC81408 on SPI2 --- */
int stm_da_open(void); /* outputs zero, cleared by the pin: 0, -EXH_E_ABSENT */
/* Offset binary of the library (3249/V), all together. 0, -EXH_E_IO: SPI does not answer. */
int stm_da_write(const uint16_t raw[EXH_FINGERS]);
void stm_da_clear(void); /* outputs zero by the pin: any context */
int stm_da_silent(void); /* 1: three wrong answers in a row */

/* --- adc.c: monitors, supply, glove --- */
int stm_adc_open(void);  /* 0, -EXH_E_ABSENT: it does not convert, -EXH_E_IO: its DMA failed */
void stm_adc_half(void); /* the interrupt */
int stm_adc_late(void);  /* 1: nothing converted for three half circles, or a DMA error */
void stm_adc_read(struct exh_drive_in *in);
int stm_adc_glove(struct exh_glove_in *in, uint32_t tick);

/* --- box.c, or box_none.c: drives --- */
int stm_box_open(void); /* finds what is there and names what is not; drives disabled */
int stm_box_read_drive(struct exh_drive_in *in);
int stm_box_write_drive(const struct exh_drive_out *out);
int stm_box_read_glove(struct exh_glove_in *in, uint32_t tick);
void stm_box_safe(void); /* any time, any context */
void stm_box_report(void);

/* --- watchdog.c --- */
void stm_watchdog_start(struct exh_period T);
void stm_watchdog_feed(void);
int stm_watchdog_bitten(void); /* since power-on */

/* --- board.c --- */
void stm_systick(void);
void stm_fault(uint32_t exception); /* on a fresh stack; does not return */
uint32_t stm_ticks(void);           /* of SysTick, modulo 2^32 */
void stm_watch(void);               /* the first tick starts the watchdog: of images with a scene */
extern void (*stm_idle)(void);      /* while a tick is waited for; or NULL */

#endif
