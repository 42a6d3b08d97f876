/* SPDX-License-Identifier: MIT */
/* Region: the gains that the stability advisor allows at one rate on one device.
 *
 * A lattice of nodes over k and b. A node holds if in each of so many cases (sim/settle.h) the mass
 * comes to rest; what lies between four nodes that hold is allowed. So nothing is allowed that was
 * not looked at from all sides, and no border is drawn between nodes. */
#ifndef CLI_REGION_H
#define CLI_REGION_H

#include "sim/settle.h"

#define REGION_MAX 200 /* pieces along k, along b */

struct region_opt {
    struct sim_device device;
    struct settle_wall wall; /* k and b are not looked at */
    int columns, rows;       /* pieces along k and b */
    int cases;               /* a node, and of each variant of the device */
    double margin;           /* every second case with so much (a share) less friction */
    double off; /* 0: the device as told; else also with masses so much more and less and with so
                      much less friction */
    int jobs;
};

struct region {
    struct region_opt o;
    double k_top_Npm, b_top_Nspm; /* whole columns and rows from here on hold nowhere */
    int hint;                     /* the case that failed last */
    signed char *node;            /* 1 holds, 0 does not, -1 not looked at */
};

/* Finds how far it reaches. 0; 1 after a line on stderr: nothing holds, out of memory, or
 * interrupted (130). Free it in any case. */
int region_open(struct region *r, const struct region_opt *o);
void region_free(struct region *r);

/* Looks at all nodes, over the processes asked for. 0, 1 or 130. */
int region_fill(struct region *r);

/* Of node i along k, j along b. The first k is a quarter of a step. */
double region_k(const struct region *r, int i);
double region_b(const struct region *r, int j);

/* Whether the piece above and right of node i, j is allowed; nodes are looked at as needed. */
int region_piece(struct region *r, int i, int j);

/* The piece that a pair lies in, at an edge the lower one. 0: none has it. */
int region_find(const struct region *r, double k_Npm, double b_Nspm, int *i, int *j);

/* Whether all pieces are allowed that a pair lies in or on the edge of. */
int region_allows(struct region *r, double k_Npm, double b_Nspm);

/* mu > (pi/2) w (T/2 + delay + lag - (b + c)/k), w = sqrt(k / (mass + rotor)): what friction in
 * proportion to the tension takes out of a bounce, against what hold and delay put in. */
int region_energy(const struct region_opt *o, double k_Npm, double b_Nspm);

#endif
