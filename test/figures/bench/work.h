/* SPDX-License-Identifier: MIT */
/* Work: error and cost of ours, of others' integer code and of plain floating point, of one
 * kernel each on the same inputs, for the report's diagrams.
 */
#ifndef BENCH_WORK_H
#define BENCH_WORK_H

#include "bench.h"

#define WORK_FINGERS 5u
#define WORK_HOUR    7200000u /* ticks at 2 kHz */

struct work {
    const char *kernel; /* a diagram's panel */
    const char *name;
    const char *kind; /* ours, integer, float */
    const char *unit; /* of the error */
    uint32_t ticks;   /* over which it is taken; WORK_HOUR: at times, too */
    void (*setup)(void);
    void (*op)(uint32_t i);
    long double (*off)(uint32_t i); /* one more tick: by how much the result is off */
};

struct work_group {
    const struct work *work;
    size_t n;
};
extern const struct work_group law_works, table_works, hand_works, freeze_works, passivity_works,
    speed_works;
extern const struct work_group cmsis_works, fixmath_works; /* where they could be had */

/* --- inputs that ours and others share --- */

/* The wall: a string that moves some millimetres inside it, in counts past the contact, each tick
 * up to two and a bit of noise. A count and the gains are exact in all formats, and no powers of
 * two. */
#define WALL_STEP_M (71213.0 / 1073741824.0)
#define WALL_K_NPM  1997.25
#define WALL_B_NSPM 6.171875
#define WALL_T_S    (1 / 2000.0)
void wall_seed(void);
int32_t wall_cnt(void); /* the next tick's */
/* The exact law, N, of this tick's position past the contact and the last one's, both in metres. */
long double wall_N(long double pos_m, long double last_m);

/* Postures of five fingers, and the exact fingertip. */
extern int32_t hand_joint[BENCH_OPS][WORK_FINGERS][3];
void hand_seed(void);
void hand_posture(int32_t q[3]);
long double hand_off(uint32_t finger, const int32_t q[3], const double got[3]);

/* A table of 16 knots, evenly spaced: y of x, both whole of full scale. */
#define CURVE_KNOTS 16u
extern int32_t curve_x[CURVE_KNOTS], curve_y[CURVE_KNOTS];
extern int32_t curve_at[BENCH_OPS];
void curve_seed(void);
long double curve_exact(int32_t x);

/* A plane, a fingertip (and the string) before it. freeze_path(): on the way down and up again of
 * op i. freeze_any(): anywhere within half a metre. Returns the exact distance. */
struct freeze_case {
    long double normal[3], offset_m, tip_m[3], pos_m;
    int touching;
};
void freeze_path(uint32_t i, uint32_t f, struct freeze_case *c);
long double freeze_any(struct freeze_case *c);

/* The contact of an hour. energy_next() moves it by a tick. It returns the exact energy, J, the
 * count and the next commanded force. energy_hold() returns what the bench can hold of that.
 * energy_cnt has the counts of the ops. */
#define ENERGY_F_MOST_N 22
#define ENERGY_WAY_M    (3.0 / 2000)
extern int32_t energy_cnt[BENCH_OPS];
void energy_seed(void);
double energy_step_m(void);
long double energy_next(int32_t *cnt, int32_t *asked_N_q20);
void energy_hold(int32_t force_N_q20);

#endif
