/* SPDX-License-Identifier: MIT */
/* Registers: the device as Modbus registers, made from its tables; the same map for every port.
 *
 * docs/MODBUS.md describes the map. Addresses are protocol addresses, from 0. A value has 32 bits
 * in two registers, high word first. A request outside the map gets exception 2, a forbidden one
 * exception 3; neither changes anything. */
#ifndef EXHAND_REGS_H
#define EXHAND_REGS_H

#include "exhand/params.h"
#include "exhand/safety.h"
#include "exhand/signal.h"
#include "exhand/trace.h"
#include "exhand/units.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- the map --- */

#define EXH_REGS_MAGIC 0x45584831u /* "EXH1" */
/* major << 16 | minor. A new major changes meanings, a new minor adds values. */
#define EXH_REGS_VERSION 0x00010001u

/* The kind of a register: the function code that reads it. */
enum exh_regs_kind {
    EXH_REGS_COIL = 1,     /* bits for commands */
    EXH_REGS_DISCRETE = 2, /* bits to read */
    EXH_REGS_HOLDING = 3,  /* registers to read and write */
    EXH_REGS_INPUT = 4     /* registers to read only */
};

/* First registers. Value i of a table has the registers first + 2 i and first + 2 i + 1. */
#define EXH_REGS_HEAD_AT         0x0000u /* input: enum exh_regs_head */
#define EXH_REGS_TRACE_AT        0x0400u /* input: enum exh_regs_trace; holding: EVERY and later */
#define EXH_REGS_FRAMES_AT       0x0440u /* input: frames of the trace */
#define EXH_REGS_SIGNAL_AT       0x1000u /* input: outputs of the tick, raw */
#define EXH_REGS_SIGNAL_FLOAT_AT 0x3000u /* input: the same as binary32 in the unit of the row */
#define EXH_REGS_PARAM_AT        0x5000u /* input: active parameters; holding: staged; raw */
#define EXH_REGS_PARAM_FLOAT_AT  0x7000u /* the same as binary32 */
#define EXH_REGS_VALUES          4096u   /* most values of one table */

/* Values of the head, two input registers each. */
enum exh_regs_head {
    EXH_HEAD_MAGIC,       /* EXH_REGS_MAGIC */
    EXH_HEAD_VERSION,     /* EXH_REGS_VERSION */
    EXH_HEAD_TEST_INT,    /* 0x12345678 */
    EXH_HEAD_TEST_FLOAT,  /* binary32 1.0 */
    EXH_HEAD_TICK,        /* from exh_regs_status, as all up to MISSED */
    EXH_HEAD_STATE,       /* enum exh_state */
    EXH_HEAD_FAULTS,      /* enum exh_fault, latched */
    EXH_HEAD_FIRST,       /* the first of them; stays after CLEAR */
    EXH_HEAD_FIRST_TICK,  /* tick of the first fault */
    EXH_HEAD_PRESENT,     /* enum exh_fault, in the last tick */
    EXH_HEAD_LIMITS,      /* enum exh_limit, in the last tick */
    EXH_HEAD_ARM_STEP,    /* enum exh_arm: present step of arming, or last refused */
    EXH_HEAD_DIN,         /* enum exh_din */
    EXH_HEAD_MISSED,      /* ticks missed since set-up, saturating */
    EXH_HEAD_SIGNALS,     /* values in the table of outputs */
    EXH_HEAD_PARAMS,      /* values in the table of parameters */
    EXH_HEAD_SIGNALS_CRC, /* exh_signal_crc() of the table of outputs */
    EXH_HEAD_PARAMS_CRC,  /* exh_signal_crc() of the table of parameters */
    EXH_HEAD_PERIOD_NUM,  /* the loop's period in seconds: num / den */
    EXH_HEAD_PERIOD_DEN,  /* denominator of it */
    EXH_HEAD_LIB_VERSION, /* EXH_VERSION_NUMBER */
    EXH_HEAD_FINGERS,     /* drives in use */
    EXH_HEAD_STAGED,      /* values staged here that differ from the wanted ones */
    EXH_HEAD_PENDING,     /* coils commanded and not yet executed, bit k: coil k */
    EXH_HEAD_DONE,        /* commands executed since set-up, modulo 2^32 */
    EXH_HEAD_RESULT,      /* result of the last of them: 0 or -EXH_E_... */
    EXH_HEAD_NAME_0,      /* name of the scene, four characters per value, first one highest */
    EXH_HEAD_NAME_1,      /* the next four */
    EXH_HEAD_NAME_2,      /* the next four */
    EXH_HEAD_NAME_3,      /* the last four, zero-padded */
    EXH_HEAD_REFUSED,     /* writes and APPLY refused since set-up, modulo 2^32; new in 1.1 */
    EXH_HEADS             /* number of values */
};

