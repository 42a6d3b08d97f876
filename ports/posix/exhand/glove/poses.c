/* SPDX-License-Identifier: MIT */
#include "glove/poses.h"

#include "base/fifo.h"
#include "base/lines.h"
#include "base/option.h"
#include "box/recording.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LINE_B 1024
#define PI     3.14159265358979323846

#define S(name) (1u << EXH_GLOVE_##name)
#define MPJS    (S(INDEX_MPJ) | S(MIDDLE_MPJ) | S(RING_MPJ) | S(LITTLE_MPJ))
#define PIJS    (S(INDEX_PIJ) | S(MIDDLE_PIJ) | S(RING_PIJ) | S(LITTLE_PIJ))
#define DIJS    (S(INDEX_DIJ) | S(MIDDLE_DIJ) | S(RING_DIJ) | S(LITTLE_DIJ))
#define ABS     (S(MIDDLE_INDEX_AB) | S(RING_MIDDLE_AB) | S(LITTLE_RING_AB))
#define EVERY   ((1u << EXH_GLOVE_SENSORS) - 1u)

#define GROUPS 3

/* The angles are gauges': blocks and templates to lay the fingers on. The first group that
 * has a sensor says its angle. Each knuckle bends alone once, fingers together: what the
 * abduction sensors beside it then say is its cross-coupling. */
static const struct {
    const char *name, *todo;
    struct {
        uint32_t sensors;
        int deg;
    } group[GROUPS];
} text[GLOVE_POSES] = {
    {"flat", "hand flat on the table, fingers and thumb together, wrist straight", {{EVERY, 0}}},
    {"spread", "flat on the template: fingers 20 degrees apart, thumb 45 degrees out",
        {{ABS, 20}, {S(THUMB_AB), 45}, {EVERY, 0}}},
    {"knuckles", "fingers together and straight, bent 80 degrees at the knuckles over the block",
        {{MPJS, 80}, {PIJS | DIJS | ABS, 0}}},
    {"hook", "knuckles straight, fingers hooked: middle joints 90, last joints 60 degrees",
        {{PIJS, 90}, {DIJS, 60}, {MPJS, 0}}},
    {"index", "flat, fingers together; the index alone bent 60 degrees at its knuckle",
        {{S(INDEX_MPJ), 60}, {S(MIDDLE_MPJ) | S(MIDDLE_INDEX_AB), 0}}},
    {"middle", "the middle finger alone bent 60 degrees at its knuckle",
        {{S(MIDDLE_MPJ), 60},
            {S(INDEX_MPJ) | S(RING_MPJ) | S(MIDDLE_INDEX_AB) | S(RING_MIDDLE_AB), 0}}},
    {"ring", "the ring finger alone bent 60 degrees at its knuckle",
        {{S(RING_MPJ), 60},
            {S(MIDDLE_MPJ) | S(LITTLE_MPJ) | S(RING_MIDDLE_AB) | S(LITTLE_RING_AB), 0}}},
    {"little", "the little finger alone bent 60 degrees at its knuckle",
        {{S(LITTLE_MPJ), 60}, {S(RING_MPJ) | S(LITTLE_RING_AB), 0}}},
    {"thumb", "flat; the thumb bent 30 degrees at its knuckle, 70 at its last joint",
        {{S(THUMB_MPJ), 30}, {S(THUMB_IJ), 70}, {S(THUMB_ROTATE) | S(THUMB_AB), 0}}},
    {"across", "the thumb turned 50 degrees across the palm and lying on it",
        {{S(THUMB_ROTATE), 50}, {S(THUMB_AB), 0}}},
    {"opposed", "the thumb turned 50 degrees across the palm and standing 45 degrees off it",
        {{S(THUMB_ROTATE), 50}, {S(THUMB_AB), 45}}},
    {"cup", "the palm cupped around the bowl: 30 degrees", {{S(PALM_ARCH), 30}}},
    {"up", "the wrist bent 30 degrees up", {{S(WRIST_PITCH), 30}, {S(WRIST_YAW), 0}}},
    {"down", "the wrist bent 25 degrees down", {{S(WRIST_PITCH), -25}, {S(WRIST_YAW), 0}}},
    {"side", "the wrist turned 20 degrees to the little finger's side",
        {{S(WRIST_YAW), -20}, {S(WRIST_PITCH), 0}}},
};

const char *glove_pose_name(unsigned pose)
{
    return pose < GLOVE_POSES ? text[pose].name : "unknown";
}

