/* SPDX-License-Identifier: MIT */
/* The phases of each stage. */
#include "bringup.h"

/* Levels dwell for `hold`. Measurement starts after the first quarter, when the current no longer
 * rises. */
static int measures(const struct bringup *s, const struct bringup_cfg *cfg)
{
    return s->tick - s->level * cfg->hold_ticks >= cfg->hold_ticks / 4;
}

/* --- hands --- */

static uint8_t turn(struct bringup *s, const struct bringup_cfg *cfg, struct bringup_view v)
{
    const int64_t out = exh_wrap_diff(v.cnt, s->start_cnt);
    const int64_t far = exh_wrap_diff(s->far_cnt, s->start_cnt);
    if (out > far) { s->far_cnt = v.cnt; }
    if (far < cfg->turn_cnt && -out > cfg->turn_cnt / 2) { return EXH_PROBE_WRONG_WAY; }
    if (far >= cfg->turn_cnt && out < cfg->turn_cnt / 4) { return EXH_PROBE_DONE; }
    if (s->tick < cfg->wait_ticks) { return EXH_PROBE_BUSY; }
    return far < cfg->polarity.move_cnt ? EXH_PROBE_STILL : BRINGUP_NOBODY;
}

/* Each input must open and close, longer than contact bounce. */
static uint8_t inputs(struct bringup *s, const struct bringup_cfg *cfg, struct bringup_view v)
{
    s->steady = v.din == s->was ? s->steady + 1 : 0;
    s->was = v.din;
    if (s->steady >= cfg->doubt_ticks) {
        s->opened |= ~v.din & 7u;
        s->closed |= v.din;
    }
    if ((s->opened & s->closed) == 7u) { return EXH_PROBE_DONE; }
    return s->tick < cfg->wait_ticks ? EXH_PROBE_BUSY : BRINGUP_INPUT;
}

/* --- currents --- */

static int32_t force_of(const struct bringup_cfg *cfg, int32_t cur_A_q26)
{
    const int32_t f_N_q20 = exh_sat32(exh_mul_shr(cur_A_q26, cfg->kf_NpA_q20, EXH_Q_CUR));
    const int32_t top_N_q20 = cfg->level_N_q20[BRINGUP_LEVELS - 1];
    return f_N_q20 < top_N_q20 ? f_N_q20 : top_N_q20;
}

static uint8_t rest(struct bringup *s, const struct bringup_cfg *cfg, struct bringup_view v)
{
    const int64_t off_A_q26 = (int64_t)cfg->par->own.zero_A_q26 * cfg->hold_ticks;
    exh_mean_add(&s->mon, v.mon_A_q26);
    exh_mean_add(&s->coded, s->coded_A_q26);
    if (cfg->par->own.stage == 1 && !cfg->par->own.loop) { return EXH_PROBE_DONE; }
    if (s->mon.n < cfg->hold_ticks) { return EXH_PROBE_BUSY; }
    return s->mon.sum > off_A_q26 || -s->mon.sum > off_A_q26 ? BRINGUP_MONITOR : EXH_PROBE_DONE;
}

static uint8_t levels(
    struct bringup *s, const struct bringup_cfg *cfg, struct bringup_view v, int32_t *f_N_q20)
{
    *f_N_q20 = cfg->level_N_q20[s->level];
    if (measures(s, cfg)) {
        exh_mean_add(&s->mon, v.mon_A_q26);
        exh_mean_add(&s->coded, s->coded_A_q26);
    }
    if (s->tick + 1 < (s->level + 1u) * cfg->hold_ticks) { return EXH_PROBE_BUSY; }
    s->tell |= BRINGUP_TELL_LEVEL;
    s->told_level = s->level;
    s->told_mon = s->mon;
    s->told_coded = s->coded;
    s->mon.sum = s->coded.sum = 0;
    s->mon.n = s->coded.n = 0;
    s->level++;
    /* A string under higher tension stretches a little: an encoder without counts is dead. */
    if (cfg->par->own.stage >= 4 && v.cnt == s->at_cnt) { return EXH_PROBE_STILL; }
    s->at_cnt = v.cnt;
    return s->level < BRINGUP_LEVELS ? EXH_PROBE_BUSY : EXH_PROBE_DONE;
}

static uint8_t polarity(
    struct bringup *s, const struct bringup_cfg *cfg, struct bringup_view v, int32_t *f_N_q20)
{
    if (s->tick == 0) { exh_probe_start(&s->probe, v.cnt, 0); }
    (void)exh_probe_step(&s->probe, &cfg->polarity, v.cnt);
    *f_N_q20 = force_of(cfg, s->probe.cur_A_q26);
    return s->probe.result;
}

