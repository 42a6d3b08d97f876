/* SPDX-License-Identifier: MIT */
/* The payloads of wire, listed anew from docs/WIRE.md. */
#ifndef TEST_GOLDEN_WIRE_BODY_H
#define TEST_GOLDEN_WIRE_BODY_H

#include "golden.h"

#include "exhand/wire.h"

#define GOLDEN_BODY_B 231 /* the longest */

/* The payload of p->type; nothing of another type. */
void golden_body_list(struct exh_bytes *c, struct exh_wire_packet *p);

/* A payload that can be. */
void golden_body_any(struct golden_rng *r, int64_t type, uint8_t *b);

/* Gives it one value that cannot be; PARAM and ACK have none. */
void golden_body_spoil(struct golden_rng *r, int64_t type, uint8_t *b);

#endif
