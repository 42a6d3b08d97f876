/* SPDX-License-Identifier: MIT */
/* Text for people: one line at the end of a phase, and the action for the next. */
#include "bringup.h"

struct text {
    char *to;
    unsigned len;
};

static void put(struct text *t, const char *word)
{
    while (*word != '\0' && t->len < BRINGUP_TEXT_B) { t->to[t->len++] = *word++; }
}

/* v / 10^places with all digits. */
static void put_int(struct text *t, int64_t v, unsigned places)
{
    char digit[24];
    unsigned n = sizeof digit;
    uint64_t rest = (uint64_t)(v < 0 ? -v : v);
    digit[--n] = '\0';
    do {
        uint64_t d;
        rest = exh_udiv64(rest, 10, &d);
        digit[--n] = (char)('0' + (char)d);
        if (sizeof digit - 1 - n == places && places > 0) { digit[--n] = '.'; }
    } while (rest > 0 || sizeof digit - 1 - n < places + (places > 0) + 1);
    if (v < 0) { digit[--n] = '-'; }
    put(t, &digit[n]);
}

/* raw 2^-frac in thousandths, rounded to nearest. */
static int64_t milli(int64_t raw, unsigned frac) { return exh_shr_round(raw * 1000, frac); }

static void put_mA(struct text *t, const char *before, int32_t A_q26)
{
    put(t, before);
    put_int(t, milli(A_q26, EXH_Q_CUR), 0);
    put(t, " mA");
}

static const struct bringup_phase *told(const struct bringup *s, const struct bringup_cfg *cfg)
{
    return bringup_phase(cfg->list, s->told_phase);
}

/* --- */

/* The action for the next phase. */
static void put_ask(struct text *t, const struct bringup *s, const struct bringup_cfg *cfg)
{
    const struct bringup_phase *p = bringup_phase(cfg->list, s->phase);
    if (p == NULL || p->text[0] == '\0') { return; }
    put(t, p->name);
    put(t, ": ");
    put(t, p->text);
    put(t, "\n");
}

static void put_start(struct text *t, const struct bringup_cfg *cfg)
{
    const struct bringup_own_par *own = &cfg->par->own;
    put(t, "stage ");
    put_int(t, own->stage, 0);
    put(t, ", finger ");
    put_int(t, own->finger, 0);
    put_mA(t, ", no more than ", cfg->to_cur[1].y);
    put(t, own->stage == 1 ? " as a code, drive disabled\n" : "\n");
}

static void put_level(struct text *t, const struct bringup *s, const struct bringup_cfg *cfg)
{
    const int32_t stage = cfg->par->own.stage;
    put(t, told(s, cfg)->name);
    put(t, " ");
    put_int(t, s->told_level + 1, 0);
    if (stage == 1) {
        const int64_t off_raw = (int64_t)s->tell_raw - cfg->par->drive.dac_zero_raw;
        put(t, ": code ");
        put_int(t, s->tell_raw, 0);
        put(t, ", meter ");
        put_int(t, exh_shr_round(off_raw * 322745, 20), 3); /* 1000 / 3249 mV per code */
        put(t, " V");
    } else if (stage >= 4) {
        put(t, ": ");
        put_int(t, milli(cfg->level_N_q20[s->told_level], EXH_Q_FORCE), 3);
        put(t, " N");
    } else {
        put(t, ":");
    }
    put_mA(t, stage == 1 || stage >= 4 ? ", " : " ", exh_mean_value(&s->told_coded));
    if (stage > 1 || cfg->par->own.loop) { put_mA(t, ", monitor ", exh_mean_value(&s->told_mon)); }
    put(t, "\n");
}

/* Names of the bits that are set, in brackets. */
static void put_names(struct text *t, const char *const *name, unsigned count, uint32_t bits)
{
    const char *before = " (";
    for (unsigned i = 0; i < count; i++) {
        if (!(bits >> i & 1)) { continue; }
        put(t, before);
        put(t, name[i]);
        before = ", ";
    }
    put(t, before[0] == ',' ? ")" : "");
}

static void put_causes(struct text *t, const struct bringup *s)
{
    static const char *const name[] = {"emergency stop", "drive not ready", "ticks missed",
        "encoder", "dead-man released", "current tracking", "encoder stands", "too fast", "glove",
        "card", "link", "supply", "watchdog", "configuration", "state of the box"};
    put_names(t, name, EXH_FAULTS,
        s->safety.state == EXH_STATE_FAULT ? s->safety.faults : s->safety.present);
}

static void put_missing(struct text *t, const struct bringup *s)
{
    static const char *const name[] = {"emergency stop", "dead-man", "drive ready"};
    put_names(t, name, 3, ~(s->opened & s->closed));
}

