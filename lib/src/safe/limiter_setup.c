/* SPDX-License-Identifier: MIT */
/* Set-up of a limiter: ranges of its fields, then what a step needs, in its own scales. */
#include "exhand/limiter.h"

#include "exhand/fix.h"

#include <stddef.h>

/* Half of what the law's formats hold: positions within it. */
#define LAW_MOST (INT32_C(1) << 30)
/* Fraction bits of a position sent, at most; its speed a step, so that the square of four times it
 * has room; and the way to brake. */
#define FRAC_MAX 12
#define VEL_MOST (INT32_C(1) << 29)
#define WAY_MOST (UINT32_C(1) << 30)
/* An effort is squared in so many bits: with 2^24 steps of heat_ms that is below HEAT_MOST. The
 * least difference of squares: a quarter of the budget is then some units of 2^HEAT_SHIFT. */
#define SQUARE_BITS   11
#define SQUARES_LEAST (UINT32_C(1) << 14)
#define HEAT_MOST     (INT64_C(1) << (31 + HEAT_SHIFT))
#define HEAT_STEPS    64
#define HEAT_SHIFT    16

/* --- ranges --- */

#define EFFORT_ (1u << EXH_LIMITER_EFFORT)
#define PLACE_  (1u << EXH_LIMITER_POSITION)
#define WALL_   (1u << EXH_LIMITER_WALL)
#define FORCE_  (EFFORT_ | WALL_)
#define ALL_    (FORCE_ | PLACE_)
#define EITHER  0x08u /* of either sign */
#define USES    4     /* what must be measured if it is not 0, from this bit on */
#define POS_    ((unsigned)EXH_LIMITER_POS << USES)
#define VEL_    ((unsigned)EXH_LIMITER_VEL << USES)
#define MS_     0x40u /* a time in ms: in steps too */
#define SLEW_   0x80u /* a change a second: a step too */

/* Its largest value, 0xmn for m * 10^n; the kinds for which it must not be 0, and the bits above.
 */
static const struct range {
    uint8_t most, is;
} ranges[EXH_LIMITER_FIELDS] = {
    {0x20, 0}, {0xF0, 0}, {0x27, ALL_},                             /* kind uses rate */
    {0x29, FORCE_}, {0x29, FORCE_ | SLEW_}, {0x29, FORCE_ | SLEW_}, /* effort */
    {0x14, ALL_ | MS_}, {0x13, FORCE_ | MS_},                       /* ramp release */
    {0x58, EITHER}, {0x58, EITHER}, {0x58, 0},                      /* pos */
    {0x19, PLACE_}, {0x29, PLACE_},                                 /* vel acc */
    {0x19, 0}, {0x10, 0}, {0x10, 0},                                /* first after */
    {0x17, ALL_}, {0x17, ALL_},                                     /* age gap */
    {0x29, WALL_ | VEL_}, {0x13, MS_},                              /* speed */
    {0x29, POS_}, {0x19, 0}, {0x64, MS_},                           /* stall */
    {0x29, 0}, {0x29, 0}, {0x65, MS_},                              /* heat */
    {0x10, 0}, {0x19, 0}, {0x19, 0}, {0x18, 0},                     /* wall */
};
EXH_STATIC_ASSERT(
    fields_are_counted, sizeof(struct exh_limiter_par) == EXH_LIMITER_FIELDS * sizeof(int32_t));

#define PLACE_OF(name) (offsetof(struct exh_limiter_par, name) / sizeof(int32_t))
#define FIELD(name)    (-(int)(1 + PLACE_OF(name)))
/* The first that does not hold names the field. */
#define NEED(cond, name) \
    do { \
        if (!(cond)) { return FIELD(name); } \
    } while (0)

/* floor(v * scale / by), at most 2^31 - 1. `by` is not 0. */
static int32_t scaled(int32_t v, uint32_t scale, uint32_t by)
{
    const uint64_t q = exh_udiv64((uint64_t)(uint32_t)v * scale, by, NULL);
    return q > INT32_MAX ? INT32_MAX : (int32_t)q;
}

/* Copies, too: word by word, since a small CPU may have no memcpy. steps[k]: what field k is by
 * steps, where its range says so; a slew is 1 at least. */
