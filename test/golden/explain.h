/* SPDX-License-Identifier: MIT */
/* Explain: where a run and the generator's part. On hosts only; elsewhere nothing. */
#ifndef TEST_GOLDEN_EXPLAIN_H
#define TEST_GOLDEN_EXPLAIN_H

#include "golden.h"

/* Every step-th rate from lo to hi. */
struct golden_rates {
    uint32_t lo, hi, step;
};

/* The rates that EXH_RATES=lo..hi:step asks for; all without it. */
struct golden_rates golden_rates(void);

/* 1 if EXH_CELLS=1: say of each module which rates ran, and the CRC of their digests. */
int golden_cells(void);

/* The CRC of each hundred rates' digests beyond GOLDEN_RATES, from the generator's file; 0 if it is
 * not there. */
int golden_hundreds(const char *name, uint32_t crc[GOLDEN_HUNDREDS]);

/* 1 if EXH_EXPLAIN=0: count, and tell nothing. */
int golden_quiet(void);

/* Calls the generator for a run whose digest is wrong, and returns what to say of it: the
 * first tick that differs, expected and got. Never NULL; good until the next call. */
const char *golden_explain(const char *name, golden_run *run, uint32_t rate_Hz);

/* The same against the committed trace: "" where all is as it says. */
const char *golden_trace(const char *name, golden_run *run, uint32_t rate_Hz);

#endif
