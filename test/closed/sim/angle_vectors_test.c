/* SPDX-License-Identifier: MIT */
/* A third opinion on angle.h: the cosines that CMSIS-DSP keeps to test its own by. They are rounded
 * doubles; its sines are not, they stray by up to 2147 LSB of q31, and are not asked. */
#include "exhand/angle.h"

#include "exhand/fix.h"

#include "check.h"

#include <stdio.h>
#include <stdlib.h>

#define VECTORS_MAX 64

/* The words of one file: a width letter, how many, then a comment and a word by lines. */
static unsigned words(const char *name, uint32_t *word)
{
    const char *root = getenv("EXH_DATA");
    char line[512];
    unsigned n = 0;
    FILE *f;
    snprintf(
        line, sizeof line, "%s/numerics-cmsis-q31/%s", root != NULL ? root : "$EXH_DATA", name);
    f = fopen(line, "r");
    while (f != NULL && n < VECTORS_MAX && fgets(line, sizeof line, f) != NULL) {
        if (line[0] == '0' && line[1] == 'x') { word[n++] = (uint32_t)strtoul(line, NULL, 16); }
    }
    if (f != NULL) { fclose(f); }
    return n;
}

TEST(cosines_of_another_library)
{
    uint32_t angle_q31[VECTORS_MAX], cos_q31[VECTORS_MAX];
    const unsigned n = words("Angles1_q31.txt", angle_q31);
    int64_t worst = 0;
    if (n == 0) {
        check_note("numerics-cmsis-q31 is not there: cosines of another library not compared");
        return;
    }
    CHECK(words("Cos1_q31.txt", cos_q31) == n && n == 23, "%u angles", n);
    for (unsigned i = 0; i < n; i++) {
        struct exh_sincos y;
        int64_t off;
        exh_sincos(exh_from_u32(angle_q31[i] << 1), &y); /* theirs: 2^31 is one turn */
        off = 2 * (int64_t)y.cos_q30 - exh_from_u32(cos_q31[i]);
        if (off < 0) { off = -off; }
        if (off > worst) { worst = off; }
        /* 2.25 LSB of q30, and their rounding, or their 1 that is 1 - 2^-31 */
        CHECK(off <= 5, "angle %#" PRIx32 ": %" PRId32 ", theirs %" PRId32, angle_q31[i], y.cos_q30,
            exh_from_u32(cos_q31[i]));
    }
    check_note("%u cosines of CMSIS-DSP: within %" PRId64 " LSB of q31", n, worst);
}

TEST_MAIN("sim/angle_vectors", cosines_of_another_library);
