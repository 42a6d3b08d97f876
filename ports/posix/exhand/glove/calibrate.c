/* SPDX-License-Identifier: MIT */
/* exhand calibrate --glove: a user's calibration of the glove, from poses. */
#include "base/names.h"
#include "base/cli.h"

#include "base/assign.h"
#include "box/glove_image.h"
#include "glove/result.h"
#include "base/option.h"
#include "base/outfile.h"

#include "exhand/error.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define DAY_S    86400
#define RAIL_RAW 32000 /* beyond: no code of a hand */

struct poses_options {
    int64_t user, id, day, valid_days, sensors, move_raw, noise_raw;
    double residual_deg;
    const char *poses, *columns, *scale, *out, *check;
    struct glove_bench bench;
};

/* The results, for printing and writing. */
/* --- options with their own syntax --- */

static int take_fault(void *ctx, const char *text)
{
    static const struct {
        const char *name;
        unsigned char fault;
    } kind[] = {{"open", SIM_GLOVE_OPEN}, {"short", SIM_GLOVE_SHORT}, {"stuck", SIM_GLOVE_STUCK}};
    struct poses_options *o = ctx;
    const char *equals = strchr(text, '=');
    const size_t len = equals ? (size_t)(equals - text) : 0;
    for (unsigned i = 0; equals != NULL && i < EXH_GLOVE_SENSORS; i++) {
        const char *sensor = exh_glove_sensor_text(i);
        for (size_t k = 0; k < sizeof kind / sizeof kind[0]; k++) {
            if (strlen(sensor) == len && strncmp(text, sensor, len) == 0 &&
                strcmp(equals + 1, kind[k].name) == 0) {
                o->bench.fault[i] = kind[k].fault;
                return 0;
            }
        }
    }
    cli_complain("--wrong: %s: give SENSOR=open, short or stuck: `exhand calibrate --glove "
                 "--params` lists the "
                 "sensors",
        text);
    return 2;
}

static int take_device(void *ctx, const char *text)
{
    struct poses_options *o = ctx;
    const struct sim_device_row *row;
    char name[ASSIGN_NAME_B];
    double value;
    if (assign_split("device", text, name, &value)) { return 2; }
    if (sim_glove_set(&o->bench.par, name, value, &row) == 0) { return 0; }
    return assign_refused("calibrate --glove", name, value, row);
}

static void print_params(void)
{
    printf("The simulated glove and its card (--device NAME=VALUE)\n");
    for (int i = 0; i < sim_glove_rows; i++) {
        const struct sim_device_row *r = &sim_glove_row[i];
        printf("  %-13s %-8s %12.7g  %12.7g .. %-12.7g %-8s %s\n", r->name, names_unit(r->unit),
            r->value, r->min, r->max, r->sure, r->help);
    }
    printf("\nIts sensors, in the order of the codes (--wrong SENSOR=open, short or stuck)\n");
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        printf("  %2u %s\n", i, exh_glove_sensor_text(i));
    }
}

/* --- an image that is there --- */

static int refused(const char *path, int err, const struct exh_glove_error *bad)
{
    const int of_sensor = bad->what >= EXH_GLOVE_GAIN;
    cli_complain("%s: %s%s%s: %s: calibrate again", path, exh_glove_error_text(bad->what),
        of_sensor ? " of " : "", of_sensor ? exh_glove_sensor_text(bad->at) : "",
        exh_error_text(err));
    return 1;
}

