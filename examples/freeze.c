/* SPDX-License-Identifier: MIT */
#include "freeze.h"

#include "exhand/error.h"
#include "exhand/exhand.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LEN(a) (sizeof(a) / sizeof((a)[0]))

/* --- the structures --- */

enum kind { U8, I32, U32, I64, GAIN, TABLE, PAR, KINDS };
/* TABLE and PAR are pointers; the scene gives their text. */
static const size_t size_B[KINDS] = {
    1, 4, 4, 8, sizeof(struct exh_gain), sizeof(struct exh_table), sizeof(void *)};

struct field {
    const char *name;
    size_t at;
    enum kind kind;
};

struct freeze_type {
    const char *name;
    size_t size_B;
    const struct field *field;
    size_t fields;
};

#define TYPE(type, ...) \
    { \
        "struct " #type, sizeof(struct type), (const struct field[]){__VA_ARGS__}, \
            LEN(((const struct field[]){__VA_ARGS__})) \
    }
#define F(type, name, kind) \
    { \
#name, offsetof(struct type, name), kind \
    }

const struct freeze_type freeze_knot =
    TYPE(exh_knot, F(exh_knot, x, I32), F(exh_knot, y, I32), F(exh_knot, slope, GAIN));
const struct freeze_type freeze_quad = TYPE(exh_quad_cfg, F(exh_quad_cfg, par, PAR),
    F(exh_quad_cfg, jump_cnt, I32), F(exh_quad_cfg, unused, U8));
const struct freeze_type freeze_velocity_window = TYPE(exh_velocity_window_cfg,
    F(exh_velocity_window_cfg, gain, GAIN), F(exh_velocity_window_cfg, n, U8));
const struct freeze_type freeze_drive =
    TYPE(exh_drive_cfg, F(exh_drive_cfg, par, PAR), F(exh_drive_cfg, force_to_cur, TABLE),
        F(exh_drive_cfg, cur_to_force, TABLE), F(exh_drive_cfg, f_top_N_q20, I32),
        F(exh_drive_cfg, i_top_A_q26, I32), F(exh_drive_cfg, i_whole_A_q26, I32),
        F(exh_drive_cfg, top_limit, U32), F(exh_drive_cfg, tick_N_q20, GAIN),
        F(exh_drive_cfg, i2t_budget_q32, I64), F(exh_drive_cfg, i2t_fold, GAIN),
        F(exh_drive_cfg, i2t_shift, U8), F(exh_drive_cfg, dac_A_q26, GAIN));
const struct freeze_type freeze_track =
    TYPE(exh_tracking_cfg, F(exh_tracking_cfg, tol_A_q26, I32), F(exh_tracking_cfg, ticks, U32));
const struct freeze_type freeze_safety =
    TYPE(exh_safety_cfg, F(exh_safety_cfg, late_max, U32), F(exh_safety_cfg, small_N_q20, I32),
        F(exh_safety_cfg, arm_ticks, U32), F(exh_safety_cfg, ramp_q30, I32),
        F(exh_safety_cfg, release_ticks, U32), F(exh_safety_cfg, fall, GAIN));

static int nothing(const uint8_t *p, size_t len_B)
{
    while (len_B > 0 && p[len_B - 1] == 0) { len_B--; }
    return len_B == 0;
}

/* Checks for missing fields. Between listed fields only alignment padding is allowed, which set-up
 * leaves unchanged. So a field missing in this list is detected, even if it fits into padding. */
static int whole(const struct freeze_type *t, const uint8_t *of)
{
    size_t end = 0;
    for (size_t k = 0; k < t->fields; k++) {
        const size_t at = t->field[k].at, size = size_B[t->field[k].kind];
        const size_t align = size < sizeof(void *) ? size : sizeof(void *);
        if (at < end || at - end >= align || !nothing(of + end, at - end)) { return 0; }
        end = at + size;
    }
    return end <= t->size_B && t->size_B - end < sizeof(void *) &&
           nothing(of + end, t->size_B - end);
}

/* --- output as C --- */

static void print_field(const struct field *f, const void *of, const char *text)
{
    uint8_t u8;
    int32_t i32;
    int64_t i64;
    struct exh_gain gain;
    const uint8_t *const p = (const uint8_t *)of + f->at;
    printf(".%s = ", f->name);
    switch (f->kind) {
    case U8: memcpy(&u8, p, sizeof u8), printf("%u", (unsigned)u8); break;
    case I32: memcpy(&i32, p, sizeof i32), printf("INT32_C(%" PRId32 ")", i32); break;
    case U32: memcpy(&i32, p, sizeof i32), printf("UINT32_C(%" PRIu32 ")", (uint32_t)i32); break;
    case I64: memcpy(&i64, p, sizeof i64), printf("INT64_C(%" PRId64 ")", i64); break;
    case GAIN:
        memcpy(&gain, p, sizeof gain);
        printf("{.mant = INT32_C(%" PRId32 "), .shift = %u}", gain.mant, (unsigned)gain.shift);
        break;
    case TABLE:
    case PAR:
    case KINDS: printf("%s", text); break;
    }
}

