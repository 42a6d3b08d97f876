/* SPDX-License-Identifier: MIT */
/* exh_safety_is_open(). A separate file: in safety.c, it makes the tick a third larger. */
#include "exhand/safety.h"

int exh_safety_is_open(const struct exh_safety *s)
{
    return exh_safety_is_running(s) || s->state == EXH_STATE_RELEASE ||
           (s->state == EXH_STATE_ARM && s->share_q30 > 0);
}
