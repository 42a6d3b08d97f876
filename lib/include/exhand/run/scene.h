/* SPDX-License-Identifier: MIT */
/* Scene: what the loop, the log and the replay need to know of one.
 *
 * A scene is a pure tick over the library's modules; this descriptor points to
 * its one static instance, so that an image needs no allocation. Optional parts
 * are NULL: a scene without parameters links no parameter code.
 */
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
    /* Of scenes with a glove alone: */
    uint8_t glove_new;         /* 1: a new frame, 0: the one before, older by a tick */
    struct exh_glove_in glove; /* its age counts from its conversion */
};

/* Packets of one tick, in or out. What comes in excess of that waits for the next tick: at 90 Hz
 * these are 720 a second. */
#define EXH_SCENE_PACKETS  8
#define EXH_SCENE_PACKET_B 256
struct exh_scene_mail {
    uint8_t packets;
    uint16_t len_B[EXH_SCENE_PACKETS];
    uint8_t byte[EXH_SCENE_PACKETS][EXH_SCENE_PACKET_B];
};

/* The link of a scene that has one. A link that is down is no reason to stop. */
struct exh_scene_link {
    int (*recv)(void *buf, size_t cap_B);       /* exh_board_link_recv */
    int (*send)(const void *buf, size_t len_B); /* exh_board_link_send */
    struct exh_scene_mail *in;  /* before a tick, by the loop: logged, as all that crosses inward */
    struct exh_scene_mail *out; /* what is to be sent, by: */
    void (*write)(void);        /* behind the outputs, where it delays none of them */
};

/* What set-up has to know of the board it runs on. */
struct exh_scene_board {
    struct exh_period T; /* what its timer was programmed to */
    uint8_t enc_bits;    /* width of its counters */
};

/* Calibrations of fingers as images (exhand/calibrate.h), from whoever sets the scene up, before
 * that: one a finger, in any order. Their bytes stay where they are and as they are: a log's header
 * has them. */
struct exh_scene_calib {
    struct {
        const uint8_t *byte;
        uint32_t len_B;
    } image[EXH_FINGERS];
    uint8_t images;
    /* Why the last set-up refused one: 0 it did not, or -EXH_E_…; which, from 0; of what a table
     * does not hold, the point; a name for people. */
    int refused;
    uint8_t image_at, point_at;
    const char *what;
    /* Where its force over current is too far from what is expected: both, N/A, and whose. Else
     * expected is 0. Allowed is within half of it. */
    int32_t ratio_NpA_q20, expected_NpA_q20;
    uint8_t finger;
};

struct exh_scene {
    const char *name; /* at most 15 characters */
    uint32_t rate_Hz; /* when nobody asks for another */
    uint8_t fingers;
    struct exh_params *params;              /* NULL: constants in ROM */
    const struct exh_signal_table *signals; /* outputs per tick, or NULL */
    int32_t *values;                        /* theirs, or NULL: exh_scene_signals() reads them */
    /* exh_board_read_glove, or NULL: only a scene that names it links it. */
    int (*read_glove)(struct exh_glove_in *in);
    const int32_t *glove_every;        /* asks for a frame every so many ticks; NULL: every tick */
    const struct exh_scene_link *link; /* or NULL */

    /* Parameters to their defaults and unlocked; NULL without parameters. Before
     * staging any and before the loop. */
    void (*defaults)(void);
    /* Parameters into configuration, state to power-on. 0 or -EXH_E…. */
    int (*setup)(struct exh_scene_board board);
    /* One tick. */
    void (*tick)(const struct exh_scene_in *in, struct exh_drive_out *out);
    /* Fills in the signals that are of the state a tick left and nothing else: no tick pays for
     * them that nobody reads. NULL: a tick fills in all. */
    void (*show)(void);
    /* Words for people through exh_board_log, behind the outputs, where it delays none of them; or
     * NULL. */
    void (*tell)(void);
    /* The whole state through a cursor; NULL: not replayable. */
    void (*state)(struct exh_bytes *c);
    /* The state of the box, for whoever commands it; or NULL. */
    const struct exh_safety *safety;
    /* Where calibrations are put before set-up; or NULL: it takes none. */
    struct exh_scene_calib *calib;
    /* May all that is staged be applied together: 0, or -EXH_E… by a rule of the scene, and whoever
     * staged it takes it back. NULL: the rows' ranges are enough. */
    int (*allowed)(void);
    /* Of a scene that asks what is not ours (custom): its answer in the coming tick is the one in
     * these signals, as a log has them; it is not asked. NULL: all that decides is in inputs and
     * state. */
    void (*answered)(const int32_t *signal);
    /* The loop has ended and the outputs are safe. Or NULL. */
    void (*end)(void);
    /* exh_params_apply with params, else NULL: only a scene that names it links it. */
    int (*apply)(struct exh_params *params);
};

/* The signals of the newest tick, until the next; NULL: it has none. Whoever reads some of them
 * asks here in that tick, and nowhere else. */
static inline int32_t *exh_scene_signals(const struct exh_scene *sc)
{
    if (sc->show) { sc->show(); }
    return sc->values;
}

#endif
