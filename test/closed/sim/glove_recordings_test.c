/* SPDX-License-Identifier: MIT */
/* Real gloves through the glove module: CyberGlove recordings, whose codes come back exactly,
 * and the noise of a bend-sensor glove at rest. */
#include "exhand/glove.h"

#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define TURN_RAD 6.283185307179586
#define ROWS_MAX 7000
#define COLS_MAX 34

static int nearest(double v) { return (int)(v < 0 ? v - 0.5 : v + 0.5); /* the cast cuts it off */ }

/* --- the files --- */

static double cell[ROWS_MAX][COLS_MAX];

/* Numbers between blanks and commas, lines that end in LF or CR; a line that begins with a
 * letter is none, a word that is no number ends its line. The rows, 0 if it is not there. */
static int read_rows(const char *name, int *cols)
{
    const char *data = getenv("EXH_DATA") ? getenv("EXH_DATA") : "$EXH_DATA";
    static char text[1 << 21];
    char path[512];
    size_t n;
    int rows = 0;
    FILE *f;
    snprintf(path, sizeof path, "%s/%s", data, name);
    f = fopen(path, "rb");
    if (f == NULL) {
        check_note("%s: not there: not tested; EXH_DATA names the place of data", path);
        return 0;
    }
    n = fread(text, 1, sizeof text - 1, f);
    fclose(f);
    CHECK(n < sizeof text - 1, "%s: too long", path);
    text[n] = '\0';
    *cols = 0;
    for (char *at = text; *at != '\0'; at += strcspn(at, "\r\n"), at += strspn(at, "\r\n")) {
        int c = 0;
        char *p = at;
        for (;;) {
            char *end;
            double v;
            p += strspn(p, " ,\t");
            if (*p == '\r' || *p == '\n' || *p == '\0') { break; }
            v = strtod(p, &end);
            if (end == p || c == COLS_MAX || rows == ROWS_MAX) { break; }
            cell[rows][c++] = v;
            p = end;
        }
        if (c == 0) { continue; }
        CHECK(*cols == 0 || c == *cols, "%s: row %d has %d numbers", path, rows, c);
        *cols = c;
        rows++;
    }
    return rows;
}

/* --- CyberGlove --- */

/* rad per code of the columns that are on a grid (SOURCE.md of both), 0 of the others. */
struct recording {
    const char *name;
    int rows, first, cols; /* expected; where the angles begin, and how many */
    int repeated_percent;  /* rows that repeat the one before; -1: not said */
    const double *step_rad;
};

static const double graspdb[22 + 1] = {0.01584, 0.01459, 0.01427, 0.00502, 0.01616, 0.01459, 0, 0,
    0.01725, 0.01804, 0, 0, 0.01757, 0.01788, 0, 0, 0.01663, 0.01820, 0, 0, 0.00910, 0.00863,
    0.00392};
static const double libras[22] = {0.01584, 0.01459, 0.01427, 0.00502, 0.01616, 0.01459, 0.00753, 0,
    0.01725, 0.01804, 0.01051, 0, 0.01757, 0.01788, 0.01051, 0, 0.01663, 0.01820, 0.00988, 0,
    0.00910, 0.00863};

static const struct recording recording[] = {
    {"glove-cyberglove-graspdb14/00_calib-rad-su01.txt", 6674, 7, 23, 74, graspdb},
    {"glove-cyberglove-graspdb14/10_ex01-rad-003-grasp-su04.txt", 1145, 7, 23, 60, graspdb},
    {"glove-cyberglove-graspdb14/04_ex01-rad-045-grasp-su03.txt", 276, 7, 23, 47, graspdb},
    {"glove-cyberglove-libras-alphabet/alphabet.csv", -1, 0, 22, -1, libras},
};

/* A glove that reads `scale` A/D codes a device code, zero at zero. The columns on the grid
 * are its sensors, one after the other; column[] is which. */
struct chain {
    struct exh_glove_cal cal;
    struct exh_glove_cfg cfg;
    struct exh_glove s;
    int column[EXH_GLOVE_SENSORS], scale;
    unsigned sensors;
};

static void set_up(
    struct chain *c, const struct recording *r, int scale, const struct exh_glove_par *par)
{
    memset(c, 0, sizeof *c);
    c->scale = scale;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        c->cal.sensor[i].of[0] = c->cal.sensor[i].of[1] = EXH_GLOVE_NONE;
    }
    for (int col = 0; col < r->cols; col++) {
        struct exh_glove_sensor *s = &c->cal.sensor[c->sensors];
        if (r->step_rad[col] == 0) { continue; }
        s->gain_turnpraw_q38 =
            (int32_t)(r->step_rad[col] / TURN_RAD / scale * 274877906944.0 + 0.5);
        s->low_raw = (int16_t)(-200 * scale);
        s->high_raw = (int16_t)(100 * scale);
        c->cal.present |= 1u << c->sensors;
        c->column[c->sensors++] = col;
    }
    CHECK_EQ_I64(exh_glove_setup(&c->cfg, par, &c->cal, (struct exh_period){1, 60}), 0);
}

