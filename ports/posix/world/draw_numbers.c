/* SPDX-License-Identifier: MIT */
/* Numbers on the screen: how the link is, and d, q_lim, F of every finger. */
#include "draw.h"

#include "exhand/precontact.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { WHITE, GREY, BLUE, AMBER, RED };
static const float ink[][4] = {{0.97F, 0.97F, 0.97F, 1}, {0.74F, 0.77F, 0.81F, 1},
    {0.52F, 0.79F, 1, 1}, {1, 0.78F, 0.30F, 1}, {1, 0.46F, 0.42F, 1}};

#ifdef __GNUC__
__attribute__((format(printf, 6, 7)))
#endif
static void
say(struct draw_list *l, int x, int y, int colour, int how, const char *format, ...)
{
    struct draw_text *t = &l->text[l->texts];
    va_list args;
    if (l->texts == (int)(sizeof l->text / sizeof l->text[0])) { return; }
    l->texts++;
    t->x = x;
    t->y = y;
    t->large = how == 2;
    t->right = how == 1;
    memcpy(t->colour, ink[colour], sizeof t->colour);
    va_start(args, format);
    vsnprintf(t->text, sizeof t->text, format, args);
    va_end(args);
}

static void rect(
    struct draw_list *l, int x, int y, int w, int h, float r, float g, float b, float opaque)
{
    const struct draw_rect q = {x, y, w, h, opaque < 1, {r, g, b, opaque}};
    if (l->rects < (int)(sizeof l->rect / sizeof l->rect[0])) { l->rect[l->rects++] = q; }
}

/* What the finger does, in one word, and its colour. */
static const char *doing(const struct draw_moment *m, int f, int *colour)
{
    *colour = GREY;
    if (!(m->out.fingers >> f & 1)) { return "off"; }
    *colour = RED;
    if (m->in.touching >> f & 1) { return "contact"; }
    *colour = AMBER;
    if (m->in.frozen >> f & 1) { return "frozen"; }
    *colour = m->out.plane[f].kind == EXH_PLANE_HIT ? BLUE : GREY;
    return m->out.plane[f].kind == EXH_PLANE_HIT ? "near" : "free";
}

/* In mm; blank for `none`. */
static void way(struct draw_list *l, int x, int y, int32_t m_q30, int32_t none)
{
    if (m_q30 != none) { say(l, x, y, WHITE, 1, "%.2f", m_q30 * (1000 * 0x1p-30)); }
}

static void finger_row(const struct draw_moment *m, struct draw_list *l, int f, int y)
{
    const double force = m->in.force_N_q20[f] * 0x1p-20;
    int colour;
    const char *what = doing(m, f, &colour);
    const int on = m->out.fingers >> f & 1, wide = (int)(force * 5.8 + 0.5);
    say(l, 24, y, on ? WHITE : GREY, 0, "%s", finger_name[f]);
    say(l, 84, y, colour, 0, "%s", what);
    if (!on) { return; }
    if (m->out.plane[f].kind == EXH_PLANE_HIT) {
        way(l, 206, y, m->in.d_m_q30[f], INT32_MIN);
        way(l, 292, y, m->in.q_lim_m_q30[f], EXH_PRECONTACT_NO_LIM);
    }
    say(l, 346, y, WHITE, 1, "%.2f", force);
    rect(l, 356, y + 3, wide > 70 ? 70 : wide, 11, 0.93F, 0.10F, 0.10F, 1);
}

static void fingers(const struct draw_moment *m, struct draw_list *l)
{
    rect(l, 12, -168, 424, 156, 0.07F, 0.09F, 0.12F, 0.72F);
    say(l, 206, -136, GREY, 1, "d mm");
    say(l, 292, -136, GREY, 1, "q_lim mm");
    say(l, 346, -136, GREY, 1, "F N");
    for (int f = 0; f < FINGERS; f++) { finger_row(m, l, f, -116 + 20 * f); }
}

static void link_state(const struct draw_moment *m, struct draw_list *l)
{
    if (m->picture_fps > 0) {
        say(l, 24, 46, WHITE, 0, "%.0f frames/s, %.0f pictures/s", m->fps, m->picture_fps);
    } else {
        say(l, 24, 46, WHITE, 0, "%.0f frames/s", m->fps);
    }
    if (!m->linked) {
        say(l, 24, 66, AMBER, 0, "no link: hand moved by keys, forces made up here");
    } else if (m->trip_ms >= 0) {
        say(l, 24, 66, m->age_ms > 100 ? RED : GREY, 0,
            "link: age %.1f ms, round trip %.1f ms, lost %lu", m->age_ms, m->trip_ms, m->lost);
    } else {
        say(l, 24, 66, m->age_ms > 100 ? RED : GREY, 0, "link: age %.1f ms, lost %lu", m->age_ms,
            m->lost);
    }
    if (m->paused) { say(l, 24, 86, AMBER, 0, "paused"); }
}

static void keys(struct draw_list *l)
{
    static const char *const text[] = {"arrows, mouse    turn the view",
        "+ -, wheel       nearer, farther", "1 .. 5           bend thumb .. little",
        "0                bend all; shift opens", "w a s d r f      carry the hand",
        "space            pause", "b                back to the start",
        "h                this help", "q, esc           leave"};
    const int n = (int)(sizeof text / sizeof text[0]);
    rect(l, -330, 12, 318, 20 * n + 16, 0.07F, 0.09F, 0.12F, 0.72F);
    for (int i = 0; i < n; i++) {
        char key[18];
        snprintf(key, sizeof key, "%.16s", text[i]);
        say(l, -318, 20 + 20 * i, WHITE, 0, "%s", key);
        say(l, -206, 20 + 20 * i, GREY, 0, "%s", text[i] + 17);
    }
}

void draw_numbers(const struct world *w, const struct draw_moment *m, struct draw_list *l)
{
    const char *title = world_scene(w)->title;
    rect(l, 12, 12, 424, m->paused ? 98 : 78, 0.07F, 0.09F, 0.12F, 0.72F);
    say(l, 24, 18, WHITE, 2, "%s", title[0] ? title : "world");
    link_state(m, l);
    fingers(m, l);
    say(l, 24, -162, WHITE, 0, "red bars: forces    planes:");
    say(l, 220, -162, BLUE, 0, "near");
    say(l, 264, -162, AMBER, 0, "frozen");
    say(l, 324, -162, RED, 0, "in contact");
    if (m->help) { keys(l); }
}
