/* SPDX-License-Identifier: MIT */
/* Scene: the descriptor that the loop, the log and the replay use.
 *
 * A scene is a pure tick function over the library's modules. The descriptor points to its one
 * static instance, so no allocation is needed. Optional parts are NULL and then not linked. */
#ifndef EXHAND_RUN_SCENE_H
#define EXHAND_RUN_SCENE_H

#include "exhand/bytes.h"
#include "exhand/frame.h"
#include "exhand/glove.h"
#include "exhand/params.h"
#include "exhand/safety.h"
#include "exhand/signal.h"

#include <stdint.h>

struct exh_scene_in {
    struct exh_drive_in drive;
    uint32_t missed; /* ticks missed before this one */
    uint8_t command; /* enum exh_command */
    /* Only in scenes with a glove: */
    uint8_t glove_new;         /* 1: a new frame; 0: the previous one, older by a tick */
    struct exh_glove_in glove; /* its age counts from its conversion */
};

/* Packets of one tick, in or out. More wait for the next tick: 720 per second at 90 Hz. */
#define EXH_SCENE_PACKETS  8
#define EXH_SCENE_PACKET_B 256
struct exh_scene_mail {
    uint8_t packets;
    uint16_t len_B[EXH_SCENE_PACKETS];
    uint8_t byte[EXH_SCENE_PACKETS][EXH_SCENE_PACKET_B];
};

/* The link of a scene. A link that is down does not stop the scene. */
struct exh_scene_link {
    int (*recv)(void *buf, size_t cap_B);       /* exh_board_link_recv */
    int (*send)(const void *buf, size_t len_B); /* exh_board_link_send */
    struct exh_scene_mail *in;                  /* set by the loop before a tick, and logged */
    struct exh_scene_mail *out;                 /* packets to send, set by: */
    void (*write)(void); /* after the outputs, so that it does not delay them */
};

/* Properties of the board for set-up. */
struct exh_scene_board {
    struct exh_period T; /* the programmed period of its timer */
    uint8_t enc_bits;    /* width of its counters */
};

/* Calibrations of fingers as images (exhand/calibrate.h), at most one per finger, in any order. The
 * caller provides them before set-up. The bytes must not change: a log's header has them. */
struct exh_scene_calib {
    struct {
        const uint8_t *byte;
        uint32_t len_B;
    } image[EXH_FINGERS];
    uint8_t images;
    /* Why the last set-up refused an image: 0 (none refused) or -EXH_E_...; its index; the point
     * that does not fit a table; the reason as text. */
    int refused;
    uint8_t image_at, point_at;
    const char *what;
    /* Ratio of force and current that is too far from the expected one, N/A, and its finger.
     * expected is 0 otherwise. The limit is half of it. */
    int32_t ratio_NpA_q20, expected_NpA_q20;
    uint8_t finger;
};

struct exh_scene {
    const char *name; /* at most 15 characters */
    uint32_t rate_Hz; /* default rate */
    uint8_t fingers;
    struct exh_params *params;              /* NULL: constants in ROM */
    const struct exh_signal_table *signals; /* outputs per tick, or NULL */
    int32_t *values;                        /* their values, or NULL; use exh_scene_signals() */
    /* exh_board_read_glove, or NULL. Only a scene that names it links it. */
    int (*read_glove)(struct exh_glove_in *in);
    const int32_t *glove_every;        /* ticks between requests for a frame; NULL: every tick */
    const struct exh_scene_link *link; /* or NULL */

    /* Sets parameters to their defaults and unlocks them; NULL without parameters. Call it before
     * staging and before the loop. */
    void (*defaults)(void);
    /* Makes the configuration from the parameters and sets the power-on state. 0 or -EXH_E_.... */
    int (*setup)(struct exh_scene_board board);
    /* One tick. */
    void (*tick)(const struct exh_scene_in *in, struct exh_drive_out *out);
    /* Computes signals that depend only on the state after a tick. NULL: the tick computes all. */
    void (*show)(void);
    /* Writes text through exh_board_log after the outputs, without delaying them; or NULL. */
    void (*tell)(void);
    /* The whole state through a cursor; NULL: not replayable. */
    void (*state)(struct exh_bytes *c);
    /* The state of the device, for hooks that command it; or NULL. */
    const struct exh_safety *safety;
    /* Where the caller puts calibrations before set-up; NULL: takes none. */
    struct exh_scene_calib *calib;
    /* Checks whether all staged values may be applied together: 0 or -EXH_E_.... After an error,
     * the sender withdraws them. NULL: the rows' ranges suffice. */
    int (*allowed)(void);
    /* For a scene with an external controller (custom), in a replay: the controller's answer in the
     * coming tick, from the logged signals; the controller is not called. NULL: inputs and state
     * determine all. */
    void (*answered)(const int32_t *signal);
    /* Called after the loop, when the outputs are safe; or NULL. */
    void (*end)(void);
    /* exh_params_apply with params, else NULL. Only a scene that names it links it. */
    int (*apply)(struct exh_params *params);
    /* For exhand/run/log_later.h: all that state() reads, and the same bytes in parts, from a copy
     * of it. Or zeros. */
    struct {
        void *memory;
        uint32_t memory_B;
        unsigned parts;
        void (*part)(struct exh_bytes *c, void *copy, unsigned part);
    } later;
};

/* The signals of the last tick, valid until the next; NULL: none. Call it in that tick. */
static inline int32_t *exh_scene_signals(const struct exh_scene *sc)
{
    if (sc->show) { sc->show(); }
    return sc->values;
}

#endif
