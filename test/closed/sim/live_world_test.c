/* SPDX-License-Identifier: MIT */
/* exhand run --udp: a box and its world as two processes, with all that goes on beside. */
#include "modbus_rig.h"

#include "file_of.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>

#define SCENE  "ports/posix/world/scenes/collision.world"
#define WAIT_S 60 /* a slow machine is no fault */

static struct said s;
static char at[64]; /* where the world is */

static void nap(void)
{
    const struct timespec t = {0, 20000000};
    nanosleep(&t, NULL);
}

/* A socket at a free port of this machine, which `at` names. */
static int open_port(void)
{
    struct sockaddr_in a;
    socklen_t len = sizeof a;
    const int fd = socket(AF_INET, SOCK_DGRAM, 0);
    const struct timeval patience = {WAIT_S, 0};
    memset(&a, 0, sizeof a);
    a.sin_family = AF_INET;
    a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    CHECK(fd >= 0 && bind(fd, (struct sockaddr *)&a, sizeof a) == 0 &&
              getsockname(fd, (struct sockaddr *)&a, &len) == 0 &&
              setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience) == 0,
        "no port");
    snprintf(at, sizeof at, "127.0.0.1:%d", ntohs(a.sin_port));
    return fd;
}

/* key: its file, or NULL; err: where it complains, or NULL. */
static pid_t start_world(const char *key, const char *err)
{
    const char *const with = key ? "--key" : NULL;
    const pid_t pid = fork();
    CHECK(pid >= 0, "no process");
    if (pid) { return pid; }
    alarm(600);
    if (!freopen("/dev/null", "w", stdout) || (err && !freopen(err, "w", stderr))) { _exit(99); }
    execl(WORLD_PROGRAM, "world", "--headless", "--scene", SCENE, "--listen", at, with, key,
        (char *)NULL);
    _exit(98);
}

static void end_world(pid_t pid)
{
    int status;
    kill(pid, SIGKILL);
    CHECK(waitpid(pid, &status, 0) == pid && WIFSIGNALED(status), "the world ended before: %#x",
        (unsigned)status);
}

/* Until the box has said it. */
static void wait_for(const char *dir, const char *what)
{
    static char text[SAID_B];
    const time_t end = time(NULL) + WAIT_S;
    do {
        said_read(text, said_path(dir, "said.err"));
        if (strstr(text, what)) { return; }
        nap();
    } while (time(NULL) < end);
    CHECK(0, "never said: %s, but: %s", what, text);
}

static long lines(const char *text)
{
    long n = 0;
    for (; *text; text++) { n += *text == '\n'; }
    return n;
}

static double touched_s; /* of the row that was read last */

/* Of the table at the end: contacts of a finger. */
static long contacts(const char *out, const char *finger)
{
    const char *const row = strstr(out, finger);
    double lo, hi, a, b, c, d;
    long n = -1;
    CHECK(row && sscanf(row + strlen(finger), "%lf ..%lf %lf ..%lf %lf ..%lf %ld %lf", &lo, &hi, &a,
                     &b, &c, &d, &n, &touched_s) == 8,
        "%s: no row: %s", finger, out);
    return n;
}

#ifdef EXH_MODBUS

static const unsigned index_c =
    (unsigned)(offsetof(struct bilateral_signals, paper[1].c) / sizeof(int32_t));

static void wait_for_contact(struct rig *r)
{
    const time_t end = time(NULL) + WAIT_S;
    while (!rig_input(r, RIG_OUT + 2 * index_c)) {
        CHECK(time(NULL) < end, "the index touches nothing");
        nap();
    }
}

static void check_files(const char *dir)
{
    const char *const log = said_path(dir, "a.exh"), *const table = said_path(dir, "a.csv");
    said(&s, dir, cli_csv, WORDS("csv", log, "--finger", "index", "--out", table));
    CHECK(s.status == 0 && said_size(table) > 100000, "%d %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log, "--timeline"));
    CHECK(s.status == 0 && strstr(s.out, "contact begins"), "%d %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", said_path(dir, "b.exh"), "--timeline"));
    CHECK(s.status == 0 && strstr(s.out, "deadman"), "%d %s %s", s.status, s.err, s.out);
}

