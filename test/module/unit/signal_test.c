/* SPDX-License-Identifier: MIT */
/* signal.h and params.h: tables, the one way to change a parameter, and its image. */
#include "exhand/params.h"
#include "exhand/signal.h"

#include "exhand/bytes.h"
#include "exhand/contact.h"
#include "exhand/drive.h"
#include "exhand/error.h"
#include "exhand/quad.h"
#include "exhand/safety.h"
#include "exhand/tracking.h"
#include "exhand/velocity.h"

#include "check.h"

/* Group A: two rows, once. Group B: three rows, twice: values 2..4 and 5..7. */
static const struct exh_signal row_a[] = {
    {0x7101, 0, EXH_WHEN_ANY, -10, 10, 3, "gain", "", "may change at any time"},
    {0x7102, 8, EXH_WHEN_SETUP, 0, 1000, 500, "width", "m", "before the loop"},
};
static const struct exh_signal row_b[] = {
    {0x7201, 0, EXH_WHEN_ANY, INT32_MIN, INT32_MAX, -1, "wide", "", "any raw value"},
    {0x7202, 0, EXH_WHEN_SETUP, 5, 5, 5, "fixed", "", "one allowed value"},
    {0x7203, 4, EXH_WHEN_ANY, 0, 100, 0, "third", "s", "may change at any time"},
};
static const struct exh_signal_group groups[] = {{row_a, 2, 1}, {row_b, 3, 2}};
static const struct exh_signal_table table = {groups, 2};
#define VALUES  8
#define IMAGE_B (12 + 4 * VALUES + 4)

struct fixture {
    struct exh_params p;
    int32_t active[VALUES + 1], staged[VALUES + 1]; /* one more as a fence */
};

static void setup(struct fixture *f)
{
    f->active[VALUES] = 0x5A5A;
    f->staged[VALUES] = 0x5A5A;
    exh_params_setup(&f->p, &table, f->active, f->staged);
}

static void check_active(const struct fixture *f, const int32_t *want, const char *when)
{
    for (size_t i = 0; i < VALUES; i++) {
        CHECK(f->active[i] == want[i], "%s: value %zu is %" PRId32 ", want %" PRId32, when, i,
            f->active[i], want[i]);
    }
    CHECK(f->active[VALUES] == 0x5A5A && f->staged[VALUES] == 0x5A5A, "%s: fence gone", when);
}

static const int32_t defaults[VALUES] = {3, 500, -1, 5, 0, -1, 5, 0};

TEST(rows_and_instances_in_order)
{
    static const struct {
        uint16_t id, instance;
    } want[VALUES] = {{0x7101, 0}, {0x7102, 0}, {0x7201, 0}, {0x7202, 0}, {0x7203, 0}, {0x7201, 1},
        {0x7202, 1}, {0x7203, 1}};
    uint16_t k = 9;
    CHECK_EQ_I64(exh_signal_count(&table), VALUES);
    for (uint32_t i = 0; i < VALUES; i++) {
        const struct exh_signal *row = exh_signal_at(&table, i, &k);
        CHECK(row != NULL && row->id == want[i].id && k == want[i].instance, "value %" PRIu32, i);
        CHECK(exh_signal_at(&table, i, NULL) == row, "value %" PRIu32 " without instance", i);
        CHECK_EQ_I64(exh_signal_find(&table, want[i].id, want[i].instance), (int64_t)i);
    }
    CHECK(exh_signal_at(&table, VALUES, &k) == NULL, "one past the end");
    CHECK(exh_signal_at(&table, UINT32_MAX, &k) == NULL, "far past the end");
    CHECK_EQ_I64(exh_signal_find(&table, 0x7101, 1), -EXH_E_UNKNOWN);
    CHECK_EQ_I64(exh_signal_find(&table, 0x7201, 2), -EXH_E_UNKNOWN);
    CHECK_EQ_I64(exh_signal_find(&table, 0x9999, 0), -EXH_E_UNKNOWN);
}

