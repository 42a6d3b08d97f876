/* SPDX-License-Identifier: MIT */
/* Door: what the Python package calls. The library works sample by sample; here are arrays of them,
 * the inline functions that a shared library does not have, and the tables of the scenes.
 *
 * What a caller keeps between two calls is memory of door_B[] bytes, zeros at first, which he does
 * not look into. Pointers are checked by the package, not here. */
#include "exhand/run/log.h"
#include "exhand/run/scene.h"

#include "exhand/board.h"
#include "exhand/contact.h"
#include "exhand/error.h"
#include "exhand/exhand.h"
#include "exhand/limiter.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- what the scenes ask of a board: here is none --- */

const struct exh_board_info exh_board_info = {"python", EXH_BOARD_VERSION, EXH_FINGERS, 32, 20000};
int exh_board_read_glove(struct exh_glove_in *in) { return in ? -EXH_E_ABSENT : -EXH_E_RANGE; }
uint32_t exh_board_cycles(void) { return 0; }
int exh_board_log(const void *rec, size_t len_B) { return rec && len_B ? 0 : 0; }
int exh_board_link_send(const void *buf, size_t len_B) { return buf && len_B ? 0 : 0; }
int exh_board_link_recv(void *buf, size_t cap_B) { return buf && cap_B ? 0 : 0; }

/* A contract of the library was broken. No value is given back, as none would be right. */
void exh_assert_failed(const char *file, int line)
{
    fprintf(stderr, "exhand: %s:%d: a contract of the library was broken: stopped\n", file, line);
    abort();
}

/* --- kernels --- */

struct velocity {
    union {
        struct exh_velocity_window_cfg window;
        struct exh_velocity_pole_cfg pole;
        struct exh_velocity_foaw_cfg foaw;
        struct exh_velocity_track_cfg track;
    } cfg;
    union {
        struct exh_velocity_window window;
        struct exh_velocity_pole pole;
        struct exh_velocity_foaw foaw;
        struct exh_velocity_track track;
    } s;
    int32_t method; /* 0 window, 1 pole, 2 foaw, 3 track */
};
struct counter {
    struct exh_quad_par par;
    struct exh_quad_cfg cfg;
    struct exh_quad s;
};
struct law {
    struct exh_contact_par par;
    struct exh_contact s;
};

/* Bytes of: a filter's set-up, one channel, velocity, counter, decoder, law, receiver, limiter's
 * set-up and state. */
const uint32_t door_B[] = {sizeof(struct exh_filter_cfg), sizeof(struct exh_filter),
    sizeof(struct velocity), sizeof(struct counter), sizeof(struct exh_quad_ab), sizeof(struct law),
    sizeof(struct exh_wire_rx), sizeof(struct exh_limiter_cfg), sizeof(struct exh_limiter)};

int door_filter_setup(
    struct exh_filter_cfg *cfg, int32_t order, int32_t fc_Hz_q16, uint32_t num, uint32_t den)
{
    const struct exh_filter_par par = {order, fc_Hz_q16};
    return exh_filter_setup(cfg, &par, (struct exh_period){num, den});
}

/* rows of n channels each; y may be x. */
void door_filter(const struct exh_filter_cfg *cfg, struct exh_filter *s, const int32_t *x,
    int32_t *y, size_t rows, uint32_t n)
{
    for (size_t k = 0; k < rows; k++) { exh_filter_step(s, cfg, x + k * n, y + k * n, n); }
}

int door_velocity_setup(struct velocity *v, int32_t method, int32_t step_m_q42, uint32_t num,
    uint32_t den, uint32_t a, uint32_t b)
{
    const struct exh_velocity_scale scale = {step_m_q42, {num, den}};
    const struct exh_velocity_par par = {(int32_t)a};
    v->method = method;
    switch (method) {
    case 0: return exh_velocity_window_setup(&v->cfg.window, scale, &par);
    case 1: return exh_velocity_pole_setup(&v->cfg.pole, scale, a);
    case 2: return exh_velocity_foaw_setup(&v->cfg.foaw, scale, a, b);
    default: return exh_velocity_track_setup(&v->cfg.track, scale, a);
    }
}

#define RUN(name) \
    for (size_t k = 0; k < n; k++) { \
        vel_mps_q27[k] = exh_velocity_##name##_step(&v->s.name, &v->cfg.name, cnt[k]); \
    } \
    break

void door_velocity(struct velocity *v, const int32_t *cnt, int32_t *vel_mps_q27, size_t n)
{
    switch (v->method) {
    case 0: RUN(window);
    case 1: RUN(pole);
    case 2: RUN(foaw);
    default: RUN(track);
    }
}

int door_counter_setup(struct counter *c, int32_t step_m_q42, int32_t speed_max_mps_q27,
    uint32_t num, uint32_t den, uint32_t bits)
{
    c->par = (struct exh_quad_par){step_m_q42, speed_max_mps_q27};
    return exh_quad_setup(&c->cfg, &c->par, (struct exh_period){num, den}, bits);
}

/* Returns 1 once a sample has moved faster than it may. */
int door_counter(struct counter *c, const uint32_t *raw, int32_t *cnt, size_t n)
{
    for (size_t k = 0; k < n; k++) { cnt[k] = exh_quad_step(&c->s, &c->cfg, raw[k]); }
    return c->s.lost;
}

