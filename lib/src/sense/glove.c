/* SPDX-License-Identifier: MIT */
/* Glove frame to joint angles: fault detection, low-pass, quantizer, calibration. */
#include "exhand/glove.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include "quantizer_tick.h"

#define FC_MIN_HZ_Q16    EXH_Q(1, 10, 16)
#define FC_MAX_HZ_Q16    EXH_Q(10000, 1, 16)
#define HYST_MAX_RAW_Q16 EXH_Q(4096, 1, 16)
#define MARGIN_MAX_Q16   EXH_Q(8, 1, 16)

/* Finger movements stay below about 10 Hz, and the delay of the filter adds to the required warning
 * time. Delay times noise bandwidth is 1/4 for first and second order. So order 2 is used for its
 * flat pass band. At 30 Hz it delays by 7.5 ms and passes 18 % of white noise sampled at 2 kHz. The
 * noise of the paper, 6.1 mV peak to peak, is 20 codes. A hysteresis of 20 codes keeps its 11 bits
 * stable at every rate, filtered or not. */
const struct exh_signal exh_glove_rows[EXH_GLOVE_ROWS] = {
    {0x0901, 0, EXH_WHEN_SETUP, 0, 2, 2, "glove_order", "",
        "order of the glove's low-pass, 0 = none"},
    {0x0902, 16, EXH_WHEN_SETUP, FC_MIN_HZ_Q16, FC_MAX_HZ_Q16, EXH_Q(30, 1, 16), "glove_fc", "hz",
        "its cut-off, below half the glove's rate"},
    {0x0903, 0, EXH_WHEN_SETUP, 1, 24, 11, "glove_bits", "", "stable bits of the card's range"},
    {0x0904, 16, EXH_WHEN_SETUP, 0, HYST_MAX_RAW_Q16, EXH_Q(20, 1, 16), "glove_hyst", "",
        "hysteresis, A/D codes: the noise, peak to peak"},
    {0x0905, 0, EXH_WHEN_SETUP, INT16_MIN, INT16_MAX, -32000, "glove_low", "",
        "A/D code at or below: lower rail"},
    {0x0906, 0, EXH_WHEN_SETUP, INT16_MIN, INT16_MAX, 32000, "glove_high", "",
        "A/D code at or above: upper rail"},
    {0x0907, 0, EXH_WHEN_SETUP, 0, 1, 1, "glove_open_high", "",
        "1: an open wire reads high, a short low"},
    {0x0908, 0, EXH_WHEN_SETUP, 1, 255, 3, "glove_debounce", "",
        "frames in a row that make and end a fault"},
    {0x0909, 16, EXH_WHEN_SETUP, 0, MARGIN_MAX_Q16, EXH_Q(1, 2, 16), "glove_margin", "",
        "share of the calibrated span that a code may leave it by"},
};

const char *exh_glove_cause_text(unsigned cause)
{
    static const char *const text[EXH_GLOVE_CAUSES] = {"good", "open", "short", "out of range"};
    return cause < EXH_GLOVE_CAUSES ? text[cause] : "unknown";
}

/* --- set-up --- */

/* Computes the accepted codes of each sensor: its span and margin, within the rails. A span between
 * the rails also proves their order. */
static int limits(struct exh_glove_cfg *cfg, const struct exh_glove_par *par)
{
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *s = &cfg->cal->sensor[i];
        const int32_t margin =
            (int32_t)exh_mul_shr((int32_t)s->high_raw - s->low_raw, par->margin_q16, 16);
        if (!(cfg->cal->present >> i & 1)) { /* ignores an unconnected pin */
            cfg->lo_raw[i] = INT16_MIN;
            cfg->hi_raw[i] = INT16_MAX;
            continue;
        }
        if (s->low_raw <= par->low_raw || s->high_raw >= par->high_raw) { return -EXH_E_RANGE; }
        cfg->lo_raw[i] =
            (int16_t)exh_clamp((int64_t)s->low_raw - margin, par->low_raw + 1, INT16_MAX);
        cfg->hi_raw[i] =
            (int16_t)exh_clamp((int64_t)s->high_raw + margin, INT16_MIN, par->high_raw - 1);
    }
    return 0;
}

