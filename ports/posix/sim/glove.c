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
#define ALL    ((UINT32_C(1) << SIM_GLOVE_SENSORS) - 1)

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
SIM_ROWS(sim_glove_par, sim_glove_row);

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
    const double below = v < most ? v : most;
    return below > -most ? below : -most;
}

/* Of a share of the excitation. */
static double amplified(const struct sim_glove_par *p, double share)
{
    return limit(p->gain * p->excite_V * share + p->offset_V, p->rail_V);
}

/* Of angles that began a line at from_s: what the low-pass has left of what was before. */
struct left {
    double from_s, left;
};

/* As the sensor sees it, behind the low-pass, with what it has of its neighbours. *rests: 0, it may
 * move. */
static double bent_rad(
    const struct sim_glove *g, unsigned i, double t_s, const struct left *now, int *rests)
{
    const struct sim_glove_sees *sees = &g->sees[i];
    double rad = 0;
    for (unsigned k = 0; k < sees->n; k++) {
        const struct sim_lag *l = &g->angle_rad[sees->of[k]];
        const int known = now && l->x.start_s == now->from_s;
        *rests &= sim_lag_rests(l);
        rad += sees->share[k] * (known ? sim_lag_left(l, t_s, now->left) : sim_lag_at(l, t_s));
    }
    return rad;
}

static double shown_V(const struct sim_glove *g, unsigned i, double rad)
{
    const struct sim_glove_par *p = &g->par;
    switch (g->fault[i]) {
    case SIM_GLOVE_RAIL_HIGH: return p->rail_V;
    case SIM_GLOVE_RAIL_LOW: return -p->rail_V;
    case SIM_GLOVE_OPEN: return amplified(p, 1);
    case SIM_GLOVE_SHORT: return amplified(p, 0);
    default: return limit(g->at_0_V[i] + rad * g->V_perrad[i], p->rail_V);
    }
}

double sim_glove_volt(const struct sim_glove *g, unsigned i, double t_s)
{
    int rests = 0;
    return shown_V(g, i, bent_rad(g, i, t_s, NULL, &rests));
}

/* The same, where all angles stay or began a straight line so long ago. */
static inline double line_V(const struct sim_glove *g, unsigned i, double s, double left)
{
    const struct sim_glove_sees *sees = &g->sees[i];
    const struct sim_lag *l = &g->angle_rad[sees->of[0]];
    double rad = sees->share[0] * (l->p[0] + l->p[1] * s + l->off * left);
    for (unsigned k = 1; k < sees->n; k++) {
        l = &g->angle_rad[sees->of[k]];
        rad += sees->share[k] * (l->p[0] + l->p[1] * s + l->off * left);
    }
    return limit(g->at_0_V[i] + rad * g->V_perrad[i], g->par.rail_V);
}

/* Which angles bend this sensor. */
static void look(struct sim_glove *g, unsigned i)
{
    struct sim_glove_sees *sees = &g->sees[i];
    const int *bend = sim_glove_sensor[i].bend;
    sees->n = 1;
    sees->of[0] = g->of[i];
    sees->share[0] = g->share[i];
    for (int k = 0; k < 2 && bend[k] >= 0 && g->par.couple != 0; k++) {
        sees->of[sees->n] = g->of[bend[k]];
        sees->share[sees->n++] = g->par.couple / 2 * g->share[bend[k]];
    }
    g->volt_V[i] = line_V(g, i, 0, 0);
}

