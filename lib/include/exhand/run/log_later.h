/* SPDX-License-Identifier: MIT */
/* A log that spreads each keyframe and header over ticks, for a board on which one takes longer
 * than a tick. The state is copied in its tick, and becomes bytes in this tick and those behind it.
 * Records of these wait. So the log has the same bytes in the same order, only later, if no record
 * is lost. What waits is lost if the program stops by an assert or a fault of the processor: the
 * last ticks before it. */
#ifndef EXHAND_RUN_LOG_LATER_H
#define EXHAND_RUN_LOG_LATER_H

#include "exhand/run/log.h"

/* Bytes that one tick makes of a keyframe, and more to the end of a part of it. */
#define EXH_LOG_LATER_B 512u

/* Memory of the caller; it stays in use. A scene whose copy does not fit writes in its tick. */
struct exh_log_later {
    uint8_t *record; /* EXH_LOG_RECORD_B */
    uint8_t *copy;   /* aligned to 8: the scene's memory, then both arrays of parameters */
    uint8_t *held;   /* records of the ticks in between; if full, one tick writes the rest */
    uint32_t copy_B, held_B;
};

/* Call it before exh_log_start(). Not together with exh_log_tap(). */
void exh_log_later(const struct exh_log_later *memory);

#endif
