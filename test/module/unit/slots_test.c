/* SPDX-License-Identifier: MIT */
/* slots.h: which slot is valid, and the effect of a cut, a wrong bit or foreign bytes. */
#include "exhand/slots.h"

#include "exhand/bytes.h"
#include "exhand/calibrate.h"
#include "exhand/error.h"
#include "exhand/params.h"
#include "exhand/signal.h"

#include "check.h"

#define IMAGE_B 24u
#define SLOT    64u /* B of a slot: more than what is in it */
#define WHOLE   EXH_SLOT_B(IMAGE_B)

static uint8_t slot[2][SLOT];
static uint8_t buf[SLOT];

static void erase(unsigned to) { memset(slot[to], 0xFF, SLOT); }

/* Erased, and the first `cut` bytes of what is to be programmed. */
static void program(unsigned to, uint32_t n, uint32_t cut)
{
    erase(to);
    memcpy(slot[to], buf, cut < n ? cut : n);
}

/* An image that is all `value` in buf, and what is to be programmed of it. */
static int32_t next(unsigned *to, unsigned value)
{
    memset(buf, 0xAA, sizeof buf);
    memset(buf + EXH_SLOT_HEAD_B, (int)value, IMAGE_B);
    return exh_slots_encode(to, slot[0], slot[1], SLOT, buf, sizeof buf, IMAGE_B);
}

static unsigned save(unsigned value)
{
    unsigned to = 9;
    CHECK_EQ_I64(next(&to, value), WHOLE);
    CHECK(to < 2, "slot %u", to);
    program(to & 1, WHOLE, WHOLE);
    return to;
}

/* The slot that counts is `at` with the image `value`. */
static void counts(int at, unsigned value, uint32_t sequence)
{
    struct exh_slot is = {NULL, 0, 0};
    CHECK_EQ_I64(exh_slots_find(&is, slot[0], slot[1], SLOT), at);
    CHECK(is.len_B == IMAGE_B && is.image == slot[at] + EXH_SLOT_HEAD_B && is.image[0] == value &&
              is.image[IMAGE_B - 1] == value && is.sequence == sequence,
        "%lu bytes, sequence %lu", (unsigned long)is.len_B, (unsigned long)is.sequence);
}

/* A slot as a box with this sequence number writes it. It does not use the library's writer. */
static void forge(unsigned at, uint32_t sequence, unsigned value)
{
    struct exh_bytes c = exh_bytes_writer(slot[at], SLOT);
    uint32_t magic = 0x53485845u, len_B = IMAGE_B, crc;
    uint8_t v = (uint8_t)value;
    erase(at);
    exh_bytes_u32(&c, &magic);
    exh_bytes_u32(&c, &sequence);
    exh_bytes_u32(&c, &len_B);
    for (uint32_t i = 0; i < len_B; i++) { exh_bytes_u8(&c, &v); }
    crc = exh_crc32(0, slot[at], c.at);
    exh_bytes_u32(&c, &crc);
    exh_bytes_u32(&c, &sequence);
}

static void begin(void)
{
    erase(0);
    erase(1);
}

TEST(a_worked_example)
{
    static const uint8_t want[] = {
        'E', 'X', 'H', 'S', 1, 0, 0, 0, 9, 0, 0, 0, '1', '2', '3', '4', '5', '6', '7', '8', '9'};
    const uint32_t crc = exh_crc32(0, want, sizeof want);
    unsigned to = 9;
    begin();
    memset(buf, 0xAA, sizeof buf);
    memcpy(buf + EXH_SLOT_HEAD_B, "123456789", 9);
    CHECK_EQ_I64(exh_slots_encode(&to, slot[0], slot[1], SLOT, buf, sizeof buf, 9), 29);
    CHECK(to == 0 && memcmp(buf, want, sizeof want) == 0, "to slot %u", to);
    for (unsigned i = 0; i < 4; i++) { CHECK_EQ_I64(buf[21 + i], crc >> (8 * i) & 255); }
    CHECK(buf[25] == 1 && buf[26] == 0 && buf[27] == 0 && buf[28] == 0, "no sequence at the end");
    CHECK_EQ_I64(buf[29], 0xAA);
}

