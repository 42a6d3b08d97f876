/* SPDX-License-Identifier: MIT */
/* The last seconds of a running box as a picture: a panel a signal, the state below. */
#include "live/watch.h"

#include "base/names.h"
#include "base/option.h"
#include "base/outfile.h"
#include "base/none.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PANELS 8

static struct {
    const char *png;
    double last_s;
    double *row; /* time, state, values: a ring of them */
    size_t cap, n, width;
} plot;

int watch_plot_open(const char *png, double last_s)
{
    plot.png = png;
    plot.last_s = last_s;
    if (system("command -v gnuplot >/dev/null 2>&1") != 0) {
        cli_complain("--plot: gnuplot draws it, and is not here: install gnuplot-nox");
        return 3;
    }
    return 0;
}

/* What is older than the last seconds goes when there is no room; half of it is kept twice over. */
static int make_room(double now_s)
{
    size_t from = 0;
    double *bigger;
    if (plot.n < plot.cap) { return 1; }
    while (from < plot.n && plot.row[from * plot.width] < now_s - plot.last_s) { from++; }
    plot.n -= from;
    if (from) {
        memmove(plot.row, plot.row + from * plot.width, plot.n * plot.width * sizeof *plot.row);
    }
    if (plot.n < plot.cap / 2) { return 1; }
    bigger = realloc(plot.row, (plot.cap ? 2 * plot.cap : 1024) * plot.width * sizeof *plot.row);
    if (bigger == NULL) { return plot.n < plot.cap; }
    plot.row = bigger;
    plot.cap = plot.cap ? 2 * plot.cap : 1024;
    return 1;
}

int watch_plot_sample(const struct watch_box *b, const struct watch_pick *p)
{
    const double now_s = (double)b->tick * b->T.num / b->T.den;
    double *to;
    plot.width = 2 + (size_t)p->n;
    if (plot.n && now_s < plot.row[(plot.n - 1) * plot.width]) { plot.n = 0; } /* restarted */
    if (!make_room(now_s)) {
        cli_complain("--plot: no memory: fewer --last or --hz");
        return 1;
    }
    to = plot.row + plot.n++ * plot.width;
    *to++ = now_s;
    *to++ = b->state;
    for (uint32_t i = 0; i < p->n; i++) {
        *to++ = none_or(exh_signal_at(b->scene->signals, p->index[i], NULL), b->value[p->index[i]]);
    }
    return 0;
}

/* --- drawing --- */

static void put_data(FILE *g)
{
    const double end_s = plot.row[(plot.n - 1) * plot.width];
    fprintf(g, "$d << END_OF_DATA\n");
    for (size_t k = 0; k < plot.n; k++) {
        const double *row = plot.row + k * plot.width;
        if (row[0] < end_s - plot.last_s) { continue; }
        for (size_t i = 0; i < plot.width; i++) { fprintf(g, "%.9g ", row[i]); }
        fputc('\n', g);
    }
    fprintf(g, "END_OF_DATA\n");
}

/* Of the picture, from the top: title, n panels, the state's strip, the axis' numbers and name. In
 * pixels. */
enum { TITLE_PX = 50, PANEL_PX = 170, GAP_PX = 20, STRIP_PX = 75, AXIS_PX = 75 };

static unsigned height_px(unsigned n) { return TITLE_PX + PANEL_PX * n + STRIP_PX + AXIS_PX; }

/* Top and bottom of panel i of n, or of the strip below them, on the screen. */
static void put_place(FILE *g, unsigned i, unsigned n)
{
    const double h = height_px(n), top = h - TITLE_PX - PANEL_PX * (double)i;
    const double from = i < n ? top - PANEL_PX + GAP_PX : AXIS_PX;
    fprintf(g, "set tmargin at screen %.4f; set bmargin at screen %.4f\n", top / h, from / h);
}

static void put_panels(FILE *g, const struct watch_box *b, const struct watch_pick *p, unsigned n)
{
    static const char *const color[] = {
        "#1f5fbf", "#d62728", "#1a8f2e", "#e08a1e", "#5a3d9a", "#0f8b8d", "#a0522d", "#444444"};
    for (unsigned i = 0; i < n; i++) {
        char name[WATCH_NAME_B];
        const struct exh_signal *row = watch_name(name, b->scene->signals, p->index[i]);
        put_place(g, i, n);
        fprintf(g,
            "set ylabel \"%s%s%s\" noenhanced\nplot $d using 1:%u with steps lc rgb '%s' lw "
            "1.4 notitle\n",
            name, row->unit[0] ? "\\n" : "", names_unit(row->unit), i + 3, color[i % PANELS]);
        if (i == 0) { fprintf(g, "unset label 1\n"); }
    }
    put_place(g, n, n);
    fprintf(g, "set yrange [-0.5:5.5]; set ytics ('off' 0, 'run' 2, 'fault' 5)\n"
               "set format x '%%g'; set xlabel 'time of the box (s)'; set ylabel 'state'\n"
               "plot $d using 1:2 with steps lc rgb '#333333' lw 1.8 notitle\n");
}

static int put_script(FILE *g, const struct watch_box *b, const struct watch_pick *p)
{
    const unsigned n = p->n < PANELS ? (unsigned)p->n : PANELS;
    const double end_s = plot.row[(plot.n - 1) * plot.width];
    const double first_s = plot.row[0] > end_s - plot.last_s ? plot.row[0] : end_s - plot.last_s;
    put_data(g);
    fprintf(g,
        "set terminal pngcairo size 1400,%u font 'DejaVu Sans,15' linewidth 1.4 background "
        "'#ffffff'\n",
        height_px(n));
    fprintf(g,
        "set border 3 lc rgb '#333333' lw 0.8\nset tics nomirror out scale 0.5 font ',12' "
        "textcolor rgb '#333333'\n"
        "set grid lc rgb '#dddddd' lw 0.6 lt 1\nset lmargin at screen 0.1; set rmargin at "
        "screen 0.985\n"
        "set xrange [%.9g:%.9g]\nset format x ''\nset ytics autofreq\nset multiplot\n"
        "set label 1 '%s, %.6g Hz' at screen 0.5, 0.965 center noenhanced\n",
        first_s, end_s > first_s ? end_s : first_s + 1, b->scene->name,
        (double)b->T.den / b->T.num);
    put_panels(g, b, p, n);
    fprintf(g, "unset multiplot\nunset output\n");
    return ferror(g);
}

int watch_plot_draw(const struct watch_box *b, const struct watch_pick *p)
{
    FILE *f = outfile_open("plot", plot.png), *g = NULL;
    char command[64];
    int err = f == NULL, fd = -1;
    if (f) {
        fd = dup(fileno(f)); /* which a child gets */
        snprintf(command, sizeof command, "gnuplot >/dev/fd/%d", fd);
        g = fd >= 0 ? popen(command, "w") : NULL;
        err = g == NULL;
    }
    if (g) {
        err = put_script(g, b, p);
        err |= pclose(g) != 0;
    }
    if (fd >= 0) { (void)close(fd); }
    if (f && outfile_end(f, !err) != 0) { err = 1; }
    free(plot.row);
    plot.row = NULL;
    plot.cap = plot.n = 0;
    if (err) {
        cli_complain("--plot: %s: gnuplot could not draw it", plot.png);
        return 1;
    }
    fprintf(stderr, "picture: %s\n", plot.png);
    return 0;
}