static int code_of(const struct recording *r, int row, int col)
{
    return nearest(cell[row][r->first + col] / r->step_rad[col]);
}

static void feed(
    struct chain *c, const struct recording *r, int row, int32_t angle[EXH_GLOVE_SENSORS])
{
    struct exh_glove_in in = {{0}, 0};
    for (unsigned i = 0; i < c->sensors; i++) {
        in.raw[i] = (int16_t)(code_of(r, row, c->column[i]) * c->scale);
    }
    CHECK(exh_glove_step(&c->s, &c->cfg, &in, angle) == 0, "%s row %d: a fault", r->name, row);
}

/* The default but for the order: 11 bits, 20 codes of hysteresis; or 16 bits and none. */
static struct exh_glove_par par_of(int order, int bits, int hyst_raw)
{
    const struct exh_signal *row = exh_glove_rows;
    const struct exh_glove_par par = {order, 20 * 65536, bits, hyst_raw * 65536, row[4].dflt,
        row[5].dflt, row[6].dflt, row[7].dflt, row[8].dflt};
    return par;
}

/* Every angle: its code comes back, and it is the file's to the rounding of gain and angle. */
static double check_angles(
    const struct chain *c, const struct recording *r, int row, const int32_t *angle)
{
    double worst = 0;
    for (unsigned i = 0; i < c->sensors; i++) {
        const int col = c->column[i], code = code_of(r, row, col);
        const double rad = angle[i] * (TURN_RAD / 4294967296.0), file = cell[row][r->first + col];
        const double off = fabs(rad - file);
        const double bound =
            abs(code) * c->scale * (TURN_RAD / 549755813888.0) + TURN_RAD / 8589934592.0;
        CHECK(nearest(rad / r->step_rad[col]) == code, "%s row %d column %d: code %d", r->name, row,
            col + 1, code);
        CHECK(off <= bound * 1.000001, "%s row %d column %d: %.9g, %.9g", r->name, row, col + 1,
            rad, file);
        worst = off > worst ? off : worst;
    }
    return worst;
}

/* The premise: value / step is a whole number, in every listed column and in no other. */
static void check_grid(const struct recording *r, int rows)
{
    for (int col = 0; col < r->cols; col++) {
        for (int row = 0; row < rows && r->step_rad[col] > 0; row++) {
            const double codes = cell[row][r->first + col] / r->step_rad[col];
            CHECK(fabs(codes - nearest(codes)) < 1e-9, "%s row %d column %d: %.9g", r->name, row,
                col + 1, codes);
        }
    }
}

static int same_row(const struct recording *r, int a, int b)
{
    return memcmp(&cell[a][r->first], &cell[b][r->first], (size_t)r->cols * sizeof cell[0][0]) == 0;
}

TEST(codes_come_back_exactly)
{
    for (size_t k = 0; k < LEN(recording); k++) {
        static const struct {
            int scale, bits, hyst;
        } as[] = {{1, 16, 0}, {128, 11, 20}, {128, 12, 16}};
        const struct recording *r = &recording[k];
        int cols = 0;
        const int rows = read_rows(r->name, &cols);
        double worst = 0;
        struct chain c;
        if (rows == 0) { continue; }
        CHECK(r->rows < 0 || rows == r->rows, "%s: %d rows", r->name, rows);
        CHECK(cols == r->first + r->cols, "%s: %d columns", r->name, cols);
        check_grid(r, rows);
        for (size_t n = 0; n < LEN(as); n++) {
            const struct exh_glove_par par = par_of(0, as[n].bits, as[n].hyst);
            set_up(&c, r, as[n].scale, &par);
            for (int row = 0; row < rows; row++) {
                int32_t angle[EXH_GLOVE_SENSORS];
                double off;
                feed(&c, r, row, angle);
                off = check_angles(&c, r, row, angle);
                worst = off > worst ? off : worst;
            }
        }
        check_note("%s: %d rows of %u sensors, all codes back, angles within %.2g urad", r->name,
            rows, c.sensors, worst * 1e6);
    }
}

/* Unfiltered, no angle moves while the row repeats; filtered, none does once it has settled,
 * and then it is the file's, exactly as without. */
