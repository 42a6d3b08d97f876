/* SPDX-License-Identifier: MIT */
/* The glove, and the full box: glove to fingertips, planes of a link, five walls. The glove's
 * quantizer has 24 bits here, and is the integers' alone: one of fewer bits would hide what
 * arithmetic does. */
#include "scenes.h"

#include "exhand/error.h"

#include <math.h>
#include <string.h>

#define PI         3.14159265358979323846L
#define ROUND_S    1.2
#define MEET       0.55L /* the planes are at the fingertips' places then */
#define STRING_CNT 1000  /* of a whole bend */
#define ZERO       32768
#define PULL_N     10

static const struct exh_scene *scene;
static int box; /* 1: bilateral */
static struct exh_scene_in in;
static struct exh_drive_out out;
static struct exh_wire_tx world;
static struct exh_wire_packet planes;
static uint32_t ticks, rate;
static long double most_bent;
static struct pipe_glove_par glove_par;
static struct pipe_glove_double glove_double;
static struct pipe_glove_float glove_float;
static struct pipe_glove_exact glove_exact;
static struct pipe_plane_double plane_double[PIPE_FINGERS];
static struct pipe_plane_float plane_float[PIPE_FINGERS];
static struct pipe_plane_exact plane_exact[PIPE_FINGERS];
static struct pipe_wall_double wall_double[PIPE_FINGERS];
static struct pipe_wall_float wall_float[PIPE_FINGERS];
static struct pipe_wall_exact wall_exact[PIPE_FINGERS];
static int32_t cnt_now[PIPE_FINGERS];

/* --- the scene's inputs --- */

static void deliver(struct exh_wire_packet *p)
{
    struct exh_scene_mail *mail = scene->link->in;
    mail->len_B[0] = (uint16_t)exh_wire_encode(&world, p, 0, mail->byte[0], EXH_SCENE_PACKET_B);
    mail->packets = 1;
}

static void tick(void)
{
    exh_params_apply(scene->params);
    scene->tick(&in, &out);
    if (box) {
        scene->link->write();
        scene->link->in->packets = 0;
    }
    in.command = EXH_CMD_NONE;
    ticks++;
}

/* All fingers bent by a share, 0..1, strings out by as much. */
static void inputs(long double bent)
{
    in.drive.din = EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS;
    for (unsigned f = 0; f < PIPE_FINGERS; f++) {
        const int codes = out.dac_raw[f] - ZERO;
        cnt_now[f] = (int32_t)(STRING_CNT * bent);
        in.drive.din |= (uint32_t)EXH_DIN_DRIVE0 << f;
        in.drive.enc_raw[f] = (uint32_t)cnt_now[f];
        in.drive.mon_raw[f] = (int16_t)(codes + codes / 16); /* 1.06 for the drive's 1.05 */
    }
    in.glove_new = 1;
    for (unsigned i = 0; i < PIPE_SENSORS; i++) {
        const struct exh_glove_sensor *s = &exh_glove_cal_default.sensor[i];
        const long double span = s->high_raw - s->low_raw;
        in.glove.raw[i] = (int16_t)(s->low_raw + span * (0.05L + 0.9L * bent));
    }
}

static long double bent_at(uint32_t i)
{
    return most_bent / 2 * (1 - cosl(2 * PI * i / (ROUND_S * rate)));
}

/* --- the numbers of the integers --- */

static void glove_numbers(const struct glove_sensor_par *sensor, int32_t fc_Hz_q16)
{
    glove_par.fc_period = bench_q(fc_Hz_q16, 16) / rate;
    for (unsigned i = 0; i < PIPE_SENSORS; i++) {
        glove_par.zero[i] = bench_q(sensor[i].zero_raw_q15, EXH_Q_ZERO);
        glove_par.rad_per_code[i] = 2 * PI * bench_q(sensor[i].gain_turnpraw_q38, EXH_Q_TPRAW);
        for (int k = 0; k < 2; k++) {
            glove_par.cross[i][k] = bench_q(sensor[i].cross_q30[k], 30);
            glove_par.of[i][k] = sensor[i].of[k] < PIPE_SENSORS ? sensor[i].of[k] : -1;
        }
    }
    for (unsigned f = 0; f < PIPE_FINGERS; f++) {
        const struct exh_hand_bones *b = &exh_hit2_bones[f];
        for (unsigned k = 0; k < 3; k++) {
            const struct exh_hand_joint *j = &exh_hit2_map.joint[f][k];
            glove_par.bias[f][k] = 2 * PI * bench_q(j->bias_turn_q32, 32);
            glove_par.lo[f][k] = 2 * PI * bench_q(j->lo_turn_q32, 32);
            glove_par.hi[f][k] = 2 * PI * bench_q(j->hi_turn_q32, 32);
            glove_par.len[f][k] = bench_q(b->len_m_q34[k], 34);
            glove_par.base[f][k] = bench_q(b->base_m_q32[k], 32);
            for (unsigned t = 0; t < 2; t++) {
                glove_par.gain[f][k][t] = bench_q(j->gain_q24[t], 24);
                glove_par.sensor[f][k][t] = j->sensor[t];
            }
            for (unsigned t = 0; t < 3; t++) {
                glove_par.rot[f][k][t] = bench_q(b->rot_q30[k][t], 30);
            }
        }
    }
    pipe_glove_double_start(&glove_double, &glove_par, in.glove.raw);
    pipe_glove_float_start(&glove_float, &glove_par, in.glove.raw);
    pipe_glove_exact_start(&glove_exact, &glove_par, in.glove.raw);
}

