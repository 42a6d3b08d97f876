/* SPDX-License-Identifier: MIT */
/* exhand regs: what it prints is where the library has it, of every scene; docs/MODBUS.md has it.
 */
#include "said.h"

#include "bilateral/bilateral.h"
#include "bringup/bringup.h"
#include "calibrate/calibrate.h"
#include "drop/drop.h"
#include "glove/glove.h"
#include "guarded/guarded.h"

#include "exhand/error.h"
#include "exhand/regs.h"

#include <math.h>

#define VALUES 512

static struct said s;
static const struct exh_scene *const scenes[] = {&exh_scene_drop, &exh_scene_guarded,
    &exh_scene_bilateral, &exh_scene_glove, &exh_scene_calibrate, &exh_scene_bringup};

TEST(the_documented_table_is_the_one_made_now)
{
    char *dir = said_dir();
    said(&s, dir, cli_regs, WORDS("regs", "--fixed", "--markdown"));
    CHECK(s.status == 0 && s.err[0] == '\0', "status %d: %s", s.status, s.err);
    said_as_document(&s, "docs/MODBUS.md", "exhand regs --fixed --markdown");
    said_clean(dir);
}

static struct exh_regs regs_of(const struct exh_scene *sc)
{
    static int32_t staged[VALUES];
    static uint32_t touched[EXH_REGS_WORDS(VALUES)];
    static struct exh_trace trace;
    static struct exh_trace_frame frame[EXH_TRACE_FRAMES];
    struct exh_regs r = {.name = sc->name,
        .signals = sc->signals,
        .signal = exh_scene_signals(sc),
        .may = EXH_REGS_MAY};
    if (sc->defaults) { sc->defaults(); }
    if (sc->params) {
        CHECK(exh_signal_count(sc->params->table) <= VALUES, "%s: more than this test holds",
            sc->name);
        r.params = sc->params->table;
        r.active = sc->params->active;
        r.wanted = sc->params->staged;
        r.staged = staged;
        r.touched = touched;
    }
    CHECK(exh_regs_setup(&r) == 0, "%s", sc->name);
    CHECK_EQ_I64(exh_trace_setup(&trace, frame, EXH_TRACE_FRAMES, r.signals_n), 0);
    r.trace = &trace;
    return r;
}

/* Field n of a line of the CSV, of those before the help. */
static void field(char to[64], const char *line, int n)
{
    size_t len;
    for (; n > 0; n--) { line += strcspn(line, ",\n") + 1; }
    len = strcspn(line, ",\n");
    CHECK(len < 64, "%s", line);
    memcpy(to, line, len);
    to[len] = '\0';
}

static double float_of(uint32_t bits)
{
    float f;
    memcpy(&f, &bits, sizeof f);
    return (double)f;
}

/* A line of the CSV names registers that can be read; those of parameters hold the default it says.
 */
static void line_holds(const struct exh_regs *r, const char *line, int *lines)
{
    char table[64], address[64], reference[64], format[64], dflt[64];
    uint8_t got[4];
    uint32_t v;
    unsigned long at;
    field(table, line, 0);
    field(address, line, 1);
    field(reference, line, 2);
    field(format, line, 5);
    field(dflt, line, 8);
    at = strtoul(address, NULL, 16);
    CHECK(strtoul(reference + 1, NULL, 10) == at + 1, "%s", line);
    ++*lines;
    if (strcmp(table, "coil") == 0 || strcmp(table, "discrete") == 0) {
        CHECK(exh_regs_read_bits(r, table[0] == 'c' ? EXH_REGS_COIL : EXH_REGS_DISCRETE,
                  (uint16_t)at, 1, got) == 0,
            "%s", line);
        return;
    }
    CHECK(exh_regs_read(
              r, table[0] == 'h' ? EXH_REGS_HOLDING : EXH_REGS_INPUT, (uint16_t)at, 2, got) == 0,
        "%s", line);
    v = (uint32_t)got[0] << 24 | (uint32_t)got[1] << 16 | (uint32_t)got[2] << 8 | got[3];
    if (dflt[0] != '\0') {
        const double want = strtod(dflt, NULL);
        const double is =
            strcmp(format, "f32") == 0
                ? float_of(v)
                : ldexp((double)(int32_t)v, -(strlen(format) > 5 ? atoi(format + 5) : 0));
        CHECK(fabs(is - want) <= 1e-7 * fabs(want), "%.12g: %s", is, line);
    }
}

TEST(every_line_of_every_scene_holds)
{
    char *dir = said_dir();
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        const struct exh_regs r = regs_of(scenes[i]);
        int lines = 0;
        FILE *f;
        char line[512], path[512];
        said(&s, dir, cli_regs, WORDS("regs", "--scene", scenes[i]->name, "--csv"));
        CHECK(s.status == 0 && s.err[0] == '\0', "%s: status %d: %s", scenes[i]->name, s.status,
            s.err);
        snprintf(path, sizeof path, "%s/said.out",
            dir); /* as it is: it may be longer than what was said holds */
        f = fopen(path, "r");
        CHECK(f != NULL && fgets(line, sizeof line, f) && strncmp(line, "table,address,", 14) == 0,
            "%s", line);
        while (fgets(line, sizeof line, f)) { line_holds(&r, line, &lines); }
        fclose(f);
        CHECK(lines > 100 && (unsigned)lines > 2 * r.signals_n + 4 * r.params_n, "%s: %d lines",
            scenes[i]->name, lines);
        check_note("%s: %u outputs, %u parameters, %d rows", scenes[i]->name, (unsigned)r.signals_n,
            (unsigned)r.params_n, lines);
    }
    said_clean(dir);
}

TEST(text_has_names_units_and_ranges)
{
    char *dir = said_dir();
    said(&s, dir, cli_regs, WORDS("regs"));
    CHECK(s.status == 0 && strstr(s.out, "0x5000 ") && strstr(s.out, "n_per_m") &&
              strstr(s.out, "420481"),
        "%s", s.out);
    said(&s, dir, cli_regs, WORDS("regs", "--scene", "nothing"));
    CHECK(s.status == 2 && strstr(s.err, "one of drop, "), "%d: %s", s.status, s.err);
    said(&s, dir, cli_regs, WORDS("regs", "--csv", "--markdown"));
    CHECK(s.status == 2 && strstr(s.err, "give one of them"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST_MAIN("regs_command", the_documented_table_is_the_one_made_now, every_line_of_every_scene_holds,
    text_has_names_units_and_ranges);
