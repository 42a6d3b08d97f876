/* SPDX-License-Identifier: MIT */
/* Compares configuration and parameters with their checksums, a few bytes per tick. */
#include "exhand/integrity.h"

#include "exhand/bytes.h"

void exh_integrity_seal(
    struct exh_integrity *g, const void *area, size_t len_B, struct exh_params *params)
{
    g->area = (const uint8_t *)area;
    g->len_B = (uint32_t)len_B;
    g->want = exh_crc32(0, area, len_B);
    g->at = g->crc = 0;
    g->params = params;
    g->broken = 0;
    if (params) { exh_params_seal(params); }
}

/* The last part of a round may be shorter. Dummy work keeps the cost of all ticks equal. */
static void look_at_area(struct exh_integrity *g)
{
    static const uint8_t nothing[EXH_INTEGRITY_B] = {0};
    const uint32_t left = g->len_B - g->at, n = left < EXH_INTEGRITY_B ? left : EXH_INTEGRITY_B;
    g->crc = exh_crc32(g->crc, g->area + g->at, n);
    (void)exh_crc32(0, nothing, EXH_INTEGRITY_B - n);
    g->at += n;
    if (g->at < g->len_B) { return; }
    if (g->crc != g->want) { g->broken = 1; }
    g->at = g->crc = 0;
}

static void look_at_params(struct exh_integrity *g)
{
    for (unsigned k = 0; k < EXH_INTEGRITY_WORDS; k++) {
        if (exh_params_verify(g->params)) { g->broken = 1; }
    }
}

int exh_integrity_step(struct exh_integrity *g)
{
    if (g->len_B > 0) { look_at_area(g); }
    if (g->params) { look_at_params(g); }
    return g->broken;
}
