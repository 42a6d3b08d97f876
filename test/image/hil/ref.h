/* SPDX-License-Identifier: MIT */
/* The reference: the same scene on the POSIX port, in a separate process, tick by tick. */
#ifndef HIL_REF_H
#define HIL_REF_H

#include "posix.h"
#include "exhand/run/scene.h"

#define REF_SETTINGS 32
#define REF_SIGNALS  256

struct ref_setting {
    const char *name;
    double value;
};

struct ref_cfg {
    const struct exh_scene *scene;
    struct posix_config board; /* T, seed, device, hand */
    struct ref_setting setting[REF_SETTINGS];
    int settings;
    int (*prepare)(void); /* stages what is no setting: 0 or -EXH_E_...; NULL: nothing is */
    double held_s;        /* from then on the dead-man switch is held */
    uint16_t glove_age;   /* of frames as the cards hand them over, ticks */
    int turns;            /* monitors and supply of the tick before, one a board, in turn */
    int glove_last;       /* a frame is of the tick in which the one before was handed over */
    int monitor_age;      /* of monitors and supply, in ticks, 0 or 1 */
};

/* One tick: what went in and came out, */
struct ref_tick {
    struct exh_drive_in in;
    struct exh_drive_out out;
    uint32_t missed;
    uint8_t command, glove_new;
    struct exh_glove_in glove;
};
/* and all that the scene says of it. */
struct ref_frame {
    struct ref_tick tick;
    int32_t signal[REF_SIGNALS];
    struct exh_scene_mail mail_in, mail_out; /* of a scene with a link */
};

/* The dead-man switch in a tick. */
int ref_held(const struct ref_cfg *c, uint64_t tick);

/* All of them, into the scene's own: 0 or -EXH_E_.... */
int ref_parameters(const struct ref_cfg *c);
/* Its settings for an image's command line; exact. */
void ref_options(const struct ref_cfg *c, char *text, size_t cap_B);

struct ref;
struct ref *ref_start(const struct ref_cfg *c);
/* The next tick's: 1; 0: it has ended. */
int ref_next(struct ref *r, struct ref_frame *f);
void ref_stop(struct ref *r);

#endif
