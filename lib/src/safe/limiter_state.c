/* SPDX-License-Identifier: MIT */
/* The state of a limiter. A separate file: in limiter.c, a compiler copies it once for each way
 * through the step, and a small CPU pays for each copy. */
#include "limiter_parts.h"

/* What leads on from a state, where nothing speaks against it. */
static const uint8_t leads_on[EXH_STATES] = {
    EXH_ON_RUN, EXH_ON_ARMED, EXH_ON_LIMITED, EXH_ON_LIMITED, EXH_ON_NONE, EXH_ON_CLEAR};

/* The first that applies, in the order of enum exh_trigger. */
static unsigned trigger(const struct exh_limiter *s, int position, uint32_t present, int run)
{
    const unsigned state = s->state;
    uint32_t ready = exh_limiter_is_on(state) ? s->limits : s->opened;
    if (state == EXH_STATE_ARM) { ready = s->share_q30 >= EXH_LIMITER_FULL_Q30; }
    if (state == EXH_STATE_RELEASE && (position ? s->vel : s->sent) == 0) {
        return s->causes ? EXH_ON_LATCHED : EXH_ON_RELEASED;
    }
    /* LOGIC comes with FAULT. */
    if (present) { return present & EXH_LIMITER_LOGIC ? EXH_ON_CUT : EXH_ON_CAUSE; }
    if (!run) { return EXH_ON_OFF; }
    return ready ? leads_on[state] : EXH_ON_NONE;
}

/* Latches causes, and goes on by the table of the box (safety.h). */
void exh_limiter_go_on(struct exh_limiter *s, const struct exh_limiter_cfg *cfg,
    const struct exh_limiter_in *in, uint32_t present)
{
    const uint32_t others = present & ~(uint32_t)EXH_LIMITER_RELEASED;
    const uint32_t hand = cfg->par.uses & EXH_LIMITER_DEADMAN ? in->deadman : in->run;
    const unsigned before = s->state;
    int32_t share = EXH_LIMITER_FULL_Q30; /* in all states but ARM */
    if (present && before != EXH_STATE_OFF) {
        if (s->causes == 0) { s->first = present & (~present + 1u); }
        s->causes |= present;
    }
    if (others || !hand) { s->opened = others == 0; }
    s->state = exh_safety_next[before][trigger(
        s, cfg->par.kind == EXH_LIMITER_POSITION, present, in->run != 0)];
    if (s->state == EXH_STATE_OFF) { s->causes = 0; } /* it left FAULT, or there are none */
    if (s->state == EXH_STATE_ARM) {
        share = (s->share_q30 & (EXH_LIMITER_FULL_Q30 - 1)) + cfg->ramp_q30;
    }
    if (share > EXH_LIMITER_FULL_Q30) { share = EXH_LIMITER_FULL_Q30; }
    if (s->state == EXH_STATE_ARM && before != EXH_STATE_ARM) {
        share = 0;
        s->opened = 0;
        s->first = 0;
    }
    s->share_q30 = share;
}
