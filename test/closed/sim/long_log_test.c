/* SPDX-License-Identifier: MIT */
/* Logs longer than memory should be: read in constant memory, at any place, past 4 GiB. */
#include "said.h"

#include <sys/resource.h>

#define LONG_B   (60L << 20)
#define MEMORY_B (24L << 20) /* of all that reads it, the code and the C library in it */

static struct said s;

static void cut(const char *path, off_t len) { CHECK(truncate(path, len) == 0, "%s", path); }

static long peak_B(void)
{
    struct rusage u;
    CHECK_EQ_I64(getrusage(RUSAGE_CHILDREN, &u), 0);
    return u.ru_maxrss * 1024;
}

static const char *write_log(char *dir, const char *seconds)
{
    static char log[512]; /* said_path() forgets */
    snprintf(log, sizeof log, "%s/long.exh", dir);
    said(&s, dir, cli_run,
        WORDS(
            "run", "--scene", "bilateral", "--fingers", "all", "--seconds", seconds, "--log", log));
    CHECK(s.status == 0, "%d %s", s.status, s.err);
    return log;
}

TEST(a_long_log_takes_no_memory)
{
    char *dir = said_dir();
    const char *log = write_log(dir, "45");
    CHECK(said_size(log) > LONG_B, "%ld", said_size(log));
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0 && strstr(s.out, "90000 ticks from tick 0"), "%s%s", s.out, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log, "--from", "80000"));
    CHECK(s.status == 0 && strstr(s.out, "10128 ticks from tick 79872"), "%s%s", s.out, s.err);
    said(&s, dir, cli_csv, WORDS("csv", log, "--out", "/dev/null"));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d %s", s.status, s.err);
    cut(log, LONG_B);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 1 && strstr(s.out, " identical") &&
              strstr(s.err, "cut off before its end: read to its last whole record, tick "),
        "%d %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log, "--timeline", "--from", "70000"));
    CHECK(s.status == 1 && strstr(s.out, "force at most "), "%s", s.err);
#ifndef __SANITIZE_ADDRESS__ /* whose shadow is no memory of ours */
    CHECK(peak_B() < MEMORY_B, "%ld bytes for a log of %ld", peak_B(), LONG_B);
#endif
    said_clean(dir);
}

/* A hole in the file, behind its end and before it. */
TEST(places_are_wider_than_32_bits)
{
    char *dir = said_dir();
    const char *log = write_log(dir, "0.1");
    const off_t far = (off_t)5 << 30;
    if (sizeof far > 4) {
        cut(log, far);
        said(&s, dir, cli_replay, WORDS("replay", log));
        CHECK(s.status == 0 && strstr(s.out, "200 ticks from tick 0"), "%s%s", s.out, s.err);
    }
    said_clean(dir);
}

TEST(what_can_not_be_read_twice_is_refused_by_name)
{
    char *dir = said_dir();
    said(&s, dir, cli_csv, WORDS("csv", dir));
    CHECK(s.status == 2 && strstr(s.err, "give a regular file"), "%d %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", "/dev/null"));
    CHECK(s.status == 2 && strstr(s.err, "give a regular file"), "%d %s", s.status, s.err);
    said_clean(dir);
}

TEST_MAIN("long_log", a_long_log_takes_no_memory, places_are_wider_than_32_bits,
    what_can_not_be_read_twice_is_refused_by_name);
