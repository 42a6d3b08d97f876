/* SPDX-License-Identifier: MIT */
/* exhand run: what its parts share. */
#ifndef CLI_LIVE_H
#define CLI_LIVE_H

#include "box/hand_options.h"
#include "box/hand_record.h"
#include "box/contacts.h"
#include "exhand/run/loop.h"
#include "box/run.h"

#include "exhand/frame.h"

#include <stdint.h>
#include <stdio.h>

#define LIVE_SETTINGS_MAX 64

/* --log-size and --log-keep. */
struct live_log_size {
    uint64_t B;   /* of a file, about; 0: one file without end */
    int64_t keep; /* old ones that stay; < 0: all */
};

struct live_options {
    const char *scene, *params, *log, *blackbox, *modbus, *save, *glove, *glove_image, *udp,
        *record;
    struct live_log_size log_size;
    const char *fingers, *speed; /* as they were given; NULL: they were not */
    double rate_Hz, seconds, let_go_s;
    double slack_s; /* < 0: not given */
    double record_Hz;
    int64_t seed;
    int pace, grip, list, remote, write;
    struct contacts gpio;
    const char *set[LIVE_SETTINGS_MAX];
    int sets;
    struct run_setting setting[LIVE_SETTINGS_MAX];
    struct bilateral_options hand;
    struct run_live live;
    struct hand_record recorded; /* of --record */
    struct glove_tty tty;        /* of --glove-serial, while it runs */
    struct exh_glove_cal glove_cal;
};

/* live_box.c. The parameters that its box begins with, staged: 0, or -EXH_E_... after a line on
 * stderr. */
int live_stage(struct live_options *o, const struct exh_scene *sc);
/* The box of this scene, until it ends: 0, or the -EXH_E... of board or scene. */
int live_box(struct live_options *o, const struct exh_scene *sc);
/* What was felt, of --udp and --record; an exit status: 1 if nothing was and no world was heard. */
int live_box_felt(const struct live_options *o);
/* What a client's thread could not do: an exit status; 0: nothing. */
int live_box_clients(void);

/* live_person.c. The person at the dead-man switch of the simulated box. Closes it a tenth of a
 * second after the start and opens it on request. Not used if --gpio has a real switch. */
struct live_person {
    int again;       /* opens and closes it again in OFF or FAULT; else once */
    double let_go_s; /* 0: never */
};
void live_person(const struct live_person *is);
void live_wires(struct exh_drive_in *in); /* posix_config.wires_in */
/* Hooks: the grip's command. */
void live_person_start(const struct exh_scene *sc, struct exh_scene_board board);
void live_person_before(uint32_t tick, struct exh_scene_in *in);

/* live_status.c. A line of status on a terminal, which no tick waits for; and what became of it, on
 * standard output. finger: whose values are shown. */
void live_status(unsigned finger);
void live_status_start(const struct exh_scene *sc, struct exh_scene_board board);
void live_status_after(uint32_t tick, const struct exh_scene_in *in);
void live_status_end(void);

/* live_log.c. --log: paced, no tick waits for it either: what finds no room is lost and counted.
 * An exit status, after a line on stderr; 0: fine, also without a path.
 */
int live_log_open(const char *path, int paced, const struct live_log_size *size);
FILE *live_log_file(void);                       /* NULL: none */
int live_log_put(const void *rec, size_t len_B); /* posix_config.log_put */
uint64_t live_log_lost(void);                    /* records */
int live_log_close(void);

#endif
