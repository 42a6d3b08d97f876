/* SPDX-License-Identifier: MIT */
/* Safety: the state of the box, its faults, and the gate to the D/A.
 *
 * OFF at power-on: zero current, drives disabled. A command arms it, in steps; FAULT latches with
 * its cause and tick and is left by hand. What leads where is a table, exh_safety_next[]. The gate
 * is the only code that makes a D/A code.
 */
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

/* The state of the box; over wire and registers it is this number. */
enum exh_state {
    EXH_STATE_OFF,     /* closed: no current, drives disabled */
    EXH_STATE_ARM,     /* closed while the law must ask for little; then open, the limit rises */
    EXH_STATE_RUN,     /* open */
    EXH_STATE_LIMIT,   /* RUN, and in the last tick a limit held something back (not PULL: a
                        * string cannot push) */
    EXH_STATE_RELEASE, /* open: the force held goes, in equal steps */
    EXH_STATE_FAULT,   /* closed, until cleared */
    EXH_STATES         /* how many there are */
};

/* What is asked of the box in a tick. */
enum exh_command {
    EXH_CMD_NONE, /* nothing */
    EXH_CMD_RUN,  /* OFF -> ARM when every step of arming holds */
    EXH_CMD_OFF,  /* to OFF, by way of RELEASE where there may be a force */
    EXH_CMD_CLEAR /* FAULT -> OFF, if no cause is present and the dead-man was released since */
};

/* Causes, as bits; names by exh_fault_name(). */
enum exh_fault {
    EXH_FAULT_ESTOP = 1u << 0,     /* emergency-stop loop open */
    EXH_FAULT_DRIVE = 1u << 1,     /* a drive in use is not ready */
    EXH_FAULT_OVERRUN = 1u << 2,   /* too many ticks missed in too short a time */
    EXH_FAULT_ENCODER = 1u << 3,   /* movement no hand can make */
    EXH_FAULT_DEADMAN = 1u << 4,   /* dead-man switch released */
    EXH_FAULT_TRACKING = 1u << 5,  /* the current monitored does not follow what is coded */
    EXH_FAULT_STUCK = 1u << 6,     /* encoder stands still while current flows */
    EXH_FAULT_SPEED = 1u << 7,     /* too fast for too long */
    EXH_FAULT_GLOVE = 1u << 8,     /* a glove channel in use */
    EXH_FAULT_CARD = 1u << 9,      /* a card does not answer */
    EXH_FAULT_LINK = 1u << 10,     /* a link that is needed is silent */
    EXH_FAULT_SUPPLY = 1u << 11,   /* supply voltage outside its range */
    EXH_FAULT_WATCHDOG = 1u << 12, /* a watchdog has fired */
    EXH_FAULT_CONFIG = 1u << 13,   /* CRC of parameters or calibration */
    EXH_FAULT_LOGIC = 1u << 14,    /* a state of the box that cannot be */
    EXH_FAULT_CHATTER = 1u << 15   /* a contact buzzes, and drives the string */
};
#define EXH_FAULTS 16 /* bits of enum exh_fault, from 0 on */
/* Causes that close the gate in the tick that sees them: either the drives are off anyway, or what
 * is coded cannot be trusted to do what it says. All others let the force go by the release law. */
#define EXH_FAULT_CUT \
    ((uint32_t)(EXH_FAULT_ESTOP | EXH_FAULT_DRIVE | EXH_FAULT_TRACKING | EXH_FAULT_CARD | \
                EXH_FAULT_WATCHDOG | EXH_FAULT_CONFIG | EXH_FAULT_LOGIC))

/* For `raised`, in the place of exh_tracking_step(): the port has no current monitors, or the scene
 * compares them itself. A D/A that stands still is then not seen. It is a name in the scene's
 * source and no parameter, which could be set by mistake, over a link, or for a port that does have
 * them. */
#define EXH_UNTRACKED 0u

/* steps of arming, in their order */
enum exh_arm {
    EXH_ARM_SELFTEST = 1u << 0,    /* known answers came out (integrity.h) */
    EXH_ARM_CALIBRATION = 1u << 1, /* valid: of this device, hand and time */
    EXH_ARM_POLARITY = 1u << 2,    /* of motor and encoder: was seen to be right */
    EXH_ARM_ENCODER = 1u << 3,     /* plausible */
    EXH_ARM_DEADMAN = 1u << 4,     /* held; e-stop, drives: no cause at all */
    EXH_ARM_SMALL_FORCE = 1u << 5, /* the law asks for less than arm_force, for arm_time */
    EXH_ARM_RAMP = 1u << 6         /* the force limit rises to f_max in ramp_time */
};
#define EXH_ARMS 7 /* bits of enum exh_arm, from 0 on */
/* The first four are vouched for by the scene. One that has no such thing says so by a name in its
 * source, as with EXH_UNTRACKED. */
