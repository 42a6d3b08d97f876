/* SPDX-License-Identifier: MIT */
/* Limiter: a guard for any motor, between the program that commands and the drive.
 *
 * One structure of parameters, one set-up, one step a tick. In: a command, what is measured, how
 * old the command is, a dead-man switch and the time. Out: what to send, which limits act, the
 * state and the first cause of a stop.
 *
 * Every number is an integer in millionths of the SI unit ("micro"), int32_t, so +-2147 units:
 *   effort    uN, uN m or uA: force, torque or current; what the drive takes
 *   position  um or urad
 *   velocity  um/s or urad/s
 * A few parameters are in thousandths ("milli"): their names end so. EXH_MICRO() and EXH_MILLI()
 * write rational numbers without a float; exh_limiter_micro() converts a float (see below).
 *
 * Three kinds of command:
 *   effort    is limited in size and slew
 *   position  is held within a range, with limited velocity and acceleration
 *   wall      the command is a wall's position: effort = b v + k (x - wall) + F0 out of the wall, 0
 *             .. 104.8576 units, by exh_contact_force() (contact.h); then as an effort
 *
 * States are those of the box (enum exh_state, safety.h) by the same table:
 *   OFF -> ARM (limits rise from 0) -> RUN <-> LIMIT -> RELEASE -> OFF, after a cause -> FAULT
 * Nothing starts automatically. To start, set `run`, release the dead-man once, then take it. The
 * same ends FAULT, once no cause is present. Without a dead-man, `run` must be 0 once.
 * In RELEASE the effort held goes to 0 in equal steps; a position brakes to a standstill.
 *
 * Rates hold by step: with steps late by a factor, efforts and positions change slower by it.
 *
 * Passivity (passivity.h) is left to the caller: it counts energy in counts of an encoder and in
 * the force that a drive's code holds, and a limiter knows neither. The wall is then outside, and
 * its force is a command of kind effort (examples/limiter/README.md has the order of the calls).
 *
 * This is software. It is no safety function, and it does not replace an emergency stop.
 */
#ifndef EXHAND_LIMITER_H
#define EXHAND_LIMITER_H

#include "exhand/contact.h"
#include "exhand/fix.h"
#include "exhand/motion.h"
#include "exhand/safety.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* num/den in millionths and thousandths, for initialisers; truncated towards 0. The result must fit
 * int32_t. EXH_MICRO(35, 10) is 3.5 units. */
#define EXH_MICRO(num, den) ((int32_t)((num)*INT64_C(1000000) / (den)))
#define EXH_MILLI(num, den) ((int32_t)((num)*INT64_C(1000) / (den)))

/* In place of a number: there is none (NaN, infinity, a sensor that failed). As a command, or as a
 * measured value that `uses` names, it is the cause NUMBER. */
#define EXH_LIMITER_NONE INT32_MIN

/* What a command is. */
enum exh_limiter_kind {
    EXH_LIMITER_EFFORT,   /* an effort, micro */
    EXH_LIMITER_POSITION, /* a position, micro; uses POS */
    EXH_LIMITER_WALL,     /* a wall's position, micro; uses POS and VEL */
    EXH_LIMITER_KINDS     /* how many there are */
};

/* What is given at every step, as bits of `uses`. What it does not name is never read. */
enum exh_limiter_use {
    EXH_LIMITER_POS = 1u << 0,      /* measured position */
    EXH_LIMITER_VEL = 1u << 1,      /* measured velocity */
    EXH_LIMITER_MEASURED = 1u << 2, /* measured effort */
    EXH_LIMITER_DEADMAN = 1u << 3,  /* a dead-man switch */
    EXH_LIMITER_USE_ALL = (1u << 4) - 1u
};

/* What to do with a first command that is far off. */
enum exh_limiter_first {
    EXH_LIMITER_REFUSE,  /* cause FAR */
    EXH_LIMITER_APPROACH /* go there within the limits; the first effort rises with the ramp */
};

/* What a drive of a position does in FAULT, once it does not move. */
enum exh_limiter_after {
    EXH_LIMITER_LIMP, /* `enable` is 0 */
    EXH_LIMITER_HOLD  /* `enable` stays 1, the last position is sent on */
};

