/* SPDX-License-Identifier: MIT */
/* Causes of faults of the device, not of a finger: glove, link, supply. */
#include "bilateral.h"

/* Whole ticks in a time plus one; 0: never. All values are in range, so nothing overflows. */
static uint32_t ticks_of(int32_t ms, struct exh_period T)
{
    return ms == 0 ? 0 : exh_ticks_in(ms, T) + 1;
}

int bilateral_cause_setup(struct bilateral_cfg *cfg, struct exh_period T)
{
    cfg->glove_ticks = ticks_of(cfg->par->own.glove_ms, T);
    cfg->link_ticks = ticks_of(cfg->par->own.link_ms, T);
    return exh_supply_setup(&cfg->supply, &cfg->par->supply, T);
}

/* A fault if the glove lacks data of a finger in use for too long: a faulty sensor, no frame, or an
 * old one. When an age reaches its limit of 16 bits, time continues to count. Until the fault,
 * precontact lets go of that finger alone. */
static int glove_lost(struct bilateral *s, const struct bilateral_cfg *cfg, uint32_t missed)
{
    uint32_t oldest = 0;
    int unsure = 0;
    for (unsigned k = 0; k < bilateral_n(cfg); k++) {
        const uint32_t age_ticks = bilateral_finger_age(s, cfg, k);
        if (age_ticks == UINT32_MAX) {
            unsure = 1;
        } else if (age_ticks > oldest) {
            oldest = age_ticks;
        }
    }
    s->unsure_ticks = unsure ? bilateral_later(s->unsure_ticks, missed) : 0;
    if (s->unsure_ticks < oldest) { s->unsure_ticks = oldest; }
    return cfg->glove_ticks != 0 && s->unsure_ticks >= cfg->glove_ticks;
}

uint32_t bilateral_causes(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_scene_in *in)
{
    const int glove = glove_lost(s, cfg, in->missed);
    const int supply = exh_supply_step(&s->supply, &cfg->supply, in->drive.supply_raw, in->missed);
    /* Contacts are local and frozen before they are felt, so a required link is an option. */
    const int link = cfg->link_ticks != 0 && s->wire.age_ticks >= cfg->link_ticks;
    return (s->broken ? EXH_FAULT_CONFIG : 0u) | (glove ? EXH_FAULT_GLOVE : 0u) |
           (supply ? EXH_FAULT_SUPPLY : 0u) | (link ? EXH_FAULT_LINK : 0u);
}