#define EXH_UNTESTED     EXH_ARM_SELFTEST
#define EXH_UNCALIBRATED EXH_ARM_CALIBRATION
#define EXH_UNPOLARISED  EXH_ARM_POLARITY
#define EXH_ARM_ALL      0xFu
/* With them in `ready`, and no step: while the gate is open in ARM the ramp waits, since a pull is
 * under way (polarity.h). A step that is lost then is named as refused. */
#define EXH_ARM_WAIT 0x80u

/* in order of priority: the first that applies decides */
enum exh_trigger {
    EXH_ON_REFUSED,  /* the gate is not open yet, and a step of arming does not hold or OFF comes */
    EXH_ON_CUT,      /* a cause of EXH_FAULT_CUT */
    EXH_ON_LATCHED,  /* the release has ended, for a fault */
    EXH_ON_RELEASED, /* it has, for none */
    EXH_ON_CAUSE,    /* any other cause */
    EXH_ON_OFF,      /* command; or in the ramp a step that the scene vouches for is lost */
    EXH_ON_ARMED,    /* the ramp has ended */
    EXH_ON_LIMITED,  /* while it runs: a limit acted in the last tick */
    EXH_ON_RUN,      /* command */
    EXH_ON_CLEAR,    /* command, in FAULT, and it may */
    EXH_ON_NONE,     /* none of them: the state stays, but LIMIT is RUN again */
    EXH_TRIGGERS     /* how many there are */
};
/* The state machine. A cell that cannot be reached leads to FAULT. */
extern const uint8_t exh_safety_next[EXH_STATES][EXH_TRIGGERS];

/* Ticks in time that make up for one that was missed. */
#define EXH_LATE_TICKS 64

/* Parameters of the box; rows in exh_safety_rows[]. */
struct exh_safety_par {
    /* Missed ticks tolerated, 0 or 1: one in EXH_LATE_TICKS. What a tick believes of
     * time is wrong in it: velocity over n ticks reads up to (n+1)/n too much,
     * the heat of I2t by one tick in EXH_LATE_TICKS too little. */
    int32_t missed_max;
    int32_t arm_force_N_q20; /* small force, N, 0.1 .. 10 */
    int32_t arm_ms;          /* for as long, ms, 1 .. 1000, and 2 ticks */
    int32_t ramp_ms;         /* 0 to f_max, ms, 1 .. 5000 */
    int32_t release_ms; /* force held to 0, ms, 5 .. 18; 3 ticks at least, below 500 Hz 4 at most */
};
#define EXH_SAFETY_ROWS 5
extern const struct exh_signal exh_safety_rows[EXH_SAFETY_ROWS];

