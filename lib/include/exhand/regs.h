/* SPDX-License-Identifier: MIT */
/* Registers: the box as registers, made from its tables; the same map for every port.
 *
 * docs/MODBUS.md is the map for whoever reads it.
 *
 * Protocol addresses, from 0. A value is 32 bits in two registers, high word first. Where nothing
 * is, exception 2; what may not be, exception 3, and nothing of such a request is taken.
 */
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
/* major << 16 | minor: a new major means something else, a new minor adds */
#define EXH_REGS_VERSION 0x00010001u

/* the function that reads it */
enum exh_regs_kind {
    EXH_REGS_COIL = 1,     /* bits that command */
    EXH_REGS_DISCRETE = 2, /* bits that tell */
    EXH_REGS_HOLDING = 3,  /* registers that can be written, too */
    EXH_REGS_INPUT = 4     /* registers that can be read alone */
};

/* First registers. Value i of a table is in registers first + 2 i and first + 2 i + 1. */
#define EXH_REGS_HEAD_AT         0x0000u /* input: enum exh_regs_head */
#define EXH_REGS_TRACE_AT        0x0400u /* input: enum exh_regs_trace; holding: from EVERY on */
#define EXH_REGS_FRAMES_AT       0x0440u /* input: frames of the trace */
#define EXH_REGS_SIGNAL_AT       0x1000u /* input: outputs of the tick, raw */
#define EXH_REGS_SIGNAL_FLOAT_AT 0x3000u /* input: the same as binary32, in the row's unit */
#define EXH_REGS_PARAM_AT        0x5000u /* input: parameters in effect; holding: staged; raw */
#define EXH_REGS_PARAM_FLOAT_AT  0x7000u /* the same as binary32 */
#define EXH_REGS_VALUES          4096u   /* of one table at most */

/* values of the head, two input registers each */
enum exh_regs_head {
    EXH_HEAD_MAGIC,       /* EXH_REGS_MAGIC */
    EXH_HEAD_VERSION,     /* EXH_REGS_VERSION */
    EXH_HEAD_TEST_INT,    /* 0x12345678 */
    EXH_HEAD_TEST_FLOAT,  /* binary32 1.0 */
    EXH_HEAD_TICK,        /* of exh_regs_status, as all up to MISSED */
    EXH_HEAD_STATE,       /* enum exh_state */
    EXH_HEAD_FAULTS,      /* enum exh_fault, latched */
    EXH_HEAD_FIRST,       /* the first of them; stays after CLEAR */
    EXH_HEAD_FIRST_TICK,  /* and when */
    EXH_HEAD_PRESENT,     /* enum exh_fault, in the last tick */
    EXH_HEAD_LIMITS,      /* enum exh_limit, in the last tick */
    EXH_HEAD_ARM_STEP,    /* enum exh_arm, on which arming is or was refused */
    EXH_HEAD_DIN,         /* enum exh_din */
    EXH_HEAD_MISSED,      /* ticks since set-up, saturating */
    EXH_HEAD_SIGNALS,     /* values in the table of outputs */
    EXH_HEAD_PARAMS,      /* values in that of parameters */
    EXH_HEAD_SIGNALS_CRC, /* exh_signal_crc() of the table of outputs */
    EXH_HEAD_PARAMS_CRC,  /* of that of parameters */
    EXH_HEAD_PERIOD_NUM,  /* the loop's period in seconds: num / den */
    EXH_HEAD_PERIOD_DEN,  /* likewise */
    EXH_HEAD_LIB_VERSION, /* EXH_VERSION_NUMBER */
    EXH_HEAD_FINGERS,     /* drives in use */
    EXH_HEAD_STAGED,      /* values staged that differ from what is wanted */
    EXH_HEAD_PENDING,     /* coils commanded and not yet carried out, bit k: coil k */
    EXH_HEAD_DONE,        /* commands carried out since set-up, modulo 2^32 */
    EXH_HEAD_RESULT,      /* of the last of them: 0 or -EXH_E… */
    EXH_HEAD_NAME_0,      /* of the scene, four characters a value, the first highest */
    EXH_HEAD_NAME_1,      /* the next four */
    EXH_HEAD_NAME_2,      /* the next */
    EXH_HEAD_NAME_3,      /* the last; zeros behind the end */
    EXH_HEAD_REFUSED,     /* writes and APPLY refused since set-up, modulo 2^32; since 1.1 */
    EXH_HEADS             /* how many there are */
};

/* Discrete inputs: 32 each, bit k at first + k. */
enum exh_regs_bits {
    EXH_BITS_FAULTS,  /* 0: enum exh_fault, latched */
    EXH_BITS_PRESENT, /* 32: enum exh_fault, in the last tick */
    EXH_BITS_DIN,     /* 64: enum exh_din */
    EXH_BITS_STATE,   /* 96: enum exh_state k: one of them is 1 */
    EXH_BITS_LIMITS,  /* 128: enum exh_limit, in the last tick */
    EXH_BITS_ARM,     /* 160: enum exh_arm, on which arming is or was refused */
    EXH_BITS          /* how many there are */
};

