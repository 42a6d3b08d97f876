/* SPDX-License-Identifier: MIT */
/* Diagrams: boxes and wires whose texts name rows of the signal and device tables, so
 * that a picture cannot keep a name or a value that the code has dropped. */
#ifndef CLI_DIAGRAM_H
#define CLI_DIAGRAM_H

#include <stdio.h>

/* In a text, {p:k} becomes a parameter of the drop scene with its default and unit,
 * {s:q} an output with its unit, {P:mat_k} and {S:d} those of the bilateral scene, {d:mass} a value
 * of the simulated device. Places are px / 10. */
struct diagram_box {
    int x, y, w, h;
    const char *title;
    const char *line[6]; /* NULL ends them */
};
struct diagram_wire {
    int n; /* corners */
    int at[4][2];
    const char *label;
    int x, y; /* where the label is centred */
};
struct diagram {
    const char *name, *title;
    int w, h;
    const struct diagram_box *box;
    int boxes;
    const struct diagram_wire *wire;
    int wires;
    const char *const *svg; /* what is neither, line by line, px; NULL ends it, NULL: nothing */
};

extern const struct diagram diagrams[];
extern const int diagrams_n;

/* SVG to f; 0, or 1 after a line on stderr: a text names a row that does not exist. */
int diagram_draw(FILE *f, const struct diagram *d);

#endif
