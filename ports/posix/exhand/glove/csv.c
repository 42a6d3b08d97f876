/* SPDX-License-Identifier: MIT */
/* exhand glove --csv: a recording through the glove's modules, as angles. */
#include "glove/modes.h"

#include "base/option.h"
#include "base/param.h"

#include "exhand/error.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SENSORS EXH_GLOVE_SENSORS
#define PI      3.14159265358979323846

struct exh_period glove_period(double rate_Hz)
{
    return (struct exh_period){1000, (uint32_t)(rate_Hz * 1000 + 0.5)};
}

/* --- parameters --- */

int glove_ready(const struct glove_options *o, struct glove_par *par, struct glove_cfg *cfg,
    struct exh_period T)
{
    struct exh_params *p = exh_scene_glove.params;
    const double rate_Hz = (double)T.den / T.num;
    int err;
    memcpy(par, p->staged, sizeof *par);
    if (!o->fc_given && par->glove.order > 0 && par->glove.fc_Hz_q16 / 65536.0 > rate_Hz / 4) {
        par->glove.fc_Hz_q16 = (int32_t)(rate_Hz / 4 * 65536);
        cli_complain("at %.6g Hz the low-pass is at %.6g Hz: --set glove_fc=... says another",
            rate_Hz, par->glove.fc_Hz_q16 / 65536.0);
    }
    err = glove_setup(cfg, par, T);
    if (err < 0) {
        cli_complain("%.6g Hz with these parameters: %s: see --rate and --set", rate_Hz,
            exh_error_text(err));
        return 2;
    }
    return 0;
}

/* --- angles backwards to codes --- */

/* Codes that a calibrated glove gives at these angles, not rounded. */
static void codes_of(
    const struct exh_glove_cal *cal, const double rad[SENSORS], double code[SENSORS])
{
    for (int i = 0; i < SENSORS; i++) {
        const struct exh_glove_sensor *s = &cal->sensor[i];
        double turn = rad[i] / (2 * PI);
        for (int k = 0; k < 2; k++) {
            if (s->of[k] != EXH_GLOVE_NONE) {
                turn -= s->cross_q30[k] / 1073741824.0 * rad[s->of[k]] / (2 * PI);
            }
        }
        code[i] = s->zero_raw_q15 / 32768.0 + turn / (s->gain_turnpraw_q38 / 274877906944.0);
    }
}

/* Nearest, limited; 1 if it was. */
static int code_of(double v, int16_t *to)
{
    const int beyond = v > 32767.5 || v < -32768.5;
    *to = (int16_t)(v > 32767 ? 32767 : v < -32768 ? -32768 : v < 0 ? v - 0.5 : v + 0.5);
    return beyond;
}

/* One code is 2^-16 turn, up to 170 degrees either way. */
static void stage_plain(void)
{
    static struct exh_glove_cal cal;
    cal = exh_glove_cal_default;
    for (int i = 0; i < SENSORS; i++) {
        cal.sensor[i] = (struct exh_glove_sensor){
            0, 1 << (38 - 16), {0, 0}, -31000, 31000, {EXH_GLOVE_NONE, EXH_GLOVE_NONE}};
    }
    (void)glove_stage_cal(&cal, NULL);
}

static void staged_cal(struct exh_glove_cal *cal)
{
    static struct glove_par par;
    memcpy(&par, exh_scene_glove.params->staged, sizeof par);
    glove_cal_of_par(cal, &par);
}

/* Rows to codes; how many were beyond the codes there are. No number has a rail's code, so that its
 * channel has the fault; to a neighbour that it pulls along it is what it was before. */
static long take_rows(struct glove_frames *f, const struct recording *r)
{
    static struct exh_glove_cal cal;
    double held[SENSORS] = {0};
    long beyond = 0;
    staged_cal(&cal);
    for (long n = 0; n < r->rows; n++) {
        const double *row = r->row[n];
        double code[SENSORS];
        for (int i = 0; i < SENSORS; i++) { held[i] = isnan(row[i]) ? held[i] : row[i]; }
        if (r->codes) {
            memcpy(code, held, sizeof code);
        } else {
            codes_of(&cal, held, code);
        }
        for (int i = 0; i < SENSORS; i++) {
            beyond += code_of(code[i], &f->raw[n][i]);
            if (isnan(row[i])) { f->raw[n][i] = INT16_MAX; }
        }
    }
    return beyond;
}

