/* SPDX-License-Identifier: MIT */
/* The step of a limiter: causes, state, and what is sent. */
#include "exhand/limiter.h"

#include "exhand/fix.h"

#define FULL_Q30 (INT32_C(1) << 30)
/* Of an effort that is squared: twice the heat of the peak, and no sum overflows. */
#define SQUARED_MOST 2896
#define HEAT_SHIFT   16 /* of what is left of it, to 32 bits */

/* What one step knows, for those after it. Zeros where a value is not used or is none. */
struct step {
    int32_t asked;  /* effort or position, micro; never INT32_MIN */
    int32_t pos;    /* measured */
    int32_t vel;    /* likewise */
    int32_t effort; /* likewise, its size */
    uint32_t present;
};

/* |v|, at most INT32_MAX. */
static int32_t size_of(int32_t v) { return v >= 0 ? v : v < -INT32_MAX ? INT32_MAX : -v; }

static int32_t least(int32_t a, int32_t b) { return a < b ? a : b; }

/* 1 if a is farther than `way`, 0 .. 10^9, from b, +-10^9: a distance that wraps is still far. */
static int is_far(int32_t a, int32_t b, int32_t way)
{
    const int32_t d = exh_wrap_diff(a, b);
    return d > way || d < -way;
}

/* 1 where the drive may be on: all states but OFF and FAULT. */
static uint32_t is_on(unsigned state)
{
    return state >= EXH_STATE_ARM && state <= EXH_STATE_RELEASE;
}

/* --- causes --- */

/* Time that does not go on, or by too much in one step. */
static int time_is_bad(struct exh_limiter *s, const struct exh_limiter_cfg *cfg, uint32_t now_us)
{
    const uint32_t gap = s->started ? now_us - s->now_us : 1;
    s->still_steps = gap != 0 ? 0 : s->still_steps + 1;
    s->now_us = now_us;
    s->started = 1;
    return gap > (uint32_t)cfg->par.gap_max_us || s->still_steps >= cfg->still_steps;
}

