/* Safety: the state of the box, its faults, and the gate to the D/A.
 *
 * OFF at power-on: zero current, drives disabled. RUN only by command. FAULT
 * latches with its cause and tick; leaving it takes an explicit command and the
 * cause gone. The gate is the only code that makes a D/A code.
 */
#ifndef EXHAND_SAFETY_H
#define EXHAND_SAFETY_H

#include "exhand/bytes.h"
#include "exhand/drive.h"
#include "exhand/signal.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum exh_state { EXH_STATE_OFF, EXH_STATE_RUN, EXH_STATE_FAULT };

enum exh_command {
    EXH_CMD_NONE,
    EXH_CMD_RUN,  /* OFF -> RUN when no cause of a fault is present              */
    EXH_CMD_OFF,  /* RUN -> OFF                                                  */
    EXH_CMD_CLEAR /* FAULT -> OFF when no cause is present: so with the dead-man held */
};

enum exh_fault {
    EXH_FAULT_ESTOP = 1u << 0,   /* emergency-stop loop open                    */
    EXH_FAULT_DRIVE = 1u << 1,   /* a drive in use is not ready                 */
    EXH_FAULT_OVERRUN = 1u << 2, /* too many ticks missed in too short a time   */
    EXH_FAULT_ENCODER = 1u << 3, /* movement no hand can make                   */
    EXH_FAULT_DEADMAN = 1u << 4, /* dead-man switch released                    */
    EXH_FAULT_TRACKING = 1u << 5 /* the current monitored does not follow what is coded */
};

/* For `raised`, in the place of exh_track_step(): the port has no current monitors, or the scene
 * compares them itself. A D/A that stands still is then not seen. It is a name in the scene's source and no parameter, which
 * could be set by mistake, over a link, or for a port that does have them. */
#define EXH_UNTRACKED 0u

#define EXH_LATE_TICKS 64

struct exh_safety_par {
    /* Missed ticks tolerated, 0 or 1: one in EXH_LATE_TICKS. What a tick believes of
     * time is wrong in it: velocity over n ticks reads up to (n+1)/n too much,
     * the heat of I2t by one tick in EXH_LATE_TICKS too little. */
    int32_t missed_max;
};
#define EXH_SAFETY_ROWS 1
extern const struct exh_signal exh_safety_rows[EXH_SAFETY_ROWS];

struct exh_safety {
    uint32_t present;    /* causes seen in the last tick: why RUN or CLEAR is refused */
    uint32_t faults;     /* latched causes                                     */
    uint32_t first;      /* the first of them; stays after CLEAR, for a report */
    uint32_t first_tick; /* and when                                           */
    uint32_t tick;       /* ticks since set-up, modulo 2^32                    */
    uint32_t missed;     /* ticks missed since set-up, saturating              */
    uint32_t late;       /* EXH_LATE_TICKS a missed tick, less 1 for each in time */
    uint8_t state;       /* enum exh_state                                     */
    uint8_t alive;       /* completed ticks, modulo 256                        */
    uint8_t fingers;     /* drives seen ready in this tick: the gate opens no other */
};

struct exh_safety_in {
    uint32_t din;     /* enum exh_din                                          */
    uint32_t raised;  /* enum exh_fault: causes other modules see now           */
    uint32_t missed;  /* ticks missed before this one                          */
    uint8_t command;  /* enum exh_command                                      */
    uint8_t fingers;  /* drives in use: 0 .. fingers-1; 1 .. EXH_FINGERS       */
};

/* One tick, first thing. Returns the state, enum exh_state. A missed_max outside
 * its range counts as 0, a state that is none as FAULT. */
uint8_t exh_safety_step(struct exh_safety *s, const struct exh_safety_par *par,
                        struct exh_safety_in in);

/* Last thing of a tick: the currents of fingers 0..n-1 into codes. Completes
 * each ledger (gate, dac, coded); fingers not in use, and all of them outside
 * RUN, get dac_zero and are disabled. No input makes a code beyond dac_zero +-
 * dac_span. 1 <= n <= the fingers of exh_safety_step(); cfg, i and limits are arrays of n. Adds
 * EXH_LIMIT_DAC and EXH_LIMIT_GATE (current held back) to limits. */
void exh_gate(struct exh_safety *s, const struct exh_drive_cfg *cfg, unsigned n,
              struct exh_current_ledger *i, uint32_t *limits, struct exh_drive_out *out);

void exh_safety_bytes(struct exh_bytes *c, struct exh_safety *s);

#ifdef __cplusplus
}
#endif
#endif
