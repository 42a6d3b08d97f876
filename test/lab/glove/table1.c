/* SPDX-License-Identifier: MIT */
/* exhand-lab glove --selftest: the paper's Table I. It lists peak-to-peak noise and stable bits of
 * joint angle, motor position and motor current at rest. Then the effect of low-pass and quantizer
 * on the angle. */
#include "lab/glove/glove.h"

#include "base/option.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct rest_options *is; /* of the run */

#define SENSORS EXH_GLOVE_SENSORS
#define CODES   65536.0 /* in 20 V */

/* --- measuring --- */

/* Largest less smallest, so far. */
struct range {
    int64_t lo, hi;
};

static const struct range none = {INT64_MAX, INT64_MIN};

static void see(struct range *r, int64_t v)
{
    if (v < r->lo) { r->lo = v; }
    if (v > r->hi) { r->hi = v; }
}

/* What cannot be seen is not there: no noise is taken to be less than one step. */
static double width(const struct range *r, double step)
{
    const double w = r->hi > r->lo ? (double)(r->hi - r->lo) : 0;
    return w > step ? w : step;
}

static int stable_bits(double span, double pp)
{
    int bits = 0;
    while (bits < 32 && pp * (double)(INT64_C(2) << bits) <= span) { bits++; }
    return bits;
}

/* Of the worst channel, codes. */
static double joint_pp(const struct glove_frames *f, int *worst)
{
    double pp = 0;
    for (int i = 0; i < SENSORS; i++) {
        struct range r = none;
        for (long n = 0; n < f->n; n++) { see(&r, f->raw[n][i]); }
        if (width(&r, 1) > pp) {
            pp = width(&r, 1);
            *worst = i;
        }
    }
    return pp;
}

/* By the library, from counter values, m. */
static int position_pp(
    const struct glove_rest *r, const struct sim_device *d, double *pp_m, double *step_m)
{
    const struct exh_quad_par par = {
        (int32_t)(d->step_m / d->decode * (double)(INT64_C(1) << EXH_Q_STEP) + 0.5),
        EXH_Q(10, 1, EXH_Q_VEL)};
    struct exh_quad_cfg cfg;
    struct exh_quad s;
    struct range seen = none;
    const int err = exh_quad_setup(&cfg, &par, r->frames.T, exh_board_info.enc_bits);
    if (err < 0) {
        cli_complain("encoder: %s", exh_error_text(err));
        return 2;
    }
    memset(&s, 0, sizeof s);
    for (long n = 0; n < r->ticks; n++) {
        see(&seen, exh_quad_pos_m_q30(&par, exh_quad_step(&s, &cfg, r->enc[n])));
    }
    *step_m = d->step_m / d->decode;
    *pp_m = width(&seen, *step_m * (1 << 30)) / (1 << 30);
    return 0;
}

static double current_pp(const struct glove_rest *r, const struct sim_device *d)
{
    const struct exh_drive_par par = {
        .mon_A_q40 = (int32_t)(d->mon_apc * (double)(INT64_C(1) << EXH_Q_MON) + 0.5)};
    const struct exh_drive_cfg cfg = {.par = &par};
    struct range seen = none;
    for (long n = 0; n < r->ticks; n++) { see(&seen, exh_drive_monitor_A_q26(&cfg, r->mon[n])); }
    return width(&seen, d->mon_apc * (1 << EXH_Q_CUR)) / (1 << EXH_Q_CUR);
}

/* --- the table --- */

static int row(
    const char *name, const char *noise, const char *span, int bits, const char *paper, int want)
{
    printf("  %-15s %-28s %-26s %4d   %-15s %4d%s\n", name, noise, span, bits, paper, want,
        bits < want ? "   falls short" : "");
    return bits < want;
}

static int joint_row(double pp)
{
    const double span = is->span_V / 20 * CODES;
    char noise[64], width_text[64];
    snprintf(noise, sizeof noise, "%.2f mV (%.0f codes)", pp * 20e3 / CODES, pp);
    snprintf(width_text, sizeof width_text, "%.4g V", is->span_V);
    return row("joint angle", noise, width_text, stable_bits(span, pp), "6.1 mV", 11);
}

static int motor_rows(const struct glove_options *o, const struct glove_rest *r)
{
    double pp_m, step_m, pp_A;
    char noise[64], span[64];
    int err = position_pp(r, &o->device, &pp_m, &step_m), fails;
    if (err) { return err; }
    snprintf(noise, sizeof noise, "%.2f um (steps: %.3g)", pp_m * 1e6, pp_m / step_m);
    snprintf(span, sizeof span, "%.4g mm (steps: %ld)", is->travel_m * 1e3,
        (long)(is->travel_m / step_m));
    fails =
        row("motor position", noise, span, stable_bits(is->travel_m, pp_m), "1 encoder step", 9);
    pp_A = current_pp(r, &o->device);
    snprintf(noise, sizeof noise, "%.1f mA", pp_A * 1e3);
    snprintf(span, sizeof span, "%.4g A", is->span_A);
    return row("motor current", noise, span, stable_bits(is->span_A, pp_A), "47.2 mA", 7) || fails;
}

