/* The link to the controller: UDP, one datagram a packet, never waiting. Either end may come, go
 * and come back in any order. */
#ifndef WORLD_LINK_H
#define WORLD_LINK_H

#include "exhand/wire.h"

#include <netinet/in.h>
#include <stddef.h>
#include <sys/socket.h>

#define LINK_PORT "5758"

struct link {
    int fd;
    struct sockaddr_storage peer;
    socklen_t peer_B; /* 0: nobody so far                                        */
    int fixed;        /* peer was given, and only it is listened to               */
    struct exh_wire_tx tx;
    struct exh_wire_rx rx;
    uint32_t echo_seq, echo_stamp_us;
    int64_t hello_us; /* when the last HELLO went out                             */
    int64_t heard_us; /* when it was last looked what came                        */
    struct exh_wire_hello theirs;
    unsigned differs; /* enum exh_wire_differs, of the newest HELLO               */
    unsigned long odd; /* HELLOs that differed                                    */
    unsigned long strangers; /* from elsewhere than the peer that was given       */
    unsigned long sent, unsent;
};

/* listen: "[ADDRESS:]PORT" or NULL; peer: "HOST:PORT" or NULL. 0, or 1 with the reason. */
int link_open(struct link *l, const char *listen, const char *peer, uint32_t session, char *error,
              size_t error_B);
void link_close(struct link *l);

/* Takes what has come till now. 1 if a newer state is in *state. */
int link_receive(struct link *l, struct exh_wire_state *state, int64_t now_us);

/* Says HELLO when it is time, and answers the newest state. planes NULL: they are not of that
 * state's hand, and nobody is told them. */
void link_answer(struct link *l, const struct exh_wire_planes *planes, int64_t now_us);

#endif
