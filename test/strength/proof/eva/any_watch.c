/* SPDX-License-Identifier: MIT */
/* PROVES: speed, standing
 * Speed and stand-still of a finger: any state, any constants, any input.
 *
 * PLANT: lib/src/safe/watch.c: exh_clamp(*vel_mps_q27, -most, most) -> *vel_mps_q27
 */
#include "safe/watch.c"

#include "any.h"

#include "exhand/drive.h"

int main(void)
{
    static struct exh_watch s;
    static struct exh_watch_par par;
    static struct exh_watch_cfg cfg;
    int32_t vel = any32();
    uint32_t limits = any_u32();
    ANY(s);
    ANY(par);
    ANY(cfg);
    cfg.par = &par;
    par.speed_mps_q27 = Frama_C_interval(SPEED_MIN_MPS_Q27, SPEED_MAX_MPS_Q27);
    (void)exh_watch_step(&s, &cfg, &vel, &limits);
    /*@ assert held: -1342177280 <= vel <= 1342177280; */
    exh_watch_coded(&s, &cfg, any32(), any32());
    END();
    return 0;
}
