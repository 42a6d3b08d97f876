/* SPDX-License-Identifier: MIT */
/* The driver of the Sensoray 526 against a scripted bus: EEPROM, calibration, self-test. */
#include "bus.h"
#include "check.h"

#include "cards/s526.h"

#include "exhand/error.h"

static struct exh_s526 card;
static struct exh_card_fault fault;

static int open_with(struct exh_s526_par par)
{
    static const struct exh_s526 nothing;
    card = nothing;
    fault = (struct exh_card_fault){255, 0, 0, 0, 0, 0};
    bus.s526[1].base = 0;
    bus.mm.base = 0;
    bus_clear();
    return exh_s526_open(&card, 0x2C0, 0x11, 0, &par, &fault);
}

static int open_it(void)
{
    const struct exh_s526_par par = EXH_S526_PAR_DEFAULT;
    return open_with(par);
}

static void refused(int err, int want, unsigned phase, unsigned what)
{
    CHECK_EQ_I64(err, want);
    CHECK(fault.phase == phase && fault.what == what, "%s: %s, at %u, got %" PRId32,
        exh_card_phase_text(fault.phase), exh_card_what_text(fault.what), fault.at, fault.got);
    CHECK(bus_safe(), "outputs left on");
}

/* ---- doubles ---------------------------------------------------------------------- */

static int64_t fixed(const uint16_t *word, unsigned frac)
{
    int64_t v = 0;
    CHECK_EQ_I64(exh_s526_double(word, frac, &v), 0);
    return v;
}

/* Patterns written down by hand. */
TEST(doubles_by_example)
{
    const uint16_t d3249[] = {0, 0, 0x6200, 0x40A9}, d32768[] = {0, 0, 0, 0x40E0};
    const uint16_t minus_half[] = {0, 0, 0, 0xBFE0}, third[] = {0x5555, 0x5555, 0x5555, 0x3FD5};
    const uint16_t zero[] = {0, 0, 0, 0x8000}, tiny[] = {1, 0, 0, 0};
    const uint16_t odd[] = {0, 0, 0, 0x3FF8}; /* 1.5 */
    CHECK_EQ_I64(fixed(d3249, 32), INT64_C(3249) << 32);
    CHECK_EQ_I64(fixed(d32768, 32), INT64_C(32768) << 32);
    CHECK_EQ_I64(fixed(minus_half, 32), -(INT64_C(1) << 31));
    CHECK_EQ_I64(fixed(third, 32), INT64_C(1431655765)); /* 2^32 / 3, rounded */
    CHECK_EQ_I64(fixed(zero, 32), 0);
    CHECK_EQ_I64(fixed(tiny, 60), 0);
    CHECK_EQ_I64(fixed(odd, 0), 2);
    CHECK_EQ_I64(fixed(minus_half, 0), -1); /* half away from zero */
}

TEST(doubles_that_are_no_number_or_too_large_are_refused)
{
    const uint16_t infinite[] = {0, 0, 0, 0x7FF0}, nan[] = {1, 0, 0, 0xFFF0};
    const uint16_t erased[] = {0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF};
    uint16_t word[4];
    int64_t v;
    CHECK_EQ_I64(exh_s526_double(infinite, 0, &v), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_s526_double(nan, 0, &v), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_s526_double(erased, 32, &v), -EXH_E_RANGE);
    bus_double(word, 0, 1, 62);
    CHECK_EQ_I64(exh_s526_double(word, 0, &v), -EXH_E_RANGE);
    bus_double(word, 0, (UINT64_C(1) << 53) - 1, 9);
    CHECK_EQ_I64(fixed(word, 0), ((INT64_C(1) << 53) - 1) << 9);
}

/* n * 2^-s is what it is, rounded once. */
TEST(doubles_of_every_size_round_once)
{
    while (check_case(50)) {
        const int32_t n = check_i32_in(-INT32_MAX, INT32_MAX);
        const unsigned s = (unsigned)check_i32_in(0, 40), frac = (unsigned)check_i32_in(0, 30);
        const uint64_t m = (uint64_t)(n < 0 ? -(int64_t)n : n);
        const uint64_t shifted = s > frac ? ((m >> (s - frac - 1)) + 1) >> 1 : m << (frac - s);
        uint16_t word[4];
        bus_double(word, n < 0, m, -(int)s);
        CHECK_EQ_I64(fixed(word, frac), n < 0 ? -(int64_t)shifted : (int64_t)shifted);
    }
}

