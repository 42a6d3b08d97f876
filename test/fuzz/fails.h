/* SPDX-License-Identifier: MIT */
/* What the library's checks call, where a fuzzer looks on: an assertion ends it, saturation is none
 * of its business. */
#ifndef TEST_FUZZ_FAILS_H
#define TEST_FUZZ_FAILS_H

#include "exhand/error.h"
#include "exhand/fix.h"

#include <stdio.h>
#include <stdlib.h>

void exh_assert_failed(const char *file, int line)
{
    fprintf(stderr, "%s:%d: assertion\n", file, line);
    abort();
}

#ifdef EXH_FIX_AUDIT
void exh_fix_saturated(const char *file, int line)
{
    (void)file;
    (void)line;
}
#endif

#endif
