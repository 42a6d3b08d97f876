/* SPDX-License-Identifier: MIT */
/* The drop scene with a passivity controller between law and limits. */
#ifndef EXAMPLES_GUARDED_H
#define EXAMPLES_GUARDED_H

#include "../drop/drop.h"

struct guarded_own_par {
    int32_t rule_on; /* 1: k and b outside the rule of gains are refused */
};

/* Drop's parameters first, so that their names and indices stay; then the additions. */
struct guarded_par {
    struct drop_par drop;
    struct exh_passivity_par passivity;
    struct guarded_own_par own;
    struct exh_gains_par gains; /* used only with rule_on */
};

struct guarded_signals {
    struct drop_signals drop;
    int32_t energy_J_q24;    /* received by the present contact */
    int32_t passivity_N_q20; /* passivity of the ledger, <= 0 */
};

struct guarded_cfg {
    struct drop_cfg drop;
    struct exh_knot held[EXH_CALIB_POINTS_MAX + 2];
    struct exh_passivity_cfg passivity;
};

struct guarded {
    struct drop drop;
    struct exh_passivity passivity;
};

/* Makes the configuration from parameters; calib as for drop_setup(). Returns 0 or -EXH_E_.... With
 * rule_on also errors of exh_gains_setup(), and -EXH_E_GAINS for k and b outside. */
int guarded_setup(struct guarded_cfg *cfg, const struct guarded_par *par,
    struct exh_scene_board board, struct exh_scene_calib *calib);

/* Stages a value of this image's scene, also over a link: as exh_params_stage(), with rule_on as
 * exh_gains_stage() with the rule of set-up. */
int guarded_stage(uint16_t id, uint16_t instance, int32_t raw);

/* One tick. */
void guarded_tick(struct guarded *s, const struct guarded_cfg *cfg, const struct exh_scene_in *in,
    struct exh_drive_out *out, struct guarded_signals *sig);

/* State through a cursor. */
void guarded_bytes(struct exh_bytes *c, struct guarded *s);

/* Memory of the one instance, for tests that damage it. */
struct guarded *guarded_memory(struct guarded_cfg **cfg);

extern const struct exh_scene exh_scene_guarded;

#endif