/* --- behind filter and quantizer --- */

/* Samples by which a filter is late on a ramp, once it has settled. */
static double delay_ticks(const struct exh_filter_cfg *cfg, long settle)
{
    struct exh_filter s;
    const int32_t slope = (int32_t)(INT32_C(0x40000000) / (2 * settle));
    int32_t x = 0, y = 0;
    exh_filter_reset(&s, &x, 1);
    for (long n = 0; n < 2 * settle; n++) {
        x += slope;
        exh_filter_step(&s, cfg, &x, &y, 1);
    }
    return (double)(x - y) / slope;
}

/* a filter */
struct behind {
    double pp_raw; /* of the worst channel, codes */
    long flips[2]; /* behind a quantizer of so many bits, with and without hysteresis */
    int bits;
};

static void widths(const struct glove_frames *f, const struct exh_filter_cfg *cfg, long settle,
    struct behind *b, const struct exh_quantizer_cfg q[2])
{
    static struct exh_filter s[SENSORS];
    static struct exh_quantizer keep[2][SENSORS];
    long flips[2][SENSORS] = {{0}};
    int32_t last[2][SENSORS], x[SENSORS];
    struct range seen[SENSORS];
    memset(keep, 0, sizeof keep);
    for (long n = 0; n < f->n; n++) {
        for (int i = 0; i < SENSORS; i++) { x[i] = f->raw[n][i] * 65536; }
        if (n == 0) { exh_filter_reset(s, x, SENSORS); }
        if (cfg != NULL) { exh_filter_step(s, cfg, x, x, SENSORS); }
        for (int i = 0; n >= settle && i < SENSORS; i++) {
            if (n == settle) { seen[i] = none; }
            see(&seen[i], x[i]);
            for (int k = 0; q != NULL && k < 2; k++) {
                const int32_t v = exh_quantizer_step(&keep[k][i], &q[k], x[i]);
                if (n > settle && v != last[k][i]) { flips[k][i]++; }
                last[k][i] = v;
            }
        }
    }
    for (int i = 0; q != NULL && i < 2 * SENSORS; i++) { /* one each to find its place */
        const long n = flips[i / SENSORS][i % SENSORS];
        if (n > 1) { b->flips[i / SENSORS] += n - 1; }
    }
    for (int i = 0; q == NULL && i < SENSORS; i++) {
        if (width(&seen[i], 1) / 65536 > b->pp_raw) { b->pp_raw = width(&seen[i], 1) / 65536; }
    }
}

static int behind_filter(const struct glove_frames *f, double fc_Hz)
{
    const double rate_Hz = (double)f->T.den / f->T.num;
    const long settle = fc_Hz > 0 ? (long)(3 * rate_Hz / fc_Hz) + 1 : 0;
    const struct exh_filter_par par = {2, (int32_t)(fc_Hz * 65536)};
    struct exh_filter_cfg cfg;
    struct exh_quantizer_cfg q[2];
    struct exh_quantizer_par qp[2];
    struct behind b = {0, {0, 0}, 0};
    double delay_s = 0;
    if (fc_Hz > 0 &&
        (4 * fc_Hz > rate_Hz || f->n < 2 * settle || exh_filter_setup(&cfg, &par, f->T) < 0)) {
        return 0;
    }
    widths(f, fc_Hz > 0 ? &cfg : NULL, settle, &b, NULL);
    b.bits = stable_bits(is->span_V / 20 * CODES, b.pp_raw);
    if (b.bits > 24) { b.bits = 24; }
    if (fc_Hz > 0) { delay_s = delay_ticks(&cfg, settle) / rate_Hz; }
    qp[0] = (struct exh_quantizer_par){b.bits, (int32_t)(b.pp_raw * 65536 + 0.5)};
    qp[1] = (struct exh_quantizer_par){b.bits, 0};
    if (exh_quantizer_setup(&q[0], &qp[0]) < 0 || exh_quantizer_setup(&q[1], &qp[1]) < 0) {
        return 1;
    }
    widths(f, fc_Hz > 0 ? &cfg : NULL, settle, &b, q);
    if (fc_Hz > 0) {
        printf("  %8.6g", fc_Hz);
    } else {
        printf("      none");
    }
    printf(" %13.3f mV %6d %8.2f ms %11ld %12ld\n", b.pp_raw * 20e3 / CODES, b.bits, delay_s * 1e3,
        b.flips[1], b.flips[0]);
    return b.flips[0] > 0;
}

