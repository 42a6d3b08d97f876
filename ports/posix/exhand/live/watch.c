/* SPDX-License-Identifier: MIT */
/* exhand watch: what a running box does, as it does it. */
#include "live/watch.h"

#include "base/lines.h"
#include "base/cli.h"
#include "base/names.h"
#include "base/none.h"
#include "base/option.h"
#include "base/outfile.h"
#include "base/until.h"
#include "posix.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define DRAWN_HZ 10.0 /* a terminal is not drawn more often */
#define LATE_S   0.05 /* Ctrl-C and --seconds wait no longer */

static struct {
    const char *modbus, *listen, *peer, *key, *names, *finger, *csv, *plot;
    double hz, seconds, last_s;
    int64_t trace; /* ticks from frame to frame; 0: none */
    struct watch_box box;
    struct watch_pick pick;
    const struct exh_scene *picked; /* of this scene */
    FILE *file;
    int tty, taken; /* taken: a sample of this tick is there */
    uint32_t tick;
    double shown_s;
} w;

/* --- what is watched --- */

/* Now that the scene is known. */
static int pick(struct watch_box *b)
{
    const int finger = names_find(&names_finger, w.finger);
    const int err = watch_pick(&w.pick, b->scene->signals, w.names, (unsigned)finger);
    if (err) { return err; }
    b->from = UINT32_MAX;
    b->to = 0;
    for (uint32_t i = 0; i < w.pick.n; i++) {
        if (w.pick.index[i] < b->from) { b->from = w.pick.index[i]; }
        if (w.pick.index[i] > b->to) { b->to = w.pick.index[i]; }
    }
    if (w.trace && w.names && w.pick.n > EXH_TRACE_SIGNALS) {
        cli_complain("--trace: of %d signals at most: give fewer --signals", EXH_TRACE_SIGNALS);
        return 2;
    }
    if (w.trace && w.pick.n > EXH_TRACE_SIGNALS) { w.pick.n = EXH_TRACE_SIGNALS; }
    for (uint32_t i = 0; i < EXH_TRACE_SIGNALS; i++) {
        b->index[i] = w.pick.index[i < w.pick.n ? i : 0];
    }
    b->every = (uint32_t)w.trace;
    w.picked = b->scene;
    return 0;
}

/* --- samples --- */

static int csv_sample(const struct watch_box *b, int first)
{
    char name[WATCH_NAME_B];
    if (first) {
        fprintf(w.file, "t_s,tick,state,faults,present,limits");
        for (uint32_t i = 0; i < w.pick.n; i++) {
            const struct exh_signal *row = watch_name(name, b->scene->signals, w.pick.index[i]);
            fprintf(w.file, ",%s%s%s", name, row->unit[0] ? "_" : "", row->unit);
        }
        fputc('\n', w.file);
    }
    fprintf(w.file, "%.9f,%lu,%u,%lu,%lu,%lu", (double)b->tick * b->T.num / b->T.den,
        (unsigned long)b->tick, (unsigned)b->state, (unsigned long)b->faults,
        (unsigned long)b->present, (unsigned long)b->limits);
    for (uint32_t i = 0; i < w.pick.n; i++) {
        none_or_cell(w.file, exh_signal_at(b->scene->signals, w.pick.index[i], NULL),
            b->value[w.pick.index[i]]);
    }
    fputc('\n', w.file);
    if (!ferror(w.file) && (w.tty || fflush(w.file) == 0)) { return 0; }
    cli_complain(
        "--csv: %s: can't be written: %s: make room or give another --csv", w.csv, strerror(errno));
    return 1;
}

/* A log has every tick. Shows one per 1/hz of the box's time, in rising order. A restarted box
 * counts from 0. */
static int due(const struct watch_box *b)
{
    const uint32_t passed = b->tick - w.tick;
    const double passed_s = (double)passed * b->T.num / b->T.den;
    return !w.taken || w.modbus || passed >= UINT32_C(0x80000000) || passed_s * w.hz >= 1 - 1e-9;
}