TEST(empty_table)
{
    static const struct exh_signal_table none = {NULL, 0};
    CHECK_EQ_I64(exh_signal_count(&none), 0);
    CHECK(exh_signal_at(&none, 0, NULL) == NULL, "a row of nothing");
    CHECK_EQ_I64(exh_signal_find(&none, 1, 0), -EXH_E_UNKNOWN);
}

/* The CRC moves with everything that changes the meaning of a value array. */
TEST(crc_tells_tables_apart)
{
    struct exh_signal row[2];
    struct exh_signal_group group[2] = {{row, 2, 1}, {row_b, 3, 2}};
    const struct exh_signal_table t = {group, 2};
    const uint32_t same = exh_signal_crc(&table);
    for (int change = 0; change < 9; change++) {
        memcpy(row, row_a, sizeof row);
        group[1].instances = 2;
        group[1].rows = 3;
        switch (change) {
        case 1: row[0].id ^= 1; break;
        case 2: row[0].frac ^= 1; break;
        case 3: row[0].min--; break;
        case 4: row[1].max--; break;
        case 5: group[1].instances = 3; break;
        case 6: group[1].rows = 2; break;
        case 7:
            row[0].name = "other";
            row[0].help = "words carry no meaning";
            break;
        case 8:
            row[0] = row_a[1];
            row[1] = row_a[0];
            break;
        default: break;
        }
        CHECK((exh_signal_crc(&t) == same) == (change == 0 || change == 7), "change %d", change);
    }
}

/* {gain, width} twice is gain width gain width; {gain} twice, {width} twice is
 * gain gain width width: another meaning, so another CRC. */
TEST(crc_sees_how_rows_are_grouped)
{
    static const struct exh_signal_group together[] = {{row_a, 2, 2}};
    static const struct exh_signal_group apart[] = {{row_a, 1, 2}, {row_a + 1, 1, 2}};
    static const struct exh_signal_table a = {together, 1}, b = {apart, 2};
    CHECK(exh_signal_at(&a, 1, NULL) != exh_signal_at(&b, 1, NULL), "fixture");
    CHECK(exh_signal_crc(&a) != exh_signal_crc(&b), "both %08" PRIx32, exh_signal_crc(&a));
}

TEST(staging_waits_for_apply)
{
    struct fixture f;
    setup(&f);
    check_active(&f, defaults, "init");
    CHECK_EQ_I64(exh_params_apply(&f.p), 0);
    CHECK_EQ_I64(exh_params_stage(&f.p, 0x7203, 1, 100), 0);
    CHECK_EQ_I64(exh_params_stage(&f.p, 0x7101, 0, -10), 0);
    check_active(&f, defaults, "staged");
    CHECK_EQ_I64(exh_params_apply(&f.p), 1);
    check_active(&f, (const int32_t[]){-10, 500, -1, 5, 0, -1, 5, 100}, "applied");
    CHECK_EQ_I64(exh_params_apply(&f.p), 0);
}

TEST(refusals_stage_nothing)
{
    static const struct {
        uint16_t id, instance;
        int32_t raw;
        int locked, want;
    } row[] = {
        {0x7101, 0, 11, 0, -EXH_E_RANGE},
        {0x7101, 0, -11, 0, -EXH_E_RANGE},
        {0x7101, 0, INT32_MIN, 0, -EXH_E_RANGE},
        {0x7202, 1, 4, 0, -EXH_E_RANGE},
        {0x7202, 1, 6, 0, -EXH_E_RANGE},
        {0x7101, 1, 0, 0, -EXH_E_UNKNOWN},
        {0x0000, 0, 0, 0, -EXH_E_UNKNOWN},
        {0x7102, 0, 499, 1, -EXH_E_STATE},
        {0x7101, 0, 11, 1, -EXH_E_RANGE},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct fixture f;
        setup(&f);
        f.p.locked = (uint8_t)row[i].locked;
        CHECK(exh_params_stage(&f.p, row[i].id, row[i].instance, row[i].raw) == row[i].want,
            "row %zu", i);
        CHECK(exh_params_apply(&f.p) == 0, "row %zu: something is pending", i);
        check_active(&f, defaults, "refused");
    }
}