TEST(blank_slots_have_nothing)
{
    static const uint8_t blank[] = {0xFF, 0x00, 0x55};
    struct exh_slot is = {NULL, 7, 8};
    for (unsigned i = 0; i < sizeof blank; i++) {
        memset(slot, blank[i], sizeof slot);
        CHECK_EQ_I64(exh_slot_decode(&is, slot[0], SLOT), -EXH_E_UNKNOWN);
        CHECK_EQ_I64(exh_slots_find(&is, slot[0], slot[1], SLOT), -EXH_E_ABSENT);
        CHECK(is.image == NULL && is.len_B == 7 && is.sequence == 8, "it was touched");
        CHECK_EQ_I64(save(1), 0);
        counts(0, 1, 1);
    }
}

TEST(each_goes_to_the_other)
{
    begin();
    for (unsigned k = 0; k < 9; k++) {
        CHECK_EQ_I64(save(k), k & 1);
        counts((int)(k & 1), k, k + 1);
    }
}

/* Saving the same values again does not wear out the flash. */
TEST(what_stands_there_is_not_saved_again)
{
    unsigned to = 9;
    begin();
    (void)save(1);
    (void)save(2);
    CHECK_EQ_I64(next(&to, 2), 0);
    CHECK_EQ_I64(to, 1);
    CHECK_EQ_I64(buf[0], 0xAA);
    CHECK_EQ_I64(next(&to, 1), WHOLE); /* the other slot has it, which does not count */
    CHECK_EQ_I64(to, 0);
    for (uint32_t n = IMAGE_B - 1; n <= IMAGE_B + 1; n += 2) { /* the same but for its length */
        memset(buf + EXH_SLOT_HEAD_B, 2, n);
        CHECK_EQ_I64(
            exh_slots_encode(&to, slot[0], slot[1], SLOT, buf, sizeof buf, n), EXH_SLOT_B(n));
    }
    memset(buf + EXH_SLOT_HEAD_B, 2, IMAGE_B);
    buf[EXH_SLOT_HEAD_B + IMAGE_B - 1] = 3;
    CHECK_EQ_I64(exh_slots_encode(&to, slot[0], slot[1], SLOT, buf, sizeof buf, IMAGE_B), WHOLE);
}

TEST(the_sequence_goes_round)
{
    static const uint32_t from[] = {1, 0x7FFFFFFEu, 0x7FFFFFFFu, 0x80000000u, 0x80000001u,
        0xFFFFFFFCu, 0xFFFFFFFDu, 0xFFFFFFFEu};
    for (unsigned i = 0; i < sizeof from / sizeof from[0]; i++) {
        uint32_t sequence = from[i];
        begin();
        forge(1, sequence, 0);
        counts(1, 0, sequence);
        for (unsigned k = 1; k < 6; k++) {
            sequence = sequence == 0xFFFFFFFEu ? 1 : sequence + 1;
            CHECK_EQ_I64(save(k), (k - 1) & 1);
            counts((int)((k - 1) & 1), k, sequence);
        }
    }
}

TEST(the_one_ahead_counts)
{
    static const struct {
        uint32_t a, b;
        int at;
    } v[] = {{5, 6, 1}, {6, 5, 0}, {5, 5, 0}, {0xFFFFFFFEu, 1, 1}, {1, 0xFFFFFFFEu, 0},
        {1, 0x80000000u, 1}, {1, 0x80000001u, 0}, {0x80000001u, 1, 0}, {1, 0x80000002u, 0},
        {0x80000002u, 1, 1}};
    for (unsigned i = 0; i < sizeof v / sizeof v[0]; i++) {
        forge(0, v[i].a, 10);
        forge(1, v[i].b, 11);
        counts(v[i].at, v[i].at ? 11 : 10, v[i].at ? v[i].b : v[i].a);
    }
    forge(0, 5, 10); /* a copy: both are the same, and the next goes to the other */
    forge(1, 5, 10);
    CHECK_EQ_I64(save(1), 1);
    counts(1, 1, 6);
}

