/* SPDX-License-Identifier: MIT */
/* Pre-contact and wire: five fingers that come down, touch and leave, each at its own phase.
 * The same in double, as one would write it: distance and freeze rule, without hysteresis,
 * ages, births or counts. */
#include "bench.h"

#include "exhand/error.h"
#include "exhand/precontact.h"
#include "exhand/wire.h"

#include <math.h>
#include <string.h>

#define FINGERS 5u
#define CASES   300000
#define MM(x)   EXH_Q(x, 1000, EXH_Q_POS)

static const struct exh_material_par material[1] = {{1 << 24, 1 << 24, 1 << 22}};
static struct exh_precontact_par par;
static struct exh_precontact_cfg cfg;
static struct exh_precontact finger[FINGERS];
static struct exh_precontact_in at[FINGERS][BENCH_OPS];
static struct exh_plane plane;
static struct exh_wire_packet state, planes;
static struct exh_wire_tx tx;
static struct exh_wire_rx rx;
static uint8_t buf[EXH_WIRE_MAX_B];
static int32_t buf_B;

static struct {
    double n[3], point[3], tip[FINGERS][BENCH_OPS][3], q[FINGERS][BENCH_OPS], lim[FINGERS];
} dbl;

static double si(int32_t raw) { return (double)raw / (double)(1 << EXH_Q_POS); }

/* 64 mm down and up again over 1024 ticks, onto (0.6, 0, 0.8). */
static void fill(void)
{
    plane = (struct exh_plane){EXH_PLANE_HIT, 0, 1, {644245094, 0, 858993459}, {MM(60), 0, MM(80)}};
    for (uint32_t f = 0; f < FINGERS; f++) {
        for (uint32_t i = 0; i < BENCH_OPS; i++) {
            const int32_t u = (int32_t)((i + 205 * f) % BENCH_OPS);
            const int32_t off = MM(60) - MM(70) / 512 * (u < 512 ? u : 1024 - u);
            struct exh_precontact_in *in = &at[f][i];
            *in = (struct exh_precontact_in){{MM(60) + off / 10 * 6, MM(3), MM(80) + off / 10 * 8},
                {-6 * (1 << 20), 0, -8 * (1 << 20)}, MM(100) - off, 0, off < -MM(7), 1, 0};
            dbl.tip[f][i][0] = si(in->tip_m_q30.x);
            dbl.tip[f][i][1] = si(in->tip_m_q30.y);
            dbl.tip[f][i][2] = si(in->tip_m_q30.z);
            dbl.q[f][i] = si(in->pos_m_q30);
        }
        finger[f] = (struct exh_precontact){0};
        dbl.lim[f] = 1;
    }
    for (int k = 0; k < 3; k++) {
        dbl.n[k] = si((&plane.normal_q30.x)[k]);
        dbl.point[k] = si((&plane.point_m_q30.x)[k]);
    }
}

static void start_with(int from_slope)
{
    const struct exh_period T = {1, 2000};
    par = (struct exh_precontact_par){
        -MM(5), MM(1), 1 << 24, from_slope, 0, 60000, MM(5), 100, 50, 100};
    EXH_ASSERT(exh_precontact_setup(&cfg, &par, material, 1, MM(7), T) == 0);
    fill();
    for (uint32_t f = 0; f < FINGERS; f++) { exh_precontact_update(&finger[f], &cfg, &plane, 0); }
}

static void start(void) { start_with(0); }

static void start_slope(void) { start_with(1); }

static void step_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        bench_sink = exh_precontact_step(&finger[f], &cfg, &at[f][i]);
    }
}

static void tell_op(uint32_t i)
{
    (void)i;
    for (uint32_t f = 0; f < FINGERS; f++) { exh_precontact_update(&finger[f], &cfg, &plane, 0); }
}

static volatile double sink_double;

static void double_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        const double *p = dbl.tip[f][i];
        const double d = (dbl.point[0] - p[0]) * dbl.n[0] + (dbl.point[1] - p[1]) * dbl.n[1] +
                         (dbl.point[2] - p[2]) * dbl.n[2] + 0.007;
        if (!(d >= -0.005)) { dbl.lim[f] = dbl.q[f][i] - d; }
        sink_double = dbl.lim[f];
    }
}

/* --- errors --- */

static long double dot(const struct exh_vec3 *a, const struct exh_vec3 *b)
{
    return (long double)((int64_t)a->x * b->x) + (long double)((int64_t)a->y * b->y) +
           (long double)((int64_t)a->z * b->z);
}

