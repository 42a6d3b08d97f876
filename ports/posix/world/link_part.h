/* SPDX-License-Identifier: MIT */
/* Between the parts of the link. */
#ifndef WORLD_LINK_PART_H
#define WORLD_LINK_PART_H

#include "link.h"

void link_put(struct link *l, struct exh_wire_packet *p, int64_t now_us);

/* The controller has restarted and has lost all requests. */
void link_params_anew(struct link *l, int64_t now_us);
void link_params_answered(struct link *l, const struct exh_wire_ack *a);
void link_params_ask(struct link *l, int64_t now_us);

/* The same for the trace. */
void link_trace_anew(struct link *l, int64_t now_us);
void link_trace_ask(struct link *l, int64_t now_us);
void link_trace_take(struct link *l, const struct exh_wire_trace *in);

/* Planes of a material that the controller has not answered for become UNTOLD: it does not know yet
 * what they are to be felt with. */
void link_params_hide(struct link *l, struct exh_wire_planes *planes, int64_t now_us);

#endif