/* The rate that was said, or that of the recorded time, whose unevenness is said. */
static int take_rate(struct glove_frames *f, const struct glove_options *o,
    const struct recording *r, const char *path)
{
    const double hz = o->rate_Hz > 0 ? o->rate_Hz : recording_row_hz(r);
    const long gaps = recording_gaps(r);
    if (hz <= 0) {
        cli_complain(
            "--csv: --rate HZ says how fast its rows came, or --columns where their time is");
        return 2;
    }
    if (hz < 1 || hz > GLOVE_RATE_TOP) {
        cli_complain("%s: %.6g rows a second by its time (allowed 1..%d): another unit of time?",
            path, hz, GLOVE_RATE_TOP);
        return 2;
    }
    if (gaps > 0) {
        cli_complain("%s: %ld of %ld steps of time are longer than 1.5 of the mean: the low-pass "
                     "takes them as even, %.6g Hz",
            path, gaps, r->rows - 1, hz);
    }
    f->T = glove_period(hz);
    return 0;
}

struct recording_ask glove_asked(const struct glove_options *o)
{
    return (struct recording_ask){
        o->unit ? recording_unit_of(o->unit) : RECORDING_GUESS, o->columns, o->scale};
}

int glove_frames_from(
    struct glove_frames *f, const struct glove_options *o, struct recording *r, const char *path)
{
    long beyond;
    if (!r->codes && !o->calibration) { stage_plain(); }
    f->n = r->rows;
    f->raw = malloc((size_t)r->rows * sizeof *f->raw);
    if (f->raw == NULL) {
        cli_complain("out of memory");
        return 1;
    }
    beyond = take_rows(f, r);
    f->t_s = r->t_s;
    f->label = r->label;
    r->t_s = NULL;
    r->label = NULL;
    if (beyond > 0) {
        cli_complain(
            "%s: %ld of %ld angles lie beyond the codes of this calibration: they are limited",
            path, beyond, f->n * SENSORS);
    }
    return 0;
}

int glove_frames_of(struct glove_frames *f, const struct glove_options *o, const char *path)
{
    const struct recording_ask ask = glove_asked(o);
    struct recording r;
    int err = recording_read(&r, path, &ask);
    if (err) { return err; }
    err = take_rate(f, o, &r, path);
    if (err == 0) { err = glove_frames_from(f, o, &r, path); }
    recording_free(&r);
    return err;
}

void glove_frames_free(struct glove_frames *f)
{
    free(f->raw);
    free(f->t_s);
    free(f->label);
    f->raw = NULL;
    f->t_s = NULL;
    f->label = NULL;
}

/* --- out --- */

void glove_header(const struct glove_options *o, int labelled)
{
    const struct exh_signal_table *t = exh_scene_glove.signals;
    const uint32_t n = exh_signal_count(t);
    printf("t_s");
    for (uint32_t i = 0; i < n - 1; i++) { /* all but the age */
        const struct exh_signal *r = exh_signal_at(t, i, NULL);
        const char *unit = strcmp(r->unit, "turn") == 0 ? o->deg ? "deg" : "rad" : r->unit;
        if (i <= SENSORS || o->tips) { printf(",%s%s%s", r->name, unit[0] ? "_" : "", unit); }
    }
    puts(labelled ? ",label" : "");
}

void glove_line(
    const struct glove_options *o, double t_s, const struct glove_signals *s, const char *label)
{
    const double turn = (o->deg ? 360 : 2 * PI) / 4294967296.0;
    printf("%.9g", t_s);
    for (int i = 0; i < SENSORS; i++) { printf(",%.9g", s->angle_turn_q32[i] * turn); }
    printf(",%ld", (long)s->faults);
    if (o->tips) {
        for (int f = 0; f < EXH_FINGERS; f++) {
            for (int j = 0; j < EXH_HAND_JOINTS; j++) {
                printf(",%.9g", s->joint_turn_q32[f][j] * turn);
            }
        }
        printf(",%ld", (long)s->clamped);
        for (int f = 0; f < EXH_FINGERS; f++) {
            const struct exh_vec3 *p = &s->tip_m_q30[f];
            printf(
                ",%.9g,%.9g,%.9g", p->x / 1073741824.0, p->y / 1073741824.0, p->z / 1073741824.0);
        }
    }
    if (label != NULL) { printf(",%s", label); }
    putchar('\n');
}

int glove_csv(const struct glove_options *o)
{
    static struct glove_cfg cfg;
    static struct glove_par par;
    static struct glove s;
    struct glove_frames f = {NULL, 0, {0, 0}, NULL, NULL};
    int err = glove_frames_of(&f, o, o->csv);
    if (err == 0) { err = glove_ready(o, &par, &cfg, f.T); }
    if (err) {
        glove_frames_free(&f);
        return err;
    }
    memset(&s, 0, sizeof s);
    glove_header(o, f.label != NULL);
    for (long n = 0; n < f.n; n++) {
        struct exh_glove_in in = {.age_ticks = 0};
        memcpy(in.raw, f.raw[n], sizeof in.raw);
        glove_frame(&s, &cfg, &in);
        glove_line(o, f.t_s != NULL ? f.t_s[n] : (double)n * f.T.num / f.T.den, &s.sig,
            f.label != NULL ? f.label[n] : NULL);
    }
    glove_frames_free(&f);
    return 0;
}