/* A contact, a fault, the world dead and born again, a contact: under Modbus, log and black box. */
TEST(world_modbus_log_and_black_box_together)
{
    char dir[64];
    struct rig r;
    pid_t world;
    long felt;
    strcpy(dir, said_dir());
    (void)close(open_port());
    world = start_world(NULL, NULL);
    rig_start(
        &r, WORDS("run", "--scene", "bilateral", "--udp", at, "--fingers", "index,middle", "--rate",
                "500", "--modbus", "tcp:127.0.0.1:0", "--log", said_path(dir, "a.exh"),
                "--blackbox", said_path(dir, "b.exh"), "--let-go", "3", "--grip"));
    wait_for_contact(&r);
    end_world(world);
    wait_for(r.dir, "the world has been silent for");
    world = start_world(NULL, NULL);
    wait_for(r.dir, "the world answers again");
    wait_for(r.dir, "the world began anew: its session 2");
    while (said_size(said_path(dir, "b.exh")) < 0) { nap(); }
    wait_for_contact(&r);
    rig_end(&r, 130);
    end_world(world);
    CHECK(!strstr(r.said.err, "no world"), "%s", r.said.err);
    felt = contacts(r.said.out, "  index ");
    CHECK(felt > 1 && strstr(r.said.out, "; 2 sessions; 0 packets of other"), "%s", r.said.out);
    said_clean(r.dir);
    check_files(dir);
    said_clean(dir);
    check_note("index: %ld contacts under Modbus, log and black box", felt);
}

/* `make live`, its three programs in one group. */
static int live(int argc, char **argv)
{
    (void)argc;
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    if (argv[1]) { setenv("LIVE_SECONDS", argv[1], 1); }
    execl("ports/posix/live.sh", "live.sh", EXHAND_PROGRAM, WORLD_PROGRAM, (char *)NULL);
    return 99;
}

static void live_ended(const char *dir, pid_t group, int status)
{
    said_end(&s, dir, group);
    CHECK(s.status == status, "%d, want %d: %s %s", s.status, status, s.out, s.err);
    CHECK(kill(-group, 0) == -1 && errno == ESRCH, "a process is left");
}

/* Whether a process is of this group and its command line has this word; blanks are zeros there. */
static int is_of(const char *pid, pid_t group, const char *word)
{
    static char line[SAID_B];
    char path[64];
    int n, of = 0;
    snprintf(path, sizeof path, "/proc/%.20s/stat", pid);
    said_read(line, path);
    if (sscanf(line, "%*d (%*[^)]) %*c %*d %d", &of) != 1 || of != group) { return 0; }
    snprintf(path, sizeof path, "/proc/%.20s/cmdline", pid);
    memset(line, 0, sizeof line);
    said_read(line, path);
    for (n = 0; line[n] || line[n + 1]; n += (int)strlen(line + n) + 1) {
        if (strcmp(line + n, word) == 0) { return 1; }
    }
    return 0;
}

static pid_t program_of(pid_t group, const char *word)
{
    const struct dirent *e;
    pid_t pid = 0;
    DIR *d = opendir("/proc");
    CHECK(d != NULL, "no /proc");
    while (pid == 0 && (e = readdir(d)) != NULL) {
        if (is_of(e->d_name, group, word)) { pid = atoi(e->d_name); }
    }
    closedir(d);
    CHECK(pid > 0, "no process with %s", word);
    return pid;
}

static void wait_for_watch(const char *dir)
{
    static char text[SAID_B];
    const time_t end = time(NULL) + WAIT_S;
    do {
        nap();
        said_read(text, said_path(dir, "said.out"));
        CHECK(time(NULL) < end, "nothing is watched: %s", text);
    } while (!strstr(text, " s  "));
}

/* By its time, by Ctrl-C, and as one of the three ends: no process is left, and no wait. */
TEST(make_live_ends_all_three)
{
    static const struct {
        const char *seconds, *kill; /* both NULL: Ctrl-C */
        int status;
    } way[] = {{"4", NULL, 0}, {NULL, NULL, 130}, {NULL, "--headless", 137}, {NULL, "run", 137},
        {NULL, "watch", 137}};
    char *dir = said_dir();
    for (size_t i = 0; i < sizeof way / sizeof way[0]; i++) {
        const pid_t group = said_start(dir, live, WORDS("live", way[i].seconds));
        if (way[i].seconds == NULL) { wait_for_watch(dir); }
        if (way[i].kill) {
            kill(program_of(group, way[i].kill), SIGKILL);
        } else if (way[i].seconds == NULL) {
            kill(-group, SIGINT);
        }
        live_ended(dir, group, way[i].status);
        CHECK(strstr(s.out, "it runs without pictures") && strstr(s.out, "box: modbus: tcp:"), "%s",
            s.out);
        if (i == 0) { CHECK(contacts(s.out, "  index ") > 0, "%s", s.out); }
    }
    said_clean(dir);
}

