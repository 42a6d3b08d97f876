/* SPDX-License-Identifier: MIT */
/* Errors: what a call that may fail returns, and the assertion that stays on.
 *
 * Three lanes (docs/DESIGN.md 13): set-up, input and output return 0 or a
 * negative -EXH_E…; the control path cannot fail, it saturates and sets a limit
 * bit (safety.h); a programmer's mistake goes to EXH_ASSERT.
 */
#ifndef EXHAND_ERROR_H
#define EXHAND_ERROR_H

#include "exhand/units.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Error codes. Functions, packets and registers carry them negated. */
enum exh_error {
    EXH_OK = 0,         /* done */
    EXH_E_RANGE = 1,    /* a value lies outside its documented range */
    EXH_E_UNKNOWN = 2,  /* no such signal, record or command */
    EXH_E_STATE = 3,    /* right call, wrong time (a set-up value while locked) */
    EXH_E_CRC = 4,      /* bytes damaged */
    EXH_E_VERSION = 5,  /* another version or another table than ours */
    EXH_E_SHORT = 6,    /* bytes end too early, or a buffer is too small */
    EXH_E_MONOTONE = 7, /* a conversion table does not rise strictly */
    EXH_E_RATE = 8,     /* the loop rate cannot be had */
    EXH_E_IO = 9,       /* a device answered wrongly or not in time */
    EXH_E_ABSENT = 10,  /* a device is not there */
    EXH_E_STALE = 11,   /* a calibration too old, or made before a change */
    EXH_E_CUTOFF = 12,  /* a cut-off at or above half the rate */
    EXH_E_GAINS = 13,   /* stiffness and damping outside the rule of gains */
    EXH_E_COUNT = 14    /* how many there are; not an error */
};

/* One line of plain English for a returned code (sign ignored). Never NULL. */
const char *exh_error_text(int code);

/* The library's one hook besides mem*: makes the outputs safe, then stops.
 * The program defines it (lib/src/run/loop.c does); it must not return. */
void exh_assert_failed(const char *file, int line);

/* On in release: a violated contract near a human finger is a reason to stop. */
#define EXH_ASSERT(cond) \
    do { \
        if (!(cond)) { exh_assert_failed(__FILE__, __LINE__); } \
    } while (0)

#ifdef __cplusplus
}
#endif
#endif
