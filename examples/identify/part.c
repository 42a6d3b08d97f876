/* SPDX-License-Identifier: MIT */
/* The parts of a run: the current of each, and its end. */
#include "identify.h"

/* Currents. */
enum {
    NONE,    /* no current */
    RISE,    /* rises from the present current by the ramp */
    SINK,    /* falls by the ramp */
    PULSE,   /* above the current that moves the rotor */
    UP,      /* above the current that lifts the mass */
    DOWN,    /* below the current that lets it sink */
    HANG,    /* between the two */
    BRAKE,   /* half of HANG, to stop a rising mass */
    SQUARE,  /* HANG plus or minus enough to move it */
    RELEASE, /* a small part of the current that lets it sink */
    CATCH    /* far above the current that lifts it */
};

/* Ends. */
enum {
    TIME,
    INWARD,  /* distance in from the start of the part */
    OUTWARD, /* distance out from the innermost point of the part */
    ABOVE,   /* height above the start of the stage */
    TURN,    /* distance in again from the outermost point of the part */
    STILL    /* the count does not change */
};

/* Result at the end, from the present current. */
enum { NOTHING, FREE, LIFTS, SINKS, PULSED };

struct part {
    const char *name;
    uint8_t stage, current, end, far, learns;
    uint8_t must; /* 1: a timeout is a failure */
    uint16_t ms;
};

#define M IDENTIFY_MASS
static const struct part part[] = {
    {"free", IDENTIFY_SLACK, RISE, INWARD, IDENTIFY_MM1, FREE, 1, 20000},
    {"runs out", IDENTIFY_SLACK, NONE, STILL, 0, NOTHING, 0, 1000},
    {"pulse", IDENTIFY_SLACK, PULSE, INWARD, IDENTIFY_MM2, PULSED, 0, 80},
    {"lift", M, RISE, INWARD, IDENTIFY_MM15, LIFTS, 1, 20000},
    {"stop", M, BRAKE, OUTWARD, IDENTIFY_MM1, NOTHING, 0, 300},
    {"lower", M, SINK, OUTWARD, IDENTIFY_MM6, SINKS, 1, 20000},
    {"caught", M, CATCH, TURN, IDENTIFY_MM1, NOTHING, 1, 1000},
    {"middle", M, UP, ABOVE, IDENTIFY_MID, NOTHING, 1, 5000},
    {"stop", M, BRAKE, OUTWARD, IDENTIFY_MM1, NOTHING, 0, 300},
    {"rest", M, HANG, TIME, 0, NOTHING, 0, 0},
    {"pull up", M, RISE, INWARD, IDENTIFY_MM6, LIFTS, 1, 10000},
    {"stop", M, BRAKE, OUTWARD, IDENTIFY_MM1, NOTHING, 0, 300},
    {"pull down", M, SINK, OUTWARD, IDENTIFY_MM6, SINKS, 1, 10000},
    {"step up", M, UP, INWARD, IDENTIFY_MM6, NOTHING, 1, 2000},
    {"step down", M, DOWN, OUTWARD, IDENTIFY_MM6, NOTHING, 1, 2000},
    {"step up", M, UP, INWARD, IDENTIFY_MM6, NOTHING, 1, 2000},
    {"step down", M, DOWN, OUTWARD, IDENTIFY_MM6, NOTHING, 1, 2000},
    {"square wave", M, SQUARE, TIME, 0, NOTHING, 0, 1200},
    {"raise", M, UP, ABOVE, IDENTIFY_HIGH, NOTHING, 1, 5000},
    {"release", M, RELEASE, OUTWARD, IDENTIFY_MM12, NOTHING, 0, 500},
    {"catch", M, CATCH, TURN, IDENTIFY_MM1, NOTHING, 1, 1000},
};
#undef M
#define PARTS  (sizeof part / sizeof part[0])
#define RUNOUT 1 /* the slack stage repeats from here, */
#define FIRST  3 /* the mass stage starts here */

const char *identify_part_text(unsigned p) { return p < PARTS ? part[p].name : 0; }
unsigned identify_part_stage(unsigned p) { return p < PARTS ? part[p].stage : IDENTIFY_STAGES; }

/* --- currents --- */

static int32_t hang_A_q26(const struct identify_run *r)
{
    return r->up_A_q26 / 2 + r->down_A_q26 / 2;
}

static int32_t half_A_q26(const struct identify_run *r)
{
    return r->up_A_q26 / 2 - r->down_A_q26 / 2;
}