static int fresh(struct watch_box *b)
{
    int err = 0, first = w.picked == NULL;
    if (w.picked != b->scene) {
        err = pick(b);
        if (err || w.modbus) { return err; } /* from now on only these are requested */
    }
    if (!due(b)) { return 0; }
    first |= !w.taken;
    w.taken = 1;
    w.tick = b->tick;
    if (w.file) { err = csv_sample(b, first); }
    if (err == 0 && w.plot) { err = watch_plot_sample(b, &w.pick); }
    watch_view_sample(b, &w.pick);
    if (!w.tty) { watch_view_line(b, &w.pick); }
    return err;
}

/* --- until it is over --- */

static void show(void)
{
    const double now_s = until_now_s();
    const int silent = watch_age_s(&w.box) > 1;
    if (now_s - w.shown_s < (w.tty ? 1 / DRAWN_HZ : 1)) { return; }
    if (w.tty) {
        watch_view_draw(&w.box, &w.pick, w.modbus ? w.modbus : w.listen);
    } else if (silent) {
        printf("silent for %.1f s%s%s\n", watch_age_s(&w.box), w.box.trouble ? ": " : "",
            w.box.trouble ? w.box.trouble : "");
        fflush(stdout);
    }
    w.shown_s = now_s;
}

static void sleep_until(double s)
{
    const double left_s = s - until_now_s();
    const struct timespec t = {0, (long)(left_s * 1e9)};
    if (left_s > 0 && left_s < 1) { (void)nanosleep(&t, NULL); }
}

static int go(void)
{
    const double end_s = w.seconds > 0 ? until_now_s() + w.seconds : 1e300;
    double next_s = until_now_s();
    int err = 0;
    w.box.since_s = w.shown_s = next_s;
    while (err == 0 && !posix_interrupted() && !w.box.ended && until_now_s() < end_s) {
        const double now_s = until_now_s();
        const double wake_s = next_s < now_s + LATE_S ? next_s : now_s + LATE_S;
        if (w.listen) {
            err = watch_stream_look(&w.box, now_s + LATE_S, fresh);
        } else if (now_s >= next_s) {
            err = watch_modbus_look(&w.box, fresh);
            next_s = next_s + 1 / w.hz > now_s ? next_s + 1 / w.hz : now_s;
        } else {
            sleep_until(wake_s);
        }
        show();
    }
    return err;
}

static int finish(int err)
{
    if (w.tty) {
        if (w.picked) { watch_view_draw(&w.box, &w.pick, w.modbus ? w.modbus : w.listen); }
        watch_view_end();
    }
    if (w.file && outfile_end(w.file, w.taken && !ferror(w.file)) != 0 && err == 0) { err = 1; }
    if (err == 0 && w.plot && w.taken) { err = watch_plot_draw(&w.box, &w.pick); }
    if (err) { return err; }
    if (!w.taken) {
        cli_complain("%s: nothing was heard%s%s", w.modbus ? w.modbus : w.listen,
            w.box.trouble ? ": " : "", w.box.trouble ? w.box.trouble : "");
        return posix_interrupted() ? 130 : 1;
    }
    if (w.box.breaks) {
        cli_complain("the link was lost %lu times: nothing is known of what was between",
            (unsigned long)w.box.breaks);
    }
    if (w.box.mixed) {
        cli_complain(
            "%llu of %llu readings are of more than one tick: --trace has four signals of one",
            (unsigned long long)w.box.mixed, (unsigned long long)w.box.heard);
    }
    if (w.box.lost) {
        cli_complain("%llu %s were lost on the way", (unsigned long long)w.box.lost,
            w.trace ? "frames" : "ticks");
    }
    if (!w.box.ended && !posix_interrupted() && watch_age_s(&w.box) > 1) {
        cli_complain("silent for %.1f s at the end", watch_age_s(&w.box));
        return 1;
    }
    return posix_interrupted() ? 130 : 0;
}