/* Coils: a 1 commands, a 0 does nothing; each reads as 1 while it is pending. */
enum exh_regs_coil {
    EXH_COIL_APPLY,   /* all that is staged, at once, between two ticks */
    EXH_COIL_DISCARD, /* nothing is staged any more */
    EXH_COIL_SAVE,    /* the parameters as they are wanted, to where the port keeps them */
    EXH_COIL_OFF,     /* EXH_CMD_OFF */
    EXH_COIL_RUN,     /* EXH_CMD_RUN */
    EXH_COIL_CLEAR,   /* EXH_CMD_CLEAR */
    EXH_COILS         /* how many there are */
};

/* The trace, two registers each; holding registers begin with EVERY at EXH_REGS_TRACE_AT. Whoever
 * writes one or more of those starts another trace. */
enum exh_regs_trace {
    EXH_TRACE_HEAD_FRAMES,   /* that are held at most, a power of two */
    EXH_TRACE_HEAD_NEXT,     /* number of the next frame, modulo 2^32 */
    EXH_TRACE_HEAD_OLDEST,   /* number of the oldest held; that of the next: none */
    EXH_TRACE_HEAD_RUN,      /* traces started, modulo 2^32 */
    EXH_TRACE_HEAD_EVERY,    /* ticks from frame to frame; 0: none */
    EXH_TRACE_HEAD_SIGNAL_0, /* index in the table of outputs of the first */
    EXH_TRACE_HEAD_SIGNAL_1, /* of the second */
    EXH_TRACE_HEAD_SIGNAL_2, /* of the third */
    EXH_TRACE_HEAD_SIGNAL_3, /* of the fourth */
    EXH_TRACE_HEADS          /* how many there are */
};
/* Values that can be written. */
#define EXH_REGS_TRACE_SET (EXH_TRACE_HEADS - EXH_TRACE_HEAD_EVERY)

/* Frame k is in the values FRAME_VALUES * (k modulo frames) and following: number, tick, four
 * raw. */
#define EXH_REGS_FRAME_VALUES (2 + EXH_TRACE_SIGNALS)

/* One line of a table for people (regs_names.c): a value of the head, 32 bits, a coil, a block. */
struct exh_regs_row {
    const char *name;   /* [a-z0-9_.]+; of a coil, capitals */
    const char *format; /* "u32", "i32", "f32", "text"; of bits the enum; of a coil "" */
    const char *help;   /* one line; "": as the row before */
};
extern const struct exh_regs_row exh_regs_head_row[EXH_HEADS];
extern const struct exh_regs_row exh_regs_bits_row[EXH_BITS];
extern const struct exh_regs_row exh_regs_coil_row[EXH_COILS];
extern const struct exh_regs_row exh_regs_trace_row[EXH_TRACE_HEADS];

/* One block of the map, for people likewise. */
struct exh_regs_block {
    uint8_t kind;            /* enum exh_regs_kind */
    uint16_t at;             /* first register, coil or input */
    const char *name, *help; /* a word or two; one line */
};
#define EXH_REGS_BLOCKS 12
extern const struct exh_regs_block exh_regs_blocks[EXH_REGS_BLOCKS];

/* --- refusals --- */

/* Codes of an exception, as the protocol has them. */
enum exh_modbus_exception {
    EXH_MODBUS_FUNCTION = 1, /* no such function */
    EXH_MODBUS_ADDRESS = 2,  /* nothing there, or not all of it */
    EXH_MODBUS_VALUE = 3,    /* a count, a length, a value that may not be */
    EXH_MODBUS_BUSY = 6      /* not now; ask again */
};

/* --- registers --- */

/* What changes from tick to tick aside from the tables. */
struct exh_regs_status {
    uint32_t tick, missed;   /* since set-up: modulo 2^32; saturating */
    uint32_t faults;         /* enum exh_fault: latched */
    uint32_t first;          /* the first of them */
    uint32_t first_tick;     /* and when */
    uint32_t present;        /* enum exh_fault: in the last tick */
    uint32_t limits, din;    /* enum exh_limit, in the last tick; enum exh_din */
    uint8_t state, arm_step; /* enum exh_state; what exh_safety_arm_step() says */
};

/* The words of `touched` for n parameters. */
#define EXH_REGS_WORDS(n) (((n) + 31) / 32)

/* What the registers show, and what has been staged and commanded by them. All pointers are the
 * caller's; a table that is NULL has no registers. Nothing may change what they point to while a
 * request is answered: then no answer mixes two ticks. */