static int copy_checked(struct exh_limiter_cfg *cfg, const struct exh_limiter_par *par,
    int32_t steps[EXH_LIMITER_FIELDS])
{
    for (size_t k = 0; k < EXH_LIMITER_FIELDS; k++) {
        const int32_t v = *(const int32_t *)(const void *)((const char *)par + k * sizeof v);
        const unsigned is = ranges[k].is;
        const uint32_t rate = (uint32_t)cfg->par.rate_milli;
        int32_t hi = ranges[k].most >> 4, lo;
        for (int n = ranges[k].most & 15; n > 0; n--) { hi *= 10; }
        *(int32_t *)(void *)((char *)&cfg->par + k * sizeof v) = v;
        /* The kind is right by then; its own needs are none. */
        lo = is & EITHER ? -hi : (int32_t)(is >> (cfg->par.kind & 3) & 1);
        if (!exh_inside(v, lo, hi) || (v != 0 && is >> USES & ~(unsigned)cfg->par.uses & 3u)) {
            return -1 - (int)k;
        }
        if (is & MS_) { steps[k] = scaled(v, rate, 1000000); }
        if (is & SLEW_) { steps[k] = scaled(v, 1000000, rate); }
        if (is & SLEW_ && steps[k] == 0) { steps[k] = 1; }
    }
    return 0;
}

/* What must go with what. */
static int check_relations(struct exh_limiter_cfg *cfg)
{
    const struct exh_limiter_par *par = &cfg->par;
    const int place = par->kind == EXH_LIMITER_POSITION;
    /* What a position sent does to the motor is known only where it is measured. */
    const int32_t needs =
        (par->kind == EXH_LIMITER_EFFORT ? 0 : EXH_LIMITER_POS) |
        (place && (par->stall_effort | par->heat_peak) ? EXH_LIMITER_MEASURED : 0);
    NEED(!(needs & ~par->uses), uses);
    NEED(par->stall_effort == 0 || par->stall_ms > 0, stall_ms);
    cfg->near_min = cfg->near_max = 0; /* where it is not measured it is 0 */
    if (par->uses & EXH_LIMITER_POS) {
        NEED(par->pos_min < par->pos_max, pos_max);
        cfg->near_min = par->pos_min - par->pos_over;
        cfg->near_max = par->pos_max + par->pos_over;
    }
    return 0;
}

/* --- what a step needs --- */

/* Velocity and acceleration a step, in the finest scale in which full speed, its square and the way
 * to brake have room. */
static int setup_place(struct exh_limiter_cfg *cfg)
{
    const uint32_t rate = (uint32_t)cfg->par.rate_milli;
    const int32_t second = scaled(cfg->par.acc_max_milli, 1000000, rate);
    for (int frac = FRAC_MAX; frac >= 0; frac--) {
        const int32_t vel = scaled(cfg->par.vel_max, UINT32_C(1000) << frac, rate);
        const int32_t acc = scaled(second, UINT32_C(1000) << frac, rate);
        uint32_t brake;
        NEED(vel > 0, vel_max);
        NEED(acc > 0, acc_max_milli);
        if (vel >= VEL_MOST) { continue; }
        cfg->frac = (uint32_t)frac;
        cfg->vel = vel;
        /* From full speed to full speed the other way: no limit. */
        cfg->acc = acc < vel * 2 ? acc : vel * 2;
        /* fits() asks for v^2/2a + v/2 + a/8, and a <= 2v. */
        brake = (uint32_t)scaled(vel, (uint32_t)vel, (uint32_t)cfg->acc * 2u) + (uint32_t)vel;
        brake = (brake >> frac) + 2;
        cfg->brake = (int32_t)brake;
        if (brake < WAY_MOST >> frac) { return 0; }
    }
    return FIELD(vel_max);
}

