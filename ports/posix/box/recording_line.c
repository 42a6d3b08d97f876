/* SPDX-License-Identifier: MIT */
#include "box/recording_line.h"

#include <string.h>

static int next_char(struct recording_text *t)
{
    const int c = t->at < t->n ? (unsigned char)t->head[t->at++] : getc(t->f);
    t->line_B = c == '\n' || c == '\r' ? 0 : t->line_B + 1;
    t->endless |= t->line_B > RECORDING_LINE_B;
    return t->endless ? EOF : c;
}

static void put_back(struct recording_text *t, int c)
{
    if (c == EOF) { return; }
    if (t->at > 0 && t->at <= t->n && t->head[t->at - 1] == (char)c) {
        t->at--;
    } else {
        ungetc(c, t->f);
    }
}

static int is_end(int c) { return c == EOF || c == '\n' || c == '\r'; }

static int is_blank(const struct recording_text *t, int c)
{
    return c == ' ' || (c == '\t' && t->separator != '\t');
}

static int is_separator(const struct recording_text *t, int c)
{
    if (t->separator) { return c == t->separator; }
    return c == ',' || c == ';' || c == ' ' || c == '\t';
}

static int skip_blanks(struct recording_text *t, int c)
{
    while (is_blank(t, c)) { c = next_char(t); }
    return c;
}

/* Removes quotes around a field, and blanks after it. */
static void trim(const struct recording_text *t, char *field, size_t n)
{
    while (n > 0 && is_blank(t, field[n - 1])) { n--; }
    field[n] = '\0';
    if (t->separator && n >= 2 && field[0] == '"' && field[n - 1] == '"') {
        memmove(field, field + 1, n - 2);
        field[n - 2] = '\0';
    }
}

/* The field that begins with c. Returns whether there was any character. */
static int take_field(struct recording_text *t, int c, char to[RECORDING_FIELD_B])
{
    size_t n = 0;
    c = skip_blanks(t, c);
    for (; !is_end(c) && !is_separator(t, c); c = next_char(t)) {
        if (n < RECORDING_FIELD_B - 1) {
            to[n++] = c == '\0' ? '?' : (char)c;
        } else if (!is_blank(t, c)) {
            to[n - 1] = '?'; /* what is cut off is no number any more */
        }
    }
    trim(t, to, n);
    if (t->separator == 0 && is_blank(t, c)) { /* the separator, if nothing better comes */
        c = skip_blanks(t, c);
        if (c != ',' && c != ';' && !is_end(c)) {
            put_back(t, c);
            c = ' ';
        }
    }
    if (c == '\r') {
        c = next_char(t);
        if (c != '\n') { put_back(t, c); }
        c = '\n';
    }
    t->ended = c == '\n' || c == EOF;
    return c != EOF || n > 0;
}

/* What separates in the first line of head that is not empty. */
static int separator_of(const char *head, size_t n)
{
    static const char one[] = ",;\t";
    size_t from = 0, end;
    while (from < n && (head[from] == '\n' || head[from] == '\r')) { from++; }
    for (end = from; end < n && head[end] != '\n' && head[end] != '\r';) { end++; }
    for (size_t i = 0; one[i] != '\0'; i++) {
        if (memchr(head + from, one[i], end - from) != NULL) { return one[i]; }
    }
    return 0;
}

void recording_text_begin(struct recording_text *t, FILE *f, int one)
{
    static const char mark[] = "\xEF\xBB\xBF"; /* a byte order mark */
    memset(t, 0, sizeof *t);
    t->f = f;
    t->n = fread(t->head, 1, sizeof t->head, f);
    if (t->n >= 3 && memcmp(t->head, mark, 3) == 0) { t->at = 3; }
    if (one) { t->separator = separator_of(t->head + t->at, t->n - t->at); }
}

int recording_text_next(struct recording_text *t, struct recording_line *line)
{
    char behind[RECORDING_FIELD_B];
    int c = next_char(t);
    line->n = 0;
    if (c == EOF) { return 0; }
    do {
        char *to = line->n < RECORDING_COLUMNS ? line->field[line->n] : behind;
        const int some = take_field(t, c, to);
        if (some || line->n > 0) { line->n++; }
        c = t->ended ? EOF : next_char(t);
    } while (!t->ended);
    return line->n > 0;
}
