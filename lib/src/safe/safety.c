/* SPDX-License-Identifier: MIT */
/* State machine of the device: causes, arming, release and faults. */
#include "exhand/safety.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include <stddef.h>

#define MISSED_MAX     1
#define LATE_MOST      (4u * EXH_LATE_TICKS) /* else a minute of overrun takes an hour */
#define SMALL_MIN_NQ20 EXH_Q(1, 10, EXH_Q_FORCE)
#define SMALL_MAX_NQ20 EXH_Q(10, 1, EXH_Q_FORCE)
#define ARM_MAX_MS     1000
#define RAMP_MAX_MS    5000
#define RELEASE_MIN_MS 5
#define SLOW_HZ        500 /* below it, a release has at most 4 ticks */
#define SLOW_TICKS     4
#define RELEASE_MAX_MS 18 /* with the tick that detects it, at 500 Hz: 20 */
#define FULL_Q30       (INT32_C(1) << 30)

const struct exh_signal exh_safety_rows[EXH_SAFETY_ROWS] = {
    {0x0601, 0, EXH_WHEN_SETUP, 0, MISSED_MAX, 1, "missed_max", "",
        "missed ticks tolerated, in 64"},
    {0x0602, EXH_Q_FORCE, EXH_WHEN_SETUP, SMALL_MIN_NQ20, SMALL_MAX_NQ20, EXH_Q(1, 1, EXH_Q_FORCE),
        "arm_force", "n", "arming needs a law that asks for no more"},
    {0x0603, 0, EXH_WHEN_SETUP, 1, ARM_MAX_MS, 50, "arm_time", "ms", "for so long, and 2 ticks"},
    {0x0604, 0, EXH_WHEN_SETUP, 1, RAMP_MAX_MS, 500, "ramp_time", "ms",
        "then the force limit rises to f_max in"},
    {0x0605, 0, EXH_WHEN_SETUP, RELEASE_MIN_MS, RELEASE_MAX_MS, 15, "release_time", "ms",
        "a force let go falls to zero in, 3 ticks at least"},
};

/* --- set-up --- */

int exh_safety_setup(
    struct exh_safety_cfg *cfg, const struct exh_safety_par *par, struct exh_period T)
{
    uint32_t ramp_ticks;
    if (!exh_inside(par->missed_max, 0, MISSED_MAX) ||
        !exh_inside(par->arm_force_N_q20, SMALL_MIN_NQ20, SMALL_MAX_NQ20) ||
        !exh_inside(par->arm_ms, 1, ARM_MAX_MS) || !exh_inside(par->ramp_ms, 1, RAMP_MAX_MS) ||
        !exh_inside(par->release_ms, RELEASE_MIN_MS, RELEASE_MAX_MS)) {
        return -EXH_E_RANGE;
    }
    if (!exh_period_ok(T)) { return -EXH_E_RATE; }
    cfg->late_max = (uint32_t)par->missed_max * EXH_LATE_TICKS;
    cfg->small_N_q20 = par->arm_force_N_q20;
    cfg->arm_ticks = exh_ticks_in(par->arm_ms, T) + 1;
    if (cfg->arm_ticks < 2) { cfg->arm_ticks = 2; }
    ramp_ticks = exh_ticks_in(par->ramp_ms, T) + 1;
    cfg->ramp_q30 = (int32_t)exh_udiv64(FULL_Q30 + ramp_ticks - 1, ramp_ticks, NULL);
    cfg->release_ticks = exh_ticks_in(par->release_ms, T);
    if (cfg->release_ticks < 3) { cfg->release_ticks = 3; }
    if (cfg->release_ticks > SLOW_TICKS && T.den < (uint64_t)SLOW_HZ * T.num) {
        cfg->release_ticks = SLOW_TICKS;
    }
    return exh_gain_set(&cfg->fall, 1, cfg->release_ticks);
}

/* --- conditions --- */

