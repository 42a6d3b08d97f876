/* SPDX-License-Identifier: MIT */
/* world: the world simulator as a separate program. */
#include "run.h"

#include "base/ends.h"
#include "base/option.h"

#include "exhand/exhand.h"

#include <stdio.h>
#include <stdlib.h>

#define OPTIONS(r) \
    {"scene", CLI_TEXT, &(r).scene, 0, 0, "FILE", \
        "the world (ports/posix/world/scenes/README.md)"}, \
        {"listen", CLI_TEXT, &(r).listen, 0, 0, "[ADDRESS:]PORT", \
            "wait for a controller there (UDP); 127.0.0.1"}, \
        {"peer", CLI_TEXT, &(r).peer, 0, 0, "HOST:PORT", \
            "the controller is there; no other is listened to"}, \
        {"key", CLI_TEXT, &(r).key, 0, 0, "FILE", \
            "of both, 32 hexadecimal digits; a controller that lacks it is not heard"}, \
        {"fps", CLI_REAL, &(r).fps, 1, 2000, "N", "frames a second, each an exchange; 400"}, \
        {"frames", CLI_INT, &(r).frames, 1, 1e12, "N", "end after so many"}, \
        {"seconds", CLI_REAL, &(r).seconds, 0, 1e9, "S", "end after so long"}, \
        {"headless", CLI_FLAG, &(r).headless, 0, 0, NULL, \
            "no window; without a link: as fast as it goes"}, \
        {"script", CLI_FLAG, &(r).script, 0, 0, NULL, \
            "without a controller, fingers close and open by themselves"}, \
        {"trace", CLI_TEXT, &(r).trace, 0, 0, "FILE", \
            "outputs of the controller, as it sends them, as CSV (a link)"}, \
        {"trace-every", CLI_INT, &(r).trace_every, 1, 1e6, "N", "of every N-th tick; 1"}, \
        {"trace-signals", CLI_TEXT, &(r).trace_signals, 0, 0, "NAMES", \
            "up to four; q[1],f_des[1],d[1],c[1]: of the index finger"}, \
        {"png", CLI_TEXT, &(r).png, 0, 0, "FILE", "leave the last picture there"}, \
        {"list", CLI_TEXT, &(r).list, 0, 0, "FILE", \
            "leave there what the window showed last, as words and numbers"}, \
        {"video", CLI_TEXT, &(r).video, 0, 0, "DIR", \
            "leave pictures there (--headless, no link)"}, \
        {"video-fps", CLI_REAL, &(r).video_fps, 1, 400, "N", "so many a second; 25"}, \
        {"width", CLI_INT, &(r).width, 160, 8192, "PIXELS", "of the picture; 960"}, \
        {"height", CLI_INT, &(r).height, 120, 8192, "PIXELS", "of the picture; 600"}, \
        {"smooth", CLI_INT, &(r).samples, 0, 16, "N", \
            "samples a pixel; 4 for --png and --video, else 0"}, \
        {"bench", CLI_FLAG, &(r).bench, 0, 0, NULL, "print frames and looks a second"},

void exh_assert_failed(const char *file, int line)
{
    fprintf(stderr, "world: %s:%d: a check of its own failed: please report it\n", file, line);
    abort();
}

static int load(struct run *r)
{
    char why[700];
    if (r->scene == NULL) {
        cli_complain("--scene: is missing: give a file of ports/posix/world/scenes");
        return 2;
    }
    r->world = world_load_file(r->scene, why, sizeof why);
    if (r->world == NULL) { cli_complain("%s", why); }
    return r->world ? 0 : 2;
}

static int check(struct run *r)
{
    const int alone = r->headless && !r->listen && !r->peer;
    if (r->video && !alone) {
        cli_complain(
            "--video: works with --headless and without --listen and --peer: use --png, or leave "
            "the link away");
        return 2;
    }
    if (r->key && !r->listen && !r->peer) {
        cli_complain("--key: is a link's: give --listen or --peer");
        return 2;
    }
    if (r->trace && !r->listen && !r->peer) {
        cli_complain("--trace: is a controller's: give --listen or --peer");
        return 2;
    }
    if (alone && !r->frames && r->seconds <= 0) {
        cli_complain("--headless: when is it to end? Give --frames or --seconds");
        return 2;
    }
    if (r->samples < 0) { r->samples = r->png || r->video ? 4 : 0; }
    return 0;
}

int main(int argc, char **argv)
{
    struct run r = {.trace_signals = "q[1],f_des[1],d[1],c[1]",
        .trace_every = 1,
        .fps = 400,
        .video_fps = 25,
        .width = 960,
        .height = 600,
        .samples = -1};
    const struct cli_option option[] = {OPTIONS(r)};
    const struct cli_command c = {"world", "--scene FILE [options]",
        "The virtual world: answers joints with the planes the fingers are about "
        "to touch.",
        option, (int)(sizeof option / sizeof option[0]), 0};
    int status;
    ends_begin();
    cli_program = "";
    status = cli_parse(&c, argc, argv, NULL);
    if (status) { return status == 1 ? 0 : status; }
    if (r.bench) { return ends_status(cli_finish(run_bench(&r))); }
    status = check(&r);
    if (status == 0) { status = load(&r); }
    if (status) { return status; }
    status = r.headless && !r.listen && !r.peer ? run_alone(&r) : run_live(&r);
    world_free(r.world);
    return ends_status(cli_finish(status));
}
