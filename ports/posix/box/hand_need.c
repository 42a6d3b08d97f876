/* SPDX-License-Identifier: MIT */
#include "box/hand_need.h"

#include <math.h>

#define TWO_PI 6.283185307179586
#define ARM_M  0.2 /* of a step of all joints together, at the fingertip */

static int32_t fixed(double v, int frac) { return (int32_t)floor(ldexp(v, frac) + 0.5); }

static const struct bilateral_par *staged(void)
{
    return (const struct bilateral_par *)(const void *)exh_scene_bilateral.params->staged;
}

double hand_scale(const struct bilateral_run_cfg *c, unsigned f, double x_m)
{
    const struct bilateral_finger_is w = {f, c->board.exo.finger[f].arm_m, c->board.hand.pose};
    return bilateral_scale(&w, x_m, -ldexp(staged()->precontact[f].d_lim_m_q30, -EXH_Q_POS));
}

struct exh_precontact_need hand_need(const struct bilateral_run_cfg *c, double scale, double mps)
{
    const struct bilateral_par *par = staged();
    const struct exh_glove_par *g = &par->glove;
    const double fc_Hz = g->fc_Hz_q16 / 65536.0;
    const double filter_s = g->order == 2 ? sqrt(2) / (TWO_PI * fc_Hz)
                            : g->order    ? 1 / (TWO_PI * fc_Hz)
                                          : 0;
    const double lag_s = filter_s + 1 / (TWO_PI * c->board.glove_par.cutoff_Hz) +
                         EXH_GLOVE_SENSORS * c->board.glove_par.interval_s +
                         (par->glove_own.every - 1) / (double)c->rate_Hz;
    /* A step of the quantizer and its hysteresis. */
    const double codes = ldexp(1, 16 - g->bits) + g->hyst_raw_q16 / 65536.0;
    const double turn = ldexp(fabs((double)par->sensor[4].gain_turnpraw_q38), -38) * codes;
    const struct exh_precontact_need n = {
        .speed_mps_q27 = fixed(mps / scale, EXH_Q_VEL),
        .lag_us = (int32_t)ceil(1e6 * lag_s),
        .noise_m_q30 = fixed(ARM_M * TWO_PI * turn, EXH_Q_POS),
        .age_us = (int32_t)ceil(1e6 / c->fps),
    };
    return n;
}