void glove_poses_print(FILE *f)
{
    for (unsigned p = 0; p < GLOVE_POSES; p++) {
        fprintf(f, "%2u %-9s %s\n", p + 1, text[p].name, text[p].todo);
    }
}

int glove_pose_says(unsigned pose, unsigned sensor, int *deg)
{
    for (unsigned g = 0; g < GROUPS; g++) {
        if (text[pose].group[g].sensors >> sensor & 1) {
            *deg = text[pose].group[g].deg;
            return 1;
        }
    }
    return 0;
}

static void take_code(struct glove_codes *c, double code)
{
    const double raw_q16 = code * 65536 + (code < 0 ? -0.5 : 0.5); /* the cast cuts it off */
    if (c->mean_raw_q16.n == 0 || code < c->low) { c->low = code; }
    if (c->mean_raw_q16.n == 0 || code > c->high) { c->high = code; }
    exh_mean_add(&c->mean_raw_q16, (int32_t)raw_q16);
}

/* --- live --- */

void glove_poses_take(struct glove_taken *t, const struct glove_bench *b, FILE *progress)
{
    struct sim_random person = {(uint64_t)b->seed};
    memset(t, 0, sizeof *t);
    for (unsigned p = 0; p < GLOVE_POSES; p++) {
        static struct sim_glove g;
        double rad[EXH_GLOVE_SENSORS];
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            const double off = 2 * sim_random_unit(&person) - 1;
            int deg = 0; /* where the pose leaves it free, as in the flat hand */
            (void)glove_pose_says(p, i, &deg);
            rad[i] = (deg + b->miss_deg * off) * (PI / 180);
        }
        sim_glove_start(&g, &b->par, sim_random_u64(&person), rad);
        memcpy(g.fault, b->fault, sizeof g.fault);
        for (int64_t n = 0; n < b->frames; n++) {
            const double tick_s = (double)(n + 1) / b->rate_Hz;
            for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
                take_code(
                    &t->code[p][i], sim_glove_convert(&g, i, sim_glove_held_s(&b->par, i, tick_s)));
            }
            t->frames[p]++;
        }
        fprintf(progress, "pose %2u of %d, %-9s %s: taken\n", p + 1, GLOVE_POSES, text[p].name,
            text[p].todo);
    }
}

/* --- recorded --- */

int glove_pose_find(const char *name)
{
    for (int p = 0; p < GLOVE_POSES; p++) {
        if (strcmp(text[p].name, name) == 0) { return p; }
    }
    return -1;
}

/* Reads one more than there are sensors, to detect too many. */
static int codes_of(char *text_of, double code[EXH_GLOVE_SENSORS + 1])
{
    int n = 0;
    for (char *word = strtok(text_of, ", \t"); word != NULL; word = strtok(NULL, ", \t")) {
        char *end;
        const double v = strtod(word, &end);
        if (end == word || *end != '\0' || !(v >= -32768 && v <= 32767)) { return -1; }
        if (n == EXH_GLOVE_SENSORS) { return n + 1; }
        code[n++] = v;
    }
    return n;
}

/* 0, or 2 after a line on stderr. */
static int take_line(struct glove_taken *t, char *line, const char *path, unsigned long at)
{
    double code[EXH_GLOVE_SENSORS + 1];
    char *comma = strchr(line, ',');
    int pose, n;
    if (line[0] == '\0' || line[0] == '#') { return 0; }
    if (comma != NULL) { *comma = '\0'; }
    if (strcmp(line, "pose") == 0) { return 0; } /* the header */
    pose = glove_pose_find(line);
    if (pose < 0) {
        cli_complain("--poses: %s: line %lu: %.40s: no such pose: `exhand calibrate --glove "
                     "--list` lists them",
            path, at, line);
        return 2;
    }
    n = comma != NULL ? codes_of(comma + 1, code) : 0;
    if (n != EXH_GLOVE_SENSORS) {
        cli_complain("--poses: %s: line %lu: %s: give the pose and %d codes of -32768..32767, "
                     "commas between",
            path, at,
            n < 0                   ? "no code"
            : n < EXH_GLOVE_SENSORS ? "too few codes"
                                    : "too many codes",
            EXH_GLOVE_SENSORS);
        return 2;
    }
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { take_code(&t->code[pose][i], code[i]); }
    t->frames[pose]++;
    return 0;
}

void glove_poses_row(FILE *f, const char *pose, const int16_t raw[EXH_GLOVE_SENSORS])
{
    fputs(pose, f);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { fprintf(f, ",%d", raw[i]); }
    fputc('\n', f);
}

