/* exhand glove --selftest: the paper's Table I, peak-to-peak noise and stable bits of joint
 * angle, motor position and motor current at rest, and what low-pass and quantizer make of
 * the first. */
#include "glove.h"

#include "logfile.h"
#include "option.h"

#include "log.h"
#include "loop.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SENSORS EXH_GLOVE_SENSORS
#define CODES   65536.0 /* in 20 V */

/* What was recorded at rest. */
struct rest {
    struct glove_frames frames;
    uint32_t *enc; /* NULL: no motor in the recording */
    int16_t *mon;
    long ticks, cap;
    int no_memory;
};

static struct rest *taking; /* of the loop's hook */

/* --- input --- */

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    taking->frames.T = board.T;
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    struct rest *r = taking;
    (void)tick;
    (void)out;
    if (r->ticks == r->cap) {
        posix_stop();
        return;
    }
    r->enc[r->ticks] = in->drive.enc_raw[0];
    r->mon[r->ticks++] = in->drive.mon_raw[0];
    if (in->glove_new) {
        memcpy(r->frames.raw[r->frames.n++], in->glove.raw, sizeof in->glove.raw);
    }
}

static int make_room(struct rest *r, long n)
{
    r->cap = n;
    r->frames.raw = malloc((size_t)n * sizeof *r->frames.raw);
    r->enc = malloc((size_t)n * sizeof *r->enc);
    r->mon = malloc((size_t)n * sizeof *r->mon);
    if (r->frames.raw && r->enc && r->mon) { return 0; }
    cli_complain("out of memory: fewer --seconds");
    return 1;
}

/* What the board gives, hand and motor at rest. */
static int from_board(struct rest *r, const struct glove_options *o)
{
    static const struct exh_loop_hooks hooks = {start, NULL, after};
    const double rate_Hz = o->rate_Hz > 0 ? o->rate_Hz : exh_scene_glove.rate_Hz;
    struct posix_config c = posix_config_default();
    int err = make_room(r, (long)(o->seconds * rate_Hz) + 1);
    if (err) { return err; }
    c.device = o->device;
    c.glove_par = o->chain;
    c.seed = (uint64_t)o->seed;
    c.bench = c.glove = 1;
    c.enc_jitter_cnt = 1;
    c.T = glove_period(rate_Hz);
    c.max_ticks = (uint32_t)r->cap - 1;
    posix_configure(&c);
    taking = r;
    err = exh_loop(&exh_scene_glove, 0, &hooks);
    if (err < 0) {
        cli_complain("%s: %.6g Hz: %s", exh_board_info.name, rate_Hz, exh_error_text(err));
        return err == -EXH_E_ABSENT ? 3 : 2;
    }
    return posix_interrupted() ? 130 : 0;
}

/* The glove frames of a log. */
static int from_log(struct rest *r, const char *path)
{
    struct logfile l;
    struct exh_record rec;
    struct exh_scene_in in;
    struct exh_drive_out out;
    int err = logfile_open(&l, path);
    if (err == 0 && l.scene->read_glove == NULL) {
        cli_complain("%s: made by scene %s, which reads no glove", path, l.scene->name);
        err = 2;
    }
    r->frames.T = l.header.T;
    if (err == 0) {
        r->cap = (long)(l.len / EXH_RECORD_OVERHEAD);
        r->frames.raw = malloc((size_t)r->cap * sizeof *r->frames.raw);
        err = r->frames.raw == NULL;
    }
    while (err == 0 && logfile_next(&l, &rec)) {
        struct exh_bytes c = exh_bytes_reader(rec.payload, rec.len_B);
        if (rec.type != EXH_RECORD_FRAME) { continue; }
        memset(&in, 0, sizeof in);
        exh_log_frame_bytes(&c, l.scene, &in, &out, l.scene->signal);
        if (exh_bytes_ok(&c) && c.at == rec.len_B && in.glove_new) {
            memcpy(r->frames.raw[r->frames.n++], in.glove.raw, sizeof in.glove.raw);
        }
    }
    if (err == 0) { err = logfile_complain(&l); }
    logfile_close(&l);
    return err;
}

static int from_csv(struct rest *r, const struct glove_options *o)
{
    r->frames.T = glove_period(o->rate_Hz);
    return glove_frames_of(&r->frames, o, o->csv);
}

