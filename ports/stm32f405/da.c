/* SPDX-License-Identifier: MIT */
/* The D/A: a DAC81408, eight channels of 16 bits and +-10 V, on SPI2. At power-on its channels are
 * off, and its registers hold -10 V of a bipolar range. A low pin CLR makes buffers and outputs
 * zero at any time. A resistor holds it low over a reset. Source: TI SLASER3A, "Clear DAC
 * Operation": a bipolar range is cleared to its middle. Frames of 24 bits, SPI mode 1 and the
 * register map are those of public drivers for this family. */
#include "da_code.h"
#include "stm.h"

#include "exhand/error.h"

#define POLLS      100u /* ten times what a byte takes: 28 waits are not to cost a watchdog */
#define CHANNELS   8u
#define QUARTER    1u /* 42 MHz / 4: 10.5 MHz where an answer comes back */
#define HALF       0u /* 21 MHz of the 50 that its data sheet allows to write */
#define RESET_CODE 0xAu
#define SILENT_MAX 3u

static uint8_t asked; /* the next frame brings SPICONFIG back */
static uint8_t wrong;
static volatile uint8_t cleared; /* CLR is low */

static void set_clock(uint32_t fraction)
{
    REG(BASE_SPI2, SPI_CR1) = SPI_CR1_CPHA | SPI_CR1_MSTR | PUT(SPI_CR1_BR, fraction) |
                              SPI_CR1_SSI | SPI_CR1_SSM | SPI_CR1_SPE;
}

/* Waits until SPI has this status: 0 or -EXH_E_IO. */
static int comes(uint32_t mask, uint32_t want)
{
    uint32_t n = 0;
    while (n < POLLS && (REG(BASE_SPI2, SPI_SR) & mask) != want) { n++; }
    return n == POLLS ? -EXH_E_IO : 0;
}

/* Writes the bytes one after another. Incoming bytes are not read, because an interrupt may come
 * between two of them. */
static int write(uint32_t out)
{
    int err = 0;
    PIN_LOW(DA_SYNC);
    for (int shift = 16; shift >= 0; shift -= 8) {
        *(volatile uint8_t *)((uintptr_t)BASE_SPI2 + SPI_DR) = (uint8_t)(out >> shift);
        err |= comes(SPI_SR_TXE, SPI_SR_TXE);
    }
    err |= comes(SPI_SR_BSY, 0);
    PIN_HIGH(DA_SYNC);
    return err;
}

/* Writes and reads; *back has the answer. 0 or -EXH_E_IO. */
static int frame(uint32_t out, uint32_t *back)
{
    uint32_t in = 0;
    int err = 0;
    PIN_LOW(DA_SYNC);
    for (int shift = 16; shift >= 0; shift -= 8) {
        *(volatile uint8_t *)((uintptr_t)BASE_SPI2 + SPI_DR) = (uint8_t)(out >> shift);
        err |= comes(SPI_SR_RXNE, SPI_SR_RXNE);
        in = in << 8 | (REG(BASE_SPI2, SPI_DR) & 0xFFu);
    }
    err |= comes(SPI_SR_BSY, 0);
    PIN_HIGH(DA_SYNC);
    if (back) { *back = in; }
    return err;
}

static int put(uint32_t at, uint32_t value) { return frame(at << 16 | value, NULL); }

static int get(uint32_t at, uint32_t *value)
{
    const int err = frame(DA_READ | at << 16, NULL);
    return err < 0 ? err : frame(0, value);
}

static void open_spi(void)
{
    REG(BASE_RCC, RCC_APB1ENR) |= RCC_APB1ENR_SPI2EN;
    (void)REG(BASE_RCC, RCC_APB1ENR);
    REG(BASE_SPI2, SPI_CR1) = 0;
    set_clock(QUARTER);
    (void)REG(BASE_SPI2, SPI_DR); /* drops an older byte: it is no answer */
}

/* Zero is in every channel before one is on. CLR goes up for that, while all channels are off: it
 * may keep codes out. Its edge makes them zero once more. Codes cannot be read: a sibling of this
 * part reads them as 0 (TI, E2E thread 1235803). Configurations can (TI SLASER3A, "SPICONFIG"). */
static int set_up(void)
{
    uint32_t gen = 0;
    int bad;
    (void)put(DA_GENCONFIG, DA_GEN_REF);
    (void)put(DA_SYNCCONFIG, DA_SYNC_ALL);
    (void)put(DA_DACRANGE0, DA_RANGE_10V);
    (void)put(DA_DACRANGE1, DA_RANGE_10V);
    PIN_HIGH(DA_CLR);
    for (unsigned i = 0; i < CHANNELS; i++) { (void)put(DA_DAC(i), DA_ZERO); }
    (void)put(DA_TRIGGER, DA_LDAC);
    PIN_LOW(DA_CLR);
    bad = get(DA_GENCONFIG, &gen) < 0 || (gen & 0xFFFFu) != DA_GEN_REF;
    if (!bad) { (void)put(DA_DACPWDWN, DA_ON_0_TO_4); }
    return bad ? -EXH_E_ABSENT : 0;
}

int stm_da_open(void)
{
    uint32_t id = 0;
    PIN_LOW(DA_CLR);
    PIN_HIGH(DA_SYNC);
    cleared = 1;
    asked = wrong = 0;
    open_spi();
    (void)put(DA_TRIGGER, RESET_CODE);
    stm_delay_us(5000);
    (void)put(DA_SPICONFIG, DA_SPI_RUN);
    if (get(DA_DEVICEID, &id) < 0 || (id & 0xFFFFu) >> 2 != DA_ID) { return -EXH_E_ABSENT; }
    return set_up();
}

/* Checks the answer to the previous tick's last frame. A D/A that is absent, or was reset, has
 * another SPICONFIG. */
static void compare(uint32_t back)
{
    if (!asked) { return; }
    wrong = (uint8_t)((back & 0xFFFFu) == DA_SPI_RUN ? 0 : wrong < SILENT_MAX ? wrong + 1 : wrong);
}

int stm_da_silent(void) { return wrong == SILENT_MAX; }

/* Where CLR was low its registers are zero, so it goes up before the codes that it would keep
 * out. */
int stm_da_write(const uint16_t raw[EXH_FINGERS])
{
    int err = 0;
    if (cleared) {
        cleared = asked = 0;
        PIN_HIGH(DA_CLR);
    }
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        const uint32_t out = DA_DAC(i) << 16 | stm_da_code(raw[i]);
        uint32_t back;
        if (i == 0) {
            err |= frame(out, &back);
            compare(back);
            set_clock(HALF);
        } else {
            err |= write(out);
        }
    }
    err |= write(DA_TRIGGER << 16 | DA_LDAC);
    err |= write(DA_READ | DA_SPICONFIG << 16);
    (void)REG(BASE_SPI2, SPI_DR); /* drops unread bytes; */
    (void)REG(BASE_SPI2, SPI_SR); /* behind it, this ends the overrun, or the next byte is lost */
    set_clock(QUARTER);
    asked = 1;
    return err ? -EXH_E_IO : 0;
}

/* By the pin alone: SPI may be what is broken, or in the middle of a frame. */
void stm_da_clear(void)
{
    PIN_LOW(DA_CLR);
    cleared = 1;
}