/* What blank memory reads as is no sequence, were the CRC right. */
TEST(two_sequences_are_none)
{
    struct exh_slot is;
    forge(0, 0, 1);
    CHECK_EQ_I64(exh_slot_decode(&is, slot[0], SLOT), -EXH_E_CRC);
    forge(0, 0xFFFFFFFFu, 1);
    CHECK_EQ_I64(exh_slot_decode(&is, slot[0], SLOT), -EXH_E_CRC);
    forge(0, 0xFFFFFFFEu, 1);
    CHECK_EQ_I64(exh_slot_decode(&is, slot[0], SLOT), 0);
}

TEST(each_bit_of_one_slot)
{
    begin();
    (void)save(1);
    (void)save(2);
    for (unsigned at = 0; at < 2; at++) {
        for (uint32_t bit = 0; bit < 8 * WHOLE; bit++) {
            slot[at][bit / 8] ^= (uint8_t)(1u << bit % 8);
            counts(at == 0, at == 0 ? 2 : 1, at == 0 ? 2 : 1);
            slot[at][bit / 8] ^= (uint8_t)(1u << bit % 8);
        }
        for (uint32_t i = WHOLE; i < SLOT; i++) { slot[at][i] = 0; } /* beyond the image: ignored */
        counts(1, 2, 2);
    }
}

/* Behind the cut are the old bytes: ones, zeros, or the image before the last. */
TEST(cut_off_at_every_byte)
{
    static const uint32_t from[] = {1, 0xFE, 0xFFFE, 0x00FFFFFEu, 0x7FFFFFFEu, 0xFFFFFFFCu};
    for (unsigned i = 0; i < 3 * sizeof from / sizeof from[0]; i++) {
        const uint32_t older = from[i / 3];
        uint32_t sequence = older == 0xFFFFFFFEu ? 1 : older + 1;
        uint8_t before[SLOT];
        unsigned to;
        forge(0, older, 1);
        memcpy(before, slot[0], SLOT);
        if (i % 3 != 2) { memset(before, i % 3 ? 0x00 : 0xFF, SLOT); }
        forge(1, sequence, 2);
        CHECK_EQ_I64(next(&to, 3), WHOLE);
        CHECK_EQ_I64(to, 0);
        for (uint32_t cut = 0; cut <= WHOLE; cut++) {
            int whole;
            memcpy(slot[0], before, SLOT);
            memcpy(slot[0], buf, cut);
            whole = memcmp(slot[0], buf, WHOLE) == 0; /* the last bytes may have been there */
            CHECK(whole || cut < WHOLE, "never whole");
            counts(!whole, whole ? 3 : 2,
                whole ? (sequence == 0xFFFFFFFEu ? 1 : sequence + 1) : sequence);
        }
    }
}

/* Erased up to a byte from either end; what the box saves next is whole again. */
TEST(cut_off_in_the_erasure)
{
    for (uint32_t cut = 1; cut < 2 * WHOLE; cut++) {
        begin();
        (void)save(1);
        (void)save(2);
        if (cut <= WHOLE) {
            memset(slot[0], 0xFF, cut);
        } else {
            memset(slot[0] + cut - WHOLE, 0xFF, SLOT - (cut - WHOLE));
        }
        counts(1, 2, 2);
        CHECK_EQ_I64(save(3), 0);
        counts(0, 3, 3);
    }
}