static void wall_numbers(
    const struct bilateral_par *p, const struct bilateral_cfg *cfg, const struct bilateral *s)
{
    for (unsigned f = 0; f < PIPE_FINGERS; f++) {
        const struct exh_knot *end =
            &cfg->finger[f].calib.force_to_cur[cfg->finger[f].calib.to_cur_n - 1];
        const struct exh_material_par *m = &p->material[0];
        const struct exh_contact *c = &s->finger[f].contact;
        int32_t most =
            p->drive[f].f_max_N_q20 < m->f_max_N_q20 ? p->drive[f].f_max_N_q20 : m->f_max_N_q20;
        const struct pipe_wall_now now = {cnt_now[f], bench_q(c->turn_m_q30, EXH_Q_POS),
            bench_q(s->finger[f].drive.force_N_q20, EXH_Q_FORCE), c->inward, c->touching,
            (int)s->finger[f].rest_ticks};
        struct pipe_wall_par w = {0};
        if (end->x < most) { most = end->x; }
        w.step_m = bench_q(p->quad[f].step_m_q42, EXH_Q_STEP);
        w.period_s = 1.0L / rate;
        w.window = 1 << p->velocity[f].p;
        w.rest_ticks = (int)cfg->rest_ticks;
        w.speed_mps = bench_q(p->watch[f].speed_mps_q27, EXH_Q_VEL);
        w.k_Npm = bench_q(m->k_Npm_q10, EXH_Q_K);
        w.b_Nspm = bench_q(m->b_Nspm_q20, EXH_Q_B);
        w.f0_N = bench_q(p->contact[f].f0_N_q20, EXH_Q_FORCE);
        w.band_m = bench_q(p->contact[f].f0_band_m_q30, EXH_Q_POS);
        w.hyst_m = bench_q(p->contact[f].hyst_m_q30, EXH_Q_POS);
        w.f_max_N = bench_q(most, EXH_Q_FORCE);
        w.up_Nps = p->drive[f].slew_up_Nps;
        w.down_Nps = p->drive[f].slew_down_Nps;
        pipe_wall_double_start(&wall_double[f], &w, &now);
        pipe_wall_float_start(&wall_float[f], &w, &now);
        pipe_wall_exact_start(&wall_exact[f], &w, &now);
    }
}

/* A plane across the way that the fingertip goes, through where it is at MEET; its normal rounded.
 */
static void put_planes(const struct bilateral_par *p)
{
    static struct pipe_glove_exact at;
    int16_t raw[PIPE_SENSORS];
    memcpy(raw, in.glove.raw, sizeof raw);
    at = glove_exact;
    inputs(MEET);
    pipe_glove_exact_start(&at, &glove_par, in.glove.raw);
    pipe_glove_exact(&at, in.glove.raw);
    memset(&planes, 0, sizeof planes);
    planes.type = EXH_WIRE_PLANES;
    planes.u.planes.fingers = (1 << PIPE_FINGERS) - 1;
    for (unsigned f = 0; f < PIPE_FINGERS; f++) {
        struct exh_wire_plane *w = &planes.u.planes.plane[f];
        struct pipe_plane_par par = {.pad_m = bench_q(p->hand[f].pad_m_q30, EXH_Q_POS),
            .d_lim_m = bench_q(p->precontact[f].d_lim_m_q30, EXH_Q_POS),
            .hyst_m = bench_q(p->precontact[f].hyst_m_q30, EXH_Q_POS),
            .scale = bench_q(p->precontact[f].scale_q24, 24)};
        long double way[3], len = 0;
        for (int k = 0; k < 3; k++) {
            way[k] = glove_exact.tip[f][k] - at.tip[f][k];
            len += way[k] * way[k];
        }
        w->kind = EXH_PLANE_HIT;
        w->object = (uint16_t)f;
        for (int k = 0; k < 3; k++) {
            w->normal_q30[k] = (int32_t)(way[k] / sqrtl(len) * 0x1p30L);
            w->point_m_q30[k] = (int32_t)(at.tip[f][k] * 0x1p30L);
            par.n[k] = bench_q(w->normal_q30[k], 30);
            par.point[k] = bench_q(w->point_m_q30[k], EXH_Q_POS);
        }
        pipe_plane_double_start(&plane_double[f], &par);
        pipe_plane_float_start(&plane_float[f], &par);
        pipe_plane_exact_start(&plane_exact[f], &par);
    }
    memcpy(in.glove.raw, raw, sizeof raw);
}

