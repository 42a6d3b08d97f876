/* SPDX-License-Identifier: MIT */
/* Estimate: the velocity estimators of exhand/velocity.h in doubles, for models of the box. */
#ifndef SIM_ESTIMATE_H
#define SIM_ESTIMATE_H

#define ESTIMATE_TICKS 16 /* longest window */

enum estimate_kind { ESTIMATE_WINDOW, ESTIMATE_POLE, ESTIMATE_FOAW, ESTIMATE_TRACK, ESTIMATES };

extern const char *const estimate_name[ESTIMATES];

/* Zeros: the plain window; its `window` is the only value then needed. */
struct estimate_par {
    enum estimate_kind kind;
    int window;   /* ticks of the window, or of the longest of FOAW; 1..16 */
    double tau_s; /* of the pole, or of each of the observer's two */
};

struct estimate {
    double cnt[ESTIMATE_TICKS + 1]; /* a ring, the newest at `at` */
    int at;
    double x_cnt, v_cnt; /* of pole and observer: position, and counts a tick */
};

/* At rest at a count. */
void estimate_start(struct estimate *s, double cnt);

/* One tick: counts a tick. */
double estimate_step(struct estimate *s, const struct estimate_par *p, double T_s, double cnt);

#endif
