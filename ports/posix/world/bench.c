/* SPDX-License-Identifier: MIT */
/* Frames and looks a second on one core, with and without culling, and with the picture drawn. */
#include "run.h"

#include "mesh.h"
#include "picture.h"
#include "rpy.h"
#include "solo.h"
#include "view.h"

#include "base/option.h"
#include "sim/lag.h"
#include "sim/random.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define STATES 512
#define RUN_S  0.4

static const char *const frame_of_all = "hand at 0 0 0\nmaterial m\nfingers all\nlook ahead 0.1\n";

/* Of the processor, all threads together: what one core would do in that time were it free. */
static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double random_in(struct sim_random *r, double lo, double hi)
{
    return lo + (hi - lo) * sim_random_unit(r);
}

static double wall_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* --- worlds --- */

/* One object among others, in a cube of half edge half_m around the fingers. */
static int object(char *to, size_t to_B, struct sim_random *r, int k, double half_m, int moving)
{
    const double x = random_in(r, -half_m, half_m), y = 0.1 + random_in(r, -half_m, half_m);
    const double z = random_in(r, -half_m, half_m), a = random_in(r, 0.01, 0.03);
    int n;
    switch (k % 3) {
    case 0:
        n = snprintf(
            to, to_B, "sphere o%d at %.4f %.4f %.4f radius %.4f material m\n", k, x, y, z, a);
        break;
    case 1:
        n = snprintf(to, to_B,
            "box o%d at %.4f %.4f %.4f rpy 20 30 %.1f size %.4f 0.03 0.02 material m\n", k, x, y, z,
            1e4 * a, 2 * a);
        break;
    default:
        n = snprintf(to, to_B,
            "capsule o%d at %.4f %.4f %.4f rpy 50 %.1f 0 radius 0.01 length %.4f "
            "material m\n",
            k, x, y, z, 1e4 * a, 2 * a);
    }
    if (moving) {
        n += snprintf(to + n, to_B - (size_t)n, "motion o%d sine move 0.02 0 0 hz 0.5\n", k);
    }
    return n;
}

/* n objects, the first a plane under the hand. To be freed. */
static char *objects(int n, double half_m, int moving)
{
    struct sim_random r = {1};
    const size_t room = 400 + (size_t)n * 200;
    char *text = malloc(room);
    int at;
    if (text == NULL) { return NULL; }
    at = snprintf(text, room, "%splane floor at 0 0 -0.09 material m\n", frame_of_all);
    for (int k = 1; k < n; k++) {
        at += object(text + at, room - (size_t)at, &r, k, half_m, moving);
    }
    return text;
}

/* A sphere of 2 n^2 triangles under the hand, as an OBJ file. 0, or 1. */
static int write_ball(FILE *f, int n, double radius_m)
{
    for (int i = 0; i <= n; i++) {
        const double a = (i + 0.5) * (3.141592653589793 / (n + 1));
        for (int k = 0; k < n; k++) {
            const double b = k * (6.283185307179586 / n), c = radius_m * sim_sin(a);
            fprintf(f, "v %.7f %.7f %.7f\n", c * sim_cos(b), c * sim_sin(b), radius_m * sim_cos(a));
        }
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n; k++) {
            const int a = i * n + k + 1, b = i * n + (k + 1) % n + 1;
            fprintf(f, "f %d %d %d %d\n", a, a + n, b + n, b);
        }
    }
    return fflush(f) != 0;
}

static struct world *mesh_world(char *why, size_t why_B)
{
    char name[] = "/tmp/world-XXXXXX", text[300];
    const int fd = mkstemp(name);
    FILE *f = fd < 0 ? NULL : fdopen(fd, "w");
    struct world *w = NULL;
    if (f == NULL || write_ball(f, 224, 0.07)) {
        snprintf(why, why_B, "/tmp: no file can be made there");
    } else {
        snprintf(text, sizeof text, "%smesh ball at 0.0 0.13 -0.07 file %s material m\n",
            frame_of_all, name);
        w = world_load("bench", text, why, why_B);
    }
    if (f) { fclose(f); }
    if (fd >= 0) { unlink(name); }
    return w;
}

/* --- measuring --- */

static struct exh_wire_state state[STATES];

static void make_states(void)
{
    struct sim_random r = {2};
    for (int k = 0; k < STATES; k++) {
        state[k].fingers = (1u << FINGERS) - 1;
        for (int i = 0; i < FINGERS * 3; i++) {
            const double rad = random_in(&r, finger_lo_rad[i % 3], finger_hi_rad[i % 3]);
            state[k].joint_turn_q32[i / 3][i % 3] = (int32_t)(rad / RAD_PER_TURN_Q32);
        }
    }
}

static double frames_per_s(struct world *w, int cull, struct world_stats *s)
{
    static struct exh_wire_planes out;
    const double start = now_s();
    double t = start;
    world_cull(w, cull);
    memset(s, 0, sizeof *s);
    while (t - start < RUN_S) {
        for (int k = 0; k < STATES; k++) {
            world_frame(w, &state[k], NULL, (double)s->frames / 400, &out, s);
        }
        t = now_s();
    }
    return (double)s->frames / (t - start);
}

