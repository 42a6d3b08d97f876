/* SPDX-License-Identifier: MIT */
/* One packet to the controller, counted as sent or not. */
#include "link_part.h"

#include "exhand/exhand.h"

void link_put(struct link *l, struct exh_wire_packet *p, int64_t now_us)
{
    unsigned char buf[EXH_KEYED_MAX_B];
    int32_t n = exh_wire_encode(&l->tx, p, (uint32_t)now_us, buf, EXH_WIRE_MAX_B);
    int sent;
    if (n > 0 && l->has_key) { n = exh_keyed_encode(&l->keyed, buf, (size_t)n, sizeof buf); }
    sent = n > 0 &&
           sendto(l->fd, buf, (size_t)n, 0, (const struct sockaddr *)&l->peer, l->peer_B) == n;
    l->sent += (unsigned long)sent;
    l->unsent += (unsigned long)!sent;
}
