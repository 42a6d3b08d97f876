/* SPDX-License-Identifier: MIT */
#include "base/lines.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

/* Bytes of the character there that may be shown; 0: none may. */
static size_t shown(const unsigned char *at)
{
    const size_t n = at[0] < 0x80 ? 1 : at[0] < 0xC2 ? 0 : at[0] < 0xE0 ? 2 : at[0] < 0xF0 ? 3 : 4;
    if (at[0] < ' ' || at[0] == 0x7F || at[0] > 0xF4) { return 0; }
    if (at[0] == 0xC2 && at[1] < 0xA0) { return 0; } /* the control characters of Latin-1 */
    for (size_t i = 1; i < n; i++) {
        if ((at[i] & 0xC0) != 0x80) { return 0; } /* also at the end of the text */
    }
    return n;
}

void lines_plain(char *to, size_t cap_B, const char *from)
{
    size_t n = 0;
    while (*from != '\0') {
        const size_t len = shown((const unsigned char *)from);
        if (n + (len ? len : 4) >= cap_B) { break; }
        if (len > 0) {
            memcpy(to + n, from, len);
        } else {
            (void)snprintf(to + n, 5, "\\x%02x", (unsigned char)*from);
        }
        n += len ? len : 4;
        from += len ? len : 1;
    }
    to[n] = '\0';
}

int lines_terminal(int fd)
{
    const char *term = getenv("TERM");
    return isatty(fd) && !(term && strcmp(term, "dumb") == 0);
}
