#include "exhand/guard.h"

#include "exhand/bytes.h"

void exh_guard_seal(struct exh_guard *g, const void *area, size_t len_B,
                    const struct exh_params *params)
{
    g->area = area;
    g->len_B = (uint32_t)len_B;
    g->want = exh_crc32(0, area, len_B);
    g->at = g->crc = g->word = 0;
    g->params = params;
    g->words = params ? exh_signal_count(params->table) : 0;
    g->broken = 0;
}

/* The last part of a round may be shorter; what it lacks is spent on nothing, so all ticks cost the same. */
static void look_at_area(struct exh_guard *g)
{
    static const uint8_t nothing[EXH_GUARD_B];
    const uint32_t left = g->len_B - g->at, n = left < EXH_GUARD_B ? left : EXH_GUARD_B;
    g->crc = exh_crc32(g->crc, g->area + g->at, n);
    (void)exh_crc32(0, nothing, EXH_GUARD_B - n);
    g->at += n;
    if (g->at < g->len_B) { return; }
    if (g->crc != g->want) { g->broken = 1; }
    g->at = g->crc = 0;
}

/* Two copies that are one but for what is just being staged. */
static void look_at_params(struct exh_guard *g)
{
    for (unsigned k = 0; k < EXH_GUARD_WORDS; k++) {
        const int differ = g->params->active[g->word] != g->params->staged[g->word];
        if (differ && !g->params->pending) { g->broken = 1; }
        g->word = g->word + 1 < g->words ? g->word + 1 : 0;
    }
}

int exh_guard_step(struct exh_guard *g)
{
    if (g->len_B > 0) { look_at_area(g); }
    if (g->words > 0) { look_at_params(g); }
    return g->broken;
}
