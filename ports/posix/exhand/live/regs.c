/* SPDX-License-Identifier: MIT */
/* exhand regs: the registers of a scene, as a Modbus client finds them. */
#include "base/cli.h"
#include "base/names.h"
#include "base/option.h"
#include "base/param.h"
#include "base/scenes.h"

#include "exhand/regs.h"

#include <stdio.h>
#include <string.h>

#define CELL_B  32
#define COLUMNS 12

enum style { TEXT, MARKDOWN, CSV };

/* --- lines --- */

/* In the order of the columns; a line leaves out what it has not. */
struct line {
    char cell[COLUMNS][CELL_B];
    const char *help; /* the last column, as long as it is */
};
enum column {
    KIND,
    ADDRESS,
    REFERENCE,
    FLOAT_AT,
    FLOAT_REF,
    NAME,
    UNIT,
    FORMAT,
    MIN,
    MAX,
    DEFAULT,
    WHEN
};
#define ADDRESSED (1u << KIND | 1u << ADDRESS | 1u << REFERENCE | 1u << NAME)
#define FIXED     (ADDRESSED | 1u << FORMAT)
#define ALL       ((1u << COLUMNS) - 1u)

static const char *const title[COLUMNS] = {"table", "address", "reference", "float", "float ref",
    "name", "unit", "format", "min", "max", "default", "when"};
static const int width[COLUMNS] = {8, 7, 9, 6, 9, 20, 10, 9, 14, 14, 14, 8};

static void put_quoted(const char *s)
{
    if (strpbrk(s, ",\"") == NULL) {
        fputs(s, stdout);
        return;
    }
    putchar('"');
    for (; *s != '\0'; s++) { printf(*s == '"' ? "\"\"" : "%c", *s); }
    putchar('"');
}

/* columns: a bit for each that is shown. */
static void put(enum style style, unsigned columns, const struct line *l)
{
    if (style == MARKDOWN) { fputs("| ", stdout); }
    for (unsigned i = 0; i < COLUMNS; i++) {
        if (!(columns >> i & 1u)) { continue; }
        if (style == TEXT) { printf("%-*s ", width[i], l->cell[i]); }
        if (style == MARKDOWN) { printf("%s | ", l->cell[i]); }
        if (style == CSV) {
            put_quoted(l->cell[i]);
            putchar(',');
        }
    }
    if (style == CSV) {
        put_quoted(l->help);
    } else {
        fputs(l->help, stdout);
    }
    puts(style == MARKDOWN ? " |" : "");
}

static void put_titles(enum style style, unsigned columns)
{
    struct line l = {.help = "what"};
    for (unsigned i = 0; i < COLUMNS; i++) { snprintf(l.cell[i], CELL_B, "%s", title[i]); }
    put(style, columns, &l);
    if (style == MARKDOWN) {
        putchar('|');
        for (unsigned i = 0; i < COLUMNS; i++) { fputs(columns >> i & 1u ? "--|" : "", stdout); }
        puts("--|");
    }
}

static const char *kind_name(unsigned kind)
{
    static const char *const name[] = {"", "coil", "discrete", "holding", "input"};
    return name[kind];
}

/* Where; and as those count who begin at 1 and put the table's digit before. */
static void put_at(char address[CELL_B], char reference[CELL_B], unsigned kind, uint32_t at)
{
    static const unsigned digit[] = {0, 0, 1, 4, 3};
    snprintf(address, CELL_B, "0x%04X", (unsigned)at);
    snprintf(reference, CELL_B, "%u%05u", digit[kind], (unsigned)at + 1);
}

static struct line line_at(unsigned kind, uint32_t at, const char *help)
{
    struct line l = {.help = help};
    snprintf(l.cell[KIND], CELL_B, "%s", kind_name(kind));
    put_at(l.cell[ADDRESS], l.cell[REFERENCE], kind, at);
    return l;
}

/* --- what every scene has --- */

static void fixed_row(
    enum style style, unsigned columns, unsigned kind, uint32_t at, const struct exh_regs_row *row)
{
    struct line l = line_at(kind, at, row->help);
    snprintf(l.cell[NAME], CELL_B, "%s", row->name);
    snprintf(l.cell[FORMAT], CELL_B, "%s", row->format);
    put(style, columns, &l);
}

static const char *bit_name(unsigned word, unsigned k)
{
    switch (word) {
    case EXH_BITS_FAULTS:
    case EXH_BITS_PRESENT: return exh_fault_name(k);
    case EXH_BITS_DIN: return k < names_din.n && names_din.says[k] ? names_word(&names_din, k) : "";
    case EXH_BITS_STATE: return exh_state_name(k);
    case EXH_BITS_LIMITS: return exh_limit_name(k);
    default: return exh_arm_name(k);
    }
}

