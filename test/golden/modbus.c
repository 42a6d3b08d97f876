/* SPDX-License-Identifier: MIT */
/* modbus: requests and their answers. modbus_rtu: the same on a serial line. mirror: binary32 and
 * back. */
#include "modbus_box.h"
#include "modules.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/modbus_rtu.h"

static struct golden_box box;

void golden_modbus(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("modbus", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        if (g->tick % 64 == 0) { golden_box_setup(&box, &r, golden_period(rate_Hz, g->tick)); }
        golden_box_tick(&box, &r, g->tick);
        for (unsigned i = 0; i < 3; i++) {
            uint8_t req[BOX_REQUEST_B], resp[EXH_MODBUS_PDU_B];
            const uint32_t len_B = golden_request(&box, &r, req);
            int n;
            golden_put_bytes(g, req, len_B);
            n = exh_modbus_answer(&box.regs, req, len_B, resp, sizeof resp);
            golden_put_bytes(g, resp, (uint32_t)n);
        }
        golden_box_between(g, &box, &r);
        golden_tick(g);
    }
}

/* --- a serial line --- */

static int any_line(struct exh_modbus_rtu *u, struct golden_rng *r)
{
    static const uint32_t baud[] = {299, 300, 9600, 19200, 19201, 115200, 10000000, 10000001};
    const int64_t how = golden_draw(r, 0, 9);
    const uint32_t some = (uint32_t)golden_draw(r, 300, 25000);
    const uint32_t address = (uint32_t)golden_draw(r, 0, 255);
    const int err = exh_modbus_rtu_setup(u, address, how < 8 ? baud[how] : some);
    if (err != 0) { CHECK_EQ_I64(exh_modbus_rtu_setup(u, 1 + (address & 127), some), 0); }
    return err;
}

/* A request in its frame, damaged now and then. */
static uint32_t any_frame(const struct exh_modbus_rtu *u, struct golden_rng *r, uint8_t *frame)
{
    uint32_t len_B = 1 + golden_request(&box, r, frame + 1);
    const int64_t who = golden_draw(r, 0, 7);
    const int64_t how = golden_draw(r, 0, 15);
    const uint8_t any = (uint8_t)golden_draw(r, 0, 255);
    uint16_t crc;
    if (how == 3) { len_B = 1; } /* no request at all */
    frame[0] = who < 2 ? 0 : who == 2 ? any : u->address;
    if (how == 0) {
        for (const uint32_t to_B = (uint32_t)golden_draw(r, 253, 255); len_B < to_B;) {
            frame[len_B++] = 0;
        }
    }
    crc = exh_crc16(frame, len_B);
    frame[len_B++] = (uint8_t)(crc & 0xFFu);
    frame[len_B++] = (uint8_t)(crc >> 8);
    if (how == 1) { len_B = (uint32_t)golden_draw(r, 1, len_B); }
    if (how == 2) {
        const int64_t at = golden_draw(r, 0, (int64_t)len_B - 1);
        frame[at] = (uint8_t)(frame[at] ^ UINT32_C(1) << golden_draw(r, 0, 7));
    }
    return len_B;
}

/* Bytes with a pause among them, or a damaged one; what the line says of the pause. */
static int bytes_come(
    struct exh_modbus_rtu *u, struct golden_rng *r, const uint8_t *frame, uint32_t len_B)
{
    const uint32_t at = (uint32_t)golden_draw(r, 0, len_B);
    const int64_t how = golden_draw(r, 0, 15);
    const uint32_t any = (uint32_t)golden_draw(r, 0, 2 * u->silence_us);
    int told;
    for (uint32_t i = 0; i < at; i++) { exh_modbus_rtu_receive(u, frame[i]); }
    told = exh_modbus_rtu_poll(u, how == 0   ? u->silence_us
                                  : how == 1 ? any
                                  : how == 2 ? UINT32_MAX
                                  : how < 8  ? u->silence_us - 1
                                             : 0);
    if (how == 15) { exh_modbus_rtu_discard(u); }
    for (uint32_t i = at; i < len_B; i++) { exh_modbus_rtu_receive(u, frame[i]); }
    return told;
}

