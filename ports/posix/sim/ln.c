/* SPDX-License-Identifier: MIT */
#include "ln.h"

/* ln x = e ln 2 + 2 artanh((m - 1)/(m + 1)), m in 0.7..1.4: |z| < 0.18, z^25 < 1e-18. */
double sim_ln(double x)
{
    double e = 0, z, sum = 0, power;
    while (x > 1.4) {
        x /= 2;
        e++;
    }
    while (x < 0.7) {
        x *= 2;
        e--;
    }
    z = (x - 1) / (x + 1);
    power = z;
    for (int i = 1; i < 25; i += 2) {
        sum += power / i;
        power *= z * z;
    }
    return e * 0.69314718055994531 + 2 * sum;
}
