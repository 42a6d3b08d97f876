/* SPDX-License-Identifier: MIT */
#include "lab/diagram/diagram.h"

#include "lab/lab.h"
#include "base/option.h"
#include "base/param.h"

#include "bilateral/bilateral.h"
#include "drop/drop.h"
#include "sim/device.h"

#include <string.h>

/* Units as people write them. */
static const struct {
    const char *ascii, *text;
} unit[] = {
    {"n", "N"},         {"a", "A"},   {"m_per_s", "m/s"}, {"n_per_m", "N/m"}, {"ns_per_m", "Ns/m"},
    {"n_per_a", "N/A"}, {"hz", "Hz"}, {"n_per_s", "N/s"}, {"per_a", "per A"}, {"n_per_v", "N/V"},
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
             cli_signal_value(r, p->active[exh_signal_find(p->table, r->id, 0)]),
             r->unit[0] ? " " : "", unit_text(r->unit));
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

static int row_of(char *to, size_t cap, char kind, const char *name)
{
    switch (kind) {
    case 'p': return parameter(to, cap, &exh_scene_drop, name);
    case 's': return output(to, cap, &exh_scene_drop, name);
    case 'P': return parameter(to, cap, &exh_scene_bilateral, name);
    case 'S': return output(to, cap, &exh_scene_bilateral, name);
    default: return device(to, cap, name);
    }
}

/* The text with every {kind:name} replaced, in a buffer that the next call reuses. */
static const char *expand(const char *text, int *failed)
{
    static char out[320];
    size_t n = 0;
    while (*text != '\0' && n + 64 < sizeof out) {
        char name[32] = "", row[64];
        char kind;
        if (sscanf(text, "{%c:%31[a-z0-9_]}", &kind, name) != 2) {
            out[n++] = *text++;
            continue;
        }
        if (row_of(row, sizeof row, kind, name)) {
            cli_complain("{%c:%s}: no such row: mend the diagram", kind, name);
            *failed = 1;
            row[0] = '\0';
        }
        n += (size_t)snprintf(out + n, sizeof out - n, "%s", row);
        text = strchr(text, '}') + 1;
    }
    out[n] = '\0';
    return out;
}

static void draw_box(FILE *f, const struct diagram_box *b, int *failed)
{
    const int mid = 10 * b->x + 5 * b->w;
    fprintf(f, "<rect class='box' x='%d' y='%d' width='%d' height='%d' rx='6'/>\n", 10 * b->x,
            10 * b->y, 10 * b->w, 10 * b->h);
    fprintf(f, "<text class='title' x='%d' y='%d'>%s</text>\n", mid, 10 * b->y + 30, b->title);
    for (int i = 0; i < 6 && b->line[i] != NULL; i++) {
        fprintf(f, "<text x='%d' y='%d'>%s</text>\n", mid, 10 * b->y + 62 + 27 * i,
                expand(b->line[i], failed));
    }
}

static void draw_wire(FILE *f, const struct diagram_wire *w, int *failed)
{
    fprintf(f, "<polyline class='wire' points='");
    for (int i = 0; i < w->n; i++) {
        fprintf(f, "%s%d,%d", i ? " " : "", 10 * w->at[i][0], 10 * w->at[i][1]);
    }
    fprintf(f, "'/>\n<text class='label' x='%d' y='%d'>%s</text>\n", 10 * w->x, 10 * w->y,
            expand(w->label, failed));
}

int diagram_draw(FILE *f, const struct diagram *d)
{
    int failed = 0;
    exh_scene_drop.defaults();
    exh_scene_bilateral.defaults();
    fprintf(f,
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %d %d' font-family='DejaVu "
            "Sans, sans-serif' font-size='18' text-anchor='middle'>\n"
            "<title>%s</title>\n<style>.box{fill:#f4f7fb;stroke:#1f5fbf;stroke-width:2}"
            ".wire{fill:none;stroke:#555555;stroke-width:2.5;marker-end:url(#tip)}"
            ".title{font-weight:bold;font-size:21px}.label{fill:#b03020;font-size:17px}</style>\n"
            "<defs><marker id='tip' viewBox='0 0 10 10' refX='9' refY='5' markerWidth='7' "
            "markerHeight='7' orient='auto'><path d='M0,0 L10,5 L0,10 z' fill='#555555'/>"
            "</marker></defs>\n<rect width='%d' height='%d' fill='#ffffff'/>\n",
            10 * d->w, 10 * d->h, d->title, 10 * d->w, 10 * d->h);
    fprintf(f, "<text class='title' x='%d' y='36'>%s</text>\n", 5 * d->w, d->title);
    for (int i = 0; i < d->boxes; i++) { draw_box(f, &d->box[i], &failed); }
    for (int i = 0; i < d->wires; i++) { draw_wire(f, &d->wire[i], &failed); }
    for (int i = 0; d->svg != NULL && d->svg[i] != NULL; i++) {
        fprintf(f, "%s\n", expand(d->svg[i], &failed));
    }
    fprintf(f, "</svg>\n");
    return failed;
}

int cli_diagram(int argc, char **argv)
{
    const struct cli_command c = {
        "diagram",
        "NAME",
        "Draws a block diagram as SVG on standard output, from the signal "
        "and device tables: overview, setup, identification, principle, geometry or bilateral.",
        NULL,
        0,
        1};
    const char *name = NULL;
    const int err = cli_parse(&c, argc, argv, &name);
    if (err) { return err == 1 ? 0 : err; }
    for (int i = 0; i < diagrams_n; i++) {
        if (strcmp(name, diagrams[i].name) == 0) { return diagram_draw(stdout, &diagrams[i]); }
    }
    cli_complain(
        "%s: no such diagram (overview, setup, identification, principle, geometry, bilateral)",
        name);
    return 2;
}