void door_position(int32_t step_m_q42, const int32_t *cnt, int32_t *pos_m_q30, size_t n)
{
    const struct exh_quad_par par = {step_m_q42, 0};
    for (size_t k = 0; k < n; k++) { pos_m_q30[k] = exh_quad_pos_m_q30(&par, cnt[k]); }
}

/* mode 1, 2 or 4; returns the illegal steps since the first sample. */
uint32_t door_quadrature(
    struct exh_quad_ab *s, uint32_t mode, const uint8_t *ab, int32_t *cnt, size_t n)
{
    const struct exh_quad_mode *m = mode == 1   ? &exh_quad_x1
                                    : mode == 2 ? &exh_quad_x2
                                                : &exh_quad_x4;
    for (size_t k = 0; k < n; k++) {
        exh_quad_ab_step(s, m, ab[k]);
        cnt[k] = s->cnt;
    }
    return s->illegal;
}

/* in: position, velocity, wall of each tick. out: spring, damper, pullback, touching. */
void door_contact(struct law *l, const int32_t (*in)[3], int64_t (*out)[4], size_t n)
{
    for (size_t k = 0; k < n; k++) {
        const struct exh_contact_in i = {in[k][0], in[k][1], in[k][2]};
        struct exh_force_ledger f;
        out[k][3] = exh_contact_step(&l->s, &l->par, i, &f);
        out[k][0] = f.spring_N_q20;
        out[k][1] = f.damper_N_q20;
        out[k][2] = f.pullback_N_q20;
    }
}

/* The law without memory. */
void door_force(const struct law *l, const int32_t (*in)[3], int32_t *force_N_q20, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        const struct exh_contact_in i = {in[k][0], in[k][1], in[k][2]};
        force_N_q20[k] = exh_contact_force(&l->par, i);
    }
}

/* --- scenes --- */

extern const struct exh_scene exh_scene_drop, exh_scene_guarded, exh_scene_bilateral,
    exh_scene_glove, exh_scene_calibrate, exh_scene_bringup, exh_scene_identify;
static const struct exh_scene *const scenes[] = {&exh_scene_drop, &exh_scene_guarded,
    &exh_scene_bilateral, &exh_scene_glove, &exh_scene_calibrate, &exh_scene_bringup,
    &exh_scene_identify};

/* Name of scene k, and whether its frames have a glove's codes; NULL: there are no more. */
const char *door_scene(uint32_t k, int32_t *has_glove)
{
    if (k >= sizeof scenes / sizeof scenes[0]) { return NULL; }
    *has_glove = scenes[k]->read_glove != NULL;
    return scenes[k]->name;
}

/* Its table of outputs, or of parameters. */
const struct exh_signal_table *door_table(uint32_t k, int32_t of_params)
{
    const struct exh_scene *sc = scenes[k];
    if (!of_params) { return sc->signals; }
    if (sc->params && sc->params->table == NULL) { sc->defaults(); }
    return sc->params ? sc->params->table : NULL;
}

/* --- records of a log --- */

enum { AT, TYPE, LEN_B, SEQ, TICK, COLUMNS };

/* Whole records from *from on, into rows of `to`, cap of them: how many. *from moves behind the
 * last byte that was looked at, *damaged counts bytes that are of no record. */
size_t door_records(const uint8_t *log, size_t len_B, size_t *from, size_t *damaged,
    uint64_t (*to)[COLUMNS], size_t cap)
{
    size_t n = 0;
    while (n < cap && *from < len_B) {
        const size_t left = len_B - *from;
        struct exh_record r;
        const int32_t took =
            exh_record_decode(log + *from, left < UINT32_MAX ? (uint32_t)left : UINT32_MAX, &r);
        if (took < 0) {
            const uint8_t *next =
                left > 1 ? memchr(log + *from + 1, EXH_RECORD_SYNC & 0xFF, left - 1) : NULL;
            const size_t skip = next ? (size_t)(next - log) - *from : left;
            *damaged += skip;
            *from += skip;
            continue;
        }
        to[n][AT] = *from + EXH_RECORD_HEAD_B;
        to[n][TYPE] = r.type;
        to[n][LEN_B] = r.len_B;
        to[n][SEQ] = r.seq;
        to[n++][TICK] = r.tick;
        *from += (size_t)took;
        if (r.type == EXH_RECORD_END) { break; }
    }
    return n;
}

/* --- the wire --- */

/* One datagram by the rules of a receiver: its type if it is to be taken, or -EXH_E_... */
int door_wire(struct exh_wire_rx *rx, const uint8_t *packet, size_t len_B)
{
    struct exh_wire_packet p;
    return exh_wire_decode(rx, &p, packet, len_B);
}

/* --- the limiter --- */

void door_limiter(struct exh_limiter *s, const struct exh_limiter_cfg *cfg,
    const struct exh_limiter_in *in, struct exh_limiter_out *out, size_t n)
{
    for (size_t k = 0; k < n; k++) { exh_limiter_step(s, cfg, in + k, out + k); }
}
