/* SPDX-License-Identifier: MIT */
/* Are too many ticks late? The count of late ticks decreases with time. So firmware that takes the
 * processor once a minute does not halt the box, and a loop that is too slow does. Portable:
 * test/closed/sim/pc104_overload_test.c. */
#include "pc104.h"

int pc104_overload_step(struct pc104_overload *o, uint32_t passed_ticks, uint32_t late)
{
    o->since_ticks = passed_ticks > o->leak_ticks ? o->leak_ticks : o->since_ticks + passed_ticks;
    if (o->since_ticks >= o->leak_ticks) {
        o->since_ticks = 0;
        if (o->n > 0) { o->n--; }
    }
    o->n = late > UINT32_MAX - o->n ? UINT32_MAX : o->n + late;
    return o->n > o->most;
}
