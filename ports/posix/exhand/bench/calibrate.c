/* SPDX-License-Identifier: MIT */
/* exhand calibrate: the paper's first step, on the simulated device's bench. */
#include "base/cli.h"

#include "base/assign.h"
#include "bench/calibrate.h"
#include "base/option.h"
#include "base/until.h"
#include "base/outfile.h"
#include "base/param.h"

#include "calibrate/calibrate.h"

#include "exhand/error.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define DAY_S 86400

static const struct {
    const char *name, *what;
    unsigned bit;
} wrong[] = {
    {"motor_reversed", "the motor's leads are exchanged", BENCH_MOTOR_REVERSED},
    {"encoder_reversed", "the encoder's lines are exchanged", BENCH_ENCODER_REVERSED},
    {"stuck", "the rotor does not turn", BENCH_STUCK},
    {"caught", "the string is caught on its way home", BENCH_CAUGHT},
    {"endless", "nothing stops the string at its end", BENCH_ENDLESS},
    {"no_mass", "nothing hangs on the string", BENCH_NO_MASS},
    {"fixed_mass", "the mass on the string is fixed", BENCH_FIXED_MASS},
    {"pulled", "a person pulls the slack string", BENCH_PULLED},
};
#define WRONGS (sizeof wrong / sizeof wrong[0])

/* --- options with a syntax of their own --- */

/* Up to CALIBRATE_MASSES of them, kg. How many, or 0 after a line on stderr. */
static int masses(const char *option, const char *text, double *kg, int rising)
{
    char *end = NULL;
    int n = 0;
    do {
        const char *from = end ? end + 1 : text;
        const double v = strtod(from, &end);
        if (n == CALIBRATE_MASSES || end == from || !(v >= 0.001 && v <= 5) ||
            (rising && n > 0 && v <= kg[n - 1]) || (*end != ',' && *end != '\0')) {
            cli_complain("--%s: %s (0.001..5 kg%s, commas between, at most %d): e.g. --%s 0.1,0.5",
                option, text, rising ? ", rising" : "", CALIBRATE_MASSES, option);
            return 0;
        }
        kg[n++] = v;
    } while (*end == ',');
    return n;
}

static int take_masses(void *ctx, const char *text)
{
    struct calibrate_options *o = ctx;
    o->masses = masses("mass", text, o->mass_kg, 1);
    if (o->masses == 1) { /* any one point lies on its own line: nothing would be checked */
        cli_complain(
            "--mass: %s: one mass alone can't be checked against a line: give two or more", text);
        return 2;
    }
    return o->masses ? 0 : 2;
}

static int take_hung(void *ctx, const char *text)
{
    struct calibrate_options *o = ctx;
    o->hung = masses("hung", text, o->hung_kg, 0);
    return o->hung ? 0 : 2;
}

static int take_setting(void *ctx, const char *text)
{
    struct calibrate_options *o = ctx;
    char name[ASSIGN_NAME_B];
    double value;
    if (assign_split("set", text, name, &value)) { return 2; }
    if (o->settings == CALIBRATE_SETTINGS_MAX) {
        cli_complain("--set: at most %d", CALIBRATE_SETTINGS_MAX);
        return 2;
    }
    if (strcmp(name, "go") == 0) {
        cli_complain("--set: go: it is the person's word, at each step: it can't be given before");
        return 2;
    }
    if (strcmp(name, "mass") == 0) {
        cli_complain("--set: mass: give --mass");
        return 2;
    }
    exh_scene_calibrate.defaults();
    if (cli_param_set_by(exh_scene_calibrate.params, "--set: ", name, value) < 0) { return 2; }
    o->setting[o->settings++] = (struct calibration_setting){
        cli_signal_find(exh_scene_calibrate.params->table, name, NULL)->name, value};
    return 0;
}

static int take_device(void *ctx, const char *text)
{
    struct calibrate_options *o = ctx;
    return assign_device(&o->device, "calibrate", text);
}

static int take_wrong(void *ctx, const char *text)
{
    struct calibrate_options *o = ctx;
    for (size_t i = 0; i < WRONGS; i++) {
        if (strcmp(wrong[i].name, text) == 0) {
            o->wrong |= wrong[i].bit;
            return 0;
        }
    }
    cli_complain("--wrong: %s (one of those that `exhand calibrate --params` lists)", text);
    return 2;
}

static void print_params(void)
{
    exh_scene_calibrate.defaults();
    printf("Parameters of the scene (--set NAME=VALUE; f_max and slew in A for N: there is no "
           "table yet)\n");
    cli_signal_print(stdout, exh_scene_calibrate.params->table, NULL);
    printf("\nThe simulated device (--device NAME=VALUE); step and the scales are known to the "
           "scene\n");
    for (int i = 0; i < sim_device_rows; i++) {
        const struct sim_device_row *r = &sim_device_row[i];
        printf("  %-13s %-8s %12.7g  %12.7g .. %-12.7g %-8s %s\n", r->name, r->unit, r->value,
            r->min, r->max, r->sure, r->help);
    }
    printf("\nWhat may be wrong at the bench (--wrong NAME)\n");
    for (size_t i = 0; i < WRONGS; i++) { printf("  %-17s %s\n", wrong[i].name, wrong[i].what); }
}

