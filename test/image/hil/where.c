/* SPDX-License-Identifier: MIT */
#include "where.h"

#include <inttypes.h>
#include <stdlib.h>

#define BLOCKS 16384

struct block {
    uint32_t address, n[2];
};

static struct tick {
    uint32_t insns;
    unsigned blocks;
    struct {
        uint32_t address;
        unsigned n;
    } block[BLOCKS];
} now, cheapest, dearest;
static int inside, any;

void where_begin(void)
{
    now.blocks = 0;
    inside = 1;
}

void where_block(uint32_t address, unsigned n)
{
    if (!inside || now.blocks == BLOCKS) { return; }
    now.block[now.blocks].address = address;
    now.block[now.blocks++].n = n;
}

void where_end(uint32_t n)
{
    if (!inside) { return; }
    inside = 0;
    now.insns = n;
    if (!any || n < cheapest.insns) { cheapest = now; }
    if (!any || n > dearest.insns) { dearest = now; }
    any = 1;
}

static unsigned add(struct block *sum, unsigned sums, const struct tick *t, unsigned column)
{
    for (unsigned i = 0; i < t->blocks; i++) {
        unsigned j = 0;
        while (j < sums && sum[j].address != t->block[i].address) { j++; }
        if (j == sums && sums < BLOCKS) {
            sum[sums++] = (struct block){t->block[i].address, {0, 0}};
        }
        if (j < sums) { sum[j].n[column] += t->block[i].n; }
    }
    return sums;
}

static int by_address(const void *a, const void *b)
{
    const struct block *x = a, *y = b;
    return (x->address > y->address) - (x->address < y->address);
}

void where_print(int all)
{
    static struct block sum[BLOCKS];
    unsigned sums = add(sum, 0, &cheapest, 0);
    sums = add(sum, sums, &dearest, 1);
    qsort(sum, sums, sizeof sum[0], by_address);
    for (unsigned i = 0; i < sums; i++) {
        if (all || sum[i].n[0] != sum[i].n[1]) {
            printf("  0x%06" PRIx32 " %6" PRIu32 " %6" PRIu32 "\n", sum[i].address, sum[i].n[0],
                sum[i].n[1]);
        }
    }
}