static void one_frame(struct golden *g, struct exh_modbus_rtu *u, struct golden_rng *r)
{
    uint8_t frame[BOX_REQUEST_B + 3], resp[EXH_MODBUS_ADU_B];
    const uint32_t len_B = any_frame(u, r, frame);
    int64_t last;
    int n = 0;
    golden_put_bytes(g, frame, len_B);
    golden_put(g, exh_crc16(frame, len_B > 0 ? len_B - 1 : 0));
    golden_put(g, bytes_come(u, r, frame, len_B));
    golden_put(g, exh_modbus_rtu_poll(u, u->silence_us - 1));
    last = golden_draw(r, 0, 7);
    golden_put(g, exh_modbus_rtu_poll(u, last == 0 ? 0 : last == 1 ? UINT32_MAX : 1));
    if (golden_draw(r, 0, 7) != 0) { n = exh_modbus_rtu_answer(u, &box.regs, resp, sizeof resp); }
    golden_put_bytes(g, resp, (uint32_t)n);
    golden_put(g, u->taken);
    golden_put(g, u->others);
    golden_put(g, u->damaged);
}

void golden_modbus_rtu(struct golden *g, uint32_t rate_Hz)
{
    static struct exh_modbus_rtu line;
    struct golden_rng r = golden_rng("modbus_rtu", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        int err = 0;
        if (g->tick % 64 == 0) { golden_box_setup(&box, &r, golden_period(rate_Hz, g->tick)); }
        if (g->tick % 8 == 0) { err = any_line(&line, &r); }
        golden_put(g, err);
        golden_put(g, line.silence_us);
        golden_box_tick(&box, &r, g->tick);
        one_frame(g, &line, &r);
        golden_box_between(g, &box, &r);
        golden_tick(g);
    }
}

/* --- binary32 --- */

/* Anything, what is no number, halves between two raw values, the ends of an int32. */
static uint32_t any_bits(struct golden_rng *r, unsigned frac)
{
    const int64_t how = golden_draw(r, 0, 7);
    const uint32_t any = (uint32_t)golden_draw(r, 0, UINT32_MAX);
    const int64_t near = golden_draw(r, -2, 2);
    const int32_t small = (int32_t)golden_draw(r, -4096, 4096);
    if (how == 0) { return any; }
    if (how == 1) { return (any & 0x807FFFFFu) | 0x7F800000u; }
    if (how == 2) { return any & 0x807FFFFFu; }
    if (how == 3) { return exh_float_from_raw(small >> 10, frac > 124 ? frac : frac + 2); }
    if (how == 4) { return exh_float_from_raw(small, frac > 125 ? frac : frac + 1); }
    return (exh_float_from_raw(how == 5   ? INT32_MIN
                               : how == 6 ? INT32_MAX
                                          : exh_from_u32(any),
                frac) +
               (uint32_t)near) &
           0xFFFFFFFFu;
}

void golden_mirror(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("mirror", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        for (unsigned i = 0; i < 4; i++) {
            const int64_t some = golden_draw(&r, 0, 144);
            const unsigned frac = some > 126 ? 126 : (unsigned)some;
            const int32_t any = (int32_t)golden_draw(&r, INT32_MIN, INT32_MAX);
            const int32_t of = any >> golden_draw(&r, 0, 31);
            const uint32_t bits = any_bits(&r, frac);
            int32_t raw = 99;
            const int err = exh_float_to_raw(bits, frac, &raw);
            golden_put(g, frac);
            golden_put(g, of);
            golden_put(g, bits);
            golden_put(g, exh_float_from_raw(of, frac));
            golden_put(g, err);
            golden_put(g, raw);
        }
        golden_tick(g);
    }
}
