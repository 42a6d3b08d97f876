/* Stress: the drop scene at and beyond the ends of its ranges, alone and in closed loop
 * over the simulated device; and sine and cosine of every angle there is. `make stress` builds
 * it with -fsanitize=address,undefined, runs it, and runs the property tests with EXH_CASES=100000000 for the laws themselves.
 *
 * Prints one table: case, what must hold besides the rules below, what held, ok or FAIL.
 * Exit status 1 on any FAIL. In every tick of every case must hold:
 *
 *   output     the scene gives what its modules give in their documented order
 *   ledgers    force and current terms sum to the last bit
 *   force      0 outside RUN; 0 <= F <= f_max and the table's end (above f_max, after it was lowered, only on its way down)
 *   slew       |change of F| <= slew * T + 1 LSB
 *   code       dac_zero <= code <= dac_zero + dac_span: a string is never pushed; outside
 *              RUN, and on axes not in use, dac_zero and disabled
 *   current    0 <= i <= i_peak, coded to half a code
 *   heat       the integral of i^2 - i_cont^2 stays within i_peak for peak_time, in whole
 *              ticks rounded up, and one tick more
 *   signals    c is 0 or 1 and agrees with q and q_lim, enums and bit sets are known ones,
 *              the monitored force lies on its table
 */
#include "stress.h"

int main(void)
{
    int failed;
    exh_scene_drop.defaults(); /* its table is the one the rig uses */
    printf("In every tick: output, ledgers, force, slew, code, current, heat, signals (see "
           "test/stress/stress.c).\n");
    closed_loops();
    open_loops();
    random_parameters();
    heats();
    wraps();
    failed = failures() + every_angle();
    printf("%d failed\n", failed);
    return failed != 0;
}
