/* SPDX-License-Identifier: MIT */
/* Sine and cosine of a binary angle. */
#include "exhand/angle.h"

#include "sincos.h"

void exh_sincos(int32_t x_turn_q32, struct exh_sincos *y) { *y = sincos_in_place(x_turn_q32); }