/* ---- nominal ------------------------------------------------------------------------ */

TEST(a_nominal_card_changes_no_code)
{
    bus_reset();
    CHECK_EQ_I64(open_it(), 0);
    CHECK_EQ_I64(card.id.nominal, 0);
    CHECK_EQ_I64(card.id.c10_sum, 327670);
    for (int32_t raw = 0; raw <= (int32_t)UINT16_MAX; raw++) {
        for (unsigned k = 0; k < 4; k++) {
            CHECK_EQ_I64(exh_s526_da_code(&card.id.da[k], (uint16_t)raw), raw);
        }
        CHECK_EQ_I64(exh_s526_ad_code(&card.id.ad, (int16_t)(raw - 32768)), raw - 32768);
    }
    for (unsigned k = 0; k < 4; k++) { CHECK_EQ_I64(bus.s526[0].da_out[k], 32768); }
}

/* Also where the reference is a little off 10 V and reads accordingly: c10 = its code. */
TEST(a_reference_off_10_V_on_a_nominal_card_changes_no_code)
{
    static const int32_t mV[] = {9801, 9900, 9990, 9998};
    for (unsigned i = 0; i < sizeof mV / sizeof mV[0]; i++) {
        bus_reset();
        bus_double(&bus.s526[0].ee[0x20], 0, (uint64_t)mV[i] * (UINT64_C(1) << 40) / 1000, -40);
        bus.s526[0].ad[8] = (int16_t)((mV[i] * 32768 + 5000) / 10000);
        CHECK_EQ_I64(open_it(), 0);
        for (int32_t raw = -32768; raw <= 32767; raw++) {
            CHECK_EQ_I64(exh_s526_ad_code(&card.id.ad, (int16_t)raw), raw);
        }
    }
}

/* The same if the reference, or the zero, is so high that 10 V is beyond the range. How far is
 * unknown, and a gain computed from it would make every voltage too high. */
TEST(a_reference_beyond_the_range_raises_no_gain)
{
    bus_reset();
    bus_double(&bus.s526[0].ee[0x20], 0, 10199 * (UINT64_C(1) << 40) / 1000, -40);
    CHECK_EQ_I64(open_it(), 0);
    for (int32_t raw = -32768; raw <= 32767; raw++) {
        CHECK_EQ_I64(exh_s526_ad_code(&card.id.ad, (int16_t)raw), raw);
    }
    bus_reset();
    bus.s526[0].ad[9] = 300;
    CHECK_EQ_I64(open_it(), 0);
    for (int32_t raw = -32768; raw <= 32767; raw++) {
        const int32_t want = raw - 300 < -32768 ? -32768 : raw - 300;
        CHECK_EQ_I64(exh_s526_ad_code(&card.id.ad, (int16_t)raw), want);
    }
}

/* ---- calibration --------------------------------------------------------------------- */

/* round half up of num / den, den > 0 */
static int64_t quotient(int64_t num, int64_t den)
{
    const int64_t twice = 2 * num + den;
    return twice >= 0 ? twice / (2 * den) : -((-twice + 2 * den - 1) / (2 * den));
}

/* A D/A with another gain and offset is given the code of the same voltage. */
TEST(da_codes_are_the_voltage_s)
{
    static const int32_t a[] = {3087, 3200, 3249, 3300, 3411}, b[] = {31768, 32700, 32768, 33768};
    for (unsigned i = 0; i < 20; i++) {
        bus_reset();
        bus_double(&bus.s526[0].ee[16], 0, (uint64_t)a[i / 4], 0);
        bus_double(&bus.s526[0].ee[20], 0, (uint64_t)b[i % 4], 0);
        CHECK_EQ_I64(open_it(), 0);
        CHECK_EQ_I64(bus.s526[0].da_out[2], b[i % 4]); /* 0 V */
        for (int32_t raw = 0; raw <= (int32_t)UINT16_MAX; raw += 7) {
            const int64_t v = b[i % 4] + quotient((int64_t)(raw - 32768) * a[i / 4], 3249);
            const int64_t want = v < 0 ? 0 : v > UINT16_MAX ? UINT16_MAX : v;
            CHECK_EQ_I64(exh_s526_da_code(&card.id.da[2], (uint16_t)raw), want);
            CHECK_EQ_I64(exh_s526_da_code(&card.id.da[1], (uint16_t)raw), raw);
        }
    }
}