static void put_bits(enum style style, unsigned columns)
{
    for (unsigned w = 0; w < EXH_BITS; w++) {
        for (unsigned k = 0; k < 32; k++) {
            struct line l = line_at(EXH_REGS_DISCRETE, 32 * w + k, exh_regs_bits_row[w].help);
            if (bit_name(w, k)[0] == '\0') { continue; }
            snprintf(l.cell[NAME], CELL_B, "%s.%s", exh_regs_bits_row[w].name, bit_name(w, k));
            snprintf(l.cell[FORMAT], CELL_B, "bit");
            put(style, columns, &l);
        }
    }
}

static void put_fixed(enum style style, unsigned columns)
{
    for (unsigned i = 0; i < EXH_COILS; i++) {
        fixed_row(style, columns, EXH_REGS_COIL, i, &exh_regs_coil_row[i]);
    }
    put_bits(style, columns);
    for (unsigned i = 0; i < EXH_HEADS; i++) {
        fixed_row(style, columns, EXH_REGS_INPUT, EXH_REGS_HEAD_AT + 2 * i, &exh_regs_head_row[i]);
    }
    for (unsigned i = 0; i < EXH_TRACE_HEADS; i++) {
        fixed_row(
            style, columns, EXH_REGS_INPUT, EXH_REGS_TRACE_AT + 2 * i, &exh_regs_trace_row[i]);
    }
    for (unsigned i = 0; i < EXH_REGS_TRACE_SET; i++) {
        fixed_row(style, columns, EXH_REGS_HOLDING, EXH_REGS_TRACE_AT + 2 * i,
            &exh_regs_trace_row[EXH_TRACE_HEAD_EVERY + i]);
    }
}

static void put_blocks(enum style style)
{
    put_titles(style, ADDRESSED);
    for (unsigned i = 0; i < EXH_REGS_BLOCKS; i++) {
        const struct exh_regs_block *b = &exh_regs_blocks[i];
        struct line l = line_at(b->kind, b->at, b->help);
        snprintf(l.cell[NAME], CELL_B, "%s", b->name);
        put(style, ADDRESSED, &l);
    }
}

/* --- what the scene has --- */

static void name_cells(
    struct line *l, const struct exh_signal *row, unsigned instance, unsigned of, int is_float)
{
    if (of > 1) {
        snprintf(l->cell[NAME], CELL_B, "%s[%u]", row->name, instance);
    } else {
        snprintf(l->cell[NAME], CELL_B, "%s", row->name);
    }
    snprintf(l->cell[UNIT], CELL_B, "%s", row->unit);
    if (is_float) {
        snprintf(l->cell[FORMAT], CELL_B, "f32");
    } else if (row->frac > 0) {
        snprintf(l->cell[FORMAT], CELL_B, "i32 q%u", (unsigned)row->frac);
    } else {
        snprintf(l->cell[FORMAT], CELL_B, "i32");
    }
    snprintf(l->cell[WHEN], CELL_B, "%s", cli_signal_when(row));
}

static void range_cells(struct line *l, const struct exh_signal *row, int32_t dflt)
{
    snprintf(l->cell[MIN], CELL_B, "%.10g", cli_signal_value(row, row->min));
    snprintf(l->cell[MAX], CELL_B, "%.10g", cli_signal_value(row, row->max));
    snprintf(l->cell[DEFAULT], CELL_B, "%.10g", cli_signal_value(row, dflt));
}

/* A table's two blocks of one kind. */
struct values {
    unsigned kind;
    const struct exh_signal_table *table;
    const int32_t *dflt; /* the scene's own; NULL: outputs */
    uint32_t raw_at, float_at;
};

static struct values outputs_of(const struct exh_scene *sc)
{
    return (struct values){
        EXH_REGS_INPUT, sc->signals, NULL, EXH_REGS_SIGNAL_AT, EXH_REGS_SIGNAL_FLOAT_AT};
}

static struct values params_of(const struct exh_scene *sc, unsigned kind)
{
    const struct exh_params *p = sc->params;
    return (struct values){kind, p ? p->table : NULL, p ? p->staged : NULL, EXH_REGS_PARAM_AT,
        EXH_REGS_PARAM_FLOAT_AT};
}

enum which { RAW, FLOAT, BOTH };

