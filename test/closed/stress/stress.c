/* SPDX-License-Identifier: MIT */
/* Stress: the drop scene at and beyond the ends of its ranges, alone and in closed loop
 * over the simulated device; and sine and cosine of every angle there is. `make stress` builds
 * it with -fsanitize=address,undefined, runs it, and runs the property tests with
 * EXH_CASES=100000000 for the laws themselves.
 *
 * Prints one table: case, what must hold besides the rules below, what held, ok or FAIL.
 * Exit status 1 on any FAIL. In every tick of every case must hold:
 *
 *   output     the scene gives what its modules give in their documented order
 *   state      of the box, causes and faults latched are those of box.c, which knows SAFETY.md and
 * no table; alive counts ledgers    force and current terms sum to the last bit force      open:
 * what the law asks for, within 0, f_max, the table's end and the ramp's share of them, or as near
 * as slew lets it; in a release the force at its beginning less equal steps, whatever the law asks
 * for, and 0 after the last; else 0 slew       open: |change of F| <= slew * T + 1 LSB speed
 * velocity into the law is what was measured within speed_limit; for longer than speed_time it is a
 * fault slewed     parameters that act on force go 1/2^s of what is left a tick, rounded up, all
 * others at once code       dac_zero <= code <= dac_zero + dac_span: a string is never pushed;
 * shut, and on axes not in use, dac_zero and disabled; in a release never further out than in the
 * tick before current    0 <= i <= i_peak, coded to half a code heat       the integral of i^2 -
 * i_cont^2 stays within i_peak for peak_time, in whole ticks rounded up, and one tick more signals
 * c is 0 or 1 and agrees with q and q_lim, enums and bit sets are known ones, the monitored force
 * lies on its table
 *
 * ends.c: other scenes, of which less is asked, and the signs of what saturates.
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
