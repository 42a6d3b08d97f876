/* SPDX-License-Identifier: MIT */
/* Drive: from a force ledger to a motor current, and from raw codes back to SI.
 *
 * Order, fixed: permit, force limit, slew, force-to-current table, peak
 * current, I2t.
 * The code for the D/A is made by exh_gate_step() alone (safety.h).
 */
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

/* --- limits: a limit acts and is reported, it is not a fault --- */

/* Bits of what a step returns, collected over a tick; names by exh_limit_name(). */
enum exh_limit {
    EXH_LIMIT_PULL = 1u << 0,    /* law asked to push: a string only pulls */
    EXH_LIMIT_FORCE = 1u << 1,   /* above f_max, or the end of the table; closed: above small_N_q20,
                                  * without passivity, which may take the wall away for a while */
    EXH_LIMIT_SLEW = 1u << 2,    /* rise or fall of force above slew_up, slew_down */
    EXH_LIMIT_PEAK = 1u << 3,    /* above i_peak */
    EXH_LIMIT_I2T = 1u << 4,     /* held back by heat: more than 3/4 of its budget is used */
    EXH_LIMIT_DAC = 1u << 5,     /* code at the end of its span */
    EXH_LIMIT_GATE = 1u << 6,    /* closed: force and current held at zero */
    EXH_LIMIT_RAMP = 1u << 7,    /* above the share of f_max that arming allows yet */
    EXH_LIMIT_RELEASE = 1u << 8, /* the release law has the force */
    EXH_LIMIT_SPEED = 1u << 9,   /* velocity into the law (motion.h) */
    EXH_LIMIT_PASSIVITY = 1u << 10, /* contact gave out more than it took (passivity.h) */
    EXH_LIMIT_PERSON = 1u << 11     /* above person_f or person_i, where they are the lower: in the
                                     * place of FORCE and PEAK */
};
#define EXH_LIMITS 12 /* bits of enum exh_limit, from 0 on */

/* --- permit: what the state of the box (safety.h) lets the force do in this tick --- */

/* Which of the three rules of exh_drive_force_step() holds. */
enum exh_permit_mode {
    EXH_PERMIT_CLOSED, /* no force */
    EXH_PERMIT_OPEN,   /* what the law asks for, within limits */
    EXH_PERMIT_RELEASE /* what was held goes, whatever the law asks for */
};

/* Made by exh_safety_step(), one for all fingers. */
struct exh_permit {
    uint8_t mode;         /* enum exh_permit_mode */
    int32_t share_q30;    /* open: of the force limit, 0 .. 2^30 */
    int32_t small_N_q20;  /* closed: a force asked for above it is told, FORCE */
    uint32_t ticks;       /* 1, and one for each missed before it */
    struct exh_gain fall; /* release: of the force held at its start, a tick */
};

/* --- one axis --- */

/* Parameters of one axis; rows in exh_drive_rows[]. */
struct exh_drive_par {
    int32_t f_max_N_q20;   /* force limit, N, 0 .. 100 */
    int32_t slew_up_Nps;   /* rise of force, N/s, 1 .. 10^7 */
    int32_t slew_down_Nps; /* fall of force, N/s, 1000 .. 10^7 */
    int32_t i_peak_A_q26;  /* no code stands for more, A, 0.1 .. 6.6 */
    int32_t i_cont_A_q26;  /* for ever, A, 0 .. 3.3 and <= i_peak */
    int32_t peak_ms;       /* how long i_peak from cold, ms, 1 .. 2700 */
    int32_t dac_zero_raw;  /* code of 0 A, 0 .. 65535 */
    int32_t dac_span_raw;  /* codes either side of it that may be used, 0 .. 32767 */
    int32_t dac_rawpA_q16; /* codes per ampere, 1 .. 32768 */
    int32_t mon_zero_raw;  /* monitor code at 0 A, -32768 .. 32767 */
    int32_t mon_A_q40;     /* ampere per monitor code, > 0 .. 1.95 mA */
    int32_t person_N_q20;  /* the person's ceiling: no more force is asked for, N, 0.125 .. 100 */
    int32_t person_A_q26;  /* and no code stands for more, A, 0 .. 6.6 */
};
#define EXH_DRIVE_ROWS 13
extern const struct exh_signal exh_drive_rows[EXH_DRIVE_ROWS];