/* --- files --- */

struct results {
    const struct exh_calib *c;
    const struct calibration_lines *l;
    uint8_t image[EXH_CALIB_IMAGE_B];
    size_t image_B;
};

static void write_image(FILE *f, const void *ctx)
{
    const struct results *r = ctx;
    (void)fwrite(r->image, 1, r->image_B, f);
}

static void write_points(FILE *f, const void *ctx)
{
    const struct results *r = ctx;
    calibration_csv(f, r->c, r->l);
}

static void write_table(FILE *f, const void *ctx)
{
    const struct results *r = ctx;
    (void)calibration_table_csv(f, r->c); /* there is one: the image was saved */
}

static void write_pictures(FILE *f, const void *ctx)
{
    const struct results *r = ctx;
    outfile_pictures(f, "calibrate");
    fprintf(f,
        "out='calibration.png'; points='calibration.csv'; table='table.csv'\n"
        "kf=%.9g; kf_mon=%.9g\nload plots.'/calibration.gp'\n",
        (double)r->l->cur.kf_NpA_q20 / (1 << EXH_Q_FORCE),
        (double)r->l->mon.kf_NpA_q20 / (1 << EXH_Q_FORCE));
}

/* All of them or the first that fails. 0, or 1 after a line on stderr. */
static int write_files(
    const char *dir, const struct exh_calib *c, const struct calibration_lines *l)
{
    static const struct {
        const char *name;
        void (*write)(FILE *f, const void *ctx);
    } file[] = {{"calibration.bin", write_image}, {"calibration.csv", write_points},
        {"table.csv", write_table}, {"pictures.gp", write_pictures}};
    struct results r = {.c = c, .l = l};
    struct exh_calib_error bad = {0, 0};
    const int32_t len = exh_calib_save(c, r.image, sizeof r.image, &bad);
    if (len < 0) { return calibrate_complain("calibration.bin", len, &bad); }
    r.image_B = (size_t)len;
    for (size_t i = 0; i < sizeof file / sizeof file[0]; i++) {
        if (outfile_write(dir, file[i].name, file[i].write, &r) != 0) { return 1; }
    }
    return 0;
}

/* --- a calibration --- */

/* What was judged good, kept. */
static int finish(const struct calibrate_options *o, struct calibration *r)
{
    struct calibration_lines l;
    if (calibrate_judge(o, r, &l) != 0) { return 1; }
    if (posix_interrupted()) {
        cli_complain("interrupted before it was written: nothing was saved");
        return 130;
    }
    if (o->out != NULL && write_files(o->out, &r->c, &l) != 0) { return 1; }
    printf("for the drop experiment, straight: exhand drop --set kf=%.6g --set f0=%.4g\n",
        (double)l.cur.kf_NpA_q20 / (1 << EXH_Q_FORCE), l.f0_N);
    return 0;
}

static void say_failure(const struct calibrate_options *o, const struct calibration *r)
{
    const unsigned mass = r->step - CALIBRATE_MASS; /* wraps for the others */
    char which[24] = "", why[CALIBRATION_WHY_B];
    if (mass < (unsigned)o->masses) { snprintf(which, sizeof which, " %.4g kg", o->mass_kg[mass]); }
    calibration_why(why, r);
    cli_complain(
        "%s%s: %s after %.2f s at up to %.1f mA, %.1f mm: stopped, no current; put it right and "
        "calibrate again",
        calibrate_step_text(r->step), which, why, r->last_s, r->last_most_A * 1e3,
        r->last_travel_m * 1e3);
}

static int calibrate(const struct calibrate_options *o)
{
    static struct calibration r;
    struct calibration_cfg c;
    int err;
    memset(&c, 0, sizeof c);
    c.rate_Hz = (uint32_t)o->rate_Hz;
    c.mass_kg = o->mass_kg;
    c.hung_kg = o->hung ? o->hung_kg : NULL;
    c.masses = o->masses;
    c.setting = o->setting;
    c.settings = o->settings;
    c.progress = stdout;
    c.board = posix_config_default();
    c.board.device = o->device;
    c.board.seed = (uint64_t)o->seed;
    c.board.pace = o->pace;
    c.board.cards.how = o->cards ? POSIX_CARDS_INSTANT : POSIX_CARDS_NONE;
    c.board.wrong = o->wrong;
    if (o->out != NULL && outfile_dir(o->out, "calibration.bin") != 0) { return 2; }
    until_catch(UNTIL_RESTARTS);
    err = calibration_run(&c, &r);
    fflush(stdout); /* the steps before what is said of them */
    if (err < 0) { return err == -EXH_E_STATE ? 130 : 2; }
    if (r.result != EXH_PROBE_DONE) {
        say_failure(o, &r);
        return 1;
    }
    r.c.device_id = (uint32_t)o->id;
    r.c.finger = (uint32_t)o->finger;
    r.c.day = (uint32_t)o->day;
    r.c.valid_days = (uint32_t)o->valid_days;
    return finish(o, &r);
}