/* An A/D with an offset and another gain, measured by its references, has the true voltage. */
TEST(ad_codes_are_the_voltage_s)
{
    static const int32_t full[] = {31600, 32200, 32490, 32700}, zero[] = {-300, -7, 0, 1, 60};
    for (unsigned i = 0; i < 20; i++) {
        const int32_t c10 = full[i / 5], c0 = zero[i % 5];
        bus_reset();
        bus.s526[0].ad[8] = (int16_t)c10;
        bus.s526[0].ad[9] = (int16_t)c0;
        CHECK_EQ_I64(open_it(), 0);
        for (int32_t raw = -32768; raw <= 32767; raw += 13) {
            const int64_t v = quotient((int64_t)(raw - c0) * 32768, c10 - c0);
            const int64_t want = v < INT16_MIN ? INT16_MIN : v > INT16_MAX ? INT16_MAX : v;
            CHECK_EQ_I64(exh_s526_ad_code(&card.id.ad, (int16_t)raw), want);
        }
    }
}

TEST(references_are_averaged_and_their_noise_is_bounded)
{
    bus_reset();
    bus.s526[0].ad[8] = 32400;
    bus.s526[0].ad[9] = 20;
    bus.s526[0].ad_noise = 64; /* alternately with and without */
    CHECK_EQ_I64(open_it(), 0);
    CHECK_EQ_I64(card.id.c0_sum, 10 * 20 + 5 * 64);
    CHECK_EQ_I64(card.id.c10_sum, 10 * 32400 + 5 * 64);
    bus_reset();
    bus.s526[0].ad[8] = 32400;
    bus.s526[0].ad_noise = 65;
    refused(open_it(), -EXH_E_IO, EXH_CARD_CALIBRATE, EXH_CARD_REF_NOISE);
}

TEST(half_a_code_of_offset_is_none)
{
    static const int16_t noise[] = {1, -1}, zero[] = {1, -1};
    for (unsigned i = 0; i < 2; i++) {
        bus_reset();
        bus.s526[0].ad_noise = noise[i]; /* 0 and this in turn */
        bus.s526[0].ad[8] = 32700;
        CHECK_EQ_I64(open_it(), 0);
        CHECK_EQ_I64(card.id.c0_sum, 5 * noise[i]);
        CHECK_EQ_I64(card.id.ad.zero_raw_q14, 0);
        bus_reset();
        bus.s526[0].ad[9] = zero[i];
        CHECK_EQ_I64(open_it(), 0);
        CHECK_EQ_I64(card.id.ad.zero_raw_q14, zero[i] * 16384);
    }
}

TEST(implausible_references_are_refused_by_name)
{
    bus_reset();
    bus.s526[0].ad[9] = 329;
    refused(open_it(), -EXH_E_IO, EXH_CARD_CALIBRATE, EXH_CARD_REF_0V);
    CHECK_EQ_I64(fault.got, 3290);
    bus_reset();
    bus.s526[0].ad[8] = 31456;
    refused(open_it(), -EXH_E_IO, EXH_CARD_CALIBRATE, EXH_CARD_REF_10V);
    bus_reset(); /* plausible each, together not */
    bus.s526[0].ad[8] = 31457;
    bus.s526[0].ad[9] = 328;
    bus_double(&bus.s526[0].ee[0x20], 0, 10199 * (UINT64_C(1) << 40) / 1000, -40);
    refused(open_it(), -EXH_E_IO, EXH_CARD_CALIBRATE, EXH_CARD_AD_GAIN);
    bus_reset(); /* the two swapped, as where their bits are */
    bus.s526[0].ad[8] = 0;
    bus.s526[0].ad[9] = 32767;
    refused(open_it(), -EXH_E_IO, EXH_CARD_CALIBRATE, EXH_CARD_REF_0V);
}

