/* SPDX-License-Identifier: MIT */
/* Reach: how far the exact linear test goes at a rate. It is the measure of a map's rays, so that
 * maps of one device have the same rays however fine they are. */
#ifndef LAB_DROP_REACH_H
#define LAB_DROP_REACH_H

#include "sim/device.h"

struct reach {
    double k_Npm, b_Nspm; /* the largest k and the largest b with rho < 1; zeros: nowhere */
};
struct reach reach_of(const struct sim_device *d, double rate_Hz, int window);

#endif