int glove_poses_read(struct glove_taken *t, const char *path)
{
    const int standard = strcmp(path, "-") == 0;
    FILE *f = standard ? stdin : fifo_read(path);
    char line[LINE_B];
    unsigned long at = 0;
    int more, status = 0;
    memset(t, 0, sizeof *t);
    if (f == NULL) {
        cli_complain("--poses: %s: %s: give a CSV of poses and codes", path, strerror(errno));
        return 3;
    }
    while (status == 0 && (more = lines_next(f, line, sizeof line)) != 0) {
        at++;
        if (more < 0) {
            cli_complain(
                "--poses: %s: line %lu: longer than %d bytes: give the pose and its codes alone",
                path, at, LINE_B - 1);
            status = 2;
        } else {
            status = take_line(t, line, path, at);
        }
    }
    if (status == 0 && ferror(f)) { /* a directory, as a rule */
        cli_complain(
            "--poses: %s: can't be read: %s: give a CSV of poses and codes", path, strerror(errno));
        status = 2;
    }
    if (!standard) { fclose(f); }
    return status;
}

/* --- recorded, in columns of another program --- */

/* By its name, or its number in --list; -1: neither. */
static int labelled(const char *label)
{
    char *end;
    const long n = strtol(label, &end, 10);
    return end != label && *end == '\0' ? (n >= 1 && n <= GLOVE_POSES ? (int)n - 1 : -1)
                                        : glove_pose_find(label);
}

/* A row as it is, or not at all: what it says is of one pose. 1 if it was taken; -1: no pose. */
static int take_labelled(
    struct glove_taken *t, const double row[EXH_GLOVE_SENSORS], const char *label)
{
    const int pose = labelled(label);
    if (pose < 0) { return -1; }
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        if (isnan(row[i])) { return 0; }
    }
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { take_code(&t->code[pose][i], row[i]); }
    t->frames[pose]++;
    return 1;
}

int glove_poses_read_columns(
    struct glove_taken *t, const char *path, const char *columns, const char *scale)
{
    const struct recording_ask ask = {RECORDING_CODES, columns, scale ? scale : "1"};
    struct recording r;
    long left = 0;
    int err = recording_read(&r, path, &ask);
    memset(t, 0, sizeof *t);
    if (err == 0 && r.label == NULL) {
        cli_complain("--columns: no pose: label=C says which column has its name or number");
        err = 2;
    }
    for (long n = 0; err == 0 && n < r.rows; n++) {
        const int taken = take_labelled(t, r.row[n], r.label[n]);
        left += taken == 0;
        if (taken < 0) {
            cli_complain("--poses: %s: row %ld: %s: no such pose: `exhand calibrate --glove "
                         "--list` lists them",
                path, n + 1, r.label[n]);
            err = 2;
        }
    }
    if (left > 0) { cli_complain("--poses: %s: %ld rows are left out for that", path, left); }
    recording_free(&r);
    return err;
}

/* --- to the fit, and to a file --- */

unsigned glove_poses_fit(
    struct exh_glove_pose *pose, uint8_t which[GLOVE_POSES], const struct glove_taken *t)
{
    unsigned n = 0;
    for (unsigned p = 0; p < GLOVE_POSES; p++) {
        struct exh_glove_pose *to = &pose[n];
        if (t->frames[p] == 0) { continue; }
        memset(to, 0, sizeof *to);
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            const struct glove_codes *c = &t->code[p][i];
            int deg;
            to->mean_raw_q16[i] = exh_mean_value(&c->mean_raw_q16);
            to->noise_raw[i] = (int32_t)(c->high - c->low + 0.5);
            if (!glove_pose_says(p, i, &deg)) { continue; }
            to->known |= 1u << i;
            to->angle_turn_q32[i] = (int32_t)(deg * (INT64_C(1) << 32) / 360);
        }
        which[n++] = (uint8_t)p;
    }
    return n;
}

void glove_poses_csv(FILE *f, const struct glove_taken *t)
{
    fprintf(f, "pose");
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        fprintf(f, ",%s", exh_glove_sensor_text(i));
    }
    fputc('\n', f);
    for (unsigned p = 0; p < GLOVE_POSES; p++) {
        if (t->frames[p] == 0) { continue; }
        fprintf(f, "%s", text[p].name);
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            fprintf(f, ",%.4f", exh_mean_value(&t->code[p][i].mean_raw_q16) / 65536.0);
        }
        fputc('\n', f);
    }
}