/* ---- EEPROM --------------------------------------------------------------------------- */

TEST(a_word_of_the_eeprom_by_example)
{
    unsigned i = 0;
    bus_reset();
    CHECK_EQ_I64(open_it(), 0);
    while (i < bus.n && !(bus.log[i].port == 0x2F4 && bus.log[i].value == (0x23 << 3 | 5))) { i++; }
    bus.n = i + 4;
    CHECK(bus_said(i - 1, "w 2CE 80, w 2F4 11D, r 2CE 80, w 2CE 84, r 2F2 4024"), "otherwise");
}

TEST(garbage_in_the_eeprom_is_refused_by_name)
{
    for (unsigned k = 0; k < 4; k++) {
        bus_reset();
        bus_double(&bus.s526[0].ee[8 * k], k & 1, k & 1 ? 3249 : 3086, 0);
        refused(open_it(), -EXH_E_IO, EXH_CARD_EEPROM, EXH_CARD_DA_GAIN);
        CHECK_EQ_I64(fault.at, k);
        CHECK_EQ_I64(fault.got, k & 1 ? -3249000 : 3086000);
        bus_reset();
        bus_double(&bus.s526[0].ee[8 * k + 4], 0, 0, 0);
        refused(open_it(), -EXH_E_IO, EXH_CARD_EEPROM, EXH_CARD_DA_OFFSET);
        CHECK_EQ_I64(fault.at, k);
    }
    bus_reset();
    bus_double(&bus.s526[0].ee[0x20], 0, 5, 0);
    refused(open_it(), -EXH_E_IO, EXH_CARD_EEPROM, EXH_CARD_AD_VREF);
    CHECK_EQ_I64(fault.got, 5000000);
    bus_reset();
    bus_double(&bus.s526[0].ee[0], 1, 3000000, 0); /* too low to be printed */
    refused(open_it(), -EXH_E_IO, EXH_CARD_EEPROM, EXH_CARD_DA_GAIN);
    CHECK_EQ_I64(fault.got, INT32_MIN);
    bus_reset();
    memset(bus.s526[0].ee, 0xFF, sizeof bus.s526[0].ee);
    refused(open_it(), -EXH_E_IO, EXH_CARD_EEPROM, EXH_CARD_DA_GAIN);
    CHECK_EQ_I64(fault.got, INT32_MAX);
}

TEST(nominal_values_only_where_the_configuration_says_so)
{
    struct exh_s526_par par = EXH_S526_PAR_DEFAULT;
    par.nominal = 1;
    bus_reset();
    bus_double(&bus.s526[0].ee[8], 0, 3200, 0); /* D/A 1 is not nominal, and in order */
    memset(&bus.s526[0].ee[16], 0xFF, 8);       /* D/A 2's gain is garbage */
    memset(&bus.s526[0].ee[0x20], 0, 8);        /* and the reference */
    CHECK_EQ_I64(open_with(par), 0);
    CHECK_EQ_I64(card.id.nominal, 0x14);
    CHECK_EQ_I64(exh_s526_da_code(&card.id.da[1], 32768 + 3249), 32768 + 3200);
    CHECK_EQ_I64(exh_s526_da_code(&card.id.da[2], 32768 + 3249), 32768 + 3249);
    CHECK_EQ_I64(card.id.vref_V_q32, INT64_C(10) << 32);
}

/* ---- detect and self-test --------------------------------------------------------------- */

TEST(an_empty_port_is_read_once_and_not_written)
{
    bus_reset();
    bus.s526[0].base = 0;
    refused(open_it(), -EXH_E_ABSENT, EXH_CARD_DETECT, EXH_CARD_EMPTY);
    CHECK(bus_said(0, "r 2F4 FFFF"), "more than one look");
}

