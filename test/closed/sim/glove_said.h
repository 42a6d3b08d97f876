/* SPDX-License-Identifier: MIT */
/* What the tests of exhand glove share: words, files, and numbers in what was said. */
#ifndef TEST_SIM_GLOVE_SAID_H
#define TEST_SIM_GLOVE_SAID_H

#include "said.h"

#include "exhand/glove.h"

#define SENSORS EXH_GLOVE_SENSORS

/* Rows of angles. */
#define ROW_A \
    "0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1.0,1.1,1.2,1.3,1.4,1.5,-0.1,-0.2,-0.3,-0.4,-0.5,-0.6,-" \
    "0.7"
#define ROW_B \
    "0.2,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1.0,1.1,1.2,1.3,1.4,1.5,-0.1,-0.2,-0.3,-0.4,-0.5,-0.6,-" \
    "0.7"

static inline void write_text(const char *path, const char *text)
{
    FILE *f = fopen(path, "wb");
    CHECK(f != NULL && fputs(text, f) >= 0, "%s", path);
    CHECK_EQ_I64(fclose(f), 0);
}

/* The number after the first `word` of a text, or at its n-th column behind it. */
static inline double number_after(const char *text, const char *word, int column)
{
    const char *at = strstr(text, word);
    char *end;
    double v = -1e9;
    CHECK(at != NULL, "no \"%s\" in %s", word, text);
    at = at ? at + strlen(word) : "";
    for (int n = 0; n <= column; n++) {
        while (*at == ' ' || *at == ',') { at++; }
        v = strtod(at, &end);
        at = end;
    }
    return v;
}

#endif