/* --- a run --- */

static void begin(const char *name, uint32_t rate_Hz)
{
    const struct exh_scene_board board = {{1, rate_Hz}, 24};
    struct exh_wire_packet hello = {.type = EXH_WIRE_HELLO};
    int32_t k, b;
    box = strcmp(name, "bilateral") == 0;
    scene = box ? &exh_scene_bilateral : &exh_scene_glove;
    rate = rate_Hz;
    scenes_gains(rate, &k, &b);
    scene->params->locked = 0;
    scene->defaults();
    (void)exh_params_stage(scene->params, 0x0903, 0, 24);
    (void)exh_params_stage(scene->params, 0x0904, 0, 0);
    (void)exh_params_stage(scene->params, 0x0902, 0, 30 * 65536);
    (void)exh_params_stage(scene->params, 0x8401, 0, 1);
    if (box) {
        (void)exh_params_stage(scene->params, 0x8903, 0, 1);
        (void)exh_params_stage(scene->params, 0x8610, 0, (1 << PIPE_FINGERS) - 1);
        (void)exh_params_stage(scene->params, 0x8617, 0, 0); /* any gains */
        (void)exh_params_stage(scene->params, 0x0B01, 0, k * 1024);
        (void)exh_params_stage(scene->params, 0x0B02, 0, b * (1 << 20));
        for (uint16_t f = 0; f < PIPE_FINGERS; f++) {
            (void)exh_params_stage(scene->params, 0x0C04, f, 0);
        }
    }
    exh_params_apply(scene->params);
    EXH_ASSERT(scene->setup(board) == 0);
    scene->params->locked = 1;
    memset(&in, 0, sizeof in);
    ticks = 0;
    most_bent = 1;
    for (unsigned f = 0; f < PIPE_FINGERS; f++) { out.dac_raw[f] = ZERO; }
    if (!box) {
        inputs(0);
        tick();
        glove_numbers(((const struct glove_par *)scene->params->active)->sensor,
            ((const struct glove_par *)scene->params->active)->glove.fc_Hz_q16);
        return;
    }
    hello.u.hello.role = EXH_WIRE_WORLD;
    world = (struct exh_wire_tx){7, 0};
    deliver(&hello);
    for (uint32_t i = 0; i < 3 * rate + 100 && !exh_safety_is_running(scene->safety); i++) {
        in.command = (uint8_t)(i == 0 ? EXH_CMD_RUN : EXH_CMD_NONE);
        inputs(0);
        tick();
    }
    EXH_ASSERT(exh_safety_is_running(scene->safety));
    {
        const struct bilateral_par *p = (const struct bilateral_par *)scene->params->active;
        struct bilateral_cfg *cfg;
        const struct bilateral *s = bilateral_memory(&cfg);
        glove_numbers(p->sensor, p->glove.fc_Hz_q16);
        pipe_glove_exact(&glove_exact, in.glove.raw);
        wall_numbers(p, cfg, s);
        put_planes(p);
        glove_numbers(p->sensor, p->glove.fc_Hz_q16);
    }
}

static void in_double(void)
{
    pipe_glove_double(&glove_double, in.glove.raw);
    for (int f = 0; f < PIPE_FINGERS && box; f++) {
        const double q = cnt_now[f] * wall_double[f].step;
        pipe_plane_double(&plane_double[f], glove_double.tip[f], q, wall_double[f].touching);
        (void)pipe_wall_double(&wall_double[f], cnt_now[f], plane_double[f].lim);
    }
}

static void in_float(void)
{
    pipe_glove_float(&glove_float, in.glove.raw);
    for (int f = 0; f < PIPE_FINGERS && box; f++) {
        const float q = (float)cnt_now[f] * wall_float[f].step;
        pipe_plane_float(&plane_float[f], glove_float.tip[f], q, wall_float[f].touching);
        (void)pipe_wall_float(&wall_float[f], cnt_now[f], plane_float[f].lim);
    }
}

