/* SPDX-License-Identifier: MIT */
/* PROVES: scene minimal
 * Scene minimal: set-up for any board, then a tick in any state, with any frame, command and
 * missed ticks. All library functions keep contract.h. The tick leaves a state that the next tick
 * accepts.
 *
 * EVA: -eva-slevel 40 -eva-split-return-function setup:0 -kernel-warn-key annot:missing-spec=abort
 * PLANT: examples/minimal/minimal.c: &now, 1, box); -> &now, 0, box);
 * PLANT: lib/include/exhand/axis.h: exh_gate_step(s, a->drive_cfg, 1, -> exh_gate_step(s, a->drive_cfg, 2,
 * PLANT: examples/minimal/minimal.c: exh_axis_sense(&axis, &in->drive, 0); -> exh_axis_sense(&axis, &in->drive, 5);
 * PLANT: examples/minimal/minimal.c: (void)exh_contact_law(&contact_par, q, &f); -> (void)q;
 * PLANT: examples/minimal/minimal.c: = {knot, 2}, no_table -> = {knot, 3}, no_table
 */
#include "minimal/minimal.c"

#include "called.h"

int main(void)
{
    const struct exh_scene_board board = {{any_u32(), any_u32()}, any8()};
    static struct exh_scene_in in;
    static struct exh_drive_out out;
    if (exh_scene_minimal.setup(board) != 0) { return 1; }
    ANY(s.quad);
    s.vel = any_velocity();
    s.drive = any_drive();
    ANY(s.track);
    s.safety = any_safety();
    ANY(in);
    exh_scene_minimal.tick(&in, &out);
    /*@ assert next: velocity(&s.vel) && drive(&s.drive) && safety(&s.safety); */
    /*@ assert no_other_drive: out.enable <= 1; */
    END();
    return 0;
}
