/* SPDX-License-Identifier: MIT */
/* Noise instead of all modules before the gate, and in memory. No code leaves the span above its
 * zero. A shut gate gives only zero codes. Only drives in use are enabled. After drive.h the force
 * keeps its slew limit. */
#include "exhand/exhand.h"

#include "check.h"

#define N EXH_FINGERS

static struct exh_knot knot[3];
static struct exh_drive_par par[N];
static struct exh_drive_cfg cfg[N];
static struct exh_safety box;
static struct exh_current_ledger i[N];
static struct exh_force_ledger f[N];
static uint32_t limits[N];
static struct exh_drive_out out;

static void noise(void *at, size_t n)
{
    uint8_t *p = at;
    for (size_t k = 0; k < n; k++) { p[k] = (uint8_t)(check_u64() >> 56); }
}

/* Noise that is at an end of the range as often as anywhere. */
static int64_t any64(void)
{
    const uint64_t how = check_u64() % 8;
    return how == 0 ? INT64_MIN : how == 1 ? INT64_MAX : how < 4 ? check_i32() : check_i64();
}

/* Parameters as exh_drive_setup() lets them pass. */
static int any_drives(void)
{
    const struct exh_table t = {knot, 3}, none = {NULL, 0};
    const struct exh_period T = {1, (uint32_t)check_i32_in(1, 20000)};
    int err = 0;
    knot[0] = (struct exh_knot){-check_i32_in(1, 1 << 20), -check_i32_in(1, 1 << 20), {0, 0}};
    knot[1] = (struct exh_knot){0, 0, {0, 0}};
    knot[2] =
        (struct exh_knot){check_i32_in(1 << 20, 1 << 28), check_i32_in(1 << 20, 1 << 29), {0, 0}};
    err = exh_table_setup(knot, 3);
    for (unsigned k = 0; k < N; k++) {
        int32_t *field = &par[k].f_max_N_q20;
        for (unsigned r = 0; r < EXH_DRIVE_ROWS; r++) {
            field[r] = check_u64() % 4 ? exh_drive_rows[r].dflt
                                       : check_i32_in(exh_drive_rows[r].min, exh_drive_rows[r].max);
        }
        if (par[k].i_cont_A_q26 > par[k].i_peak_A_q26) {
            par[k].i_cont_A_q26 = par[k].i_peak_A_q26;
        }
        if (err == 0) { err = exh_drive_setup(&cfg[k], &par[k], T, t, none); }
    }
    return err;
}

static int is_open(const struct exh_safety *s)
{
    return s->state == EXH_STATE_RUN || s->state == EXH_STATE_LIMIT ||
           s->state == EXH_STATE_RELEASE || (s->state == EXH_STATE_ARM && s->share_q30 > 0);
}

/* The state of the box as memory may have it: any bytes, or as good as sound. */
static void any_box(void)
{
    noise(&box, sizeof box);
    box.fingers = N;
    if (check_u64() % 2) { box.state = (uint8_t)(check_u64() % EXH_STATES); }
    if (check_u64() % 2) { box.faults = box.late = 0; }
    box.share_q30 = check_i32();
}

static void check_codes(unsigned n, int open)
{
    for (unsigned k = 0; k < N; k++) {
        const int32_t zero = par[k < n ? k : 0].dac_zero_raw;
        const int32_t off = (int32_t)out.dac_raw[k] - zero;
        const int32_t span = k < n && open ? par[k].dac_span_raw : 0;
        CHECK(off >= -span && off <= span, "finger %u of %u: %" PRId32 " codes of %" PRId32, k, n,
            off, span);
    }
    CHECK(out.enable == (open ? (1u << n) - 1u : 0u), "enable %x of %u", out.enable, n);
}

TEST(gate_before_noise)
{
    uint64_t shut = 0, cases = 0;
    CHECK_EQ_I64(any_drives(), 0);
    while (check_case(1)) {
        const unsigned n = 1 + (unsigned)(check_u64() % N);
        int open;
        if (check_u64() % 16 == 0 && any_drives() < 0) { continue; }
        any_box();
        noise(limits, sizeof limits);
        noise(&out, sizeof out);
        for (unsigned k = 0; k < N; k++) {
            i[k].table_A_q26 = any64();
            i[k].peak_A_q26 = any64();
            i[k].i2t_A_q26 = any64();
            i[k].gate_A_q26 = any64();
            i[k].dac_A_q26 = any64();
            i[k].coded_A_q26 = check_i32();
        }
        open = is_open(&box);
        exh_gate_step(&box, cfg, n, i, limits, &out);
        check_codes(n, open);
        shut += !open;
        cases++;
    }
    CHECK(cases < 100 || (shut > cases / 10 && shut < cases / 10 * 9), "%d of %d shut", (int)shut,
        (int)cases);
}

/* The state of a drive from noise, as it comes out of a log. */
static void any_drive(struct exh_drive *s)
{
    uint8_t bytes[32] = {0};
    struct exh_bytes c = exh_bytes_reader(bytes, sizeof bytes);
    noise(bytes, sizeof bytes);
    exh_drive_serialize(&c, s);
}

