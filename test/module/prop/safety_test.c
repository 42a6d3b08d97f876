/* SPDX-License-Identifier: MIT */
/* safety.h: the gate with any current, any parameters in range, any state; the
 * state machine under any sequence of inputs. */
#include "exhand/safety.h"

#include "check.h"
#include "wide.h"

static int32_t in_row(unsigned r)
{
    return check_i32_in(exh_drive_rows[r].min, exh_drive_rows[r].max);
}

struct box {
    struct exh_drive_par par[EXH_FINGERS];
    struct exh_drive_cfg cfg[EXH_FINGERS];
    struct exh_current_ledger i[EXH_FINGERS];
    uint32_t limits[EXH_FINGERS];
    int32_t most[EXH_FINGERS]; /* codes from zero: in a release those of the last tick */
    struct exh_drive_out out;
};

static int any_box(struct box *b, unsigned n)
{
    static struct exh_knot knot[2] = {{0, 0, {1 << 30, 30}}, {1, 1, {1 << 30, 30}}};
    const struct exh_table t = {knot, 2}, none = {NULL, 0};
    for (unsigned k = 0; k < n; k++) {
        int32_t *field = &b->par[k].f_max_N_q20;
        for (unsigned r = 0; r < EXH_DRIVE_ROWS; r++) { field[r] = exh_drive_rows[r].dflt; }
        for (unsigned r = 6; r <= 8; r++) { /* zero, span, scale of the D/A */
            if (check_u64() % 4) { field[r] = in_row(r); }
        }
        if (check_u64() % 2) { field[3] = in_row(3); }   /* i_peak, and i_cont below it */
        if (check_u64() % 2) { field[12] = in_row(12); } /* person_i */
        if (b->par[k].i_cont_A_q26 > b->par[k].i_peak_A_q26) { b->par[k].i_cont_A_q26 = 0; }
        if (exh_drive_setup(&b->cfg[k], &b->par[k], (struct exh_period){1, 2000}, t, none) < 0) {
            return 0;
        }
        b->i[k].table_A_q26 = check_i32();
        b->i[k].peak_A_q26 = check_u64() % 2 ? 0 : check_i32();
        b->i[k].i2t_A_q26 = check_u64() % 2 ? 0 : check_i32();
        b->i[k].gate_A_q26 = b->i[k].dac_A_q26 = b->i[k].coded_A_q26 = 5;
        b->limits[k] = 0;
    }
    return 1;
}

/* code/rawpA amperes, q26, rounded and limited: the current of the code. */
static int stands_for(const struct exh_drive_par *par, int32_t codes, int32_t coded)
{
    const struct wide exact = wide_shl(wide_of(codes), EXH_Q_CUR + EXH_Q_DAC);
    const struct wide err = wide_sub(wide_mul(coded, par->dac_rawpA_q16), exact);
    const struct wide slack =
        wide_add(wide_shr_floor(wide_abs(exact), 31), wide_of((int64_t)par->dac_rawpA_q16 / 2 + 1));
    if (coded == INT32_MAX && wide_negative(err)) { return 1; }
    if (coded == INT32_MIN && !wide_negative(err)) { return 1; }
    return wide_within(err, slack);
}

/* The code nearest to the current asked, unless an end is in the way. */
static int nearest_code(const struct exh_drive_par *par, int32_t most, int64_t asked, int32_t codes)
{
    const int32_t top =
        par->person_A_q26 < par->i_peak_A_q26 ? par->person_A_q26 : par->i_peak_A_q26;
    const int64_t peak =
        wide_sat64(wide_shr_floor(wide_mul(top, par->dac_rawpA_q16), EXH_Q_CUR + EXH_Q_DAC));
    const int64_t near = par->dac_span_raw < most ? par->dac_span_raw : most;
    const int64_t span = peak < near ? peak : near;
    const int64_t lo = span < par->dac_zero_raw ? -span : -par->dac_zero_raw;
    const int64_t hi = span < 65535 - par->dac_zero_raw ? span : 65535 - par->dac_zero_raw;
    const int32_t in = wide_sat32(wide_of(asked));
    const int64_t want =
        wide_sat64(wide_shr_half_up(wide_mul(in, par->dac_rawpA_q16), EXH_Q_CUR + EXH_Q_DAC));
    return codes == (want < lo ? lo : want > hi ? hi : want);
}

