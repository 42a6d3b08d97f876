/* SPDX-License-Identifier: MIT */
#include "world.h"

#include "exhand/exhand.h"

#include <string.h>

static struct exh_wire_tx tx = {7, 0};
static struct exh_wire_rx rx;
static struct exh_wire_state first, newest;
static struct exh_wire_planes planes;

static int32_t size_of(int32_t v) { return v < 0 ? -v : v; }

void world_place(void)
{
    planes.fingers = newest.fingers;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const int32_t *was = first.tip_m_q30[f], *is = newest.tip_m_q30[f];
        struct exh_wire_plane *p = &planes.plane[f];
        int axis = 0;
        for (int k = 1; k < 3; k++) {
            if (size_of(is[k] - was[k]) > size_of(is[axis] - was[axis])) { axis = k; }
        }
        memset(p, 0, sizeof *p);
        p->kind = newest.fingers >> f & 1 ? EXH_PLANE_HIT : EXH_PLANE_UNTOLD;
        p->object = (uint16_t)f;
        p->normal_q30[axis] = is[axis] > was[axis] ? -(INT32_C(1) << 30) : INT32_C(1) << 30;
        p->point_m_q30[axis] = is[axis];
    }
}

static void put(struct exh_scene_mail *to, struct exh_wire_packet *p)
{
    const int32_t n = exh_wire_encode(&tx, p, 0, to->byte[to->packets], EXH_SCENE_PACKET_B);
    if (n > 0) { to->len_B[to->packets++] = (uint16_t)n; }
}

static void answer(struct exh_scene_mail *to, const struct exh_wire_packet *state)
{
    struct exh_wire_packet p = {.type = EXH_WIRE_PLANES};
    if (first.fingers == 0) { first = state->u.state; }
    newest = state->u.state;
    p.u.planes = planes;
    p.u.planes.echo_seq = state->seq;
    p.u.planes.echo_stamp_us = state->stamp_us;
    put(to, &p);
}

void world_answer(const struct exh_scene_link *link)
{
    link->in->packets = 0;
    for (unsigned i = 0; i < link->out->packets; i++) {
        struct exh_wire_packet p;
        const int type = exh_wire_decode(&rx, &p, link->out->byte[i], link->out->len_B[i]);
        if (type == EXH_WIRE_HELLO) {
            p.u.hello.role = EXH_WIRE_WORLD;
            put(link->in, &p);
        } else if (type == EXH_WIRE_STATE) {
            answer(link->in, &p);
        }
    }
}
