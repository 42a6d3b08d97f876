/* SPDX-License-Identifier: MIT */
/* From the log of a falling-mass run to a stiffness and to "came to rest or not".
 *
 * The paper's steps, each one function: cut the log by the collision signal, pool
 * the (position, monitored force) pairs, keep 0.8 .. 4.5 N, sort by force, average
 * ten positions, fit a line. fall_stiffness() runs them all; fall_rest() is the
 * stability rule.
 *
 * Only + - * / on doubles, no libm, no global state: built without contraction
 * and without x87, every machine prints the same digits. Lists are allocated
 * here and owned by the caller; after any return, also a failed one, they may be
 * released with their _free().
 */
#ifndef EXHAND_CLI_ANALYSIS_H
#define EXHAND_CLI_ANALYSIS_H

#include <stddef.h>
#include <stdint.h>

struct fall_sample {
    double t_s, q_m, qd_mps, f_des_N, i_des_A, f_mon_N;
    int c; /* the contact condition applies */
};

/* A run: fall i is samples [start[i], start[i + 1]), the last one ends with the
 * log. Starts rise strictly; samples before the first belong to no fall. Within
 * a fall time rises strictly; between falls it may begin again. */
struct fall_log {
    const struct fall_sample *sample;
    size_t samples;
    const size_t *start;
    size_t falls;
};

enum fall_status {
    FALL_OK = 0,
    FALL_NO_MEMORY,
    FALL_BAD_LOG,   /* starts or times do not rise, or a value beyond +-1e9 */
    FALL_BAD_OPT,   /* an option outside its range */
    FALL_TOO_FEW,   /* fewer than FALL_MIN_PAIRS pairs in the band */
    FALL_FLAT,      /* position or force does not vary: no line */
    FALL_NO_RISE,   /* force does not rise with position: no stiffness */
    FALL_UNBOUNDED, /* the interval has no upper end */
    FALL_FEW_FALLS, /* fewer than two falls, or one alone makes the line */
    FALL_IO         /* a file could not be written */
};

/* One line of plain English. Never NULL. */
const char *fall_status_text(enum fall_status status);

/* ---- Contacts ------------------------------------------------------------ */

struct fall_contact {
    size_t first, end; /* samples [first, end), c true in all of them */
    size_t fall;
    int open; /* fall or log ended while still in contact */
};

struct fall_contacts {
    struct fall_contact *at;
    size_t n;
};
struct fall_opt;

/* Cuts at the edges of c. A fall's end closes a contact (open = 1), it never runs
 * on into the next fall. Contacts shorter than min_samples are dropped (0 and 1
 * keep all); a gap in c, however short, separates two contacts. */
enum fall_status fall_dissect(const struct fall_log *log, size_t min_samples,
                              struct fall_contacts *out);
void fall_contacts_free(struct fall_contacts *contacts);

/* Which samples belong to the "contact situations" of the paper. */
enum fall_scope {
    FALL_SCOPE_ALL,   /* those of all contacts */
    FALL_SCOPE_FIRST, /* of the first contact of each fall */
    FALL_SCOPE_MOVES, /* of all contacts, up to where the motor has stopped */
    FALL_SCOPE_WHOLE, /* of the whole fall, in contact or not */
    FALL_SCOPES
};

/* fall_dissect(), then cut to a scope. The motor "has stopped" where from there to the
 * end of its fall the encoder stays within one count, of step_m. */
enum fall_status fall_dissect_scope(const struct fall_log *log, const struct fall_opt *opt,
                                    struct fall_contacts *out);

/* ---- Stiffness ----------------------------------------------------------- */

#define FALL_WINDOW    10 /* positions in one average */
#define FALL_MIN_PAIRS 12 /* pairs in the band: three averages, the least for a fit */

struct fall_pair {
    double q_m, f_N;
    size_t fall;
};

struct fall_pairs {
    struct fall_pair *at;
    size_t n;
};

/* Which force an averaged position keeps. The paper averages the positions only,
 * so the pair keeps the force of one sample. CENTRE is the sixth of the ten, right
 * of the middle: the average belongs to the middle of its window, and a pair that
 * kept the NEWEST force would be shifted by 4.5 samples, unevenly where forces
 * are not evenly spaced. NEWEST and MEAN are there to show how little it matters. */
enum fall_force { FALL_FORCE_CENTRE, FALL_FORCE_NEWEST, FALL_FORCE_MEAN };

struct fall_opt {
    size_t min_samples; /* shortest contact, samples */
    size_t lag;         /* pair F_mon(n) with q(n - lag); see fall_pool() */
    double band_lo_N;   /* both ends belong to the band */
    double band_hi_N;
    enum fall_force force;
    enum fall_scope scope; /* which samples belong to a contact */
    double step_m;         /* of the encoder, for FALL_SCOPE_MOVES */
};

/* 1 sample, lag 1, 0.8 .. 4.5 N, centre, all contacts. */
extern const struct fall_opt fall_opt_default;

/* All pairs of the contacts, in log order. The monitor answers the command of the
 * previous tick, so lag 1 pairs it with the position that command came from.
 * Both samples lie in the same contact: its first `lag` forces (they answer
 * commands given before it) and its last `lag` positions (answered after it)
 * have no partner, and a contact of n samples gives n - lag pairs. The caller may
 * thin out `contacts` before, for instance to the first of each fall. */
