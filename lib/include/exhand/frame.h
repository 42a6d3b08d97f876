/* SPDX-License-Identifier: MIT */
/* Frame: the raw codes of the five axes that a board reads and writes in a tick. */
#ifndef EXHAND_FRAME_H
#define EXHAND_FRAME_H

#include "exhand/bytes.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Digital inputs. Every contact is normally closed: 1 means healthy. */
enum exh_din {
    EXH_DIN_ESTOP = 1u << 0,    /* emergency-stop loop closed */
    EXH_DIN_DEADMAN = 1u << 1,  /* dead-man switch held */
    EXH_DIN_WATCHDOG = 1u << 2, /* no watchdog has fired since power-on */
    EXH_DIN_CARDS = 1u << 3,    /* the cards answer and obey their commands */
    EXH_DIN_DRIVE0 = 1u << 8    /* drive of finger i ready: EXH_DIN_DRIVE0 << i */
};

/* The inputs that a board latches together in a tick. */
struct exh_drive_in {
    uint32_t enc_raw[EXH_FINGERS]; /* counter values; the low enc_bits count */
    int16_t mon_raw[EXH_FINGERS];  /* current monitor, two's complement */
    int16_t supply_raw;            /* supply monitor */
    uint32_t din;                  /* enum exh_din */
};

/* The outputs that a board writes in a tick. Only exh_gate_step() makes them. */
struct exh_drive_out {
    uint16_t dac_raw[EXH_FINGERS]; /* offset binary */
    uint8_t enable;                /* bit i: drive of finger i enabled */
    uint8_t alive;                 /* toggles once per completed tick: the watchdog's kick */
};

/* The first n fingers of a frame through a cursor, n <= EXH_FINGERS. */
void exh_drive_in_serialize(struct exh_bytes *c, struct exh_drive_in *in, unsigned n);
void exh_drive_out_serialize(struct exh_bytes *c, struct exh_drive_out *out, unsigned n);

#ifdef __cplusplus
}
#endif
#endif