static void check_finger(const struct box *b, unsigned k, int open, int64_t asked)
{
    const struct exh_drive_par *par = &b->par[k];
    const struct exh_current_ledger *i = &b->i[k];
    const int32_t codes = (int32_t)b->out.dac_raw[k] - par->dac_zero_raw;
    CHECK(codes <= par->dac_span_raw && codes >= -par->dac_span_raw,
        "finger %u: %" PRId32 " codes, span %" PRId32, k, codes, par->dac_span_raw);
    CHECK(wide_cmp(wide_shl(wide_of(codes < 0 ? -codes : codes), EXH_Q_CUR + EXH_Q_DAC),
              wide_mul(par->i_peak_A_q26, par->dac_rawpA_q16)) <= 0,
        "finger %u: %" PRId32 " codes are beyond i_peak", k, codes);
    CHECK(wide_cmp(wide_shl(wide_of(codes < 0 ? -codes : codes), EXH_Q_CUR + EXH_Q_DAC),
              wide_mul(par->person_A_q26, par->dac_rawpA_q16)) <= 0,
        "finger %u: %" PRId32 " codes are beyond person_i", k, codes);
    CHECK(i->coded_A_q26 == asked + i->gate_A_q26 + i->dac_A_q26, "finger %u: ledger", k);
    CHECK(stands_for(par, codes, i->coded_A_q26), "finger %u: %" PRId32 " codes are not %" PRId32,
        k, codes, i->coded_A_q26);
    if (open) {
        CHECK(nearest_code(par, b->most[k], asked, codes),
            "finger %u: %" PRId64 " A q26 became %" PRId32, k, asked, codes);
        CHECK(i->gate_A_q26 == 0 || asked > INT32_MAX || asked < INT32_MIN, "finger %u: gate", k);
    } else {
        CHECK(codes == 0 && i->coded_A_q26 == 0, "finger %u: %" PRId32 " codes outside RUN", k,
            codes);
        CHECK(i->gate_A_q26 == -asked && i->dac_A_q26 == 0, "finger %u: gate", k);
    }
}

TEST(gate_holds_with_any_input)
{
    while (check_case(4)) {
        const unsigned n = 1 + (unsigned)(check_u64() % EXH_FINGERS);
        struct box b;
        struct exh_safety s = {0};
        int64_t asked[EXH_FINGERS];
        uint8_t before;
        int open;
        if (!any_box(&b, n)) {
            CHECK(0, "set-up refused parameters within range");
            continue;
        }
        for (unsigned k = 0; k < n; k++) {
            asked[k] = b.i[k].table_A_q26 + b.i[k].peak_A_q26 + b.i[k].i2t_A_q26;
        }
        s.fingers = (uint8_t)(n + check_u64() % (EXH_FINGERS + 1 - n));
        s.state = (uint8_t)(check_u64() % 7);
        s.share_q30 = check_u64() % 2 ? 0 : 1;
        s.alive = (uint8_t)(check_u64() & 0xFF);
        for (unsigned k = 0; k < EXH_FINGERS; k++) {
            s.off_raw[k] = (uint16_t)(check_u64() >> (check_u64() % 17));
            b.most[k] = s.state == EXH_STATE_RELEASE ? s.off_raw[k] : UINT16_MAX;
        }
        open = (s.state > EXH_STATE_ARM && s.state < EXH_STATE_FAULT) ||
               (s.state == EXH_STATE_ARM && s.share_q30 == 1);
        b.out.alive = before = s.alive;
        exh_gate_step(&s, b.cfg, n, b.i, b.limits, &b.out);
        CHECK(b.out.alive != before && s.alive == b.out.alive, "alive stands at %d", before);
        CHECK(b.out.enable == (open ? (1u << n) - 1u : 0), "enable %x", b.out.enable);
        for (unsigned k = 0; k < n; k++) { check_finger(&b, k, open, asked[k]); }
        for (unsigned k = n; k < EXH_FINGERS; k++) {
            CHECK(b.out.dac_raw[k] == b.par[0].dac_zero_raw, "unused finger %u: %d", k,
                b.out.dac_raw[k]);
        }
    }
}

/* The last inputs, as the state machine should remember them. */
struct memory {
    uint64_t late;
    uint32_t ticks, opened, in_release;
};

static struct exh_safety_in any_in(uint32_t k)
{
    struct exh_safety_in in = {UINT32_MAX, 0, 0, EXH_CMD_NONE, 5, EXH_ARM_ALL};
    if (check_u64() % 64 == 0) { in.din = (uint32_t)(check_u64() & UINT32_MAX); }
    if (k / 256 % 4 == 0 && check_u64() % 8 == 0) { in.din &= ~(uint32_t)EXH_DIN_DEADMAN; }
    if (check_u64() % 128 == 0) { in.raised = 1u << check_u64() % EXH_FAULTS; }
    if (check_u64() % 100 == 0) { in.missed = (uint32_t)check_i32_in(0, 3); }
    if (check_u64() % 16 == 0) { in.command = (uint8_t)(check_u64() % 5); }
    if (check_u64() % 128 == 0) { in.ready = (uint8_t)(check_u64() & 15); }
    in.fingers = (uint8_t)(1 + check_u64() % 5);
    return in;
}

