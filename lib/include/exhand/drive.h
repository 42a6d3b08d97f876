/* SPDX-License-Identifier: MIT */
/* Drive: from a force ledger to a motor current, and from monitor codes back to SI units.
 *
 * The order is fixed: permit, force limit, slew, force-to-current table, peak current, I2t. Only
 * exh_gate_step() (safety.h) makes the D/A code.
 *
 *   uint32_t limits = exh_drive_force_step(&drive, &cfg, &permit, &force_ledger);
 *   limits |= exh_drive_current_step(&drive, &cfg, &force_ledger, &current_ledger); */
#ifndef EXHAND_DRIVE_H
#define EXHAND_DRIVE_H

#include "exhand/bytes.h"
#include "exhand/contact.h"
#include "exhand/fix.h"
#include "exhand/signal.h"
#include "exhand/table.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- limits: acting limits are reported, they are no faults --- */

/* Bits that the steps of a tick return. exh_limit_name() gives their names. */
enum exh_limit {
    EXH_LIMIT_PULL = 1u << 0,       /* the law requested a push; a string only pulls */
    EXH_LIMIT_FORCE = 1u << 1,      /* above f_max or the end of the table. With the gate closed:
                                     * spring, damper and pull-back exceed small_N_q20 */
    EXH_LIMIT_SLEW = 1u << 2,       /* rise or fall of force above slew_up or slew_down */
    EXH_LIMIT_PEAK = 1u << 3,       /* above i_peak */
    EXH_LIMIT_I2T = 1u << 4,        /* I2t: more than 3/4 of the heat budget is used */
    EXH_LIMIT_DAC = 1u << 5,        /* the D/A code is at the end of its span */
    EXH_LIMIT_GATE = 1u << 6,       /* gate closed: force and current are 0 */
    EXH_LIMIT_RAMP = 1u << 7,       /* above the share of f_max that arming allows so far */
    EXH_LIMIT_RELEASE = 1u << 8,    /* the release law sets the force */
    EXH_LIMIT_SPEED = 1u << 9,      /* velocity limited before the law (motion.h) */
    EXH_LIMIT_PASSIVITY = 1u << 10, /* the contact returned more than it received (passivity.h) */
    EXH_LIMIT_PERSON = 1u << 11     /* above person_f or person_i; replaces FORCE and PEAK */
};
#define EXH_LIMITS 12 /* number of bits of enum exh_limit, from bit 0 */

/* --- permit: how the state of the device (safety.h) restricts the force in this tick --- */

/* The rule that exh_drive_force_step() applies. */
enum exh_permit_mode {
    EXH_PERMIT_CLOSED, /* no force */
    EXH_PERMIT_OPEN,   /* the force of the law, within limits */
    EXH_PERMIT_RELEASE /* the held force falls to 0, independent of the law */
};

/* The permit; exh_safety_step() makes one for all fingers. */
struct exh_permit {
    uint8_t mode;         /* enum exh_permit_mode */
    int32_t share_q30;    /* open: share of the force limit, 0 .. 2^30 */
    int32_t small_N_q20;  /* closed: a larger request sets FORCE */
    uint32_t ticks;       /* 1, plus the ticks missed before this one */
    struct exh_gain fall; /* release: share of the initial force to remove per tick */
};

/* --- one axis --- */

/* Parameters of one axis; rows in exh_drive_rows[]. */
struct exh_drive_par {
    int32_t f_max_N_q20;   /* force limit, N, 0 .. 100 */
    int32_t slew_up_Nps;   /* rise of force, N/s, 1 .. 10^7 */
    int32_t slew_down_Nps; /* fall of force, N/s, 1000 .. 10^7 */
    int32_t i_peak_A_q26;  /* no code exceeds this current, A, 0.1 .. 6.6 */
    int32_t i_cont_A_q26;  /* continuous current, A, 0 .. 3.3 and <= i_peak */
    int32_t peak_ms;       /* duration of i_peak from cold, ms, 1 .. 2700 */
    int32_t dac_zero_raw;  /* code of 0 A, 0 .. 65535 */
    int32_t dac_span_raw;  /* usable codes on either side of it, 0 .. 32767 */
    int32_t dac_rawpA_q16; /* codes per ampere, 1 .. 32768 */
    int32_t mon_zero_raw;  /* monitor code at 0 A, -32768 .. 32767 */
    int32_t mon_A_q40;     /* ampere per monitor code, > 0 .. 1.95 mA */
    int32_t person_N_q20;  /* the person's force limit, N, 0.125 .. 100 */
    int32_t person_A_q26;  /* the person's current limit, A, 0 .. 6.6 */
};
#define EXH_DRIVE_ROWS 13
extern const struct exh_signal exh_drive_rows[EXH_DRIVE_ROWS];