static void in_exact(void)
{
    pipe_glove_exact(&glove_exact, in.glove.raw);
    for (int f = 0; f < PIPE_FINGERS && box; f++) {
        const long double q = cnt_now[f] * wall_exact[f].step;
        pipe_plane_exact(&plane_exact[f], glove_exact.tip[f], q, wall_exact[f].touching);
        (void)pipe_wall_exact(&wall_exact[f], cnt_now[f], plane_exact[f].lim);
    }
}

static void add(
    struct scenes_sum *s, long double fixed, long double dbl, long double flt, long double want)
{
    error_add(&s->way[FIXED], fixed - want);
    error_add(&s->way[DOUBLE], dbl - want);
    error_add(&s->way[FLOAT], flt - want);
}

static void compare(struct scenes_sum *angle, struct scenes_sum *tip, struct scenes_sum *force)
{
    const struct glove_signals *sig =
        box ? NULL : (const struct glove_signals *)exh_scene_signals(scene);
    const struct bilateral_signals *all =
        box ? (const struct bilateral_signals *)exh_scene_signals(scene) : NULL;
    for (int f = 0; f < PIPE_FINGERS; f++) {
        const int32_t *joint = box ? all->more[f].joint_turn_q32 : sig->joint_turn_q32[f];
        const struct exh_vec3 *p = box ? &all->more[f].tip_m_q30 : &sig->tip_m_q30[f];
        for (int k = 0; k < 3; k++) {
            add(angle, 2 * PI * bench_q(joint[k], 32), glove_double.joint[f][k],
                glove_float.joint[f][k], glove_exact.joint[f][k]);
            add(tip, bench_q(((const int32_t *)p)[k], EXH_Q_POS), glove_double.tip[f][k],
                glove_float.tip[f][k], glove_exact.tip[f][k]);
        }
        if (box && wall_exact[f].touching) {
            add(force, bench_q(all->paper[f].f_des_N_q20, EXH_Q_FORCE), wall_double[f].force,
                wall_float[f].force, wall_exact[f].force);
        }
    }
}

static void round_of(uint32_t i)
{
    inputs(bent_at(i));
    if (box && i % 5 == 0) {
        planes.u.planes.echo_stamp_us = (uint32_t)((uint64_t)ticks * 1000000 / rate);
        deliver(&planes);
    }
    tick();
}

/* How far to bend, so that the strings are some millimetres past the planes, as the first round
 * finds these. */
static long double far_enough(void)
{
    int32_t k, b;
    long double lim = 0;
    scenes_gains(rate, &k, &b);
    for (int f = 0; f < PIPE_FINGERS; f++) {
        const long double at = plane_exact[f].lim / (wall_exact[f].step * STRING_CNT);
        if (at > lim) { lim = at; }
    }
    lim += (long double)PULL_N / k / (wall_exact[0].step * STRING_CNT);
    return lim < 1 ? lim : 1;
}

void scenes_hand(const char *name, uint32_t rate_Hz, double seconds)
{
    static const struct scenes_sum none;
    struct scenes_sum angle = none, tip = none, force = none;
    const uint32_t once = (uint32_t)(ROUND_S * rate_Hz);
    long double far = 1;
    uint32_t i = 0;
    begin(name, rate_Hz);
    for (; box && i < once; i++) {
        round_of(i);
        in_double();
        in_float();
        in_exact();
        if (i == once / 2) { far = far_enough(); }
    }
    most_bent = far;
    for (uint32_t end = i + (uint32_t)(seconds * rate); i < end; i++) {
        round_of(i);
        in_double();
        in_float();
        in_exact();
        compare(&angle, &tip, &force);
    }
    scenes_print(name, rate, "joints", "rad", &angle);
    scenes_print(name, rate, "fingertips", "m", &tip);
    if (box) {
        EXH_ASSERT(exh_safety_is_running(scene->safety));
        scenes_print(name, rate, "force", "N", &force);
    }
}

/* --- ops --- */

static struct exh_scene_in op_in[BENCH_OPS];

void scenes_hand_setup(const char *name)
{
    begin(name, 2000);
    for (uint32_t i = 0; i < 2 * BENCH_OPS; i++) {
        round_of(i);
        op_in[i % BENCH_OPS] = in;
    }
}

static void fixed_op(uint32_t i)
{
    in = op_in[i];
    in.drive.mon_raw[0] = (int16_t)((out.dac_raw[0] - ZERO) * 17 / 16);
    scene->tick(&in, &out);
    bench_sink = out.dac_raw[0];
}

static void double_op(uint32_t i)
{
    in = op_in[i];
    in_double();
    bench_sink = glove_double.tip[0][0] > 0;
}

static void float_op(uint32_t i)
{
    in = op_in[i];
    in_float();
    bench_sink = glove_float.tip[0][0] > 0;
}

void (*const scenes_hand_op[WAYS])(uint32_t i) = {fixed_op, double_op, float_op};
