/* SPDX-License-Identifier: MIT */
/* PROVES: scene guarded
 * Scene guarded with the functions of drop, with inputs as for drop. With and without a rule of
 * gains, including values that the rule stages or refuses.
 *
 * EVA: -eva-slevel 40 -eva-split-return-function setup:0,drop_setup:0,guarded_setup:0,ask_rule:0 -kernel-warn-key annot:missing-spec=abort
 * WITH: examples/drop/drop.c
 * PLANT: examples/guarded/guarded.c: cfg->held, t->force_to_cur, t->to_cur_n) -> cfg->held, t->cur_to_force, t->to_force_n)
 * PLANT: examples/guarded/guarded.c: return err == 0 ? ask_rule(par, board.T) : err; -> return err;
 * PLANT: examples/guarded/guarded.c: return active.own.rule_on ? exh_gains_stage( -> return !active.own.rule_on ? exh_gains_stage(
 * PLANT: examples/guarded/guarded.c: if (active.own.rule_on) { exh_gains_step -> if (1) { exh_gains_step
 * PLANT: examples/guarded/guarded.c: sig->passivity_N_q20 = exh_sat32(now.f.passivity_N_q20); -> sig->passivity_N_q20 = (int32_t)now.f.passivity_N_q20;
 * PLANT: examples/guarded/guarded.c: held.n = t->to_cur_n; -> (void)0;
 */
#include "guarded/guarded.c"

#include "called_params.h"

static void scene(int32_t rule_on)
{
    const struct exh_scene_board board = {{any_u32(), any_u32()}, any8()};
    static struct exh_bytes c;
    static struct exh_scene_in in;
    static struct exh_drive_out out;
    exh_scene_guarded.defaults();
    active.own.rule_on = rule_on;
    if (exh_scene_guarded.setup(board) != 0) { return; }
    /*@ admit rows: contact_par(&active.drop.contact); */ /* units contract, params */
    (void)guarded_stage((uint16_t)any_u32(), (uint16_t)any_u32(), any32());
    (void)exh_scene_guarded.allowed();
    exh_scene_guarded.state(&c);
    ANY(in);
    exh_scene_guarded.tick(&in, &out);
    /*@ assert next: velocity(&state.drop.velocity) && contact(&state.drop.contact) && drive(&state.drop.drive) &&
          safety(&state.drop.safety) && passivity(&state.passivity); */
    /*@ assert guarded: guard(&guard); */
    END();
}

int main(void)
{
    scene(0);
    scene(1);
    return 0;
}