#else
TEST(make_live_ends_all_three) { check_note("libmodbus is not here: not tried"); }

TEST(world_modbus_log_and_black_box_together) { check_note("libmodbus is not here: not tried"); }
#endif

TEST(a_world_that_is_not_there_is_said_and_fails)
{
    char *dir = said_dir(), line[200];
    (void)close(open_port());
    snprintf(line, sizeof line,
        "--udp %s: no world answers: start `world --scene FILE --listen %s` there\n", at, at);
    said(&s, dir, cli_run,
        WORDS("run", "--scene", "bilateral", "--udp", at, "--rate", "500", "--seconds", "3"));
    CHECK(s.status == 1 && strstr(s.err, line), "%d %s", s.status, s.err);
    CHECK(strstr(s.out, "no world") && strstr(s.out, ": 0 packets"), "%s", s.out);
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--udp", at, "--rate", "500", "--speed", "fast", "--approaches", "1"));
    CHECK(s.status == 1 && strstr(s.err, line), "%d %s", s.status, s.err);
    said_clean(dir);
}

static const char *key_in(char path[512], const char *dir, const char *name, const char *digits)
{
    FILE *f;
    (void)snprintf(path, 512, "%s/%s", dir, name);
    f = fopen(path, "w");
    CHECK(f && fputs(digits, f) >= 0 && fclose(f) == 0 && chmod(path, 0600) == 0, "%s", path);
    return path;
}

/* Both with the key, one of them with another or with none: who lacks it is not answered. */
TEST(only_who_has_the_key_is_answered)
{
    static char text[SAID_B];
    char *dir = said_dir(), path[2][512];
    const char *const a = key_in(path[0], dir, "a", "000102030405060708090a0b0c0d0e0f"),
                      *const b = key_in(path[1], dir, "b", "100102030405060708090a0b0c0d0e0f");
    const struct {
        const char *box, *world, *says; /* the world, of the box */
    } way[] = {{a, a, NULL}, {a, b, "packets come with another key"},
        {a, NULL, "of another version, or with a key"}, {NULL, a, "packets come without a key"}};
    (void)close(open_port());
    for (size_t i = 0; i < sizeof way / sizeof way[0]; i++) {
        const char *const err = said_path(dir, "world.err");
        const pid_t world = start_world(way[i].world, err);
        const char *const with = way[i].box ? "--key" : NULL;
        said(&s, dir, cli_run,
            WORDS("run", "--scene", "bilateral", "--udp", at, "--rate", "500", "--seconds",
                way[i].says ? "3" : "4", with, way[i].box));
        end_world(world);
        said_read(text, err);
        if (way[i].says == NULL) {
            CHECK(s.status == 0 && contacts(s.out, "  index ") > 0, "%s %s", s.out, s.err);
            CHECK(strstr(s.out, "taken; 0 without a key, 0 of another key"), "%s", s.out);
        } else {
            CHECK(s.status == 1 && strstr(s.out, ": 0 packets came"), "%zu: %s", i, s.out);
            CHECK(strstr(text, way[i].says), "%zu: %s", i, text);
        }
    }
    said_clean(dir);
}

/* Of the box that sent to this socket: where it is. */
static struct sockaddr_in heard(int fd)
{
    struct sockaddr_in from;
    socklen_t len = sizeof from;
    char buf[512];
    CHECK(recvfrom(fd, buf, sizeof buf, 0, (struct sockaddr *)&from, &len) > 0, "no box");
    return from;
}

static void put(int fd, const struct sockaddr_in *to, int n)
{
    static const char junk[40] = "XW";
    for (int i = 0; i < n; i++) {
        CHECK(
            sendto(fd, junk, sizeof junk, 0, (const struct sockaddr *)to, sizeof *to) > 0, "send");
    }
}

/* Longer than a scene's packet, than any of ours, and none. */
static void put_long(int fd, const struct sockaddr_in *to)
{
    static const char junk[2000] = "XW";
    static const size_t len_B[] = {257, sizeof junk, 0};
    for (int i = 0; i < 3; i++) {
        CHECK(sendto(fd, junk, len_B[i], 0, (const struct sockaddr *)to, sizeof *to) ==
                  (ssize_t)len_B[i],
            "send");
    }
}

