/* SPDX-License-Identifier: MIT */
/* Authority: who may change which parameter, and when; one table, which denies what it does not
 * name. Every way to a parameter asks it (params.h, regs.h, wire.h). */
#ifndef EXHAND_AUTHORITY_H
#define EXHAND_AUTHORITY_H

#include "exhand/error.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Whose wish it is. */
enum exh_source {
    EXH_FROM_PERSON,   /* at the box: command line, boot option; a log that is replayed */
    EXH_FROM_IMAGE,    /* an image of parameters */
    EXH_FROM_REGISTER, /* Modbus */
    EXH_FROM_WORLD,    /* PARAM over the link */
    EXH_SOURCES        /* how many there are */
};

/* Who asks, and in what box. */
struct exh_authority {
    uint8_t source; /* enum exh_source */
    uint8_t locked; /* set-up is over: exh_params.locked */
    uint8_t open;   /* the gate is open or may come to be: any state but OFF and FAULT (safety.h) */
};

/* 0 if a value of class `when` (enum exh_signal_when) may go from `was`, the value wanted, to
 * `raw`; -EXH_E_STATE if not. What is neither a source nor a class of these may not. Ranges and
 * rules are not asked. */
int exh_authority_check(struct exh_authority who, unsigned when, int32_t was, int32_t raw);

#ifdef __cplusplus
}
#endif
#endif
