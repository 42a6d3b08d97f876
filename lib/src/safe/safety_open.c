/* SPDX-License-Identifier: MIT */
/* When the gate is open. A file of its own: compiled into safety.c, it makes the tick there a third
 * larger. */
#include "exhand/safety.h"

int exh_safety_is_open(const struct exh_safety *s)
{
    return exh_safety_is_running(s) || s->state == EXH_STATE_RELEASE ||
           (s->state == EXH_STATE_ARM && s->share_q30 > 0);
}
