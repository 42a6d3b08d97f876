/* SPDX-License-Identifier: MIT */
/* exhand watch --listen: a log that comes over the network, sampled. Over Modbus:
 * modbus_watch_test.c. */
#define _XOPEN_SOURCE 700 /* pseudo-terminals */

#include "said.h"
#include "terminal.h"

#include "udp.h"

#include "exhand/run/stream.h"

#include "exhand/record.h"

#include <time.h>

static struct said s;
static char at[32];
static struct udp from;
static char *dir;
static pid_t watcher;
static uint32_t number;

static void pause_ms(long ms)
{
    const struct timespec t = {ms / 1000, ms % 1000 * 1000000};
    (void)nanosleep(&t, NULL);
}

static int (*watch)(int, char **) = cli_watch;

/* At a port that was free just now. */
static void start(const char *option, const char *value)
{
    struct udp probe;
    number = 0;
    stream_open(77);
    CHECK_EQ_I64(udp_open(&probe, "127.0.0.1:0", NULL), 0);
    (void)snprintf(at, sizeof at, "127.0.0.1:%u", udp_port(&probe));
    udp_close(&probe);
    CHECK_EQ_I64(udp_open(&from, "127.0.0.1:0", at), 0);
    watcher = said_start(dir, watch,
        WORDS("watch", "--listen", at, "--seconds", "30", "--csv", said_path(dir, "w.csv"), option,
            value));
    for (int i = 0; i < 400 && said_size(said_path(dir, "w.csv.part")) < 0; i++) { pause_ms(10); }
    pause_ms(50);
}

/* --NAME=DIR/FILE */
static const char *said_path_as_option(const char *name, const char *file)
{
    static char option[600];
    snprintf(option, sizeof option, "--%s=%s", name, said_path(dir, file));
    return option;
}

static void piece(const uint8_t *byte, unsigned n, int last, int lose)
{
    uint8_t datagram[STREAM_PIECE_B];
    const size_t len = stream_piece(datagram, byte, n, last);
    if (!lose) { CHECK(udp_send(&from, datagram, len) > 0, "piece %lu", (unsigned long)number); }
    stream_sent(n);
    if (++number % 8 == 0) { pause_ms(2); } /* the socket's room is not endless */
}

/* A file's bytes; lost: each so many pieces one is. */
static void send_file(const char *path, unsigned lost)
{
    FILE *f = fopen(path, "rb");
    uint8_t byte[STREAM_DATA_B];
    size_t n;
    CHECK(f != NULL, "no log");
    while ((n = fread(byte, 1, sizeof byte, f)) > 0) {
        piece(byte, (unsigned)n, 0, lost && number % lost == lost - 1);
    }
    fclose(f);
}

static void end(void)
{
    said_end(&s, dir, watcher);
    udp_close(&from);
}

static const char *a_log(const char *seconds)
{
    static char log[64]; /* said_path() forgets */
    snprintf(log, sizeof log, "%s/a.exh", dir);
    said(&s, dir, cli_run, WORDS("run", "--seconds", seconds, "--log", log));
    CHECK(s.status == 0, "%s", s.err);
    return log;
}

/* Lines of the first that are the second's, in its order; -1: one is not. Both have q at first
 * behind `skip` columns. */
static int found_in(const char *path, const char *in, int *lines)
{
    FILE *f = fopen(path, "r"), *g = fopen(in, "r");
    char a[512], b[512];
    int same = 0;
    CHECK(f && g && fgets(a, sizeof a, f) && fgets(b, sizeof b, g), "no table");
    *lines = 0;
    while (fgets(a, sizeof a, f)) {
        const char *values = a;
        double t = strtod(a, NULL), u = -1;
        for (int i = 0; i < 6; i++) { values = strchr(values, ',') + 1; }
        while (u < t - 1e-9 && fgets(b, sizeof b, g)) { u = strtod(b, NULL); }
        same += u < t + 1e-9 && strcmp(values, strchr(b, ',') + 1) == 0;
        ++*lines;
    }
    fclose(f);
    fclose(g);
    return same;
}

/* How many samples it shows of the log; each has the log's values. */
static int samples_of_the_log(const char *log, const char *hz)
{
    int lines, same;
    said(&s, dir, cli_csv, WORDS("csv", log, "--out", said_path(dir, "c.csv")));
    CHECK_EQ_I64(s.status, 0);
    start("--hz", hz);
    send_file(log, 0);
    end();
    CHECK(s.status == 0, "%d %s", s.status, s.err);
    same = found_in(said_path(dir, "w.csv"), said_path(dir, "c.csv"), &lines);
    CHECK(same == lines, "%d of %d", same, lines);
    return lines;
}

