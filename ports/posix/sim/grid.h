/* SPDX-License-Identifier: MIT */
/* Grid: lengths of time that repeat to the bit.
 *
 * An instant in double has an error of its own, so the pieces between ticks, outputs and servo
 * samples differ in their last bits, and nothing that was worked out for one serves the next.
 * Between instants on a grid of 2^-46 s (14 fs, a last bit at 64 s) they are few. No error adds up:
 * the pieces' sum is the whole, on the grid. */
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
