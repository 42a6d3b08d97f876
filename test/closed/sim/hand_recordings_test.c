/* SPDX-License-Identifier: MIT */
/* The map of the robot hand over recordings of real hands in CyberGloves: joints keep their
 * limits, and how often each had to be cut off. */
#include "exhand/exhand.h"

#include "check.h"

#include <stdio.h>
#include <stdlib.h>

#define COLUMNS_MAX           40
#define CLAMPED_MAX_PER_MILLE 20

/* Columns as the recording software has them, of a hand model: four of each finger, the last the
 * turn to the side, then palm and wrist. It counts bending down from 0, a turn towards the
 * little finger up. */
static const struct {
    const char *path;
    int columns, first; /* in a line; where the angles begin, radians */
} file[] = {{"glove-cyberglove-libras-alphabet/alphabet.csv", 22, 0},
    {"glove-cyberglove-graspdb14/00_calib-rad-su01.txt", 30, 7},
    {"glove-cyberglove-graspdb14/10_ex01-rad-003-grasp-su04.txt", 30, 7},
    {"glove-cyberglove-graspdb14/04_ex01-rad-045-grasp-su03.txt", 30, 7}};
#define FILES (sizeof file / sizeof file[0])

struct tally {
    uint32_t rows, clamped[EXH_FINGERS][EXH_HAND_JOINTS];
};

/* --- reading --- */

static FILE *open_data(const char *path)
{
    const char *root = getenv("EXH_DATA");
    char name[512];
    snprintf(name, sizeof name, "%s/%s", root != NULL ? root : "$EXH_DATA", path);
    return fopen(name, "rb");
}

/* Next line, however it ends; 0 at the end of the file. */
static int next_line(FILE *f, char *line, size_t cap)
{
    size_t n = 0;
    int c;
    while ((c = getc(f)) != EOF && c != '\n' && c != '\r') {
        if (n + 1 < cap) { line[n++] = (char)c; }
    }
    line[n] = '\0';
    return c != EOF || n > 0;
}

/* Numbers at the start of a line, set apart by blanks or commas. */
static int numbers(const char *line, double *v, int cap)
{
    int n = 0;
    while (n < cap) {
        char *end;
        v[n] = strtod(line, &end);
        if (end == line) { break; }
        n++;
        line = *end == ',' ? end + 1 : end;
    }
    return n;
}

static int32_t turn_q32(double rad) { return (int32_t)(rad * 683565275.5764316); }

/* The glove's 22 from the model's 22: bending turned round, and turns to the side as the
 * distance between neighbours. */
static void to_sensors(const double *column, int32_t *sensor)
{
    static const uint8_t bend[][2] = {{EXH_GLOVE_INDEX_MPJ, 4}, {EXH_GLOVE_MIDDLE_MPJ, 8},
        {EXH_GLOVE_RING_MPJ, 12}, {EXH_GLOVE_LITTLE_MPJ, 16}};
    memset(sensor, 0, EXH_GLOVE_SENSORS * sizeof sensor[0]);
    for (size_t i = 0; i < 4; i++) {
        sensor[EXH_GLOVE_THUMB_ROTATE + i] = turn_q32(-column[i]);
        for (size_t k = 0; k < 3; k++) {
            sensor[bend[i][0] + k] = turn_q32(-column[bend[i][1] + k]);
        }
    }
    sensor[EXH_GLOVE_MIDDLE_INDEX_AB] = turn_q32(column[11] - column[7]);
    sensor[EXH_GLOVE_RING_MIDDLE_AB] = turn_q32(column[15] - column[11]);
    sensor[EXH_GLOVE_LITTLE_RING_AB] = turn_q32(column[19] - column[15]);
}

/* --- the claim --- */

static void follow(const double *column, struct tally *t)
{
    int32_t sensor[EXH_GLOVE_SENSORS], q[EXH_HAND_JOINTS];
    to_sensors(column, sensor);
    t->rows++;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const uint32_t clamped = exh_hand_joints(&exh_hit2_map, f, sensor, q);
        for (unsigned j = 0; j < EXH_HAND_JOINTS; j++) {
            const struct exh_hand_joint *limit = &exh_hit2_map.joint[f][j];
            CHECK(q[j] >= limit->lo_turn_q32 && q[j] <= limit->hi_turn_q32,
                "finger %u, joint %u: %" PRId32, f, j, q[j]);
            t->clamped[f][j] += clamped >> j & 1;
        }
    }
}

static void read_file(FILE *f, size_t which, struct tally *t)
{
    char line[1024];
    while (next_line(f, line, sizeof line)) {
        double v[COLUMNS_MAX];
        if (numbers(line, v, COLUMNS_MAX) == file[which].columns) {
            follow(v + file[which].first, t);
        }
    }
}

static void print(const char *name, const struct tally *t)
{
    char text[160];
    int n = 0;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        for (unsigned j = 0; j < EXH_HAND_JOINTS; j++) {
            n += snprintf(text + n, sizeof text - (size_t)n, "%s%.2f",
                j   ? " "
                : f ? " | "
                    : "",
                100.0 * t->clamped[f][j] / t->rows);
        }
    }
    check_note("%s, %u rows: clamped %% q0 q1 q2 of thumb to little: %s", name, t->rows, text);
}

TEST(joints_keep_their_limits)
{
    struct tally all = {0, {{0}}};
    unsigned missing = 0;
    for (size_t i = 0; i < FILES; i++) {
        struct tally one = {0, {{0}}};
        FILE *f = open_data(file[i].path);
        if (f == NULL) {
            missing++;
            continue;
        }
        read_file(f, i, &one);
        fclose(f);
        CHECK(one.rows >= 200, "%s: %u rows", file[i].path, one.rows);
        print(file[i].path, &one);
        all.rows += one.rows;
        for (unsigned k = 0; k < EXH_FINGERS * EXH_HAND_JOINTS; k++) {
            all.clamped[k / 3][k % 3] += one.clamped[k / 3][k % 3];
        }
    }
    if (missing > 0) {
        check_note("%u of %u recordings are not there: share clamped not judged", missing,
            (unsigned)FILES);
        return;
    }
    print("all", &all);
    for (unsigned k = 0; k < EXH_FINGERS * EXH_HAND_JOINTS; k++) {
        CHECK(1000 * (uint64_t)all.clamped[k / 3][k % 3] <=
                  CLAMPED_MAX_PER_MILLE * (uint64_t)all.rows,
            "finger %u, joint %u: %u of %u rows clamped", k / 3, k % 3, all.clamped[k / 3][k % 3],
            all.rows);
    }
}

TEST_MAIN("sim/hand_recordings", joints_keep_their_limits);
