/* SPDX-License-Identifier: MIT */
/* Region: the gains that the stability advisor allows at one rate, on one device or on all of some.
 *
 * Rows over b. In each k is raised from weak to stiff; at a pair the mass has to come to rest in so
 * many cases (sim/settle.h), which deal the devices in turn. Allowed is what hangs together from
 * weak up: nothing beyond a pair that does not hold, whatever rests there. */
#ifndef CLI_REGION_H
#define CLI_REGION_H

#include "sim/settle.h"

#define REGION_ROWS    40 /* steps of b, a multiple of 4 */
#define REGION_DEVICES 24

struct region_opt {
    struct sim_device device[REGION_DEVICES]; /* the first is the given one */
    int devices;
    struct settle_wall wall; /* k and b are not looked at */
    int cases;               /* a pair */
    double margin;           /* every second case with so much (a share) less friction */
    double inwards; /* by this share of k, and of its width in b, a rule ends inside of what is
                       proved */
    int at_phase;   /* 1: the wall lies `phase` counts above a count; 0: anywhere */
    double phase;
    int jobs;
};

struct region_row {
    double b_Nspm, low_Npm, high_Npm; /* k allowed from and to; 0: none */
};

struct region {
    struct region_opt o;
    struct region_row row[REGION_ROWS + 1]; /* equal steps of b, from 0 */
};

/* 0; 1 after a line on stderr: nothing holds; or interrupted (130). */
int region_fill(struct region *r, const struct region_opt *o);

/* How a pair fares in all cases of a row's end. */
struct region_pair {
    int falls, rest;
    struct settle_case at; /* the first that does not rest */
    int device;            /* and of which device */
};
struct region_pair region_try(const struct region_opt *o, double k_Npm, double b_Nspm);

/* Whether a pair holds in as many cases, of another draw than the rows' (draw > REGION_ROWS). */
int region_holds(const struct region_opt *o, double k_Npm, double b_Nspm, int draw);

/* mu > (pi/2) w (T/2 + delay + lag - (b + c)/k), w = sqrt(k / (mass + rotor)). Friction in
 * proportion to the tension removes energy from a bounce; hold and delay add energy. */
int region_energy(const struct region_opt *o, double k_Npm, double b_Nspm);

#endif