/* Set-up of one axis; constant in the tick. */
struct exh_drive_cfg {
    const struct exh_drive_par *par; /* read at every tick */
    struct exh_table force_to_cur;   /* N q20 -> A q26 */
    struct exh_table cur_to_force;   /* monitor: A q26 -> N q20 */
    int32_t f_top_N_q20;             /* end of that table or person_f, the lower one */
    int32_t i_top_A_q26;             /* person_i in whole codes, or i_peak if lower */
    int32_t i_whole_A_q26;           /* i_peak in whole codes */
    uint32_t top_limit;              /* enum exh_limit that f_top_N_q20 sets */
    struct exh_gain tick_N_q20;      /* N q20 per tick, per N/s */
    int64_t i2t_budget_q32;          /* A^2 ticks above i_cont^2 */
    struct exh_gain i2t_fold;        /* A q26 per (remaining budget >> i2t_shift) */
    uint8_t i2t_shift;               /* scales the budget below 2^31 */
    struct exh_gain dac_A_q26;       /* A per code */
};

/* State of one axis. All zeros: at rest and cold. */
struct exh_drive {
    int32_t force_N_q20; /* last commanded force */
    int32_t fall_N_q20;  /* release: reduction per tick; else 0 */
    int64_t i2t_q32;     /* heat above continuous, A^2 ticks, 0 .. budget + 1 tick at peak */
};

/* The current ledger: coded = table + peak + i2t + gate + dac, always exactly. */
struct exh_current_ledger {
    int64_t table_A_q26; /* current for the commanded force */
    int64_t peak_A_q26;  /* correction by the peak limit */
    int64_t i2t_A_q26;   /* correction by I2t */
    int64_t gate_A_q26;  /* correction by the gate */
    int64_t dac_A_q26;   /* rounding to a code, and the end of its span */
    int32_t coded_A_q26; /* current of the code */
};

/* Set-up (divides). The tables come from exh_table_setup(); they and par must outlive cfg.
 * force_to_cur must reach above 0 N and give 0 A at 0 N. cur_to_force may be {NULL, 0} without a
 * monitor. -EXH_E_RATE: T. -EXH_E_RANGE: an invalid table, a parameter outside its range above, or
 * i_peak < i_cont. Parameters in ROM have passed no other check. */
int exh_drive_setup(struct exh_drive_cfg *cfg, const struct exh_drive_par *par, struct exh_period T,
    struct exh_table force_to_cur, struct exh_table cur_to_force);

/* Force limits for one tick, which replace those of exh_drive_par. A scene may lower them. */
struct exh_drive_most {
    int32_t f_max_N_q20; /* force limit, N, 0 .. 100 */
    int32_t slew_up_Nps; /* rise of force, N/s, 1 .. 10^7 */
};

/* exh_drive_force_step() with force limits for this tick. */
uint32_t exh_drive_force_within(struct exh_drive *s, const struct exh_drive_cfg *cfg,
    const struct exh_permit *permit, struct exh_drive_most own, struct exh_force_ledger *f);

/* Completes the force ledger by the rule of permit->mode; an unknown mode acts as CLOSED. Returns
 * limit bits.
 * - OPEN: 0 <= force <= the share of f_max and of the table's end, and |change| <= slew * T (at
 *   least 1 LSB). After f_max was lowered, slew has priority: the force falls at its rate.
 * - RELEASE: the held force falls in equal steps, independent of the ledger. Each of permit->ticks
 *   removes fall times the initial force and at most 1 LSB more. With fall = 1/n, it is 0 after n
 *   ticks.
 * - CLOSED: the force is 0 and rises from 0 when the gate opens again. */
static inline uint32_t exh_drive_force_step(struct exh_drive *s, const struct exh_drive_cfg *cfg,
    const struct exh_permit *permit, struct exh_force_ledger *f)
{
    const struct exh_drive_most own = {cfg->par->f_max_N_q20, cfg->par->slew_up_Nps};
    return exh_drive_force_within(s, cfg, permit, own, f);
}

/* Sets table, peak and i2t of the current ledger for the commanded force, and the rest to 0. I2t
 * does not act while less than 3/4 of the budget is used; then it reduces the limit to i_cont
 * without a step. Both limits are rounded down to whole D/A codes. The heat counts the current of
 * the nearest code. Returns limit bits. */
uint32_t exh_drive_current_step(struct exh_drive *s, const struct exh_drive_cfg *cfg,
    const struct exh_force_ledger *f, struct exh_current_ledger *i);

/* The current of a monitor code, A q26; saturates. The error is at most 1/2 LSB = 7.5 nA. */
int32_t exh_drive_monitor_A_q26(const struct exh_drive_cfg *cfg, int16_t mon_raw);
/* The string force that the monitor's table gives for this current, N q20; 0 without a table. */
int32_t exh_drive_monitor_N_q20(const struct exh_drive_cfg *cfg, int32_t mon_A_q26);

/* State through a cursor. */
void exh_drive_serialize(struct exh_bytes *c, struct exh_drive *s);

#ifdef __cplusplus
}
#endif
#endif