/* As drive.c has it, for any unit: squares above the nominal one, summed over steps. */
static int setup_heat(struct exh_limiter_cfg *cfg, uint32_t steps)
{
    const uint32_t top = (uint32_t)cfg->par.heat_peak, bottom = (uint32_t)cfg->par.heat_nominal;
    unsigned shift = 0, knee = 30;
    uint32_t square, squares;
    cfg->heat_top = INT32_MAX;
    cfg->heat_shift = 31; /* no effort is seen, and there is room for ever */
    cfg->heat_budget = HEAT_MOST;
    cfg->heat_knee = knee;
    cfg->heat_bottom = 0;
    cfg->heat_square = 0;
    if (top == 0) { return 0; }
    while (top >> shift >> SQUARE_BITS) { shift++; }
    square = (bottom >> shift) * (bottom >> shift);
    squares = (top >> shift) * (top >> shift) - square;
    NEED(square > 0 && bottom < top && squares >= SQUARES_LEAST, heat_nominal);
    NEED(steps >= HEAT_STEPS, heat_ms);
    cfg->heat_top = (int32_t)top;
    cfg->heat_bottom = (int32_t)bottom;
    cfg->heat_shift = shift;
    cfg->heat_square = (int32_t)square;
    cfg->heat_budget = (int64_t)((uint64_t)squares * steps);
    while ((uint32_t)(cfg->heat_budget >> HEAT_SHIFT) >> 2 >> knee == 0) { knee--; }
    cfg->heat_knee = knee;
    return 0;
}

/* A gain in the law's format, by the least shift that fits. */
static int32_t law_gain(int32_t gain, uint32_t unit, unsigned q, unsigned *shift)
{
    int32_t v;
    *shift = 0;
    for (;;) {
        v = scaled(gain, UINT32_C(1) << (q - *shift), unit);
        if (v < INT32_MAX) { return v; }
        (*shift)++;
    }
}

static int setup_wall(struct exh_limiter_cfg *cfg)
{
    const struct exh_limiter_par *par = &cfg->par;
    unsigned pos, vel;
    cfg->wall.k_Npm_q10 =
        law_gain(par->wall_k_milli, 1000, EXH_Q_K + EXH_Q_POS - EXH_Q_FORCE, &pos);
    cfg->wall.b_Nspm_q20 = law_gain(par->wall_b, 1000000, EXH_Q_B + EXH_Q_VEL - EXH_Q_FORCE, &vel);
    cfg->wall.f0_N_q20 = par->wall_f0;
    cfg->pos_scale = INT32_C(1) << pos;
    cfg->vel_scale = INT32_C(1) << vel;
    if (par->wall_below) {
        cfg->pos_scale = -cfg->pos_scale;
        cfg->vel_scale = -cfg->vel_scale;
    }
    NEED(cfg->near_max < LAW_MOST >> pos && -cfg->near_min < LAW_MOST >> pos, wall_k_milli);
    NEED(par->speed_max <= INT32_MAX >> vel, wall_b);
    return 0;
}

/* Times; and what motion.h watches. */
static int setup_times(struct exh_limiter_cfg *cfg, const int32_t steps[EXH_LIMITER_FIELDS])
{
    const struct exh_limiter_par *par = &cfg->par;
    const uint32_t release = (uint32_t)steps[PLACE_OF(release_ms)];
    cfg->fall_q32 = (uint32_t)scaled(2, UINT32_C(1) << 30, release + (release == 0)) * 2;
    cfg->ramp_q30 = scaled(1, (UINT32_C(1) << 30) - 1, (uint32_t)steps[PLACE_OF(ramp_ms)] + 1) + 1;
    cfg->up = steps[PLACE_OF(effort_up_milli)];
    cfg->down = steps[PLACE_OF(effort_down_milli)];
    cfg->speed_steps = (uint32_t)steps[PLACE_OF(speed_ms)] + 1;
    cfg->stall_steps = par->stall_effort > 0 ? (uint32_t)steps[PLACE_OF(stall_ms)] + 1 : 0;
    cfg->motion.speed_mps_q27 = par->speed_max > 0 ? par->speed_max : INT32_MAX;
    cfg->motion.stuck_cur_A_q26 = par->stall_effort;
    cfg->still_steps = (uint32_t)scaled(par->gap_max_us, (uint32_t)par->rate_milli, 1000000000);
    NEED(cfg->still_steps >= 2, gap_max_us);
    return setup_heat(cfg, (uint32_t)steps[PLACE_OF(heat_ms)]);
}

int exh_limiter_setup(struct exh_limiter_cfg *cfg, const struct exh_limiter_par *par)
{
    int32_t steps[EXH_LIMITER_FIELDS];
    int err = copy_checked(cfg, par, steps);
    if (err == 0) { err = check_relations(cfg); }
    if (err == 0) { err = setup_times(cfg, steps); }
    if (err == 0 && cfg->par.kind == EXH_LIMITER_POSITION) { err = setup_place(cfg); }
    if (err == 0 && cfg->par.kind == EXH_LIMITER_WALL) { err = setup_wall(cfg); }
    return err;
}