/* The last values of the phase. */
static void put_values(struct text *t, const struct bringup *s, const struct bringup_cfg *cfg)
{
    const int turned = told(s, cfg)->ask == BRINGUP_ASK_TURN;
    const int32_t moved_cnt = exh_wrap_diff(turned ? s->far_cnt : s->tell_cnt, s->start_cnt);
    if (!told(s, cfg)->hands) { put_mA(t, ", ", s->tell_A_q26); }
    if (s->mon.n > 0 || !told(s, cfg)->hands) {
        put_mA(t, ", monitor ", s->mon.n ? exh_mean_value(&s->mon) : s->tell_mon_A_q26);
    }
    if (told(s, cfg)->step == BRINGUP_INPUTS || told(s, cfg)->step == BRINGUP_TABLE) {
        put(t, "\n");
        return;
    }
    put(t, ", moved ");
    put_int(t, milli(INT64_C(10) * exh_quad_pos_m_q30(&cfg->par->quad, moved_cnt), EXH_Q_POS), 1);
    put(t, " mm");
    if (!told(s, cfg)->hands) {
        put(t, ", ");
        put_int(t, milli(s->tell_mps_q27, EXH_Q_VEL), 0);
        put(t, " mm/s");
    }
    put(t, "\n");
}

/* A line through the balance's readings, if any: the suggested kf. */
static void put_kf(struct text *t, const struct bringup_cfg *cfg)
{
    struct exh_calib_point point[BRINGUP_LEVELS];
    const struct exh_table to_cur = {cfg->to_cur, 2};
    struct exh_calib_fit fit;
    for (unsigned k = 0; k < BRINGUP_LEVELS; k++) {
        const int32_t cur_A_q26 = exh_table_at(to_cur, cfg->level_N_q20[k]);
        point[k] = (struct exh_calib_point){cfg->par->own.read_N_q20[k], cur_A_q26, cur_A_q26, 0};
    }
    if (exh_calib_fit(&fit, point, BRINGUP_LEVELS, EXH_CALIB_CURRENT) < 0) {
        put(t, "table: no readings yet: the same again with read1= read2= read3=, in N\n");
        return;
    }
    put(t, "table: the balance says kf ");
    put_int(t, milli(fit.kf_NpA_q20, EXH_Q_FORCE), 3);
    put(t, ", set is ");
    put_int(t, milli(cfg->par->own.kf_NpA_q20, EXH_Q_FORCE), 3);
    put(t, " N/A\n");
}

/* The current that balances the mass without friction, and kf from it. */
static void put_mass(struct text *t, const struct bringup *s, const struct bringup_cfg *cfg)
{
    const struct exh_calib_point p = exh_weigh_point(&s->weigh, cfg->mass_N_q20);
    struct exh_calib_fit fit;
    put_int(t, milli(p.force_N_q20, EXH_Q_FORCE), 3);
    put_mA(t, " N: ", p.cur_A_q26);
    put_mA(t, ", monitor ", p.mon_A_q26);
    put_mA(t, ", friction ", p.friction_A_q26);
    if (exh_calib_fit(&fit, &p, 1, EXH_CALIB_CURRENT) == 0) {
        put(t, "; kf ");
        put_int(t, milli(fit.kf_NpA_q20, EXH_Q_FORCE), 3);
        put(t, " N/A");
    }
    put(t, "\n");
}

static void put_phase(struct text *t, const struct bringup *s, const struct bringup_cfg *cfg)
{
    const struct bringup_phase *p = told(s, cfg);
    const int failed = s->result > EXH_PROBE_DONE;
    if (p->step == BRINGUP_TABLE) { put_kf(t, cfg); }
    put(t, failed ? "STOP in " : "");
    put(t, p->name);
    put(t, ": ");
    put(t, failed ? bringup_result_text(s->result) : "ok");
    if (s->result == BRINGUP_OFF) { put_causes(t, s); }
    if (s->result == BRINGUP_INPUT) { put_missing(t, s); }
    put_values(t, s, cfg);
    if (!failed && p->step == BRINGUP_WEIGH) { put_mass(t, s, cfg); }
    if (failed) { put(t, "outputs at 0 A, drive disabled\n"); }
}

static void put_end(struct text *t, const struct bringup_cfg *cfg)
{
    const struct bringup_own_par *own = &cfg->par->own;
    put(t, "stage ");
    put_int(t, own->stage, 0);
    put(t, "");
    put(t, cfg->list == BRINGUP_WEIGHS ? " weighed" : " shown");
    put(t, ": outputs at 0 A, drive disabled");
    if (cfg->list < BRINGUP_STAGES) {
        put(t, "; next stage=");
        put_int(t, own->stage + 1, 0);
        put(t, " finger=");
        put_int(t, own->finger, 0);
        put(t, " shown=");
        put_int(t, cfg->number, 0);
    }
    put(t, "\n");
}

unsigned bringup_text(
    char text[BRINGUP_TEXT_B], const struct bringup *s, const struct bringup_cfg *cfg)
{
    struct text t = {text, 0};
    if (s->tell & BRINGUP_TELL_START) { put_start(&t, cfg); }
    if (s->tell & BRINGUP_TELL_LEVEL) { put_level(&t, s, cfg); }
    if (s->tell & BRINGUP_TELL_PHASE) { put_phase(&t, s, cfg); }
    if ((s->tell & (BRINGUP_TELL_START | BRINGUP_TELL_PHASE)) && s->result == EXH_PROBE_BUSY) {
        put_ask(&t, s, cfg);
    }
    if ((s->tell & BRINGUP_TELL_PHASE) && s->result == EXH_PROBE_DONE) { put_end(&t, cfg); }
    return t.len;
}
