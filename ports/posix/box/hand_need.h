/* SPDX-License-Identifier: MIT */
/* Inputs of the advice for d_lim: speed of a fingertip, delay and error of its position. One
 * formula and one set of defaults for all commands. */
#ifndef BOX_HAND_NEED_H
#define BOX_HAND_NEED_H

#include "box/hand.h"

/* Of a hand on this device with the scene's staged parameters (bilateral_stage(), or behind a run),
 * over a perfect link. scale: string metres per fingertip metre; mps: the fastest approach, of the
 * string. */
struct exh_precontact_need hand_need(const struct bilateral_run_cfg *c, double scale, double mps);

/* scale of finger f that touches where x_m of string is out: from d_lim on. */
double hand_scale(const struct bilateral_run_cfg *c, unsigned f, double x_m);

#endif
