/* SPDX-License-Identifier: MIT */
/* The step of a limiter: causes, state, and what is sent. */
#include "exhand/limiter.h"

#include "exhand/fix.h"

#include "limiter_parts.h"

/* Of an effort that is squared: twice the heat of the peak, and no sum overflows. */
#define SQUARED_MOST 2896
#define HEAT_SHIFT   16 /* of what is left of it, to 32 bits */

/* What one step knows, for those after it. Zeros where a value is not used or is none. */
struct step {
    int32_t asked;   /* effort or position, micro; never INT32_MIN */
    int32_t pos;     /* measured */
    int32_t vel;     /* measured */
    uint32_t effort; /* measured, its size */
    uint32_t present;
};

/* |v|. */
static uint32_t size_of(int32_t v) { return v < 0 ? (uint32_t)(-(v + 1)) + 1u : (uint32_t)v; }

static int32_t least(int32_t a, int32_t b) { return a < b ? a : b; }

/* 1 if a is farther than `way`, 0 .. 10^9, from b, +-10^9: a distance that wraps is still far. */
static int is_far(int32_t a, int32_t b, int32_t way)
{
    const int32_t d = exh_wrap_diff(a, b);
    return d > way || d < -way;
}

/* --- causes --- */

/* Time that does not go on, or by too much in one step. */
static int time_is_bad(struct exh_limiter *s, const struct exh_limiter_cfg *cfg, uint32_t now_us)
{
    uint32_t gap;
    if (!s->started) { s->now_us = now_us - 1u; }
    gap = now_us - s->now_us;
    s->still_steps = gap != 0 ? 0 : s->still_steps + 1;
    s->now_us = now_us;
    s->started = 1;
    return (gap > (uint32_t)cfg->par.gap_max_us) | (s->still_steps >= cfg->still_steps);
}

/* What is measured, as far as it is used. 1 if something is no number. */
static int read(const struct exh_limiter_cfg *cfg, const struct exh_limiter_in *in, struct step *t)
{
    const int32_t uses = cfg->par.uses;
    if (uses & EXH_LIMITER_POS) { t->pos = in->pos; }
    if (uses & EXH_LIMITER_VEL) { t->vel = in->vel; }
    if (uses & EXH_LIMITER_MEASURED) { t->effort = size_of(in->effort); }
    if (in->command != EXH_LIMITER_NONE && t->pos != EXH_LIMITER_NONE &&
        t->vel != EXH_LIMITER_NONE && t->effort <= INT32_MAX) {
        t->asked = in->command;
        return 0;
    }
    t->pos = t->vel = 0;
    t->effort = 0;
    return 1;
}

/* A value in the law's scale; it wraps only where there is a cause that stops it from being used.
 */
static int32_t in_law(int32_t v, int32_t scale)
{
    return exh_from_u32((uint32_t)v * (uint32_t)scale);
}

/* The force of the wall, as an effort. A wall beyond what positions may be is where they end. */
static int32_t wall(const struct exh_limiter_cfg *cfg, int32_t at, int32_t pos, int32_t vel)
{
    struct exh_contact_in in;
    int32_t f;
    in.pos_m_q30 = in_law(pos, cfg->pos_scale);
    in.lim_m_q30 = in_law(exh_clamp32(at, cfg->near_min, cfg->near_max), cfg->pos_scale);
    in.vel_mps_q27 = in_law(vel, cfg->vel_scale);
    f = exh_contact_force(&cfg->wall, in);
    return cfg->par.wall_below ? f : -f;
}

/* The heat of the last step: squares above the nominal one. 1 if there is too much of it. */
static int heat_up(struct exh_limiter *s, const struct exh_limiter_cfg *cfg, uint32_t effort)
{
    const uint32_t seen = effort >> (cfg->heat_shift & 31u);
    const int32_t e = (int32_t)(seen < SQUARED_MOST ? seen : SQUARED_MOST);
    const int64_t most = cfg->heat_budget + (cfg->heat_budget >> 2);
    int64_t sum = exh_wrap_add64(s->heat, e * e - cfg->heat_square);
    int over = 0;
    if (sum < 0) { sum = 0; }
    if (sum > most) {
        sum = most + 1; /* a quarter above, and it is not forgotten */
        over = 1;
    }
    s->heat = sum;
    return over;
}

