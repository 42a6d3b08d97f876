/* SPDX-License-Identifier: MIT */
/* Whether a fall came to rest. */
#ifndef BASE_REST_H
#define BASE_REST_H

#include "falls/fall.h"

struct fall_rest_opt {
    double observe_s;      /* from the first contact of the fall */
    double window_s;       /* the end of the observation that is judged */
    double travel_m;       /* peak-to-peak of q above this: oscillates */
    double force_N;        /* peak-to-peak of F_mon above this: oscillates */
    double encoder_step_m; /* 0 = do not distinguish buzz from rest */
    double range_m;        /* |q| from here on is the end of its format, not a place */
};

/* 5 s, 0.5 s, 0.25 mm, 4 N, no encoder step, 1.99 m of the format's 2. The rule belongs to a string
 * that only pulls: log with F >= 0 on. */
extern const struct fall_rest_opt fall_rest_opt_default;

enum fall_rest_class {
    FALL_AT_REST,
    FALL_BUZZ, /* at rest, but the encoder changes by one or two counts, as a
                  position at the edge of a count may do without motion. It counts
                  as rest. Three counts, below travel_m, are slow creep: rest */
    FALL_OSCILLATES,
    FALL_INCOMPLETE, /* no contact, the log ends before the observation does, or the
                        mass is in flight through the whole window, or ran away to
                        where position is no longer measured */
    FALL_REST_CLASSES
};

/* "rest", "buzz", "oscillates", "incomplete". Never NULL. */
const char *fall_rest_text(enum fall_rest_class rest);

struct fall_rest {
    enum fall_rest_class rest;
    double t_contact_s;       /* of the first contact; 0 without */
    double travel_m, force_N; /* peak-to-peak over the window; 0 if incomplete */
};

/* Judges every fall of the log into out[log->falls]. Times are compared at half ticks, so that
 * rounding cannot move a sample over an edge. The observation is the ticks from the first contact
 * up to, not including, observe_s after it. A window with fewer than 3 samples, or with more than a
 * tenth of them missing, is incomplete. The window has at least four ticks, so that a slow rate can
 * have 3 samples. BUZZ and AT_REST both count as rest. */
enum fall_status fall_rest(const struct fall_log *log, const struct fall_contacts *contacts,
    const struct fall_rest_opt *opt, struct fall_rest *out);

#endif