/* The lightest mass on the string decides. */
static int steps_too_long(struct calibrate_options *o)
{
    struct sim_device d = o->device;
    int err;
    for (int i = 0; i < o->masses; i++) {
        if (o->mass_kg[i] < d.mass_kg) { d.mass_kg = o->mass_kg[i]; }
    }
    err = assign_step(&d, 0, 0);
    o->device.substep_s = d.substep_s;
    return err;
}

static void defaults(struct calibrate_options *o)
{
    static const double mass_kg[] = {0.1, 0.2, 0.3, 0.5, 0.7};
    memset(o, 0, sizeof *o); /* a test calls more than once */
    o->rate_Hz = 2000;
    o->seed = o->id = 1;
    o->valid_days = 90;
    o->residual_N = 0.1;
    o->day = (int64_t)(time(NULL) / DAY_S);
    o->device = sim_device_default();
    o->masses = (int)(sizeof mass_kg / sizeof mass_kg[0]);
    memcpy(o->mass_kg, mass_kg, sizeof mass_kg);
}

int cli_calibrate(int argc, char **argv)
{
    static struct calibrate_options o;
    int list = 0, glove = 0, err; /* --glove is handled by cli_calibrate_glove() */
    struct cli_call known = {take_masses, &o}, setting = {take_setting, &o};
    struct cli_call device = {take_device, &o}, fault = {take_wrong, &o};
    struct cli_call hung = {take_hung, &o};
    const struct cli_option option[] = {
        {"glove", CLI_FLAG, &glove, 0, 0, NULL,
            "the glove, from poses: --glove --help lists its options"},
        {"mass", CLI_CALL, &known, 0, 0, "KG[,KG...]",
            "known masses, rising (0.1,0.2,0.3,0.5,0.7)"},
        {"hung", CLI_CALL, &hung, 0, 0, "KG[,KG...]",
            "the true masses, as many, to simulate a mistake (the same)"},
        {"rate", CLI_INT, &o.rate_Hz, 20, 20000, "HZ", "loop rate (2000)"},
        {"out", CLI_TEXT, &o.out, 0, 0, "DIR", "write image, CSVs and a picture's script there"},
        {"check", CLI_TEXT, &o.check, 0, 0, "FILE",
            "only check whether this image is valid here today"},
        {"residual", CLI_REAL, &o.residual_N, 0, 100, "N",
            "largest distance of a point from the line (0.1)"},
        {"id", CLI_INT, &o.id, 0, 4294967295.0, "N", "of the device (1)"},
        {"finger", CLI_INT, &o.finger, 0, EXH_FINGERS - 1, "N", "thumb 0 .. little 4 (0)"},
        {"day", CLI_INT, &o.day, 0, 4294967295.0, "N", "today, in days since 1970 (the clock's)"},
        {"valid", CLI_INT, &o.valid_days, 0, EXH_CALIB_VALID_MAX_DAYS, "DAYS",
            "days until it expires (90)"},
        {"seed", CLI_INT, &o.seed, 0, 1e9, "N", "random seed of the simulation (1)"},
        {"cards", CLI_FLAG, &o.cards, 0, 0, NULL,
            "through the drivers and emulated cards; results do not change"},
        {"pace", CLI_FLAG, &o.pace, 0, 0, NULL, "run in real time"},
        {"set", CLI_CALL, &setting, 0, 0, "NAME=VALUE", "a parameter of the scene"},
        {"device", CLI_CALL, &device, 0, 0, "NAME=VALUE", "a value of the simulated device"},
        {"wrong", CLI_CALL, &fault, 0, 0, "NAME", "a mistake at the bench"},
        {"params", CLI_FLAG, &list, 0, 0, NULL, "list these three, with units and ranges"},
    };
    const struct cli_command c = {"calibrate", "[options]",
        "Polarity, home, F0, then masses: tables from force to current and from monitor to force.",
        option, (int)(sizeof option / sizeof option[0]), 0};

    defaults(&o);
    err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (list) {
        print_params();
        return 0;
    }
    if (o.hung != 0 && o.hung != o.masses) {
        cli_complain("--hung: %d masses (as many as --mass: %d): give that many", o.hung, o.masses);
        return 2;
    }
    return o.check ? calibrate_check(&o) : steps_too_long(&o) ? 2 : calibrate(&o);
}