TEST(what_does_not_fit_is_refused)
{
    static uint8_t big[SLOT + 1];
    struct exh_slot is = {NULL, 0, 0};
    unsigned to = 9;
    begin();
    memset(big, 0xAA, sizeof big);
    CHECK_EQ_I64(
        exh_slots_encode(&to, slot[0], slot[1], SLOT, big, sizeof big, SLOT - 19), -EXH_E_SHORT);
    CHECK_EQ_I64(exh_slots_encode(&to, slot[0], slot[1], SLOT, big, 30, 11), -EXH_E_SHORT);
    CHECK_EQ_I64(exh_slots_encode(&to, slot[0], slot[1], SLOT, big, 19, 0), -EXH_E_SHORT);
    CHECK_EQ_I64(
        exh_slots_encode(&to, slot[0], slot[1], SLOT, big, sizeof big, SIZE_MAX), -EXH_E_SHORT);
    CHECK_EQ_I64(exh_slots_encode(&to, slot[0], slot[1], SIZE_MAX, big, SIZE_MAX, 1), -EXH_E_SHORT);
    for (uint32_t i = 0; i < sizeof big; i++) { CHECK_EQ_I64(big[i], 0xAA); }
    CHECK_EQ_I64(to, 9);
    CHECK_EQ_I64(exh_slots_encode(&to, slot[0], slot[1], SLOT, big, SLOT, SLOT - 20), SLOT);
    memcpy(slot[0], big, SLOT);
    CHECK_EQ_I64(exh_slot_decode(&is, slot[0], SLOT), 0);
    CHECK_EQ_I64(is.len_B, SLOT - 20);
    for (uint32_t n = 0; n < SLOT; n++) {
        CHECK_EQ_I64(exh_slot_decode(&is, slot[0], n), -EXH_E_SHORT);
    }
    CHECK_EQ_I64(exh_slots_encode(&to, slot[1], slot[1], SLOT, big, SLOT, 0), EXH_SLOT_B(0));
    CHECK_EQ_I64(exh_slot_decode(&is, big, EXH_SLOT_B(0)), 0); /* an image of nothing */
    for (uint32_t n = SLOT - 19; n != 0; n = n > 0xFFFFFFF0u ? n + 1
                                             : n * 2 > n     ? n * 2
                                                             : 0xFFFFFFF1u) {
        for (unsigned k = 0; k < 4; k++) { slot[0][8 + k] = (uint8_t)(n >> (8 * k) & 255); }
        CHECK_EQ_I64(exh_slot_decode(&is, slot[0], SLOT), -EXH_E_SHORT);
    }
}

/* As in the header's example: parameters, and a finger's calibration too. */
static const struct exh_signal row[] = {
    {0x7101, 0, EXH_WHEN_ANY, -1000, 1000, 5, "a", "", "one"},
    {0x7102, 4, EXH_WHEN_ANY, -1000, 1000, 6, "b", "", "another"},
};
static const struct exh_signal_group group = {row, 2, 1};
static const struct exh_signal_table table = {&group, 1};

TEST(parameters_come_back)
{
    static uint8_t flash[2][128], out[128];
    int32_t active[2], staged[2];
    struct exh_params p;
    struct exh_slot is;
    memset(flash, 0xFF, sizeof flash);
    exh_params_setup(&p, &table, active, staged);
    for (int32_t v = -3; v < 4; v++) {
        unsigned to;
        int32_t n;
        CHECK_EQ_I64(exh_params_stage(&p, 0x7101, 0, v), 0);
        n = exh_params_save(&p, out + EXH_SLOT_HEAD_B, sizeof out - EXH_SLOT_B(0));
        n = exh_slots_encode(&to, flash[0], flash[1], sizeof flash[0], out, sizeof out, (size_t)n);
        CHECK(n > 0, "nothing to save: %ld", (long)n);
        memset(flash[to], 0xFF, sizeof flash[0]);
        memcpy(flash[to], out, (size_t)n / 2); /* cut off: the value before */
        exh_params_setup(&p, &table, active, staged);
        if (exh_slots_find(&is, flash[0], flash[1], sizeof flash[0]) >= 0) {
            CHECK_EQ_I64(exh_params_load(&p, is.image, is.len_B, NULL), 0);
        }
        CHECK_EQ_I64(staged[0], v == -3 ? 5 : v - 1);
        memcpy(flash[to], out, (size_t)n);
        CHECK_EQ_I64(exh_slots_find(&is, flash[0], flash[1], sizeof flash[0]), (int)to);
        CHECK_EQ_I64(exh_params_load(&p, is.image, is.len_B, NULL), 0);
        CHECK_EQ_I64(staged[0], v);
    }
}

