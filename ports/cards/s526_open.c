/* SPDX-License-Identifier: MIT */
/* Finding, testing and calibrating the card. */
#include "s526_reg.h"
#include "wait.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include <stddef.h>

#define REF_RUNS 10 /* conversions of each reference */
#define GAIN_1   (INT32_C(1) << 30)

/* Plausible values: D/A gain and offset are within 5 % and 1000 codes of nominal. The reference is
 * 10 V +- 2 %. 0 V reads within 1 % of the range of 0. 10 V reads within 4 % of its code, below the
 * end of the range. */
#define DA_GAIN_LO  3087
#define DA_GAIN_HI  3411
#define DA_ZERO_OFF 1000
#define VREF_LO_uV  9800000
#define VREF_HI_uV  10200000
#define REF_0V_OFF  328
#define REF_10V_LO  31457
#define REF_10V_HI  32767
#define AD_GAIN_PPM 50000

/* Largest deviation that cannot be distinguished from nominal: half a code at 0 V, one and a half
 * at the end of the range. There a nominal 10 V reads one code too few, the last of the range. */
#define SAME_ZERO_SUM 5
#define SAME_GAIN_Q30 (3 << 14)

/* --- detect --- */

int exh_s526_is_there(uint16_t base, uint16_t *got)
{
    *got = exh_io_in16((uint16_t)(base + S526_EEC));
    return *got == 0x526A || *got == 0x526B;
}

static int detect(struct exh_s526 *s, struct exh_card_fault *f)
{
    uint16_t got;
    const int is = exh_s526_is_there(s->base, &got);
    f->phase = EXH_CARD_DETECT;
    s->id.signature = got;
    if (is) { return 0; }
    if (got == S526_ALL_ONES) {
        (void)exh_card_fault(f, EXH_CARD_EMPTY, S526_EEC, got, 0, 0);
    } else {
        (void)exh_card_fault(f, EXH_CARD_SIGNATURE, S526_EEC, got, 0x526A, 0x526B);
    }
    return -EXH_E_ABSENT;
}

/* --- self-test --- */

/* Both preloads, the high word first: a load takes now one of them and now the other. */
static void preload(const struct exh_s526 *s, unsigned axis, uint32_t count)
{
    static const uint16_t which[2] = {S526_PRELOAD0, S526_PRELOAD1};
    for (unsigned i = 0; i < 2; i++) {
        s526_out(s, s526_counter(axis, S526_MODE), which[i]); /* and not counting */
        s526_out(s, s526_counter(axis, S526_HIGH), count >> 16);
        s526_out(s, s526_counter(axis, S526_LOW), count & 0xFFFFu);
    }
    s526_out(s, s526_counter(axis, S526_CONTROL), S526_LOAD);
}

/* Loads all counters with different values before it reads the first. So a stopped counter fails,
 * and so does one that answers for its neighbour. */
static int test_counters(const struct exh_s526 *s, uint32_t flip, struct exh_card_fault *f)
{
    static const uint32_t pattern[EXH_S526_AXES] = {0x5A33C5, 0x0FA596, 0xC33C69, 0x3669A0};
    for (unsigned k = 0; k < EXH_S526_AXES; k++) { preload(s, k, pattern[k] ^ flip); }
    for (unsigned k = 0; k < EXH_S526_AXES; k++) {
        const int32_t want = (int32_t)(pattern[k] ^ flip);
        const int32_t got = (int32_t)exh_s526_count(s, k);
        if (got != want) { return exh_card_fault(f, EXH_CARD_COUNTER, k, got, want, want); }
    }
    return 0;
}

/* Counting x4 from 0. */
static int start_counter(const struct exh_s526 *s, unsigned axis, struct exh_card_fault *f)
{
    const unsigned mode = s526_counter(axis, S526_MODE);
    const unsigned control = s526_counter(axis, S526_CONTROL);
    uint16_t got;
    s526_out(s, mode, S526_QUAD_X4);
    got = s526_in(s, mode);
    if (got != S526_QUAD_X4) {
        return exh_card_fault(f, EXH_CARD_REGISTER, mode, got, S526_QUAD_X4, S526_QUAD_X4);
    }
    s526_out(s, control, S526_RESET);
    s526_out(s, control, S526_CAPTURED);
    return 0;
}

