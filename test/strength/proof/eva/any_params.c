/* SPDX-License-Identifier: MIT */
/* PROVES: parameters
 * Anything in the rows of a table with four groups, in both arrays and in the data beside them,
 * damaged or not. Look-up, apply, stage, put, drop and restore with any index and value. A step
 * towards any goal with any shift. Set-up with any time and period. Images of any bytes in three
 * lengths, a keyframe of any bytes, and both written into buffers of some sizes.
 *
 * EVA: -eva-slevel 10 -eva-min-loop-unroll 16
 * PLANT: lib/src/num/params.c: const uint32_t i = p->at < p->count ? p->at : 0; -> const uint32_t i = p->at;
 * PLANT: lib/src/num/params.c: if (row == NULL) { return -EXH_E_UNKNOWN; } -> (void)0;
 * PLANT: lib/src/num/params.c: int err = whole(p, buf, len_B); -> int err = 0;
 * PLANT: lib/src/num/params.c: falls ? 0 : p->shift & 31u -> falls ? 0 : p->shift
 * PLANT: lib/src/num/params.c: for (uint32_t i = 0; i < p->count; i++) { put(p, p->staged, i, was[i]); } -> for (uint32_t i = 0; i <= p->count; i++) { put(p, p->staged, i, was[i]); }
 * PLANT: lib/src/num/params.c: first += (uint32_t)g->rows * g->instances; -> first += (uint32_t)g->rows * (g->instances + 1u);
 * PLANT: lib/src/num/params.c: &g->row[r], i++, take) -> &g->row[r], ++i, take)
 * PLANT: lib/src/num/params.c: if (bad != NULL) { *bad = i; } -> *bad = i;
 * PLANT: lib/src/num/params.c: if (len_B < body_B + IMAGE_CRC_B) { return -EXH_E_SHORT; } -> (void)0;
 */
#include "num/bytes.c"
#include "num/crc.c"
#include "num/fix.c"
#define exh_signal_crc table_crc /* its proof is any_signal.c */
struct exh_signal_table;
uint32_t table_crc(const struct exh_signal_table *t);
#include "num/authority.c"
#include "num/params.c"
#undef exh_signal_crc
#include "num/signal.c" /* not that of Frama-C */

#include "table.h"

#define IMAGE_B (IMAGE_HEAD_B + 4 * TABLE_VALUES + IMAGE_CRC_B)

static struct exh_params p;
static int32_t active[TABLE_VALUES], staged[TABLE_VALUES], was[TABLE_VALUES];
static uint8_t image_B[IMAGE_B + 1];

uint32_t table_crc(const struct exh_signal_table *t)
{
    (void)t;
    return any_u32();
}

static void any_params(void)
{
    any_rows();
    exh_params_setup(&p, &table, active, staged);
    /*@ assert counted: p.count == 8; */
    ANY(active);
    ANY(staged);
    p.locked = any8();
    p.pending = any8();
    p.moving = any8();
    p.shift = any8();
    p.led[0] = p.led[1] = (uint16_t)any_u32();
    p.sum = any_u32();
    p.passed = any_u32();
    p.at = any_u32();
}

static void changes(void)
{
    const struct exh_tune_par tune = {any32()};
    const struct exh_period T = {any_u32(), any_u32()};
    struct exh_authority who;
    ANY(who);
    any_params();
    (void)exh_params_verify(&p);
    /*@ assert next: p.at < 8; */
    (void)exh_params_stage(&p, (uint16_t)any_u32(), (uint16_t)any_u32(), any32());
    (void)exh_params_stage_at(&p, Frama_C_unsigned_int_interval(TABLE_VALUES, UINT32_MAX), any32());
    for (uint32_t i = 0; i < TABLE_VALUES; i++) { (void)exh_params_stage_by(&p, who, i, any32()); }
    exh_params_set_active(&p, Frama_C_unsigned_int_interval(0, TABLE_VALUES - 1), any32());
    (void)exh_params_apply(&p);
    exh_params_discard(&p);
    ANY(was);
    exh_params_rollback(&p, was, any8());
    exh_params_slew_setup(&p, &tune, T);
    /*@ assert shift: p.shift <= 15; */
    (void)exh_params_apply(&p);
    exh_params_seal(&p);
    (void)exh_params_slew_step(any32(), any32(), Frama_C_unsigned_int_interval(0, 31));
}

static void loaded(size_t len_B)
{
    uint32_t bad;
    any_params();
    ANY(image_B);
    /* Its end is the end of the array. */
    (void)exh_params_restore(&p, image_B + sizeof image_B - len_B, len_B, NULL);
    (void)exh_params_load(&p, image_B + sizeof image_B - len_B, len_B, len_B & 1 ? &bad : NULL);
}

static void saved(size_t cap_B)
{
    any_params();
    (void)exh_params_save(&p, image_B + sizeof image_B - cap_B, cap_B);
}

static void keyframe(void)
{
    static uint8_t frame_B[8 * TABLE_VALUES];
    struct exh_bytes c;
    any_params();
    FROM_BYTES(p, exh_params_serialize);
    c = exh_bytes_writer(frame_B, sizeof frame_B);
    exh_params_serialize(&c, &p);
    c = exh_bytes_writer(frame_B, 7);
    exh_params_serialize(&c, &p);
    ANY(frame_B);
    c = exh_bytes_reader(frame_B, 7);
    exh_params_serialize(&c, &p);
}

int main(void)
{
    static const struct exh_params zero;
    p = zero;
    (void)exh_params_verify(&p);
    changes();
    loaded(IMAGE_B);
    loaded(IMAGE_B - 1);
    loaded(IMAGE_HEAD_B - 1);
    saved(IMAGE_B);
    saved(IMAGE_B - 1);
    saved(3);
    keyframe();
    END();
    return 0;
}
