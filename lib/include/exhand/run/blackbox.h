/* SPDX-License-Identifier: MIT */
/* Black box: the last seconds of a scene's records in memory, to be read out after a fault as a log
 * that `exhand replay` runs again. Hooks for the loop in the place of the log's, which they call: a
 * scene has one by being linked with this file and given memory.
 *
 * It records until a bit of the scene's signal `faults` sets, runs on for EXH_BLACKBOX_AFTER_MS so
 * that the release is in it, and freezes. Faults that come after the first are counted; nothing is
 * recorded over what led to the first. When it was read, or cleared, it begins anew. */
#ifndef EXHAND_RUN_BLACKBOX_H
#define EXHAND_RUN_BLACKBOX_H

#include "exhand/run/log.h"

#define EXH_BLACKBOX_AFTER_MS    50 /* and 8 ticks at least */
#define EXH_BLACKBOX_AFTER_TICKS 8

/* Before the start: the memory, for header and records; NULL: no black box. alone: the board's log
 * gets no records, and in a frozen box a tick makes none. */
void exh_blackbox_memory(void *mem, size_t len_B, int alone);

void exh_blackbox_start(const struct exh_scene *sc, struct exh_scene_board board);
void exh_blackbox_before(uint32_t tick, struct exh_scene_in *in);
void exh_blackbox_after(
    uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out);

/* No tick comes any more. After a fault it freezes as it is; halted: so it does without one. */
void exh_blackbox_stop(int halted);

/* The dump of a frozen box, any bytes a call, at any time between two ticks: header with the
 * parameters of the freeze, records, EXH_EVENT_FROZE, the end with the number of records that found
 * no room. 0: there is nothing, or nothing more. Then the box begins anew. */
uint32_t exh_blackbox_read(uint8_t *to, uint32_t cap_B);
/* Bytes to the end of the record that was last read from: where words may stand on the same line.
 */
uint32_t exh_blackbox_rest(void);
void exh_blackbox_clear(void);

enum exh_blackbox_state {
    EXH_BLACKBOX_OFF, /* no memory, too little to hold a fault, or a scene without keyframes */
    EXH_BLACKBOX_RECORDS,
    EXH_BLACKBOX_RUNS_ON,
    EXH_BLACKBOX_FROZEN
};
struct exh_blackbox_is {
    enum exh_blackbox_state state;
    uint32_t cause;  /* enum exh_fault; 0: halted */
    uint32_t tick;   /* of the fault, or the last */
    uint32_t later;  /* causes since */
    uint32_t held_B; /* what a dump has to say, about */
};
struct exh_blackbox_is exh_blackbox_is(void);

#endif
