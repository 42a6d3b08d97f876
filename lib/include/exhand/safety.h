/* SPDX-License-Identifier: MIT */
/* Safety: the states of the device, its faults, and the gate before the D/A.
 *
 * At power-on the state is OFF: zero current, drives disabled. A command arms the device in steps.
 * FAULT latches its cause and tick; only an operator command leaves it. The table exh_safety_next[]
 * holds all transitions. The gate is the only code that makes a D/A code. In a tick:
 *
 *   struct exh_permit permit = exh_safety_step(&safety, &cfg, in); // first
 *   // per finger: law, exh_drive_force_step(), exh_drive_current_step()
 *   exh_gate_step(&safety, drive_cfg, n, current_ledger, limits, &out); // last */
#ifndef EXHAND_SAFETY_H
#define EXHAND_SAFETY_H

#include "exhand/bytes.h"
#include "exhand/drive.h"
#include "exhand/frame.h"
#include "exhand/signal.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The state of the device. Wire and registers use these numbers. */
enum exh_state {
    EXH_STATE_OFF,     /* closed: no current, drives disabled */
    EXH_STATE_ARM,     /* gate closed until the law requests little; then the limit rises */
    EXH_STATE_RUN,     /* gate open */
    EXH_STATE_LIMIT,   /* RUN, and in the last tick a limit other than PULL acted */
    EXH_STATE_RELEASE, /* gate open: the held force falls in equal steps */
    EXH_STATE_FAULT,   /* gate closed, until cleared */
    EXH_STATES         /* number of states */
};

/* The command to the device in a tick. */
enum exh_command {
    EXH_CMD_NONE, /* nothing */
    EXH_CMD_RUN,  /* OFF -> ARM, if every step of arming is satisfied */
    EXH_CMD_OFF,  /* to OFF, through RELEASE if there may be a force */
    EXH_CMD_CLEAR /* FAULT -> OFF, if no cause is present and the dead-man was released */
};

/* Causes of faults, as bits. exh_fault_name() gives their names. */
enum exh_fault {
    EXH_FAULT_ESTOP = 1u << 0,     /* emergency-stop loop open */
    EXH_FAULT_DRIVE = 1u << 1,     /* a drive in use is not ready */
    EXH_FAULT_OVERRUN = 1u << 2,   /* too many ticks missed within too short a time */
    EXH_FAULT_ENCODER = 1u << 3,   /* implausibly fast movement */
    EXH_FAULT_DEADMAN = 1u << 4,   /* dead-man switch released */
    EXH_FAULT_TRACKING = 1u << 5,  /* measured current does not follow the code */
    EXH_FAULT_STUCK = 1u << 6,     /* encoder does not move while current flows */
    EXH_FAULT_SPEED = 1u << 7,     /* above the speed limit for too long */
    EXH_FAULT_GLOVE = 1u << 8,     /* a glove channel in use is faulty */
    EXH_FAULT_CARD = 1u << 9,      /* a card does not answer */
    EXH_FAULT_LINK = 1u << 10,     /* a required link is silent */
    EXH_FAULT_SUPPLY = 1u << 11,   /* supply voltage outside its range */
    EXH_FAULT_WATCHDOG = 1u << 12, /* a watchdog has fired */
    EXH_FAULT_CONFIG = 1u << 13,   /* wrong CRC of parameters or calibration */
    EXH_FAULT_LOGIC = 1u << 14,    /* impossible state of the state machine */
    EXH_FAULT_CHATTER = 1u << 15   /* limit cycle of a contact that drives the string */
};
#define EXH_FAULTS 16 /* number of bits of enum exh_fault, from bit 0 */
/* Causes that close the gate in the tick that detects them: the drives are off anyway, or the
 * current may not follow the code. For all others, the release law reduces the force. */
#define EXH_FAULT_CUT \
    ((uint32_t)(EXH_FAULT_ESTOP | EXH_FAULT_DRIVE | EXH_FAULT_TRACKING | EXH_FAULT_CARD | \
                EXH_FAULT_WATCHDOG | EXH_FAULT_CONFIG | EXH_FAULT_LOGIC))

/* Use it in raised instead of exh_tracking_step() if the port has no current monitors, or if the
 * scene compares them. A D/A that fails to update is then not detected. It is a name in the source,
 * not a parameter. So no user sets it by mistake, over a link, or for a port with monitors. */
#define EXH_UNTRACKED 0u

