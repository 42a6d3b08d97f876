/* SPDX-License-Identifier: MIT */
/* What a run of examples/identify saw, tick by tick: from the run itself or from its log. */
#ifndef IDENTIFY_DATA_H
#define IDENTIFY_DATA_H

#include "identify/identify.h"

#include <stddef.h>
#include <stdint.h>

struct identify_sample {
    int32_t cnt;   /* from the first, string out is positive */
    float coded_A; /* put out in this tick */
    float mon_A;   /* read in this tick */
    uint8_t part;  /* that goes on behind this tick */
    uint8_t stage;
    uint8_t busy; /* a stage goes on */
    uint8_t repeat;
};

struct identify_data {
    struct identify_sample *sample;
    size_t n, cap;
    double T_s;
    double mass_kg; /* as given to the scene */
    double step_m;  /* as given to the scene; affects its limits only */
    double servo_Hz;
    struct identify_par par; /* of the scene */
    unsigned result;         /* enum identify_result: how the run ended */
    int no_memory;
    int32_t first_cnt;
};

void identify_data_free(struct identify_data *d);

/* The scene's parameters as they are now. */
void identify_data_begin(struct identify_data *d, struct exh_period T);
/* A tick has ended, of the scene's one instance. */
void identify_data_tick(struct identify_data *d);

/* A log. 0; 2 after a line on stderr. */
int identify_data_log(struct identify_data *d, const char *path);

#endif