static void print_one(const struct freeze *f, const void *of)
{
    unsigned texts = 0;
    printf("{");
    for (size_t k = 0; k < f->type->fields; k++) {
        const struct field *field = &f->type->field[k];
        const int points = field->kind == TABLE || field->kind == PAR;
        printf("%s", k ? ",\n    " : "");
        print_field(field, of, points ? f->text[texts++] : "");
    }
    printf("}");
}

static int print_list(void)
{
    for (const struct freeze *f = freeze_list; f->type; f++) {
        for (unsigned k = 0; k < f->n; k++) {
            if (whole(f->type, (const uint8_t *)f->of + k * f->type->size_B)) { continue; }
            fprintf(stderr, "freeze: %s: has other fields than examples/freeze.c\n", f->type->name);
            return 1;
        }
        printf("static const %s %s%s = ", f->type->name, f->name, f->n > 1 ? "[]" : "");
        for (unsigned k = 0; k < f->n; k++) {
            printf("%s", f->n > 1 && k == 0 ? "{" : "");
            print_one(f, (const uint8_t *)f->of + k * f->type->size_B);
            printf("%s", f->n == 1 ? "" : k + 1 < f->n ? ",\n    " : "}");
        }
        printf(";\n");
    }
    return 0;
}

/* --- the program --- */

void exh_assert_failed(const char *file, int line)
{
    fprintf(stderr, "freeze: %s:%d: assertion\n", file, line);
    exit(1);
}

/* Digits only, at most 2^32-1. */
static int number(const char *text, char end, uint32_t *value, const char **rest)
{
    uint64_t v = 0;
    const char *p = text;
    for (; *p >= '0' && *p <= '9' && v <= UINT32_MAX; p++) { v = v * 10 + (uint64_t)(*p - '0'); }
    *value = (uint32_t)v;
    *rest = p + 1;
    return p != text && *p == end && v <= UINT32_MAX;
}

/* "HZ", or "N/D" in seconds. */
static int period(const char *text, struct exh_period *T)
{
    const char *rest;
    if (number(text, '/', &T->num, &rest)) {
        return number(rest, '\0', &T->den, &rest) && exh_period_ok(*T);
    }
    T->num = 1;
    return number(text, '\0', &T->den, &rest) && exh_period_ok(*T);
}

static int usage(FILE *to, int status)
{
    fprintf(to,
        "usage: freeze RATE BITS\n"
        "What the set-up of scene %s makes, as C, to stdout: %s/frozen.h says what for.\n"
        "  RATE  of the loop: HZ, 1 .. 20000, or its period N/D in seconds, as the board's "
        "timer makes it\n"
        "  BITS  width of the board's counters, 16 .. 32\n"
        "Exit status: 0 ok, 1 set-up refuses, 2 bad usage.\n",
        freeze_scene->name, "examples");
    return status;
}

int main(int argc, char **argv)
{
    struct exh_scene_board board;
    uint32_t bits;
    const char *rest;
    int err;

    if (argc == 2 && strcmp(argv[1], "--help") == 0) { return usage(stdout, 0); }
    if (argc != 3) { return usage(stderr, 2); }
    if (!period(argv[1], &board.T)) {
        fprintf(stderr, "RATE: %s (1 .. 20000 Hz, or N/D s): give what the board's timer makes\n",
            argv[1]);
        return 2;
    }
    if (!number(argv[2], '\0', &bits, &rest) || bits < 16 || bits > 32) {
        fprintf(stderr, "BITS: %s (16 .. 32): give the width of the board's counters\n", argv[2]);
        return 2;
    }
    board.enc_bits = (uint8_t)bits;
    err = freeze_scene->setup(board);
    if (err < 0) {
        fprintf(stderr, "freeze: %s, %s, %s bits: %s\n", freeze_scene->name, argv[1], argv[2],
            exh_error_text(err));
        return 1;
    }
    printf(
        "/* Made by examples/freeze.c, not by hand: what the set-up of scene %s makes at %" PRIu32
        "/%" PRIu32 " s with counters of %u bits.\n * `make frozen` makes it anew. */\n#include "
        "\"frozen.h\"\n\n"
        "#include \"exhand/exhand.h\"\n\n"
        "EXH_STATIC_ASSERT(frozen_by, EXH_VERSION_MAJOR == %d && EXH_VERSION_MINOR == %d && "
        "EXH_VERSION_PATCH == %d);\n\n"
        "static const struct exh_scene_board frozen_board = {.T = {%" PRIu32 ", %" PRIu32
        "}, .enc_bits = %u};\n",
        freeze_scene->name, board.T.num, board.T.den, (unsigned)bits, EXH_VERSION_MAJOR,
        EXH_VERSION_MINOR, EXH_VERSION_PATCH, board.T.num, board.T.den, (unsigned)bits);
    return print_list();
}
