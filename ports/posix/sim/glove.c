/* SPDX-License-Identifier: MIT */
/* Every parameter of the simulated glove and its card, with unit, range and how sure we are.
 *
 * - paper: read in the ICRA 2013 paper.
 * - card: read in a data sheet or driver of the card (Diamond DMM-32X-AT).
 * - file: read in a published calibration file of a CyberGlove.
 * - ours: a choice of the simulation.
 */
#include "glove.h"

#include "grid.h"
#include "plant.h"

#include <stddef.h>
#include <string.h>

#define TWO_PI 6.283185307179586
#define DEG    (TWO_PI / 360)
#define CODES  32768.0 /* either side of 0 V */

#define FORGOTTEN 700 /* so many time constants: e^-700 is 0 */

const struct sim_device_row sim_glove_row[] = {
    {"excite", "v", 5, 0.1, 20, "ours", "across each sensor and its series resistors"},
    {"dead", "", 0.1, 0, 0.4, "ours", "share of it at either end that only a broken wire gives"},
    {"gain", "", 4.5, 0.1, 1000, "ours", "of the amplifier: the live part is -9 .. 9 V"},
    {"offset", "v", -11.25, -20, 20, "ours", "behind the amplifier"},
    {"rail", "v", 12, 1, 20, "ours", "where the amplifier ends, either side of 0"},
    {"couple", "", 0.08, -1, 1, "ours", "of its neighbours' mean flexion in an abduction sensor"},

    {"cutoff", "hz", 159, 1, 1000000, "ours", "anti-alias low-pass, one pole: 10 kohm and 100 nF"},
    {"noise", "v", 0.0061, 0, 1, "paper", "peak to peak: normal, clipped at 3 standard deviations"},

    {"interval", "s", 4e-6, 1e-6, 1e-3, "card",
        "from channel to channel; it has 4, 5, 10, 15, 20 us"},
    {"settle", "s", 0.36e-6, 0, 1e-3, "ours",
        "time constant of the multiplexer: a step of full scale settles to one code in 4 us"},
    {"span", "v", 10, 1, 10, "paper", "the card's range, either side of 0, in 16 bits"},
};
const int sim_glove_rows = (int)(sizeof sim_glove_row / sizeof sim_glove_row[0]);

typedef char glove_rows_match[sizeof(struct sim_glove_par) / sizeof(double) ==
                                      sizeof sim_glove_row / sizeof sim_glove_row[0]
                                  ? 1
                                  : -1];

/* In the glove's order. End points: file (one user's, 8 bits), angles nominal. An abduction
 * sensor is bent by the two fingers it joins, the thumb's by its rotation (ours). */
const struct sim_glove_sensor sim_glove_sensor[SIM_GLOVE_SENSORS] = {
    {"thumb_rotate", -60, 0.335, 60, 0.697, {-1, -1}},
    {"thumb_mpj", -30, 0.311, 30, 0.736, {-1, -1}},
    {"thumb_ij", 0, 0.461, 90, 0.909, {-1, -1}},
    {"thumb_ab", 0, 0.791, 50, 0.350, {0, 0}},
    {"index_mpj", 0, 0.429, 90, 0.654, {-1, -1}},
    {"index_pij", 0, 0.181, 90, 0.654, {-1, -1}},
    {"index_dij", 0, 0.185, 90, 0.469, {-1, -1}},
    {"middle_mpj", 0, 0.417, 90, 0.630, {-1, -1}},
    {"middle_pij", 0, 0.268, 90, 0.591, {-1, -1}},
    {"middle_dij", 0, 0.000, 90, 0.323, {-1, -1}},
    {"middle_index_ab", 0, 0.468, 50, 0.390, {4, 7}},
    {"ring_mpj", 0, 0.323, 90, 0.571, {-1, -1}},
    {"ring_pij", 0, 0.240, 90, 0.618, {-1, -1}},
    {"ring_dij", 0, 0.177, 90, 0.390, {-1, -1}},
    {"ring_middle_ab", 0, 0.610, 50, 0.283, {7, 11}},
    {"pinkie_mpj", 0, 0.354, 90, 0.591, {-1, -1}},
    {"pinkie_pij", 0, 0.154, 90, 0.602, {-1, -1}},
    {"pinkie_dij", 0, 0.319, 90, 0.579, {-1, -1}},
    {"pinkie_ring_ab", 0, 0.516, 50, 0.209, {11, 15}},
    {"palm_arch", 0, 0.357, 40, 0.650, {-1, -1}},
    {"wrist_pitch", -30, 0.154, 40, 0.622, {-1, -1}},
    {"wrist_yaw", -30, 0.925, 10, 0.236, {-1, -1}},
};

struct sim_glove_par sim_glove_default(void)
{
    struct sim_glove_par p;
    sim_rows_default(&p, sim_glove_row, sim_glove_rows);
    return p;
}

