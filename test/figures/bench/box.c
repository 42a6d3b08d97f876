/* SPDX-License-Identifier: MIT */
/* Whole ticks of five fingers: the integer kernels of the paper's controller in one, as a program
 * calls them, and the full box with glove and link. Their parts' errors are other rows; their bits
 * are the golden vectors'. */
#include "bench.h"

#include "tick.h"

#include "bilateral/bilateral.h"
#include "exhand/board.h"

#include <string.h>

static void no_error(struct error *e) { error_add(e, 0); }

/* --- the kernels --- */

static struct tick_box kernel;
static struct tick_in kernel_in[BENCH_OPS];

static void kernel_setup(void)
{
    EXH_ASSERT(tick_setup(&kernel) == 0);
    for (uint32_t i = 0; i < BENCH_OPS; i++) { tick_input(&kernel_in[i], i); }
}

static void kernel_op(uint32_t i) { bench_sink = tick_once(&kernel, &kernel_in[i]); }

/* --- the full box: glove frames at a pace, planes and a state packet 400 times a second --- */

#define LINK_HZ    400u
#define PLANES     (2 * BENCH_OPS / 5 + 1) /* at 2 kHz; fewer at any higher rate */
#define ARM_TICKS  25000u
#define HALF       512u /* of a bend: flat at 0, a fist there, flat again at twice it */
#define MEET       300u /* the planes are at the fingertips' places then */
#define CODE_ZERO  32768
#define FINGERS_ID 0x8610
#define SESSION_ID 0x8613
#define WITHOUT_ID 0x8903 /* lib/src/run/calib_set: no calibration, and it arms */
#define STATE_ID   0x8611 /* examples/bilateral/tables.c: ticks from one state to the next */
#define GLOVE_ID   0x8401 /* examples/glove/cal: ticks from one frame to the next */

static const struct exh_scene *const box = &exh_scene_bilateral;
static struct exh_scene_in now[BENCH_OPS]; /* of each tick; monitors follow the codes */
static struct exh_drive_out out;
static uint8_t packet[PLANES][EXH_SCENE_PACKET_B];
static int32_t packet_B[PLANES];
static struct exh_wire_tx world;
static uint32_t rate_Hz, link_every, ticks, next;

/* As the loop does it, link and all. */
static void box_tick(struct exh_scene_in *in)
{
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const int codes = out.dac_raw[f] - CODE_ZERO;
        in->drive.mon_raw[f] = (int16_t)(codes + codes / 16); /* 1.06 for the drive's 1.05 */
    }
    exh_params_apply(box->params);
    box->tick(in, &out);
    box->link->write();
    box->link->in->packets = 0;
    ticks++;
}

/* Fingers `bent` of HALF, their strings out by as much. */
static void bend(struct exh_scene_in *in, uint32_t bent)
{
    in->drive.din = EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        in->drive.din |= (uint32_t)EXH_DIN_DRIVE0 << f;
        in->drive.enc_raw[f] = bent * 2;
    }
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *s = &exh_glove_cal_default.sensor[i];
        const int32_t span = s->high_raw - s->low_raw;
        in->glove.raw[i] = (int16_t)(s->low_raw + span * (int32_t)bent / (int32_t)HALF);
    }
}

static uint32_t bent_at(uint32_t i)
{
    const uint32_t at = i % (2 * HALF);
    return at < HALF ? at : 2 * HALF - at;
}

/* Along the axis that the fingertip moves along most, so that the normal is exact. */
static void put_plane(
    struct exh_wire_plane *p, unsigned f, const struct exh_vec3 *from, const struct exh_vec3 *to)
{
    const int32_t was[3] = {from->x, from->y, from->z}, is[3] = {to->x, to->y, to->z};
    int axis = 0;
    for (int k = 1; k < 3; k++) {
        const int32_t way = is[k] - was[k], most = is[axis] - was[axis];
        if ((way < 0 ? -way : way) > (most < 0 ? -most : most)) { axis = k; }
    }
    p->kind = EXH_PLANE_HIT;
    p->object = (uint16_t)f;
    p->normal_q30[axis] = is[axis] > was[axis] ? -(INT32_C(1) << 30) : INT32_C(1) << 30;
    p->point_m_q30[axis] = is[axis];
}