/* A hanging mass limits the ramp to half its current per second. */
static int32_t ramp_A_q26(const struct identify_run *r, const struct identify_cfg *cfg)
{
    const int32_t slow = (int32_t)exh_mul_shr(r->up_A_q26, cfg->half_per_s_q31, 31);
    return r->up_A_q26 == 0 || cfg->ramp_A_q26 < slow ? cfg->ramp_A_q26 : slow > 0 ? slow : 1;
}

/* Near an end of the travel, biases the current away from it. */
static int32_t lean_A_q26(
    const struct identify_run *r, const struct identify_cfg *cfg, int32_t in_cnt)
{
    const int32_t hang = hang_A_q26(r);
    return in_cnt < cfg->far_cnt[IDENTIFY_LOW]    ? hang / 6
           : in_cnt > cfg->far_cnt[IDENTIFY_HIGH] ? -(hang / 6)
                                                  : 0;
}

/* Switches, with a shrinking half period. */
static int32_t square_A_q26(struct identify_run *r, const struct identify_cfg *cfg, int32_t in_cnt)
{
    const int32_t hang = hang_A_q26(r), amp = half_A_q26(r) + hang / 3;
    if (r->flip == 0) {
        r->sign = !r->sign;
        r->half -= r->half / 12;
        r->flip = r->half;
    }
    r->flip -= r->flip > 0;
    return hang + lean_A_q26(r, cfg, in_cnt) + (r->sign ? amp : -amp);
}

static int32_t current_A_q26(
    struct identify_run *r, const struct identify_cfg *cfg, unsigned kind, int32_t in_cnt)
{
    const int32_t hang = hang_A_q26(r);
    switch (kind) {
    case RISE: return r->cur_A_q26 + ramp_A_q26(r, cfg);
    case SINK: return r->cur_A_q26 - ramp_A_q26(r, cfg);
    case PULSE: return r->free_A_q26 + r->pulse_A_q26;
    case UP: return r->up_A_q26 + hang / 4;
    case DOWN: return r->down_A_q26 - hang / 4;
    case HANG: return hang + lean_A_q26(r, cfg, in_cnt);
    case BRAKE: return hang / 2;
    case SQUARE: return square_A_q26(r, cfg, in_cnt);
    case RELEASE: return r->down_A_q26 / 4;
    case CATCH: return r->up_A_q26 + hang / 2;
    default: return 0;
    }
}

/* --- ends --- */

static int ended(
    const struct identify_run *r, const struct identify_cfg *cfg, const struct part *p, int32_t cnt)
{
    const int32_t far = cfg->far_cnt[p->far];
    switch (p->end) {
    case INWARD: return exh_wrap_diff(r->part_cnt, cnt) >= far;
    case OUTWARD: return exh_wrap_diff(cnt, r->high_cnt) >= far;
    case ABOVE: return exh_wrap_diff(r->start_cnt, cnt) >= far;
    case TURN: return exh_wrap_diff(r->low_cnt, cnt) >= far;
    case STILL: return r->still >= cfg->still_ticks;
    default: return 0;
    }
}

static uint32_t ticks_of(
    const struct identify_run *r, const struct identify_cfg *cfg, const struct part *p)
{
    return p->ms ? exh_ticks_in(p->ms, cfg->T) : r->long_ticks;
}

/* After a short pulse the next one is smaller, after a long one larger. */
static void learn(struct identify_run *r, const struct identify_cfg *cfg, const struct part *p)
{
    const int32_t most = cfg->par->own.i_max_A_q26;
    if (p->learns == FREE) { r->free_A_q26 = r->cur_A_q26; }
    if (p->learns == LIFTS) { r->up_A_q26 = r->cur_A_q26; }
    if (p->learns == LIFTS && r->down_A_q26 == 0) { r->down_A_q26 = r->cur_A_q26 / 2; }
    if (p->learns == SINKS) { r->down_A_q26 = r->cur_A_q26; }
    if (p->learns != PULSED) { return; }
    if (r->tick < cfg->short_ticks) { r->pulse_A_q26 -= r->pulse_A_q26 / 3; }
    if (r->tick > cfg->long_ticks) { r->pulse_A_q26 += r->pulse_A_q26 / 2; }
    r->pulse_A_q26 =
        exh_clamp(r->pulse_A_q26, 1, most - r->free_A_q26 > 1 ? most - r->free_A_q26 : 1);
}

