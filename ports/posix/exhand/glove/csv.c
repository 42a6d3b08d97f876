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

/* Nearest, limited; 1 if it was. No number: at the rail, so that the channel has its fault. */
static int code_of(double v, int16_t *to)
{
    if (isnan(v)) {
        *to = INT16_MAX;
        return 0;
    }
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

struct recording_ask glove_asked(const struct glove_options *o)
{
    return (struct recording_ask){
        o->unit ? recording_unit_of(o->unit) : RECORDING_GUESS, o->columns, o->scale};
}

int glove_frames_of(struct glove_frames *f, const struct glove_options *o, const char *path)
{
    static struct exh_glove_cal cal;
    const struct recording_ask ask = glove_asked(o);
    struct recording r;
    long beyond = 0;
    int err = recording_read(&r, path, &ask);
    if (err) { return err; }
    if (!r.codes && !o->calibration) { stage_plain(); }
    staged_cal(&cal);
    f->n = r.rows;
    f->raw = malloc((size_t)r.rows * sizeof *f->raw);
    for (long n = 0; f->raw != NULL && n < r.rows; n++) {
        double code[SENSORS];
        if (r.codes) {
            memcpy(code, r.row[n], sizeof code);
        } else {
            codes_of(&cal, r.row[n], code);
        }
        for (int i = 0; i < SENSORS; i++) { beyond += code_of(code[i], &f->raw[n][i]); }
    }
    recording_free(&r);
    if (f->raw == NULL) {
        cli_complain("out of memory");
        return 1;
    }
    if (beyond > 0) {
        cli_complain(
            "%s: %ld of %ld angles lie beyond the codes of this calibration: they are limited",
            path, beyond, f->n * SENSORS);
    }
    return 0;
}

/* --- out --- */

void glove_header(const struct glove_options *o)
{
    const struct exh_signal_table *t = exh_scene_glove.signals;
    const uint32_t n = exh_signal_count(t);
    printf("t_s");
    for (uint32_t i = 0; i < n - 1; i++) { /* all but the age */
        const struct exh_signal *r = exh_signal_at(t, i, NULL);
        const char *unit = strcmp(r->unit, "turn") == 0 ? o->deg ? "deg" : "rad" : r->unit;
        if (i <= SENSORS || o->tips) { printf(",%s%s%s", r->name, unit[0] ? "_" : "", unit); }
    }
    putchar('\n');
}

void glove_line(const struct glove_options *o, double t_s, const struct glove_signals *s)
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
    putchar('\n');
}

int glove_csv(const struct glove_options *o)
{
    const struct exh_period T = glove_period(o->rate_Hz);
    static struct glove_cfg cfg;
    static struct glove_par par;
    static struct glove s;
    struct glove_frames f = {NULL, 0, T};
    int err = glove_frames_of(&f, o, o->csv);
    if (err == 0) { err = glove_ready(o, &par, &cfg, T); }
    if (err) {
        free(f.raw);
        return err;
    }
    memset(&s, 0, sizeof s);
    glove_header(o);
    for (long n = 0; n < f.n; n++) {
        struct exh_glove_in in = {.age_ticks = 0};
        memcpy(in.raw, f.raw[n], sizeof in.raw);
        glove_frame(&s, &cfg, &in);
        glove_line(o, (double)n * T.num / T.den, &s.sig);
    }
    free(f.raw);
    return 0;
}