static int self_test(struct exh_s526 *s, struct exh_card_fault *f)
{
    uint8_t pins;
    uint16_t isr;
    int err = exh_s526_lines(s, &pins, f);
    f->phase = EXH_CARD_SELFTEST;
    if (err == 0) { err = test_counters(s, 0, f); }
    if (err == 0) { err = test_counters(s, 0xFFFFFF, f); }
    for (unsigned k = 0; k < EXH_S526_AXES && err == 0; k++) { err = start_counter(s, k, f); }
    if (err < 0) { return err; }
    s526_out(s, S526_ISR, S526_DA_DONE | S526_AD_DONE | S526_EE_DONE);
    s526_out(s, S526_DAC, S526_DA_START);
    err = s526_wait(s, S526_DA_DONE, s->par.da_wait_us, EXH_CARD_DA_TIMEOUT, 0, &isr, f);
    s526_out(s, S526_ISR, S526_DA_DONE);
    return err;
}

/* --- EEPROM --- */

static int ee_word(
    const struct exh_s526 *s, unsigned address, uint16_t *word, struct exh_card_fault *f)
{
    uint16_t isr;
    int err;
    s526_out(s, S526_ISR, S526_EE_DONE);
    s526_out(s, S526_EEC, address << 3 | 5u); /* read */
    err = s526_wait(s, S526_EE_DONE, s->par.ee_wait_us, EXH_CARD_EE_TIMEOUT, address, &isr, f);
    /* Also the A/D: a scan of an earlier program may have ended after the self-test. */
    s526_out(s, S526_ISR, S526_EE_DONE | S526_AD_DONE);
    *word = s526_in(s, S526_EED);
    return err;
}

int exh_s526_double(const uint16_t word[4], unsigned frac, int64_t *value)
{
    const unsigned exponent = word[3] >> 4 & 0x7FFu;
    const int negative = word[3] >> 15;
    const int shift = (int)exponent - 1075 + (int)frac;
    int64_t v = (int64_t)(word[3] & 0xFu) << 48 | (int64_t)word[2] << 32 | (int64_t)word[1] << 16 |
                (int64_t)word[0];
    *value = 0;
    if (exponent == 0x7FF || shift > 9) { return -EXH_E_RANGE; }
    if (exponent == 0 || shift < -53) { return 0; } /* less than half, however small */
    v += INT64_C(1) << 52;
    if (shift > 0) { v <<= shift; }
    if (shift < 0) { v = exh_shr_round(v, (unsigned)-shift); }
    *value = negative ? -v : v;
    return 0;
}

/* A double of the EEPROM, in q32; *garbage: no number. */
static int ee_double(const struct exh_s526 *s, unsigned address, int64_t *q32, int *garbage,
    struct exh_card_fault *f)
{
    uint16_t word[4] = {0, 0, 0, 0};
    int err = 0;
    for (unsigned i = 0; i < 4 && err == 0; i++) { err = ee_word(s, address + i, &word[i], f); }
    *garbage = exh_s526_double(word, 32, q32) < 0;
    if (*garbage) { *q32 = INT64_MAX; }
    return err;
}

/* A value for a report, in the unit's given part, cut to 32 bits. */
static int32_t told(int64_t q32, int32_t parts)
{
    const int64_t limit_q32 = INT64_C(2000) << 32; /* times a million, 31 bits */
    const int64_t most = parts > 1000 ? limit_q32 : limit_q32 * 1000;
    if (q32 > most || q32 < -most) { return q32 > 0 ? INT32_MAX : INT32_MIN; }
    return exh_sat32(exh_shr_round(exh_shr_round(q32, 16) * parts, 16));
}

/* Outside lo..hi: a fault, or 1 if nominal values may replace it. */
static int check(const struct exh_s526 *s, unsigned what, unsigned at, int64_t q32, int32_t parts,
    int32_t lo, int32_t hi, struct exh_card_fault *f)
{
    const int32_t got = told(q32, parts);
    if (got >= lo && got <= hi) { return 0; }
    if (s->par.nominal) { return 1; }
    return exh_card_fault(f, what, at, got, lo, hi);
}