int sim_glove_set(
    struct sim_glove_par *p, const char *name, double value, const struct sim_device_row **row)
{
    return sim_rows_set(p, sim_glove_row, sim_glove_rows, name, value, row);
}

/* Without branches where the processor can. */
static inline double limit(double v, double most)
{
    const double below = most < v ? most : v;
    return -most > below ? -most : below;
}

/* Of a share of the excitation. */
static double amplified(const struct sim_glove_par *p, double share)
{
    return limit(p->gain * p->excite_V * share + p->offset_V, p->rail_V);
}

/* As the sensor sees it, behind the low-pass. before: of this channel; NULL: nothing is kept. */
static double angle_rad(const struct sim_glove *g, unsigned i, double t_s, struct sim_decay *before)
{
    const struct sim_lag *l = &g->angle_rad[g->of[i]];
    const double s = before ? sim_grid_s(l->x.start_s, t_s) : 0;
    if (before == NULL || sim_lag_settled(l) || s > FORGOTTEN * l->tau_s) {
        return g->share[i] * sim_lag_at(l, t_s);
    }
    return g->share[i] * sim_lag_left(l, t_s, sim_decay_at(before, l->tau_s, s));
}

/* With what it has of its neighbours. */
static double bent_rad(const struct sim_glove *g, unsigned i, double t_s, struct sim_decay *before)
{
    const struct sim_glove_sensor *n = &sim_glove_sensor[i];
    double rad = angle_rad(g, i, t_s, before);
    for (int k = 0; k < 2 && n->bend[k] >= 0 && g->par.couple != 0; k++) {
        rad += g->par.couple / 2 * angle_rad(g, (unsigned)n->bend[k], t_s, before);
    }
    return rad;
}

static double shown_V(const struct sim_glove *g, unsigned i, double rad)
{
    const struct sim_glove_par *p = &g->par;
    if (g->fault[i] == SIM_GLOVE_RAIL_HIGH) { return p->rail_V; }
    if (g->fault[i] == SIM_GLOVE_RAIL_LOW) { return -p->rail_V; }
    if (g->fault[i] == SIM_GLOVE_OPEN) { return amplified(p, 1); }
    if (g->fault[i] == SIM_GLOVE_SHORT) { return amplified(p, 0); }
    return amplified(p,
        p->dead + g->live * (sim_glove_sensor[i].lo + (rad - g->lo_rad[i]) * g->share_perrad[i]));
}

double sim_glove_volt(const struct sim_glove *g, unsigned i, double t_s)
{
    return shown_V(g, i, bent_rad(g, i, t_s, NULL));
}

static int rests(const struct sim_glove *g, int i)
{
    return i < 0 || sim_lag_rests(&g->angle_rad[g->of[i]]);
}

/* The same, of a channel without a fault kept. */
static double moved_V(struct sim_glove *g, unsigned i, double t_s)
{
    const int *bend = sim_glove_sensor[i].bend;
    if (g->fault[i] != SIM_GLOVE_WELL) { return sim_glove_volt(g, i, t_s); }
    g->volt_V[i] = shown_V(g, i, bent_rad(g, i, t_s, &g->low_pass[i]));
    if (rests(g, (int)i) && rests(g, bend[0]) && rests(g, bend[1])) {
        g->moves &= ~(UINT32_C(1) << i);
    }
    return g->volt_V[i];
}

void sim_glove_start(struct sim_glove *g, const struct sim_glove_par *p, uint64_t seed,
    const double angle_rad[SIM_GLOVE_SENSORS])
{
    memset(g, 0, sizeof *g);
    g->par = *p;
    g->rng.state = seed;
    g->live = 1 - 2 * p->dead;
    for (unsigned i = 0; i < SIM_GLOVE_SENSORS; i++) {
        const struct sim_glove_sensor *n = &sim_glove_sensor[i];
        g->lo_rad[i] = n->lo_deg * DEG;
        g->share_perrad[i] = (n->hi - n->lo) / ((n->hi_deg - n->lo_deg) * DEG);
        sim_lag_start(&g->angle_rad[i], 1 / (TWO_PI * p->cutoff_Hz), angle_rad[i]);
        g->of[i] = (unsigned char)i;
        g->share[i] = 1;
        g->seen[i] |= UINT32_C(1) << i;
        for (int k = 0; k < 2 && sim_glove_sensor[i].bend[k] >= 0; k++) {
            g->seen[sim_glove_sensor[i].bend[k]] |= UINT32_C(1) << i;
        }
    }
    g->moves = g->reads = (UINT32_C(1) << SIM_GLOVE_SENSORS) - 1;
    g->slot_left = p->settle_s > 0 ? sim_exp_neg(p->interval_s / p->settle_s) : 0;
    g->code_perV = CODES / p->span_V;
    g->noise_V_perLSB = p->noise_V / 6;
    g->noise_V_most = p->noise_V / 2;
    g->held_V = sim_glove_volt(g, 0, 0);
    g->held_s = -1;
}