int exh_glove_setup(struct exh_glove_cfg *cfg, const struct exh_glove_par *par,
    const struct exh_glove_cal *cal, struct exh_period T)
{
    const struct exh_quantizer_par quantizer = {par->bits, par->hyst_raw_q16};
    const struct exh_filter_par filter = {par->order, par->fc_Hz_q16};
    int err = exh_rows_validate(exh_glove_rows, EXH_GLOVE_ROWS, par)
                  ? exh_glove_cal_validate(cal, NULL)
                  : -EXH_E_RANGE;
    if (err == 0 && par->order > 0) { err = exh_filter_setup(&cfg->filter, &filter, T); }
    if (err == 0) { err = exh_quantizer_setup(&cfg->quantizer, &quantizer); }
    if (err < 0) { return err; }
    cfg->cal = cal;
    cfg->low_raw = (int16_t)par->low_raw;
    cfg->high_raw = (int16_t)par->high_raw;
    cfg->low_cause = par->open_high ? EXH_GLOVE_SHORT : EXH_GLOVE_OPEN;
    cfg->high_cause = par->open_high ? EXH_GLOVE_OPEN : EXH_GLOVE_SHORT;
    cfg->debounce_frames = (uint8_t)par->debounce_frames;
    cfg->order = (uint8_t)par->order;
    cfg->crosses = 0;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const uint8_t *of = cal->sensor[i].of;
        if (of[0] != EXH_GLOVE_NONE || of[1] != EXH_GLOVE_NONE) {
            cfg->crossed[cfg->crosses++] = (uint8_t)i;
        }
    }
    return limits(cfg, par);
}

/* --- acceptance of codes --- */

static uint8_t cause_of(const struct exh_glove_cfg *cfg, unsigned i, int16_t raw)
{
    if (raw >= cfg->lo_raw[i] && raw <= cfg->hi_raw[i]) { return EXH_GLOVE_GOOD; }
    if (raw <= cfg->low_raw) { return cfg->low_cause; }
    return raw >= cfg->high_raw ? cfg->high_cause : EXH_GLOVE_OUTSIDE;
}

/* A good code on a channel without rejected codes. */
static int is_plain(
    const struct exh_glove *s, const struct exh_glove_cfg *cfg, unsigned i, int16_t raw)
{
    return raw >= cfg->lo_raw[i] && raw <= cfg->hi_raw[i] && (s->run[i] | s->cause[i]) == 0;
}

/* Processes any code. */
static void judge(struct exh_glove *s, const struct exh_glove_cfg *cfg, unsigned i, int16_t raw)
{
    const uint8_t now = cause_of(cfg, i, raw);
    const int faulty = s->cause[i] != EXH_GLOVE_GOOD, bad = now != EXH_GLOVE_GOOD;
    if (faulty && bad) { s->cause[i] = now; } /* report the latest cause */
    if (faulty == bad) {
        s->run[i] = 0;
    } else if (s->run[i] + 1 < cfg->debounce_frames) {
        s->run[i]++;
    } else {
        s->run[i] = 0;
        s->cause[i] = now;
        if (bad && s->faults[i] < UINT16_MAX) { s->faults[i]++; }
    }
    if (!bad && s->cause[i] == EXH_GLOVE_GOOD) { s->good_raw[i] = raw; }
}

/* The first frame: there is no good code yet. */
static void start(
    struct exh_glove *s, const struct exh_glove_cfg *cfg, const struct exh_glove_in *in)
{
    int32_t x_raw_q16[EXH_GLOVE_SENSORS];
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *cal = &cfg->cal->sensor[i];
        s->cause[i] = cause_of(cfg, i, in->raw[i]);
        s->faults[i] = s->cause[i] != EXH_GLOVE_GOOD;
        s->run[i] = 0;
        s->quantizer[i] = (struct exh_quantizer){0, 0};
        s->good_raw[i] =
            s->cause[i] == EXH_GLOVE_GOOD
                ? in->raw[i]
                : (int16_t)exh_clamp(cal->zero_raw_q15 >> EXH_Q_ZERO, cal->low_raw, cal->high_raw);
        x_raw_q16[i] = s->good_raw[i] * (INT32_C(1) << EXH_Q_RAW);
    }
    exh_filter_reset(s->filter, x_raw_q16, EXH_GLOVE_SENSORS);
    s->started = 1;
}

/* --- the tick --- */

