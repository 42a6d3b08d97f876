/* SPDX-License-Identifier: MIT */
#include "board.h"

#include <string.h>

enum { A, B, C, D };
struct pin {
    uint8_t port, pin;
};
static const struct {
    uint8_t timer, function;
    struct pin a, b;
} encoder[EXH_FINGERS] = {{1, 1, {A, 8}, {A, 9}}, {2, 1, {A, 0}, {A, 1}}, {3, 2, {A, 6}, {A, 7}},
    {4, 2, {B, 6}, {B, 7}}, {8, 3, {C, 6}, {C, 7}}};
static const struct pin enable[EXH_FINGERS] = {{C, 8}, {C, 9}, {B, 8}, {B, 9}, {B, 5}};
static const struct pin ready[EXH_FINGERS] = {{C, 13}, {C, 14}, {C, 15}, {A, 15}, {B, 4}};
static const struct pin mux[4] = {{A, 4}, {A, 5}, {B, 3}, {B, 2}};
static const struct pin estop = {A, 3}, deadman = {A, 10}, sync = {B, 12}, clear = {D, 2},
                        alive = {C, 12};
static const struct pin spi[3] = {{B, 13}, {B, 14}, {B, 15}};

void (*board_sent)(unsigned usart, uint8_t byte);
void (*board_changed)(void);
static struct board *board; /* the one that is wired */
static struct stm *chip;

static int level(const struct stm *s, struct pin p) { return stm_port_out(s, p.port) >> p.pin & 1; }

static int is_function(const struct stm *s, struct pin p, unsigned function)
{
    return stm_pin_mode(s, p.port, p.pin) == 2 && stm_pin_function(s, p.port, p.pin) == function;
}

/* --- what the chip does to the board --- */

/* +-10 V of the library's codes brought to 0 .. 3.3 V: 12 bits of them. */
static uint16_t code12(int16_t raw) { return (uint16_t)(((int32_t)raw + 32768) >> 4); }

static uint16_t analog(void *ctx, unsigned channel)
{
    unsigned address = 0;
    (void)ctx;
    for (unsigned i = 0; i < 4; i++) { address |= (unsigned)level(chip, mux[i]) << i; }
    if (channel >= 10 && channel < 15) { return code12(board->mon[channel - 10]); }
    if (channel == 15) { return code12(board->supply); }
    if (channel == 8 && address < 11) { return code12(board->glove[address]); }
    if (channel == 9 && address < 11) { return code12(board->glove[11 + address]); }
    return 0;
}

static int spi_wired(unsigned n)
{
    return n == 2 && is_function(chip, spi[0], 5) && is_function(chip, spi[2], 5);
}

static void spi_out(void *ctx, unsigned n, uint16_t word, unsigned bits)
{
    (void)ctx;
    board->da.silent = (chip->wrong >> STM_DA_SILENT & 1) != 0;
    /* Mode 1: idle low, taken at the falling edge. */
    if (spi_wired(n) && bits == 8 && (chip->spi[2].r[0] & 3) == 1) {
        da_byte(&board->da, (uint8_t)word);
    }
}

static uint16_t miso(void *ctx, unsigned n)
{
    (void)ctx;
    return spi_wired(n) && is_function(chip, spi[1], 5) ? da_answer(&board->da) : 0;
}

static void pins(void *ctx, unsigned port, uint16_t was, uint16_t is)
{
    const unsigned changed = (unsigned)was ^ is;
    (void)ctx;
    if (port == sync.port && changed >> sync.pin & 1) { da_sync(&board->da, is >> sync.pin & 1); }
    if (port == clear.port && changed >> clear.pin & 1) {
        da_clear(&board->da, is >> clear.pin & 1);
    }
    if (board_changed) { board_changed(); }
}

static void sent(void *ctx, unsigned usart, uint8_t byte)
{
    (void)ctx;
    if (board_sent) { board_sent(usart, byte); }
}

void board_open(struct board *b, struct stm *s)
{
    memset(b, 0, sizeof *b);
    da_power_on(&b->da);
    da_clear(&b->da, 0); /* its resistor holds it */
    board = b;
    chip = s;
    stm_outside.analog = analog;
    stm_outside.spi = spi_out;
    stm_outside.miso = miso;
    stm_outside.pins = pins;
    stm_outside.sent = sent;
}

/* --- what the device does to the board --- */

static void put_pin(struct stm *s, struct pin p, int high)
{
    const unsigned bit = 1u << p.pin;
    s->port[p.port].in = (uint16_t)(high ? s->port[p.port].in | bit : s->port[p.port].in & ~bit);
}

/* Of four quarters A is high in two. Where B never is, each edge of A takes back the one before. */
static int line_a(uint32_t enc) { return (int)((enc + 1) >> 1 & 1); }

static void turn(struct board *b, struct stm *s, unsigned i, uint32_t enc)
{
    const int wired = is_function(s, encoder[i].a, encoder[i].function) &&
                      is_function(s, encoder[i].b, encoder[i].function);
    const int32_t truth = (int32_t)(enc - b->enc[i]);
    int32_t quarters = truth + b->jump[i];
    if (b->half >> i & 1) { quarters = line_a(enc) - line_a(b->enc[i]); }
    b->enc[i] = enc;
    b->jump[i] = 0;
    if (b->stuck >> i & 1) { quarters = 0; }
    if (b->miswired >> i & 1) { quarters = -quarters; }
    b->misread += (uint32_t)(quarters > truth ? quarters - truth : truth - quarters);
    if (wired) { stm_tim_turn(s, encoder[i].timer, quarters); }
}

void board_put(struct board *b, struct stm *s, const struct exh_drive_in *in)
{
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        turn(b, s, i, in->enc_raw[i]);
        b->mon[i] = in->mon_raw[i];
        put_pin(s, ready[i], (in->din & (uint32_t)EXH_DIN_DRIVE0 << i) != 0);
    }
    b->supply = in->supply_raw;
    put_pin(s, estop, (in->din & EXH_DIN_ESTOP) != 0);
    put_pin(s, deadman, (in->din & EXH_DIN_DEADMAN) != 0);
}

/* Volts of the D/A as codes of the library's, 3249 a volt. */
static uint16_t code_of(int32_t uV)
{
    const int64_t n = (int64_t)uV * 3249;
    return (uint16_t)(32768 + (n + (n < 0 ? -500000 : 500000)) / 1000000);
}

unsigned board_enables(const struct stm *s)
{
    unsigned on = board->welded;
    for (unsigned i = 0; i < EXH_FINGERS; i++) { on |= (unsigned)level(s, enable[i]) << i; }
    return on;
}

void board_get(const struct board *b, const struct stm *s, struct exh_drive_out *out)
{
    memset(out, 0, sizeof *out);
    for (unsigned i = 0; i < EXH_FINGERS; i++) { out->dac_raw[i] = code_of(da_uV(&b->da, i)); }
    out->enable = (uint8_t)board_enables(s);
    out->alive = (uint8_t)level(s, alive);
}