void sim_glove_start(struct sim_glove *g, const struct sim_glove_par *p, uint64_t seed,
    const double angle_rad[SIM_GLOVE_SENSORS])
{
    memset(g, 0, sizeof *g);
    g->par = *p;
    g->rng.state = seed;
    for (unsigned i = 0; i < SIM_GLOVE_SENSORS; i++) {
        const struct sim_glove_sensor *n = &sim_glove_sensor[i];
        const double perrad = (n->hi - n->lo) / ((n->hi_deg - n->lo_deg) * DEG);
        const double live_V = p->gain * p->excite_V * (1 - 2 * p->dead);
        g->V_perrad[i] = live_V * perrad;
        g->at_0_V[i] = p->gain * p->excite_V * p->dead + p->offset_V +
                       live_V * (n->lo - n->lo_deg * DEG * perrad);
        sim_lag_start(&g->angle_rad[i], 1 / (TWO_PI * p->cutoff_Hz), angle_rad[i]);
        g->of[i] = (unsigned char)i;
        g->share[i] = 1;
        g->seen[i] |= UINT32_C(1) << i;
        for (int k = 0; k < 2 && sim_glove_sensor[i].bend[k] >= 0; k++) {
            g->seen[sim_glove_sensor[i].bend[k]] |= UINT32_C(1) << i;
        }
    }
    for (unsigned i = 0; i < SIM_GLOVE_SENSORS; i++) { look(g, i); }
    g->reads = g->holds = g->stays = ALL;
    g->tau_s = 1 / (TWO_PI * p->cutoff_Hz);
    g->line_left = sim_exp_neg(p->interval_s / g->tau_s);
    g->slot_left = p->settle_s > 0 ? sim_exp_neg(p->interval_s / p->settle_s) : 0;
    g->code_perV = CODES / p->span_V;
    g->noise_V_perLSB = p->noise_V / 6;
    g->noise_V_most = p->noise_V / 2;
    g->held_V = sim_glove_volt(g, 0, 0);
    g->held_s = -1;
}

void sim_glove_move(struct sim_glove *g, unsigned i, const struct sim_curve *x)
{
    const uint32_t angle = UINT32_C(1) << i;
    sim_lag_follow(&g->angle_rad[i], x);
    g->lines = x->start_s != g->line_s ? 0 : g->lines & ~angle;
    g->line_s = x->start_s;
    g->stays &= ~angle;
    g->moves |= g->seen[i];
}

void sim_glove_follow(struct sim_glove *g, unsigned i, unsigned of, double share)
{
    g->of[i] = (unsigned char)of;
    g->share[i] = share;
    g->seen[of] |= g->seen[i];
    g->moves |= g->seen[i];
    for (unsigned k = 0; k < SIM_GLOVE_SENSORS; k++) { look(g, k); }
}

/* What is known by its peak-to-peak value is clipped there. 3 deviations: a thousand samples have
 * reached it about once on either side, so that a second at any usual rate measures all of it. */
static inline double noise_V(const struct sim_glove *g, struct sim_random *r)
{
    return limit(sim_random_bytes(r) * g->noise_V_perLSB, g->noise_V_most);
}

/* Of a voltage in codes, far within 32 bits. The cast cuts a half off. */
static inline int16_t code_of(double v)
{
    const int32_t n = (int32_t)(v + (CODES + 0.5));
    if (n >> 16) { return n < 0 ? INT16_MIN : INT16_MAX; }
    return (int16_t)(n - 32768);
}

/* What the low-pass has left when channel `first` is held at t_s. Most angles that move began their
 * lines at the same time. */
static struct left left_of_line(struct sim_glove *g, unsigned first, double t_s)
{
    struct left now = {g->line_s, 0};
    const double s = sim_grid_s(g->line_s, t_s), tau_s = g->tau_s;
    if (s >= 0 && s < FORGOTTEN * tau_s) { now.left = sim_decay_at(&g->low_pass[first], tau_s, s); }
    return now;
}

/* Channels that have a fault, or that see an angle which moves other than on the newest lines.
 * *stuck: those whose code stays. */
static uint32_t odd(const struct sim_glove *g, uint32_t *stuck)
{
    uint64_t some, middle, last; /* words, which overlap: a byte each would take long */
    uint32_t mask = 0;
    memcpy(&some, g->fault, 8);
    memcpy(&middle, g->fault + 8, 8);
    memcpy(&last, g->fault + SIM_GLOVE_SENSORS - 8, 8);
    *stuck = 0;
    if (!(some | middle | last) && (g->lines | g->stays) == ALL) { return 0; }
    for (unsigned i = 0; i < SIM_GLOVE_SENSORS; i++) {
        if (!((g->lines | g->stays) >> i & 1)) { mask |= g->seen[i] & g->moves; }
        if (g->fault[i] != SIM_GLOVE_WELL) { mask |= UINT32_C(1) << i; }
        if (g->fault[i] == SIM_GLOVE_STUCK) { *stuck |= UINT32_C(1) << i; }
    }
    return mask;
}

