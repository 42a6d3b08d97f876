/* SPDX-License-Identifier: MIT */
/* The box on a terminal, and as lines. */
#include "live/watch.h"

#include "base/names.h"
#include "base/none.h"
#include "base/until.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PAST   32 /* samples of a sparkline */
#define RATE_S 1.0

static struct {
    double past[WATCH_SIGNALS][PAST];
    unsigned n; /* samples so far */
    int on;
    uint64_t heard; /* and when, for rates */
    uint32_t tick;
    double at_s, ticks_ps, heard_ps;
} view;

void watch_view_sample(const struct watch_box *b, const struct watch_pick *p)
{
    for (uint32_t i = 0; i < p->n; i++) {
        const struct exh_signal *row = exh_signal_at(b->scene->signals, p->index[i], NULL);
        view.past[i][view.n % PAST] = none_or(row, b->value[p->index[i]]);
    }
    view.n++;
}

static void rates(const struct watch_box *b)
{
    const double now_s = until_now_s(), passed_s = now_s - view.at_s;
    if (view.at_s > 0 && passed_s < RATE_S) { return; }
    view.ticks_ps = view.at_s > 0 ? (double)(b->tick - view.tick) / passed_s : 0;
    view.heard_ps = view.at_s > 0 ? (double)(b->heard - view.heard) / passed_s : 0;
    view.at_s = now_s;
    view.tick = b->tick;
    view.heard = b->heard;
}

/* From the least to the greatest of what it shows; a gap where there was none. */
static void spark(uint32_t i)
{
    static const char *const step[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
    const unsigned n = view.n < PAST ? view.n : PAST;
    double lo = (double)INFINITY, hi = -(double)INFINITY;
    for (unsigned k = 0; k < n; k++) {
        const double v = view.past[i][k];
        if (v < lo) { lo = v; }
        if (v > hi) { hi = v; }
    }
    for (unsigned k = view.n - n; k < view.n; k++) {
        const double v = view.past[i][k % PAST];
        const unsigned high = hi > lo && v >= lo ? (unsigned)((v - lo) / (hi - lo) * 7.999) : 0;
        fputs(isnan(v) ? " " : step[high], stdout);
    }
}

static int utf8(void)
{
    const char *const name[] = {"LC_ALL", "LC_CTYPE", "LANG"};
    for (unsigned i = 0; i < 3; i++) {
        const char *is = getenv(name[i]);
        if (is && is[0]) { return strstr(is, "UTF-8") || strstr(is, "utf8"); }
    }
    return 0;
}

/* Reverse video, but where NO_COLOR asks for plain text (no-color.org). */
static const char *loud(int on)
{
    const char *plain = getenv("NO_COLOR");
    return plain && plain[0] ? "" : on ? "\033[7m" : "\033[0m";
}

#define LINE_END "\033[K\n" /* the rest of what stood there goes */

static void draw_head(const struct watch_box *b, const char *source)
{
    const double age_s = watch_age_s(b);
    printf("exhand watch %s%s", source, LINE_END);
    if (b->scene == NULL) {
        printf("nothing heard for %.1f s%s%s%s", age_s, b->trouble ? ": " : "",
            b->trouble ? b->trouble : "", LINE_END);
        return;
    }
    printf("%s, %.6g Hz   %.3f s   tick %lu   %.1f ticks/s%s", b->scene->name,
        (double)b->T.den / b->T.num, (double)b->tick * b->T.num / b->T.den, (unsigned long)b->tick,
        view.ticks_ps, LINE_END);
    if (age_s > 1) {
        printf("%sSILENT for %.1f s%s%s%s%s", loud(1), age_s, loud(0), b->trouble ? ": " : "",
            b->trouble ? b->trouble : "", LINE_END);
    } else {
        printf("age %.2f s   heard %.1f times/s   lost %llu%s", age_s, view.heard_ps,
            (unsigned long long)b->lost, LINE_END);
    }
}

static void draw_state(const struct watch_box *b)
{
    char faults[NAMES_B], present[NAMES_B], limits[NAMES_B], clear[NAMES_CLEAR_B];
    names_clear(clear, b->faults, b->present);
    names_faults(faults, sizeof faults, b->faults);
    names_faults(present, sizeof present, b->present);
    names_bits(limits, sizeof limits, &names_limit, b->limits);
    printf("state   %s: %s%s", names_word(&names_state, b->state),
        names_says(&names_state, b->state), LINE_END);
    printf("faults  %s%s%s   now %s%s", b->faults ? loud(1) : "", faults, b->faults ? loud(0) : "",
        present, LINE_END);
    if (clear[0]) { printf("clear   %s%s", clear, LINE_END); }
    printf("limits  %s%s", limits, LINE_END);
}

void watch_view_draw(const struct watch_box *b, const struct watch_pick *p, const char *source)
{
    const int sparks = utf8();
    rates(b);
    printf(view.on ? "\033[H" : "\033[2J\033[H\033[?25l"); /* the cursor hidden */
    view.on = 1;
    draw_head(b, source);
    if (b->scene) { draw_state(b); }
    for (uint32_t i = 0; b->scene && view.n && i < p->n; i++) {
        char name[WATCH_NAME_B];
        const struct exh_signal *row = watch_name(name, b->scene->signals, p->index[i]);
        if (none_is(row, b->value[p->index[i]])) {
            printf("  %-14s %14s %-10s ", name, "", "");
        } else {
            printf("  %-14s %14.6g %-10s ", name, none_or(row, b->value[p->index[i]]),
                names_unit(row->unit));
        }
        if (sparks) { spark(i); }
        printf(LINE_END);
    }
    printf("Ctrl-C ends it\033[J");
    fflush(stdout);
}

/* A separate line when the action required of the person changes. */
static void say_clear(const struct watch_box *b)
{
    static char said[NAMES_CLEAR_B];
    char clear[NAMES_CLEAR_B];
    names_clear(clear, b->faults, b->present);
    if (clear[0] && strcmp(clear, said) != 0) { printf("to clear: %s\n", clear); }
    memcpy(said, clear, sizeof said);
}

void watch_view_line(const struct watch_box *b, const struct watch_pick *p)
{
    char text[NAMES_B];
    names_faults(text, sizeof text, b->faults);
    say_clear(b);
    printf("%.4f s  %s  faults %s", (double)b->tick * b->T.num / b->T.den,
        names_word(&names_state, b->state), text);
    names_bits(text, sizeof text, &names_limit, b->limits);
    printf("  limits %s", text);
    for (uint32_t i = 0; i < p->n; i++) {
        char name[WATCH_NAME_B];
        const struct exh_signal *row = watch_name(name, b->scene->signals, p->index[i]);
        if (none_is(row, b->value[p->index[i]])) {
            printf("  %s -", name);
        } else {
            printf("  %s %.6g%s%s", name, none_or(row, b->value[p->index[i]]),
                row->unit[0] ? " " : "", names_unit(row->unit));
        }
    }
    printf("\n");
    fflush(stdout);
}

void watch_view_end(void)
{
    if (view.on) { printf("\r\033[K\033[?25h"); }
    view.on = 0;
    fflush(stdout);
}
