/* SPDX-License-Identifier: MIT */
#include "lab/diagram/diagram.h"

#include "lab/lab.h"
#include "base/option.h"
#include "base/param.h"

#include "bilateral/bilateral.h"
#include "drop/drop.h"
#include "exhand/bytes.h"
#include "sim/device.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>

/* Units as people write them. */
static const struct {
    const char *ascii, *text;
} unit[] = {
    {"n", "N"},
    {"a", "A"},
    {"m_per_s", "m/s"},
    {"n_per_m", "N/m"},
    {"ns_per_m", "Ns/m"},
    {"n_per_a", "N/A"},
    {"hz", "Hz"},
    {"n_per_s", "N/s"},
    {"per_a", "per A"},
    {"n_per_v", "N/V"},
};

static const char *unit_text(const char *ascii)
{
    for (size_t i = 0; i < sizeof unit / sizeof unit[0]; i++) {
        if (strcmp(unit[i].ascii, ascii) == 0) { return unit[i].text; }
    }
    return ascii;
}

/* As the scene sets them out. */
static int parameter(char *to, size_t cap, const struct exh_scene *sc, const char *name)
{
    const struct exh_params *p = sc->params;
    const struct exh_signal *r = cli_signal_find(p->table, name, NULL);
    if (r == NULL) { return 1; }
    snprintf(to, cap, "%s %.5g%s%s", name,
        cli_signal_value(r, p->active[exh_signal_find(p->table, r->id, 0)]), r->unit[0] ? " " : "",
        unit_text(r->unit));
    return 0;
}

static int output(char *to, size_t cap, const struct exh_scene *sc, const char *name)
{
    const struct exh_signal *r = cli_signal_find(sc->signals, name, NULL);
    if (r == NULL) { return 1; }
    snprintf(to, cap, "%s%s%s", name, r->unit[0] ? " in " : "", unit_text(r->unit));
    return 0;
}

static int device(char *to, size_t cap, const char *name)
{
    for (int i = 0; i < sim_device_rows; i++) {
        const struct sim_device_row *r = &sim_device_row[i];
        if (strcmp(r->name, name) != 0) { continue; }
        snprintf(to, cap, "%.5g%s%s", r->value, r->unit[0] ? " " : "", unit_text(r->unit));
        return 0;
    }
    return 1;
}

/* The text for {kind:name}. crc is that of all that was printed so far. */
static int row_of(char *to, size_t cap, char kind, const char *name, uint32_t crc)
{
    switch (kind) {
    case 'p': return parameter(to, cap, &exh_scene_drop, name);
    case 's': return output(to, cap, &exh_scene_drop, name);
    case 'P': return parameter(to, cap, &exh_scene_bilateral, name);
    case 'S': return output(to, cap, &exh_scene_bilateral, name);
    case 'd': return device(to, cap, name);
    case '#': snprintf(to, cap, "%08" PRIx32, crc); return strcmp(name, "crc") != 0;
    default: return 1;
    }
}

int diagram_expand(FILE *in, FILE *out)
{
    char line[512];
    uint32_t crc = 0;
    exh_scene_drop.defaults();
    exh_scene_bilateral.defaults();
    while (fgets(line, sizeof line, in) != NULL) {
        for (const char *text = line; *text != '\0';) {
            char name[32] = "", row[64] = {*text, '\0'}, kind;
            if (sscanf(text, "{%c:%31[a-z0-9_]}", &kind, name) != 2) {
                text++;
            } else if (row_of(row, sizeof row, kind, name, crc)) {
                cli_complain("{%c:%s}: no such row: mend the diagram", kind, name);
                return 1;
            } else {
                text = strchr(text, '}') + 1;
            }
            crc = exh_crc32(crc, row, (uint32_t)strlen(row));
            fputs(row, out);
        }
    }
    return 0;
}

int cli_diagram(int argc, char **argv)
{
    const struct cli_command c = {"diagram", "FILE",
        "Prints FILE with {p:k}, a row of the signal and device tables, as its name, value and "
        "unit: the block diagrams, test/lab/diagram/*.dot, for Graphviz (make diagrams).",
        NULL, 0, 1};
    const char *name = NULL;
    int err = cli_parse(&c, argc, argv, &name);
    FILE *f;
    if (err) { return err == 1 ? 0 : err; }
    f = fopen(name, "r");
    if (f == NULL) {
        cli_complain("%s: %s", name, strerror(errno));
        return 2;
    }
    err = diagram_expand(f, stdout);
    fclose(f);
    return err;
}