/* Discrete inputs: 32 per row, bit k at first + k. */
enum exh_regs_bits {
    EXH_BITS_FAULTS,  /* 0: enum exh_fault, latched */
    EXH_BITS_PRESENT, /* 32: enum exh_fault, in the last tick */
    EXH_BITS_DIN,     /* 64: enum exh_din */
    EXH_BITS_STATE,   /* 96: bit k is 1 in enum exh_state k */
    EXH_BITS_LIMITS,  /* 128: enum exh_limit, in the last tick */
    EXH_BITS_ARM,     /* 160: enum exh_arm: present step of arming, or last refused */
    EXH_BITS          /* number of rows */
};

/* Coils. Writing 1 commands, 0 does nothing. A coil reads as 1 while it is pending. */
enum exh_regs_coil {
    EXH_COIL_APPLY,   /* apply all staged values, between two ticks */
    EXH_COIL_DISCARD, /* discard all staged values */
    EXH_COIL_SAVE,    /* save the wanted parameters where the port keeps them */
    EXH_COIL_OFF,     /* EXH_CMD_OFF */
    EXH_COIL_RUN,     /* EXH_CMD_RUN */
    EXH_COIL_CLEAR,   /* EXH_CMD_CLEAR */
    EXH_COILS         /* number of coils */
};

/* The trace, two registers each. Its holding registers start with EVERY at EXH_REGS_TRACE_AT.
 * Writing any of them starts a new trace. */
enum exh_regs_trace {
    EXH_TRACE_HEAD_FRAMES,   /* capacity in frames, a power of two */
    EXH_TRACE_HEAD_NEXT,     /* number of the next frame, modulo 2^32 */
    EXH_TRACE_HEAD_OLDEST,   /* number of the oldest frame held; that of NEXT: none */
    EXH_TRACE_HEAD_RUN,      /* traces started, modulo 2^32 */
    EXH_TRACE_HEAD_EVERY,    /* ticks between frames; 0: no trace */
    EXH_TRACE_HEAD_SIGNAL_0, /* index of the first signal in the table of outputs */
    EXH_TRACE_HEAD_SIGNAL_1, /* index of the second */
    EXH_TRACE_HEAD_SIGNAL_2, /* index of the third */
    EXH_TRACE_HEAD_SIGNAL_3, /* index of the fourth */
    EXH_TRACE_HEADS          /* number of values */
};
/* Number of values that can be written. */
#define EXH_REGS_TRACE_SET (EXH_TRACE_HEADS - EXH_TRACE_HEAD_EVERY)

/* Frame k has the values from FRAME_VALUES * (k modulo frames): number, tick, four raw values. */
#define EXH_REGS_FRAME_VALUES (2 + EXH_TRACE_SIGNALS)

/* One row of documentation (regs_names.c): a value of the head, 32 bits, a coil or a block. */
struct exh_regs_row {
    const char *name;   /* [a-z0-9_.]+; of a coil in capitals */
    const char *format; /* "u32", "i32", "f32", "text"; of bits the enum; of a coil "" */
    const char *help;   /* description, one line; "": as the row before */
};
extern const struct exh_regs_row exh_regs_head_row[EXH_HEADS];
extern const struct exh_regs_row exh_regs_bits_row[EXH_BITS];
extern const struct exh_regs_row exh_regs_coil_row[EXH_COILS];
extern const struct exh_regs_row exh_regs_trace_row[EXH_TRACE_HEADS];

/* One block of the map, for documentation. */
struct exh_regs_block {
    uint8_t kind;            /* enum exh_regs_kind */
    uint16_t at;             /* first register, coil or input */
    const char *name, *help; /* one or two words; one line */
};
#define EXH_REGS_BLOCKS 12
extern const struct exh_regs_block exh_regs_blocks[EXH_REGS_BLOCKS];

/* --- refusals --- */

/* Exception codes of the Modbus protocol. */
enum exh_modbus_exception {
    EXH_MODBUS_FUNCTION = 1, /* unknown function */
    EXH_MODBUS_ADDRESS = 2,  /* range not inside one block */
    EXH_MODBUS_VALUE = 3,    /* invalid count, length or value */
    EXH_MODBUS_BUSY = 6      /* not now; try again */
};

/* --- registers --- */

/* Status of the device that changes per tick, apart from the tables. */
struct exh_regs_status {
    uint32_t tick, missed;   /* ticks since set-up, modulo 2^32; missed ones, saturating */
    uint32_t faults;         /* enum exh_fault: latched */
    uint32_t first;          /* first of the latched faults */
    uint32_t first_tick;     /* its tick */
    uint32_t present;        /* enum exh_fault: present in the last tick */
    uint32_t limits, din;    /* enum exh_limit, in the last tick; enum exh_din */
    uint8_t state, arm_step; /* enum exh_state; exh_safety_arm_step() */
};

/* Number of words of touched for n parameters. */
#define EXH_REGS_WORDS(n) (((n) + 31) / 32)

/* The register map: the values it shows, and the values and commands it has received. All pointers
 * are the caller's; a NULL table has no registers. Their targets must not change while a request is
 * answered, so that no response mixes two ticks. */
