/* SPDX-License-Identifier: MIT */
/* Frame: raw codes of the device's five axes, as a board reads and writes them in a tick. */
#ifndef EXHAND_FRAME_H
#define EXHAND_FRAME_H

#include "exhand/bytes.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* digital inputs; every contact is normally closed: 1 = healthy */
enum exh_din {
    EXH_DIN_ESTOP = 1u << 0,    /* emergency-stop loop closed */
    EXH_DIN_DEADMAN = 1u << 1,  /* dead-man switch held */
    EXH_DIN_WATCHDOG = 1u << 2, /* no watchdog has fired since power-on */
    EXH_DIN_CARDS = 1u << 3,    /* the cards answer and do what they are told */
    EXH_DIN_DRIVE0 = 1u << 8    /* drive of finger i ready: EXH_DIN_DRIVE0 << i */
};

/* What a board reads in a tick, latched together. */
struct exh_drive_in {
    uint32_t enc_raw[EXH_FINGERS]; /* counter value, the board's width, low bits */
    int16_t mon_raw[EXH_FINGERS];  /* current monitor, two's complement */
    int16_t supply_raw;            /* supply monitor */
    uint32_t din;                  /* enum exh_din */
};

/* What it writes in a tick; made by exh_gate_step() alone. */
struct exh_drive_out {
    uint16_t dac_raw[EXH_FINGERS]; /* offset binary */
    uint8_t enable;                /* bit i: drive of finger i enabled */
    uint8_t alive;                 /* changes once per completed tick: the watchdog's kick */
};

/* The first n fingers of a frame through a cursor. */
void exh_drive_in_serialize(struct exh_bytes *c, struct exh_drive_in *in, unsigned n);
void exh_drive_out_serialize(struct exh_bytes *c, struct exh_drive_out *out, unsigned n);

#ifdef __cplusplus
}
#endif
#endif