/* A valid image that may not be used: prints its user, and the present one. */
static int not_here(const struct poses_options *o, const struct exh_glove_cal *c, int err,
    const struct exh_glove_error *bad)
{
    if (bad->what == EXH_GLOVE_USER) {
        cli_complain("%s: made for user %" PRIu32 ", this is %" PRId64
                     ": give their --user, or calibrate this one",
            o->check, c->user_id, o->user);
    } else if (bad->what == EXH_GLOVE_GLOVE) {
        cli_complain("%s: made for glove %" PRIu32 ", this is %" PRId64
                     ": give its --id, or calibrate this one",
            o->check, c->glove_id, o->id);
    } else if (bad->what == EXH_GLOVE_AGE && (uint32_t)o->day < c->day) {
        cli_complain("%s: from the future: made on day %" PRIu32 ", today is day %" PRId64
                     ": set the clock right, "
                     "or give --day",
            o->check, c->day, o->day);
    } else if (bad->what == EXH_GLOVE_AGE) {
        cli_complain("%s: stale: made on day %" PRIu32 ", good for %" PRIu32
                     " days, today is day %" PRId64 ": calibrate again",
            o->check, c->day, c->valid_days, o->day);
    } else {
        return refused(o->check, err, bad);
    }
    return 1;
}

static int check_image(const struct poses_options *o)
{
    struct exh_glove_cal c;
    struct exh_glove_error bad = {0, 0};
    uint8_t image[EXH_GLOVE_CAL_IMAGE_B];
    const long len = outfile_read("check", o->check, IMAGE_WANTED, image, sizeof image);
    int err;
    if (len < 0) { return (int)-len; }
    err = exh_glove_cal_load(&c, image, (size_t)len, &bad);
    if (err < 0) { return refused(o->check, err, &bad); }
    printf("%s: user %" PRIu32 ", glove %" PRIu32 ", made on day %" PRIu32 ", good for %" PRIu32
           " days; today is day %" PRId64 "\n",
        o->check, c.user_id, c.glove_id, c.day, c.valid_days, o->day);
    fflush(stdout);
    err = exh_glove_cal_check(&c, (uint32_t)o->user, (uint32_t)o->id, (uint32_t)o->day, &bad);
    if (err < 0) { return not_here(o, &c, err, &bad); }
    glove_cal_print(&c);
    return 0;
}

/* --- a calibration --- */

static int at_rail(const struct glove_result *r, unsigned sensor)
{
    for (unsigned p = 0; p < r->poses; p++) {
        const int32_t raw_q16 = r->pose[p].mean_raw_q16[sensor];
        if (raw_q16 > -RAIL_RAW * 65536 && raw_q16 < RAIL_RAW * 65536) { return 0; }
    }
    return r->poses > 0;
}

/* One line for each sensor that did not come out. */
static void say_bad(const struct poses_options *o, const struct glove_result *r, unsigned i)
{
    const struct exh_glove_fit *f = &r->fit[i];
    const char *name = exh_glove_sensor_text(i), *pose = glove_pose_name(r->which[f->pose]);
    const char *what = exh_glove_error_text(f->what);
    if (at_rail(r, i)) {
        cli_complain("%s: at the end of the card in every pose: open or short: mend its wire, and "
                     "calibrate again",
            name);
    } else if (f->what == EXH_GLOVE_MOVE) {
        cli_complain("%s: %s: under %" PRId64 " codes: take the poses as told, or see to its wire",
            name, what, o->move_raw);
    } else if (f->what == EXH_GLOVE_NOISE) {
        cli_complain("%s: %s: %" PRId32 " codes in pose %s (allowed 0..%" PRId64
                     "): hold still, and calibrate again",
            name, what, r->pose[f->pose].noise_raw[i], pose, o->noise_raw);
    } else if (f->what == EXH_GLOVE_RESIDUAL) {
        cli_complain(
            "%s: %s: %.2f deg in pose %s (allowed 0..%.4g): take that pose again, or --residual",
            name, what, f->residual_turn_q32 * DEG_OF_TURN_Q32, pose, o->residual_deg);
    } else if (f->what == EXH_GLOVE_POSES) {
        cli_complain("%s: %s: %d say its angle, too few or too much alike: take all that `exhand "
                     "calibrate --glove "
                     "--list` lists",
            name, what, f->poses);
    } else if (f->what == EXH_GLOVE_CROSS) {
        cli_complain(
            "%s: %s: beyond +-2, or of a sensor that did not come out: see to that one first", name,
            what);
    } else {
        cli_complain(
            "%s: %s: implausible: see that it is worn right, and calibrate again", name, what);
    }
}