static void begin_part(struct identify_run *r, const struct identify_cfg *cfg, int32_t cnt)
{
    r->tick = r->still = 0;
    r->part_cnt = r->low_cnt = r->high_cnt = r->seen_cnt = cnt;
    r->half = cfg->half_ticks;
    r->flip = 0;
    r->chance = r->chance * 1664525u + 1013904223u;
    r->long_ticks =
        (cfg->half_ticks + (uint32_t)((uint64_t)r->chance * (2 * cfg->half_ticks) >> 32)) / 2;
}

/* Starts the next part. DONE after the last of the stage, or the reason for the end. */
static uint8_t next(struct identify_run *r, const struct identify_cfg *cfg, int32_t cnt)
{
    const struct identify_own_par *own = &cfg->par->own;
    const int32_t in_cnt =
        exh_wrap_diff(r->start_cnt, cnt) > 0 ? exh_wrap_diff(r->start_cnt, cnt) : 0;
    learn(r, cfg, &part[r->part]);
    if (part[r->part].learns == LIFTS && r->up_A_q26 < 2 * r->free_A_q26) {
        return IDENTIFY_NO_MASS;
    }
    if (r->stage == IDENTIFY_SLACK && r->part == RUNOUT &&
        (r->repeat >= own->repeats || in_cnt > cfg->slack_cnt)) {
        return EXH_PROBE_DONE;
    }
    r->part++;
    if (r->stage == IDENTIFY_SLACK && r->part == FIRST) {
        r->part = RUNOUT;
        r->repeat++;
    }
    if (r->part == PARTS) {
        r->part = IDENTIFY_PART_ROUND;
        r->repeat++;
        if (r->repeat >= own->repeats) { return EXH_PROBE_DONE; }
    }
    begin_part(r, cfg, cnt);
    return EXH_PROBE_BUSY;
}

/* --- doubt --- */

static uint8_t doubt(struct identify_run *r, const struct identify_cfg *cfg, int32_t cnt)
{
    const int32_t in_cnt = exh_wrap_diff(r->start_cnt, cnt);
    const int32_t moved = exh_wrap_diff(cnt, r->fast_cnt);
    if (in_cnt > cfg->travel_cnt || in_cnt < -(cfg->travel_cnt / 10)) { return EXH_PROBE_TRAVEL; }
    if (++r->fast < cfg->fast_ticks) { return EXH_PROBE_BUSY; }
    r->fast = 0;
    r->fast_cnt = cnt;
    return moved > cfg->fast_cnt || moved < -cfg->fast_cnt ? IDENTIFY_SPEED : EXH_PROBE_BUSY;
}

void identify_begin(struct identify_run *r, const struct identify_cfg *cfg, int32_t cnt)
{
    r->start_cnt = r->fast_cnt = cnt;
    r->fast = 0;
    r->repeat = 0;
    r->cur_A_q26 = 0;
    r->part = r->stage == IDENTIFY_SLACK ? 0 : FIRST;
    if (r->stage == IDENTIFY_SLACK) { r->pulse_A_q26 = cfg->par->own.pulse_A_q26; }
    begin_part(r, cfg, cnt);
}

uint8_t identify_step(struct identify_run *r, const struct identify_cfg *cfg, int32_t cnt)
{
    const struct part *p = &part[r->part];
    const int32_t most = cfg->par->own.i_max_A_q26;
    uint8_t result = doubt(r, cfg, cnt);
    if (result != EXH_PROBE_BUSY) { return result; }
    if (exh_wrap_diff(cnt, r->low_cnt) > 0) { r->low_cnt = cnt; }
    if (exh_wrap_diff(cnt, r->high_cnt) < 0) { r->high_cnt = cnt; }
    r->still = cnt == r->seen_cnt ? r->still + 1 : 0;
    r->seen_cnt = cnt;
    if (p->current == SINK && r->cur_A_q26 == 0 && r->still >= cfg->still_ticks) {
        return IDENTIFY_NO_MASS; /* nothing pulls it out */
    }
    if (ended(r, cfg, p, cnt)) {
        result = next(r, cfg, cnt);
    } else if (r->tick++ >= ticks_of(r, cfg, p)) {
        result = p->must ? EXH_PROBE_STILL : next(r, cfg, cnt);
    }
    if (result != EXH_PROBE_BUSY) { return result; }
    r->cur_A_q26 = exh_clamp(
        current_A_q26(r, cfg, part[r->part].current, exh_wrap_diff(r->start_cnt, cnt)), 0, most);
    return EXH_PROBE_BUSY;
}
