/* SPDX-License-Identifier: MIT */
/* exhand watch --modbus of a box that `exhand run --modbus` is. */
#include "modbus_rig.h"

#ifndef EXH_MODBUS
RIG_NONE("modbus_watch");
#else

static struct said s;
static char where[64];

static void serve(struct rig *r, const char *const *word)
{
    rig_start(r, word);
    snprintf(where, sizeof where, "tcp:127.0.0.1:%d", r->port);
}

/* Lines of a CSV, and whether its ticks rise. */
static int lines_of(const char *path)
{
    FILE *f = fopen(path, "r");
    char line[512];
    double was = -1;
    int n = 0;
    CHECK(f != NULL && fgets(line, sizeof line, f), "no table");
    for (; fgets(line, sizeof line, f); n++) {
        const double t = strtod(line, NULL);
        CHECK(t > was, "%s does not rise", line);
        was = t;
    }
    fclose(f);
    return n;
}

TEST(a_running_box_is_watched)
{
    struct rig r;
    int n;
    serve(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
    said(&s, r.dir, cli_watch,
        WORDS("watch", "--modbus", where, "--seconds", "2", "--hz", "20", "--csv",
            said_path(r.dir, "w.csv"), "--signals", "q,f_des"));
    CHECK(s.status == 0, "%d %s", s.status, s.err);
    n = lines_of(said_path(r.dir, "w.csv"));
    CHECK(n >= 2 && n <= 41, "%d samples of 40", n);
    CHECK(strstr(s.out, "faults none") && strstr(s.out, "  q ") && !strstr(s.out, "  qd "), "%s",
        s.out);
    rig_end(&r, 130);
    said_clean(r.dir);
}

/* The watcher's own files, as both say something. */
TEST(a_box_that_falls_silent_and_comes_back)
{
    char *dir = said_dir(), own[64];
    struct rig r;
    pid_t watcher;
    strcpy(own, dir);
    serve(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
    watcher = said_start(own, cli_watch, WORDS("watch", "--modbus", where));
    rig_sleep(0.7);
    kill(r.pid, SIGSTOP);
    rig_sleep(3);
    kill(r.pid, SIGCONT);
    rig_sleep(2);
    kill(watcher, SIGINT);
    said_end(&s, own, watcher);
    CHECK(s.status == 130, "%d %s", s.status, s.err);
    CHECK(strstr(s.out, "silent for 1.") || strstr(s.out, "silent for 2."), "%s", s.out);
    CHECK(strstr(strstr(s.out, "silent for"), "  faults "), "it does not come back: %s", s.out);
    rig_end(&r, 130);
    said_clean(r.dir);
    said_clean(own);
}

/* Ticks of a trace: how many frames are missing between its first and last. */
static int missing_of(const char *path, int every, int *lines)
{
    FILE *f = fopen(path, "r");
    char line[512];
    long was = -1;
    int missing = 0;
    CHECK(f != NULL && fgets(line, sizeof line, f), "no table");
    for (*lines = 0; fgets(line, sizeof line, f); ++*lines) {
        const long tick = strtol(strchr(line, ',') + 1, NULL, 10);
        CHECK(was < 0 || ((tick - was) % every == 0 && tick > was), "%ld behind %ld", tick, was);
        missing += was >= 0 ? (int)(tick - was) / every - 1 : 0;
        was = tick;
    }
    fclose(f);
    return missing;
}

TEST(a_trace_has_every_frame_or_says_what_it_lost)
{
    struct rig r;
    int lines = 0, missing = 0, lost;
    const char *said_lost;
    serve(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
    /* On a busy machine some reads come too late: then it says so, and one of ten tries has all. */
    for (int i = 0; i < 10; i++) {
        said(&s, r.dir, cli_watch,
            WORDS("watch", "--modbus", where, "--seconds", "2", "--trace", "20", "--csv",
                said_path(r.dir, "w.csv"), "--signals", "q,f_des,state"));
        missing = missing_of(said_path(r.dir, "w.csv"), 20, &lines);
        CHECK(s.status == 0 && (missing == 0 || strstr(s.err, "lost")), "%d, missing %d %s",
            s.status, missing, s.err);
        if (missing == 0 && lines >= 20) { break; }
    }
    CHECK(missing == 0 && lines >= 20 && !strstr(s.err, "lost"), "missing %d of %d: %s", missing,
        lines, s.err);
    said(&s, r.dir, cli_watch,
        WORDS("watch", "--modbus", where, "--seconds", "3", "--trace", "1", "--hz", "2", "--csv",
            said_path(r.dir, "w.csv")));
    missing = missing_of(said_path(r.dir, "w.csv"), 1, &lines);
    said_lost = strstr(s.err, "exhand watch: ");
    lost = said_lost ? atoi(said_lost + 14) : 0;
    CHECK(s.status == 0 && strstr(s.err, "frames were lost"), "%d %s", s.status, s.err);
    /* Frames before the first one that was read count as lost, too: those of half a second. */
    CHECK(lost >= missing && missing > 100 && lost - missing < 2000, "%d missing, %d told as lost",
        missing, lost);
    check_note(
        "looked at twice a second: %d frames of 2000 a second read, %d told as lost", lines, lost);
    rig_end(&r, 130);
    said_clean(r.dir);
}

TEST(nobody_there)
{
    char *dir = said_dir();
    said(&s, dir, cli_watch, WORDS("watch", "--modbus", "tcp:127.0.0.1:1"));
    CHECK(s.status == 3 && strstr(s.err, "is the box there"), "%d %s", s.status, s.err);
    said(&s, dir, cli_watch, WORDS("watch", "--modbus", "udp:127.0.0.1:1"));
    CHECK(s.status == 2 && strstr(s.err, "give tcp:ADDRESS:PORT"), "%d %s", s.status, s.err);
    said(&s, dir, cli_watch, WORDS("watch", "--modbus", "rtu:/dev/nowhere:9600"));
    CHECK(s.status == 3, "%d %s", s.status, s.err);
    said_clean(dir);
}

TEST_MAIN("modbus_watch", a_running_box_is_watched, a_box_that_falls_silent_and_comes_back,
    a_trace_has_every_frame_or_says_what_it_lost, nobody_there);
#endif
