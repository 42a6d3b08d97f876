/* SPDX-License-Identifier: MIT */
#include "tokens.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int tokens_complain(struct tokens *w, const char *format, ...)
{
    va_list args;
    int at;
    if (w->error[0]) { return 1; }
    at = snprintf(w->error, w->error_B, "%s:%d: ", w->file, w->line);
    if (at < 0 || (size_t)at >= w->error_B) { return 1; }
    va_start(args, format);
    vsnprintf(w->error + at, w->error_B - (size_t)at, format, args);
    va_end(args);
    return 1;
}

int tokens_part(struct tokens *w, char *text)
{
    w->n = 0;
    text[strcspn(text, "#\r\n")] = '\0';
    for (char *s = strtok(text, " \t"); s; s = strtok(NULL, " \t")) {
        if (w->n == TOKENS_MAX) {
            return tokens_complain(w, "more than %d words: put less on one line", TOKENS_MAX);
        }
        w->word[w->n++] = s;
    }
    return 0;
}

/* What the line is about: its first word, and the second where there is one. */
static int complain(struct tokens *w, int from, const char *what)
{
    return tokens_complain(
        w, "%s%s%s: %s", w->word[0], from > 1 ? " " : "", from > 1 ? w->word[1] : "", what);
}

static int number(struct tokens *w, int from, int at, const struct pair *p, int i)
{
    char text[160], *end;
    const char *s = at < w->n ? w->word[at] : "";
    const double v = strtod(s, &end);
    if (end == s || *end) {
        snprintf(text, sizeof text,
            "%s: %d number%s must follow, not \"%.30s\": add what is missing", p->key, p->numbers,
            p->numbers > 1 ? "s" : "", s);
        return complain(w, from, text);
    }
    if (!(v >= p->lo && v <= p->hi)) {
        snprintf(text, sizeof text, "%s %.30s (allowed %g..%g): give a number in that range",
            p->key, s, p->lo, p->hi);
        return complain(w, from, text);
    }
    ((double *)p->to)[i] = v;
    return 0;
}

static struct pair *find(struct tokens *w, int from, const char *key, struct pair *p, int n)
{
    char text[320];
    size_t at;
    for (int i = 0; i < n; i++) {
        if (strcmp(p[i].key, key) == 0) { return &p[i]; }
    }
    at = (size_t)snprintf(text, sizeof text, "%.30s: no such word here: use one of", key);
    for (int i = 0; i < n && at < sizeof text; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, " %s", p[i].key);
    }
    complain(w, from, text);
    return NULL;
}

static int one_pair(struct tokens *w, int from, int *at, struct pair *p, int n)
{
    char text[100];
    struct pair *a = find(w, from, w->word[*at], p, n);
    if (a == NULL) { return 1; }
    if (a->seen) {
        snprintf(text, sizeof text, "%s: given twice: leave one out", a->key);
        return complain(w, from, text);
    }
    a->seen = 1;
    *at += 1;
    for (int i = 0; i < a->numbers; i++, *at += 1) {
        if (number(w, from, *at, a, i)) { return 1; }
    }
    if (a->numbers == 0) {
        if (*at == w->n) {
            snprintf(text, sizeof text, "%s: a word must follow: add it", a->key);
            return complain(w, from, text);
        }
        *(const char **)a->to = w->word[*at];
        *at += 1;
    }
    return 0;
}

int tokens_pairs(struct tokens *w, int from, struct pair *p, int n)
{
    for (int at = from; at < w->n;) {
        if (one_pair(w, from, &at, p, n)) { return 1; }
    }
    for (int i = 0; i < n; i++) {
        if (p[i].must && !p[i].seen) {
            char text[100];
            snprintf(text, sizeof text, "%s is missing: add `%s` and its %s", p[i].key, p[i].key,
                p[i].numbers == 0  ? "name"
                : p[i].numbers > 1 ? "numbers"
                                   : "number");
            return complain(w, from, text);
        }
    }
    return 0;
}