static uint32_t add_sat(uint32_t a, uint32_t b) { return a > UINT32_MAX - b ? UINT32_MAX : a + b; }

/* A tick half a period too long misses every other tick, so misses must accumulate. */
static void count_missed(struct exh_safety *s, uint32_t missed)
{
    s->missed = add_sat(s->missed, missed);
    if (s->late > 0) { s->late--; }
    for (uint32_t k = 0; k < missed && k <= MISSED_MAX; k++) {
        s->late = add_sat(s->late, EXH_LATE_TICKS);
    }
    if (s->late > LATE_MOST) { s->late = LATE_MOST; }
}

/* Counts all limits in every tick, since the cost must not depend on them. */
static void count_limits(struct exh_safety *s)
{
    uint32_t left = s->limits;
    for (uint32_t *held = s->held; held < s->held + EXH_LIMITS; held++, left >>= 1) {
        const uint32_t sum = *held + (left & 1u);
        *held = sum - (sum < *held);
    }
}

/* Only FAULT and a RELEASE towards it have latched faults. */
static int sane(const struct exh_safety *s)
{
    return s->state == EXH_STATE_FAULT  ? s->faults != 0
           : s->state < EXH_STATE_FAULT ? s->faults == 0 || s->state == EXH_STATE_RELEASE
                                        : 0;
}

/* Causes present in this tick. */
static uint32_t causes(
    struct exh_safety *s, const struct exh_safety_cfg *cfg, const struct exh_safety_in *in)
{
    const uint32_t drives = ((1u << in->fingers) - 1u) * EXH_DIN_DRIVE0;
    uint32_t c = in->raised;
    if (!(in->din & EXH_DIN_ESTOP)) { c |= EXH_FAULT_ESTOP; }
    if (!(in->din & EXH_DIN_DEADMAN)) { c |= EXH_FAULT_DEADMAN; }
    if (!(in->din & EXH_DIN_WATCHDOG)) { c |= EXH_FAULT_WATCHDOG; }
    if (!(in->din & EXH_DIN_CARDS)) { c |= EXH_FAULT_CARD; }
    if ((in->din & drives) != drives) { c |= EXH_FAULT_DRIVE; }
    if (s->late > cfg->late_max) { c |= EXH_FAULT_OVERRUN; }
    if (!sane(s)) {
        c |= EXH_FAULT_LOGIC;
        s->state = EXH_STATE_FAULT;
    }
    return c;
}

/* Steps of arming that fail, among those that need no open gate. */
static uint32_t lacking(const struct exh_safety *s, uint32_t ready, uint32_t now)
{
    return (~ready & EXH_ARM_ALL) | (now ? EXH_ARM_DEADMAN : 0u) |
           (s->limits & EXH_LIMIT_FORCE ? EXH_ARM_SMALL_FORCE : 0u);
}

static void latch(struct exh_safety *s, uint32_t now)
{
    if (s->faults == 0 && now != 0) {
        s->first = now;
        s->first_tick = s->tick;
    }
    s->faults |= now;
}

/* Requires a release of the dead-man after the last cause, and after causes that return while it is
 * open. So a person clears only faults that have ended. */
static void see_hand(struct exh_safety *s, uint32_t din)
{
    if (s->present) { s->opened = s->present == EXH_FAULT_DEADMAN && !(din & EXH_DIN_DEADMAN); }
}

/* --- transitions --- */

#define O EXH_STATE_OFF
#define A EXH_STATE_ARM
#define R EXH_STATE_RUN
#define L EXH_STATE_LIMIT
#define E EXH_STATE_RELEASE
#define F EXH_STATE_FAULT
const uint8_t exh_safety_next[EXH_STATES][EXH_TRIGGERS] = {
    /*            refused cut latched released cause off armed limited run clear none */
    /* off     */ {O, O, F, F, O, O, F, F, A, F, O},
    /* arm     */ {O, F, F, F, E, E, R, F, A, F, A},
    /* run     */ {F, F, F, F, E, E, F, L, R, F, R},
    /* limit   */ {F, F, F, F, E, E, F, L, R, F, R},
    /* release */ {F, F, F, O, E, E, F, F, E, F, E},
    /* fault   */ {F, F, F, F, F, F, F, F, F, O, F},
};
#undef O
#undef A
#undef R
#undef L
#undef E
#undef F