static uint8_t speed(
    struct bringup *s, const struct bringup_cfg *cfg, struct bringup_view v, int32_t *f_N_q20)
{
    *f_N_q20 = cfg->level_N_q20[BRINGUP_LEVELS - 1];
    if (-v.v_mps_q27 >= cfg->par->own.v_trip_mps_q27) { return EXH_PROBE_DONE; }
    if (v.v_mps_q27 >= cfg->par->own.v_trip_mps_q27) { return EXH_PROBE_WRONG_WAY; }
    return s->tick < cfg->dwell_ticks * 10 ? EXH_PROBE_BUSY : EXH_PROBE_STILL;
}

/* At rest: less than `move` in a dwell that begins after stop_time. */
static uint8_t stop(struct bringup *s, const struct bringup_cfg *cfg, struct bringup_view v)
{
    const int64_t moved = exh_wrap_diff(v.cnt, s->at_cnt);
    if (s->tick <= cfg->stop_ticks) { s->at_cnt = v.cnt; }
    if (s->tick < cfg->stop_ticks + cfg->dwell_ticks) { return EXH_PROBE_BUSY; }
    return moved < cfg->polarity.move_cnt && -moved < cfg->polarity.move_cnt ? EXH_PROBE_DONE
                                                                             : EXH_PROBE_TIME;
}

static uint8_t home(
    struct bringup *s, const struct bringup_cfg *cfg, struct bringup_view v, int32_t *f_N_q20)
{
    if (s->tick == 0) { exh_home_start(&s->homing, v.cnt); }
    (void)exh_home_step(&s->homing, &cfg->home, v.cnt);
    *f_N_q20 = force_of(cfg, s->homing.cur_A_q26);
    return s->homing.result;
}

static uint8_t weigh(
    struct bringup *s, const struct bringup_cfg *cfg, struct bringup_view v, int32_t *f_N_q20)
{
    if (s->tick == 0) { exh_weigh_start(&s->weigh, &cfg->weigh, v.cnt); }
    (void)exh_weigh_step(&s->weigh, &cfg->weigh, v.cnt, s->coded_A_q26, v.mon_A_q26);
    *f_N_q20 = force_of(cfg, s->weigh.cur_A_q26);
    return s->weigh.result;
}

/* Compares the readings of the balance with the command. */
static uint8_t table(const struct bringup_cfg *cfg)
{
    const struct bringup_own_par *own = &cfg->par->own;
    for (unsigned k = 0; k < BRINGUP_LEVELS; k++) {
        const int64_t off = (int64_t)own->read_N_q20[k] - cfg->level_N_q20[k];
        if (100 * (off < 0 ? -off : off) > (int64_t)own->read_percent * cfg->level_N_q20[k]) {
            return BRINGUP_READING;
        }
    }
    return EXH_PROBE_DONE;
}

uint8_t bringup_step(struct bringup *s, const struct bringup_cfg *cfg,
    const struct bringup_phase *p, struct bringup_view v, int32_t *f_N_q20)
{
    *f_N_q20 = 0;
    switch (p->step) {
    case BRINGUP_REST: return rest(s, cfg, v);
    case BRINGUP_TURN: return turn(s, cfg, v);
    case BRINGUP_INPUTS: return inputs(s, cfg, v);
    case BRINGUP_LEVEL: return levels(s, cfg, v, f_N_q20);
    case BRINGUP_POLARITY: return polarity(s, cfg, v, f_N_q20);
    case BRINGUP_RUN: return speed(s, cfg, v, f_N_q20);
    case BRINGUP_STOP: return stop(s, cfg, v);
    case BRINGUP_HOME: return home(s, cfg, v, f_N_q20);
    case BRINGUP_WEIGH: return weigh(s, cfg, v, f_N_q20);
    case BRINGUP_TABLE: return table(cfg);
    default: return BRINGUP_OFF;
    }
}

