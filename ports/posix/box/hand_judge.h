/* SPDX-License-Identifier: MIT */
/* What a contact was like: speed, settling, stiffness, and whether it was there in its time. */
#ifndef CLI_BILATERAL_JUDGE_H
#define CLI_BILATERAL_JUDGE_H

#include "box/hand.h"

#define PAPER_RATE_HZ       2000u
#define PAPER_K_NPM         20000.0
#define PAPER_B_NSPM        60.0
#define PAPER_SETTLING_S    0.025
#define PAPER_STIFFNESS_NPM 41250.0
#define PAPER_LOCAL_NPM     50004.0
#define SETTLED_BAND        0.05
#define EARLY_M             1e-3 /* contact so much before pad and object touch */

struct bilateral_contact {
    unsigned finger;
    int approach;
    int frozen, missed, early; /* missed: none though the finger went 1 mm into something */
    int late;                  /* its plane came when the finger was inside */
    int around;                /* missed: there was a plane, born around the finger */
    int nothing;               /* contact, and nothing was there */
    size_t first, hold_end;    /* samples: first of contact, behind the last of hold */
    double t_s, speed_mps;     /* at contact */
    double lim_m;              /* q_lim */
    double off_m;              /* q_lim less where pad and object touch then; NAN: unknown */
    double late_m;             /* so far inside it was */
    double settle_s;           /* < 0: never, or no contact */
    double rest_s;             /* as above, for position within 0.2 mm and F_mon within 1.5 N */
    double held_N;             /* F_mon at the end of the hold */
    double f_max_N;            /* F_des */
    double rise_Nps;           /* steepest millisecond of F_mon in the first three */
    double stiffness_Npm;      /* position over force, inverted; 0: none */
};

/* SI of a sample. */
struct fall_sample bilateral_si(const struct bilateral_sample *s, size_t tick, struct exh_period T);

/* Contacts of finger f, one per approach, at most cap: how many approaches there were. */
int bilateral_judge(
    const struct bilateral_run *r, unsigned f, struct bilateral_contact *c, int cap);

/* The paper's line through position and force: position over force, inverted. */
struct bilateral_line {
    double k_Npm;              /* 0: no line */
    double lo_Npm, hi_Npm, r2; /* 95 %, approach for approach left out; hi 0: no upper end */
};

/* Through the pairs of all approaches (approach 0) or of one; plot: files for force_position.gp,
 * prefix or NULL. */
struct bilateral_line bilateral_stiffness(
    const struct bilateral_run *r, unsigned f, int approach, const char *plot);

/* What a finger's approaches of one seed, or of several, came to. */
struct bilateral_count {
    int contacts, settled, missed, early, late;
    double settle_s;                 /* median of those that settled; over seeds: mean of these */
    struct bilateral_line line;      /* pooled; over seeds: mean, its interval, median of r2 */
    double settle_lo_s, settle_hi_s; /* 95 % interval of the mean over seeds; hi 0: none */
};

/* Counts contacts c, n of them, and their line. */
void bilateral_count(struct bilateral_count *to, const struct bilateral_contact *c, int n,
    struct bilateral_line line);

#endif