void sim_glove_move(struct sim_glove *g, unsigned i, const struct sim_curve *x)
{
    sim_lag_follow(&g->angle_rad[i], x);
    g->moves |= g->seen[i];
}

void sim_glove_line(struct sim_glove *g, unsigned i, const struct sim_line *x, double left)
{
    sim_lag_line(&g->angle_rad[i], x, left);
    g->moves |= g->seen[i];
}

void sim_glove_follow(struct sim_glove *g, unsigned i, unsigned of, double share)
{
    g->of[i] = (unsigned char)of;
    g->share[i] = share;
    g->seen[of] |= g->seen[i];
    g->moves |= g->seen[i];
}

/* What is known by its peak-to-peak value is clipped there. 3 deviations: a thousand samples have
 * reached it about once on either side, so that a second at any usual rate measures all of it. */
static inline double noise_V(const struct sim_glove *g, struct sim_random *r)
{
    return limit(sim_random_normal(r) * g->noise_V_perLSB, g->noise_V_most);
}

/* Of a voltage in codes. */
static inline int16_t code_of(double v)
{
    v += CODES + 0.5; /* the cast cuts it off */
    return (int16_t)(v < 0 ? -32768 : v >= 65536 ? 32767 : (int32_t)v - 32768);
}

/* Channels first to end - 1 behind the multiplexer, the first held at t_s. It goes on as soon as a
 * channel is held: what is left of the one before has the whole slot to decay; left: of that before
 * the first. */
static void hold(struct sim_glove *g, unsigned first, unsigned end, double t_s, double tick_s,
    double left, double *held_V)
{
    const double slot_left = g->slot_left;
    double before_V = g->held_V;
    uint32_t moves = g->moves >> first;
    for (unsigned i = first; i < end; i++, moves >>= 1) {
        double v = g->volt_V[i];
        if (g->fault[i] != SIM_GLOVE_WELL || moves & 1) {
            v = moved_V(g, i, i > first ? sim_glove_held_s(&g->par, i, tick_s) : t_s);
        }
        held_V[i] = before_V = v + (before_V - v) * left;
        left = slot_left;
    }
    g->held_V = before_V;
    g->held_s = end > first + 1 ? sim_glove_held_s(&g->par, end - 1, tick_s) : t_s;
}

/* A channel that is not read keeps its code; no other gets its random numbers. */
static void convert(
    struct sim_glove *g, unsigned first, unsigned end, double t_s, double tick_s, double left)
{
    const double code_perV = g->code_perV;
    const unsigned numbers = g->noise_V_most > 0 ? SIM_RANDOM_NORMAL : 0;
    struct sim_random rng = g->rng;
    uint32_t reads = g->reads >> first;
    double held_V[SIM_GLOVE_SENSORS];
    hold(g, first, end, t_s, tick_s, left, held_V);
    for (unsigned i = first; i < end; i++, reads >>= 1) {
        double v = held_V[i];
        if (!(reads & 1)) {
            sim_random_skip(&rng, numbers);
            continue;
        }
        if (numbers) { v += noise_V(g, &rng); }
        if (g->fault[i] != SIM_GLOVE_STUCK) { g->code[i] = code_of(v * code_perV); }
    }
    g->rng = rng;
}

void sim_glove_reads(struct sim_glove *g, uint32_t channels)
{
    for (unsigned i = 0; i < SIM_GLOVE_SENSORS; i++) {
        if (!(channels >> i & 1)) { g->code[i] = code_of(sim_glove_volt(g, i, 0) * g->code_perV); }
    }
    g->reads = channels;
}

/* Of the channel before, behind a slot of any length. */
static double left_at(const struct sim_glove *g, double t_s)
{
    const double slot_s = t_s - g->held_s, settle_s = g->par.settle_s;
    return settle_s > 0 && slot_s > 0 ? sim_exp_neg(slot_s / settle_s) : 0;
}

int16_t sim_glove_convert(struct sim_glove *g, unsigned i, double t_s)
{
    convert(g, i, i + 1, t_s, t_s, left_at(g, t_s));
    return g->code[i];
}

void sim_glove_scan(struct sim_glove *g, unsigned first, unsigned end, double tick_s, int16_t *raw)
{
    const double t_s = sim_glove_held_s(&g->par, first, tick_s);
    convert(g, first, end, t_s, tick_s, first == 0 ? left_at(g, t_s) : g->slot_left);
    memcpy(raw + first, g->code + first, (end - first) * sizeof raw[0]);
}

int16_t sim_glove_code(const struct sim_glove_par *p, double v_V)
{
    return code_of(v_V * (CODES / p->span_V));
}