TEST(another_card_is_not_written)
{
    bus_reset();
    bus.s526[0].signature = 0x526C;
    CHECK_EQ_I64(open_it(), -EXH_E_ABSENT);
    CHECK_EQ_I64(fault.what, EXH_CARD_SIGNATURE);
    CHECK_EQ_I64(fault.got, 0x526C);
    CHECK(bus_said(0, "r 2F4 526C"), "more than one look");
}

/* The first accesses of all: the signature, then safe outputs, then counter 0's preloads, high word
 * first, both, before the load. */
TEST(outputs_are_safe_before_anything_is_tested)
{
    bus_reset();
    CHECK_EQ_I64(open_it(), 0);
    bus.n = 29;
    CHECK(bus_said(0, "r 2F4 526A, w 2CA 800, w 2C4 0, w 2C8 8000, w 2C4 2, w 2C8 8000, w 2C4 4, "
                      "w 2C8 8000, w 2C4 6, w 2C8 8000, w 2C4 1, w 2CA 800, w 2C4 0, w 2C8 8000, "
                      "w 2C4 2, w 2C8 8000, w 2C4 4, w 2C8 8000, w 2C4 6, w 2C8 8000, w 2C4 1, "
                      "r 2CA F, w 2D6 0, w 2D4 5A, w 2D2 33C5, w 2D6 4000, w 2D4 5A, w 2D2 33C5, "
                      "w 2D8 4000"),
        "not in this order");
}

TEST(counters_end_at_zero_counting_x4)
{
    bus_reset();
    memset(bus.s526[0].ecap, 1, 4); /* of whatever was before */
    CHECK_EQ_I64(open_it(), 0);
    for (unsigned k = 0; k < 4; k++) {
        CHECK_EQ_I64(bus.s526[0].ecap[k], 0);
        CHECK_EQ_I64(bus.s526[0].mode[k], 0x0480);
        CHECK_EQ_I64(bus.s526[0].count[k], 0);
    }
}

TEST(a_counter_with_a_dead_bit_is_named)
{
    for (unsigned bit = 0; bit < 24; bit++) {
        bus_reset();
        bus.s526[0].count_stuck = 1u << bit;
        refused(open_it(), -EXH_E_IO, EXH_CARD_SELFTEST, EXH_CARD_COUNTER);
    }
    bus_reset();
    bus.s526[0].mode_stuck = 0x0400;
    refused(open_it(), -EXH_E_IO, EXH_CARD_SELFTEST, EXH_CARD_REGISTER);
    CHECK_EQ_I64(fault.at, 0x16);
}

TEST(an_output_pin_that_stays_active_is_a_fault)
{
    bus_reset();
    bus.s526[0].pins_stuck = 0x20;
    refused(open_it(), -EXH_E_IO, EXH_CARD_SELFTEST, EXH_CARD_LINES);
    CHECK_EQ_I64(fault.got, 0x20);
}

/* ---- waits -------------------------------------------------------------------------------- */

static const struct {
    uint16_t mute;
    uint8_t phase, what;
    uint16_t limit_us;
} silent[] = {{2, EXH_CARD_SELFTEST, EXH_CARD_DA_TIMEOUT, 200},
    {4, EXH_CARD_CALIBRATE, EXH_CARD_AD_TIMEOUT, 500},
    {0x80, EXH_CARD_EEPROM, EXH_CARD_EE_TIMEOUT, 10000}};

TEST(a_flag_that_never_comes_ends_in_time)
{
    for (unsigned i = 0; i < 3; i++) {
        bus_reset();
        bus.s526[0].mute = silent[i].mute;
        refused(open_it(), -EXH_E_IO, silent[i].phase, silent[i].what);
        /* What went before and after are 700 accesses at most. */
        CHECK(bus.time_us >= silent[i].limit_us && bus.time_us <= silent[i].limit_us + 700u,
            "%" PRIu32 " us", bus.time_us);
    }
}

TEST(flags_of_whatever_was_before_are_not_taken_for_an_answer)
{
    for (unsigned i = 0; i < 3; i++) {
        bus_reset();
        bus.s526[0].isr = 0x86;
        bus.s526[0].mute = silent[i].mute;
        refused(open_it(), -EXH_E_IO, silent[i].phase, silent[i].what);
    }
}