/* Parameters. All are int32_t, in this order, and the place of each is its number for
 * exh_limiter_field_name(). 0 means "not watched" only where that is said. */
struct exh_limiter_par {
    int32_t kind;       /* enum exh_limiter_kind */
    int32_t uses;       /* bits of enum exh_limiter_use */
    int32_t rate_milli; /* steps a second, mHz, 1 .. 20000000 */

    int32_t effort_max;        /* EFFORT, WALL: no more is sent, micro, 1 .. 2*10^9 */
    int32_t effort_up_milli;   /* its rise from 0, a second, milli, 1 .. 2*10^9 */
    int32_t effort_down_milli; /* its fall towards 0, a second, milli, 1 .. 2*10^9 */
    int32_t ramp_ms;           /* arming: limits rise from 0 to full, ms, 1 .. 10000 */
    int32_t release_ms; /* EFFORT, WALL: effort held to 0, ms, 1 .. 1000; one step at least */

    int32_t pos_min;       /* uses POS: least position commanded, micro, +-5*10^8 */
    int32_t pos_max;       /* most, micro, above pos_min, +-5*10^8 */
    int32_t pos_over;      /* measured farther beyond them: cause RANGE; micro, 0 .. 5*10^8 */
    int32_t vel_max;       /* POSITION: of what is sent, micro a second, 1 .. 10^9 */
    int32_t acc_max_milli; /* POSITION: of what is sent, milli a second^2, 1 .. 2*10^9 */

    int32_t first_max; /* first command, farther from the measured position (POSITION) or from 0:
                        * far off; micro, 0 .. 10^9 */
    int32_t first;     /* enum exh_limiter_first */
    int32_t after;     /* POSITION: enum exh_limiter_after */

    int32_t age_max_us; /* a command that is older: cause STALE; us, 1 .. 10^7 */
    int32_t gap_max_us; /* steps farther apart, or a clock that stops for so many steps' time:
                         * cause TIME; us, two steps .. 10^7 */

    int32_t speed_max; /* uses VEL: measured speed beyond it for longer than speed_ms: cause SPEED,
                        * and WALL damps no more speed than it; micro a second, 0 .. 2*10^9; 0: not
                        * watched, but WALL needs it */
    int32_t speed_ms;  /* ms, 0 .. 1000 */

    int32_t stall_effort; /* uses POS: an effort above it for longer than stall_ms without
                           * movement: cause STALL; micro, 0 .. 2*10^9, 0: not watched */
    int32_t stall_move;   /* a way up to this is no movement, micro, 0 .. 10^9 */
    int32_t stall_ms;     /* ms, 1 .. 60000, where it is watched */

    int32_t heat_nominal; /* effort for ever, micro, 0 .. heat_peak */
    int32_t heat_peak;    /* effort for heat_ms from cold, micro, 0 .. 2*10^9, 0: not watched */
    int32_t heat_ms;      /* time constant of I2t, ms, 64 steps .. 600000, where it is watched */

    int32_t wall_below;   /* WALL: 0: positions above the command are in the wall; 1: below it */
    int32_t wall_k_milli; /* stiffness, milli effort per position, 0 .. 10^9 */
    int32_t wall_b;       /* damping, micro effort per velocity, 0 .. 10^9 */
    int32_t wall_f0;      /* F0, while the velocity is out of the wall; micro, 0 .. 10^8 */
};
#define EXH_LIMITER_FIELDS 30 /* in exh_limiter_par */

