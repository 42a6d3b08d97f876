/* SPDX-License-Identifier: MIT */
#include "estimate.h"

#define RING (ESTIMATE_TICKS + 1)

const char *const estimate_name[ESTIMATES] = {"window", "pole", "foaw", "track"};

void estimate_start(struct estimate *s, double cnt)
{
    for (int i = 0; i < RING; i++) { s->cnt[i] = cnt; }
    s->at = 0;
    s->x_cnt = cnt;
    s->v_cnt = 0;
}

/* n ticks ago; 0 is the newest. */
static double past(const struct estimate *s, int n) { return s->cnt[(s->at + RING - n) % RING]; }

/* Slope of the line that fits the last n + 1 counts best. */
static double fitted(const struct estimate *s, int n)
{
    double sum = 0, square = 0;
    for (int i = 0; i <= n; i++) {
        const double t = n / 2.0 - i;
        sum += t * past(s, i);
        square += t * t;
    }
    return sum / square;
}

/* Whether the line of this slope through the newest count passes within one count of all. */
static int fits(const struct estimate *s, int n, double slope)
{
    for (int i = 1; i <= n; i++) {
        const double off = past(s, i) - (past(s, 0) - slope * i);
        if (off > 1 + 1e-9 || off < -1 - 1e-9) { return 0; }
    }
    return 1;
}

/* Longer windows until one does not fit. */
static double foaw(const struct estimate *s, int longest)
{
    double best = past(s, 0) - past(s, 1);
    for (int n = 2; n <= longest; n++) {
        const double slope = fitted(s, n);
        if (!fits(s, n, slope)) { break; }
        best = slope;
    }
    return best;
}

double estimate_step(struct estimate *s, const struct estimate_par *p, double T_s, double cnt)
{
    const double theta = p->tau_s / (p->tau_s + T_s);
    double off;
    s->at = (s->at + 1) % RING;
    s->cnt[s->at] = cnt;
    switch (p->kind) {
    case ESTIMATE_POLE: s->v_cnt += (cnt - past(s, 1) - s->v_cnt) * (1 - theta); break;
    case ESTIMATE_FOAW: return foaw(s, p->window);
    case ESTIMATE_TRACK:
        off = cnt - (s->x_cnt + s->v_cnt);
        s->x_cnt = cnt - theta * theta * off;
        s->v_cnt += (1 - theta) * (1 - theta) * off;
        break;
    case ESTIMATE_WINDOW:
    case ESTIMATES: return (cnt - past(s, p->window)) / p->window;
    }
    return s->v_cnt;
}
