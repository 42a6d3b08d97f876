/* SPDX-License-Identifier: MIT */
/* PROVES: speed, standing
 * Speed and standstill of a finger: any state, any constants, any input.
 *
 * PLANT: lib/src/safe/motion.c: exh_clamp32(*vel_mps_q27, -most, most) -> *vel_mps_q27
 */
#include "safe/motion.c"

#include "any.h"

#include "exhand/drive.h"

int main(void)
{
    static struct exh_motion s;
    static struct exh_motion_par par;
    static struct exh_motion_cfg cfg;
    int32_t vel = any32();
    uint32_t limits = any_u32();
    ANY(s);
    ANY(par);
    ANY(cfg);
    cfg.par = &par;
    par.speed_mps_q27 = Frama_C_interval(SPEED_MIN_MPS_Q27, SPEED_MAX_MPS_Q27);
    (void)exh_motion_step(&s, &cfg, &vel, &limits);
    /*@ assert held: -1342177280 <= vel <= 1342177280; */
    exh_motion_update(&s, &cfg, any32(), any32());
    END();
    return 0;
}
