/* SPDX-License-Identifier: MIT */
/* The one writer of all files: whole at its name or not there, what stood there safe, and nothing
 * left. */
#include "said.h"

#include "base/ends.h"
#include "base/outfile.h"
#include "base/outpart.h"

#include <dirent.h>
#include <errno.h>
#include <sys/resource.h>

static char *dir;

static int entries(void)
{
    DIR *d = opendir(dir);
    int n = 0;
    while (d && readdir(d) != NULL) { n++; }
    if (d) { closedir(d); }
    return n - 2;
}

static void put(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    CHECK(f != NULL && fputs(text, f) >= 0 && fclose(f) == 0, "%s", path);
}

static int holds(const char *path, const char *text)
{
    char got[SAID_B];
    said_read(got, path);
    return strcmp(got, text) == 0;
}

static struct stat of(const char *path)
{
    struct stat st;
    CHECK(lstat(path, &st) == 0, "%s: not there", path);
    return st;
}

static void writes(const char *path, const char *text)
{
    FILE *f = outfile_open("out", path);
    CHECK(f != NULL && fputs(text, f) >= 0, "%s", path);
    CHECK_EQ_I64(outfile_close(f), 0);
}

TEST(whole_at_its_name_or_not_there)
{
    const char *path;
    FILE *f;
    dir = said_dir();
    path = said_path(dir, "a");
    f = outfile_open("out", path);
    CHECK(f != NULL && said_size(path) < 0 && entries() == 1, "seen before it is whole");
    fputs("one", f);
    CHECK_EQ_I64(outfile_close(f), 0);
    CHECK(holds(path, "one") && entries() == 1, "%d entries", entries());
    f = outfile_open("out", path);
    CHECK(f != NULL && fputs("two", f) >= 0 && fflush(f) == 0 && holds(path, "one"), "the old one");
    outfile_abandon(f);
    CHECK(holds(path, "one") && entries() == 1, "%d entries", entries());
    said_clean(dir);
}

TEST(mode_and_links_stay)
{
    const char *path, *link;
    dir = said_dir();
    path = said_path(dir, "a");
    link = said_path(dir, "link");
    put(path, "old");
    CHECK(chmod(path, 0640) == 0 && symlink("a", link) == 0, "no link");
    writes(link, "new");
    CHECK(S_ISLNK(of(link).st_mode) && (of(path).st_mode & 07777) == 0640, "%o", of(path).st_mode);
    CHECK(holds(path, "new") && entries() == 2, "%d entries", entries());
    CHECK_EQ_I64(remove(path), 0);
    writes(link, "newer"); /* the link leads to nothing */
    CHECK(S_ISLNK(of(link).st_mode) && holds(path, "newer"), "not through the link");
    said_clean(dir);
}

/* A full disk represents any failure at the end. */
TEST(a_failed_write_leaves_the_old_one)
{
    const struct rlimit few = {100, RLIM_INFINITY};
    struct rlimit was;
    const char *path;
    FILE *f;
    dir = said_dir();
    path = said_path(dir, "a");
    put(path, "old");
    CHECK_EQ_I64(getrlimit(RLIMIT_FSIZE, &was), 0);
    signal(SIGXFSZ, SIG_IGN);
    CHECK_EQ_I64(setrlimit(RLIMIT_FSIZE, &few), 0);
    f = outfile_open("out", path);
    for (int i = 0; f && i < 100000; i++) { fputs("more than there is room for\n", f); }
    CHECK(f != NULL && outfile_close(f) == 1, "a file that is too large was taken");
    CHECK_EQ_I64(setrlimit(RLIMIT_FSIZE, &was), 0);
    CHECK(holds(path, "old") && entries() == 1, "%d entries", entries());
    said_clean(dir);
}

TEST(what_is_no_file_is_written_in_place)
{
    const char *fifo;
    char got[8] = "";
    int fd;
    dir = said_dir();
    fifo = said_path(dir, "fifo");
    CHECK_EQ_I64(mkfifo(fifo, 0600), 0);
    fd = open(fifo, O_RDWR);
    writes(fifo, "through");
    CHECK(read(fd, got, 7) == 7 && strcmp(got, "through") == 0, "%s", got);
    close(fd);
    CHECK(S_ISFIFO(of(fifo).st_mode) && entries() == 1, "%d entries", entries());
    writes("/dev/null", "away");
    CHECK(S_ISCHR(of("/dev/null").st_mode), "the device is gone");
    CHECK(outfile_open("out", dir) == NULL, "a directory");
    said_clean(dir);
}

TEST(two_writers_are_refused)
{
    struct outpart a, b;
    const char *path, *link;
    dir = said_dir();
    path = said_path(dir, "a");
    link = said_path(dir, "link");
    CHECK_EQ_I64(symlink(path, link), 0);
    CHECK_EQ_I64(outpart_open(&a, path), 0);
    CHECK_EQ_I64(outpart_open(&b, link), EBUSY);
    if (fork() == 0) { _exit(outpart_open(&b, path) == EBUSY ? 0 : 1); }
    {
        int status = 1;
        CHECK(wait(&status) > 0 && status == 0, "another process got it: %d", status);
    }
    CHECK_EQ_I64(outpart_commit(&a), 0);
    CHECK_EQ_I64(outpart_open(&b, path), EBUSY); /* more may be appended */
    outpart_abandon(&a);
    CHECK_EQ_I64(outpart_open(&b, path), 0);
    outpart_abandon(&b);
    CHECK_EQ_I64(entries(), 2);
    said_clean(dir);
}

