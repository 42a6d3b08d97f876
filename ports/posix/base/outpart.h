/* SPDX-License-Identifier: MIT */
/* A file in progress. Until it is complete it has the name NAME.part; then it is renamed
 * atomically. So a file with its final name is complete, however the program ends. */
#ifndef CLI_OUTPART_H
#define CLI_OUTPART_H

#define OUTPART_B   2048 /* of a path, its end and .part in it */
#define OUTPART_MAX 16   /* at a time in a process */

struct outpart {
    int fd;               /* for reading, too, if beside */
    int slot;             /* < 0: written in place */
    char path[OUTPART_B]; /* its name, links followed */
};

/* 0 or an errno: EBUSY if another writes this file now, this process or another; EISDIR. What is no
 * regular file, such as a device or a FIFO, is written in place, and so is standard output by
 * another name. A link stays, and its target is written. The mode is that of the file that is
 * there. What a killed writer left is taken over. */
int outpart_open(struct outpart *p, const char *path);

/* To the disk, then to its name, then its folder to the disk. 0 or an errno: nothing of it is left,
 * and what was at the name is there still. The descriptor stays open, and keeps other writers
 * away until it is closed. */
int outpart_commit(struct outpart *p);

/* The same without waiting for the disk, which may take long: it is whole whatever ends the
 * program, but perhaps not after the power has failed. */
int outpart_name(struct outpart *p);

/* Nothing of it is left. Closes it. */
void outpart_abandon(struct outpart *p);

/* Removes all that this process has not committed. A signal's handler may call it; so does exit().
 */
void outpart_remove_all(void);

/* 1 if both names lead to one regular file or FIFO, which may not be there yet. */
int outpart_same(const char *a, const char *b);

#endif