/* Packets of a world that answers immediately, HELLO first. */
static void write_packets(const struct exh_wire_planes *planes)
{
    struct exh_wire_packet hello = {.type = EXH_WIRE_HELLO}, p = {.type = EXH_WIRE_PLANES};
    hello.u.hello.role = EXH_WIRE_WORLD;
    world = (struct exh_wire_tx){7, 0};
    packet_B[0] = exh_wire_encode(&world, &hello, 0, packet[0], sizeof packet[0]);
    for (uint32_t i = 1; i < PLANES; i++) {
        p.u.planes = *planes;
        p.u.planes.echo_stamp_us = (ticks + link_every * i) * (1000000u / rate_Hz);
        packet_B[i] = exh_wire_encode(&world, &p, 0, packet[i], sizeof packet[i]);
    }
}

static void deliver(void)
{
    struct exh_scene_mail *mail = box->link->in;
    memcpy(mail->byte[0], packet[next], EXH_SCENE_PACKET_B);
    mail->len_B[0] = (uint16_t)packet_B[next];
    mail->packets = 1;
    next = next + 1 < PLANES ? next + 1 : 0;
}

static void arm(void)
{
    struct exh_scene_in flat = now[0];
    for (unsigned f = 0; f < EXH_FINGERS; f++) { out.dac_raw[f] = CODE_ZERO; }
    flat.glove_new = 1;
    flat.command = EXH_CMD_RUN;
    for (uint32_t i = 0; i < ARM_TICKS && !exh_safety_is_running(box->safety); i++) {
        box_tick(&flat);
        flat.command = EXH_CMD_NONE;
    }
    EXH_ASSERT(exh_safety_is_running(box->safety));
}

static void set(uint16_t id, int32_t raw) { (void)exh_params_stage(box->params, id, 0, raw); }

static void start(uint32_t glove_every)
{
    const struct exh_scene_board board = {{1, rate_Hz}, 24};
    memset(now, 0, sizeof now);
    for (uint32_t i = 0; i < BENCH_OPS; i++) {
        bend(&now[i], bent_at(i));
        now[i].glove_new = i % glove_every == 0;
    }
    box->defaults();
    set(WITHOUT_ID, 1);
    set(FINGERS_ID, (1 << EXH_FINGERS) - 1);
    set(SESSION_ID, 1);
    set(STATE_ID, (int32_t)link_every);
    set(GLOVE_ID, (int32_t)glove_every);
    exh_params_apply(box->params);
    EXH_ASSERT(box->setup(board) == 0);
    box->params->locked = 1;
    ticks = next = 0;
    arm();
}

static void box_setup(uint32_t per_s, uint32_t glove_every)
{
    struct exh_wire_planes planes;
    struct bilateral_cfg *cfg;
    const struct bilateral *state = bilateral_memory(&cfg);
    struct exh_vec3 from[EXH_FINGERS];
    rate_Hz = per_s;
    link_every = rate_Hz / LINK_HZ;
    start(glove_every);
    memset(&planes, 0, sizeof planes);
    planes.fingers = (1 << EXH_FINGERS) - 1;
    for (unsigned f = 0; f < EXH_FINGERS; f++) { from[f] = state->finger[f].tip_m_q30; }
    for (uint32_t i = 0; i < BENCH_OPS; i++) {
        box_tick(&now[i]);
        for (unsigned f = 0; f < EXH_FINGERS && i == MEET; f++) {
            put_plane(&planes.plane[f], f, &from[f], &state->finger[f].tip_m_q30);
        }
    }
    write_packets(&planes);
}

static void each_tick(void) { box_setup(2000, 1); }

static void in_turn(void) { box_setup(10000, 20); }

static void box_op(uint32_t i)
{
    if (i % link_every == 0) { deliver(); }
    box_tick(&now[i]);
    bench_sink = out.dac_raw[0];
}

static const struct kernel kernels[] = {
    {"integer_tick_x5", "", 1, 0, 1, kernel_setup, kernel_op, no_error,
        "22 low-passes, fingertips, distances, laws; errors: filter_2_x22, hand_tip_x5, "
        "precontact_x5, contact_law_x5",
        0, NULL},
    {"full_box_tick", "", 1, 0, 1, each_tick, box_op, no_error,
        "glove, link and five fingers at 2 kHz, a glove frame in every tick, planes and states in "
        "every fifth; the bits are the golden vectors'",
        0, NULL},
    {"full_box_in_turn", "", 1, 0, 1, in_turn, box_op, no_error,
        "the same at 10 kHz, a glove frame of 500 Hz that is computed in seven ticks, the link as "
        "often",
        0, NULL},
};
const struct kernel_group box_group = {kernels, sizeof kernels / sizeof kernels[0]};
