/* SPDX-License-Identifier: MIT */
/* Options of fingers before a wall: defaults, those with a syntax of their own, what --params
 * lists. */
#include "box/hand_options.h"

#include "base/names.h"
#include "base/assign.h"
#include "base/near.h"
#include "base/option.h"
#include "base/jobs.h"
#include "base/param.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const bilateral_finger_name[BILATERAL_FINGERS] = {
    "thumb", "index", "middle", "ring", "little"};

void bilateral_defaults(struct bilateral_options *o)
{
    static const struct run_setting own[] = {
        {"mat_f_max", 40}, /* the paper has no limit but the drive's */
        {"stuck_time", 0}, /* the simulated hand has no tremor, so it looks like a dead encoder */
    };
    memset(o, 0, sizeof *o);
    o->seed = 1;
    o->seeds = 8;
    o->approaches = 5;
    o->jobs = jobs_cores();
    o->link = "none";
    o->record_Hz = 100;
    o->run.own = own;
    o->run.owns = (int)(sizeof own / sizeof own[0]);
    o->run.board = posix_config_default();
    o->run.board.exo = sim_exo_default();
    o->run.board.exo.fingers = 1u << EXH_INDEX;
    o->run.k_Npm = o->run.b_Nspm = -1;
    o->run.at_m = 0.03;
    o->run.fps = 400;
    o->run.until_s = 1e30;
    o->run.images = &o->images;
    (void)bilateral_take_speeds(o, "slow,natural,fast");
}

struct bilateral_run_cfg bilateral_at_speed(const struct bilateral_options *o, double mps)
{
    struct bilateral_run_cfg c = o->run;
    c.setting = o->setting;
    c.settings = o->settings;
    c.board.seed = (uint64_t)o->seed;
    c.board.cards.how = o->cards ? POSIX_CARDS_INSTANT : POSIX_CARDS_NONE;
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        c.board.exo.path[f].speed_mps = mps;
        c.board.exo.path[f].approaches = (double)o->approaches;
    }
    return c;
}

static int bad_speeds(const char *text)
{
    cli_complain(
        "--speed: %s: give slow, natural, fast or 0.001..3 m/s of string, commas between, at "
        "most %d",
        text, BILATERAL_SPEEDS_MAX);
    return 2;
}

int bilateral_take_speeds(void *ctx, const char *text)
{
    struct bilateral_options *o = ctx;
    o->speeds = 0;
    for (const char *at = text; at != NULL;) {
        const char *comma = strchr(at, ',');
        const size_t len = comma ? (size_t)(comma - at) : strlen(at);
        struct bilateral_speed *s = &o->speed[o->speeds];
        char *end;
        if (len == 0 || len >= BILATERAL_NAME_B || o->speeds == BILATERAL_SPEEDS_MAX) {
            return bad_speeds(text);
        }
        memset(s->name, 0, sizeof s->name);
        memcpy(s->name, at, len);
        s->mps = sim_path_speed(s->name);
        if (s->mps <= 0) {
            s->mps = strtod(s->name, &end);
            if (*end != '\0' || !(s->mps >= 0.001 && s->mps <= 3)) { return bad_speeds(text); }
        }
        o->speeds++;
        at = comma ? comma + 1 : NULL;
    }
    return 0;
}

int bilateral_take_fingers(void *ctx, const char *text)
{
    struct bilateral_options *o = ctx;
    unsigned mask = 0;
    for (const char *at = text; at != NULL;) {
        const char *comma = strchr(at, ',');
        const size_t len = comma ? (size_t)(comma - at) : strlen(at);
        unsigned hit = len == 3 && strncmp(at, "all", 3) == 0 ? 31u : 0;
        for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
            const char *name = bilateral_finger_name[f];
            if (strlen(name) == len && strncmp(at, name, len) == 0) { hit |= 1u << f; }
        }
        if (hit == 0) {
            cli_complain(
                "--fingers: %s: give all, or some of thumb, index, middle, ring, little, commas "
                "between",
                text);
            return 2;
        }
        if (mask & hit) {
            cli_complain("--fingers: %.60s: one comes twice: name each once", text);
            return 2;
        }
        mask |= hit;
        at = comma ? comma + 1 : NULL;
    }
    o->run.board.exo.fingers = mask;
    return 0;
}

