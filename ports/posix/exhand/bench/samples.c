/* SPDX-License-Identifier: MIT */
#include "bench/samples.h"

#include "base/fifo.h"
#include "base/lines.h"
#include "base/option.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* Beyond it a double cannot resolve two nanoseconds. */
#define TIME_MAX_S 4e6

int samples_open(struct samples *s, const struct samples_opt *opt)
{
    const int from_stdin = opt->csv == NULL || strcmp(opt->csv, "-") == 0;
    *s = (struct samples){.opt = opt,
        .from = from_stdin ? stdin : fifo_read(opt->csv),
        .name = from_stdin ? "standard input" : opt->csv};
    for (unsigned i = 0; i < 256 && opt->csv == NULL; i++) {
        s->of_byte[i] = (uint8_t)((i >> opt->a & 1) << 1 | (i >> opt->b & 1) |
                                  (opt->index < 0 ? 0 : (i >> opt->index & 1) << 2));
    }
    if (s->from != NULL) { return 0; }
    cli_complain("%s: %s", opt->csv, strerror(errno));
    return 3;
}

void samples_close(struct samples *s)
{
    if (s->from != NULL && s->from != stdin) { fclose(s->from); }
}

double samples_us(const struct samples *s, int64_t gap)
{
    return s->opt->rate_Hz > 0 ? (double)gap * 1e6 / s->opt->rate_Hz : (double)gap / 1e3;
}

/* What can be said at the end of the input. */
static int at_end(const struct samples *s)
{
    if (ferror(s->from)) {
        cli_complain("%s: %s", s->name, strerror(errno));
        return 3;
    }
    if (s->seen == 0) {
        cli_complain("%s: holds no sample", s->name);
        return 2;
    }
    return 0;
}

static int is_zip(const char *begin, size_t n) { return n >= 4 && memcmp(begin, "PK\3\4", 4) == 0; }

static int complain_zip(const struct samples *s)
{
    cli_complain("%s: a zip archive, as sigrok sessions are: unzip -p FILE.sr 'logic-1*' | "
                 "exhand quad --raw ...",
        s->name);
    return 2;
}

/* --- bytes --- */

static int next_bytes(struct samples *s, struct samples_chunk *c)
{
    static uint8_t byte[SAMPLES_CHUNK];
    while (c->n == 0) {
        const size_t n = fread(byte, 1, sizeof byte, s->from);
        uint64_t i = s->skip;
        if (n == 0) { return at_end(s); }
        if (s->seen == 0 && is_zip((const char *)byte, n)) { return complain_zip(s); }
        for (; i < n; i += (uint64_t)s->opt->every) {
            c->line[c->n] = s->of_byte[byte[i]];
            c->at[c->n++] = (int64_t)(s->seen + i);
        }
        s->skip = i - n;
        s->seen += n;
    }
    return 0;
}

/* --- CSV --- */

static int bad_line(const struct samples *s, const char *what)
{
    cli_complain("%s: line %llu: %s: wanted %s", s->name, (unsigned long long)s->line, what,
        s->opt->rate_Hz > 0 ? "a,b, each 0 or 1 (with --rate there is no time)"
                            : "time,a,b: seconds, then each 0 or 1 (without time: --rate)");
    return 2;
}

/* Past blanks. */
static const char *blank(const char *p) { return p + strspn(p, " \t"); }

/* One line, 0 or 1, and what ends it, past which *p moves; -1 else. */
static int take_line(const char **p, char ends)
{
    const char *at = blank(*p);
    const int v = *at - '0';
    if (v != 0 && v != 1) { return -1; }
    at = blank(at + 1);
    if (*at != ends) { return -1; }
    *p = at + (ends != '\0');
    return v;
}

/* Time to nanoseconds, rising. */
static int take_time(struct samples *s, const char **p)
{
    char *end;
    const double t_s = strtod(*p, &end);
    const int64_t was_ns = s->t_ns;
    if (end == *p || *blank(end) != ',') { return bad_line(s, "no time"); }
    if (!(t_s >= -TIME_MAX_S && t_s <= TIME_MAX_S)) {
        return bad_line(s, "time beyond 4e6 s: take its start away");
    }
    s->t_ns = (int64_t)(t_s * 1e9 + (t_s < 0 ? -0.5 : 0.5));
    *p = blank(end) + 1;
    return s->seen > 0 && s->t_ns <= was_ns ? bad_line(s, "time does not rise by 1 ns") : 0;
}

static int take_row(struct samples *s, const char *text, struct samples_chunk *c)
{
    int a, b;
    int err = s->opt->rate_Hz > 0 ? 0 : take_time(s, &text);
    if (err) { return err; }
    a = take_line(&text, ',');
    if (a < 0) { return bad_line(s, "a is not 0 or 1, or the last"); }
    b = take_line(&text, '\0');
    if (b < 0) { return bad_line(s, "b is not 0 or 1, or not the last"); }
    if (s->skip == 0) {
        c->line[c->n] = (uint8_t)(a << 1 | b);
        c->at[c->n++] = s->opt->rate_Hz > 0 ? (int64_t)s->seen : s->t_ns;
        s->skip = (uint64_t)s->opt->every;
    }
    s->skip--;
    s->seen++;
    return 0;
}

/* A line without a byte order mark and blanks. */
static const char *text_of(const struct samples *s, const char *buf)
{
    return blank(s->line == 1 && strncmp(buf, "\xEF\xBB\xBF", 3) == 0 ? buf + 3 : buf);
}

/* Nothing, a comment, or the names of the columns, once, before the first row. */
static int is_no_row(struct samples *s, const char *text)
{
    char *end;
    int names;
    (void)strtod(text, &end);
    names = s->seen == 0 && !s->named && end == text; /* nan is no name */
    if (*text == '\0' || *text == '#' || *text == ';') { return 1; }
    s->named |= names;
    return names;
}

static int next_rows(struct samples *s, struct samples_chunk *c)
{
    char buf[256] = "";
    int more;
    while (c->n < SAMPLES_CHUNK && (more = lines_next(s->from, buf, sizeof buf)) != 0) {
        const char *text;
        int err = 0;
        s->line++;
        text = text_of(s, buf);
        if (s->line == 1 && is_zip(buf, sizeof buf)) { return complain_zip(s); }
        if (more < 0) { return bad_line(s, "far too long"); }
        if (!is_no_row(s, text)) { err = take_row(s, text, c); }
        if (err) { return err; }
    }
    return c->n < SAMPLES_CHUNK ? at_end(s) : 0;
}

int samples_next(struct samples *s, struct samples_chunk *c)
{
    c->n = 0;
    return s->opt->csv ? next_rows(s, c) : next_bytes(s, c);
}
