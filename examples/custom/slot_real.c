/* SPDX-License-Identifier: MIT */
#include "slot_real.h"

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "-ffast-math has no number that is none: such an answer would be taken for a force"
#endif

static const struct slot_wire *wires;
static double scale[SLOT_INPUTS];
static struct exh_period period;
static uint32_t tick;

void real_wire(const struct slot_wire *wire, unsigned n, struct exh_period T)
{
    wires = wire;
    period = T;
    tick = 0;
    for (unsigned i = 0; i < n; i++) {
        scale[i] = 1;
        for (unsigned k = 0; k < wire[i].row->frac; k++) { scale[i] /= 2; }
    }
}

double real_in(unsigned i) { return (double)*wires[i].value * scale[i]; }

double real_T_s(void) { return (double)period.num / (double)period.den; }

double real_t_s(void) { return (double)tick * (double)period.num / (double)period.den; }

int32_t real_none(void)
{
    tick++;
    return SLOT_NONE;
}

int32_t real_out(double force_N)
{
    const double raw = force_N * (double)(INT32_C(1) << EXH_Q_FORCE);
    if (!(raw - raw == 0)) { return real_none(); }
    tick++;
    if (raw >= 2147483647.0) { return INT32_MAX; }
    if (raw <= -2147483647.0) { return -INT32_MAX; }
    return (int32_t)(raw < 0 ? raw - 0.5 : raw + 0.5);
}
