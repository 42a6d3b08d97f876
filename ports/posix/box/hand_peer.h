/* SPDX-License-Identifier: MIT */
/* The world's end of the link, in this process and in virtual time: walls put up where a command
 * wants them, or a scene of the world simulator. */
#ifndef CLI_BILATERAL_PEER_H
#define CLI_BILATERAL_PEER_H

#include "sim/link.h"
#include "world/pace.h"

#include "exhand/wire.h"

#include <stdint.h>

#define PEER_PARAMS 32

struct world;

/* A world: static walls, one per finger; or a scene. */
struct peer_world {
    struct world *scene; /* NULL: the walls */
    struct exh_wire_planes wall;
    double ray_m;          /* walls farther off than this are not seen; 0: all are */
    double jump_s, jump_m; /* from then on (0: never) walls are this much nearer */
};

/* d of a tip, n.(P - tip) + pad, m; of a plane that is none: -1e3. */
double peer_gap_m(const struct exh_wire_plane *p, const int32_t tip_m_q30[3]);

/* What the fingers of this state, whose joints turn at this pace, are about to touch. */
void peer_look(const struct peer_world *w, const struct exh_wire_state *in, const struct pace *pace,
    double t_s, struct exh_wire_planes *out);

/* It exists from from_s to until_s, and, restarted, from again_s (0: not); otherwise packets to it
 * are lost. It sets the parameters until each is acknowledged. */
struct peer_cfg {
    const struct peer_world *world;
    double from_s, until_s, again_s;
    double param_from_s; /* it sets none before */
    int hostile;         /* each packet comes again so often: a bit flipped, cut short, too long */
    struct exh_wire_param param[PEER_PARAMS];
    int params;
    struct exh_wire_trace_request
        trace; /* it asks for this until it is answered; every 0: for none */
};

/* Of a trace, as it came. */
struct peer_trace {
    int answered;
    uint32_t request_seq, next;
    uint32_t frames, missed; /* that came; that never will: by their numbers */
    uint32_t first_tick, last_tick;
    uint32_t unruly; /* frames not `every` ticks behind the one before */
};

struct peer {
    struct peer_cfg cfg;
    struct exh_wire_tx tx;
    struct exh_wire_rx rx;
    struct exh_wire_packet in[2]; /* the newest STATE, and room for the next packet */
    unsigned at;                  /* of the STATE */
    struct pace pace;
    uint32_t echo_seq, echo_stamp_us;
    double hello_s, param_s; /* when the last went out */
    double met_s;            /* when the controller was first heard of; < 0: not yet */
    double heard_s;          /* when it last looked for packets */
    unsigned acked, refused; /* masks of parameters */
    uint64_t frames, answers;
    int told; /* a state has come */
    int born_again;
    struct peer_trace trace;
    double trace_s;   /* when it last asked */
    uint32_t spoiled; /* packets */
};

void peer_start(struct peer *p, const struct peer_cfg *cfg, uint32_t session);

/* posix_line's frame; ctx is a peer. */
void peer_frame(void *ctx, struct sim_link *link, double t_s);

#endif
