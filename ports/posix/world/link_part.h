/* SPDX-License-Identifier: MIT */
/* Between the parts of the link. */
#ifndef WORLD_LINK_PART_H
#define WORLD_LINK_PART_H

#include "link.h"

void link_put(struct link *l, struct exh_wire_packet *p, int64_t now_us);

/* The controller has started anew, and knows nothing of what was wanted. */
void link_params_anew(struct link *l, int64_t now_us);
void link_params_answered(struct link *l, const struct exh_wire_ack *a);
void link_params_ask(struct link *l, int64_t now_us);

/* The same of the trace. */
void link_trace_anew(struct link *l, int64_t now_us);
void link_trace_ask(struct link *l, int64_t now_us);
void link_trace_take(struct link *l, const struct exh_wire_trace *in);

/* 1: planes wait, for what they would be felt with is not known there yet. */
int link_params_hold(struct link *l, int64_t now_us);

#endif
