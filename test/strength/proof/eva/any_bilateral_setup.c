/* SPDX-License-Identifier: MIT */
/* PROVES: set-up of scene bilateral
 * Set-up of scene bilateral: any choice of fingers, parameters, calibrations and timer that the
 * loop accepts. The configuration is one that unit bilateral assumes. Every place is a finger, and
 * the fingers in use come first.
 *
 * EVA: -eva-slevel 20 -eva-split-return-function setup:0,bilateral_setup:0,bilateral_finger_setup:0 -kernel-warn-key annot:missing-spec=abort
 * WITH: examples/glove/cal.c lib/src/sense/glove_cal.c examples/bilateral/finger.c examples/bilateral/gains.c examples/bilateral/frame.c examples/bilateral/cause.c examples/bilateral/wire.c examples/bilateral/tables.c
 * PLANT: examples/bilateral/bilateral.c: if (!(mask >> f & 1u)) { cfg->at[at++] = (uint8_t)f; } -> cfg->at[at++] = (uint8_t)f;
 * PLANT: examples/bilateral/bilateral.c: cfg->drive[k] = cfg->drive[0]; -> (void)0;
 * PLANT: examples/bilateral/bilateral.c: if (cfg->n == 0) { return -EXH_E_RANGE; } -> (void)0;
 * PLANT: examples/bilateral/finger.c: &cfg->drive[place], drive, -> &cfg->drive[place], drive + 1000,
 * PLANT: examples/bilateral/finger.c: err = exh_hand_couple(&c->hand, &exh_hit2_map, f); -> err = exh_hand_couple(&c->hand, &exh_hit2_map, f + 1);
 * PLANT: examples/bilateral/finger.c: UINT32_C(1) << joint->sensor[t]; -> UINT32_C(1) << (joint->sensor[t] + 64);
 */
#include "bilateral/bilateral.c"

#define exh_signal_crc crc_by_bytes /* its proof is any_signal.c */
#include "called_box.h"
#undef exh_signal_crc
#include "sense/hand_hit2.c"

int exh_precontact_setup(struct exh_precontact_cfg *to, const struct exh_precontact_par *par,
    const struct exh_material_par *material, unsigned materials, int32_t pad_m_q30,
    struct exh_period T)
{
    struct exh_precontact_cfg made;
    (void)pad_m_q30;
    (void)T;
    /*@ assert precontact_setup: \valid_read(par) && 1 <= materials <= 255 && \valid_read(material + (0 .. materials - 1)); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    /*@ admit precontact_par(par); */
    ANY(made);
    /*@ admit precontact_made(&made); */
    made.par = par;
    made.material = material;
    made.materials = (uint8_t)materials;
    *to = made;
    return 0;
}

uint64_t exh_udiv64(uint64_t num, uint64_t den, uint64_t *rem)
{
    /*@ assert divisor: den != 0; */
    if (rem) { *rem = num % den; }
    return num / den;
}

int exh_selftest_glove(void) { return any8(); }

uint32_t exh_board_cycles(void) { return any_u32(); }

uint32_t exh_ticks_in(int32_t ms, struct exh_period T)
{
    (void)ms;
    /*@ assert ticks_in: T.num != 0; */
    return any_u32();
}

uint32_t exh_signal_crc(const struct exh_signal_table *t)
{
    /*@ assert signal_crc: \valid_read(t); */
    return any_u32();
}

/* Each choice one by one: 32 of them. */
static void chosen(int32_t fingers)
{
    const struct exh_scene_board board = {{Frama_C_unsigned_int_interval(1, UINT32_MAX),
                                              Frama_C_unsigned_int_interval(1, UINT32_MAX)},
        any8()};
    int err;
    exh_scene_bilateral.defaults();
    active.own.fingers = fingers;
    err = exh_scene_bilateral.setup(board);
    if (err != 0) { return; }
    /*@ assert some: 1 <= cfg.n <= 5; */
    /*@ assert parts: 1 <= cfg.parts <= 7; */
    for (unsigned k = 0; k < BILATERAL_FINGERS; k++) {
        const unsigned f = cfg.at[k];
        const struct bilateral_finger_cfg *const c = &cfg.finger[f];
        const struct exh_drive_cfg *const drive = &cfg.drive[k];
        const int used = fingers >> f & 1;
        /*@ assert finger: f < 5; */
        /*@ assert first_those_in_use: k < cfg.n ? used == 1 : used == 0; */
        /*@ assert made_drive: drive_cfg(drive); */
        /*@ assert made_finger: quad_cfg(&c->quad) && velocity_cfg(&c->velocity) && track_cfg(&c->track) && watch_cfg(&c->watch) && chatter_cfg(&c->chatter) &&
              hand(&c->hand) && precontact_cfg(&c->precontact); */
    }
    /*@ assert made: safety_cfg(&cfg.safety) && glove_cfg(&cfg.glove) && guard(&guard); */
    END();
}

int main(void)
{
    for (int32_t fingers = 0; fingers < 1 << BILATERAL_FINGERS; fingers++) { chosen(fingers); }
    return 0;
}
