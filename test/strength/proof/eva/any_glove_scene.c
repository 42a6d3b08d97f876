/* SPDX-License-Identifier: MIT */
/* PROVES: scene glove
 * Scene glove: set-up with any parameters, calibration and board, then a tick with or without a
 * frame in any state read from bytes. All library functions keep contract_box.h. The gate has
 * nothing to drive.
 *
 * EVA: -eva-slevel 40 -eva-split-return-function setup:0,glove_setup:0 -kernel-warn-key annot:missing-spec=abort
 * WITH: examples/glove/cal.c lib/src/sense/glove_cal.c
 * PLANT: examples/glove/glove.c: exh_hand_tip(&cfg->finger[f], joint, -> exh_hand_tip(&cfg->finger[f + 1], joint,
 * PLANT: examples/glove/glove.c: << (EXH_HAND_JOINTS * f); -> << (7 * EXH_HAND_JOINTS * f);
 * PLANT: examples/glove/glove.c: exh_gate_shut(&shut, -> exh_gate_shut(NULL,
 * PLANT: examples/glove/glove.c: const uint64_t num = (uint64_t)board.T.num * (uint32_t)active.own.every; -> const int32_t num = (int32_t)board.T.num * active.own.every;
 */
#include "glove/glove.c"

#include "called_box.h"

int main(void)
{
    const struct exh_scene_board board = {{any_u32(), any_u32()}, any8()};
    static struct exh_scene_in in;
    static struct exh_drive_out out;
    static struct exh_bytes c;
    static struct exh_glove_cal cal;
    exh_scene_glove.defaults();
    ANY(cal);
    (void)glove_stage_cal(&cal, NULL);
    if (exh_scene_glove.setup(board) != 0) { return 1; }
    exh_scene_glove.state(&c);
    shut.fingers = 1; /* set-up's: no bytes have it */
    ANY(in);
    exh_scene_glove.tick(&in, &out);
    exh_scene_glove.tick(&in, &out);
    END();
    return 0;
}