/* An abduction between two fingers is bent by both knuckles, the thumb's by its rotation;
 * an 18-sensor glove lacks the last joints, which follow the middle ones by two thirds. */
static void topology(struct glove_result *r, const struct poses_options *o)
{
    static const struct {
        uint8_t sensor, of[2];
    } bent[] = {{EXH_GLOVE_THUMB_AB, {EXH_GLOVE_THUMB_ROTATE, EXH_GLOVE_NONE}},
        {EXH_GLOVE_MIDDLE_INDEX_AB, {EXH_GLOVE_INDEX_MPJ, EXH_GLOVE_MIDDLE_MPJ}},
        {EXH_GLOVE_RING_MIDDLE_AB, {EXH_GLOVE_MIDDLE_MPJ, EXH_GLOVE_RING_MPJ}},
        {EXH_GLOVE_LITTLE_RING_AB, {EXH_GLOVE_RING_MPJ, EXH_GLOVE_LITTLE_MPJ}}};
    static const uint8_t last[] = {
        EXH_GLOVE_INDEX_DIJ, EXH_GLOVE_MIDDLE_DIJ, EXH_GLOVE_RING_DIJ, EXH_GLOVE_LITTLE_DIJ};
    r->cal.present = (1u << EXH_GLOVE_SENSORS) - 1u;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        r->cal.sensor[i].of[0] = r->cal.sensor[i].of[1] = EXH_GLOVE_NONE;
    }
    for (size_t k = 0; k < sizeof bent / sizeof bent[0]; k++) {
        memcpy(r->cal.sensor[bent[k].sensor].of, bent[k].of, sizeof bent[k].of);
    }
    for (size_t k = 0; o->sensors == 18 && k < sizeof last; k++) {
        r->cal.present &= ~(1u << last[k]);
        r->cal.sensor[last[k]].of[0] = (uint8_t)(last[k] - 1);
        r->cal.sensor[last[k]].cross_q30[0] = EXH_Q(2, 3, 30);
    }
    r->present = r->cal.present;
}

static int calibrate(const struct poses_options *o)
{
    static struct glove_result r;
    const struct exh_glove_fit_par par = {
        (int32_t)o->move_raw, (int32_t)o->noise_raw, (int32_t)(o->residual_deg / DEG_OF_TURN_Q32)};
    struct exh_glove_error bad;
    int err;
    memset(&r, 0, sizeof r);
    if (o->out != NULL && outfile_dir(o->out, "poses.csv") != 0) { return 2; }
    if (o->poses != NULL) {
        err = o->columns ? glove_poses_read_columns(&r.taken, o->poses, o->columns, o->scale)
                         : glove_poses_read(&r.taken, o->poses);
        if (err) { return err; }
    } else {
        glove_poses_take(&r.taken, &o->bench, stdout);
    }
    topology(&r, o);
    r.cal.user_id = (uint32_t)o->user;
    r.cal.glove_id = (uint32_t)o->id;
    r.cal.day = (uint32_t)o->day;
    r.cal.valid_days = (uint32_t)o->valid_days;
    r.poses = glove_poses_fit(r.pose, r.which, &r.taken);
    if (r.poses < 2) {
        cli_complain("%u poses: two or more are needed", r.poses);
        return 1;
    }
    err = exh_glove_cal_fit(&r.cal, r.fit, r.pose, r.poses, &par, &bad);
    glove_result_print(&r);
    fflush(stdout);
    if (err < 0) {
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            if (r.fit[i].what != EXH_GLOVE_ERRORS) { say_bad(o, &r, i); }
        }
        return 1;
    }
    return o->out != NULL ? glove_result_write(o->out, &r) : 0;
}

static void defaults(struct poses_options *o)
{
    memset(o, 0, sizeof *o); /* a test calls more than once */
    o->user = o->id = o->bench.seed = 1;
    o->valid_days = 90;
    o->sensors = 22;
    o->move_raw = exh_glove_fit_default.move_min_raw;
    o->noise_raw = exh_glove_fit_default.noise_max_raw;
    o->residual_deg = exh_glove_fit_default.residual_max_turn_q32 * DEG_OF_TURN_Q32;
    o->day = (int64_t)(time(NULL) / DAY_S);
    o->bench.par = sim_glove_default();
    o->bench.rate_Hz = 1000;
    o->bench.frames = 200;
    o->bench.miss_deg = 1;
}