/* A scan still ran when it was opened anew: its end is not that of the first reference. */
TEST(a_scan_that_ends_while_it_is_opened_is_not_taken_for_a_reference)
{
    unsigned i = 0;
    bus_reset();
    bus.s526[0].settle_us = 15;
    bus.s526[0].channel_us = 10;
    bus.s526[0].done_us = 150;
    bus.s526[0].wait = UINT16_MAX;
    CHECK_EQ_I64(open_it(), 0);
    while (i < bus.n && !(bus.log[i].port == 0x2C6 && bus.log[i].value == 0xE001)) { i++; }
    CHECK(bus.log[i + 1].port == 0x2CE && !(bus.log[i + 1].value & 4), "%X",
        (unsigned)bus.log[i + 1].value);
}

TEST(and_by_polls_where_time_stands_still)
{
    for (unsigned i = 0; i < 3; i++) {
        bus_reset();
        bus.stopped = 1;
        bus.s526[0].mute = silent[i].mute;
        refused(open_it(), -EXH_E_IO, silent[i].phase, silent[i].what);
        CHECK(bus.n <= 16u * silent[i].limit_us + 700, "%u accesses", bus.n);
    }
}

/* A wait that was interrupted for longer than the limit still sees that the card was in time. */
TEST(a_wait_that_was_held_up_polls_once_more)
{
    bus_reset();
    bus.access_us = 5000;
    bus.s526[0].late = 2;
    CHECK_EQ_I64(open_it(), 0);
}

/* From whichever access on: a fault, the card is named, and no write has its outputs on. */
TEST(a_card_that_dies_while_it_is_opened_is_found_dead)
{
    unsigned all;
    bus_reset();
    CHECK_EQ_I64(open_it(), 0);
    all = bus.n;
    for (unsigned from = 1; from < all - 20; from++) { /* the last are writes */
        bus_reset();
        bus.dead_card = 0;
        bus.dead_from = from;
        CHECK_EQ_I64(open_it(), -EXH_E_IO);
        CHECK(fault.what == EXH_CARD_EMPTY, "from access %u: %s: %s", from,
            exh_card_phase_text(fault.phase), exh_card_what_text(fault.what));
    }
}

TEST(settling_may_be_left_out)
{
    struct exh_s526_par par = EXH_S526_PAR_DEFAULT;
    for (unsigned k = 0; k < 2; k++) {
        par.settle = (uint8_t)k;
        bus_reset();
        CHECK_EQ_I64(open_with(par), 0);
        card.ad_mask = 1;
        bus_clear();
        exh_s526_ad_start(&card);
        CHECK(bus_said(0, k ? "w 2C6 8021, " : "w 2C6 21, "), "settle %u", k);
    }
}

TEST_MAIN("s526", doubles_by_example, doubles_that_are_no_number_or_too_large_are_refused,
    doubles_of_every_size_round_once, a_nominal_card_changes_no_code,
    a_reference_off_10_V_on_a_nominal_card_changes_no_code,
    a_reference_beyond_the_range_raises_no_gain, da_codes_are_the_voltage_s,
    ad_codes_are_the_voltage_s, references_are_averaged_and_their_noise_is_bounded,
    half_a_code_of_offset_is_none, implausible_references_are_refused_by_name,
    a_word_of_the_eeprom_by_example, garbage_in_the_eeprom_is_refused_by_name,
    nominal_values_only_where_the_configuration_says_so, an_empty_port_is_read_once_and_not_written,
    another_card_is_not_written, outputs_are_safe_before_anything_is_tested,
    counters_end_at_zero_counting_x4, a_counter_with_a_dead_bit_is_named,
    an_output_pin_that_stays_active_is_a_fault, a_flag_that_never_comes_ends_in_time,
    flags_of_whatever_was_before_are_not_taken_for_an_answer,
    a_scan_that_ends_while_it_is_opened_is_not_taken_for_a_reference,
    and_by_polls_where_time_stands_still, a_wait_that_was_held_up_polls_once_more,
    a_card_that_dies_while_it_is_opened_is_found_dead, settling_may_be_left_out);
