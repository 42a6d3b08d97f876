/* PROVES: texts
 * Names and texts of any number: of states, triggers, faults, limits, steps of arming, errors.
 *
 * PLANT: lib/src/safety_names.c: k < EXH_LIMITS ? -> k <= EXH_LIMITS ?
 * PLANT: lib/src/error.c: code <= -EXH_E_COUNT || -> code < -EXH_E_COUNT ||
 */
#include "error.c"
#include "safety_names.c"

#include "any.h"

static char first;

static void text(const char *t)
{
    first = t[0];
}

int main(void)
{
    text(exh_state_name(any_u32()));
    text(exh_trigger_name(any_u32()));
    text(exh_fault_name(any_u32()));
    text(exh_limit_name(any_u32()));
    text(exh_arm_name(any_u32()));
    text(exh_error_text(any32()));
    END();
    return 0;
}