TEST(ends_of_the_range_are_allowed)
{
    struct fixture f;
    setup(&f);
    CHECK_EQ_I64(exh_params_stage(&f.p, 0x7101, 0, 10), 0);
    CHECK_EQ_I64(exh_params_stage(&f.p, 0x7102, 0, 0), 0);
    CHECK_EQ_I64(exh_params_stage(&f.p, 0x7201, 0, INT32_MIN), 0);
    CHECK_EQ_I64(exh_params_stage(&f.p, 0x7201, 1, INT32_MAX), 0);
    CHECK_EQ_I64(exh_params_apply(&f.p), 1);
    check_active(&f, (const int32_t[]){10, 0, INT32_MIN, 5, 0, INT32_MAX, 5, 0}, "ends");
}

TEST(lock_spares_what_may_change)
{
    struct fixture f;
    setup(&f);
    f.p.locked = 1;
    CHECK_EQ_I64(exh_params_stage(&f.p, 0x7102, 0, 7), -EXH_E_STATE);
    CHECK_EQ_I64(exh_params_stage(&f.p, 0x7101, 0, 7), 0);
    CHECK_EQ_I64(exh_params_apply(&f.p), 1);
    check_active(&f, (const int32_t[]){7, 500, -1, 5, 0, -1, 5, 0}, "locked");
}

static void saved(uint8_t *image)
{
    struct fixture f;
    setup(&f);
    (void)exh_params_stage(&f.p, 0x7101, 0, -7);
    (void)exh_params_stage(&f.p, 0x7203, 0, 99);
    (void)exh_params_apply(&f.p);
    (void)exh_params_stage(&f.p, 0x7101, 0, 1); /* not yet in effect, but wanted */
    CHECK_EQ_I64(exh_params_save(&f.p, image, IMAGE_B), IMAGE_B);
}
static const int32_t saved_values[VALUES] = {1, 500, -1, 5, 99, -1, 5, 0};

TEST(image_layout)
{
    uint8_t image[IMAGE_B] = {0};
    struct exh_bytes c = exh_bytes_reader(image, sizeof image);
    uint16_t version = 0, count = 0;
    uint32_t crc = 0;
    int32_t first = 0;
    saved(image);
    CHECK(memcmp(image, "EXHP", 4) == 0, "magic");
    c.at = 4;
    exh_bytes_u16(&c, &version);
    exh_bytes_u16(&c, &count);
    exh_bytes_u32(&c, &crc);
    exh_bytes_i32(&c, &first);
    CHECK(version == EXH_PARAMS_VERSION && count == VALUES, "head");
    CHECK(crc == exh_signal_crc(&table) && first == 1, "table CRC, first value");
    c.at = IMAGE_B - 4;
    exh_bytes_u32(&c, &crc);
    CHECK(crc == exh_crc32(0, image, IMAGE_B - 4), "CRC");
}

TEST(image_round_trip_and_short_buffers)
{
    uint8_t image[IMAGE_B] = {0};
    struct fixture f;
    saved(image);
    setup(&f);
    CHECK_EQ_I64(exh_params_load(&f.p, image, sizeof image, NULL), 0);
    check_active(&f, defaults, "loaded, not applied");
    CHECK_EQ_I64(exh_params_apply(&f.p), 1);
    check_active(&f, saved_values, "loaded");
    for (size_t cap = 0; cap < IMAGE_B; cap++) {
        uint8_t buf[IMAGE_B];
        memset(buf, 0xAA, sizeof buf);
        CHECK_EQ_I64(exh_params_save(&f.p, buf, cap), -EXH_E_SHORT);
        for (size_t i = cap; i < IMAGE_B; i++) { CHECK(buf[i] == 0xAA, "cap %zu wrote", cap); }
    }
}

static void check_untouched(struct fixture *f, const char *when)
{
    CHECK(exh_params_apply(&f->p) == 0, "%s: something is pending", when);
    check_active(f, defaults, when);
}