#define HANDS 1
static const struct bringup_phase phases[] = {
    {1, BRINGUP_ASK_NOTHING, BRINGUP_REST, HANDS, BRINGUP_FAR_OWN, "rest",
        "no drive connected; D/A to the monitor's input and a meter"},
    {1, BRINGUP_ASK_TURN, BRINGUP_TURN, HANDS, BRINGUP_FAR_OWN, "encoder",
        "pull the string out by hand, let it back in"},
    {1, BRINGUP_ASK_INPUTS, BRINGUP_INPUTS, HANDS, BRINGUP_FAR_OWN, "inputs",
        "open and close emergency stop, dead-man, drive ready"},
    {1, BRINGUP_ASK_HOLD, BRINGUP_LEVEL, 0, BRINGUP_FAR_TRAVEL, "output",
        "hold the dead-man and read the meter; emergency stop if it is wrong"},
    {2, BRINGUP_ASK_HOLD, BRINGUP_REST, 0, BRINGUP_FAR_MOVE, "rest",
        "a dummy load on the drive; hold the dead-man"},
    {2, BRINGUP_ASK_NOTHING, BRINGUP_LEVEL, 0, BRINGUP_FAR_MOVE, "load", ""},
    {2, BRINGUP_ASK_NOTHING, BRINGUP_REST, 0, BRINGUP_FAR_MOVE, "off", ""},
    {3, BRINGUP_ASK_TURN, BRINGUP_TURN, HANDS, BRINGUP_FAR_OWN, "encoder",
        "the motor on the drive; pull its string out by hand, let it back in"},
    {3, BRINGUP_ASK_HOLD, BRINGUP_REST, 0, BRINGUP_FAR_MOVE, "rest",
        "string drawn out and free; hold the dead-man"},
    {3, BRINGUP_ASK_NOTHING, BRINGUP_POLARITY, 0, BRINGUP_FAR_TRAVEL, "polarity", ""},
    {3, BRINGUP_ASK_NOTHING, BRINGUP_RUN, 0, BRINGUP_FAR_TRAVEL, "speed", ""},
    {3, BRINGUP_ASK_NOTHING, BRINGUP_STOP, 0, BRINGUP_FAR_TRAVEL, "stop", ""},
    {4, BRINGUP_ASK_TURN, BRINGUP_TURN, HANDS, BRINGUP_FAR_OWN, "encoder",
        "pull the string out by hand, let it back in"},
    {4, BRINGUP_ASK_HOLD, BRINGUP_REST, 0, BRINGUP_FAR_MOVE, "rest",
        "string drawn out and free; hold the dead-man"},
    {4, BRINGUP_ASK_NOTHING, BRINGUP_HOME, 0, BRINGUP_FAR_OWN, "home", ""},
    {4, BRINGUP_ASK_HOOK, BRINGUP_LEVEL, 0, BRINGUP_FAR_TRAVEL, "force",
        "let go; the balance on the string, just taut; hold the dead-man and read it"},
    {4, BRINGUP_ASK_NOTHING, BRINGUP_TABLE, HANDS, BRINGUP_FAR_OWN, "table", ""},
    {6, BRINGUP_ASK_TURN, BRINGUP_TURN, HANDS, BRINGUP_FAR_OWN, "encoder",
        "pull the string out by hand, let it back in"},
    {6, BRINGUP_ASK_HOLD, BRINGUP_REST, 0, BRINGUP_FAR_MOVE, "rest",
        "string drawn out and free; hold the dead-man"},
    {6, BRINGUP_ASK_NOTHING, BRINGUP_HOME, 0, BRINGUP_FAR_OWN, "home", ""},
    {6, BRINGUP_ASK_HOOK, BRINGUP_WEIGH, 0, BRINGUP_FAR_TRAVEL, "mass",
        "let go; the mass on the string, standing, just taut; hold the dead-man"},
    {5, BRINGUP_ASK_TURN, BRINGUP_TURN, HANDS, BRINGUP_FAR_OWN, "encoder",
        "a finger in it: bend it, stretch it"},
    {5, BRINGUP_ASK_HOLD, BRINGUP_REST, 0, BRINGUP_FAR_TRAVEL, "rest",
        "finger bent and still; hold the dead-man"},
    {5, BRINGUP_ASK_NOTHING, BRINGUP_LEVEL, 0, BRINGUP_FAR_TRAVEL, "force", ""},
};

const struct bringup_phase *bringup_phase(unsigned list, unsigned phase)
{
    for (unsigned i = 0; i < sizeof phases / sizeof phases[0]; i++) {
        if (phases[i].stage == list && phase-- == 0) { return &phases[i]; }
    }
    return NULL;
}

const char *bringup_result_text(unsigned result)
{
    static const char *const text[BRINGUP_RESULTS - EXH_PROBE_RESULTS] = {
        "the box does not run",
        "a limit of the drive acts",
        "nobody did what was asked",
        "the stage before was not shown",
        "the monitor does not show the current commanded",
        "too fast",
        "an input was not seen to open and to close",
        "the balance does not read the force commanded",
    };
    return result >= EXH_PROBE_RESULTS && result < BRINGUP_RESULTS
               ? text[result - EXH_PROBE_RESULTS]
               : exh_probe_result_text(result);
}