int hand_bad_pose(const char *text)
{
    struct near n = near_to(text, strlen(text));
    char mean[NEAR_B], all[512] = "";
    for (int i = 0; i < sim_poses; i++) {
        const size_t at = strlen(all);
        near_try(&n, sim_pose[i].name);
        (void)snprintf(all + at, sizeof all - at, "%s%s", i ? ", " : "", sim_pose[i].name);
    }
    cli_complain(
        "--pose: %.60s: no such pose%s: give one of %s", text, near_text(mean, &n, ""), all);
    return 2;
}

/* The hand where no finger in use bends it. */
int bilateral_take_pose(void *ctx, const char *text)
{
    struct bilateral_options *o = ctx;
    const int pose = sim_pose_find(text);
    if (pose >= 0) {
        o->run.board.hand.pose = pose;
        return 0;
    }
    return hand_bad_pose(text);
}

int bilateral_take_setting(void *ctx, const char *text)
{
    struct bilateral_options *o = ctx;
    char name[ASSIGN_NAME_B];
    double value;
    if (assign_split("set", text, name, &value)) { return 2; }
    if (o->settings == BILATERAL_SETTINGS_MAX || strncmp(name, "cal_", 4) == 0 ||
        strcmp(name, "fingers") == 0) {
        cli_complain(
            "--set: %s: not here: --fingers says which, the glove is calibrated, and there may be "
            "%d settings",
            text, BILATERAL_SETTINGS_MAX);
        return 2;
    }
    exh_scene_bilateral.defaults();
    if (cli_param_set_by(exh_scene_bilateral.params, "--set: ", name, value) < 0) { return 2; }
    o->setting[o->settings++] = (struct run_setting){
        cli_signal_find(exh_scene_bilateral.params->table, name, NULL)->name, value};
    return 0;
}

/* The name of a row of the fingers, their paths, the glove's chain or the motor's device. */
static int set_device(
    struct bilateral_options *o, const char *name, double value, const struct sim_device_row **row)
{
    struct sim_exo_par *e = &o->run.board.exo;
    int err = sim_finger_set(&e->finger[0], name, value, row);
    for (unsigned f = 1; err == 0 && f < BILATERAL_FINGERS; f++) { e->finger[f] = e->finger[0]; }
    if (err == 0 || *row) { return err; }
    err = sim_path_set(&e->path[0], name, value, row);
    for (unsigned f = 1; err == 0 && f < BILATERAL_FINGERS; f++) { e->path[f] = e->path[0]; }
    if (err == 0 || *row) { return err; }
    err = sim_glove_set(&o->run.board.glove_par, name, value, row);
    return err == 0 || *row ? err : sim_device_set(&o->run.board.device, name, value, row);
}

int bilateral_take_device(void *ctx, const char *text)
{
    const struct sim_device_row *row = NULL;
    char name[ASSIGN_NAME_B];
    double value;
    if (assign_split("device", text, name, &value)) { return 2; }
    if (strcmp(name, "speed") == 0 || strcmp(name, "approaches") == 0 ||
        strcmp(name, "believed") == 0) {
        cli_complain("--device: %s: give --speed, --approaches or --at", name);
        return 2;
    }
    return set_device(ctx, name, value, &row) == 0 ? 0
                                                   : assign_refused("bilateral", name, value, row);
}

static void print_rows(const char *title, const struct sim_device_row *row, int n)
{
    printf("\n%s\n", title);
    for (int i = 0; i < n; i++) {
        printf("  %-15s %-8s %12.9g  %12.9g .. %-12.9g %-7s %s\n", row[i].name,
            names_unit(row[i].unit), row[i].value, row[i].min, row[i].max, row[i].sure,
            row[i].help);
    }
}

int bilateral_print_params(const struct bilateral_options *o)
{
    const struct bilateral_run_cfg c = bilateral_at_speed(o, o->speed[0].mps);
    const struct exh_params *p = exh_scene_bilateral.params;
    if (bilateral_stage(&c) < 0) { return 2; }
    printf("Parameters of the scene (--set NAME=VALUE, of all fingers)\n");
    cli_signal_print(stdout, p->table, p->staged);
    print_rows("A finger (--device NAME=VALUE, all of them)", sim_finger_row, sim_finger_rows);
    print_rows("What it does", sim_path_row, sim_path_rows);
    print_rows("The glove's chain", sim_glove_row, sim_glove_rows);
    print_rows("The motor's device", sim_device_row, sim_device_rows);
    print_rows("The network (--link NAME=VALUE, both ways)", sim_link_row, sim_link_rows);
    return 0;
}