int cli_calibrate_glove(int argc, char **argv)
{
    static struct poses_options o;
    struct cli_call fault = {take_fault, &o}, device = {take_device, &o};
    int glove, list = 0, params = 0, err;
    const struct cli_option option[] = {
        {"glove", CLI_FLAG, &glove, 0, 0, NULL, "the glove, not a finger's motor"},
        {"poses", CLI_TEXT, &o.poses, 0, 0, "FILE",
            "recorded: CSV of pose,22 codes; - standard input"},
        {"columns", CLI_TEXT, &o.columns, 0, 0, "LIST",
            "its columns, of `exhand glove --help`; label=C is the pose"},
        {"scale", CLI_TEXT, &o.scale, 0, 0, "A[,B]", "with --columns: A times its number and B"},
        {"list", CLI_FLAG, &list, 0, 0, NULL, "the poses and what to do in each"},
        {"sensors", CLI_INT, &o.sensors, 18, 22, "N",
            "of the glove: 18 (no last joints) or 22 (22)"},
        {"out", CLI_TEXT, &o.out, 0, 0, "DIR",
            "write " IMAGE_NAME ", glove.csv and poses.csv there"},
        {"check", CLI_TEXT, &o.check, 0, 0, "FILE",
            "only check whether this image is valid here today"},
        {"user", CLI_INT, &o.user, 0, 4294967295.0, "N", "whose hand (1)"},
        {"id", CLI_INT, &o.id, 0, 4294967295.0, "N", "of the glove (1)"},
        {"day", CLI_INT, &o.day, 0, 4294967295.0, "N", "today, in days since 1970 (the clock's)"},
        {"valid", CLI_INT, &o.valid_days, 0, 36525, "DAYS", "days until it expires (90)"},
        {"move", CLI_INT, &o.move_raw, 64, 65535, "CODES", "a sensor moves by that at least (256)"},
        {"noise", CLI_INT, &o.noise_raw, 0, 65535, "CODES", "peak to peak in a pose at most (128)"},
        {"residual", CLI_REAL, &o.residual_deg, 0, 90, "DEG", "no pose farther from the line (6)"},
        {"rate", CLI_REAL, &o.bench.rate_Hz, 1, 20000, "HZ",
            "of the simulated glove's frames (1000)"},
        {"frames", CLI_INT, &o.bench.frames, 1, 100000, "N", "taken in each pose (200)"},
        {"miss", CLI_REAL, &o.bench.miss_deg, 0, 20, "DEG",
            "by how much the simulated person misses each angle (1)"},
        {"seed", CLI_INT, &o.bench.seed, 0, 1e9, "N", "random seed of the simulation (1)"},
        {"device", CLI_CALL, &device, 0, 0, "NAME=VALUE", "a value of the simulated glove"},
        {"wrong", CLI_CALL, &fault, 0, 0, "SENSOR=KIND",
            "a fault of the simulated glove: open, short, stuck"},
        {"params", CLI_FLAG, &params, 0, 0, NULL, "list these values and sensors"},
    };
    const struct cli_command c = {"calibrate --glove", "[options]",
        "Offset, gain and cross-coupling of each sensor for one user, "
        "from poses with known angles.",
        option, (int)(sizeof option / sizeof option[0]), 0};

    defaults(&o);
    err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (o.sensors != 18 && o.sensors != 22) {
        cli_complain("--sensors: %" PRId64 ": give 18 or 22", o.sensors);
        return 2;
    }
    if ((o.columns && !o.poses) || (o.scale && !o.columns)) {
        cli_complain("--columns goes with --poses, --scale with --columns");
        return 2;
    }
    if (list) { glove_poses_print(stdout); }
    if (params) { print_params(); }
    if (list || params) { return 0; }
    return o.check ? check_image(&o) : calibrate(&o);
}