/* In the order of their registers; both: raw and float in one line. */
static void put_values(enum style style, unsigned columns, struct values v, enum which which)
{
    uint32_t i = 0;
    for (uint16_t g = 0; v.table != NULL && g < v.table->groups; g++) {
        const struct exh_signal_group *grp = &v.table->group[g];
        for (uint32_t k = 0; k < (uint32_t)grp->rows * grp->instances; k++, i++) {
            const struct exh_signal *row = &grp->row[k % grp->rows];
            struct line l =
                line_at(v.kind, (which == FLOAT ? v.float_at : v.raw_at) + 2 * i, row->help);
            if (which == BOTH) {
                put_at(l.cell[FLOAT_AT], l.cell[FLOAT_REF], v.kind, v.float_at + 2 * i);
            }
            name_cells(&l, row, k / grp->rows, grp->instances, which == FLOAT);
            if (v.dflt != NULL) { range_cells(&l, row, v.dflt[i]); }
            put(style, columns, &l);
        }
    }
}

static void heading(enum style style, const char *text)
{
    printf(style == MARKDOWN ? "\n### %s\n\n" : "\n%s\n", text);
}

static void put_map(enum style style, const struct exh_scene *sc)
{
    const unsigned out = ALL & ~(1u << KIND | 1u << MIN | 1u << MAX | 1u << DEFAULT | 1u << WHEN);
    const unsigned par = ALL & ~(1u << KIND);
    put_blocks(style);
    heading(style, "Coils, discrete inputs and head");
    put_titles(style, FIXED);
    put_fixed(style, FIXED);
    heading(style, "Outputs: input registers");
    put_titles(style, out);
    put_values(style, out, outputs_of(sc), BOTH);
    heading(style, "Parameters: holding registers staged, the input registers of the same "
                   "addresses in effect");
    put_titles(style, par);
    put_values(style, par, params_of(sc, EXH_REGS_HOLDING), BOTH);
}

/* One row for each value of each block. */
static void put_csv(const struct exh_scene *sc)
{
    const unsigned columns = ALL & ~(1u << FLOAT_AT | 1u << FLOAT_REF);
    put_titles(CSV, columns);
    put_fixed(CSV, columns);
    put_values(CSV, columns, outputs_of(sc), RAW);
    put_values(CSV, columns, outputs_of(sc), FLOAT);
    for (unsigned kind = EXH_REGS_INPUT; kind >= EXH_REGS_HOLDING; kind--) {
        put_values(CSV, columns, params_of(sc, kind), RAW);
        put_values(CSV, columns, params_of(sc, kind), FLOAT);
    }
}

/* --- command --- */

static const struct exh_scene *scene_named(const char *name)
{
    const struct exh_scene *sc = cli_scene_find(name);
    char all[256] = "";
    if (sc != NULL) { return sc; }
    for (size_t i = 0; i < CLI_SCENES; i++) {
        const size_t at = strlen(all);
        (void)snprintf(all + at, sizeof all - at, "%s%s", i ? ", " : "", cli_scenes[i]->name);
    }
    cli_complain("--scene: %.60s: no such scene: give one of %s", name, all);
    return NULL;
}

int cli_regs(int argc, char **argv)
{
    const char *name = "drop";
    int markdown = 0, csv = 0, fixed = 0;
    const struct cli_option option[] = {
        {"scene", CLI_TEXT, &name, 0, 0, "NAME", "whose registers (default drop)"},
        {"markdown", CLI_FLAG, &markdown, 0, 0, NULL, "as tables of a document"},
        {"csv", CLI_FLAG, &csv, 0, 0, NULL, "one row for each value of each block, for programs"},
        {"fixed", CLI_FLAG, &fixed, 0, 0, NULL,
            "only what every scene has: blocks, head, bits, coils"},
    };
    const struct cli_command c = {"regs", "[options]",
        "Prints the Modbus registers of a scene: protocol addresses from 0 and references from 1. "
        "A\n"
        "value is 32 bits in two registers, high word first. Raw times 2^-fraction is in the "
        "unit;\n"
        "the float is the same as binary32. docs/MODBUS.md says how to read and write them.",
        option, sizeof option / sizeof option[0], 0};
    const int err = cli_parse(&c, argc, argv, NULL);
    const struct exh_scene *sc;
    if (err) { return err == 1 ? 0 : err; }
    if (csv + markdown > 1 || csv + fixed > 1) {
        cli_complain(
            "--csv, --markdown or --fixed: CSV is the whole map, in one table: give one of them");
        return 2;
    }
    sc = scene_named(name);
    if (sc == NULL) { return 2; }
    if (sc->defaults) { sc->defaults(); } /* which names the table of parameters */
    if (csv) {
        put_csv(sc);
    } else if (fixed) {
        put_blocks(markdown ? MARKDOWN : TEXT);
        putchar('\n');
        put_titles(markdown ? MARKDOWN : TEXT, FIXED);
        put_fixed(markdown ? MARKDOWN : TEXT, FIXED);
    } else {
        put_map(markdown ? MARKDOWN : TEXT, sc);
    }
    return 0;
}
