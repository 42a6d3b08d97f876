/* SPDX-License-Identifier: MIT */
#include "motion.h"

#include "rpy.h"

#include "sim/lag.h"

#define TWO_PI 6.283185307179586

/* A straight line from key to key; before the first and after the last one it rests. */
static void keyed(const struct motion *m, double t_s, struct v3 *move, struct v3 *turn)
{
    const struct motion_key *k = m->key;
    const double first = k[0].t_s, span = k[m->keys - 1].t_s - first;
    int lo = 0, hi = m->keys - 1;
    double part;
    if (m->loop && t_s > first) { t_s -= span * floor((t_s - first) / span); }
    if (t_s <= first) { hi = 0; }
    if (t_s >= k[hi].t_s) { lo = hi; }
    while (hi - lo > 1) {
        const int mid = (lo + hi) / 2;
        if (k[mid].t_s <= t_s) {
            lo = mid;
        } else {
            hi = mid;
        }
    }
    part = lo == hi ? 0 : (t_s - k[lo].t_s) / (k[hi].t_s - k[lo].t_s);
    *move = v3_along(k[lo].move_m, part, v3_sub(k[hi].move_m, k[lo].move_m));
    *turn = v3_along(k[lo].turn_rad, part, v3_sub(k[hi].turn_rad, k[lo].turn_rad));
}

struct pose motion_at(const struct motion *m, const struct pose *stand, double t_s)
{
    struct pose p = *stand;
    struct v3 move = m->move, turn = m->turn;
    double scale = t_s;
    switch (m->kind) {
    case MOTION_NONE: return p;
    case MOTION_KEYS:
        scale = 1;
        keyed(m, t_s, &move, &turn);
        break;
    case MOTION_SINE:
        /* a whole number of turns less: the sine's argument stays small for days */
        scale = m->hz * t_s;
        scale = sim_sin(TWO_PI * (scale - floor(scale)) + m->phase_rad);
        break;
    case MOTION_LINEAR: break;
    }
    p.at = v3_along(stand->at, scale, move);
    if (turn.x != 0 || turn.y != 0 || turn.z != 0) {
        const struct m3 r = rpy_turn(v3_times(turn, scale));
        p.turn = m3_times(&r, &stand->turn);
    }
    return p;
}

static double fastest(const struct motion *m, int turning)
{
    double most = 0;
    for (int i = 1; i < m->keys; i++) {
        const struct motion_key *a = &m->key[i - 1], *b = &m->key[i];
        const struct v3 way =
            turning ? v3_sub(b->turn_rad, a->turn_rad) : v3_sub(b->move_m, a->move_m);
        most = fmax(most, v3_len(way) / (b->t_s - a->t_s));
    }
    return most;
}

static double bound(const struct motion *m, struct v3 v, int turning)
{
    switch (m->kind) {
    case MOTION_NONE: break;
    case MOTION_LINEAR: return v3_len(v);
    case MOTION_SINE: return v3_len(v) * TWO_PI * m->hz;
    case MOTION_KEYS: return fastest(m, turning);
    }
    return 0;
}

double motion_speed(const struct motion *m) { return bound(m, m->move, 0); }

/* Each of the three angles turns about an axis of length 1. So the total is at most the sum of
 * their speeds, which is at most sqrt(3) times the length of the three as a vector. */
double motion_turning(const struct motion *m) { return 1.7320508075688774 * bound(m, m->turn, 1); }
