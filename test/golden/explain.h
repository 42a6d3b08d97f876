/* Explain: where a run and the generator's part. On hosts only; elsewhere nothing. */
#ifndef TEST_GOLDEN_EXPLAIN_H
#define TEST_GOLDEN_EXPLAIN_H

#include "golden.h"

/* The rates that EXH_RATES=lo..hi asks for; as they are without it. */
void golden_rates(uint32_t *lo, uint32_t *hi);

/* Calls the generator and tells the first tick that differs, expected and got. */
void golden_explain(const char *name, golden_run *run, uint32_t rate_Hz);

/* Fails where the run differs from the committed trace. */
void golden_trace(const char *name, golden_run *run, uint32_t rate_Hz);

#endif
