/* SPDX-License-Identifier: MIT */
/* Bytes that wait for a line, the UART or the network: of the log and of the black box. */
#include "pc104.h"

#define STUCK_READS 100000u /* 0.07 s and more on ISA; 16 characters take 1.4 ms */
#define BURST_B     16u     /* size of the UART's FIFO */

int pc104_fifo_put(struct pc104_fifo *f, const uint8_t *byte, uint32_t len_B)
{
    if (len_B > f->size_B - (f->put - f->got)) { return 0; }
    for (uint32_t i = 0; i < len_B; i++) { f->byte[f->put++ & (f->size_B - 1)] = byte[i]; }
    return (int)len_B;
}

/* A piece that ends at the end of the ring is sent without waiting for more. Returns 1 if more can
 * be sent now. */
static int out_udp(struct pc104_fifo *f, int now)
{
    const uint32_t at = f->got & (f->size_B - 1);
    uint32_t n = f->put - f->got, taken;
    if (n == 0) { return 0; }
    if (n > f->size_B - at) {
        n = f->size_B - at;
        now = 1;
    }
    taken = pc104_link_log(&f->byte[at], n, now);
    f->got += taken;
    return taken > 0 && f->got != f->put;
}

int pc104_fifo_out(struct pc104_fifo *f, int32_t where, int now)
{
    const uint32_t at = f->got & (f->size_B - 1);
    uint32_t n = f->put - f->got;
    if (where == PC104_LOG_UDP) { return out_udp(f, now); }
    n = n < BURST_B ? n : BURST_B;
    n = n < f->size_B - at ? n : f->size_B - at;
    f->got += pc104_uart_offer(&f->byte[at], n);
    return f->got != f->put;
}

int pc104_fifo_wait(struct pc104_fifo *f, int32_t where)
{
    uint32_t stuck = 0;
    while (f->put != f->got && stuck < STUCK_READS) {
        const uint32_t before = f->got;
        (void)pc104_fifo_out(f, where, 1);
        stuck = before == f->got ? stuck + 1 : 0;
    }
    return f->put == f->got;
}

uint32_t pc104_fifo_flush(struct pc104_fifo *f, int32_t where)
{
    uint32_t rest;
    (void)pc104_fifo_wait(f, where);
    rest = f->put - f->got;
    f->put = f->got;
    return rest;
}
