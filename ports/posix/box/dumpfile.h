/* SPDX-License-Identifier: MIT */
/* The black box of a run on this machine: its memory, and a file for each dump. */
#ifndef CLI_DUMPFILE_H
#define CLI_DUMPFILE_H

#include "exhand/run/blackbox.h"

#include <stddef.h>

#define DUMPFILE_B      (4u << 20) /* of memory */
#define DUMPFILE_PATH_B 1024

/* Before the loop. Dumps go to path, path.2 and so on; NULL: there is no black box. logged: records
 * also go to the board's log. len_B 0: DUMPFILE_B. 0, or 1 after a line on stderr. */
int dumpfile_open(const char *path, int logged, size_t len_B);

/* Before that: on: no tick writes a dump. It goes piece by piece a tick to a thread that writes it,
 * and what its file does not take yet stays in the frozen box. One loop a process, then: the thread
 * of a file that never takes it remains. */
void dumpfile_paced(int on);

/* Hooks, the log's among them. */
void dumpfile_start(const struct exh_scene *sc, struct exh_scene_board board);
void dumpfile_before(uint32_t tick, struct exh_scene_in *in);
void dumpfile_after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out);

/* Call it after the loop. halted: it ended by an error. Returns the number of dumps written, each
 * reported by a line on stderr; -1 if one failed. */
int dumpfile_close(int halted);

#endif
