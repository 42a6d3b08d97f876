/* SPDX-License-Identifier: MIT */
/* PROVES: guard
 * Areas of 0, 1, 8, 13 and 16 bytes with any content, at any place of a round. The tick reads
 * nothing outside the area. With and without parameters of any content (any_params.c).
 *
 * EVA: -eva-slevel 200
 * PLANT: lib/src/safe/integrity.c: left < EXH_INTEGRITY_B ? left : EXH_INTEGRITY_B -> EXH_INTEGRITY_B
 * PLANT: lib/src/safe/integrity.c: if (g->at < g->len_B) { return; } -> if (g->at <= g->len_B) { return; }
 * PLANT: lib/src/safe/integrity.c: EXH_INTEGRITY_B - n) -> EXH_INTEGRITY_B - n + 2)
 * PLANT: lib/src/safe/integrity.c: if (g->params) { look_at_params(g); } -> look_at_params(g);
 */
#include "num/bytes.c"
#include "num/crc.c"
#include "num/fix.c"
#include "safe/integrity.c"
#include "num/authority.c"
#include "num/params.c"
#include "num/signal.c" /* not that of Frama-C */

#include "table.h"

static struct exh_integrity g;
static struct exh_params p;
static int32_t active[TABLE_VALUES], staged[TABLE_VALUES];

static void rounds(const uint8_t *area, uint32_t len_B, struct exh_params *params)
{
    exh_integrity_seal(&g, area, len_B, params);
    for (uint32_t at = 0; at < len_B || at == 0; at++) {
        g.at = at;
        g.want = any_u32();
        g.crc = any_u32();
        (void)exh_integrity_step(&g);
        /*@ assert place: g.at < len_B || g.at == 0; */
    }
}

static void area_of(uint32_t len_B)
{
    static uint8_t area[16];
    ANY(area);
    rounds(area + 16 - len_B, len_B, &p);
    rounds(area + 16 - len_B, len_B, NULL);
}

int main(void)
{
    static const struct exh_integrity zero;
    g = zero;
    (void)exh_integrity_step(&g);
    any_rows();
    exh_params_setup(&p, &table, active, staged);
    ANY(active);
    ANY(staged);
    p.pending = any8();
    p.at = any_u32();
    area_of(0);
    area_of(1);
    area_of(8);
    area_of(13);
    area_of(16);
    END();
    return 0;
}
