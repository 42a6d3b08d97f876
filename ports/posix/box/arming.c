/* SPDX-License-Identifier: MIT */
#include "box/arming.h"

#include "base/option.h"

#include "exhand/safety.h"

#include <stdio.h>

int arming_runs(int32_t state) { return state == EXH_STATE_RUN || state == EXH_STATE_LIMIT; }

enum arming arming_is(int32_t state)
{
    if (arming_runs(state)) { return ARMING_RUNS; }
    return state == EXH_STATE_ARM ? ARMING_GOES_ON : ARMING_REFUSED;
}

/* What to do about a step, in their order. */
static const char *const advice[EXH_ARMS] = {"the processor or its memory is broken",
    "calibrate first", "see that the motor pulls the string in",
    "the position is lost: start again", "close what is open, hold the dead-man",
    "a force is asked for already: begin outside the wall",
    "this came before all of the force was there"};

static unsigned first_of(uint32_t bits)
{
    unsigned k = 0;
    while (k < 32 && !(bits >> k & 1)) { k++; }
    return k;
}

void arming_complain(int32_t arm_step, int32_t present)
{
    /* The ramp is over when it is not refused any more: a cause in it is no refusal, but its end.
     */
    const unsigned step = first_of(arm_step ? (uint32_t)arm_step : (uint32_t)EXH_ARM_RAMP);
    char causes[128] = "";
    size_t at = 0;
    for (unsigned k = 0; k < EXH_FAULTS; k++) {
        if (!((uint32_t)present >> k & 1) || at >= sizeof causes - 1) { continue; }
        at += (size_t)snprintf(causes + at, sizeof causes - at, " %s", exh_fault_name(k));
    }
    cli_complain("arming: refused at %s%s%s: %s", step < EXH_ARMS ? exh_arm_name(step) : "none",
        causes[0] ? ", causes" : "", causes, step < EXH_ARMS ? advice[step] : "no request");
}
