/* SPDX-License-Identifier: MIT */
/* What must hold whatever comes in: a fuzzer sees an abort, people the line. */
#ifndef TEST_FUZZ_MUST_H
#define TEST_FUZZ_MUST_H

#include <stdio.h>
#include <stdlib.h>

#define MUST(cond) \
    do { \
        if (!(cond)) { \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #cond); \
            abort(); \
        } \
    } while (0)

#endif
