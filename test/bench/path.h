/* The drop scene's configuration at 2 kHz with gains that are no powers of two, and a
 * movement through its wall: what the force path and the ticks are fed with. */
#ifndef BENCH_PATH_H
#define BENCH_PATH_H

#include "bench.h"

#include "drop/drop.h"

#define PATH_HEALTHY (EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_DRIVE0)

extern struct drop_par path_par;
extern struct drop_cfg path_cfg;

/* Sets both, and seeds the generator. */
void path_setup(void);

/* Counts of a throw: 70 mm out and back in 1024 ticks, i any. */
int32_t path_cnt(uint32_t i);
/* The same as inputs of the law, the velocity exact and rounded to its format. */
struct exh_contact_in path_in(uint32_t i);

/* Exact values of the configuration. */
long double path_step_m(const struct exh_quad_par *p);

#endif