TEST(a_calibration_comes_back)
{
    static uint8_t flash[2][EXH_SLOT_B(EXH_CALIB_IMAGE_B)], out[sizeof flash[0]];
    struct exh_calib_point point[2] = {{EXH_Q(1, 1, 20), EXH_Q(1, 10, 26), EXH_Q(1, 10, 26), 0},
        {EXH_Q(2, 1, 20), EXH_Q(2, 10, 26), EXH_Q(2, 10, 26), 0}};
    struct exh_calib c = {.device_id = 7,
        .valid_days = 30,
        .dac_rawpA_q16 = 65536,
        .mon_A_q40 = 1 << 20,
        .end_A_q26 = EXH_Q(5, 1, 26),
        .point = point,
        .points = 2,
        .cap = 2};
    struct exh_slot is;
    unsigned to;
    memset(flash, 0xFF, sizeof flash);
    for (uint32_t day = 100; day < 103; day++) {
        int32_t n;
        c.day = day;
        n = exh_calib_save(&c, out + EXH_SLOT_HEAD_B, sizeof out - EXH_SLOT_B(0), NULL);
        CHECK(n > 0, "not saved: %ld", (long)n);
        n = exh_slots_encode(&to, flash[0], flash[1], sizeof flash[0], out, sizeof out, (size_t)n);
        memcpy(flash[to], out, (size_t)n);
        c.day = 0;
        CHECK(exh_slots_find(&is, flash[0], flash[1], sizeof flash[0]) >= 0, "none");
        CHECK_EQ_I64(exh_calib_load(&c, is.image, is.len_B, NULL), 0);
        CHECK_EQ_I64(c.day, day);
    }
}

/* The byte after the image, in either slot, does not belong to it. */
TEST(the_byte_behind_the_image_says_nothing)
{
    unsigned to = 9, at;
    begin();
    at = save(5) & 1u;
    memset(buf, 0, sizeof buf);
    memset(buf + EXH_SLOT_HEAD_B, 5, IMAGE_B);
    for (uint32_t more = 0; more < 2; more++) {
        buf[EXH_SLOT_HEAD_B + IMAGE_B] = (uint8_t)(slot[at][EXH_SLOT_HEAD_B + IMAGE_B] + more);
        CHECK_EQ_I64(exh_slots_encode(&to, slot[0], slot[1], SLOT, buf, sizeof buf, IMAGE_B), 0);
        CHECK_EQ_I64(to, at);
    }
}

/* A slot is at most as long as a length can say. */
TEST(the_longest_slot)
{
    unsigned to = 9;
    begin();
    memset(buf, 1, sizeof buf);
    CHECK_EQ_I64(
        exh_slots_encode(&to, slot[0], slot[1], INT32_MAX, buf, INT32_MAX, IMAGE_B), WHOLE);
    CHECK_EQ_I64(exh_slots_encode(&to, slot[0], slot[1], (size_t)INT32_MAX + 1, buf,
                     (size_t)INT32_MAX + 1, IMAGE_B),
        -EXH_E_SHORT);
}

TEST_MAIN("slots", a_worked_example, blank_slots_have_nothing, each_goes_to_the_other,
    what_stands_there_is_not_saved_again, the_sequence_goes_round, the_one_ahead_counts,
    two_sequences_are_none, each_bit_of_one_slot, cut_off_at_every_byte, cut_off_in_the_erasure,
    what_does_not_fit_is_refused, parameters_come_back, a_calibration_comes_back,
    the_byte_behind_the_image_says_nothing, the_longest_slot);
