/* SPDX-License-Identifier: MIT */
/* Black box: keeps the last seconds of a scene's records in memory. After a fault they can be read
 * as a log that `exhand replay` replays. Its functions replace the hooks of the log and call them.
 * To add it, link this file and give it memory.
 *
 * It records until a bit of the scene's signal `faults` sets. Then it continues for
 * EXH_BLACKBOX_AFTER_MS, to include the release, and freezes. Later faults are counted, but do not
 * overwrite the records. After it has been read or cleared, it starts again. */
#ifndef EXHAND_RUN_BLACKBOX_H
#define EXHAND_RUN_BLACKBOX_H

#include "exhand/run/log.h"

#define EXH_BLACKBOX_AFTER_MS    50 /* at least 8 ticks */
#define EXH_BLACKBOX_AFTER_TICKS 8

/* Gives it memory for header and records, before the start; NULL: no black box. alone: the board's
 * log gets no records, and a frozen black box costs no time. */
void exh_blackbox_memory(void *mem, size_t len_B, int alone);

void exh_blackbox_start(const struct exh_scene *sc, struct exh_scene_board board);
void exh_blackbox_before(uint32_t tick, struct exh_scene_in *in);
void exh_blackbox_after(
    uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out);

/* Call it after the last tick. It freezes after a fault, or if halted is 1. */
void exh_blackbox_stop(int halted);

/* Reads the dump of a frozen box, any number of bytes per call, between any two ticks. The dump
 * contains the header with the parameters of the freeze, records, EXH_EVENT_FROZE, and the number
 * of lost records. Returns 0 if there is nothing more; then the box starts again. */
uint32_t exh_blackbox_read(uint8_t *to, uint32_t cap_B);
/* Bytes to the end of the record being read. After them, text may follow on the same line. */
uint32_t exh_blackbox_rest(void);
void exh_blackbox_clear(void);

enum exh_blackbox_state {
    EXH_BLACKBOX_OFF, /* no memory, too little memory, or a scene without keyframes */
    EXH_BLACKBOX_RECORDS,
    EXH_BLACKBOX_RUNS_ON,
    EXH_BLACKBOX_FROZEN
};
struct exh_blackbox_is {
    enum exh_blackbox_state state;
    uint32_t cause;  /* enum exh_fault; 0: halted */
    uint32_t tick;   /* of the fault, or the last tick */
    uint32_t later;  /* causes after the first */
    uint32_t held_B; /* approximate size of a dump */
};
struct exh_blackbox_is exh_blackbox_is(void);

#endif