/* What is measured, as far as it is used. 1 if something is no number. */
static int read(const struct exh_limiter_cfg *cfg, const struct exh_limiter_in *in, struct step *t)
{
    const int32_t uses = cfg->par.uses;
    if (uses & EXH_LIMITER_POS) { t->pos = in->pos; }
    if (uses & EXH_LIMITER_VEL) { t->vel = in->vel; }
    if (uses & EXH_LIMITER_MEASURED) { t->effort = in->effort; }
    if (in->command != EXH_LIMITER_NONE && t->pos != EXH_LIMITER_NONE &&
        t->vel != EXH_LIMITER_NONE && t->effort != EXH_LIMITER_NONE) {
        t->effort = size_of(t->effort);
        return 0;
    }
    t->pos = t->vel = t->effort = 0;
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
static int heat_up(struct exh_limiter *s, const struct exh_limiter_cfg *cfg, int32_t effort)
{
    const int32_t e = least(effort >> (cfg->heat_shift & 31u), SQUARED_MOST);
    const int64_t most = cfg->heat_budget + (cfg->heat_budget >> 2);
    s->heat = exh_wrap_add64(s->heat, e * e - cfg->heat_square);
    if (s->heat < 0) { s->heat = 0; }
    if (s->heat <= most) { return 0; }
    s->heat = most + 1; /* a quarter above, and it is not forgotten */
    return 1;
}

/* All causes present, but for FAR; and what is asked for. */
static void look(struct exh_limiter *s, const struct exh_limiter_cfg *cfg,
    const struct exh_limiter_in *in, struct step *t)
{
    const struct exh_limiter_par *p = &cfg->par;
    const struct exh_motion_cfg m = {&cfg->motion, cfg->speed_steps, cfg->stall_steps};
    const int sent = !(p->uses & EXH_LIMITER_MEASURED);
    uint32_t limits = 0, c = 0, due;
    int32_t vel;
    if (time_is_bad(s, cfg, in->now_us)) { c = EXH_LIMITER_TIME; }
    if (p->uses & EXH_LIMITER_DEADMAN && !in->deadman) { c |= EXH_LIMITER_RELEASED; }
    if (in->age_us > (uint32_t)p->age_max_us) { c |= EXH_LIMITER_STALE; }
    if (sent && p->kind != EXH_LIMITER_POSITION) { t->effort = size_of(s->sent); }
    if (read(cfg, in, t)) {
        c |= EXH_LIMITER_NUMBER;
    } else if (t->pos < cfg->near_min || t->pos > cfg->near_max) {
        c |= EXH_LIMITER_RANGE;
    } else if (is_far(t->pos, s->stood, p->stall_move)) {
        /* A way of more than stall_move is a movement; motion.h counts how long there is none. */
        s->stood = t->pos;
    }
    exh_motion_update(&s->motion, &m, s->stood, t->effort);
    vel = t->vel;
    due = exh_motion_step(&s->motion, &m, &vel, &limits);
    if (due & EXH_FAULT_SPEED) { c |= EXH_LIMITER_SPEED; }
    if (due & EXH_FAULT_STUCK) { c |= EXH_LIMITER_STALL; }
    if (heat_up(s, cfg, t->effort)) { c |= EXH_LIMITER_HEAT; }
    t->present |= c;
    if (c & EXH_LIMITER_NUMBER) { return; }
    t->asked = p->kind == EXH_LIMITER_WALL ? wall(cfg, in->command, t->pos, vel) : in->command;
    /* Once after arming, before anything is let through. */
    if (s->state == EXH_STATE_ARM && s->share_q30 == 0 && p->first == EXH_LIMITER_REFUSE &&
        is_far(t->asked, p->kind == EXH_LIMITER_POSITION ? s->sent : 0, p->first_max)) {
        t->present |= EXH_LIMITER_FAR;
    }
}

/* --- state --- */

/* The first that applies, in the order of enum exh_trigger. */
static unsigned trigger(const struct exh_limiter *s, int position, uint32_t present, int run)
{
    const unsigned state = s->state;
    const uint32_t rests = !is_on(state);
    if (present & EXH_LIMITER_LOGIC) { return EXH_ON_CUT; }
    if (state == EXH_STATE_RELEASE && (position ? s->vel : s->sent) == 0) {
        return s->causes ? EXH_ON_LATCHED : EXH_ON_RELEASED;
    }
    if (present) { return EXH_ON_CAUSE; }
    if (!run) { return EXH_ON_OFF; }
    if (rests && !s->opened) { return EXH_ON_NONE; }
    if (state == EXH_STATE_FAULT) { return EXH_ON_CLEAR; }
    if (state == EXH_STATE_ARM && s->share_q30 >= FULL_Q30) { return EXH_ON_ARMED; }
    if (s->limits && (state == EXH_STATE_RUN || state == EXH_STATE_LIMIT)) {
        return EXH_ON_LIMITED;
    }
    return rests ? EXH_ON_RUN : EXH_ON_NONE;
}

/* Latches causes, and goes on by the table of the box (safety.h). */
static void go_on(struct exh_limiter *s, const struct exh_limiter_cfg *cfg,
    const struct exh_limiter_in *in, uint32_t present)
{
    const uint32_t others = present & ~(uint32_t)EXH_LIMITER_RELEASED;
    const uint32_t hand = cfg->par.uses & EXH_LIMITER_DEADMAN ? in->deadman : in->run;
    const unsigned before = s->state;
    unsigned on;
    if (present && before != EXH_STATE_OFF) {
        if (s->causes == 0) { s->first = present & (~present + 1u); }
        s->causes |= present;
    }
    if (others || !hand) { s->opened = others == 0; }
    on = trigger(s, cfg->par.kind == EXH_LIMITER_POSITION, present, in->run != 0);
    s->state = exh_safety_next[before][on];
    if (on == EXH_ON_CLEAR) { s->causes = 0; }
    if (s->state != EXH_STATE_ARM) {
        s->share_q30 = FULL_Q30;
    } else if (before != EXH_STATE_ARM) {
        s->share_q30 = 0;
        s->opened = 0;
        s->first = 0;
    } else {
        s->share_q30 = least((s->share_q30 & (FULL_Q30 - 1)) + cfg->ramp_q30, FULL_Q30);
    }
}

/* --- efforts --- */

/* From the effort of the last step towards `to`: away from 0 by `up`, towards it by `down`, and
 * through 0 by no more than either. Both within +-effort_max. */
static int32_t slewed(const struct exh_limiter_cfg *cfg, int32_t from, int32_t to)
{
    const int32_t side = (from ? from : to) < 0 ? -1 : 1;
    const int32_t a = size_of(from), back = a - cfg->down;
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
    const int32_t a = size_of(held);
    int32_t rest;
    if (s->fall <= 0) { s->fall = (int32_t)exh_umul_hi((uint32_t)a, cfg->fall_q32) + 2; }
    rest = a > s->fall ? a - s->fall : 0;
    return held < 0 ? -rest : rest;
}

static int32_t effort(struct exh_limiter *s, const struct exh_limiter_cfg *cfg, int32_t asked)
{
    const int32_t top = cfg->par.effort_max, hot = heat_leaves(s, cfg), size = size_of(asked);
    const int32_t held = exh_clamp32(s->sent, -top, top);
    int32_t most = top, want, now;
    uint32_t limits = 0;
    s->limits = EXH_LIMITER_BY_RELEASE;
    if (s->state == EXH_STATE_RELEASE) { return let_go(s, cfg, held); }
    s->fall = 0;
    s->limits = size > 0 ? EXH_LIMITER_BY_STATE : 0u;
    if (!is_on(s->state)) { return 0; }
    if (s->state == EXH_STATE_ARM) { most = exh_mul_hi(top, s->share_q30) * 4; }
    if (size > top) { limits = EXH_LIMITER_BY_EFFORT; }
    if (size > most) { limits |= most < top ? EXH_LIMITER_BY_RAMP : 0u; }
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
    const int32_t side = d < 0 ? -1 : 1;
    const int32_t vmax =
        s->state == EXH_STATE_ARM ? exh_mul_hi(cfg->vel, s->share_q30) * 4 : cfg->vel;
    int32_t v = s->vel * side;
    if (s->state == EXH_STATE_RELEASE) {
        s->limits = EXH_LIMITER_BY_RELEASE;
        v = v > acc ? v - acc : v < -acc ? v + acc : 0;
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
    if (s->state == EXH_STATE_RELEASE || (is_on(s->state) && s->share_q30 > 0)) {
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
    t.asked = t.pos = t.vel = t.effort = 0;
    t.present = 0;
    /* A state that is none, or a latch without a cause: memory was damaged. */
    if (s->state > EXH_STATE_FAULT || (s->state == EXH_STATE_FAULT && !s->causes)) {
        s->state = EXH_STATE_FAULT;
        t.present = EXH_LIMITER_LOGIC;
    }
    look(s, cfg, in, &t);
    go_on(s, cfg, in, t.present);
    s->sent = cfg->par.kind == EXH_LIMITER_POSITION ? position(s, cfg, &t, in->run != 0)
                                                    : effort(s, cfg, t.asked);
    out->send = s->sent;
    out->enable = is_on(s->state) | (s->holds != 0);
    out->state = s->state;
    out->limits = s->limits;
    out->first = s->first;
    out->causes = s->causes;
    out->present = t.present;
}