static void any_law(struct exh_force_ledger *l)
{
    l->spring_N_q20 = any64();
    l->damper_N_q20 = any64();
    l->pullback_N_q20 = any64();
    l->passivity_N_q20 = any64();
}

/* |change| is within slew * T, rounded, or 1 LSB. */
static int64_t slew_step(const struct exh_drive_cfg *c, int32_t slew_Nps)
{
    const int64_t step = exh_gain_mul(c->tick_N_q20, slew_Nps);
    return step > 1 ? step : 1;
}

static void check_force(
    unsigned k, const struct exh_permit *p, int32_t before, int32_t fall, const struct exh_drive *s)
{
    const int64_t change = (int64_t)f[k].force_N_q20 - before;
    const int64_t top =
        par[k].f_max_N_q20 < cfg[k].f_top_N_q20 ? par[k].f_max_N_q20 : cfg[k].f_top_N_q20;
    CHECK(f[k].force_N_q20 >= 0, "push: %" PRId32, f[k].force_N_q20);
    CHECK(change <= 0 || f[k].force_N_q20 <= top, "%" PRId32 " N q20", f[k].force_N_q20);
    CHECK(s->force_N_q20 == f[k].force_N_q20, "state");
    if (p->mode == EXH_PERMIT_OPEN) {
        CHECK(change <= slew_step(&cfg[k], par[k].slew_up_Nps), "rise by %" PRId64, change);
        CHECK(-change <= slew_step(&cfg[k], par[k].slew_down_Nps), "fall by %" PRId64, -change);
    } else if (p->mode == EXH_PERMIT_RELEASE) {
        const int64_t step = fall > 0 ? fall : exh_gain_floor(p->fall, before) + 1;
        CHECK(change <= 0, "a release that rises by %" PRId64, change);
        CHECK(before == 0 || change < 0, "a release that stands at %" PRId32, before);
        CHECK(-change <= step * p->ticks, "a release by %" PRId64, -change);
    } else {
        CHECK(f[k].force_N_q20 == 0, "shut: %" PRId32, f[k].force_N_q20);
    }
}

/* Force and current of finger k from noise. */
static void feel(unsigned k, const struct exh_permit *permit)
{
    struct exh_drive s;
    int32_t before, fall;
    int64_t asked;
    any_drive(&s);
    if (s.fall_N_q20 > 0 && check_u64() % 2) { s.fall_N_q20 = 0; }
    any_law(&f[k]);
    before = s.force_N_q20;
    fall = s.fall_N_q20;
    limits[k] = exh_drive_force_step(&s, &cfg[k], permit, &f[k]);
    check_force(k, permit, before, fall, &s);
    limits[k] |= exh_drive_current_step(&s, &cfg[k], &f[k], &i[k]);
    asked = i[k].table_A_q26 + i[k].peak_A_q26 + i[k].i2t_A_q26;
    CHECK(
        asked <= par[k].i_peak_A_q26 && asked >= -par[k].i_peak_A_q26, "%" PRId64 " A q26", asked);
    CHECK(s.i2t_q32 >= 0, "heat %" PRId64, s.i2t_q32);
}

TEST(state_force_current_and_gate_before_noise)
{
    static const struct exh_safety_par safety_par = {1, 1 << 20, 5, 10, 15};
    struct exh_safety_cfg safety;
    uint32_t modes[3] = {0, 0, 0};
    CHECK_EQ_I64(any_drives(), 0);
    CHECK_EQ_I64(exh_safety_setup(&safety, &safety_par, (struct exh_period){1, 2000}), 0);
    while (check_case(2)) {
        const unsigned n = 1 + (unsigned)(check_u64() % N);
        struct exh_safety_in in;
        struct exh_permit permit;
        if (check_u64() % 16 == 0 && any_drives() < 0) { continue; }
        any_box();
        noise(&in, sizeof in);
        if (check_u64() % 4) {
            in.din = UINT32_MAX;
            in.raised = in.missed = 0;
        }
        in.fingers = (uint8_t)n;
        permit = exh_safety_step(&box, &safety, in);
        CHECK(permit.mode <= EXH_PERMIT_RELEASE && box.state < EXH_STATES, "mode %d", permit.mode);
        CHECK(permit.mode == EXH_PERMIT_CLOSED || !(box.present & EXH_FAULT_CUT),
            "open with %" PRIx32, box.present);
        for (unsigned k = 0; k < n; k++) { feel(k, &permit); }
        exh_gate_step(&box, cfg, n, i, limits, &out);
        check_codes(n, permit.mode != EXH_PERMIT_CLOSED);
        modes[permit.mode]++;
    }
    CHECK(modes[0] + modes[1] + modes[2] < 1000 || (modes[0] && modes[1] && modes[2]),
        "%" PRIu32 " closed, %" PRIu32 " open, %" PRIu32 " releasing", modes[0], modes[1],
        modes[2]);
}

TEST_MAIN("prop/noise", gate_before_noise, state_force_current_and_gate_before_noise);