/* The box as it is set up. */
struct exh_safety_cfg {
    uint32_t late_max;      /* of `late`: above it, EXH_FAULT_OVERRUN */
    int32_t small_N_q20;    /* arm_force */
    uint32_t arm_ticks;     /* arm_time, rounded up, 2 at least */
    int32_t ramp_q30;       /* share of the force limit gained a tick */
    uint32_t release_ticks; /* release_time, rounded down, 3 at least, below 500 Hz 4 at most */
    struct exh_gain fall;   /* 1 / release_ticks */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range above; -EXH_E_RATE: T. */
int exh_safety_setup(
    struct exh_safety_cfg *cfg, const struct exh_safety_par *par, struct exh_period T);

/* The box from tick to tick. A state of zeros is OFF. Read-only outside this module. */
struct exh_safety {
    uint32_t present;    /* causes seen in the last tick: why RUN or CLEAR is refused */
    uint32_t faults;     /* latched causes */
    uint32_t first;      /* the first of them; stays after CLEAR, for a report */
    uint32_t first_tick; /* and when */
    uint32_t tick;       /* ticks since set-up, modulo 2^32 */
    uint32_t missed;     /* ticks missed since set-up, saturating */
    uint32_t late;   /* EXH_LATE_TICKS a missed tick, less 1 for each in time; 4 times it at most */
    uint32_t limits; /* enum exh_limit of the last tick, of all fingers */
    uint32_t held[EXH_LIMITS];     /* ticks that each limit acted in, saturating */
    uint32_t refusals;             /* of arming, saturating */
    uint32_t steps;                /* ARM: ticks of small force; RELEASE: ticks of it */
    int32_t share_q30;             /* ARM: of the force limit; 0: the gate is closed */
    uint8_t state;                 /* enum exh_state */
    uint8_t alive;                 /* completed ticks, modulo 256 */
    uint8_t refused;               /* enum exh_arm: the step that arming failed at last; 0 none */
    uint8_t opened;                /* 1: the dead-man was open since another cause was present */
    uint8_t trigger;               /* enum exh_trigger of the last tick */
    uint16_t off_raw[EXH_FINGERS]; /* the last code from dac_zero: in RELEASE none further */
    uint8_t fingers;               /* drives seen ready in this tick: the gate opens no other */
};

/* What the box goes by in a tick. */
struct exh_safety_in {
    uint32_t din;    /* enum exh_din */
    uint32_t raised; /* enum exh_fault: causes other modules see now */
    uint32_t missed; /* ticks missed before this one */
    uint8_t command; /* enum exh_command */
    uint8_t fingers; /* drives in use: 0 .. fingers-1; 1 .. EXH_FINGERS */
    uint8_t ready;   /* enum exh_arm: steps the scene vouches for */
};

/* One tick, first thing. Returns what the force may do, for exh_drive_force_step(). A state that
 * cannot be is FAULT, LOGIC. */
struct exh_permit exh_safety_step(
    struct exh_safety *s, const struct exh_safety_cfg *cfg, struct exh_safety_in in);

/* enum exh_arm: on which step arming is, or else was refused at last; 0: none. */
uint8_t exh_safety_arm_step(const struct exh_safety *s);

/* 1 in RUN and LIMIT. */
static inline int exh_safety_is_running(const struct exh_safety *s)
{
    return s->state == EXH_STATE_RUN || s->state == EXH_STATE_LIMIT;
}

/* 1 in OFF and FAULT: there is no force, and none comes but by a person's hand; else 0, and in what
 * is no state. */
static inline int exh_safety_is_at_rest(unsigned state)
{
    return state == EXH_STATE_OFF || state == EXH_STATE_FAULT;
}

/* 1 in ARM once the gate is open: a pull may be under way. */
static inline int exh_safety_pulls(const struct exh_safety *s)
{
    return s->state == EXH_STATE_ARM && s->share_q30 > 0;
}

/* 1 if the gate is open in this state of the box, else 0. */
int exh_safety_is_open(const struct exh_safety *s);

/* Last thing of a tick (gate.c): the currents of fingers 0..n-1 into codes. Completes
 * each ledger (gate, dac, coded); fingers not in use, and all of them while it is closed,
 * get dac_zero and are disabled. No input makes a code beyond dac_zero +-
 * dac_span, and in RELEASE none that is further from dac_zero than in the tick before. 1 <= n <=
 * the fingers of exh_safety_step(); cfg, i and limits are arrays of n. Adds EXH_LIMIT_DAC and
 * EXH_LIMIT_GATE (current held back) to limits, and keeps all of them for the next
 * exh_safety_step(), which counts them. */
void exh_gate_step(struct exh_safety *s, const struct exh_drive_cfg *cfg, unsigned n,
    struct exh_current_ledger *i, uint32_t *limits, struct exh_drive_out *out);

/* The same of a scene that drives nothing: the gate is shut, every finger gets dac_zero_raw. */
void exh_gate_shut(struct exh_safety *s, uint16_t dac_zero_raw, struct exh_drive_out *out);

/* State through a cursor, with a CRC of it: a state whose CRC is wrong is restored as FAULT with
 * cause LOGIC. */
void exh_safety_serialize(struct exh_bytes *c, struct exh_safety *s);

/* Names for people and files (safety_names.c), [a-z0-9_]+; "" beyond the last. k counts from 0:
 * fault and limit 1u << k, step of arming 1u << k. */
const char *exh_state_name(unsigned state);
const char *exh_trigger_name(unsigned trigger);
const char *exh_fault_name(unsigned k);
const char *exh_limit_name(unsigned k);
const char *exh_arm_name(unsigned k);

#ifdef __cplusplus
}
#endif
#endif