/* What holds a command back in this step, as bits; names by exh_limiter_limit_name(). */
enum exh_limiter_limit {
    EXH_LIMITER_BY_EFFORT = 1u << 0,  /* above effort_max */
    EXH_LIMITER_BY_RISE = 1u << 1,    /* faster than effort_up or effort_down */
    EXH_LIMITER_BY_HEAT = 1u << 2,    /* above what heat leaves of heat_peak */
    EXH_LIMITER_BY_RAMP = 1u << 3,    /* above the share that arming allows yet */
    EXH_LIMITER_BY_RANGE = 1u << 4,   /* a position outside pos_min .. pos_max */
    EXH_LIMITER_BY_VEL = 1u << 5,     /* at vel_max */
    EXH_LIMITER_BY_ACC = 1u << 6,     /* at acc_max, or braking in time */
    EXH_LIMITER_BY_RELEASE = 1u << 7, /* RELEASE has it */
    EXH_LIMITER_BY_STATE = 1u << 8    /* OFF, FAULT: nothing is let through */
};
#define EXH_LIMITER_LIMITS 9 /* bits of enum exh_limiter_limit, from 0 on */

/* Causes of a stop, as bits in their order of priority; names by exh_limiter_cause_name(). */
enum exh_limiter_cause {
    EXH_LIMITER_LOGIC = 1u << 0,    /* a state that cannot be: memory was damaged */
    EXH_LIMITER_NUMBER = 1u << 1,   /* EXH_LIMITER_NONE: not a number */
    EXH_LIMITER_TIME = 1u << 2,     /* time goes back or stops, or steps are too far apart */
    EXH_LIMITER_RELEASED = 1u << 3, /* the dead-man switch is released */
    EXH_LIMITER_STALE = 1u << 4,    /* the command is too old */
    EXH_LIMITER_RANGE = 1u << 5,    /* measured position out of range */
    EXH_LIMITER_SPEED = 1u << 6,    /* measured speed, for too long */
    EXH_LIMITER_STALL = 1u << 7,    /* effort without movement, for too long */
    EXH_LIMITER_HEAT = 1u << 8,     /* a quarter more heat than heat_peak for heat_ms */
    EXH_LIMITER_FAR = 1u << 9       /* the first command is far off, and REFUSE is chosen */
};
#define EXH_LIMITER_CAUSES 10 /* bits of enum exh_limiter_cause, from 0 on */

/* What a step goes by. */
struct exh_limiter_in {
    uint32_t now_us;  /* a clock that goes on, us, any origin; it may wrap at 2^32 */
    int32_t command;  /* by kind, micro */
    int32_t pos;      /* measured, micro */
    int32_t vel;      /* measured, micro a second */
    int32_t effort;   /* measured, micro, of either sign */
    uint32_t age_us;  /* of the command, us; UINT32_MAX if there never was one */
    uint32_t deadman; /* 1: held */
    uint32_t run;     /* 1: is to run; 0: is to be off */
};

/* What a step gives. */
struct exh_limiter_out {
    int32_t send;     /* effort, or position of kind POSITION, micro */
    uint32_t enable;  /* 1: the drive may be on; 0: it must be off */
    uint32_t state;   /* enum exh_state; its name by exh_state_name() */
    uint32_t limits;  /* enum exh_limiter_limit, of this step */
    uint32_t first;   /* one bit of enum exh_limiter_cause: the first cause latched. Of several in
                       * one step, the highest in priority. It stays until the next arming */
    uint32_t causes;  /* all that were latched since */
    uint32_t present; /* seen in this step: why it does not arm */
};

/* As it is set up; constant in the step, without pointers: it may be copied. Written by
 * exh_limiter_setup() alone. */
struct exh_limiter_cfg {
    int32_t up, down;     /* effort a step, micro */
    int32_t ramp_q30;     /* share gained a step */
    uint32_t fall_q32;    /* 1 / steps of release */
    int32_t heat_top;     /* heat_peak, or no limit */
    int32_t heat_bottom;  /* heat_nominal */
    int64_t heat_budget;  /* squares of (effort >> heat_shift), summed over steps, below 2^47 */
    int32_t heat_square;  /* of the nominal effort, in that scale */
    uint32_t heat_shift;  /* see heat_budget */
    uint32_t heat_knee;   /* bits of the budget left, >> 16, where heat begins to hold back */
    int32_t vel, acc;     /* POSITION: a step, a step^2, micro << frac */
    int32_t brake;        /* POSITION: more than the way to brake in from full speed, micro */
    uint32_t frac;        /* fraction bits of a position sent */
    uint32_t still_steps; /* gap_max_us */
    int32_t pos_scale, vel_scale;      /* WALL: from micro to what the law is given */
    int32_t near_min, near_max;        /* uses POS: measured position outside is RANGE */
    struct exh_motion_par motion;      /* limits of motion.h */
    uint32_t speed_steps, stall_steps; /* of motion.h */
    struct exh_contact_par wall;       /* WALL: the contact law's parameters */
    struct exh_limiter_par par;        /* a copy of the parameters */
};

