/* SPDX-License-Identifier: MIT */
/* A box with registers, and requests for them: what modbus and modbus_rtu share. */
#ifndef TEST_GOLDEN_MODBUS_BOX_H
#define TEST_GOLDEN_MODBUS_BOX_H

#include "golden.h"

#include "exhand/regs.h"

#define BOX_SIGNALS   64
#define BOX_PARAMS    68
#define BOX_FRAMES    8
#define BOX_REQUEST_B 320u /* more than any request has: some are too long */

struct golden_box {
    struct exh_regs regs;
    struct exh_params params;
    struct exh_trace trace;
    struct exh_trace_frame frame[BOX_FRAMES];
    int32_t signal[BOX_SIGNALS];
    int32_t active[BOX_PARAMS], wanted[BOX_PARAMS], staged[BOX_PARAMS];
    uint32_t touched[EXH_REGS_WORDS(BOX_PARAMS)];
};

void golden_box_setup(struct golden_box *b, struct golden_rng *r, struct exh_period T);

/* Another tick k of the box: what registers show changes. */
void golden_box_tick(struct golden_box *b, struct golden_rng *r, uint32_t k);

/* Some request, right or not; its bytes. */
uint32_t golden_request(const struct golden_box *b, struct golden_rng *r, uint8_t *req);

/* Puts bytes as their length, the first six of them and a CRC. */
void golden_put_bytes(struct golden *g, const uint8_t *p, uint32_t len_B);

/* Between two ticks: every other time what was commanded is carried out. */
void golden_box_between(struct golden *g, struct golden_box *b, struct golden_rng *r);

#endif