static int da_from_eeprom(struct exh_s526 *s, unsigned k, struct exh_card_fault *f)
{
    const struct exh_s526_da nominal = {GAIN_1, 0};
    int64_t a_q32, b_q32;
    int bad, err;
    s->id.da[k] = nominal;
    err = ee_double(s, 8 * k, &a_q32, &bad, f);
    if (err == 0) { err = ee_double(s, 8 * k + 4, &b_q32, &bad, f); }
    if (err < 0) { return err; }
    err = check(s, EXH_CARD_DA_GAIN, k, a_q32, 1000, DA_GAIN_LO * 1000, DA_GAIN_HI * 1000, f);
    if (err == 0) {
        err = check(s, EXH_CARD_DA_OFFSET, k, b_q32, 1000, (EXH_S526_DA_ZERO - DA_ZERO_OFF) * 1000,
            (EXH_S526_DA_ZERO + DA_ZERO_OFF) * 1000, f);
    }
    if (err > 0) { s->id.nominal |= (uint8_t)(1u << k); }
    if (err != 0) { return err < 0 ? err : 0; }
    /* To half up: 3249 * 4 is even. */
    s->id.da[k].gain_q30 =
        (int32_t)exh_udiv64((uint64_t)a_q32 + EXH_S526_DA_PERV * 2, EXH_S526_DA_PERV * 4, NULL);
    s->id.da[k].zero_raw_q14 =
        (int32_t)exh_shr_round(b_q32 - ((int64_t)EXH_S526_DA_ZERO << 32), 32 - 14);
    return 0;
}

static int eeprom(struct exh_s526 *s, struct exh_card_fault *f)
{
    int garbage, err = 0;
    f->phase = EXH_CARD_EEPROM;
    for (unsigned k = 0; k < EXH_S526_AXES && err == 0; k++) {
        err = da_from_eeprom(s, k, f);
        s->da_zero_raw[k] = exh_s526_da_code(&s->id.da[k], EXH_S526_DA_ZERO);
    }
    if (err == 0) { err = ee_double(s, 0x20, &s->id.vref_V_q32, &garbage, f); }
    if (err < 0) { return err; }
    err = check(s, EXH_CARD_AD_VREF, 0, s->id.vref_V_q32, 1000000, VREF_LO_uV, VREF_HI_uV, f);
    if (err > 0) {
        s->id.vref_V_q32 = INT64_C(10) << 32;
        s->id.nominal |= 1u << EXH_S526_AXES;
    }
    return err < 0 ? err : 0;
}

/* --- the A/D's references --- */

struct sum {
    int32_t sum, lo, hi;
};

static void add(struct sum *c, int16_t code)
{
    c->sum += code;
    c->lo = code < c->lo ? code : c->lo;
    c->hi = code > c->hi ? code : c->hi;
}

static int references(
    const struct exh_s526 *s, struct sum *c0, struct sum *c10, struct exh_card_fault *f)
{
    for (int run = 0; run < REF_RUNS; run++) {
        uint16_t isr;
        int err;
        s526_out(s, S526_ADC,
            S526_AD_SETTLE | S526_AD_CONVERT0 << S526_AD_0V | S526_AD_CONVERT0 << S526_AD_10V |
                S526_AD_START);
        err = s526_wait(s, S526_AD_DONE, s->par.ad_wait_us, EXH_CARD_AD_TIMEOUT, 0, &isr, f);
        s526_out(s, S526_ISR, S526_AD_DONE);
        if (err < 0) { return err; }
        s526_out(s, S526_ADC, S526_AD_0V << 1);
        add(c0, s526_result(s));
        s526_out(s, S526_ADC, S526_AD_10V << 1);
        add(c10, s526_result(s));
    }
    return 0;
}

