/* SPDX-License-Identifier: MIT */
#ifndef CERTIFICATE_DRAW_H
#define CERTIFICATE_DRAW_H

#include "sim/device.h"

#include <stdint.h>

/* A device by chance: each of its values over the range that is plausible for such a box, and
 * somewhat beyond. */
struct sim_device draw_device(uint64_t seed);

#endif