TEST(options_are_tried_before)
{
    const char *path, *link, *dot;
    struct outfile_option o[3] = {{"log", NULL}, {"blackbox", "/nosuchdir/x"}, {"save", NULL}};
    dir = said_dir();
    path = said_path(dir, "a");
    link = said_path(dir, "link");
    dot = said_path(dir, "./a");
    CHECK_EQ_I64(outfile_try(o, 3), 2);
    o[1].path = dir;
    CHECK_EQ_I64(outfile_try(o, 3), 2);
    o[1].path = "";
    CHECK_EQ_I64(outfile_try(o, 3), 2);
    o[0].path = path;
    o[1].path = dot;
    CHECK_EQ_I64(outfile_try(o, 3), 2); /* not there yet, but the same file */
    CHECK_EQ_I64(symlink("a", link), 0);
    o[1].path = NULL;
    o[2].path = link;
    CHECK_EQ_I64(outfile_try(o, 3), 2);
    put(path, "old");
    CHECK_EQ_I64(outfile_try(o, 3), 2);
    o[2].path = "/dev/null";
    CHECK_EQ_I64(outfile_try(o, 3), 0);
    CHECK(holds(path, "old") && entries() == 2, "a trial leaves something: %d", entries());
    said_clean(dir);
}

/* What a killed writer left, with whatever mode, is taken over. */
TEST(killed_writers_leave_what_the_next_takes)
{
    const char *path;
    pid_t pid;
    int status, go[2];
    char c;
    dir = said_dir();
    path = said_path(dir, "a");
    put(path, "old");
    CHECK_EQ_I64(pipe(go), 0);
    pid = fork();
    if (pid == 0) {
        FILE *f = outfile_open("out", path);
        if (f == NULL || fputs("half", f) < 0 || fflush(f) != 0 || write(go[1], "x", 1) != 1) {
            _exit(1);
        }
        for (;;) { pause(); }
    }
    CHECK_EQ_I64(read(go[0], &c, 1), 1);
    CHECK(kill(pid, SIGKILL) == 0 && waitpid(pid, &status, 0) == pid, "lost it");
    CHECK(holds(path, "old") && entries() == 2, "%d entries", entries());
    writes(path, "new");
    CHECK(holds(path, "new") && entries() == 1, "%d entries", entries());
    close(go[0]), close(go[1]);
    said_clean(dir);
}

/* Also if the parent process had blocked the signals. */
static void ended_by(int sig, int blocked, int expected)
{
    const char *path = said_path(dir, "a");
    int status = 0, go[2];
    char c;
    pid_t pid;
    CHECK_EQ_I64(pipe(go), 0);
    pid = fork();
    if (pid == 0) {
        sigset_t set;
        signal(sig, SIG_DFL);
        sigemptyset(&set);
        sigaddset(&set, sig);
        sigprocmask(blocked ? SIG_BLOCK : SIG_UNBLOCK, &set, NULL);
        ends_begin();
        if (outfile_open("out", path) == NULL || write(go[1], "x", 1) != 1) { _exit(1); }
        for (;;) { pause(); }
    }
    CHECK_EQ_I64(read(go[0], &c, 1), 1);
    CHECK(kill(pid, sig) == 0 && waitpid(pid, &status, 0) == pid, "lost it");
    CHECK_EQ_I64(WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), expected);
    CHECK_EQ_I64(entries(), 0);
    close(go[0]), close(go[1]);
}

TEST(signals_leave_nothing)
{
    dir = said_dir();
    for (int blocked = 0; blocked < 2; blocked++) {
        ended_by(SIGINT, blocked, 130);
        ended_by(SIGTERM, blocked, 143);
        ended_by(SIGHUP, blocked, -SIGHUP);
    }
    said_clean(dir);
}

/* A child's end takes nothing of its parent's. */
TEST(children_leave_their_parents_alone)
{
    const char *path;
    FILE *f;
    int status = 1;
    dir = said_dir();
    path = said_path(dir, "a");
    f = outfile_open("out", path);
    if (fork() == 0) {
        outpart_remove_all();
        _exit(outfile_open("out", said_path(dir, "b")) ? 0 : 1); /* and has separate entries */
    }
    CHECK(wait(&status) > 0 && status == 0, "%d", status);
    fputs("whole", f);
    CHECK_EQ_I64(outfile_close(f), 0);
    CHECK(holds(path, "whole"), "%s", path);
    said_clean(dir);
}

TEST_MAIN("outfile", whole_at_its_name_or_not_there, mode_and_links_stay,
    a_failed_write_leaves_the_old_one, what_is_no_file_is_written_in_place, two_writers_are_refused,
    options_are_tried_before, killed_writers_leave_what_the_next_takes, signals_leave_nothing,
    children_leave_their_parents_alone);
