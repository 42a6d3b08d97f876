/* SPDX-License-Identifier: MIT */
/* Authority: who may change which parameter, and when. One table denies every change that it does
 * not list. All ways to a parameter use it (params.h, regs.h, wire.h). */
#ifndef EXHAND_AUTHORITY_H
#define EXHAND_AUTHORITY_H

#include "exhand/error.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The source of a change. */
enum exh_source {
    EXH_FROM_PERSON,   /* at the device: command line, boot option; a replayed log */
    EXH_FROM_IMAGE,    /* an image of parameters */
    EXH_FROM_REGISTER, /* Modbus register */
    EXH_FROM_WORLD,    /* PARAM packet over the link */
    EXH_SOURCES        /* number of sources */
};

/* The source, and the state of the device. */
struct exh_authority {
    uint8_t source; /* enum exh_source */
    uint8_t locked; /* set-up is over: exh_params.locked */
    uint8_t open;   /* gate is open or may open: any state except OFF and FAULT (safety.h) */
};

/* Checks a change from was, the staged value, to raw. when is enum exh_signal_when. Returns 0 if
 * the source may make it, else -EXH_E_STATE. Unknown sources and classes are refused. Ranges are
 * not checked. */
int exh_authority_check(struct exh_authority who, unsigned when, int32_t was, int32_t raw);

#ifdef __cplusplus
}
#endif
#endif
