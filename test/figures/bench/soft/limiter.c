/* SPDX-License-Identifier: MIT */
/* The limiter's kinds, each from its own start. */
#include "soft.h"

#include "limiter_ops.h"

static const struct soft_op op[] = {
    {"limiter,effort", op_effort}, {"limiter,position", op_position}, {"limiter,wall", op_wall}};

const struct soft_group soft_limiter[3] = {
    {&op[0], 1, start_effort}, {&op[1], 1, start_position}, {&op[2], 1, start_wall}};