static int behind_table(const struct glove_frames *f)
{
    static const double fc_Hz[] = {0, 300, 100, 30, 10, 3};
    int err = 0;
    printf("\nJoint angle behind a second-order low-pass, and how often the codes of a quantizer "
           "of so\n"
           "many bits changed, all 22, without and with a hysteresis of as much as the noise\n"
           "  low-pass     peak to peak   bits       delay     changes      changes\n"
           "        Hz                                         without         with\n");
    for (size_t i = 0; i < sizeof fc_Hz / sizeof fc_Hz[0]; i++) {
        err |= behind_filter(f, fc_Hz[i]);
    }
    if (err) { cli_complain("a code changed within its hysteresis"); }
    return err;
}

/* A dead sensor has the least noise of all, so Table I alone does not show it. */
static int faults_line(uint32_t faults)
{
    if (faults == 0) { return 0; }
    printf("Not believed:");
    for (unsigned i = 0; i < SENSORS; i++) {
        if (faults >> i & 1) { printf(" %s", exh_glove_sensor_text(i)); }
    }
    printf("\n");
    return 1;
}

/* The glove module as its parameters are: how often its angles changed, beyond once each to
 * find their place. At rest, never; only of the board it is known that the hand is at rest. */
static int module_line(const struct glove_options *o, const struct glove_frames *f, int at_rest)
{
    static struct glove_par par;
    static struct glove_cfg cfg;
    static struct glove s;
    int32_t last[SENSORS] = {0};
    long flips[SENSORS] = {0}, beyond = 0;
    uint32_t faults = 0;
    const int err = glove_ready(o, &par, &cfg, f->T);
    if (err) { return err; }
    memset(&s, 0, sizeof s);
    for (long n = 0; n < f->n; n++) {
        struct exh_glove_in in = {.age_ticks = 0};
        memcpy(in.raw, f->raw[n], sizeof in.raw);
        glove_frame(&s, &cfg, &in);
        faults |= (uint32_t)s.sig.faults;
        for (int i = 0; i < SENSORS; i++) {
            flips[i] += n > 0 && s.sig.angle_turn_q32[i] != last[i];
            last[i] = s.sig.angle_turn_q32[i];
        }
    }
    for (int i = 0; i < SENSORS; i++) { beyond += flips[i] > 1 ? flips[i] - 1 : 0; }
    printf(
        "\nThe glove as set (order %d, %.6g Hz, %d bits, hysteresis %.4g codes): changes of its 22 "
        "angles %ld\n",
        (int)par.glove.order, par.glove.fc_Hz_q16 / 65536.0, (int)par.glove.bits,
        par.glove.hyst_raw_q16 / 65536.0, beyond);
    return (faults_line(faults) || beyond > 0) && at_rest;
}

static int worse(int a, int b) { return a > b ? a : b; }

static int report(const struct glove_options *o, const struct glove_rest *r, const char *source)
{
    const struct glove_frames *f = &r->frames;
    const double rate_Hz = (double)f->T.den / f->T.num;
    int worst = 0, fails;
    const double pp = joint_pp(f, &worst);
    printf("Stable bits = floor(log2(span / peak-to-peak noise)), %s\n"
           "%ld frames of 22 channels at %.6g Hz, %.4g s; joint angle: the worst channel, %s\n\n"
           "  %-15s %-28s %-26s %4s   %-15s %4s\n",
        source, f->n, rate_Hz, (double)f->n / rate_Hz, exh_glove_sensor_text((unsigned)worst),
        "signal", "peak to peak", "span", "bits", "paper", "bits");
    fails = joint_row(pp);
    if (r->enc != NULL) { fails = worse(fails, motor_rows(o, r)); }
    fails = worse(fails, behind_table(f));
    return worse(fails, module_line(o, f, r->enc != NULL));
}

int glove_table1(const struct glove_options *o, const struct rest_options *rest)
{
    struct glove_rest r;
    char source[300];
    int err;
    is = rest;
    memset(&r, 0, sizeof r);
    if (o->csv) {
        snprintf(source, sizeof source, "recorded: %s", o->csv);
        err = glove_rest_csv(&r, o);
    } else if (is->log) {
        snprintf(source, sizeof source, "recorded: %s", is->log);
        err = glove_rest_log(&r, is->log);
    } else {
        snprintf(source, sizeof source, "hand and motor at rest, board %s", exh_board_info.name);
        err = glove_rest_board(&r, o);
    }
    if (err == 0 && (o->csv || is->log)) { err = glove_rest_cut(&r.frames, is); }
    if (err == 0) { err = report(o, &r, source); }
    glove_frames_free(&r.frames);
    free(r.enc);
    free(r.mon);
    return err;
}
