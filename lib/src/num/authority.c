/* SPDX-License-Identifier: MIT */
/* Table of permissions for changing parameters. */
#include "exhand/authority.h"

#include "exhand/error.h"
#include "exhand/signal.h"

/* The permission of a cell. Before the end of set-up, only NEVER and SAME refuse changes. */
enum cell {
    NEVER, /* also all sources and classes without a row */
    SAME,  /* only the present value, as when a client writes a whole block */
    SETUP, /* before the loop; then as SAME */
    REST,  /* another value only while the gate cannot be open */
    FALL,  /* as REST, and a lower value at any time */
    RISE,  /* as REST, and a higher value at any time */
    ANY    /* at any time */
};

/* In the order of both enums and without a gap: g++ takes such designators alone. */
static const uint8_t may[EXH_SOURCES][EXH_WHENS] = {
    [EXH_FROM_PERSON] = {[EXH_WHEN_OUTPUT] = NEVER,
        [EXH_WHEN_SETUP] = SETUP,
        [EXH_WHEN_ANY] = ANY,
        [EXH_WHEN_SLEWED] = ANY,
        [EXH_WHEN_LIMIT] = ANY,
        [EXH_WHEN_PERSON] = SETUP,
        [EXH_WHEN_BOUND] = ANY,
        [EXH_WHEN_WALL] = ANY,
        [EXH_WHEN_REST] = ANY,
        [EXH_WHEN_MATERIAL] = ANY,
        [EXH_WHEN_WORD] = ANY},
    [EXH_FROM_IMAGE] = {[EXH_WHEN_OUTPUT] = NEVER,
        [EXH_WHEN_SETUP] = SETUP,
        [EXH_WHEN_ANY] = SETUP,
        [EXH_WHEN_SLEWED] = SETUP,
        [EXH_WHEN_LIMIT] = SETUP,
        [EXH_WHEN_PERSON] = NEVER,
        [EXH_WHEN_BOUND] = SETUP,
        [EXH_WHEN_WALL] = SETUP,
        [EXH_WHEN_REST] = SETUP,
        [EXH_WHEN_MATERIAL] = SETUP,
        [EXH_WHEN_WORD] = SETUP},
    [EXH_FROM_REGISTER] = {[EXH_WHEN_OUTPUT] = SAME,
        [EXH_WHEN_SETUP] = SETUP,
        [EXH_WHEN_ANY] = ANY,
        [EXH_WHEN_SLEWED] = FALL,
        [EXH_WHEN_LIMIT] = FALL,
        [EXH_WHEN_PERSON] = SAME,
        [EXH_WHEN_BOUND] = FALL,
        [EXH_WHEN_WALL] = RISE,
        [EXH_WHEN_REST] = REST,
        [EXH_WHEN_MATERIAL] = FALL,
        [EXH_WHEN_WORD] = SAME},
    [EXH_FROM_WORLD] = {[EXH_WHEN_OUTPUT] = NEVER,
        [EXH_WHEN_SETUP] = NEVER,
        [EXH_WHEN_ANY] = NEVER,
        [EXH_WHEN_SLEWED] = NEVER,
        [EXH_WHEN_LIMIT] = NEVER,
        [EXH_WHEN_PERSON] = NEVER,
        [EXH_WHEN_BOUND] = NEVER,
        [EXH_WHEN_WALL] = NEVER,
        [EXH_WHEN_REST] = NEVER,
        [EXH_WHEN_MATERIAL] = FALL,
        [EXH_WHEN_WORD] = NEVER},
};

int exh_authority_check(struct exh_authority who, unsigned when, int32_t was, int32_t raw)
{
    const unsigned cell =
        who.source < EXH_SOURCES && when < EXH_WHENS ? may[who.source][when] : NEVER;
    const int calm = !who.locked || (cell >= REST && !who.open);
    const int ok = (cell >= SAME && raw == was) || (cell >= SETUP && calm) ||
                   (cell == FALL && raw < was) || (cell == RISE && raw > was) || cell == ANY;
    return ok ? 0 : -EXH_E_STATE;
}
