/* Explain: where a run and the generator's part. On hosts only; elsewhere nothing. */
#ifndef TEST_GOLDEN_EXPLAIN_H
#define TEST_GOLDEN_EXPLAIN_H

#include "golden.h"

/* The rates that EXH_RATES=lo..hi asks for; as they are without it. */
void golden_rates(uint32_t *lo, uint32_t *hi);

/* 1 if EXH_EXPLAIN=0: count, and tell nothing. */
int golden_quiet(void);

/* Calls the generator for a run whose digest is wrong, and returns what to say of it: the
 * first tick that differs, expected and got. Never NULL; good until the next call. */
const char *golden_explain(const char *name, golden_run *run, uint32_t rate_Hz);

/* The same against the committed trace: "" where all is as it says. */
const char *golden_trace(const char *name, golden_run *run, uint32_t rate_Hz);

#endif
