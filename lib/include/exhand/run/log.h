/* SPDX-License-Identifier: MIT */
/* Log: writes all inputs as records (exhand/record.h) to the board's log, so that a run can be
 * replayed bit for bit. Its functions are hooks of the loop. */
#ifndef EXHAND_RUN_LOG_H
#define EXHAND_RUN_LOG_H

#include "exhand/run/scene.h"

#include "exhand/record.h"

/* Ticks between keyframes. A replay may start at each. */
#define EXH_LOG_KEYFRAME_TICKS 1024u
/* Ticks between headers. They are half a keyframe interval after a keyframe, so that no tick writes
 * both. A late reader starts at the keyframe after a header. */
#define EXH_LOG_HEADER_TICKS 4096u
/* Size of the largest record: a header or keyframe with all parameters of a scene. */
#define EXH_LOG_RECORD_B 5120u

void exh_log_start(const struct exh_scene *sc, struct exh_scene_board board);
void exh_log_before(uint32_t tick, struct exh_scene_in *in);
void exh_log_after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out);
/* Marks the coming tick with the operator's value. */
void exh_log_mark(uint32_t tick, int32_t value);
/* Ends the log. Returns the number of records lost, including this one. */
uint32_t exh_log_end(uint32_t tick);

/* A second receiver of the records, before output: the black box; NULL: none. alone: the board's
 * log gets no records. Call it before exh_log_start(). */
struct exh_log_tap {
    void (*take)(uint8_t type, uint32_t tick, const uint8_t *payload, uint32_t len_B);
    int (*due)(void); /* 1: requests a keyframe after this tick */
};
void exh_log_tap(const struct exh_log_tap *tap, int alone);
/* Writes headers and keyframes in later ticks, and the records that come meanwhile after them:
 * exhand/run/log_later.h. NULL: each record is written in its tick. */
struct exh_log_way {
    int (*put)(const void *rec, uint32_t len_B); /* 1: taken */
    /* 1: it will write this record, with this number. */
    int (*begin)(const struct exh_scene *sc, uint8_t type, uint32_t tick, uint32_t seq);
    void (*step)(int all);  /* behind each tick; all: no tick follows */
    uint32_t (*lost)(void); /* records that found no room since the last call */
    int (*waits)(void);     /* 1: a record put now waits for others, and may find no room then */
};
void exh_log_by(const struct exh_log_way *who);

/* The payload of the header with the present parameters. */
void exh_log_header_serialize(struct exh_bytes *c);
/* Number of its last bytes that are calibration images. */
uint32_t exh_log_images_B(void);

/* Payloads, shared with the replay. A restored keyframe passes the parameters' checks, or the
 * cursor fails. Scenes without signals, state or glove log none of these. */
void exh_log_frame_serialize(struct exh_bytes *c, const struct exh_scene *sc,
    struct exh_scene_in *in, struct exh_drive_out *out, int32_t *signal);
void exh_log_keyframe_serialize(struct exh_bytes *c, const struct exh_scene *sc);

#endif