#define ON(trigger, when) ((when) ? 1u << EXH_ON_##trigger : 0u)

/* Bits of all triggers that apply. Triggers of one state are computed in that state only. */
static uint32_t triggers(const struct exh_safety *s, const struct exh_safety_cfg *cfg,
    const struct exh_safety_in *in, uint32_t lacks)
{
    const int ramp = s->state == EXH_STATE_ARM && s->share_q30 > 0;
    const int early = s->state == EXH_STATE_ARM && s->share_q30 <= 0;
    const int off = in->command == EXH_CMD_OFF, run = in->command == EXH_CMD_RUN;
    const int asked = s->state == EXH_STATE_OFF && run;
    const int ended = s->state == EXH_STATE_RELEASE && s->steps >= cfg->release_ticks;
    const int runs = exh_safety_is_running(s);
    return ON(REFUSED, (asked && lacks) || (early && (lacks || off))) |
           ON(CUT, s->present & EXH_FAULT_CUT) | ON(LATCHED, ended && s->faults) |
           ON(RELEASED, ended && !s->faults) | ON(CAUSE, s->present) |
           ON(OFF, off || (ramp && lacks & EXH_ARM_ALL)) |
           ON(ARMED, ramp && s->share_q30 >= FULL_Q30) |
           ON(LIMITED, runs && s->limits & ~(uint32_t)EXH_LIMIT_PULL) | ON(RUN, run) |
           ON(CLEAR, in->command == EXH_CMD_CLEAR && s->state == EXH_STATE_FAULT && !s->present &&
                         s->opened) |
           ON(NONE, 1);
}

/* The first trigger: the index of the lowest bit. */
static uint8_t first_of(uint32_t due)
{
    const uint32_t low = due & (~due + 1u);
    return (uint8_t)(((low & 0xAAAAu) != 0) | ((low & 0xCCCCu) != 0) << 1 |
                     ((low & 0xF0F0u) != 0) << 2 | ((low & 0xFF00u) != 0) << 3);
}

/* Counts the ticks of a state from its first tick. */
static void count_steps(struct exh_safety *s, const struct exh_safety_cfg *cfg, int anew,
    const struct exh_safety_in *in)
{
    const int waits = in->ready & EXH_ARM_WAIT && s->share_q30 > 0;
    if (anew) { s->steps = 0; }
    if (anew || s->state != EXH_STATE_ARM) { s->share_q30 = 0; }
    if (s->state == EXH_STATE_RELEASE) { s->steps = add_sat(s->steps, add_sat(in->missed, 1)); }
    if (s->state == EXH_STATE_ARM && !anew) {
        s->steps = add_sat(s->steps, 1);
        if (s->steps >= cfg->arm_ticks && !waits) {
            s->share_q30 = exh_clamp((int64_t)s->share_q30 + cfg->ramp_q30, 0, FULL_Q30);
        }
    }
}

static struct exh_permit permit_of(
    const struct exh_safety *s, const struct exh_safety_cfg *cfg, uint32_t missed)
{
    struct exh_permit p;
    p.mode = !exh_safety_is_open(s)          ? EXH_PERMIT_CLOSED
             : s->state == EXH_STATE_RELEASE ? EXH_PERMIT_RELEASE
                                             : EXH_PERMIT_OPEN;
    p.share_q30 = s->state == EXH_STATE_ARM ? s->share_q30 : FULL_Q30;
    p.small_N_q20 = cfg->small_N_q20;
    p.ticks = add_sat(missed, 1);
    p.fall = cfg->fall;
    return p;
}

