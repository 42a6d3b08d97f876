/* SPDX-License-Identifier: MIT */
/* Diagrams: texts for Graphviz that name rows of the signal and device tables, so that a picture
 * cannot keep a name or a value that the code has dropped. */
#ifndef CLI_DIAGRAM_H
#define CLI_DIAGRAM_H

#include <stdio.h>

/* Copies a text and expands its marks. {p:k} becomes a parameter of the drop scene with its default
 * and unit, {s:q} an output with its unit. {P:mat_k} and {S:d} are those of the bilateral scene.
 * {d:mass} is a value of the simulated device. {#:crc} is the CRC-32 of the text before it.
 * Returns 0, or 1 after a line on stderr: the text names a row that does not exist. */
int diagram_expand(FILE *in, FILE *out);

#endif