TEST(truncated_at_every_byte)
{
    uint8_t image[IMAGE_B] = {0};
    saved(image);
    for (size_t len = 0; len < IMAGE_B; len++) {
        struct fixture f;
        setup(&f);
        CHECK(exh_params_load(&f.p, image, len, NULL) == -EXH_E_SHORT, "length %zu", len);
        check_untouched(&f, "truncated");
    }
}

TEST(every_flipped_bit_is_refused)
{
    uint8_t image[IMAGE_B] = {0};
    saved(image);
    for (size_t bit = 0; bit < 8 * IMAGE_B; bit++) {
        struct fixture f;
        int err;
        setup(&f);
        image[bit / 8] ^= (uint8_t)(1u << bit % 8);
        err = exh_params_load(&f.p, image, sizeof image, NULL);
        image[bit / 8] ^= (uint8_t)(1u << bit % 8);
        CHECK(err == (bit < 96 ? -EXH_E_VERSION : -EXH_E_CRC), "bit %zu: error %d", bit, err);
        check_untouched(&f, "flipped");
    }
}

/* Puts a value into an image and makes the CRC right again: an honest writer with
 * other ideas, not damage. */
static void forge(uint8_t *image, uint32_t i, int32_t v)
{
    struct exh_bytes c = exh_bytes_writer(image, IMAGE_B);
    uint32_t crc;
    c.at = 12 + 4 * i;
    exh_bytes_i32(&c, &v);
    crc = exh_crc32(0, image, IMAGE_B - 4);
    c.at = IMAGE_B - 4;
    exh_bytes_u32(&c, &crc);
}

TEST(honest_image_with_bad_values)
{
    static const struct {
        uint32_t i;
        int32_t v;
        int locked, want;
    } row[] = {
        {0, 11, 0, -EXH_E_RANGE},
        {7, 101, 0, -EXH_E_RANGE},
        {3, INT32_MIN, 0, -EXH_E_RANGE},
        {0, 7, 1, -EXH_E_STATE},
        {6, 6, 0, -EXH_E_RANGE},
    };
    for (size_t k = 0; k < LEN(row); k++) {
        uint8_t image[IMAGE_B] = {0};
        uint32_t bad = 77;
        struct fixture f;
        saved(image);
        forge(image, row[k].i, row[k].v);
        setup(&f);
        f.p.locked = (uint8_t)row[k].locked;
        CHECK(exh_params_load(&f.p, image, sizeof image, &bad) == row[k].want, "row %zu", k);
        CHECK(bad == row[k].i, "row %zu: blames %" PRIu32, k, bad);
        check_untouched(&f, "bad value");
        CHECK(exh_params_load(&f.p, image, sizeof image, NULL) == row[k].want, "row %zu", k);
    }
}

/* While locked an image may come again, and changes nothing. */
TEST(locked_image_as_it_stands)
{
    uint8_t image[IMAGE_B] = {0};
    struct fixture f;
    setup(&f);
    f.p.locked = 1;
    CHECK_EQ_I64(exh_params_save(&f.p, image, sizeof image), IMAGE_B);
    CHECK_EQ_I64(exh_params_load(&f.p, image, sizeof image, NULL), 0);
    CHECK_EQ_I64(exh_params_apply(&f.p), 1);
    check_active(&f, defaults, "locked load");
}

/* --- the library's own rows --- */

static const struct exh_signal_group lib_groups[] = {
    {exh_quad_rows, EXH_QUAD_ROWS, 1},
    {exh_velocity_rows, EXH_VELOCITY_ROWS, 1},
    {exh_contact_rows, EXH_CONTACT_ROWS, 1},
    {exh_drive_rows, EXH_DRIVE_ROWS, 1},
    {exh_safety_rows, EXH_SAFETY_ROWS, 1},
    {exh_tracking_rows, EXH_TRACKING_ROWS, 1},
    {exh_tune_rows, EXH_TUNE_ROWS, 1},
};
static const struct exh_signal_table lib_table = {lib_groups, 7};

static int is_name(const char *s)
{
    if (*s == '\0') { return 0; }
    for (; *s != '\0'; s++) {
        if (!((*s >= 'a' && *s <= 'z') || (*s >= '0' && *s <= '9') || *s == '_')) { return 0; }
    }
    return 1;
}

