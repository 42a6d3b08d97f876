/* SPDX-License-Identifier: MIT */
/* What happened in a log, in the words of a person: commands, states, arming, contacts and limits
 * with their peaks, faults by name, what was missed or lost. */
#ifndef CLI_TIMELINE_H
#define CLI_TIMELINE_H

#include "base/logfile.h"

#include <stdio.h>

/* The whole log, from its first record on. 0, or 1 after a line on stderr (memory). */
int timeline_print(struct logfile *l, FILE *to);

#define TIMELINE_NOTES 65536u

/* timeline_note.c: lines, sorted at the end. If there are more than TIMELINE_NOTES, the older half
 * is printed before, and a note that lasted longer than these comes late. */
struct timeline_notes {
    const struct logfile *log;
    FILE *to; /* NULL: nothing is kept, the fault alone is looked for */
    struct timeline_note {
        uint64_t tick;
        size_t order;
        char text[160];
    } * at;
    size_t n, cap, said;
    int no_memory;
    uint64_t fault_tick; /* the first of them; each line shows its distance if has_fault */
    int has_fault;
};
#ifdef __GNUC__
__attribute__((format(printf, 3, 4)))
#endif
void timeline_say(struct timeline_notes *n, uint64_t tick, const char *format, ...);
/* The line above them all; and what is left, in order of ticks, with times, and frees them. */
void timeline_head(const struct timeline_notes *n);
void timeline_out(struct timeline_notes *n);

/* Something that is on or off in a tick; on again within `gap` ticks is the same. */
struct timeline_span {
    uint64_t begin, last; /* ticks in which it was on */
    uint32_t times, ticks;
    double peak;
    int open;
};
/* 1: it is over, *was holds it. Also to be called with on 0 at the end, gap 0. */
int timeline_span(struct timeline_span *s, int on, uint64_t tick, uint64_t gap, double value,
    struct timeline_span *was);

#endif
