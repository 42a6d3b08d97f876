/* SPDX-License-Identifier: MIT */
/* Log: everything that crosses inward, as records (exhand/record.h) to the board's
 * log, so that a run can be replayed bit for bit. Hooks for the loop. */
#ifndef EXHAND_RUN_LOG_H
#define EXHAND_RUN_LOG_H

#include "exhand/run/scene.h"

#include "exhand/record.h"

/* Ticks between keyframes: a replay may start at each. */
#define EXH_LOG_KEYFRAME_TICKS 1024u
/* Ticks between headers, half of a keyframe's behind one, so that no tick has both: who comes late
 * reads from the keyframe behind it. */
#define EXH_LOG_HEADER_TICKS 4096u
/* The largest record: header or keyframe with all parameters of a scene. */
#define EXH_LOG_RECORD_B 5120u

void exh_log_start(const struct exh_scene *sc, struct exh_scene_board board);
void exh_log_before(uint32_t tick, struct exh_scene_in *in);
void exh_log_after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out);
/* The operator's own mark at the coming tick. */
void exh_log_mark(uint32_t tick, int32_t value);
/* Ends the log and tells how many records it lost, this last one included. */
uint32_t exh_log_end(uint32_t tick);

/* Whoever else takes the records, before their bytes go out: the black box. NULL: nobody. alone:
 * the board's log gets none. To be called before exh_log_start(). */
struct exh_log_tap {
    void (*take)(uint8_t type, uint32_t tick, const uint8_t *payload, uint32_t len_B);
    int (*due)(void); /* 1: it wants a keyframe behind this tick */
};
void exh_log_tap(const struct exh_log_tap *tap, int alone);
/* The header's payload with the parameters as they are now. */
void exh_log_header_serialize(struct exh_bytes *c);
/* How many of its bytes, the last, are calibrations of fingers. */
uint32_t exh_log_images_B(void);

/* Payloads, shared with the replay: what is written is what is read. A keyframe that
 * is read goes through the parameters' own checks; one that fails them is not ok.
 * A scene without signals, state or glove logs none. */
void exh_log_frame_serialize(struct exh_bytes *c, const struct exh_scene *sc,
    struct exh_scene_in *in, struct exh_drive_out *out, int32_t *signal);
void exh_log_keyframe_serialize(struct exh_bytes *c, const struct exh_scene *sc);

#endif
