/* SPDX-License-Identifier: MIT */
/* Integrity: is what must stand still still what it was, and does the machine reckon right?
 *
 * For scenes that want it; nothing else links it. What the guard finds is EXH_FAULT_CONFIG, what
 * the self-test does not is the step EXH_ARM_SELFTEST of arming.
 */
#ifndef EXHAND_INTEGRITY_H
#define EXHAND_INTEGRITY_H

#include "exhand/params.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_INTEGRITY_B     8 /* bytes of the area looked at in a tick */
#define EXH_INTEGRITY_WORDS 2 /* parameters likewise */

/* All zero: not sealed, nothing is looked at. */
struct exh_integrity {
    const uint8_t *area;       /* the caller's: configuration made at set-up */
    uint32_t len_B, at;        /* its bytes; those looked at in this round */
    uint32_t want, crc;        /* CRC-32 when it was sealed; of this round so far */
    struct exh_params *params; /* or NULL: it keeps its place in them itself */
    uint8_t broken;            /* 1: something differed; stays until sealed anew */
};

/* At the end of set-up: the area as it is now, none of which changes until it is sealed anew, and
 * the parameters (NULL: none, as where they are constants in ROM, or within the area). */
void exh_integrity_seal(
    struct exh_integrity *g, const void *area, size_t len_B, struct exh_params *params);

/* Once a tick, at constant cost: the next EXH_INTEGRITY_B bytes of the area, the CRC at the end of
 * a round, and exh_params_verify() at the next EXH_INTEGRITY_WORDS parameters. So a change of one
 * byte is told within len_B / 8 ticks, twice that if it was just passed by; one of a parameter
 * within count / 2, twice that in mid-slew. 1: something differs, or did. */
int exh_integrity_step(struct exh_integrity *g);

/* --- self-test: known answers, at set-up; what is reckoned depends on nothing --- */

/* What did not come out as it must. */
enum exh_selftest {
    EXH_SELFTEST_OK,       /* all did */
    EXH_SELFTEST_SHIFT,    /* shifts, roundings, saturation */
    EXH_SELFTEST_PRODUCT,  /* 64-bit products */
    EXH_SELFTEST_DIVISION, /* of set-up, and gains */
    EXH_SELFTEST_CRC,      /* CRC-32 of "123456789" */
    EXH_SELFTEST_SINE,     /* one angle's sine and cosine, bit for bit */
    EXH_SELFTEST_FILTER    /* a low-pass's first answers to a step, bit for bit */
};

/* enum exh_selftest: the first that failed, or 0. The second also tests what scenes with a glove
 * use, and links it. */
int exh_selftest(void);
int exh_selftest_glove(void);

#ifdef __cplusplus
}
#endif
#endif