enum fall_status fall_pool(const struct fall_log *log, const struct fall_contacts *contacts,
                           size_t lag, struct fall_pairs *out);

/* Keeps lo <= F <= hi and sorts by rising force; ties keep their order. */
enum fall_status fall_band(const struct fall_pairs *in, double lo_N, double hi_N,
                           struct fall_pairs *out);

/* Trailing windows of ten over `sorted`: n - 9 pairs (none below ten), pair i from
 * sorted pairs i .. i + 9. No window reaches over an end, none is shortened. */
enum fall_status fall_average(const struct fall_pairs *sorted, enum fall_force force,
                              struct fall_pairs *out);
void fall_pairs_free(struct fall_pairs *pairs);

/* Least squares in both directions. A minimises the error in force, B that in
 * position; a/b = r2, so B is the larger. Everything is finite whatever the
 * status; what the status denies is 0 (TOO_FEW, FLAT: a, b and r2; NO_RISE: b). */
struct fall_fit {
    enum fall_status status;
    size_t n;     /* averaged pairs */
    double a_Npm; /* slope of F over mean q */
    double b_Npm; /* inverse slope of mean q over F */
    double r2;
    double q_mean_m, f_mean_N; /* both lines pass here */
    double q_min_m, q_max_m, f_min_N, f_max_N;
};

void fall_fit_line(const struct fall_pairs *averaged, struct fall_fit *out);

/* 95 %, N/m. UNBOUNDED: hi is 0 and there is no upper end (lo is 0 where it has none
 * either); any other status but OK: both are 0. */
struct fall_interval {
    enum fall_status status;
    double lo_Npm, hi_Npm;
    size_t falls; /* that have pairs in the band */
};

/* Leaves out one fall after the other and repeats average and fit: the interval is the
 * estimate +- t times the jackknife's standard error, t of one degree of freedom less
 * than there are falls. `sorted` is the output of fall_band(). Falls, not pairs, are
 * independent of each other. B's is made of its slope (m/N) and inverted then: a slope
 * that scatters through zero would make B jump from +inf to -inf.
 * It covers the mean of the estimator, which is not k: `make coverage` shows both, and
 * that the percentiles of a bootstrap over ten falls, which this replaces, do not. */
enum fall_status fall_jackknife(const struct fall_pairs *sorted, size_t falls,
                                enum fall_force force, struct fall_interval *a,
                                struct fall_interval *b);

struct fall_stiffness {
    size_t contacts;
    struct fall_pairs raw;  /* all pairs, in log order */
    struct fall_pairs band; /* in the band, sorted */
    struct fall_pairs averaged;
    struct fall_fit fit;
    struct fall_interval a, b;
};

/* The whole chain. OK also when there is no line: look at fit.status. */
enum fall_status fall_stiffness(const struct fall_log *log, const struct fall_opt *opt,
                                struct fall_stiffness *out);
void fall_stiffness_free(struct fall_stiffness *s);

/* ---- Files for plot/force_position.gp -------------------------------------- */

enum fall_direction { FALL_A, FALL_B };

struct fall_plot_paths {
    const char *raw;      /* q_m,f_mon_n: all pairs, in and out of the band */
    const char *averaged; /* q_m,f_mon_n: the pairs of the regression */
    const char *line;     /* q_m,f_mon_n: two rows, the ends of the line */
};

/* The line spans the averaged data in the direction's own free variable: q for A,
 * force for B. Without a line its file holds the header only. */
enum fall_status fall_write_plot(const struct fall_stiffness *s, enum fall_direction direction,
                                 const struct fall_plot_paths *paths);

/* ---- Rest ------------------------------------------------------------------ */

struct fall_rest_opt {
    double observe_s;      /* from the first contact of the fall */
    double window_s;       /* the end of the observation that is judged */
    double travel_m;       /* peak-to-peak of q above this: oscillates */
    double force_N;        /* peak-to-peak of F_mon above this: oscillates */
    double encoder_step_m; /* 0 = do not tell buzz from rest */
    double range_m;        /* |q| from here on is the end of its format, not a place */
};

/* 5 s, 0.5 s, 0.25 mm, 4 N, no encoder step, 1.99 m of the format's 2. The rule belongs to a string
 * that only pulls: log with F >= 0 on. */
extern const struct fall_rest_opt fall_rest_opt_default;

enum fall_rest_class {
    FALL_AT_REST,
    FALL_BUZZ, /* at rest, but the encoder moves by one or two counts: no more
                  than a position on the edge of a count does by itself. Counts
                  as rest; three counts, below travel_m, are slow creep: rest */
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

/* Judges every fall of the log into out[log->falls]. Time is compared at half
 * ticks, so that rounding cannot move a sample over an edge: the observation is
 * the ticks from the first contact up to, not including, observe_s after it. A
 * window with fewer than 3 samples, or with more than a tenth of them missing, is
 * incomplete; so that a slow rate can have 3 at all, it is four ticks long at least.
 * BUZZ and AT_REST both count as come to rest. */
enum fall_status fall_rest(const struct fall_log *log, const struct fall_contacts *contacts,
                           const struct fall_rest_opt *opt, struct fall_rest *out);

#endif