/* Steps of arming, in their order. */
enum exh_arm {
    EXH_ARM_SELFTEST = 1u << 0,    /* the self-test passed (integrity.h) */
    EXH_ARM_CALIBRATION = 1u << 1, /* valid for this device, hand and time */
    EXH_ARM_POLARITY = 1u << 2,    /* sign of motor and encoder was checked */
    EXH_ARM_ENCODER = 1u << 3,     /* encoder is plausible */
    EXH_ARM_DEADMAN = 1u << 4,     /* dead-man switch held; no cause of a fault present */
    EXH_ARM_SMALL_FORCE = 1u << 5, /* the law requests less than arm_force for arm_time */
    EXH_ARM_RAMP = 1u << 6         /* the force limit rises to f_max within ramp_time */
};
#define EXH_ARMS 7 /* number of bits of enum exh_arm, from bit 0 */
/* The scene confirms the first four steps. A scene without a check uses one of these names. */
#define EXH_UNTESTED     EXH_ARM_SELFTEST
#define EXH_UNCALIBRATED EXH_ARM_CALIBRATION
#define EXH_UNPOLARISED  EXH_ARM_POLARITY
#define EXH_ARM_ALL      0xFu
/* Add it to ready to pause the ramp in ARM while the gate is open, during a polarity pull
 * (polarity.h). It is not a step. A step that fails meanwhile is reported as refused. */
#define EXH_ARM_WAIT 0x80u

/* Triggers of transitions, in order of priority: the first that applies decides. */
enum exh_trigger {
    EXH_ON_REFUSED,  /* gate not open yet, and a step of arming fails or OFF is commanded */
    EXH_ON_CUT,      /* a cause of EXH_FAULT_CUT */
    EXH_ON_LATCHED,  /* the release has ended; a fault caused it */
    EXH_ON_RELEASED, /* the release has ended; no fault */
    EXH_ON_CAUSE,    /* any other cause */
    EXH_ON_OFF,      /* command; or a step that the scene confirms failed in the ramp */
    EXH_ON_ARMED,    /* the ramp has ended */
    EXH_ON_LIMITED,  /* running, and a limit acted in the last tick */
    EXH_ON_RUN,      /* command */
    EXH_ON_CLEAR,    /* command, in FAULT, and allowed */
    EXH_ON_NONE,     /* none of them: the state stays, but LIMIT becomes RUN */
    EXH_TRIGGERS     /* number of triggers */
};
/* The state machine. Unreachable cells lead to FAULT. */
extern const uint8_t exh_safety_next[EXH_STATES][EXH_TRIGGERS];

/* Ticks in time that compensate one missed tick. */
#define EXH_LATE_TICKS 64

/* Parameters of the device; rows in exh_safety_rows[]. */
struct exh_safety_par {
    /* Tolerated missed ticks, 0 or 1 in EXH_LATE_TICKS. A late tick assumes a wrong time: velocity
     * over n ticks reads up to (n+1)/n too high, and I2t counts one tick too little. */
    int32_t missed_max;
    int32_t arm_force_N_q20; /* small force, N, 0.1 .. 10 */
    int32_t arm_ms;          /* duration of it, ms, 1 .. 1000, at least 2 ticks */
    int32_t ramp_ms;         /* force limit from 0 to f_max, ms, 1 .. 5000 */
    int32_t release_ms; /* held force to 0, ms, 5 .. 18; at least 3 ticks, below 500 Hz at most 4 */
};
#define EXH_SAFETY_ROWS 5
extern const struct exh_signal exh_safety_rows[EXH_SAFETY_ROWS];