struct exh_regs {
    const char *name; /* of the scene, 16 characters shown; or NULL */
    const struct exh_signal_table *signals, *params; /* outputs; parameters */
    const int32_t *signal;                           /* exh_signal_count(signals) values */
    const int32_t *active;                           /* of params: in effect, exh_params.active */
    const int32_t *wanted;                           /* of params: exh_params.staged */
    int32_t *staged;            /* the map's own, exh_signal_count(params) of them */
    uint32_t *touched;          /* bit i: staged[i] counts; EXH_REGS_WORDS() of them */
    struct exh_period T;        /* of the loop */
    uint32_t may;               /* bit k: coil k can be commanded; none: all is read only */
    uint8_t locked;             /* exh_params.locked: set-up values are refused */
    uint8_t fingers;            /* drives in use */
    struct exh_trace *trace;    /* set up; its frames are read and it is started here; or NULL */
    struct exh_regs_status box; /* by exh_regs_update() */

    /* Filled by exh_regs_setup() and what follows. */
    uint32_t signals_n, params_n;     /* values in the tables; 0: no table */
    uint32_t signals_crc, params_crc; /* exh_signal_crc() of them; 0: no table */
    uint32_t asked;   /* bit k: coil k was commanded, and exh_regs_poll() has not been called */
    uint32_t done;    /* commands carried out */
    uint32_t refused; /* writes and APPLY refused, modulo 2^32; not those that were only early */
    int32_t result;   /* of the last of them */
};

/* What can be commanded where clients may change parameters: nothing is staged without APPLY. A
 * port of which they only read leaves it 0, and adds (1u << EXH_COIL_SAVE) where it has a place to
 * save to, RUN, CLEAR and OFF where somebody has allowed them on the spot. */
#define EXH_REGS_MAY (1u << EXH_COIL_APPLY | 1u << EXH_COIL_DISCARD | 1u << EXH_COIL_OFF)

/* Counts the tables and takes their CRCs; nothing is staged or asked. -EXH_E_RANGE: more than
 * EXH_REGS_VALUES in a table, or a row with more than 126 fraction bits; -EXH_E_ABSENT: a table
 * without its values. */
int exh_regs_setup(struct exh_regs *r);

/* The box as it is after a tick. */
void exh_regs_update(struct exh_regs *r, const struct exh_safety *s, uint32_t din);

/* n registers from `at`, each two bytes, high byte first: 2 n bytes. 0, or an exception (enum
 * exh_modbus_exception). kind: HOLDING or INPUT. All of a request lies in one block. */
int exh_regs_read(
    const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n, uint8_t *to);

/* Stages n holding registers, 2 n bytes as above, all or none: a value of which one register alone
 * is written keeps the other as it stands, but not a binary32 (exception 3). Exception 3 too:
 * outside the row's range, a set-up value other than wanted while locked, a binary32 that is no
 * number; what authority.h denies a register in the state of `box`; all of it without APPLY in
 * `may`. Exception 6: APPLY is pending, and what it takes does not change any more. Those of the
 * trace start one; exception 3: a signal that is none. A binary32 goes to the nearest raw value, of
 * two as near to the even one; one that reads as what stands there leaves that as it is, one that
 * reads as min or max is min or max. What is staged as it is wanted anyway counts as not staged. */
int exh_regs_write(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from);

/* Whether exh_regs_write() would take it; 0 or its exception. Nothing is staged. */
int exh_regs_validate(const struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from);

/* n bits from `at`, the first the lowest of to[0], unused ones of the last byte 0: (n + 7) / 8
 * bytes. 0 or exception 2. kind: COIL or DISCRETE. */
int exh_regs_read_bits(
    const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n, uint8_t *to);

/* Commands by coils, all or none. Exception 3: not in `may`, or APPLY with DISCARD; exception 6:
 * DISCARD while APPLY is pending. DISCARD is done here, the others are asked for. */
int exh_regs_write_bits(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from);

/* What was asked for since the last call, bit k: coil k, for whoever carries it out, in the order
 * APPLY, SAVE, command; then exh_regs_complete(). */
uint32_t exh_regs_poll(struct exh_regs *r);

/* Between two ticks: hands what is staged to p, whose table is r->params, all or none, judged once
 * more: locked as p is, in the state of `box`, which the caller brings up to date before. 0,
 * -EXH_E_STATE (what may not be any more) or -EXH_E_RANGE. Nothing is staged then any
 * more. */
int exh_regs_apply(struct exh_regs *r, struct exh_params *p);

/* enum exh_command of what was asked for: OFF before CLEAR before RUN, else NONE. */
uint8_t exh_regs_command(uint32_t asked);

/* One command is carried out, with this result. */
void exh_regs_complete(struct exh_regs *r, int result);

/* raw * 2^-frac as the bits of a binary32, rounded to nearest, of two as near to the even one. frac
 * 0 .. 126. */
uint32_t exh_float_from_raw(int32_t raw, unsigned frac);

/* The nearest raw to a binary32, of two as near the even one. -EXH_E_RANGE: no number, infinite or
 * beyond int32_t; *raw is untouched then. frac 0 .. 126. */
int exh_float_to_raw(uint32_t bits, unsigned frac, int32_t *raw);

#ifdef __cplusplus
}
#endif
#endif