/* Packets from the right place that no world sends, and packets from elsewhere. */
TEST(packets_that_are_no_worlds_are_said_and_counted)
{
    char *dir = said_dir();
    const int other = open_port(), here = open_port(); /* `at` is the second */
    struct sockaddr_in box;
    const pid_t pid = said_start(dir, cli_run,
        WORDS("run", "--scene", "bilateral", "--udp", at, "--rate", "500", "--seconds", "5"));
    box = heard(here);
    put(other, &box, 3);
    put(here, &box, 7);
    put_long(here, &box);
    said_end(&s, dir, pid);
    CHECK(s.status == 1, "%d %s", s.status, s.err);
    CHECK(strstr(s.err, "packets of another sender come, too"), "%s", s.err);
    CHECK(strstr(s.err, "no world answers: 7 packets came that no world of this version sends"),
        "%s", s.err);
    CHECK(strstr(s.out,
              " 7 refused; 0 sessions; 3 packets of other senders, 3 of the world's too long"),
        "%s", s.out);
    close(other);
    close(here);
    said_clean(dir);
}

TEST(bad_addresses_and_other_scenes_are_refused)
{
    static const struct {
        const char *udp, *scene, *why;
    } bad[] = {
        {"127.0.0.1", "bilateral", "no host and port"},
        {":4000", "bilateral", "no host and port"},
        {"127.0.0.1:", "bilateral", "no port"},
        {"127.0.0.1:0", "bilateral", "no port from 1 to 65535"},
        {"127.0.0.1:65536", "bilateral", "no port from 1 to 65535"},
        {"127.0.0.1:4000x", "bilateral", "no port"},
        {"127.0.0.1:-4", "bilateral", "no port"},
        {"nobody.invalid:4000", "bilateral", ": give HOST:PORT"},
        {"127.0.0.1:4000", "drop", "goes with --scene bilateral, not drop"},
        {"127.0.0.1:4000", "guarded", "goes with --scene bilateral, not guarded"},
    };
    char *dir = said_dir(), start[80];
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        said(&s, dir, cli_run,
            WORDS("run", "--scene", bad[i].scene, "--udp", bad[i].udp, "--seconds", "1"));
        snprintf(start, sizeof start, "exhand run: --udp: %s: ", bad[i].udp);
        CHECK(s.status == 2 && strncmp(s.err, start, strlen(start)) == 0 &&
                  strstr(s.err, bad[i].why) && lines(s.err) == 1,
            "%s: %d %s", bad[i].udp, s.status, s.err);
        if (strcmp(bad[i].scene, "bilateral") != 0) { continue; }
        said(&s, dir, cli_bilateral, WORDS("bilateral", "--udp", bad[i].udp));
        CHECK(s.status == 2 && strstr(s.err, bad[i].why), "%s: %d %s", bad[i].udp, s.status, s.err);
    }
    said_clean(dir);
}

/* 0.04 m of string and back, at a fixed wall at 0.03 m. */
TEST(a_recording_is_played_again_and_again)
{
    const char *const file = file_of("0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n"
                                     "0,0,0,0,2,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n"
                                     "0,0,0,0,2,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n"
                                     "0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n");
    char *dir = said_dir();
    said(&s, dir, cli_run,
        WORDS("run", "--scene", "bilateral", "--record", file, "--record-rate", "2", "--rate",
            "500", "--seconds", "30"));
    CHECK(s.status == 0, "%d %s", s.status, s.err);
    /* 3 s a round, a second of rest before. It may bounce; one round touches for 0.6 s. */
    CHECK(contacts(s.out, "  index ") >= 10 && touched_s > 3, "%s", s.out);
    said(&s, dir, cli_run, WORDS("run", "--record", file, "--seconds", "1"));
    CHECK(s.status == 2 && strstr(s.err, "--record: ") && strstr(s.err, "not drop"), "%d %s",
        s.status, s.err);
    (void)remove(file);
    said(
        &s, dir, cli_run, WORDS("run", "--scene", "bilateral", "--record", file, "--seconds", "1"));
    CHECK(s.status == 3 && strstr(s.err, file), "%d %s", s.status, s.err);
    said_clean(dir);
}

TEST_MAIN("live_world", world_modbus_log_and_black_box_together, only_who_has_the_key_is_answered,
    a_world_that_is_not_there_is_said_and_fails, packets_that_are_no_worlds_are_said_and_counted,
    bad_addresses_and_other_scenes_are_refused, make_live_ends_all_three,
    a_recording_is_played_again_and_again);
