/* SPDX-License-Identifier: MIT */
/* Errors: return codes and the assertion that stays active in release builds.
 *
 * There are three ways to report (docs/DESIGN.md 13). Set-up, input and output return 0 or a
 * negative code -EXH_E_.... The control path cannot fail: it saturates and sets a limit bit
 * (safety.h). A programming error goes to EXH_ASSERT.
 *
 *   int err = exh_quad_setup(&cfg, &par, T, 16);
 *   if (err < 0) { puts(exh_error_text(err)); } */
#ifndef EXHAND_ERROR_H
#define EXHAND_ERROR_H

#include "exhand/units.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Error codes. Functions, packets and registers carry the negated code. */
enum exh_error {
    EXH_OK = 0,         /* success */
    EXH_E_RANGE = 1,    /* a value lies outside its documented range */
    EXH_E_UNKNOWN = 2,  /* no signal, record or command has this id */
    EXH_E_STATE = 3,    /* the call is not allowed now, such as a set-up value after the lock */
    EXH_E_CRC = 4,      /* the checksum disagrees: bytes are damaged */
    EXH_E_VERSION = 5,  /* the version or the signal table differs from ours */
    EXH_E_SHORT = 6,    /* input is truncated, or a buffer is too small */
    EXH_E_MONOTONE = 7, /* the values of a conversion table do not rise strictly */
    EXH_E_RATE = 8,     /* this loop rate is not possible */
    EXH_E_IO = 9,       /* a device gave a wrong answer, or none in time */
    EXH_E_ABSENT = 10,  /* the device does not exist */
    EXH_E_STALE = 11,   /* a calibration is too old, or older than a change */
    EXH_E_CUTOFF = 12,  /* the cut-off frequency is at or above half the sample rate */
    EXH_E_GAINS = 13,   /* stiffness and damping violate the rule of gains */
    EXH_E_COUNT = 14    /* number of codes; not an error */
};

/* A description of a returned code in one line of English. Ignores the sign. Never NULL. */
const char *exh_error_text(int code);

/* Sets the outputs to a safe state, then stops; must not return. The program defines it, as
 * lib/src/run/loop.c does. The library needs no other symbol except mem*(). A C++ program includes
 * this header before it defines the function, to get C linkage. */
void exh_assert_failed(const char *file, int line);

/* Stops the program if cond is 0, in release builds too: a human finger is near. */
#define EXH_ASSERT(cond) \
    do { \
        if (!(cond)) { exh_assert_failed(__FILE__, __LINE__); } \
    } while (0)

#ifdef __cplusplus
}
#endif
#endif
