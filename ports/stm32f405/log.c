/* SPDX-License-Identifier: MIT */
/* Records wait in memory for USART2: a whole one or nothing. */
#include "stm.h"

#include "exhand/board.h"

#define LOG_B 16384u    /* three of the largest records */
#define POLLS 10000000u /* all of it takes 82 ms */

static uint8_t memory[LOG_B];
static struct stm_fifo fifo = {memory, LOG_B, 0, 0, 0, STM_LOG};

int exh_board_log(const void *rec, size_t len_B)
{
    const int taken = len_B <= LOG_B ? stm_fifo_put(&fifo, rec, (uint32_t)len_B) : 0;
    stm_fifo_out(&fifo);
    return taken;
}

void stm_log_out(void) { stm_fifo_out(&fifo); }

/* Text comes behind it on the same line. Outputs are safe and the loop has ended: the watchdog is
 * fed meanwhile, or it would bite within these 82 ms and the words would be lost. */
void stm_log_flush(void)
{
    for (uint32_t n = 0; n < POLLS && (fifo.put != fifo.got || stm_uart_busy(STM_LOG)); n++) {
        stm_fifo_out(&fifo);
        stm_watchdog_feed();
    }
    stm_uart_stop(STM_LOG);
    fifo.got = fifo.put;
    fifo.under_way = 0;
}
