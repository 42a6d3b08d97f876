/* SPDX-License-Identifier: MIT */
/* A scene of integers: no FPU, MMX or SSE register is ever touched. */
#include "pc104.h"

void pc104_fpu_open(void) {}
