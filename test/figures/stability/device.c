/* SPDX-License-Identifier: MIT */
/* The same cells with what a device adds, one by one: dry and viscous friction, encoder steps, a
 * string that only pulls and no further than a peak. Linear theory no longer says what happens;
 * what must still hold is said below. */
#include "stability.h"

#include <math.h>
#include <stdlib.h>

#define START_M   1e-3     /* into the wall */
#define STEP_M    66.32e-6 /* the device's encoder */
#define COULOMB_N 1.0
#define VISCOUS   3.557
#define PEAK_N    22.0
#define LOAD_N    10.0
#define GONE_M    0.9
#define NEAR      0.005

enum part { FRICTION = 1, STEPS = 2, STRING = 4 };
static const struct {
    const char *name;
    unsigned parts;
} variant[] = {{"none", 0}, {"friction", FRICTION}, {"steps", STEPS}, {"string", STRING},
    {"all", FRICTION | STEPS | STRING}};

enum ends { REST, BUZZ, SWINGS, LEAVES, ENDS };
static const char *const end_name[ENDS] = {"rest", "buzz", "swings", "leaves"};

static struct wall with(struct wall w, unsigned parts)
{
    if (parts & FRICTION) {
        w.coulomb_N = COULOMB_N;
        w.viscous_Nspm = VISCOUS;
    }
    if (parts & STEPS) {
        w.step_m = STEP_M;
        w.phase = 0.3;
    }
    if (parts & STRING) {
        w.f_max_N = PEAK_N;
        w.load_N = LOAD_N;
    }
    w.x_m = START_M;
    return w;
}

struct span {
    double low, high;
};

static double range_of(struct wall *w, int ticks)
{
    struct span s = {w->x_m, w->x_m};
    for (int i = 0; i < ticks; i++) {
        wall_tick(w);
        s.low = fmin(s.low, w->x_m);
        s.high = fmax(s.high, w->x_m);
        if (fabs(w->x_m) > GONE_M) { return 2 * GONE_M; }
    }
    return s.high - s.low;
}

/* The movement in the last 1000 ticks of 7000, or in the last quarter second of two, whichever is
 * longer. It is at rest (within a tenth of a step), within three steps, or a swing. */
static enum ends run(struct wall w, unsigned parts)
{
    const int settle = (int)fmax(6000, 1.75 / ((double)w.T.num / w.T.den));
    double m;
    w = with(w, parts);
    if (wall_start(&w) != 0) { abort(); }
    for (int done = 0; done < settle; done += 500) {
        m = range_of(&w, 500);
        if (m > GONE_M) { return LEAVES; }
        if (w.coulomb_N > 0 && m == 0) {
            return REST;
        } /* dry friction holds it, and the force stays */
        if (!(parts & STRING) && m > 1e2 * START_M) { return LEAVES; } /* up to the formats' ends */
        if (parts == 0 && m < START_M / 1e3) { return REST; }
    }
    m = range_of(&w, settle / 6);
    return m > GONE_M ? LEAVES : m <= 0.1 * STEP_M ? REST : m <= 3 * STEP_M ? BUZZ : SWINGS;
}

/* --- cells of all rates and masses, counted --- */

struct count {
    long in[2][ENDS], all[2]; /* rho < 1, rho > 1 */
};

static double share(const struct count *c, int side, unsigned ends)
{
    long n = 0;
    for (int e = 0; e < ENDS; e++) { n += ends >> e & 1 ? c->in[side][e] : 0; }
    return c->all[side] > 0 ? 100.0 * (double)n / (double)c->all[side] : 100;
}

static int say(const struct count *c)
{
    FILE *csv = csv_open(
        "device", "switched on,rho,cells,at rest %,within three steps %,swings %,leaves %");
    int failed;
    for (size_t v = 0; v < LEN(variant); v++) {
        for (int side = 0; side < 2; side++) {
            fprintf(csv, "%s,%s,%ld,%.1f,%.1f,%.1f,%.1f\n", variant[v].name, side ? "> 1" : "< 1",
                c[v].all[side], share(&c[v], side, 1 << REST), share(&c[v], side, 1 << BUZZ),
                share(&c[v], side, 1 << SWINGS), share(&c[v], side, 1 << LEAVES));
        }
    }
    csv_close(csv);
    failed = must(share(&c[1], 0, 1 << REST) >= 99, "device: friction on, rho < 1: at rest: 99 %",
        "%.1f %% of %ld; rho > 1: %.1f %%", share(&c[1], 0, 1 << REST), c[1].all[0],
        share(&c[1], 1, 1 << REST));
    failed += must(share(&c[2], 0, 1 << REST | 1 << BUZZ) >= 98,
        "device: steps on, rho < 1: within three steps: 98 %", "%.1f %%, at rest %.1f %%",
        share(&c[2], 0, 1 << REST | 1 << BUZZ), share(&c[2], 0, 1 << REST));
    failed += must(share(&c[3], 0, 1 << LEAVES) <= 0,
        "device: a string that only pulls, a peak, rho < 1: stays", "%.1f %%, at rest %.1f %%",
        100 - share(&c[3], 0, 1 << LEAVES), share(&c[3], 0, 1 << REST));
    return failed + must(share(&c[4], 0, 1 << REST | 1 << BUZZ) >= 95 &&
                             share(&c[4], 0, 1 << LEAVES) + share(&c[4], 1, 1 << LEAVES) <= 0,
                        "device: all on, rho < 1: within three steps: 95 %; nothing leaves",
                        "%.1f %%, at rest %.1f %%; rho > 1: %.1f %% at rest",
                        share(&c[4], 0, 1 << REST | 1 << BUZZ), share(&c[4], 0, 1 << REST),
                        share(&c[4], 1, 1 << REST));
}