/* Their voltages, the first held at t_s. That of a channel at rest and without a fault is kept. */
static void odd_V(
    struct sim_glove *g, uint32_t odds, unsigned first, double t_s, double tick_s, struct left now)
{
    for (unsigned i = first; odds >> i; i++, now.left *= g->line_left) {
        const double held_s = i > first ? sim_glove_held_s(&g->par, i, tick_s) : t_s;
        int rests = g->fault[i] == SIM_GLOVE_WELL;
        if (!(odds >> i & 1)) { continue; }
        g->volt_V[i] = shown_V(g, i, bent_rad(g, i, held_s, rests ? &now : NULL, &rests));
        g->moves = (g->moves & ~(UINT32_C(1) << i)) | (uint32_t)!rests << i;
    }
}

/* Channels first to end - 1 behind the multiplexer, the first held at t_s. It goes on as soon as a
 * channel is held: what is left of the one before has the whole slot to decay; left: of that before
 * the first. A channel that is not read keeps its code; no other gets its random number. */
static void convert(
    struct sim_glove *g, unsigned first, unsigned end, double t_s, double tick_s, double left)
{
    const double slot_left = g->slot_left, line_left = g->line_left, code_perV = g->code_perV;
    const double interval_s = g->par.interval_s;
    const struct left now = left_of_line(g, first, t_s);
    uint32_t stuck, holds = g->holds >> first & ((UINT32_C(1) << (end - first)) - 1);
    const uint32_t odds = odd(g, &stuck) & holds << first;
    const uint32_t lines = g->moves & ~odds, reads = g->reads & ~stuck;
    struct sim_random rng = g->rng;
    double before_V = g->held_V, line_s = t_s - g->line_s, way_left = now.left;
    if (odds) { odd_V(g, odds, first, t_s, tick_s, now); }
    for (unsigned i = first; holds; i++, holds >>= 1) {
        if (holds & 1) {
            const double v = lines >> i & 1 ? line_V(g, i, line_s, way_left) : g->volt_V[i];
            before_V = v + (before_V - v) * left;
            if (reads >> i & 1) {
                struct sim_random own = rng;
                g->code[i] = code_of((before_V + noise_V(g, &own)) * code_perV);
            }
        }
        sim_random_skip(&rng, 1);
        way_left *= line_left;
        line_s += interval_s;
        left = slot_left;
    }
    g->held_V = before_V;
    g->held_s = end > first + 1 ? sim_glove_held_s(&g->par, end - 1, tick_s) : t_s;
    if (g->noise_V_most > 0) { sim_random_skip(&g->rng, end - first); }
}

/* The channels that are read, and before each those that it has 1e-12 of. */
static uint32_t held(const struct sim_glove *g)
{
    uint32_t mask = g->reads;
    for (double left = g->slot_left; left > 1e-12; left *= g->slot_left) {
        const uint32_t more = (mask >> 1 | mask << (SIM_GLOVE_SENSORS - 1)) & ALL & ~mask;
        if (!more) { break; }
        mask |= more;
    }
    return mask;
}

void sim_glove_reads(struct sim_glove *g, uint32_t channels)
{
    for (unsigned i = 0; i < SIM_GLOVE_SENSORS; i++) {
        if (!(channels >> i & 1)) { g->code[i] = code_of(sim_glove_volt(g, i, 0) * g->code_perV); }
    }
    g->reads = channels;
    g->holds = held(g);
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

void sim_glove_scan(struct sim_glove *g, unsigned first, unsigned end, double tick_s)
{
    const double t_s = sim_glove_held_s(&g->par, first, tick_s);
    convert(g, first, end, t_s, tick_s, first == 0 ? left_at(g, t_s) : g->slot_left);
}

int16_t sim_glove_code(const struct sim_glove_par *p, double v_V)
{
    return code_of(limit(v_V, p->span_V) * (CODES / p->span_V));
}