TEST(samples_are_the_logs_values)
{
    int lines;
    dir = said_dir();
    lines = samples_of_the_log(a_log("4"), "20");
    CHECK(lines == 80, "%d", lines);
    CHECK(strstr(s.out, "  run  faults none"), "%s", s.out);
    said_clean(dir);
}

/* What is lost is counted and the rest is watched on. */
TEST(lost_pieces_are_told)
{
    const char *log;
    dir = said_dir();
    log = a_log("4");
    start("--signals", "f_des,state");
    send_file(log, 20);
    end();
    CHECK(s.status == 0 && strstr(s.err, "ticks were lost on the way"), "%d %s", s.status, s.err);
    CHECK(strstr(s.out, "  f_des ") && strstr(s.out, "  state ") && !strstr(s.out, "  q "), "%s",
        s.out);
    said_clean(dir);
}

/* Words of others before and among it change nothing, and who looks late sees what is then. */
TEST(strangers_change_nothing_and_late_is_early_enough)
{
    const char *log;
    FILE *f;
    uint8_t byte[STREAM_DATA_B], junk[STREAM_PIECE_B];
    struct udp other;
    size_t n, len;
    int lines, same;
    dir = said_dir();
    log = a_log("4");
    said(&s, dir, cli_csv, WORDS("csv", log, "--out", said_path(dir, "c.csv")));
    CHECK_EQ_I64(s.status, 0);
    start("--hz", "20");
    CHECK_EQ_I64(udp_open(&other, "127.0.0.1:0", at), 0);
    stream_open(5);
    memset(byte, 'Z', sizeof byte);
    len = stream_piece(junk, byte, 100, 0);
    (void)udp_send(&other, junk, len);
    stream_open(77);
    f = fopen(log, "rb");
    CHECK(f != NULL && fseek(f, said_size(log) / 4, SEEK_SET) == 0, "no log");
    while ((n = fread(byte, 1, sizeof byte, f)) > 0) {
        piece(byte, (unsigned)n, 0, 0);
        if (number % 10 == 0) { (void)udp_send(&other, junk, len); }
    }
    fclose(f);
    end();
    udp_close(&other);
    CHECK(s.status == 0 && strstr(s.err, "datagrams from 127.0.0.1:"), "%d %s", s.status, s.err);
    CHECK(!strstr(s.err, "ticks were lost"), "%s", s.err);
    same = found_in(said_path(dir, "w.csv"), said_path(dir, "c.csv"), &lines);
    CHECK(same == lines && lines > 20 && lines < 40, "%d of %d", same, lines);
    said_clean(dir);
}

/* Of a hand before no world, or before one that is known from the third tick on. */
static const char *a_log_of_a_hand(const char *world_from)
{
    static char log[64];
    snprintf(log, sizeof log, "%s/bilateral_natural.exh", dir);
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--speed", "natural", "--approaches", "1", "--world-from", world_from,
            "--out", dir));
    CHECK(s.status == 0, "%s", s.err);
    return log;
}

/* No plane is no distance of -2 m, and no contact none at 2 m. */
TEST(what_there_is_none_of_is_left_out)
{
    int lines;
    dir = said_dir();
    lines = samples_of_the_log(a_log_of_a_hand("0"), "100");
    CHECK(lines > 100, "%d", lines);
    CHECK(strstr(s.out, "  d[1] -  q_lim[1] -\n") && !strstr(s.out, "-2 m"), "%.999s", s.out);
    CHECK(strstr(s.out, "  d[1] -0."), "nor is it told when there is one: %.999s", s.out);
    said_clean(dir);
}