/* Reference r within its range and quiet? */
static int believe(const struct exh_s526 *s, const struct sum *c, unsigned what, unsigned at,
    int32_t lo, int32_t hi, struct exh_card_fault *f)
{
    if (c->sum < lo * REF_RUNS || c->sum > hi * REF_RUNS) {
        return exh_card_fault(f, what, at, c->sum, lo * REF_RUNS, hi * REF_RUNS);
    }
    if (c->hi - c->lo > s->par.noise_raw) {
        return exh_card_fault(f, EXH_CARD_REF_NOISE, at, c->hi - c->lo, 0, s->par.noise_raw);
    }
    return 0;
}

static int calibrate(struct exh_s526 *s, struct exh_card_fault *f)
{
    struct sum c0 = {0, INT16_MAX, INT16_MIN}, c10 = c0;
    int64_t gain_q30, ppm;
    int err;
    f->phase = EXH_CARD_CALIBRATE;
    err = references(s, &c0, &c10, f);
    if (err == 0) {
        err = believe(s, &c0, EXH_CARD_REF_0V, S526_AD_0V, -REF_0V_OFF, REF_0V_OFF, f);
    }
    if (err == 0) {
        err = believe(s, &c10, EXH_CARD_REF_10V, S526_AD_10V, REF_10V_LO, REF_10V_HI, f);
    }
    if (err < 0) { return err; }
    /* Vref / 10 V * 32768 / (c10 - c0), these the means of ten. */
    gain_q30 = (int64_t)exh_udiv64((uint64_t)exh_shr_round(s->id.vref_V_q32, 8) << (15 + 30 - 24),
        (uint64_t)(c10.sum - c0.sum), NULL);
    ppm = exh_shr_round((gain_q30 - GAIN_1) * 1000000, 30);
    if (ppm < -AD_GAIN_PPM || ppm > AD_GAIN_PPM) {
        return exh_card_fault(f, EXH_CARD_AD_GAIN, 0, (int32_t)ppm, -AD_GAIN_PPM, AD_GAIN_PPM);
    }
    /* At the end of the range 10 V may be any more than that: the gain is this or less. */
    if (c10.hi == INT16_MAX && gain_q30 > GAIN_1) { gain_q30 = GAIN_1; }
    if (gain_q30 >= GAIN_1 - SAME_GAIN_Q30 && gain_q30 <= GAIN_1 + SAME_GAIN_Q30) {
        gain_q30 = GAIN_1;
    }
    s->id.ad.gain_q30 = (int32_t)gain_q30;
    s->id.ad.zero_raw_q14 = 0;
    if (c0.sum < -SAME_ZERO_SUM || c0.sum > SAME_ZERO_SUM) {
        s->id.ad.zero_raw_q14 = c0.sum * (1 << 14) / REF_RUNS;
    }
    s->id.c0_sum = c0.sum;
    s->id.c10_sum = c10.sum;
    return 0;
}

int exh_s526_open(struct exh_s526 *s, uint16_t base, unsigned ad_mask, unsigned lines_off,
    const struct exh_s526_par *par, struct exh_card_fault *f)
{
    int err;
    s->base = base;
    s->ad_mask = ad_mask;
    s->lines_off = (uint8_t)(lines_off & S526_DIO_LINES);
    s->par = *par;
    s->id.nominal = 0;
    s->da_sent = s->quad_next = s->counted = s->lines_kept = 0;
    s->ad_first = 1;
    for (unsigned k = 0; k < EXH_S526_AXES; k++) {
        s->da_zero_raw[k] = EXH_S526_DA_ZERO;
        s->quad[k] = 0;
    }
    err = detect(s, f);
    if (err < 0) { return err; }
    s->live = 1;
    exh_s526_safe(s, 1); /* whatever ran before */
    err = self_test(s, f);
    if (err == 0) { err = eeprom(s, f); }
    if (err == 0) { err = calibrate(s, f); }
    exh_s526_safe(s, 1);                                    /* with its own codes of 0 V */
    if (err < 0 && s526_in(s, S526_EEC) == S526_ALL_ONES) { /* the card has failed since */
        return exh_card_fault(f, EXH_CARD_EMPTY, S526_EEC, S526_ALL_ONES, 0, 0);
    }
    return err;
}