static int is_line(const char *s)
{
    if (*s == '\0') { return 0; }
    while (*s >= ' ' && *s <= '~') { s++; }
    return *s == '\0';
}

TEST(library_rows_are_well_formed)
{
    const uint32_t n = exh_signal_count(&lib_table);
    for (uint32_t i = 0; i < n; i++) {
        const struct exh_signal *r = exh_signal_at(&lib_table, i, NULL);
        CHECK(is_name(r->name), "row %" PRIu32, i);
        CHECK(r->unit != NULL && (*r->unit == '\0' || is_name(r->unit)), "%s: unit", r->name);
        CHECK(r->help != NULL && is_line(r->help), "%s: help", r->name);
        CHECK(r->min <= r->dflt, "%s: default below its range", r->name);
        CHECK(r->dflt <= r->max, "%s: default above its range", r->name);
        CHECK(r->frac < 64 && r->when < EXH_WHENS, "%s", r->name);
        for (uint32_t k = 0; k < i; k++) {
            const struct exh_signal *o = exh_signal_at(&lib_table, k, NULL);
            CHECK(o->id != r->id, "%s and %s share id %04x", r->name, o->name, r->id);
            CHECK(!check_same_text(o->name, r->name), "two rows named %s", r->name);
        }
    }
}

TEST(classes_of_rows)
{
    for (unsigned when = 0; when < EXH_WHENS; when++) {
        const struct exh_signal row = {1, 0, (uint8_t)when, 0, 1, 0, "a", "", "b"};
        const int fixed = when == EXH_WHEN_SETUP || when == EXH_WHEN_PERSON;
        CHECK(exh_signal_is_fixed(&row) == fixed, "%u", when);
    }
}

/* Rows and struct fields in the same order, one int32_t each. */
TEST(library_rows_match_their_structs)
{
    CHECK_EQ_I64(sizeof(struct exh_quad_par), 4 * EXH_QUAD_ROWS);
    CHECK_EQ_I64(sizeof(struct exh_velocity_par), 4 * EXH_VELOCITY_ROWS);
    CHECK_EQ_I64(sizeof(struct exh_contact_par), 4 * EXH_CONTACT_ROWS);
    CHECK_EQ_I64(sizeof(struct exh_drive_par), 4 * EXH_DRIVE_ROWS);
    CHECK_EQ_I64(sizeof(struct exh_safety_par), 4 * EXH_SAFETY_ROWS);
    CHECK_EQ_I64(sizeof(struct exh_tracking_par), 4 * EXH_TRACKING_ROWS);
    CHECK_EQ_I64(sizeof(struct exh_tune_par), 4 * EXH_TUNE_ROWS);
    CHECK_EQ_I64(exh_contact_rows[0].max, EXH_Q(1000000, 1, EXH_Q_K));
    CHECK_EQ_I64(exh_contact_rows[1].max, EXH_Q(1000, 1, EXH_Q_B));
    CHECK_EQ_I64(exh_contact_rows[2].max, EXH_Q(20, 1, EXH_Q_FORCE));
    CHECK_EQ_I64(exh_contact_rows[3].max, EXH_Q(1, 100, EXH_Q_POS));
    CHECK_EQ_I64(exh_contact_rows[4].max, EXH_Q(1, 100, EXH_Q_POS));
    CHECK_EQ_I64(exh_velocity_rows[0].max, 4);
    CHECK_EQ_I64(exh_safety_rows[0].max, 1);
}

TEST_MAIN("unit/signal", rows_and_instances_in_order, empty_table, crc_tells_tables_apart,
    crc_sees_how_rows_are_grouped, staging_waits_for_apply, refusals_stage_nothing,
    ends_of_the_range_are_allowed, lock_spares_what_may_change, image_layout,
    image_round_trip_and_short_buffers, truncated_at_every_byte, every_flipped_bit_is_refused,
    honest_image_with_bad_values, locked_image_as_it_stands, library_rows_are_well_formed,
    classes_of_rows, library_rows_match_their_structs);
