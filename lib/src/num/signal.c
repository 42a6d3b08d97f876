/* SPDX-License-Identifier: MIT */
/* Lookup, count and CRC of a table of signals. */
#include "exhand/signal.h"

#include "exhand/bytes.h"
#include "exhand/error.h"
#include "exhand/fix.h"

uint32_t exh_signal_count(const struct exh_signal_table *t)
{
    uint32_t n = 0;
    for (uint16_t g = 0; g < t->groups; g++) {
        n += (uint32_t)t->group[g].rows * t->group[g].instances;
    }
    return n;
}

const struct exh_signal *exh_signal_at(
    const struct exh_signal_table *t, uint32_t i, uint16_t *instance)
{
    for (uint16_t g = 0; g < t->groups; g++) {
        const struct exh_signal_group *grp = &t->group[g];
        const uint32_t all = (uint32_t)grp->rows * grp->instances;
        uint16_t k = 0;
        if (i >= all) { /* skips whole groups, since every staged value is looked up in a tick */
            i -= all;
            continue;
        }
        for (; i >= grp->rows; k++) { i -= grp->rows; }
        if (instance != NULL) { *instance = k; }
        return &grp->row[i];
    }
    return NULL;
}

/* Searches rows, not values, since a packet may need it within a tick. */
int32_t exh_signal_find(const struct exh_signal_table *t, uint16_t id, uint16_t instance)
{
    uint32_t first = 0; /* first value of this group */
    for (uint16_t g = 0; g < t->groups; g++) {
        const struct exh_signal_group *grp = &t->group[g];
        for (uint16_t r = 0; r < grp->rows && instance < grp->instances; r++) {
            if (grp->row[r].id == id) {
                return (int32_t)(first + (uint32_t)grp->rows * instance + r);
            }
        }
        first += (uint32_t)grp->rows * grp->instances;
    }
    return -EXH_E_UNKNOWN;
}

int exh_rows_validate(const struct exh_signal *row, unsigned n, const void *values)
{
    for (unsigned i = 0; i < n; i++) {
        /* Address from bytes of the whole: a pointer to one member must not reach the next. */
        const void *at = (const uint8_t *)values + i * sizeof(int32_t);
        const int32_t v = *(const int32_t *)at;
        if (!exh_inside(v, row[i].min, row[i].max)) { return 0; }
    }
    return 1;
}

uint32_t exh_signal_crc(const struct exh_signal_table *t)
{
    uint32_t crc = 0;
    for (uint16_t g = 0; g < t->groups; g++) {
        uint16_t rows = t->group[g].rows;
        uint8_t head[2];
        struct exh_bytes h = exh_bytes_writer(head, sizeof head);
        exh_bytes_u16(&h, &rows); /* all rows of an instance are adjacent */
        crc = exh_crc32(crc, head, h.at);
        for (uint16_t r = 0; r < t->group[g].rows; r++) {
            struct exh_signal row = t->group[g].row[r];
            uint16_t instances = t->group[g].instances;
            uint8_t buf[16];
            struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
            exh_bytes_u16(&c, &row.id);
            exh_bytes_u8(&c, &row.frac);
            exh_bytes_u8(&c, &row.when);
            exh_bytes_i32(&c, &row.min);
            exh_bytes_i32(&c, &row.max);
            exh_bytes_u16(&c, &instances);
            crc = exh_crc32(crc, buf, c.at);
        }
    }
    return crc;
}