/* Set-up of the device. */
struct exh_safety_cfg {
    uint32_t late_max;      /* limit of late; above it, EXH_FAULT_OVERRUN */
    int32_t small_N_q20;    /* arm_force */
    uint32_t arm_ticks;     /* arm_time, rounded up, at least 2 */
    int32_t ramp_q30;       /* rise of the force limit's share per tick */
    uint32_t release_ticks; /* release_time, rounded down; at least 3, below 500 Hz at most 4 */
    struct exh_gain fall;   /* 1 / release_ticks */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range above; -EXH_E_RATE: T. */
int exh_safety_setup(
    struct exh_safety_cfg *cfg, const struct exh_safety_par *par, struct exh_period T);

/* State of the device. All zeros: OFF. Read-only outside this module. */
struct exh_safety {
    uint32_t present;    /* causes in the last tick: why RUN or CLEAR is refused */
    uint32_t faults;     /* latched causes */
    uint32_t first;      /* the first of them; stays after CLEAR for reports */
    uint32_t first_tick; /* tick of the first cause */
    uint32_t tick;       /* ticks since set-up, modulo 2^32 */
    uint32_t missed;     /* ticks missed since set-up, saturating */
    uint32_t late;   /* +EXH_LATE_TICKS per missed tick, -1 per tick in time; at most 4 times it */
    uint32_t limits; /* enum exh_limit of the last tick, all fingers */
    uint32_t held[EXH_LIMITS];     /* ticks in which each limit acted, saturating */
    uint32_t refusals;             /* refused armings, saturating */
    uint32_t steps;                /* ARM: ticks of small force; RELEASE: ticks in it */
    int32_t share_q30;             /* ARM: share of the force limit; 0: gate closed */
    uint8_t state;                 /* enum exh_state */
    uint8_t alive;                 /* completed ticks, modulo 256 */
    uint8_t refused;               /* enum exh_arm: the step that last failed; 0: none */
    uint8_t opened;                /* 1: dead-man was open since another cause was present */
    uint8_t trigger;               /* enum exh_trigger of the last tick */
    uint16_t off_raw[EXH_FINGERS]; /* last |code - dac_zero|; may not grow in RELEASE */
    uint8_t fingers;               /* fingers with a ready drive: the gate opens no other */
};

/* Inputs of a tick. */
struct exh_safety_in {
    uint32_t din;    /* enum exh_din */
    uint32_t raised; /* enum exh_fault: causes that other modules detect now */
    uint32_t missed; /* ticks missed before this one */
    uint8_t command; /* enum exh_command */
    uint8_t fingers; /* drives in use are 0 .. fingers-1; 1 .. EXH_FINGERS */
    uint8_t ready;   /* enum exh_arm: steps that the scene confirms */
};

/* First call of a tick. Returns the permit for exh_drive_force_step(). An impossible state becomes
 * FAULT with cause LOGIC. */
struct exh_permit exh_safety_step(
    struct exh_safety *s, const struct exh_safety_cfg *cfg, struct exh_safety_in in);

/* The present step of arming, or the step that last failed, enum exh_arm; 0: none. */
uint8_t exh_safety_arm_step(const struct exh_safety *s);

/* 1 in the states RUN and LIMIT. */
static inline int exh_safety_is_running(const struct exh_safety *s)
{
    return s->state == EXH_STATE_RUN || s->state == EXH_STATE_LIMIT;
}

/* 1 in OFF and FAULT: there is no force, and only an operator command can start one. 0 in all other
 * states and for undefined ones. */
static inline int exh_safety_is_at_rest(unsigned state)
{
    return state == EXH_STATE_OFF || state == EXH_STATE_FAULT;
}

/* 1 in ARM once the gate is open: a polarity pull may be active. */
static inline int exh_safety_pulls(const struct exh_safety *s)
{
    return s->state == EXH_STATE_ARM && s->share_q30 > 0;
}

/* 1 if the gate is open in the present state, else 0. */
int exh_safety_is_open(const struct exh_safety *s);

/* Last call of a tick (gate.c): converts the currents of fingers 0 .. n-1 to codes and completes
 * each ledger (gate, dac, coded). A finger not in use gets dac_zero and is disabled; a closed gate
 * does so to all. No input gives a code beyond dac_zero +- dac_span. In RELEASE no code moves away
 * from dac_zero. Adds EXH_LIMIT_DAC and EXH_LIMIT_GATE (current held back) to limits, which the
 * next exh_safety_step() counts.
 * - cfg, i and limits have length n, from 1 to the fingers of exh_safety_step(). */
void exh_gate_step(struct exh_safety *s, const struct exh_drive_cfg *cfg, unsigned n,
    struct exh_current_ledger *i, uint32_t *limits, struct exh_drive_out *out);

/* The gate of a scene without drives: closed, every finger gets dac_zero_raw. */
void exh_gate_shut(struct exh_safety *s, uint16_t dac_zero_raw, struct exh_drive_out *out);

/* State through a cursor, with a CRC. A wrong CRC restores FAULT, cause LOGIC. */
void exh_safety_serialize(struct exh_bytes *c, struct exh_safety *s);

/* Names for people and files (safety_names.c), [a-z0-9_]+; "" beyond the last. k is the bit number
 * of the fault, limit or step of arming, from 0. */
const char *exh_state_name(unsigned state);
const char *exh_trigger_name(unsigned trigger);
const char *exh_fault_name(unsigned k);
const char *exh_limit_name(unsigned k);
const char *exh_arm_name(unsigned k);

#ifdef __cplusplus
}
#endif
#endif
