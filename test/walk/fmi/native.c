/* SPDX-License-Identifier: MIT */
/* The run that FMUs must repeat, as text: native RATE_HZ FALLS SEED: loop, board and scene drop as
 * they are shipped.
 *
 *   param NAME RAW FRAC      each parameter as set-up took it
 *   columns NAME:FRAC ...    what a tick's line has
 *   NUMBER ...               a tick, raw: what it read, what it wrote, its signals */
#include "box/table2.h"
#include "posix.h"

#include "drop/drop.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    const struct exh_params *p = sc->params;
    (void)board;
    for (uint32_t i = 0; i < p->count; i++) {
        const struct exh_signal *row = exh_signal_at(p->table, i, NULL);
        printf("param %s %ld %d\n", row->name, (long)p->active[i], row->frac);
    }
    printf("columns enc_raw:0 mon_raw:0 supply_raw:0 din:0 missed:0 command:0 dac_raw:0 enable:0 "
           "alive:0");
    for (uint32_t i = 0; i < exh_signal_count(sc->signals); i++) {
        const struct exh_signal *row = exh_signal_at(sc->signals, i, NULL);
        printf(" %s:%d", row->name, row->frac);
    }
    printf("\n");
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    (void)tick;
    (void)in;
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const struct exh_scene *sc = &exh_scene_drop;
    (void)tick;
    printf("%lu %d %d %lu %lu %d %u %u %u", (unsigned long)in->drive.enc_raw[0],
        in->drive.mon_raw[0], in->drive.supply_raw, (unsigned long)in->drive.din,
        (unsigned long)in->missed, in->command, out->dac_raw[0], out->enable, out->alive);
    for (uint32_t i = 0; i < exh_signal_count(sc->signals); i++) {
        printf(" %ld", (long)exh_scene_signals(sc)[i]);
    }
    printf("\n");
}

int main(int argc, char **argv)
{
    static const struct exh_loop_hooks hooks = {start, before, after};
    const struct table2_row *g;
    struct run_cfg c;
    struct run r;
    if (argc != 4) {
        fprintf(stderr, "usage: native RATE_HZ FALLS SEED\n");
        return 2;
    }
    memset(&c, 0, sizeof c);
    g = table2_gains(atof(argv[1]));
    c.rate_Hz = (uint32_t)atol(argv[1]);
    c.k_Npm = g->k_Npm;
    c.b_Nspm = g->b_Nspm;
    c.more = &hooks;
    c.wall = RUN_WALL_DRAWN; /* as exhand drop has it */
    c.board = posix_config_default();
    c.board.falls = atoi(argv[2]);
    c.board.seed = (uint64_t)atol(argv[3]);
    return run_drop(&c, &r) < 0;
}