static struct exh_vec3 any_unit(void)
{
    long double v[3], len = 0;
    for (int k = 0; k < 3; k++) {
        v[k] = bench_in(-1000000, 1000000) + 0.5L;
        len += v[k] * v[k];
    }
    len = sqrtl(len) / (1 << 30);
    return (struct exh_vec3){(int32_t)(v[0] / len), (int32_t)(v[1] / len), (int32_t)(v[2] / len)};
}

static struct exh_vec3 any_vec(int32_t size)
{
    const int32_t x = bench_in(-size, size), y = bench_in(-size, size), z = bench_in(-size, size);
    return (struct exh_vec3){x, y, z};
}

/* d and q_lim of one tick with a new plane; in LSB of 2^-30 m. */
static void error_of(struct error *e, int from_slope)
{
    start_with(from_slope);
    bench_seed();
    for (int i = 0; i < CASES; i++) {
        const struct exh_plane p = {EXH_PLANE_HIT, 0, 1, any_unit(), any_vec(MM(500))};
        struct exh_precontact_in in = {
            any_vec(MM(500)), {0, 0, 0}, bench_in(0, MM(500)), 0, 0, 1, 0};
        const long double pad = MM(7);
        struct exh_precontact s = {0};
        long double d, g;
        for (int k = 0; k < 3; k++) { /* some 0.8 m of fingertip a metre of string */
            (&in.slope_q24.x)[k] = -(&p.normal_q30.x)[k] / 80 + bench_in(-99999, 99999);
        }
        EXH_ASSERT(exh_precontact_update(&s, &cfg, &p, 0) == 0);
        exh_precontact_step(&s, &cfg, &in);
        d = (dot(&p.normal_q30, &p.point_m_q30) - dot(&p.normal_q30, &in.tip_m_q30)) / (1 << 30);
        d += pad;
        g = from_slope ? -dot(&p.normal_q30, &in.slope_q24) / (1 << 30) / (1 << 24) : 1;
        if (!from_slope) { error_add(e, s.d_m_q30 - d); }
        /* A far plane is no contact: only planes within 20 mm count. */
        if (d < par.d_lim_m_q30 - 1 && d > -MM(20)) {
            error_add(e, s.lim_m_q30 - (in.pos_m_q30 - d / g));
        }
    }
}

static void step_error(struct error *e) { error_of(e, 0); }

static void slope_error(struct error *e) { error_of(e, 1); }

static void no_error(struct error *e) { error_add(e, 0); }

/* --- packets --- */

static void start_wire(void)
{
    struct exh_wire_packet hello;
    start();
    memset(&state, 0, sizeof state);
    memset(&planes, 0, sizeof planes);
    memset(&hello, 0, sizeof hello);
    state.type = EXH_WIRE_STATE;
    planes.type = EXH_WIRE_PLANES;
    planes.u.planes.fingers = 31;
    hello.type = EXH_WIRE_HELLO;
    tx = (struct exh_wire_tx){1, 0};
    memset(&rx, 0, sizeof rx);
    buf_B = exh_wire_encode(&tx, &hello, 0, buf, sizeof buf);
    EXH_ASSERT(exh_wire_decode(&rx, &hello, buf, (size_t)buf_B) == EXH_WIRE_HELLO);
    buf_B = exh_wire_encode(&tx, &planes, 0, buf, sizeof buf);
}

static void write_op(uint32_t i) { bench_sink = exh_wire_encode(&tx, &state, i, buf, sizeof buf); }

static void take_op(uint32_t i)
{
    (void)i;
    rx.seq = tx.seq - 2; /* the same packet is new again */
    bench_sink = exh_wire_decode(&rx, &planes, buf, (size_t)buf_B);
}

#define METRE (1.0 / (1 << EXH_Q_POS))
static const struct kernel kernels[] = {
    {"precontact_x5", "m", METRE, 1, 1, start, step_op, step_error,
        "precontact.h: d 1/2 LSB and q_lim 1 from exact; random planes and fingertips", 0, NULL},
    {"precontact_slope_x5", "m", METRE, 4, 1, start_slope, step_op, slope_error,
        "s from the slope: q24 of it at d of up to 20 mm; random planes", 0, NULL},
    {"plain_double_freeze_x5", "m", METRE, 0, 1, start, double_op, no_error,
        "for the ratio: distance and freeze rule alone; its error is not taken", 116,
        "double distance and freeze rule, 5 fingers, private harness, gcc 12.2 -O2"},
    {"precontact_tell_x5", "", 1, 0, 1, start, tell_op, no_error, "exact", 0, NULL},
    {"wire_write_state", "", 1, 0, 1, start_wire, write_op, no_error, "exact; 236 bytes", 0, NULL},
    {"wire_take_planes", "", 1, 0, 1, start_wire, take_op, no_error, "exact; 231 bytes", 0, NULL},
};
const struct kernel_group precontact_group = {kernels, sizeof kernels / sizeof kernels[0]};
