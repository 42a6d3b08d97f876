/* SPDX-License-Identifier: MIT */
/* The log of falls that the analysis reads, and what its steps share. */
#ifndef BASE_FALL_H
#define BASE_FALL_H

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

struct fall_contact {
    size_t first, end; /* samples [first, end), c true in all of them */
    size_t fall;
    int open; /* fall or log ended while still in contact */
};

struct fall_contacts {
    struct fall_contact *at;
    size_t n;
};
/* Which samples belong to the "contact situations" of the paper. */
enum fall_scope {
    FALL_SCOPE_ALL,   /* those of all contacts */
    FALL_SCOPE_FIRST, /* of the first contact of each fall */
    FALL_SCOPE_MOVES, /* of all contacts, up to where the motor has stopped */
    FALL_SCOPE_WHOLE, /* of the whole fall, in contact or not */
    FALL_SCOPES
};

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

/* Which force an averaged position gets. The paper averages positions only, so the pair keeps the
 * force of one sample. CENTRE is the sixth of ten, right of the middle, because the average belongs
 * to the middle of its window. With the NEWEST force, the pair would be shifted by 4.5 samples,
 * unevenly where forces are not evenly spaced. NEWEST and MEAN exist to show how small the effect
 * is. */
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

/* Physical values lie far below; the square of this is far from overflow. */
#define FALL_VALUE_MAX 1e9

/* False for NaN too: a NaN compares false with everything. */
static inline int fall_sane(double x) { return x > -FALL_VALUE_MAX && x < FALL_VALUE_MAX; }

/* fall.c: an empty list has a pointer, too; calloc refuses a product that wraps. */
void *fall_alloc(size_t n, size_t size_B);

#endif
