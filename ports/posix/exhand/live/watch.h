/* SPDX-License-Identifier: MIT */
/* exhand watch: what its parts share. */
#ifndef CLI_WATCH_H
#define CLI_WATCH_H

#include "exhand/run/scene.h"

#include "exhand/regs.h"

#include <stdio.h>

#define WATCH_SIGNALS 40 /* chosen, at most */
#define WATCH_NAME_B  48

/* The box as it was last heard of. */
struct watch_box {
    const struct exh_scene *scene; /* NULL: not known yet */
    struct exh_period T;
    int32_t value[EXH_REGS_VALUES]; /* of the scene's table */
    uint32_t tick;
    uint8_t state;
    uint32_t faults, present, limits;
    uint64_t lost;       /* samples that were not heard, where they are numbered */
    uint64_t mixed;      /* times that what was heard is of more than one tick */
    uint32_t breaks;     /* of the link, since something was heard */
    uint64_t heard;      /* samples */
    double heard_s;      /* when the tick was last another one, by until_now_s() */
    double since_s;      /* when watching began */
    const char *trouble; /* of the link at present; NULL */
    int ended;           /* the box has said so */
    int all_values;      /* else only from..to are requested over Modbus */
    uint32_t from, to;
    uint32_t every;                    /* of Modbus: a trace of every so many ticks; 0: none */
    uint32_t index[EXH_TRACE_SIGNALS]; /* and of what */
};

/* Something was heard: the values are of b->tick. 0, or a status after a line on stderr. */
typedef int (*watch_fresh)(struct watch_box *b);

/* The table's CRC and count are the scene's of that name here: b->scene is set; 0, or 1 after a
 * line on stderr. */
int watch_scene(struct watch_box *b, const char *name, uint32_t crc, uint32_t count);

/* --- sources: open, then look until it is over; 0, or a status after a line on stderr --- */

/* Opens a log that arrives at ADDRESS:PORT, from this peer only. NULL: from the first peer that
 * sends a header. Receives until the header has come. */
int watch_stream_open(const char *at, const char *peer, const char *key);
int watch_stream_look(struct watch_box *b, double until_s, watch_fresh fresh);
void watch_stream_close(void);

/* Opens registers at tcp:ADDRESS:PORT or rtu:DEVICE:BAUD and reads them once. *b holds the selected
 * ones after the first sample. */
int watch_modbus_open(const char *where);
int watch_modbus_look(struct watch_box *b, watch_fresh fresh);
void watch_modbus_close(void);

/* --- signals chosen --- */

struct watch_pick {
    uint32_t n, index[WATCH_SIGNALS];
};

/* From "a,b[2],c", or NULL: the paper's. A name of each finger, without [i], is of this one. 0, or
 * 2 after a line on stderr. */
int watch_pick(
    struct watch_pick *p, const struct exh_signal_table *t, const char *names, unsigned finger);
/* "q" or "q[1]"; the row. */
const struct exh_signal *watch_name(
    char to[WATCH_NAME_B], const struct exh_signal_table *t, uint32_t i);

/* --- showing --- */

void watch_view_sample(const struct watch_box *b, const struct watch_pick *p);
/* Draws the view again, in place; tty 0: one line per sample. */
void watch_view_draw(const struct watch_box *b, const struct watch_pick *p, const char *source);
void watch_view_line(const struct watch_box *b, const struct watch_pick *p);
void watch_view_end(void);
double watch_age_s(const struct watch_box *b); /* of what is shown */

/* The last seconds, drawn by gnuplot. 0, or a status after a line on stderr. */
int watch_plot_open(const char *png, double last_s);
int watch_plot_sample(const struct watch_box *b, const struct watch_pick *p);
int watch_plot_draw(const struct watch_box *b, const struct watch_pick *p);

#endif
