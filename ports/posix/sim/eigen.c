/* SPDX-License-Identifier: MIT */
#include "eigen.h"

#include <string.h>

static double size_of(double v) { return v < 0 ? -v : v; }

double sim_sqrt(double v)
{
    double r, scale = 1;
    if (!(v > 0)) { return 0; }
    for (; v >= 4; v /= 4) { scale *= 2; }
    for (; v < 1; v *= 4) { scale /= 2; }
    r = 0.5 * (1 + v);
    for (int i = 0; i < 6; i++) { r = 0.5 * (r + v / r); }
    return r * scale;
}

/* --- real: balance, Hessenberg form --- */

/* A similar matrix with balanced rows and columns, by exact powers of 2. Forces and positions
 * differ by a factor of 10^5, which would cost digits. */
static void balance(struct matrix *M)
{
    for (int sweep = 0, changed = 1; changed && sweep < 100; sweep++) {
        changed = 0;
        for (int i = 0; i < M->n; i++) {
            double row = 0, column = 0, f = 1;
            for (int j = 0; j < M->n; j++) {
                row += j != i ? size_of(M->m[i][j]) : 0;
                column += j != i ? size_of(M->m[j][i]) : 0;
            }
            if (!(row > 0 && column > 0)) { continue; }
            while (column * f * f < row / 2) { f *= 2; }
            while (column * f * f > row * 2) { f /= 2; }
            changed |= f != 1;
            for (int j = 0; j < M->n; j++) {
                M->m[i][j] /= f;
                M->m[j][i] *= f;
            }
        }
    }
}

static void swap(double *a, double *b)
{
    const double c = *a;
    *a = *b;
    *b = c;
}

/* Elimination with pivots: zero below the first subdiagonal, the same eigenvalues. */
static void reduce(struct matrix *M)
{
    const int n = M->n;
    for (int c = 0; c + 2 < n; c++) {
        int pivot = c + 1;
        for (int i = c + 2; i < n; i++) {
            if (size_of(M->m[i][c]) > size_of(M->m[pivot][c])) { pivot = i; }
        }
        if (M->m[pivot][c] == 0) { continue; }
        for (int j = 0; j < n; j++) { swap(&M->m[pivot][j], &M->m[c + 1][j]); }
        for (int j = 0; j < n; j++) { swap(&M->m[j][pivot], &M->m[j][c + 1]); }
        for (int i = c + 2; i < n; i++) {
            const double f = M->m[i][c] / M->m[c + 1][c];
            for (int j = 0; j < n && f != 0; j++) { M->m[i][j] -= f * M->m[c + 1][j]; }
            for (int j = 0; j < n && f != 0; j++) { M->m[j][c + 1] += f * M->m[j][i]; }
            M->m[i][c] = 0;
        }
    }
}

/* --- complex: QR --- */

struct z {
    double re, im;
};

static struct z sum(struct z a, struct z b) { return (struct z){a.re + b.re, a.im + b.im}; }

static struct z less(struct z a, struct z b) { return (struct z){a.re - b.re, a.im - b.im}; }

static struct z times(struct z a, struct z b)
{
    return (struct z){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

static struct z conjugate(struct z a) { return (struct z){a.re, -a.im}; }

static double square(struct z a) { return a.re * a.re + a.im * a.im; }

static struct z z_sqrt(struct z a)
{
    const double r = sim_sqrt(square(a));
    const double re = sim_sqrt((r + size_of(a.re)) / 2);
    const double im = re > 0 ? a.im / (2 * re) : 0;
    if (a.re >= 0) { return (struct z){re, im}; }
    return (struct z){size_of(im), a.im < 0 ? -re : re};
}

typedef struct z z_matrix[EIGEN_MAX][EIGEN_MAX];

/* The eigenvalue of the last two rows that lies closer to the last entry. */
static struct z shift_of(z_matrix h, int e)
{
    const struct z a = h[e - 1][e - 1], d = h[e][e];
    const struct z half = {(a.re - d.re) / 2, (a.im - d.im) / 2};
    const struct z root = z_sqrt(sum(times(half, half), times(h[e - 1][e], h[e][e - 1])));
    const struct z mid = {(a.re + d.re) / 2, (a.im + d.im) / 2};
    const struct z one = sum(mid, root), other = less(mid, root);
    return square(less(one, d)) < square(less(other, d)) ? one : other;
}

/* One QR step on rows and columns b..e, shifted by s. */
static void step(z_matrix h, int b, int e, struct z s)
{
    struct z c[EIGEN_MAX], t[EIGEN_MAX]; /* the rotations */
    for (int i = b; i <= e; i++) { h[i][i] = less(h[i][i], s); }
    for (int i = b; i < e; i++) {
        const double r = sim_sqrt(square(h[i][i]) + square(h[i + 1][i]));
        const double f = r > 0 ? 1 / r : 0;
        c[i] = r > 0 ? (struct z){h[i][i].re * f, h[i][i].im * f} : (struct z){1, 0};
        t[i] = (struct z){h[i + 1][i].re * f, h[i + 1][i].im * f};
        for (int j = i; j <= e; j++) {
            const struct z up = h[i][j], low = h[i + 1][j];
            h[i][j] = sum(times(conjugate(c[i]), up), times(conjugate(t[i]), low));
            h[i + 1][j] = less(times(c[i], low), times(t[i], up));
        }
    }
    for (int i = b; i < e; i++) {
        for (int j = b; j <= i + 1; j++) {
            const struct z left = h[j][i], right = h[j][i + 1];
            h[j][i] = sum(times(left, c[i]), times(right, t[i]));
            h[j][i + 1] = less(times(right, conjugate(c[i])), times(left, conjugate(t[i])));
        }
    }
    for (int i = b; i <= e; i++) { h[i][i] = sum(h[i][i], s); }
}

/* Where the block that ends at e begins: above it a subdiagonal entry is nothing. */
static int block(z_matrix h, int e)
{
    int b = e;
    for (; b > 0; b--) {
        const double beside = size_of(h[b - 1][b - 1].re) + size_of(h[b - 1][b - 1].im) +
                              size_of(h[b][b].re) + size_of(h[b][b].im);
        const double below = size_of(h[b][b - 1].re) + size_of(h[b][b - 1].im);
        if (below <= 1e-16 * beside || below < 1e-290) {
            h[b][b - 1] = (struct z){0, 0};
            return b;
        }
    }
    return 0;
}

#define STEPS_MAX 100 /* per eigenvalue; three are usual */

double eigen_radius(const struct matrix *M)
{
    static struct matrix A;
    static z_matrix h;
    double most = 0;

    A = *M;
    balance(&A);
    reduce(&A);
    for (int i = 0; i < A.n; i++) {
        for (int j = 0; j < A.n; j++) { h[i][j] = (struct z){A.m[i][j], 0}; }
    }
    for (int e = A.n - 1, steps = 0; e >= 0; steps++) {
        const int b = block(h, e);
        if (b == e) {
            const double size = square(h[e][e]);
            if (size > most) { most = size; }
            e--;
            steps = -1;
        } else if (steps == STEPS_MAX) {
            return -1;
        } else if (steps % 10 == 9) { /* a shift of another kind ends a cycle */
            const double off = size_of(h[e][e - 1].re) + size_of(h[e][e - 1].im);
            step(h, b, e, (struct z){h[e][e].re + 0.75 * off, h[e][e].im + 0.4375 * off});
        } else {
            step(h, b, e, shift_of(h, e));
        }
    }
    return sim_sqrt(most);
}
