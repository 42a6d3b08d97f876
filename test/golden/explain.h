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

/* 1 if the hundred that begins at `first` is one of EXH_HUNDREDS=2001,2301; all are without it. */
int golden_drawn(uint32_t first);

/* 1 if EXH_CELLS=1: say of each module which rates ran, and the CRC of their digests. */
int golden_cells(void);

/* The digest of each rate of the hundred that begins at `first`, from the table EXH_DIGESTS, if
 * they have this CRC; else from the generator, if `ask`. 0 where neither has them. */
int golden_singles(
    const char *name, uint32_t first, uint32_t crc, int ask, uint32_t digest[GOLDEN_HUNDRED]);

/* 1 if there are files: then no other comparison is made. */
int golden_files(void);

/* Appends a module's digests at 1..GOLDEN_RATES to the table EXH_WRITE, if it is given: in
 * hundreds, the first of them with the name. */
void golden_write(const char *name, uint32_t first, const uint32_t digest[GOLDEN_HUNDRED]);

/* 1 if EXH_EXPLAIN=0: count, and print nothing. */
int golden_quiet(void);

/* Calls the generator for a run whose digest is wrong, and returns what to say of it: the
 * first tick that differs, expected and got. Never NULL; good until the next call. */
const char *golden_explain(const char *name, golden_run *run, uint32_t rate_Hz);

/* The same against the trace in the folder EXH_TRACES. "" if both agree, or without a folder. */
const char *golden_trace(const char *name, golden_run *run, uint32_t rate_Hz);

#endif
