/* SPDX-License-Identifier: MIT */
#include "base/none.h"

#include <math.h>

/* Outputs of the bilateral scene, by ids that stay: examples/bilateral/tables.c. */
static const struct {
    uint16_t id;
    int32_t raw;
} none[] = {
    {0x8707, INT32_MIN}, /* d: there is no plane */
    {0x8708, INT32_MAX}, /* q_lim: no contact can be */
};

int none_is(const struct exh_signal *row, int32_t raw)
{
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        if (row->id == none[i].id && raw == none[i].raw) { return 1; }
    }
    return 0;
}

double none_or(const struct exh_signal *row, int32_t raw)
{
    return none_is(row, raw) ? (double)NAN : (double)raw / (double)(INT64_C(1) << row->frac);
}

void none_or_cell(FILE *to, const struct exh_signal *row, int32_t raw)
{
    fputc(',', to);
    if (!none_is(row, raw)) { fprintf(to, "%.9g", none_or(row, raw)); }
}