/* And by the clock on the wall. turning: the view moves, so that nothing is kept from the picture
 * before. */
static double pictures_per_s(struct picture *p, struct world *w, int turning, double *by_wall)
{
    static struct draw_list list;
    static struct draw_moment m;
    struct solo solo;
    struct view view;
    unsigned long n = 0;
    const double start = now_s(), start_wall = wall_s();
    double t = start;
    memset(&solo, 0, sizeof solo);
    memset(&m, 0, sizeof m);
    view_start(&view, world_scene(w));
    m.look = view.look;
    m.trip_ms = -1;
    for (; t - start < (turning ? 2 : 4) * RUN_S; t = now_s(), n++) {
        if (turning) { view_turn(&view, 0.002, 0); }
        m.eye = view_eye(&view);
        m.t_s = (double)n / 400;
        solo_script(&solo, m.t_s);
        solo_step(&solo, w, &m.out, 1.0 / 400, &m.in);
        m.hand = world_hand_at(w, m.t_s);
        world_frame(w, &m.in, NULL, m.t_s, &m.out, NULL);
        world_draw(w, &m, &list);
        picture_paint(p, &list);
        picture_wait(p);
        picture_show(p);
    }
    *by_wall = (double)n / (wall_s() - start_wall);
    return (double)n / (t - start);
}

static void drawn(struct world *w, const struct picture_want *want)
{
    char why[600];
    double wall, wall_turning;
    struct picture *p = want ? picture_open(want, why, sizeof why) : NULL;
    if (p) {
        const double still = pictures_per_s(p, w, 0, &wall),
                     turning = pictures_per_s(p, w, 1, &wall_turning);
        printf(" %8.0f %8.0f %8.0f %8.0f", still, wall, turning, wall_turning);
    } else {
        printf(" %8s %8s %8s %8s", "-", "-", "-", "-");
    }
    picture_close(p);
}

static void row(const char *name, struct world *w, const struct picture_want *want)
{
    struct world_stats on, off;
    const double a = frames_per_s(w, 1, &on), b = frames_per_s(w, 0, &off);
    printf("%-26s %9.0f %9.0f %7.1f %5.1f %9.0f %7.1f", name, a, 5 * a,
        (double)(on.tests - on.culled) / (double)on.looks, 100 * (double)on.hits / (double)on.looks,
        5 * b, (double)off.tests / (double)off.looks);
    world_cull(w, 1);
    drawn(w, want);
    putchar('\n');
    fflush(stdout);
}

static int rows(const struct run *r, const struct picture_want *want)
{
    static const struct {
        const char *name;
        int n, moving;
        double half_m;
    } kind[] = {{"1 object", 1, 0, 0.1}, {"10 objects at hand", 10, 0, 0.12},
        {"1000 objects within 1 m", 1000, 0, 1}, {"1000 objects, all moving", 1000, 1, 1},
        {"1000 objects at hand", 1000, 0, 0.2}};
    char why[700];
    struct world *w;
    for (size_t i = 0; i < sizeof kind / sizeof kind[0]; i++) {
        char *text = objects(kind[i].n, kind[i].half_m, kind[i].moving);
        w = text ? world_load("bench", text, why, sizeof why) : NULL;
        free(text);
        if (w == NULL) { return 1; }
        row(kind[i].name, w, want);
        world_free(w);
    }
    w = mesh_world(why, sizeof why);
    if (w) {
        row("mesh of 100352 triangles", w, want);
    } else {
        printf("mesh: left out: %s\n", why);
    }
    world_free(w);
    if (r->scene == NULL) { return 0; }
    w = world_load_file(r->scene, why, sizeof why);
    if (w) {
        row("--scene", w, want);
    } else {
        cli_complain("%s", why);
    }
    world_free(w);
    return w == NULL ? 2 : 0;
}

int run_bench(struct run *r)
{
    const struct picture_want want = {
        "world", (int)r->width, (int)r->height, 1, r->samples < 0 ? 0 : (int)r->samples};
    char why[600];
    struct picture *p = picture_open(&want, why, sizeof why);
    if (p == NULL) { printf("without pictures: %s\n", why); }
    picture_close(p);
    make_states();
    printf(
        "One core, five fingers. Frames, looks and pictures (%d x %d, view still or turning) a "
        "second of the\n"
        "processor's time, all threads together, and of pictures also by the clock on the wall.\n",
        want.width, want.height);
    printf("%-26s %9s %9s %7s %5s %9s %7s %8s %8s %8s %8s\n", "", "frames", "looks", "bodies",
        "hits", "looks un-", "bodies", "pictures", "wall", "turning", "wall");
    printf("%-26s %9s %9s %7s %5s %9s %7s\n", "", "", "", "a look", "%", "culled", "a look");
    return rows(r, p ? &want : NULL);
}