/* Finds all causes present except FAR, and the command. */
static void look(struct exh_limiter *s, const struct exh_limiter_cfg *cfg,
    const struct exh_limiter_in *in, struct step *t)
{
    const struct exh_limiter_par *p = &cfg->par;
    const struct exh_motion_cfg m = {&cfg->motion, cfg->speed_steps, cfg->stall_steps};
    uint32_t limits = 0, c = 0, due;
    int32_t vel;
    if (time_is_bad(s, cfg, in->now_us)) { c = EXH_LIMITER_TIME; }
    if (!in->deadman && p->uses & EXH_LIMITER_DEADMAN) { c |= EXH_LIMITER_RELEASED; }
    if (in->age_us > (uint32_t)p->age_max_us) { c |= EXH_LIMITER_STALE; }
    if (p->kind != EXH_LIMITER_POSITION) { t->effort = size_of(s->sent); }
    if (read(cfg, in, t)) {
        c |= EXH_LIMITER_NUMBER;
    } else if (t->pos < cfg->near_min || t->pos > cfg->near_max) {
        c |= EXH_LIMITER_RANGE;
    } else if (is_far(t->pos, s->stood, p->stall_move)) {
        /* A way of more than stall_move is a movement; motion.h counts how long there is none. */
        s->stood = t->pos;
    }
    exh_motion_update(&s->motion, &m, s->stood, exh_from_u32(t->effort));
    vel = t->vel;
    due = exh_motion_step(&s->motion, &m, &vel, &limits);
    if (due) {
        if (due & EXH_FAULT_SPEED) { c |= EXH_LIMITER_SPEED; }
        if (due & EXH_FAULT_STUCK) { c |= EXH_LIMITER_STALL; }
    }
    if (heat_up(s, cfg, t->effort)) { c |= EXH_LIMITER_HEAT; }
    t->present |= c;
    if (c & EXH_LIMITER_NUMBER) { return; }
    if (p->kind == EXH_LIMITER_WALL) { t->asked = wall(cfg, t->asked, t->pos, vel); }
    /* Once after arming, before anything is let through. */
    if (s->state == EXH_STATE_ARM && s->share_q30 == 0 && p->first == EXH_LIMITER_REFUSE &&
        is_far(t->asked, p->kind == EXH_LIMITER_POSITION ? s->sent : 0, p->first_max)) {
        t->present |= EXH_LIMITER_FAR;
    }
}

/* --- efforts --- */

/* From the effort of the last step towards `to`: away from 0 by `up`, towards it by `down`, and
 * through 0 by no more than either. Both within +-effort_max. */
static int32_t slewed(const struct exh_limiter_cfg *cfg, int32_t from, int32_t to)
{
    const int32_t side = 1 - 2 * ((from ? from : to) < 0);
    const int32_t a = from * side, back = exh_wrap_add(a, -cfg->down);
    const uint32_t far = (uint32_t)a + (uint32_t)cfg->up, top = (uint32_t)cfg->par.effort_max;
    const int32_t hi = (int32_t)(far < top ? far : top);
    const int32_t lo = back < -cfg->up ? -cfg->up : back;
    return exh_clamp32(to * side, lo, hi) * side;
}

/* What heat leaves: the peak, and near the end of the budget a share of it, down to nominal. */
static int32_t heat_leaves(const struct exh_limiter *s, const struct exh_limiter_cfg *cfg)
{
    const uint32_t knee = cfg->heat_knee & 31u;
    const int64_t left = cfg->heat_budget - s->heat;
    const uint32_t part = left < 0 ? 0 : (uint32_t)(left >> HEAT_SHIFT);
    const uint32_t span = (uint32_t)cfg->heat_top - (uint32_t)cfg->heat_bottom;
    if (part >> knee) { return cfg->heat_top; }
    return exh_from_u32((uint32_t)cfg->heat_bottom + exh_umul_hi(span * 2, part << (31u - knee)));
}

/* What is held goes in equal steps. */
static int32_t let_go(struct exh_limiter *s, const struct exh_limiter_cfg *cfg, int32_t held)
{
    const int32_t a = (int32_t)size_of(held);
    int32_t rest;
    if (s->fall <= 0) { s->fall = (int32_t)exh_umul_hi((uint32_t)a, cfg->fall_q32) + 2; }
    rest = a > s->fall ? a - s->fall : 0;
    return held < 0 ? -rest : rest;
}

/* What arming allows of a limit. */
static int32_t share_of(const struct exh_limiter *s, int32_t most)
{
    return (int32_t)((int64_t)most * s->share_q30 >> 30);
}

static int32_t effort(struct exh_limiter *s, const struct exh_limiter_cfg *cfg, int32_t asked)
{
    const int32_t top = cfg->par.effort_max, hot = heat_leaves(s, cfg);
    const int32_t size = asked < 0 ? -asked : asked;
    const int32_t held = exh_clamp32(s->sent, -top, top);
    int32_t most = share_of(s, top), want, now;
    uint32_t limits = 0;
    if (s->state == EXH_STATE_RELEASE) {
        s->limits = EXH_LIMITER_BY_RELEASE;
        return let_go(s, cfg, held);
    }
    s->fall = 0;
    if (!exh_limiter_is_on(s->state)) {
        s->limits = asked ? EXH_LIMITER_BY_STATE : 0u;
        return 0;
    }
    if (size > top) { limits = EXH_LIMITER_BY_EFFORT; }
    if (size > most && most < top) { limits |= EXH_LIMITER_BY_RAMP; }
    if (size > hot) { limits |= EXH_LIMITER_BY_HEAT; }
    most = exh_clamp32(hot, 0, most);
    want = exh_clamp32(asked, -most, most);
    now = slewed(cfg, held, want);
    if (now != want) { limits |= EXH_LIMITER_BY_RISE; }
    s->limits = limits;
    return now;
}