/* One axis as it is set up; constant in the tick. */
struct exh_drive_cfg {
    const struct exh_drive_par *par; /* read at every tick */
    struct exh_table force_to_cur;   /* N q20 -> A q26 */
    struct exh_table cur_to_force;   /* monitor: A q26 -> N q20 */
    int32_t f_top_N_q20;             /* end of that table or person_f: no force beyond it */
    int32_t i_top_A_q26;             /* person_i in whole codes; i_peak where that is no more */
    int32_t i_whole_A_q26;           /* i_peak in whole codes */
    uint32_t top_limit;              /* enum exh_limit: whose f_top_N_q20 is */
    struct exh_gain tick_N_q20;      /* N q20 per tick, per N/s */
    int64_t i2t_budget_q32;          /* A^2 ticks above i_cont^2 */
    struct exh_gain i2t_fold;        /* A q26 per (budget left >> i2t_shift) */
    uint8_t i2t_shift;               /* brings the budget below 2^31 */
    struct exh_gain dac_A_q26;       /* A per code */
};

/* One axis from tick to tick. */
struct exh_drive {
    int32_t force_N_q20; /* last commanded */
    int32_t fall_N_q20;  /* release: taken away a tick; else 0 */
    int64_t i2t_q32;     /* heat above continuous, A^2 ticks, 0 .. budget + 1 tick at peak */
};

/* The current ledger: coded = table + peak + i2t + gate + dac, exactly, always. */
struct exh_current_ledger {
    int64_t table_A_q26; /* what the force asks for */
    int64_t peak_A_q26;  /* taken away by the peak limit */
    int64_t i2t_A_q26;   /* by I2t */
    int64_t gate_A_q26;  /* by the gate */
    int64_t dac_A_q26;   /* rounding to a code, and the end of its span */
    int32_t coded_A_q26; /* what the code stands for */
};

/* Set-up (divides). Tables must have passed exh_table_setup() and outlive cfg, as
 * must par; force_to_cur must reach above 0 N and give 0 A there; cur_to_force may be {NULL, 0}
 * where no monitor is read. -EXH_E_RATE: T. -EXH_E_RANGE when a table is not so, a parameter lies
 * outside its range above (parameters in ROM have passed no other check), or i_peak < i_cont. */
int exh_drive_setup(struct exh_drive_cfg *cfg, const struct exh_drive_par *par, struct exh_period T,
    struct exh_table force_to_cur, struct exh_table cur_to_force);

/* Limits of force that a scene may lower between any two ticks, in place of those of exh_drive_par.
 */
struct exh_drive_most {
    int32_t f_max_N_q20; /* force limit, N, 0 .. 100 */
    int32_t slew_up_Nps; /* rise of force, N/s, 1 .. 10^7 */
};

/* exh_drive_force_step() with limits of this tick's own. */
uint32_t exh_drive_force_within(struct exh_drive *s, const struct exh_drive_cfg *cfg,
    const struct exh_permit *permit, struct exh_drive_most own, struct exh_force_ledger *f);

/* Completes the force ledger, by the permit's mode, any other being CLOSED.
 * OPEN: 0 <= force <= the share of f_max and of the table's end, |change| <=
 * slew * T (at least 1 LSB). Where the two disagree, because f_max was just lowered,
 * slew wins: force comes down to the new limit at its rate.
 * RELEASE: whatever the ledger asks for, the force held in the last tick goes in equal steps,
 * fall of it and at most 1 LSB more, one for each of `ticks`: with fall = 1/n it is zero after n.
 * CLOSED: the force is zero and rises from there when it opens again. Returns limit bits. */
static inline uint32_t exh_drive_force_step(struct exh_drive *s, const struct exh_drive_cfg *cfg,
    const struct exh_permit *permit, struct exh_force_ledger *f)
{
    const struct exh_drive_most own = {cfg->par->f_max_N_q20, cfg->par->slew_up_Nps};
    return exh_drive_force_within(s, cfg, permit, own, f);
}

/* Fills table, peak and i2t for the force commanded; zeroes the rest. The I2t
 * limit leaves the peak untouched while less than 3/4 of the budget is used,
 * then folds back to i_cont without a step. Both limits are rounded down to whole D/A codes, and
 * the heat counts the current that the nearest code stands for. Returns limit bits. */
uint32_t exh_drive_current_step(struct exh_drive *s, const struct exh_drive_cfg *cfg,
    const struct exh_force_ledger *f, struct exh_current_ledger *i);

/* Monitored current of a code, A q26 (saturating, error <= 1/2 LSB = 7.5 nA). */
int32_t exh_drive_monitor_A_q26(const struct exh_drive_cfg *cfg, int16_t mon_raw);
/* The string force that the monitor's table gives for that current, N q20; 0 without a table. */
int32_t exh_drive_monitor_N_q20(const struct exh_drive_cfg *cfg, int32_t mon_A_q26);

/* State through a cursor. A state of zeros is an axis at rest and cold. */
void exh_drive_serialize(struct exh_bytes *c, struct exh_drive *s);

#ifdef __cplusplus
}
#endif
#endif
