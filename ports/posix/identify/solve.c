/* SPDX-License-Identifier: MIT */
#include "identify/solve.h"

#include <math.h>

static double raised(double v, double raise)
{
    return v + raise * v + 1e-12 * v + (v <= 0 ? 1 : 0);
}

static int factor(int n, const double *a, double raise, double c[SOLVE_MAX][SOLVE_MAX])
{
    for (int i = 0; i < n; i++) {
        for (int l = 0; l <= i; l++) {
            double s = i == l ? raised(a[i * n + i], raise) : a[i * n + l];
            for (int k = 0; k < l; k++) { s -= c[i][k] * c[l][k]; }
            if (i == l && !(s > 0)) { return -1; }
            c[i][l] = i == l ? sqrt(s) : s / c[l][l];
        }
    }
    return 0;
}

int solve_raised(int n, const double *a, double raise, const double *g, double *x)
{
    double c[SOLVE_MAX][SOLVE_MAX];
    if (factor(n, a, raise, c)) { return -1; }
    for (int i = 0; i < n; i++) {
        x[i] = g[i];
        for (int k = 0; k < i; k++) { x[i] -= c[i][k] * x[k]; }
        x[i] /= c[i][i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) { x[i] -= c[k][i] * x[k]; }
        x[i] /= c[i][i];
    }
    return 0;
}
