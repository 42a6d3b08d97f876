/* SPDX-License-Identifier: MIT */
#include "base/lines.h"

int lines_next(FILE *f, char *to, size_t cap_B)
{
    size_t n = 0;
    int c = getc(f);
    if (c == EOF) { return 0; }
    for (; c != EOF && c != '\n' && c != '\r'; c = getc(f)) {
        if (n + 1 == cap_B) { return -1; }
        to[n++] = c == '\0' ? '?' : (char)c;
    }
    to[n] = '\0';
    if (c == '\r' && (c = getc(f)) != '\n' && c != EOF) { ungetc(c, f); }
    return 1;
}