/* --from and --to of a recording. */
static int cut(struct glove_frames *f, const struct glove_options *o)
{
    const double T_s = (double)f->T.num / f->T.den;
    const long from = (long)(o->from_s / T_s + 0.5);
    long to = o->to_s > 0 ? (long)(o->to_s / T_s + 0.5) : f->n;
    if (to > f->n) { to = f->n; }
    if (from >= to) {
        cli_complain("--from, --to: %.6g..%.6g s: nothing is recorded there: it ends at %.6g s", o->from_s,
                     o->to_s, (double)f->n * T_s);
        return 2;
    }
    f->n = to - from;
    memmove(f->raw, f->raw + from, (size_t)f->n * sizeof *f->raw);
    return 0;
}

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
static int position_pp(const struct rest *r, const struct sim_device *d, double *pp_m, double *step_m)
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
        see(&seen, exh_quad_pos_m_q30(&par, exh_quad_extend(&s, &cfg, r->enc[n])));
    }
    *step_m = d->step_m / d->decode;
    *pp_m = width(&seen, *step_m * (1 << 30)) / (1 << 30);
    return 0;
}

static double current_pp(const struct rest *r, const struct sim_device *d)
{
    const struct exh_drive_par par = {.mon_A_q40 =
                                          (int32_t)(d->mon_apc * (double)(INT64_C(1) << EXH_Q_MON) + 0.5)};
    const struct exh_drive_cfg cfg = {.par = &par};
    struct range seen = none;
    for (long n = 0; n < r->ticks; n++) { see(&seen, exh_drive_monitor_A_q26(&cfg, r->mon[n])); }
    return width(&seen, d->mon_apc * (1 << EXH_Q_CUR)) / (1 << EXH_Q_CUR);
}

/* --- the table --- */

static int row(const char *name, const char *noise, const char *span, int bits, const char *paper,
               int want)
{
    printf("  %-15s %-28s %-26s %4d   %-15s %4d%s\n", name, noise, span, bits, paper, want,
           bits < want ? "   falls short" : "");
    return bits < want;
}

static int joint_row(const struct glove_options *o, double pp)
{
    const double span = o->span_V / 20 * CODES;
    char noise[64], width_text[64];
    snprintf(noise, sizeof noise, "%.2f mV (%.0f codes)", pp * 20e3 / CODES, pp);
    snprintf(width_text, sizeof width_text, "%.4g V", o->span_V);
    return row("joint angle", noise, width_text, stable_bits(span, pp), "6.1 mV", 11);
}

static int motor_rows(const struct glove_options *o, const struct rest *r)
{
    double pp_m, step_m, pp_A;
    char noise[64], span[64];
    int err = position_pp(r, &o->device, &pp_m, &step_m), fails;
    if (err) { return err; }
    snprintf(noise, sizeof noise, "%.2f um (steps: %.3g)", pp_m * 1e6, pp_m / step_m);
    snprintf(span, sizeof span, "%.4g mm (steps: %ld)", o->travel_m * 1e3, (long)(o->travel_m / step_m));
    fails = row("motor position", noise, span, stable_bits(o->travel_m, pp_m), "1 encoder step", 9);
    pp_A = current_pp(r, &o->device);
    snprintf(noise, sizeof noise, "%.1f mA", pp_A * 1e3);
    snprintf(span, sizeof span, "%.4g A", o->span_A);
    return row("motor current", noise, span, stable_bits(o->span_A, pp_A), "47.2 mA", 7) || fails;
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

struct behind { /* a filter */
    double pp_raw; /* of the worst channel, codes                                */
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
        if (flips[i / SENSORS][i % SENSORS] > 1) { b->flips[i / SENSORS] += flips[i / SENSORS][i % SENSORS] - 1; }
    }
    for (int i = 0; q == NULL && i < SENSORS; i++) {
        if (width(&seen[i], 1) / 65536 > b->pp_raw) { b->pp_raw = width(&seen[i], 1) / 65536; }
    }
}

