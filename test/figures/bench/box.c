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

/* --- the full box: a glove frame in every tick, planes and a state packet in every fifth --- */

#define RATE_HZ    2000u
#define EVERY      5u /* state_every of the scene */
#define PLANES     (2 * BENCH_OPS / EVERY + 1)
#define ARM_TICKS  5000u
#define HALF       512u /* of a bend: flat at 0, a fist there, flat again at twice it */
#define MEET       300u /* the planes stand where the fingertips are then */
#define CODE_ZERO  32768
#define FINGERS_ID 0x8610
#define SESSION_ID 0x8613
#define WITHOUT_ID 0x8903 /* lib/src/run/calib_set: no calibration, and it arms */

static const struct exh_scene *const box = &exh_scene_bilateral;
static struct exh_scene_in in;
static struct exh_drive_out out;
static uint8_t packet[PLANES][EXH_SCENE_PACKET_B];
static int32_t packet_B[PLANES];
static struct exh_wire_tx world;
static uint32_t ticks, next;

/* As the loop does it, link and all. */
static void box_tick(void)
{
    exh_params_apply(box->params);
    box->tick(&in, &out);
    box->link->write();
    box->link->in->packets = 0;
    in.command = EXH_CMD_NONE;
    ticks++;
}

/* Fingers `bent` of HALF, their strings out by as much. */
static void inputs(uint32_t bent)
{
    in.drive.din = EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const int codes = out.dac_raw[f] - CODE_ZERO;
        in.drive.din |= (uint32_t)EXH_DIN_DRIVE0 << f;
        in.drive.enc_raw[f] = bent * 2;
        in.drive.mon_raw[f] = (int16_t)(codes + codes / 16); /* 1.06 for the drive's 1.05 */
    }
    in.glove_new = 1;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *s = &exh_glove_cal_default.sensor[i];
        const int32_t span = s->high_raw - s->low_raw;
        in.glove.raw[i] = (int16_t)(s->low_raw + span * (int32_t)bent / (int32_t)HALF);
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

/* Packets of a world that answers at once, HELLO first. */
static void write_packets(const struct exh_wire_planes *planes)
{
    struct exh_wire_packet hello = {.type = EXH_WIRE_HELLO}, p = {.type = EXH_WIRE_PLANES};
    hello.u.hello.role = EXH_WIRE_WORLD;
    world = (struct exh_wire_tx){7, 0};
    packet_B[0] = exh_wire_encode(&world, &hello, 0, packet[0], sizeof packet[0]);
    for (uint32_t i = 1; i < PLANES; i++) {
        p.u.planes = *planes;
        p.u.planes.echo_stamp_us = (ticks + EVERY * i) * (1000000u / RATE_HZ);
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
    for (unsigned f = 0; f < EXH_FINGERS; f++) { out.dac_raw[f] = CODE_ZERO; }
    for (uint32_t i = 0; i < ARM_TICKS && !exh_safety_is_running(box->safety); i++) {
        in.command = (uint8_t)(i == 0 ? EXH_CMD_RUN : EXH_CMD_NONE);
        inputs(0);
        box_tick();
    }
    EXH_ASSERT(exh_safety_is_running(box->safety));
}

static void box_setup(void)
{
    const struct exh_scene_board board = {{1, RATE_HZ}, 24};
    struct exh_wire_planes planes;
    struct bilateral_cfg *cfg;
    const struct bilateral *state = bilateral_memory(&cfg);
    struct exh_vec3 from[EXH_FINGERS];
    box->defaults();
    (void)exh_params_stage(box->params, WITHOUT_ID, 0, 1);
    (void)exh_params_stage(box->params, FINGERS_ID, 0, (1 << EXH_FINGERS) - 1);
    (void)exh_params_stage(box->params, SESSION_ID, 0, 1);
    exh_params_apply(box->params);
    EXH_ASSERT(box->setup(board) == 0);
    box->params->locked = 1;
    memset(&in, 0, sizeof in);
    memset(&planes, 0, sizeof planes);
    ticks = next = 0;
    arm();
    planes.fingers = (1 << EXH_FINGERS) - 1;
    for (unsigned f = 0; f < EXH_FINGERS; f++) { from[f] = state->finger[f].tip_m_q30; }
    for (uint32_t i = 0; i < 2 * HALF; i++) {
        inputs(bent_at(i));
        box_tick();
        for (unsigned f = 0; f < EXH_FINGERS && i == MEET; f++) {
            put_plane(&planes.plane[f], f, &from[f], &state->finger[f].tip_m_q30);
        }
    }
    write_packets(&planes);
}

static void box_op(uint32_t i)
{
    inputs(bent_at(i));
    if (i % EVERY == 0) { deliver(); }
    box_tick();
    bench_sink = out.dac_raw[0];
}

static const struct kernel kernels[] = {
    {"integer_tick_x5", "", 1, 0, 1, kernel_setup, kernel_op, no_error,
        "22 low-passes, fingertips, distances, laws; errors: filter_2_x22, hand_tip_x5, "
        "precontact_x5, contact_law_x5",
        0, NULL},
    {"full_box_tick", "", 1, 0, 1, box_setup, box_op, no_error,
        "glove, link and five fingers at 2 kHz, planes and states in every fifth tick; the bits "
        "are "
        "the golden vectors'",
        0, NULL},
};
const struct kernel_group box_group = {kernels, sizeof kernels / sizeof kernels[0]};
