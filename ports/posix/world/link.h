/* SPDX-License-Identifier: MIT */
/* The link to the controller: UDP, one datagram a packet, never waiting. Either end may come, go
 * and come back in any order. */
#ifndef WORLD_LINK_H
#define WORLD_LINK_H

#include "scene_text.h"

#include "exhand/keyed.h"
#include "exhand/signal.h"
#include "exhand/wire.h"

#include <netinet/in.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/socket.h>

#define LINK_PORT  "5758"
#define LINK_WANTS (3 * SCENE_MATERIALS_MAX)

/* A value that the controller is to have. */
struct link_want {
    struct exh_wire_param param;
    const struct exh_signal *row;
    char name[SCENE_NAME_B]; /* of the material */
    int answered;
    int64_t asked_us;
};

/* What it is to trace: signals "q[1],f_des[1]", four at most, of the controller's table of outputs.
 */
struct link_trace_want {
    const struct exh_signal_table *table;
    const char *path, *signals;
    uint32_t every; /* ticks from frame to frame */
};

struct link_trace {
    const struct exh_signal_table *table;
    const char *path;
    FILE *file;                        /* NULL: none */
    struct exh_wire_trace_request ask; /* every 0: none */
    unsigned signals;                  /* of the four that it asks for */
    int asked, answered;               /* of this controller; by it */
    uint32_t first_seq, last_seq;      /* of the packets that asked */
    int64_t asked_us;
    uint32_t next; /* number of the frame that comes next */
    unsigned long frames, missed;
};

struct link {
    int fd;
    struct sockaddr_storage peer;
    socklen_t peer_B; /* 0: no peer yet */
    int fixed;        /* peer was given, and only it is listened to */
    struct exh_wire_tx tx;
    struct exh_wire_rx rx;
    int has_key;
    struct exh_keyed keyed;
    unsigned misfits; /* of keys that were said, bits */
    uint32_t echo_seq, echo_stamp_us;
    int64_t hello_us; /* when the last HELLO went out */
    int64_t heard_us; /* when packets were last read */
    struct exh_wire_hello theirs;
    unsigned differs;        /* enum exh_wire_difference, of the newest HELLO */
    unsigned long odd;       /* HELLOs that differed */
    unsigned long strangers; /* from elsewhere than the peer that was given */
    unsigned long sent, unsent;
    uint32_t table_crc; /* of the parameters the world was built for; 0: of none */
    struct link_want want[LINK_WANTS];
    int wants, waiting; /* how many; and have no answer */
    int impatient;      /* some got none for long: planes go out without */
    int64_t anew_us;    /* since when it is this controller */
    unsigned long refused;
    struct link_trace trace;
    void (*say)(const char *text); /* a line about what is wrong; or NULL */
};

/* listen: "[ADDRESS:]PORT" or NULL; peer: "HOST:PORT" or NULL. 0, or 1 with the reason. */
int link_open(struct link *l, const char *listen, const char *peer, uint32_t session, char *error,
    size_t error_B);
void link_close(struct link *l);

/* From now on only packets with this key are accepted. start: key_start(). */
void link_key(struct link *l, const struct exh_mac_key *key, uint64_t start);

/* Sends the scene's materials, each checked against its row, to the controller. Requests start at
 * its HELLO, repeat until the answer, and start again after its restart. Planes of a material wait
 * for the answers, at most a second. Refusals here or there are reported. */
void link_materials(struct link *l, const struct scene *s);

/* One value of one material; 1: refused. */
int link_want(struct link *l, const char *name, const struct exh_signal *row, unsigned instance,
    double value);

/* Requests a trace at the controller's HELLO, repeatedly until the answer, and again after its
 * restart. Its frames become lines of a CSV. 0, 1 (no file) or 2 (no such signal) with the
 * reason. */
int link_trace_open(
    struct link *l, const struct link_trace_want *want, char *error, size_t error_B);

/* Says what was missed; without a frame no file is left. 1 after a line on stderr: it could not be
 * written. */
int link_trace_close(struct link *l);

/* Reads the received packets. Returns 1 if a newer state is in *state. */
int link_receive(struct link *l, struct exh_wire_state *state, int64_t now_us);

/* Sends HELLO when due, and answers the newest state. planes NULL: not of that state's hand; none
 * are sent. */
void link_answer(struct link *l, const struct exh_wire_planes *planes, int64_t now_us);

#endif