/* --- command --- */

static int prepare(void)
{
    const struct outfile_option leaves[] = {{"csv", w.csv}, {"plot", w.plot}};
    int err = 0;
    if ((w.modbus != NULL) + (w.listen != NULL) != 1) {
        cli_complain("--modbus or --listen: where the box is heard: give one of them");
        return 2;
    }
    if (w.trace && w.listen) {
        cli_complain("--trace: a log has every tick: only with --modbus");
        return 2;
    }
    if (names_find(&names_finger, w.finger) < 0) {
        cli_complain("--finger: %s: give thumb, index, middle, ring or little", w.finger);
        return 2;
    }
    if (w.plot) { err = watch_plot_open(w.plot, w.last_s); }
    if (err == 0) {
        err = w.modbus ? watch_modbus_open(w.modbus) : watch_stream_open(w.listen, w.peer, w.key);
    }
    if (err == 0) { err = outfile_try(leaves, sizeof leaves / sizeof leaves[0]); }
    if (err == 0 && w.csv) {
        w.file = outfile_open("csv", w.csv);
        if (w.file == NULL) { err = 2; }
    }
    return err;
}

int cli_watch(int argc, char **argv)
{
    const struct cli_option option[] = {
        {"modbus", CLI_TEXT, &w.modbus, 0, 0, "WHERE",
            "a box that serves its registers: tcp:ADDRESS:PORT or rtu:DEVICE:BAUD"},
        {"listen", CLI_TEXT, &w.listen, 0, 0, "ADDRESS:PORT",
            "a box that sends its log there (pc104: log=udp)"},
        {"peer", CLI_TEXT, &w.peer, 0, 0, "ADDRESS:PORT",
            "with --listen: the box, as it sends (whoever sends the first whole header)"},
        {"key", CLI_TEXT, &w.key, 0, 0, "FILE",
            "with --listen: of the box, 32 hexadecimal digits (pc104: key=)"},
        {"trace", CLI_INT, &w.trace, 0, 1e6, "N",
            "of Modbus: every N-th tick of four signals; losses are reported"},
        {"signals", CLI_TEXT, &w.names, 0, 0, "A[,B[I]...]",
            "signals; a number selects a finger (the paper's)"},
        {"finger", CLI_TEXT, &w.finger, 0, 0, "F", "finger of signals without a number (index)"},
        {"hz", CLI_REAL, &w.hz, 0.1, 1000, "HZ", "samples a second, of a trace looks (10, 50)"},
        {"seconds", CLI_REAL, &w.seconds, 0, 1e9, "S", "then it ends (never)"},
        {"csv", CLI_TEXT, &w.csv, 0, 0, "FILE", "every sample"},
        {"plot", CLI_TEXT, &w.plot, 0, 0, "FILE.png",
            "the last seconds, drawn at the end by gnuplot"},
        {"last", CLI_REAL, &w.last_s, 0.1, 3600, "S", "of --plot (10)"},
    };
    const struct cli_command c = {"watch", "--modbus WHERE | --listen ADDRESS:PORT [options]",
        "Live values, state, faults and limits of a running box, until "
        "Ctrl-C: in place on a terminal,\n"
        "else a line a sample. It only reads.",
        option, (int)(sizeof option / sizeof option[0]), 0};
    int err;
    memset(&w, 0, sizeof w);
    w.finger = "index";
    w.last_s = 10;
    err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    w.tty = lines_terminal(STDOUT_FILENO);
    if (w.trace && w.hz == 0) { w.hz = 50; }
    if (w.hz == 0) { w.hz = 10; }
    err = prepare();
    if (err) { return err; }
    until_catch(UNTIL_COMES_BACK);
    (void)signal(SIGPIPE, SIG_IGN);
    err = finish(go());
    if (w.modbus) {
        watch_modbus_close();
    } else {
        watch_stream_close();
    }
    return err;
}
