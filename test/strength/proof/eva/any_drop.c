/* SPDX-License-Identifier: MIT */
/* PROVES: scene drop
 * Scene drop: set-up with any parameters, board and calibrations, then a tick in any state read
 * from bytes, with any frame, command and missed ticks. All library functions keep contract.h. The
 * tick leaves a state that the next tick accepts.
 *
 * EVA: -eva-slevel 40 -eva-split-return-function setup:0,drop_setup:0 -kernel-warn-key annot:missing-spec=abort
 * PLANT: examples/drop/drop.c: &of, 1, box); -> &of, 6, box);
 * PLANT: lib/include/exhand/axis.h: exh_gate_step(s, a->drive_cfg, 1, -> exh_gate_step(s, a->drive_cfg, 2,
 * PLANT: lib/include/exhand/axis.h: uint32_t raised = 0, limits = 0; -> uint32_t raised = 0, limits;
 * PLANT: examples/drop/drop.c: (starved ? EXH_FAULT_SUPPLY : 0u) -> (starved ? EXH_FAULT_SUPPLY << 5 : 0u)
 * PLANT: examples/drop/drop.c: sig->faults = exh_from_u32(s->safety.faults); -> sig->faults = (int32_t)s->safety.faults;
 * PLANT: examples/drop/drop.c: exh_integrity_seal(&guard, &cfg, sizeof cfg, -> exh_integrity_seal(&guard, &cfg, sizeof cfg + 1,
 * PLANT: examples/drop/drop.c: const struct exh_calib_finger finger = {0, &par->drive -> const struct exh_calib_finger finger = {0, NULL
 * PLANT: lib/include/exhand/axis.h: return limits | exh_drive_current_step(a->drive, a->drive_cfg, f, i); -> return limits;
 */
#include "drop/drop.c"

#include "called_params.h"

int main(void)
{
    static struct exh_bytes c;
    const struct exh_scene_board board = {{any_u32(), any_u32()}, any8()};
    static struct exh_scene_in in;
    static struct exh_drive_out out;
    exh_scene_drop.defaults();
    if (exh_scene_drop.setup(board) != 0) { return 1; }
    /*@ admit rows: contact_par(&active.contact); */ /* units contract, params */
    exh_scene_drop.state(&c);
    state.more = any_causes(); /* as a scene around it raises them */
    ANY(in);
    exh_scene_drop.tick(&in, &out);
    /*@ assert next: velocity(&state.velocity) && contact(&state.contact) && drive(&state.drive) && safety(&state.safety); */
    /*@ assert guarded: guard(&guard) && state.broken <= 1; */
    /*@ assert no_other_drive: out.enable <= 1; */
    END();
    return 0;
}
