/* SPDX-License-Identifier: MIT */
#include "run.h"

#include "picture.h"
#include "solo.h"
#include "view.h"

#include "base/option.h"
#include "base/outfile.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

struct alone {
    struct run *run;
    struct picture *picture;
    struct draw_list list;
    struct view view;
    struct draw_moment m;
    struct world_stats stats;
    struct pace pace;
};

static int save(struct alone *a, const char *option, const char *path)
{
    a->m.eye = view_eye(&a->view);
    a->m.look = a->view.look;
    world_draw(a->run->world, &a->m, &a->list);
    if (picture_save(a->picture, &a->list, option, path)) { return 1; }
    picture_show(a->picture);
    return 0;
}

/* The pictures of a video are due at their own rate. */
static int film(struct alone *a, long frame)
{
    const struct run *r = a->run;
    const double rate = r->video_fps / r->fps;
    const long now = (long)((double)frame * rate);
    char path[512];
    if (r->video == NULL || (frame > 0 && now == (long)((double)(frame - 1) * rate))) { return 0; }
    snprintf(path, sizeof path, "%s/%06ld.png", r->video, now);
    return save(a, "video", path);
}

static int frames(struct alone *a)
{
    struct run *r = a->run;
    const double dt = 1 / r->fps;
    const long n = r->frames ? (long)r->frames : (long)(r->seconds * r->fps);
    struct solo solo;
    memset(&solo, 0, sizeof solo);
    a->m.trip_ms = -1;
    a->m.fps = r->fps;
    a->m.picture_fps = r->video ? r->video_fps : 0;
    for (long k = 0; k < n; k++) {
        a->m.t_s = (double)k * dt;
        if (r->script) { solo_script(&solo, a->m.t_s); }
        solo_step(&solo, r->world, &a->m.out, dt, &a->m.in);
        a->m.hand = world_hand_at(r->world, a->m.t_s);
        pace_take(&a->pace, &a->m.in, (uint32_t)(1e6 * a->m.t_s));
        world_frame(r->world, &a->m.in, &a->pace, a->m.t_s, &a->m.out, &a->stats);
        if (film(a, k)) { return 1; }
    }
    return r->png ? save(a, "png", r->png) : 0;
}

static void report(const struct world_stats *s)
{
    printf("frames %lu  looks %lu  hits %lu  bodies asked %lu  put aside by their ball %lu  "
           "objects asleep %lu\n",
        s->frames, s->looks, s->hits, s->tests, s->culled, s->slept);
}

int run_alone(struct run *r)
{
    struct alone a;
    int status = 0;
    memset(&a, 0, sizeof a);
    a.run = r;
    view_start(&a.view, world_scene(r->world));
    if (r->video && mkdir(r->video, 0777) != 0 && errno != EEXIST) {
        cli_complain(
            "--video: %s: %s: give a directory that can be made", r->video, strerror(errno));
        return 2;
    }
    status = outfile_try(&(struct outfile_option){"png", r->png}, 1);
    if (status) { return status; }
    if (r->png || r->video) {
        const struct picture_want want = {
            "world", (int)r->width, (int)r->height, 1, (int)r->samples};
        char why[600];
        a.picture = picture_open(&want, why, sizeof why);
        if (a.picture == NULL) {
            cli_complain("%s", why);
            return 3;
        }
    }
    status = frames(&a);
    report(&a.stats);
    picture_close(a.picture);
    draw_free(&a.list);
    return status;
}
