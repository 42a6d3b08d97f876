/* SPDX-License-Identifier: MIT */
/* PROVES: tables of signals
 * Tables of up to three groups, of up to four rows each and any number of instances, with anything
 * in the rows. Any index, any id, and the CRC of the table.
 *
 * EVA: -eva-slevel 200
 * PLANT: lib/src/num/signal.c: for (; i >= grp->rows; k++) -> for (; i > grp->rows; k++)
 * PLANT: lib/src/num/signal.c: if (instance != NULL) { *instance = k; } -> *instance = k;
 * PLANT: lib/src/num/signal.c: r < grp->rows && instance < grp->instances -> r <= grp->rows
 * PLANT: lib/src/num/signal.c: uint8_t buf[16]; -> uint8_t buf[13];
 * PLANT: lib/src/num/signal.c: uint8_t head[2]; -> uint8_t head[1];
 */
#include "num/bytes.c"
#include "num/crc.c"
#include "num/signal.c" /* not that of Frama-C */

#include "any.h"

#define ROWS   4
#define GROUPS 3

static struct exh_signal row[GROUPS][ROWS];
static struct exh_signal_group group[GROUPS];

int main(void)
{
    struct exh_signal_table t = {group, 0};
    uint16_t instance;
    const struct exh_signal *at;
    int32_t found;
    t.groups = (uint16_t)Frama_C_unsigned_int_interval(0, GROUPS);
    for (unsigned g = 0; g < GROUPS; g++) {
        ANY(row[g]);
        group[g].row = row[g];
        group[g].rows = (uint16_t)Frama_C_unsigned_int_interval(0, ROWS);
        group[g].instances = (uint16_t)Frama_C_unsigned_int_interval(0, UINT16_MAX);
    }
    (void)exh_signal_count(&t);
    at = exh_signal_at(&t, any_u32(), &instance);
    if (at != NULL) { (void)exh_signal_is_fixed(at); }
    at = exh_signal_at(&t, any_u32(), NULL);
    if (at != NULL) { (void)at->dflt; }
    found = exh_signal_find(&t, (uint16_t)any_u32(), (uint16_t)any_u32());
    /*@ assert found_or_not: -100 < found < 3 * 4 * 65536; */
    (void)exh_signal_crc(&t);
    END();
    return 0;
}