static uint32_t causes_of(const struct exh_safety_in *in, struct memory *m)
{
    uint32_t now = in->raised;
    m->late = (m->late > 0 ? m->late - 1 : 0) + EXH_LATE_TICKS * (in->missed < 2 ? in->missed : 2);
    if (m->late > 4 * EXH_LATE_TICKS) {
        m->late = 4 * EXH_LATE_TICKS;
    } /* gone after 256 ticks in time */
    now |= m->late > EXH_LATE_TICKS ? EXH_FAULT_OVERRUN : 0u;
    now |= in->din & EXH_DIN_ESTOP ? 0u : EXH_FAULT_ESTOP;
    now |= in->din & EXH_DIN_DEADMAN ? 0u : EXH_FAULT_DEADMAN;
    now |= in->din & EXH_DIN_WATCHDOG ? 0u : EXH_FAULT_WATCHDOG;
    now |= in->din & EXH_DIN_CARDS ? 0u : EXH_FAULT_CARD;
    for (unsigned k = 0; k < in->fingers; k++) {
        now |= in->din >> (8 + k) & 1 ? 0u : EXH_FAULT_DRIVE;
    }
    return now;
}

/* Rules for any input. The gate opens only by RUN, a small force and a ramp. A cause shuts an open
 * gate in its tick. Only CLEAR leaves FAULT, without a cause, and after the dead-man switch was
 * open since the last other cause. The first cause does not change. A release ends after its ticks.
 */
static void check_step(const struct exh_safety *old, const struct exh_safety *s,
    const struct exh_safety_in *in, uint32_t now, struct memory *m)
{
    const int was_open = exh_safety_is_open(old), open = exh_safety_is_open(s);
    CHECK(s->present == now, "present %" PRIx32 " not %" PRIx32, s->present, now);
    CHECK(s->state < EXH_STATES, "state %d", s->state);
    CHECK(!open || was_open || (old->state == EXH_STATE_ARM && !now && in->ready == EXH_ARM_ALL),
        "opened from %d", old->state);
    CHECK(!open || !(now & EXH_FAULT_CUT), "open with %" PRIx32, now);
    CHECK(!open || !now || s->state == EXH_STATE_RELEASE, "cause in state %d", s->state);
    CHECK(!was_open || !now || s->faults != 0, "cause not latched");
    CHECK(s->faults == 0 || s->state >= EXH_STATE_RELEASE, "latched in state %d", s->state);
    CHECK(s->state != EXH_STATE_FAULT || s->faults != 0, "fault without a cause");
    CHECK((s->faults & old->faults) == old->faults || in->command == EXH_CMD_CLEAR, "forgotten");
    if (old->state == EXH_STATE_FAULT && s->state != EXH_STATE_FAULT) {
        CHECK(s->state == EXH_STATE_OFF && in->command == EXH_CMD_CLEAR && !now && m->opened,
            "left FAULT");
    }
    if (old->faults) {
        CHECK(s->first == old->first && s->first_tick == old->first_tick, "first cause changed");
    }
    if (old->state == EXH_STATE_OFF) {
        CHECK(
            s->state == EXH_STATE_OFF || (s->state == EXH_STATE_ARM && in->command == EXH_CMD_RUN),
            "from OFF to %d", s->state);
    }
    if (now) { m->opened = now == EXH_FAULT_DEADMAN && !(in->din & EXH_DIN_DEADMAN); }
    m->in_release = s->state == EXH_STATE_RELEASE ? m->in_release + 1 + in->missed : 0;
    CHECK(m->in_release < 30 + 4 + 4, "%" PRIu32 " ticks of release", m->in_release);
    CHECK(s->tick == ++m->ticks, "tick %" PRIu32, s->tick);
}

TEST(state_machine_under_any_input)
{
    static const struct exh_safety_par par = {1, 1 << 20, 5, 10, 15};
    struct exh_safety_cfg cfg;
    struct exh_safety s = {0};
    struct memory m = {0, 0, 0, 0};
    uint32_t seen = 0;
    CHECK_EQ_I64(exh_safety_setup(&cfg, &par, (struct exh_period){1, 2000}), 0);
    while (check_case(1)) {
        const struct exh_safety old = s;
        const struct exh_safety_in in = any_in(m.ticks);
        const uint32_t now = causes_of(&in, &m);
        const struct exh_permit p = exh_safety_step(&s, &cfg, in);
        check_step(&old, &s, &in, now, &m);
        CHECK((p.mode != EXH_PERMIT_CLOSED) == exh_safety_is_open(&s), "mode %d", p.mode);
        CHECK(p.share_q30 >= 0 && p.share_q30 <= 1 << 30, "share %" PRId32, p.share_q30);
        s.limits = check_u64() % 64 ? 0 : 1u << check_u64() % EXH_LIMITS;
        seen |= 1u << s.state;
    }
    /* of few cases not all come */
    CHECK(!check_has_all() || check_count < 100000 || seen == (1u << EXH_STATES) - 1,
        "states %" PRIx32, seen);
}

TEST_MAIN("prop/safety", gate_holds_with_any_input, state_machine_under_any_input);