static int behind_filter(const struct glove_options *o, const struct glove_frames *f, double fc_Hz)
{
    const double rate_Hz = (double)f->T.den / f->T.num;
    const long settle = fc_Hz > 0 ? (long)(3 * rate_Hz / fc_Hz) + 1 : 0;
    const struct exh_filter_par par = {2, (int32_t)(fc_Hz * 65536)};
    struct exh_filter_cfg cfg;
    struct exh_quantizer_cfg q[2];
    struct exh_quantizer_par qp[2];
    struct behind b = {0, {0, 0}, 0};
    double delay_s = 0;
    if (fc_Hz > 0 && (4 * fc_Hz > rate_Hz || f->n < 2 * settle || exh_filter_setup(&cfg, &par, f->T) < 0)) {
        return 0;
    }
    widths(f, fc_Hz > 0 ? &cfg : NULL, settle, &b, NULL);
    b.bits = stable_bits(o->span_V / 20 * CODES, b.pp_raw);
    if (b.bits > 24) { b.bits = 24; }
    if (fc_Hz > 0) { delay_s = delay_ticks(&cfg, settle) / rate_Hz; }
    qp[0] = (struct exh_quantizer_par){b.bits, (int32_t)(b.pp_raw * 65536 + 0.5)};
    qp[1] = (struct exh_quantizer_par){b.bits, 0};
    if (exh_quantizer_setup(&q[0], &qp[0]) < 0 || exh_quantizer_setup(&q[1], &qp[1]) < 0) { return 1; }
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

static int behind_table(const struct glove_options *o, const struct glove_frames *f)
{
    static const double fc_Hz[] = {0, 300, 100, 30, 10, 3};
    int err = 0;
    printf("\nJoint angle behind a second-order low-pass, and how often the codes of a quantizer of so\n"
           "many bits changed, all 22, without and with a hysteresis of as much as the noise\n"
           "  low-pass     peak to peak   bits       delay     changes      changes\n"
           "        Hz                                         without         with\n");
    for (size_t i = 0; i < sizeof fc_Hz / sizeof fc_Hz[0]; i++) { err |= behind_filter(o, f, fc_Hz[i]); }
    if (err) { cli_complain("a code changed within its hysteresis"); }
    return err;
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
    const int err = glove_ready(o, &par, &cfg, f->T);
    if (err) { return err; }
    memset(&s, 0, sizeof s);
    for (long n = 0; n < f->n; n++) {
        struct exh_glove_in in = {.age_ticks = 0};
        memcpy(in.raw, f->raw[n], sizeof in.raw);
        glove_frame(&s, &cfg, &in);
        for (int i = 0; i < SENSORS; i++) {
            flips[i] += n > 0 && s.sig.angle_turn_q32[i] != last[i];
            last[i] = s.sig.angle_turn_q32[i];
        }
    }
    for (int i = 0; i < SENSORS; i++) { beyond += flips[i] > 1 ? flips[i] - 1 : 0; }
    printf("\nThe glove as set (order %d, %.6g Hz, %d bits, hysteresis %.4g codes): changes of its 22 "
           "angles %ld\n", (int)par.glove.order, par.glove.fc_Hz_q16 / 65536.0, (int)par.glove.bits,
           par.glove.hyst_raw_q16 / 65536.0, beyond);
    return at_rest && beyond > 0;
}

static int worse(int a, int b)
{
    return a > b ? a : b;
}

static int report(const struct glove_options *o, const struct rest *r, const char *source)
{
    const struct glove_frames *f = &r->frames;
    const double rate_Hz = (double)f->T.den / f->T.num;
    int worst = 0, fails;
    const double pp = joint_pp(f, &worst);
    printf("Stable bits = floor(log2(span / peak-to-peak noise)), %s\n"
           "%ld frames of 22 channels at %.6g Hz, %.4g s; joint angle: the worst channel, %s\n\n"
           "  %-15s %-28s %-26s %4s   %-15s %4s\n", source, f->n, rate_Hz, (double)f->n / rate_Hz,
           exh_glove_sensor_text((unsigned)worst), "signal", "peak to peak", "span", "bits", "paper", "bits");
    fails = joint_row(o, pp);
    if (r->enc != NULL) { fails = worse(fails, motor_rows(o, r)); }
    fails = worse(fails, behind_table(o, f));
    return worse(fails, module_line(o, f, r->enc != NULL));
}

int glove_table1(const struct glove_options *o)
{
    struct rest r;
    char source[300];
    int err;
    memset(&r, 0, sizeof r);
    if (o->csv) {
        snprintf(source, sizeof source, "recorded: %s", o->csv);
        err = from_csv(&r, o);
    } else if (o->log) {
        snprintf(source, sizeof source, "recorded: %s", o->log);
        err = from_log(&r, o->log);
    } else {
        snprintf(source, sizeof source, "hand and motor at rest, board %s", exh_board_info.name);
        err = from_board(&r, o);
    }
    if (err == 0 && (o->csv || o->log)) { err = cut(&r.frames, o); }
    if (err == 0) { err = report(o, &r, source); }
    free(r.frames.raw);
    free(r.enc);
    free(r.mon);
    return err;
}
