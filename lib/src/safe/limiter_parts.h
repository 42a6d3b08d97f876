/* SPDX-License-Identifier: MIT */
/* Common parts of the limiter's sources. Not part of the library's interface. */
#ifndef EXH_LIMITER_PRIVATE_H
#define EXH_LIMITER_PRIVATE_H

#include "exhand/limiter.h"

#define EXH_LIMITER_FULL_Q30 (INT32_C(1) << 30)

/* 1 where the drive may be on: all states but OFF and FAULT. */
static inline uint32_t exh_limiter_is_on(unsigned state)
{
    return state >= EXH_STATE_ARM && state <= EXH_STATE_RELEASE;
}

/* Latches the causes present, and goes on by the table of the box (safety.h). */
void exh_limiter_go_on(struct exh_limiter *s, const struct exh_limiter_cfg *cfg,
    const struct exh_limiter_in *in, uint32_t present);

#endif
