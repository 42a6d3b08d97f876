/* SPDX-License-Identifier: MIT */
#include "box/hand_options.h"

#include <math.h>

static double deg(int32_t turn_q32) { return ldexp(360.0 * turn_q32, -EXH_Q_TURN); }

void bilateral_print_session(FILE *f, const struct bilateral_run *r, unsigned fingers)
{
    fprintf(f, "  finger      string, mm    knuckle, deg     middle, deg  contacts   touched, s   "
               "largest force, N\n");
    for (unsigned i = 0; i < BILATERAL_FINGERS; i++) {
        const struct bilateral_track *t = &r->finger[i];
        const struct bilateral_range *g = &t->range;
        if (!(fingers >> i & 1)) { continue; }
        fprintf(f, "  %-7s %6.1f ..%6.1f %6.1f ..%6.1f %6.1f ..%6.1f %9ld %12.2f %18.2f\n",
            bilateral_finger_name[i], 1e3 * g->lo_m, 1e3 * g->hi_m, deg(g->lo_turn_q32[1]),
            deg(g->hi_turn_q32[1]), deg(g->lo_turn_q32[2]), deg(g->hi_turn_q32[2]), t->contacts,
            (double)g->touched * r->T.num / r->T.den, ldexp(g->f_max_N_q20, -EXH_Q_FORCE));
    }
}