/* Width and height of a PNG; 0: it is none. */
static unsigned png_size(const char *path, unsigned *height)
{
    static const uint8_t begins[16] = {
        0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R'};
    uint8_t byte[24] = {0};
    FILE *f = fopen(path, "rb");
    size_t n = 0;
    if (f) {
        n = fread(byte, 1, sizeof byte, f);
        fclose(f);
    }
    if (n < sizeof byte || memcmp(byte, begins, sizeof begins) != 0) { return 0; }
    *height = (unsigned)byte[22] << 8 | byte[23];
    return (unsigned)byte[18] << 8 | byte[19];
}

/* A panel for each signal, so a picture of two is higher than one of one. */
TEST(a_picture_is_drawn)
{
    const char *const signals[] = {"q", "q,f_des"};
    unsigned height[2] = {0, 0};
    if (system("command -v gnuplot >/dev/null 2>&1") != 0) {
        check_note("no gnuplot here: no picture of a running box");
        return;
    }
    for (size_t i = 0; i < 2; i++) {
        const char *log;
        char option[32];
        dir = said_dir();
        log = a_log("4");
        snprintf(option, sizeof option, "--signals=%s", signals[i]);
        start(option, said_path_as_option("plot", "it's.png"));
        send_file(log, 0);
        end();
        CHECK(s.status == 0 && strstr(s.err, "picture: ") && strstr(s.err, "it's.png"), "%d %s",
            s.status, s.err);
        CHECK_EQ_I64(png_size(said_path(dir, "it's.png"), &height[i]), 1400);
        said_clean(dir);
    }
    CHECK(height[1] > height[0], "%u and %u px", height[0], height[1]);
}

static struct terminal tty;

static int watch_on_terminal(int argc, char **argv)
{
    return dup2(tty.slave, STDOUT_FILENO) < 0 ? 99 : cli_watch(argc, argv);
}

static int count(const char *text, const char *part)
{
    int n = 0;
    for (const char *p = strstr(text, part); p; p = strstr(p + 1, part)) { n++; }
    return n;
}

/* Cleared once, then drawn over from its corner; the cursor is hidden and comes back. */
TEST(a_terminal_is_drawn_over)
{
    static char text[262144];
    FILE *f;
    uint8_t byte[STREAM_DATA_B];
    size_t n;
    if (terminal_open(&tty) < 0) { return; }
    dir = said_dir();
    f = fopen(a_log("4"), "rb");
    watch = watch_on_terminal;
    start("--signals", "q,state");
    watch = cli_watch;
    text[0] = '\0';
    CHECK(f != NULL, "no log");
    while ((n = fread(byte, 1, sizeof byte, f)) ==
           sizeof byte) { /* but its last bytes: it falls silent */
        piece(byte, (unsigned)n, 0, 0);
        pause_ms(1); /* some seconds: pictures are four a second */
        terminal_read(&tty, text, sizeof text);
    }
    fclose(f);
    for (int i = 0; i < 3000 && strstr(text, "SILENT") == NULL; i++) {
        pause_ms(10);
        terminal_read(&tty, text, sizeof text);
    }
    kill(watcher, SIGINT);
    pause_ms(200);
    terminal_read(&tty, text, sizeof text);
    end();
    terminal_read(&tty, text, sizeof text);
    CHECK(s.status == 130, "%d %s", s.status, s.err);
    CHECK(count(text, "\033[2J") == 1 && count(text, "\033[H") >= 4,
        "cleared %d times, drawn %d times", count(text, "\033[2J"), count(text, "\033[H"));
    CHECK(count(text, "\033[?25l") == 1 && count(text, "\033[?25h") == 1, "the cursor");
    CHECK(strstr(text, "drop, 2000 Hz   ") && strstr(text, "state   run: ") &&
              strstr(text, "faults  none"),
        "%s", text);
    CHECK(strstr(text, "SILENT for "), "it does not tell of silence");
    CHECK(strstr(text, "Ctrl-C ends it\033[J"), "what stood below stays");
    terminal_close(&tty);
    said_clean(dir);
}

TEST(what_there_is_none_of_leaves_its_place_empty)
{
    static char text[262144];
    const char *row, *log;
    size_t empty;
    if (terminal_open(&tty) < 0) { return; }
    dir = said_dir();
    log = a_log_of_a_hand("100"); /* first: an unread terminal blocks the watcher */
    watch = watch_on_terminal;
    start("--signals", "d,c");
    watch = cli_watch;
    text[0] = '\0';
    send_file(log, 0);
    for (int i = 0; i < 3000 && strstr(text, "c[1] ") == NULL; i++) { /* a busy machine */
        pause_ms(10);
        terminal_read(&tty, text, sizeof text);
    }
    kill(watcher, SIGINT);
    end();
    row = strstr(text, "  d[1] ");
    CHECK(row != NULL, "%s", text);
    empty = strspn(row + 6, " ");
    CHECK(empty >= 34 && row[6 + empty] == '\033', "%.80s", row);
    terminal_close(&tty);
    said_clean(dir);
}

/* Of a box that was let go: what a person does next. On a terminal that can't be drawn on, as
 * lines; without colour where NO_COLOR asks for none. */
TEST(how_to_clear_is_told)
{
    static char text[262144];
    char log[64];
    dir = said_dir();
    snprintf(log, sizeof log, "%s/a.exh", dir);
    said(&s, dir, cli_run, WORDS("run", "--seconds", "3", "--let-go", "1", "--log", log));
    start("--seconds", "60");
    send_file(log, 0);
    end();
    CHECK(strstr(s.out, "to clear: let go of the dead-man switch, hold it again, then command") &&
              count(s.out, "to clear: ") == 1,
        "%s", s.out);
    for (int plain = 0; plain < 3; plain++) {
        if (terminal_open(&tty) < 0) { break; }
        setenv("TERM", plain == 2 ? "dumb" : "xterm", 1);
        if (plain == 1) { setenv("NO_COLOR", "1", 1); }
        watch = watch_on_terminal;
        start("--seconds", "60");
        watch = cli_watch;
        unsetenv("NO_COLOR");
        text[0] = '\0';
        send_file(log, 0);
        for (int i = 0; i < 3000 && strstr(text, "hold it again, then") == NULL; i++) {
            pause_ms(10);
            terminal_read(&tty, text, sizeof text);
        }
        kill(watcher, SIGINT);
        end();
        CHECK(strstr(text, "hold it again, then command CLEAR"), "%d: %s", plain, text);
        CHECK((count(text, "\033[7m") > 0) == (plain == 0), "%d: colour", plain);
        CHECK((strchr(text, '\033') != NULL) == (plain < 2), "%d: drawn", plain);
        terminal_close(&tty);
    }
    said_clean(dir);
}

TEST(silence_is_told_with_its_age)
{
    dir = said_dir();
    start("--seconds", "3");
    end();
    CHECK(s.status == 1 && strstr(s.err, "nothing was heard"), "%d %s", s.status, s.err);
    CHECK(strstr(s.out, "silent for 2.") || strstr(s.out, "silent for 3."), "%s",
        s.out); /* a busy machine draws late */
    said_clean(dir);
}

TEST(another_table_is_refused_by_name)
{
    uint8_t byte[512];
    struct exh_bytes c = exh_bytes_writer(byte, sizeof byte);
    struct exh_record_header h = {.scene = "drop", .signal_crc = 1, .T = {1, 2000}, .signals = 11};
    dir = said_dir();
    start("--hz", "10");
    exh_record_begin(&c, EXH_RECORD_HEADER, 0, 0);
    exh_record_header_serialize(&c, &h);
    piece(byte, exh_record_end(&c), 0, 0);
    end();
    CHECK(
        s.status == 1 && strstr(s.err, "scene drop: the box's table of signals (11, CRC 00000001)"),
        "%d %s", s.status, s.err);
    said_clean(dir);
}

TEST(bad_usage)
{
    static const struct {
        const char *word[5], *said;
    } row[] = {{{"watch", NULL}, "--modbus or --listen"},
        {{"watch", "--listen", "here", NULL}, "give ADDRESS:PORT"},
        {{"watch", "--listen", "127.0.0.1:0", "--finger=nose", NULL}, "--finger: nose"},
        {{"watch", "--listen", "127.0.0.1:0", "--csv=/nowhere/x", NULL}, "--csv: /nowhere/x"}};
    const char *log;
    dir = said_dir();
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        said(&s, dir, cli_watch, row[i].word);
        CHECK(
            s.status == 2 && strstr(s.err, row[i].said), "%s: %d %s", row[i].said, s.status, s.err);
    }
    log = a_log("0.5");
    start("--signals", "q,nose");
    send_file(log, 0);
    end();
    CHECK(s.status == 2 && strstr(s.err, "nose: no such signal: one of q qd f_des"), "%d %s",
        s.status, s.err);
    start("--signals", "f_dse");
    send_file(log, 0);
    end();
    CHECK(s.status == 2 && strstr(s.err, "f_dse: no such signal: did you mean f_des?: one of q "),
        "%d %s", s.status, s.err);
    said_clean(dir);
}

TEST_MAIN("watch", samples_are_the_logs_values, how_to_clear_is_told, lost_pieces_are_told,
    strangers_change_nothing_and_late_is_early_enough, a_picture_is_drawn,
    what_there_is_none_of_is_left_out, what_there_is_none_of_leaves_its_place_empty,
    a_terminal_is_drawn_over, silence_is_told_with_its_age, another_table_is_refused_by_name,
    bad_usage);
