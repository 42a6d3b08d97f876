/* SPDX-License-Identifier: MIT */
/* Grid: time steps that repeat to the bit. An instant in double has a rounding error. So the steps
 * between ticks, outputs and servo samples differ in their last bits, and results for one step
 * cannot be reused. On a grid of 2^-46 s (14 fs, the last bit at 64 s) there are few different
 * steps. No error accumulates: their sum is exact on the grid. */
#ifndef SIM_GRID_H
#define SIM_GRID_H

#include <stdint.h>

#define SIM_GRID_PER_S 70368744177664.0 /* 2^46 */

/* From 2^16 s on an instant has no finer bits anyway. */
static inline double sim_grid(double t_s)
{
    return t_s < 65536 ? (double)(int64_t)(t_s * SIM_GRID_PER_S + 0.5) * (1 / SIM_GRID_PER_S) : t_s;
}

/* From a to b. */
static inline double sim_grid_s(double from_s, double to_s)
{
    return sim_grid(to_s) - sim_grid(from_s);
}

/* Which of a power of two of slots a length below 2^16 s goes to: neighbours have others. */
static inline unsigned sim_grid_slot(double length_s, unsigned slots)
{
    return (unsigned)(int64_t)(length_s * SIM_GRID_PER_S) & (slots - 1);
}

#endif
