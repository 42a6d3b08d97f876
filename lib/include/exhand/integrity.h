/* SPDX-License-Identifier: MIT */
/* Integrity: detects changed configuration memory and wrong arithmetic.
 *
 * Optional; nothing else links it. A change that the guard finds is EXH_FAULT_CONFIG. A failed
 * self-test blocks the arming step EXH_ARM_SELFTEST.
 *
 *   exh_integrity_seal(&guard, &config, sizeof config, &params); // end of set-up
 *   if (exh_integrity_step(&guard)) { raised |= EXH_FAULT_CONFIG; } // every tick */
#ifndef EXHAND_INTEGRITY_H
#define EXHAND_INTEGRITY_H

#include "exhand/params.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_INTEGRITY_B     8 /* bytes of the area checked per tick */
#define EXH_INTEGRITY_WORDS 2 /* parameters checked per tick */

/* The guard. All zeros: not sealed, no checks. */
struct exh_integrity {
    const uint8_t *area;       /* the caller's configuration, made at set-up */
    uint32_t len_B, at;        /* length; bytes checked in this round */
    uint32_t want, crc;        /* CRC-32 when sealed; of this round so far */
    struct exh_params *params; /* or NULL; keeps its own position */
    uint8_t broken;            /* 1: a difference was found; stays until sealed again */
};

/* End of set-up: records the area as it is now. The area must not change until sealed again. params
 * may be NULL, as for parameters in ROM or within the area. */
void exh_integrity_seal(
    struct exh_integrity *g, const void *area, size_t len_B, struct exh_params *params);

/* Once per tick, at constant cost. Checks the next EXH_INTEGRITY_B bytes of the area, the CRC at
 * the end of a round, and the next EXH_INTEGRITY_WORDS parameters by exh_params_verify(). It finds
 * a changed byte within len_B / 8 ticks, or twice that if the check has just passed it. It finds a
 * changed parameter within count / 2 ticks, or twice that while it slews. Returns 1 after a
 * difference. */
int exh_integrity_step(struct exh_integrity *g);

/* --- self-test: known answers, at set-up --- */

/* The test that failed. */
enum exh_selftest {
    EXH_SELFTEST_OK,       /* none */
    EXH_SELFTEST_SHIFT,    /* shifts, roundings, saturation */
    EXH_SELFTEST_PRODUCT,  /* 64-bit products */
    EXH_SELFTEST_DIVISION, /* division of set-up, and gains */
    EXH_SELFTEST_CRC,      /* CRC-32 of "123456789" */
    EXH_SELFTEST_SINE,     /* sine and cosine of one angle, bit for bit */
    EXH_SELFTEST_FILTER    /* first outputs of a low-pass step response, bit for bit */
};

/* The first failed test, enum exh_selftest, or 0. exh_selftest_glove() adds the glove's code. */
int exh_selftest(void);
int exh_selftest_glove(void);

#ifdef __cplusplus
}
#endif
#endif