/* From step to step. A state of zeros is OFF. Read-only outside this module. */
struct exh_limiter {
    uint8_t state;            /* enum exh_state */
    uint8_t opened;           /* 1: the dead-man was open since */
    uint8_t started;          /* 1: now_us is of a step that was */
    uint8_t holds;            /* POSITION: 1: FAULT holds it, until it is off or armed */
    uint32_t now_us;          /* of the last step */
    int64_t heat;             /* above nominal, 0 .. 5/4 of the budget and 1 */
    int32_t sent;             /* effort or position of the last step, micro */
    int32_t part;             /* POSITION: beyond it, micro << frac, 0 .. 2^frac - 1 */
    int32_t vel;              /* POSITION: change of it in the last step, micro << frac */
    int32_t fall;             /* RELEASE: effort taken away a step */
    int32_t stood;            /* position of the last movement, micro */
    int32_t share_q30;        /* ARM: of the limits; else all of them */
    uint32_t causes, first;   /* as in the output */
    uint32_t limits;          /* as in the output */
    uint32_t still_steps;     /* since the clock moved */
    struct exh_motion motion; /* state of motion.h */
};

/* Set-up (divides). Returns 0, or -(1 + k) if field number k is the first wrong one. It is outside
 * its range, does not fit the others, or `uses` lacks what it needs. exh_limiter_field_name(k) is
 * its name. Do not use cfg then. */
int exh_limiter_setup(struct exh_limiter_cfg *cfg, const struct exh_limiter_par *par);

/* One step. These hold for every cfg of a set-up, every state and every input.
 * - EFFORT, WALL: |send| <= effort_max, and <= the rest that heat leaves, except for the slew.
 *   A step from 0 is at most effort_up, one towards 0 at most effort_down (whole millionths, >= 1).
 *   A step through 0 is limited by the smaller remainder of both. If enable is 0, send is 0.
 * - POSITION: once send is within pos_min .. pos_max, it stays there. It changes by at most vel_max
 *   a step, rounded up, and this change by at most acc_max. It starts at the measured position.
 *   If enable is 0, send is the measured position.
 */
void exh_limiter_step(struct exh_limiter *s, const struct exh_limiter_cfg *cfg,
    const struct exh_limiter_in *in, struct exh_limiter_out *out);

/* Names for people and files (limiter_names.c), [a-z0-9_]+; "" beyond the last. k counts from 0:
 * limit and cause 1u << k, field k. */
const char *exh_limiter_limit_name(unsigned k);
const char *exh_limiter_cause_name(unsigned k);
const char *exh_limiter_field_name(unsigned k);

/* Programs with floats define this before they include the header. */
#ifdef EXH_LIMITER_FLOAT
EXH_STATIC_ASSERT(double_has_64_bits, sizeof(double) == sizeof(uint64_t));

/* Nearest millionth of x, half away from 0. NaN and infinity become EXH_LIMITER_NONE; a number
 * beyond int32_t becomes +-INT32_MAX, with its sign. It looks at the number's bits (IEEE 754), so
 * it also works if a compiler assumes that there are no NaNs (-ffast-math). */
static inline int32_t exh_limiter_micro(double x)
{
    const uint64_t exponent = UINT64_C(0x7FF0000000000000);
    union {
        double x;
        uint64_t bits;
    } of;
    of.x = x;
    if ((of.bits & exponent) == exponent) { return EXH_LIMITER_NONE; }
    if (x >= 2147.483647) { return INT32_MAX; }
    if (x <= -2147.483647) { return -INT32_MAX; }
    return (int32_t)(x * 1e6 + (x < 0 ? -0.5 : 0.5));
}
#endif

#ifdef __cplusplus
}
#endif
#endif