TEST(angles_stand_still_while_the_row_repeats)
{
    for (size_t k = 0; k < LEN(recording); k++) {
        const struct recording *r = &recording[k];
        const struct exh_glove_par plain = par_of(0, 11, 20), filtered = par_of(2, 11, 20);
        int cols = 0, run = 0, repeated = 0, settled = 0;
        const int rows = read_rows(r->name, &cols);
        int32_t angle[2][EXH_GLOVE_SENSORS], last[EXH_GLOVE_SENSORS];
        struct chain c, f;
        if (rows == 0) { continue; }
        set_up(&c, r, 128, &plain);
        set_up(&f, r, 128, &filtered);
        for (int row = 0; row < rows; row++) {
            memcpy(last, angle[0], sizeof last);
            feed(&c, r, row, angle[0]);
            feed(&f, r, row, angle[1]);
            run = row > 0 && same_row(r, row, row - 1) ? run + 1 : 0;
            repeated += run > 0;
            CHECK(run == 0 || memcmp(last, angle[0], sizeof last) == 0, "%s row %d", r->name, row);
            if (run < 12) { continue; } /* 0.2 s at 60 Hz and 20 Hz */
            settled++;
            CHECK(memcmp(angle[0], angle[1], sizeof last) == 0, "%s row %d: not settled", r->name,
                row);
        }
        CHECK(r->repeated_percent < 0 || abs(100 * repeated / rows - r->repeated_percent) <= 1,
            "%s: %d of %d rows repeat", r->name, repeated, rows);
        check_note("%s: %d of %d rows repeat, %d of them settled behind 20 Hz: no angle moved",
            r->name, repeated, rows, settled);
    }
}

/* --- a bend-sensor glove at rest --- */

#define VMG_FIRST   2 /* device tick, host time */
#define VMG_SENSORS 23
#define VMG_RAW     60 /* A/D codes a count: 0 .. 1000 over 18.3 V of the card */

static int32_t vmg_q16(int row, int i)
{
    return (int32_t)((cell[row][VMG_FIRST + i] - 500) * VMG_RAW * 65536);
}

/* How often the quantizer's value changes from `from` on. */
static int changes(int i, int from, int rows, int bits, int hyst_counts)
{
    const struct exh_quantizer_par par = {bits, hyst_counts * VMG_RAW * 65536};
    struct exh_quantizer_cfg cfg;
    struct exh_quantizer q;
    int32_t last = 0;
    int n = 0;
    memset(&q, 0, sizeof q);
    CHECK_EQ_I64(exh_quantizer_setup(&cfg, &par), 0);
    for (int row = from; row < rows; row++) {
        const int32_t v = exh_quantizer_step(&q, &cfg, vmg_q16(row, i));
        n += row > from && v != last;
        last = v;
    }
    return n;
}

TEST(a_hand_at_rest_has_stable_bits)
{
    int cols = 0, live = 0, worst_bits = 99, tried = 0, without = 0;
    const int rows = read_rows("glove-vmg30/rest-0.txt", &cols),
              from = rows - 100; /* its last second */
    char line[400] = "";
    if (rows == 0) { return; }
    CHECK(rows == 680 && cols == 33, "%d rows of %d", rows, cols);
    for (int i = 0; i < VMG_SENSORS; i++) {
        double low = 1e9, high = -1e9;
        int pp, bits = 0;
        for (int row = from; row < rows; row++) {
            const double v = cell[row][VMG_FIRST + i];
            low = v < low ? v : low;
            high = v > high ? v : high;
        }
        pp = (int)(high - low);
        if (pp == 0) { continue; } /* stuck at an end, or as still as its 10 bits */
        while (pp << (bits + 1) <= 1000) { bits++; } /* floor(log2(span / peak to peak)) */
        live++;
        if (pp <= 8) { worst_bits = bits < worst_bits ? bits : worst_bits; }
        snprintf(line + strlen(line), sizeof line - strlen(line), " %d:%d", i, pp);
        for (int b = 1; b <= 16 && pp * VMG_RAW <= 65536 >> b;
             b++) { /* a step is no less than the noise */
            tried++;
            without += changes(i, from, rows, b, 0) > 1;
            CHECK(changes(i, from, rows, b, pp) <= 1, "sensor %d, %d counts peak to peak, %d bits",
                i, pp, b);
        }
    }
    CHECK(live >= 3, "%d live channels", live);
    CHECK(without >= 10, "without hysteresis %d move", without); /* or this shows nothing */
    CHECK(worst_bits >= 6 && worst_bits <= 9, "%d", worst_bits);
    check_note(
        "vmg30 at rest, sensor:counts peak to peak%s; those within 8 have %d or more stable bits",
        line, worst_bits);
    check_note("with hysteresis of as much no value moves twice at any number of bits; without, %d "
               "of %d do",
        without, tried);
}

TEST_MAIN("sim/glove_recordings", codes_come_back_exactly, angles_stand_still_while_the_row_repeats,
    a_hand_at_rest_has_stable_bits);
