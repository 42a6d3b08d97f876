/* SPDX-License-Identifier: MIT */
#include "base/near.h"

#include <stdio.h>
#include <string.h>

#define LONG 24 /* longer words are not compared */

struct near near_to(const char *word, size_t len)
{
    /* One letter of three may be off, and two of a long word. */
    const size_t room = len < 3 ? 0 : len < 5 ? 1 : 2;
    const struct near n = {word, len, NULL, room + 1};
    return n;
}

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* Letters to add, take, change, or swap with their neighbour. */
static size_t distance(const char *a, size_t na, const char *b, size_t nb)
{
    size_t d[LONG + 1][LONG + 1];
    for (size_t i = 0; i <= na; i++) {
        for (size_t j = 0; j <= nb; j++) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            d[i][j] = least(d[i - 1][j], d[i][j - 1]) + 1;
            d[i][j] = least(d[i][j], d[i - 1][j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
            }
        }
    }
    return d[na][nb];
}

void near_try(struct near *n, const char *may)
{
    const size_t len = strlen(may);
    size_t off;
    if (n->len > LONG || len > LONG || len == 0) { return; }
    off = distance(n->word, n->len, may, len);
    if (off >= n->off) { return; }
    n->off = off;
    n->best = may;
}

const char *near_text(char text[NEAR_B], const struct near *n, const char *lead)
{
    text[0] = '\0';
    if (n->best) { (void)snprintf(text, NEAR_B, ": did you mean %s%s?", lead, n->best); }
    return text;
}
