/* SPDX-License-Identifier: MIT */
/* PROVES: set-up of pre-contact by figures
 * Any figures, loop rates in whole Hz and in thousandths of Hz, any threshold. The advice is
 * within the range that set-up accepts.
 *
 * EVA: -eva-slevel 20
 * PLANT: lib/src/law/advise.c: d > INT32_MAX || ray > INT32_MAX || -> d > INT32_MAX ||
 * PLANT: lib/src/law/advise.c: if (need->radius_m_q30 > 0) { -> {
 */
#define exh_udiv64 udiv64_by_steps
#include "num/fix.c"
#undef exh_udiv64
#include "quotient.h"
#include "law/advise.c"

#include "any.h"

static void advise(uint32_t num, uint32_t least, uint32_t most)
{
    struct exh_precontact_advice advice;
    struct exh_precontact_need need;
    const struct exh_period T = {num, Frama_C_unsigned_int_interval(least, most)};
    ANY(need);
    if (exh_precontact_advise(&advice, &need, T, any32()) == 0) {
        /*@ assert outward: advice.d_lim_m_q30 <= 0 && advice.ray_m_q30 >= 0; */
        /*@ assert sizes: advice.error_m_q30 >= 0 && advice.speed_mps_q27 >= 0; */
    }
}

int main(void)
{
    advise(1, 1, 20020);
    advise(1000, 1000, 20020000);
    advise(any_u32(), 0, 0);
    advise(0, 1, UINT32_MAX);
    END();
    return 0;
}
