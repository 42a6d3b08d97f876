/* SPDX-License-Identifier: MIT */
/* Stress: sine and cosine of each of the 2^32 angles, against long double.
 *
 * The reference is known in one eighth of the turn: a power series at every 1024th angle,
 * and from there the sum of two angles. Its seven images are reflections and quarter turns of
 * that; the library's are not taken as given, all eight are computed. */
#include "stress.h"

#include <float.h>
#include <sys/wait.h>
#include <unistd.h>

typedef char needs_long_double_of_64_bits[LDBL_MANT_DIG >= 64 ? 1 : -1];

#define EIGHTH    (UINT32_C(1) << 29)
#define STRETCH   UINT32_C(1024)
#define PROCESSES 2u
#define LSB_RAD   (3.14159265358979323846264338327950288L / 2147483648.0L)
#define ONE_Q30   (INT32_C(1) << 30)
#define BOUND_LSB 2.25 /* angle.h */

struct circle {
    long double sin, cos;
};

static struct circle series(long double rad)
{
    struct circle y = {rad, 1};
    long double term = rad;
    for (int n = 2; n < 28; n += 2) {
        term *= rad / (long double)n;
        y.cos += n & 2 ? -term : term;
        term *= rad / (long double)(n + 1);
        y.sin += n & 2 ? -term : term;
    }
    return y;
}

static struct circle sum_of(struct circle a, struct circle b)
{
    const struct circle y = {a.sin * b.cos + a.cos * b.sin, a.cos * b.cos - a.sin * b.sin};
    return y;
}

struct seen {
    uint64_t angles, beyond; /* looked at; of them with a value beyond 1 */
    double sin_lsb, cos_lsb; /* worst errors */
    uint32_t sin_at, cos_at;
};

static double off(int32_t got_q30, long double want)
{
    const long double d = (long double)got_q30 - want * (long double)ONE_Q30;
    return (double)(d < 0 ? -d : d);
}

static void look(struct seen *e, uint32_t x, struct circle want)
{
    struct exh_sincos y;
    double d;
    exh_sincos(exh_from_u32(x), &y);
    d = off(y.sin_q30, want.sin);
    if (!(d <= e->sin_lsb)) {
        e->sin_lsb = d;
        e->sin_at = x;
    }
    d = off(y.cos_q30, want.cos);
    if (!(d <= e->cos_lsb)) {
        e->cos_lsb = d;
        e->cos_at = x;
    }
    e->beyond +=
        y.sin_q30 > ONE_Q30 || y.sin_q30 < -ONE_Q30 || y.cos_q30 > ONE_Q30 || y.cos_q30 < -ONE_Q30;
    e->angles++;
}

/* From a quarter to the next one. */
static struct circle quarter_on(struct circle a)
{
    const struct circle y = {a.cos, -a.sin};
    return y;
}

/* The angles a before and a behind each quarter; at 0 and at 1/8 they are the same four. */
static void images(struct seen *e, uint32_t a, struct circle want)
{
    struct circle behind = want, before = {-want.sin, want.cos};
    for (uint32_t quarter = 0; quarter < 4; quarter++) {
        look(e, (quarter << 30) + a, behind);
        if (a != 0 && a != EIGHTH) { look(e, (quarter << 30) - a, before); }
        behind = quarter_on(behind);
        before = quarter_on(before);
    }
}

static struct seen part_of_all(uint32_t part, uint32_t thin)
{
    static struct circle step[STRETCH];
    struct seen e = {0, 0, 0, 0, 0, 0};
    for (uint32_t k = 0; k < STRETCH; k++) { step[k] = series(LSB_RAD * (long double)k); }
    for (uint32_t at = part * STRETCH; at < EIGHTH; at += PROCESSES * STRETCH * thin) {
        const struct circle start = series(LSB_RAD * (long double)at);
        for (uint32_t k = 0; k < STRETCH; k++) { images(&e, at + k, sum_of(start, step[k])); }
    }
    if (part == 0) { images(&e, EIGHTH, series(LSB_RAD * (long double)EIGHTH)); }
    return e;
}

static void add(struct seen *all, const struct seen *e)
{
    all->angles += e->angles;
    all->beyond += e->beyond;
    if (!(e->sin_lsb <= all->sin_lsb)) {
        all->sin_lsb = e->sin_lsb;
        all->sin_at = e->sin_at;
    }
    if (!(e->cos_lsb <= all->cos_lsb)) {
        all->cos_lsb = e->cos_lsb;
        all->cos_at = e->cos_at;
    }
}

/* How many those are: eight images of each, and four of 0 and of the eighth. */
static uint64_t angles_of(uint32_t thin)
{
    const uint64_t stretches = EIGHTH / STRETCH, stride = (uint64_t)PROCESSES * thin;
    uint64_t n = 0;
    for (uint64_t part = 0; part < PROCESSES; part++) {
        n += (stretches - part + stride - 1) / stride;
    }
    return 8 * STRETCH * n;
}

/* Each part is a separate process. One that dies leaves angles out, and the count shows it. */
int every_angle(uint32_t thin)
{
    struct seen all = {0, 0, 0, 0, 0, 0}, e;
    int end[2], good;
    if (pipe(end) != 0) { return 1; }
    fflush(stdout);
    for (uint32_t part = 0; part < PROCESSES; part++) {
        if (fork() == 0) {
            e = part_of_all(part, thin);
            _exit(write(end[1], &e, sizeof e) != (ssize_t)sizeof e);
        }
    }
    close(end[1]);
    while (read(end[0], &e, sizeof e) == (ssize_t)sizeof e) { add(&all, &e); }
    close(end[0]);
    while (wait(NULL) > 0) {}
    good = all.angles == angles_of(thin) && all.beyond == 0 && all.sin_lsb <= BOUND_LSB &&
           all.cos_lsb <= BOUND_LSB;
    printf("%" PRIu64 " angles: sine within %.4f LSB of q30 (at %#" PRIx32 "), cosine within %.4f "
           "(at %#" PRIx32 "), %" PRIu64 " beyond 1 | at most %.2f | %s\n",
        all.angles, all.sin_lsb, all.sin_at, all.cos_lsb, all.cos_at, all.beyond, BOUND_LSB,
        good ? "ok" : "FAIL");
    return !good;
}