uint32_t exh_glove_believe(struct exh_glove *s, const struct exh_glove_cfg *cfg,
    const struct exh_glove_in *in, int32_t *code_raw_q16)
{
    uint32_t faulty = 0;
    unsigned i = 0;
    if (!s->started) { start(s, cfg, in); }
    for (; i < EXH_GLOVE_SENSORS && is_plain(s, cfg, i, in->raw[i]); i++) {
        s->good_raw[i] = in->raw[i];
        code_raw_q16[i] = in->raw[i] * (INT32_C(1) << EXH_Q_RAW);
    }
    for (; i < EXH_GLOVE_SENSORS; i++) { /* from the first that is not plain */
        judge(s, cfg, i, in->raw[i]);
        faulty |= (uint32_t)(s->cause[i] != EXH_GLOVE_GOOD) << i;
        code_raw_q16[i] = s->good_raw[i] * (INT32_C(1) << EXH_Q_RAW);
    }
    return faulty;
}

/* Tests the limit on the high word only, for small CPUs. */
static inline int32_t angle_of(int32_t from_zero_raw_q15, int32_t gain_turnpraw_q38)
{
    const unsigned n = EXH_Q_ZERO + EXH_Q_TPRAW - EXH_Q_TURN;
    const uint32_t half = UINT32_C(1) << (n - 1);
    const int64_t v = (int64_t)from_zero_raw_q15 * gain_turnpraw_q38 + half;
    if ((uint32_t)((uint64_t)v >> 32) + half >= 2 * half) { return exh_sat32(v >> n); }
    return exh_from_u32((uint32_t)((uint64_t)v >> n & UINT32_MAX));
}

void exh_glove_angles(struct exh_glove *s, const struct exh_glove_cfg *cfg, unsigned from,
    unsigned to, int32_t *angle_turn_q32)
{
    const struct exh_glove_sensor *cal = &cfg->cal->sensor[from];
    int32_t *const x = angle_turn_q32; /* codes q16, which become angles */
    if (cfg->order > 0 && from < to) {
        exh_filter_step(&s->filter[from], &cfg->filter, &x[from], &x[from], to - from);
    }
    for (unsigned i = from; i < to; i++, cal++) {
        const int32_t code = quantizer_in_place(&s->quantizer[i], &cfg->quantizer, x[i]);
        /* Half the code, so that the difference to a zero at the far end fits. */
        x[i] = angle_of(exh_wrap_diff(code >> 1, cal->zero_raw_q15), cal->gain_turnpraw_q38);
    }
}

void exh_glove_cross(const struct exh_glove_cfg *cfg, int32_t *angle_turn_q32)
{
    for (unsigned n = 0; n < cfg->crosses && n < EXH_GLOVE_SENSORS; n++) {
        const unsigned i = cfg->crossed[n] < EXH_GLOVE_SENSORS ? cfg->crossed[n] : 0;
        const struct exh_glove_sensor *cal = &cfg->cal->sensor[i];
        int64_t sum = angle_turn_q32[i];
        for (unsigned k = 0; k < 2; k++) {
            if (cal->of[k] >= EXH_GLOVE_SENSORS) {
                continue;
            } /* none; or damaged memory, as above */
            sum += exh_mul_shr(angle_turn_q32[cal->of[k]], cal->cross_q30[k], 30);
        }
        angle_turn_q32[i] = exh_sat32(sum);
    }
}

uint32_t exh_glove_step(struct exh_glove *s, const struct exh_glove_cfg *cfg,
    const struct exh_glove_in *in, int32_t *angle_turn_q32)
{
    const uint32_t faulty = exh_glove_believe(s, cfg, in, angle_turn_q32);
    exh_glove_angles(s, cfg, 0, EXH_GLOVE_SENSORS, angle_turn_q32);
    exh_glove_cross(cfg, angle_turn_q32);
    return faulty;
}

void exh_glove_serialize(struct exh_bytes *c, struct exh_glove *s)
{
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        exh_filter_serialize(c, &s->filter[i]);
        exh_quantizer_serialize(c, &s->quantizer[i]);
        exh_bytes_i16(c, &s->good_raw[i]);
        exh_bytes_u16(c, &s->faults[i]);
        exh_bytes_u8(c, &s->run[i]);
        exh_bytes_u8(c, &s->cause[i]);
        if (s->cause[i] >= EXH_GLOVE_CAUSES) { s->cause[i] = EXH_GLOVE_OUTSIDE; }
    }
    exh_bytes_u8(c, &s->started);
}
