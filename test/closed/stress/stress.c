/* SPDX-License-Identifier: MIT */
/* Stress: the drop scene at and beyond the ends of its ranges, alone and in closed loop with the
 * simulated device; sine and cosine of every angle. `make stress` builds it with
 * -fsanitize=address,undefined and runs it. It also runs the property tests with
 * EXH_CASES=100000000.
 *
 * Prints one table: the case, its own rules, what held, ok or FAIL. Exit status 1 on any FAIL.
 * These rules hold in every tick of every case:
 *
 *   output    The scene's output is that of its modules, called in the documented order.
 *   state     State of the box, latched causes and faults are those of box.c, a model written from
 *             docs/SAFETY.md without a table. `alive` counts.
 *   ledgers   The terms of force and current sum to the last bit.
 *   force     Gate open: the law's force, limited to 0, f_max, the table's end and the ramp's share
 *             of them, or as near as the slew limit allows. Release: the force at its beginning
 *             less equal steps, whatever the law commands, and 0 after the last step. Else 0.
 *   slew      Gate open: |change of F| <= slew * T + 1 LSB.
 *   speed     The law gets the measured velocity, limited to speed_limit. A higher speed for longer
 *             than speed_time is a fault.
 *   slewed    Parameters that act on force change by 1/2^s of the rest in a tick, rounded up. All
 *             others change in one tick.
 *   code      dac_zero <= code <= dac_zero + dac_span: a string is never pushed. Gate shut, or axis
 *             not in use: dac_zero and disabled. Release: never above the code of the tick before.
 *   current   0 <= i <= i_peak, coded to half a code.
 *   heat      The integral of i^2 - i_cont^2 stays within i_peak for peak_time, in whole ticks
 *             rounded up, and one tick more.
 *   signals   c is 0 or 1 and agrees with q and q_lim. Enums and bit sets have known values. The
 *             monitored force is on its table.
 *
 * ends.c has the other scenes, with fewer rules, and the signs of saturated values.
 */
#include "stress.h"

#include <stdlib.h>

uint64_t cases = 1000000;

int main(int argc, char **argv)
{
    int failed;
    if (argc > 1) { cases = strtoull(argv[1], NULL, 10); }
    if (argc > 2 || cases < 1000) {
        fprintf(stderr, "usage: stress [ticks of a long case, 1000 or more (1000000)]\n");
        return 2;
    }
    exh_scene_drop.defaults(); /* its table is the one the rig uses */
    printf("In every tick: output, state, ledgers, force, slew, speed, slewed, code, current, "
           "heat, signals (see "
           "test/closed/stress/stress.c).\n");
    closed_loops();
    open_loops();
    random_parameters();
    heats();
    wraps();
    all_at_their_ends();
    failed = failures() + every_angle(cases < 1000000 ? (uint32_t)(1000000 / cases) : 1);
    printf("%d failed\n", failed);
    return failed != 0;
}
