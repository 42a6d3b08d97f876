#include "csv.h"

#include "cli.h"
#include "logfile.h"
#include "option.h"
#include "param.h"

#include "log.h"

#include <errno.h>
#include <string.h>

static uint32_t columns(const struct exh_signal_table *t, int all)
{
    return all ? exh_signal_count(t) : t->group[0].rows; /* the first group is the paper's */
}

static void header_line(FILE *to, const struct exh_signal_table *t, uint32_t n)
{
    fprintf(to, "t_s");
    for (uint32_t i = 0; i < n; i++) {
        const struct exh_signal *r = exh_signal_at(t, i, NULL);
        fprintf(to, ",%s%s%s", r->name, r->unit[0] ? "_" : "", r->unit);
    }
    fputc('\n', to);
}

static void line(FILE *to, const struct exh_signal_table *t, uint32_t n, double t_s,
                 const int32_t *v)
{
    fprintf(to, "%.9f", t_s);
    for (uint32_t i = 0; i < n; i++) {
        fprintf(to, ",%.9g", cli_signal_value(exh_signal_at(t, i, NULL), v[i]));
    }
    fputc('\n', to);
}

int csv_write(const char *log_path, FILE *to, int all)
{
    struct logfile l;
    struct exh_record r;
    struct exh_drive_out out;
    struct exh_scene_in in;
    uint64_t tick = 0;
    int err = logfile_open(&l, log_path);

    if (err == 0) {
        const uint32_t n = columns(l.scene->signals, all);
        int started = 0;
        header_line(to, l.scene->signals, n);
        while (logfile_next(&l, &r)) {
            struct exh_bytes c = exh_bytes_reader(r.payload, r.len_B);
            if (r.type != EXH_RECORD_FRAME) { continue; }
            /* The record's tick wraps after 2^32; time must not. */
            tick = started ? tick + (uint32_t)(r.tick - (uint32_t)tick) : r.tick;
            started = 1;
            memset(&in, 0, sizeof in);
            exh_log_frame_bytes(&c, l.scene, &in, &out, l.scene->signal);
            line(to, l.scene->signals, n, (double)tick * l.header.T.num / l.header.T.den,
                 l.scene->signal);
        }
        err = logfile_complain(&l) ? 1 : 0;
        if (ferror(to) || fflush(to) != 0) {
            fprintf(stderr, "csv: %s\n", strerror(errno));
            err = 1;
        }
    }
    logfile_close(&l);
    return err;
}

int cli_csv(int argc, char **argv)
{
    int all = 0;
    const char *out = NULL;
    const struct cli_option option[] = {
        {"out", CLI_TEXT, &out, 0, 0, "FILE", "write there instead of standard output"},
        {"all", CLI_FLAG, &all, 0, 0, NULL, "limits, state and faults too"},
    };
    const struct cli_command c = {"csv", "LOG [options]", "A log as comma-separated values.",
                                  option, 2, 1};
    const char *log = NULL;
    FILE *to = stdout;
    int err = cli_parse(&c, argc, argv, &log);

    if (err) { return err == 1 ? 0 : err; }
    if (out != NULL) { to = fopen(out, "w"); }
    if (to == NULL) {
        fprintf(stderr, "exhand csv: --out: %s: %s\n", out, strerror(errno));
        return 2;
    }
    err = csv_write(log, to, all);
    if (to != stdout) { fclose(to); }
    return err;
}
