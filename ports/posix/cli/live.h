/* exhand run: what its parts share. */
#ifndef CLI_LIVE_H
#define CLI_LIVE_H

#include "loop.h"

#include "exhand/drive.h"

/* live_person.c. Who holds the dead-man switch of the simulated box: takes hold of it a tenth of a
 * second after the start, and lets go when asked; nobody, where --gpio has a real one. */
struct live_person {
    int again; /* lets go and takes hold anew while the box is in OFF or FAULT; else once */
    double let_go_s; /* 0: never                                                */
    unsigned finger; /* whose values are shown                                  */
};
void live_person(const struct live_person *is);
void live_wires(struct exh_drive_in *in); /* posix_config.wires_in                */

/* Hooks: the grip's command, and a line of status on a terminal. */
void live_person_start(const struct exh_scene *sc, struct exh_scene_board board);
void live_person_before(uint32_t tick, struct exh_scene_in *in);
void live_person_after(uint32_t tick, const struct exh_scene_in *in,
                       const struct exh_drive_out *out);
/* What became of it, on standard output. */
void live_person_end(void);

#endif