static int counted(enum size size)
{
    static const uint32_t rate_Hz[] = {90, 200, 500, 2000, 20000};
    static const double mass_kg[] = {0.001, 0.02, 0.1, 0.5, 5};
    static const int cells[] = {3, 6, 14};
    const int n = cells[size];
    struct count c[LEN(variant)] = {{{{0}}, {0}}};
    for (size_t r = 0; r < LEN(rate_Hz); r++) {
        for (size_t m = 0; m < LEN(mass_kg); m++) {
            for (int i = 0; i < n * n * (WALL_DELAY_MAX + 1); i++) {
                struct wall w = {.T = {1, rate_Hz[r]}, .mass_kg = mass_kg[m], .delay = i / (n * n)};
                double rho;
                w.k_Npm = spaced(30, 1e6, i % n, n);
                w.b_Nspm = i / n % n == 0 ? 0 : spaced(0.3, 1e3, i / n % n - 1, n - 1);
                rho = rho_of(&w);
                for (size_t v = 0; v < LEN(variant) && fabs(rho - 1) >= NEAR; v++) {
                    c[v].all[rho > 1]++;
                    c[v].in[rho > 1][run(w, variant[v].parts)]++;
                }
            }
        }
    }
    return say(c);
}

/* --- planes of k and b, for a picture --- */

static const struct {
    uint32_t rate_Hz;
    double mass_kg;
} plane[] = {{90, 0.5}, {500, 0.5}, {2000, 0.5}, {20000, 0.02}};

static struct wall in_plane(size_t p, double k, double b, double viscous)
{
    const struct wall w = {.T = {1, plane[p].rate_Hz},
        .mass_kg = plane[p].mass_kg,
        .delay = 1,
        .k_Npm = k,
        .b_Nspm = b,
        .viscous_Nspm = viscous};
    return w;
}

/* The largest k with rho < 1 at each b, without friction and with viscous friction. */
static void plane_borders(void)
{
    FILE *csv = csv_open("device_border", "panel,viscous_ns_per_m,b_ns_per_m,k_n_per_m");
    for (size_t i = 0; i < 2 * 240 * LEN(plane); i++) {
        const size_t p = i / 480;
        const double viscous = i / 240 % 2 ? VISCOUS : 0, b = spaced(0.3, 1e3, (int)(i % 240), 240);
        double low = 1, high = 1e7;
        for (int n = 0; n < 40; n++) {
            const double mid = sqrt(low * high);
            const struct wall w = in_plane(p, mid, b, viscous);
            *(rho_of(&w) < 1 ? &low : &high) = mid;
        }
        if (low > 2) { fprintf(csv, "%zu,%g,%g,%g\n", p, viscous, b, low); }
    }
    csv_close(csv);
}

static void planes(enum size size)
{
    static const int cells[] = {8, 28, 48};
    const int n = cells[size];
    FILE *csv = csv_open("device_plane",
        "panel,rate_hz,mass_kg,k_n_per_m,b_ns_per_m,rho,ends_steps_string,ends_all");
    for (size_t i = 0; i < LEN(plane) * (size_t)(n * n); i++) {
        const size_t p = i / (size_t)(n * n);
        const double b = spaced(0.3, 1e3, (int)i % n, n);
        const struct wall w = in_plane(p, spaced(30, 1e6, (int)i / n % n, n), b, 0);
        fprintf(csv, "%zu,%u,%g,%g,%g,%.5f,%s,%s\n", p, (unsigned)plane[p].rate_Hz,
            plane[p].mass_kg, w.k_Npm, w.b_Nspm, rho_of(&w), end_name[run(w, STEPS | STRING)],
            end_name[run(w, FRICTION | STEPS | STRING)]);
    }
    csv_close(csv);
    plane_borders();
}

int device_map(enum size size)
{
    planes(size);
    return counted(size);
}