/* --- positions --- */

/* 1 if v >= 0 a step, towards a place whose distance times 8 acc is `room`, can be braked away by
 * there. It asks for (2v + a)^2 / 8a, at most a/8 more than the steps v + (v - a) + ... are. */
static int fits(int32_t v, int32_t acc, uint64_t room)
{
    const uint32_t twice = (uint32_t)(2 * v + acc);
    return (uint64_t)twice * twice <= room;
}

/* Velocity of this step, towards a place d >= 0 away: the fastest of three that can be braked. */
static int32_t towards(struct exh_limiter *s, int32_t v, int32_t d, int32_t vmax, int32_t acc)
{
    const uint64_t room = (uint64_t)(uint32_t)d * (uint32_t)acc * 8;
    const int32_t hi = least(v + acc, vmax), lo = v > acc ? v - acc : 0, mid = (hi + lo) / 2;
    if (d <= hi && d <= acc && d >= v - acc) { return d; }
    s->limits |= hi == vmax ? EXH_LIMITER_BY_VEL : EXH_LIMITER_BY_ACC;
    if (hi <= 0 || fits(hi, acc, room)) { return hi; }
    s->limits |= EXH_LIMITER_BY_ACC;
    return fits(mid, acc, room) ? mid : lo;
}

/* Moves by this step's velocity. */
static void move(struct exh_limiter *s, const struct exh_limiter_cfg *cfg, int32_t asked)
{
    const unsigned frac = cfg->frac & 15u;
    const int32_t mask = (INT32_C(1) << frac) - 1, part = s->part & mask, acc = cfg->acc;
    const int32_t to = exh_clamp32(asked, cfg->par.pos_min, cfg->par.pos_max);
    const int32_t way = exh_clamp32(exh_wrap_diff(to, s->sent), -cfg->brake, cfg->brake);
    const int32_t d = way * (INT32_C(1) << frac) - part;
    const int32_t side = d >> 31 | 1;
    const int32_t vmax = share_of(s, cfg->vel);
    int32_t v = s->vel * side;
    if (s->state == EXH_STATE_RELEASE) {
        s->limits = EXH_LIMITER_BY_RELEASE;
        v -= exh_clamp32(v, -acc, acc);
    } else {
        s->limits = to != asked ? EXH_LIMITER_BY_RANGE : 0u;
        v = towards(s, v, d * side, vmax, acc);
    }
    s->vel = v * side;
    v = part + s->vel;
    s->sent = exh_wrap_add(s->sent, v >> frac);
    s->part = v & mask;
}

/* At rest it follows what is measured, unless FAULT holds it. */
static int32_t position(
    struct exh_limiter *s, const struct exh_limiter_cfg *cfg, const struct step *t, int run)
{
    s->vel = exh_clamp32(s->vel, -cfg->vel, cfg->vel);
    /* Arming has begun, or it is full: it is full in all states but ARM. */
    if (exh_limiter_is_on(s->state) && s->share_q30 > 0) {
        s->holds = 0;
        move(s, cfg, t->asked);
    } else {
        s->limits = EXH_LIMITER_BY_STATE;
        s->vel = 0;
        if (s->state == EXH_STATE_FAULT) {
            s->holds = cfg->par.after == EXH_LIMITER_HOLD;
        } else if (!run) {
            s->holds = 0;
        }
        if (!s->holds && !(t->present & EXH_LIMITER_NUMBER)) {
            s->sent = t->pos;
            s->part = 0;
        }
    }
    return exh_clamp32(s->sent, cfg->near_min, cfg->near_max);
}

/* --- the step --- */

void exh_limiter_step(struct exh_limiter *s, const struct exh_limiter_cfg *cfg,
    const struct exh_limiter_in *in, struct exh_limiter_out *out)
{
    struct step t;
    t.asked = t.pos = t.vel = 0;
    t.effort = t.present = 0;
    /* A state that is none, or a latch without a cause: memory was damaged. */
    if (s->state > EXH_STATE_FAULT || (s->state == EXH_STATE_FAULT && !s->causes)) {
        s->state = EXH_STATE_FAULT;
        t.present = EXH_LIMITER_LOGIC;
    }
    look(s, cfg, in, &t);
    exh_limiter_go_on(s, cfg, in, t.present);
    s->sent = cfg->par.kind == EXH_LIMITER_POSITION ? position(s, cfg, &t, in->run != 0)
                                                    : effort(s, cfg, t.asked);
    out->send = s->sent;
    out->state = s->state;
    out->enable = exh_limiter_is_on(s->state);
    if (s->holds) { out->enable = 1; }
    out->limits = s->limits;
    out->first = s->first;
    out->causes = s->causes;
    out->present = t.present;
}