struct exh_regs {
    const char *name; /* of the scene, first 16 characters shown; or NULL */
    const struct exh_signal_table *signals, *params; /* outputs; parameters */
    const int32_t *signal;                           /* array of length exh_signal_count(signals) */
    const int32_t *active;                           /* exh_params.active */
    const int32_t *wanted;                           /* exh_params.staged */
    int32_t *staged;            /* own array of length exh_signal_count(params) */
    uint32_t *touched;          /* bit i: staged[i] is set; EXH_REGS_WORDS() words */
    struct exh_period T;        /* period of the loop */
    uint32_t may;               /* bit k: coil k may be commanded; 0: read only */
    uint8_t locked;             /* exh_params.locked: set-up values are refused */
    uint8_t fingers;            /* drives in use */
    struct exh_trace *trace;    /* trace to read and start; or NULL */
    struct exh_regs_status box; /* set by exh_regs_update() */

    /* Set by exh_regs_setup() and the functions below. */
    uint32_t signals_n, params_n;     /* values in the tables; 0: no table */
    uint32_t signals_crc, params_crc; /* exh_signal_crc() of them; 0: no table */
    uint32_t asked;                   /* bit k: coil k was commanded since exh_regs_poll() */
    uint32_t done;                    /* commands executed */
    uint32_t refused;                 /* writes and APPLY refused, modulo 2^32, except BUSY */
    int32_t result;                   /* of the last command */
};

/* Commands for a port whose clients may change parameters; nothing is staged without APPLY. A
 * read-only port leaves may at 0. Add (1u << EXH_COIL_SAVE) if the port can save. Add RUN and CLEAR
 * only with the consent of a person at the device. */
#define EXH_REGS_MAY (1u << EXH_COIL_APPLY | 1u << EXH_COIL_DISCARD | 1u << EXH_COIL_OFF)

/* Set-up: counts the tables and computes their CRCs; clears staged values and commands.
 * -EXH_E_RANGE: a table has more than EXH_REGS_VALUES values, or a row more than 126 fraction bits.
 * -EXH_E_ABSENT: a table without values. */
int exh_regs_setup(struct exh_regs *r);

/* Takes the status of the device after a tick. */
void exh_regs_update(struct exh_regs *r, const struct exh_safety *s, uint32_t din);

/* Reads n registers from at to to[2 n], two bytes each, high byte first. kind: HOLDING or INPUT.
 * The range must lie in one block. Returns 0 or enum exh_modbus_exception. */
int exh_regs_read(
    const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n, uint8_t *to);

/* Stages n holding registers from from[2 n], all or none. Returns 0 or enum exh_modbus_exception.
 * Writing one register of a value keeps the other; for a binary32 it is refused.
 *
 * Exception 3: outside the range of the row, not a number, or a trace of an unknown signal. Also a
 * changed set-up value while locked, a change that authority.h denies, or no APPLY in may.
 * Exception 6: APPLY is pending, so staged values are frozen.
 *
 * A binary32 is rounded to the nearest raw value, half to even. A binary32 equal to the present,
 * the minimum or the maximum value gives exactly that raw value. A value equal to the wanted one
 * does not count as staged. Writing to the trace starts it. */
int exh_regs_write(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from);

/* The result that exh_regs_write() would return, without staging. */
int exh_regs_validate(const struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from);

/* Reads n bits from at to to[(n + 7) / 8], first bit lowest, unused bits 0. kind: COIL or DISCRETE.
 * Returns 0 or exception 2. */
int exh_regs_read_bits(
    const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n, uint8_t *to);

/* Commands by coils, all or none. Executes DISCARD here and queues the others. Exception 3: not in
 * may, or APPLY with DISCARD. Exception 6: DISCARD while APPLY is pending. */
int exh_regs_write_bits(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from);

/* Commands since the last call, bit k: coil k. The caller executes them in the order APPLY, SAVE,
 * command, and reports each by exh_regs_complete(). */
uint32_t exh_regs_poll(struct exh_regs *r);

/* Call it between two ticks: stages all values of the map in p, whose table is r->params, all or
 * none, and clears the map. It checks them again, with p->locked and the state in box, which the
 * caller updates before. Returns 0, -EXH_E_STATE (no longer allowed) or -EXH_E_RANGE. */
int exh_regs_apply(struct exh_regs *r, struct exh_params *p);

/* The enum exh_command in the bits of exh_regs_poll(): OFF before CLEAR before RUN, else NONE. */
uint8_t exh_regs_command(uint32_t asked);

/* Reports one executed command and its result. */
void exh_regs_complete(struct exh_regs *r, int result);

/* raw * 2^-frac as the bits of a binary32, rounded to nearest, half to even. frac 0 .. 126. */
uint32_t exh_float_from_raw(int32_t raw, unsigned frac);

/* The raw value nearest to a binary32, half to even; frac 0 .. 126. -EXH_E_RANGE: not a number,
 * infinite or beyond int32_t; *raw is unchanged then. */
int exh_float_to_raw(uint32_t bits, unsigned frac, int32_t *raw);

#ifdef __cplusplus
}
#endif
#endif