struct exh_permit exh_safety_step(
    struct exh_safety *s, const struct exh_safety_cfg *cfg, struct exh_safety_in in)
{
    uint32_t lacks;
    uint8_t before;

    EXH_ASSERT(in.fingers >= 1);
    EXH_ASSERT(in.fingers <= EXH_FINGERS);
    s->fingers = in.fingers;
    count_missed(s, in.missed);
    count_limits(s);
    s->present = causes(s, cfg, &in);
    lacks = lacking(s, in.ready, s->present);
    if (exh_safety_is_open(s) || s->state == EXH_STATE_FAULT) { latch(s, s->present); }
    see_hand(s, in.din);
    s->trigger = first_of(triggers(s, cfg, &in, lacks));
    if (lacks &&
        (s->trigger == EXH_ON_REFUSED ||
            (s->trigger == EXH_ON_OFF && in.ready & EXH_ARM_WAIT && exh_safety_pulls(s)))) {
        s->refused = (uint8_t)(lacks & (~lacks + 1u)); /* lowest bit: the first step */
        s->refusals = add_sat(s->refusals, 1);
    }
    before = s->state;
    s->state = exh_safety_next[before][s->trigger];
    if (s->trigger == EXH_ON_CLEAR) { s->faults = 0; }
    if (s->trigger == EXH_ON_ARMED) { s->refused = 0; }
    count_steps(s, cfg, s->state != before, &in);
    s->tick++;
    return permit_of(s, cfg, in.missed);
}

uint8_t exh_safety_arm_step(const struct exh_safety *s)
{
    if (s->state != EXH_STATE_ARM) { return s->refused; }
    return s->share_q30 > 0 ? EXH_ARM_RAMP : EXH_ARM_SMALL_FORCE;
}

/* --- state --- */

/* A corrupted state must not read as RUN, so it carries a CRC. The CRC is multiplied by an odd
 * constant, because data followed by its plain CRC makes any enclosing CRC constant. */
static int sealed(struct exh_bytes *c, uint32_t from)
{
    const int buffer = c->mode != EXH_BYTES_MEASURE && exh_bytes_ok(c);
    const uint32_t is = buffer ? exh_crc32(0, c->p + from, c->at - from) * UINT32_C(0x9E3779B1) : 0;
    uint32_t seal = is;
    exh_bytes_u32(c, &seal);
    return seal == is && exh_bytes_ok(c);
}

void exh_safety_serialize(struct exh_bytes *c, struct exh_safety *s)
{
    const uint32_t from = c->at;
    exh_bytes_u32(c, &s->present);
    exh_bytes_u32(c, &s->faults);
    exh_bytes_u32(c, &s->first);
    exh_bytes_u32(c, &s->first_tick);
    exh_bytes_u32(c, &s->tick);
    exh_bytes_u32(c, &s->missed);
    exh_bytes_u32(c, &s->late);
    exh_bytes_u32(c, &s->limits);
    for (unsigned k = 0; k < EXH_LIMITS; k++) { exh_bytes_u32(c, &s->held[k]); }
    exh_bytes_u32(c, &s->refusals);
    exh_bytes_u32(c, &s->steps);
    exh_bytes_i32(c, &s->share_q30);
    exh_bytes_u8(c, &s->state);
    exh_bytes_u8(c, &s->alive);
    exh_bytes_u8(c, &s->refused);
    exh_bytes_u8(c, &s->opened);
    exh_bytes_u8(c, &s->trigger);
    for (unsigned k = 0; k < EXH_FINGERS; k++) { exh_bytes_u16(c, &s->off_raw[k]); }
    if (!sealed(c, from) && c->mode == EXH_BYTES_READ) {
        s->state = EXH_STATE_FAULT;
        s->faults |= EXH_FAULT_LOGIC;
        s->opened = 0;
    }
    s->share_q30 = exh_clamp(s->share_q30, 0, FULL_Q30);
}
