/* exhand run: goes on, ends when asked, and leaves a log that replays. */
#include "said.h"

#include <time.h>

static void replay(const char *dir, const char *log, struct said *s)
{
    said(s, dir, cli_replay, WORDS("replay", log, "--timeline"));
    CHECK(s->status == 0, "%s", s->err);
}

static int times(const char *text, const char *part)
{
    int n = 0;
    for (const char *at = strstr(text, part); at; at = strstr(at + 1, part)) { n++; }
    return n;
}

TEST(each_scene_goes_on_until_its_time_is_over)
{
    static const char *const scene[] = {"drop", "guarded", "bilateral"};
    for (size_t i = 0; i < sizeof scene / sizeof scene[0]; i++) {
        char *dir = said_dir();
        const char *log = said_path(dir, "a.exh");
        struct said s;
        said(&s, dir, cli_run,
             WORDS("run", "--scene", scene[i], "--seconds", "12", "--rate", "1000", "--log", log));
        CHECK(s.status == 0, "%s: %d %s", scene[i], s.status, s.err);
        CHECK(strcmp(s.out, "12000 ticks, 12 s, faults none\n") == 0, "%s", s.out);
        replay(dir, log, &s);
        CHECK_EQ_I64(times(s.out, "command: run"), 1);
        CHECK(times(s.out, "contact begins") >= 3, "%s: %d contacts", scene[i],
              times(s.out, "contact begins"));
        said_clean(dir);
    }
}

/* Less than a tick is one, not for ever. */
TEST(the_shortest_time_ends)
{
    char *dir = said_dir();
    struct said s;
    said(&s, dir, cli_run, WORDS("run", "--seconds", "1e-9"));
    CHECK(s.status == 0 && strncmp(s.out, "1 ticks", 7) == 0, "%d %s", s.status, s.out);
    said_clean(dir);
}

/* The grip is the person's: a fault is cleared, and the box run, by two new ones, and by none unasked. */
TEST(after_a_fault_it_runs_again_by_the_grip_alone)
{
    for (int grip = 0; grip < 2; grip++) {
        char *dir = said_dir();
        const char *log = said_path(dir, "a.exh");
        const char *const word[] = {
            "run", "--seconds", "20", "--let-go", "5", "--log", log, grip ? "--grip" : NULL, NULL};
        struct said s;
        said(&s, dir, cli_run, word);
        CHECK(s.status == 0, "%s", s.err);
        CHECK(strstr(s.out, "deadman") != NULL, "%s", s.out);
        replay(dir, log, &s);
        CHECK_EQ_I64(times(s.out, "run -> release"), 1);
        CHECK_EQ_I64(times(s.out, "command: clear"), grip);
        CHECK_EQ_I64(times(s.out, "arm -> run"), 1 + grip);
        CHECK(grip || times(s.out, "command: run") == 1, "asked by nobody");
        said_clean(dir);
    }
}

TEST(an_interrupt_leaves_a_complete_log)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "a.exh");
    const struct timespec while_it_runs = {0, 400000000};
    struct said s;
    const pid_t pid =
        said_start(dir, cli_run, WORDS("run", "--pace", "--rate", "1000", "--log", log));
    nanosleep(&while_it_runs, NULL);
    CHECK(said_size(log) > 0, "it has not begun");
    kill(pid, SIGINT);
    said_end(&s, dir, pid);
    CHECK(s.status == 130, "%d %s", s.status, s.err);
    replay(dir, log, &s);
    CHECK(strstr(s.out, "end of the log, 0 records lost") != NULL, "%s", s.out);
    said_clean(dir);
}

TEST(what_it_cannot_do_is_named)
{
    static const struct {
        const char *word[6], *said;
        int status;
    } row[] = {{{"run", "--scene", "minimal"}, "give drop, guarded or bilateral", 2},
               {{"run", "--set", "nobody=1"}, "nobody: no such parameter", 2},
               {{"run", "--set", "k=1e9"}, "allowed 0..", 2},
               {{"run", "--seconds", "1e9"}, "or leave it out", 2},
               {{"run", "--load-params", "/nowhere/at.all"}, "image that a run saved", 3},
               {{"run", "--load-params", "/dev/null"}, "/dev/null: ", 2},
               {{"run", "--seconds", "1", "--log", "/nowhere/at.all"}, "give a file that can be written", 2},
               {{"run", "--log", "/nowhere/at.all"}, "give --seconds, or --pace", 2}};
    char *dir = said_dir();
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        struct said s;
        said(&s, dir, cli_run, row[i].word);
        CHECK(s.status == row[i].status, "%s %s: %d", row[i].word[1], row[i].word[2], s.status);
        CHECK(strstr(s.err, row[i].said) != NULL, "%s", s.err);
    }
    said_clean(dir);
}

TEST_MAIN("live", each_scene_goes_on_until_its_time_is_over, the_shortest_time_ends,
          after_a_fault_it_runs_again_by_the_grip_alone, an_interrupt_leaves_a_complete_log,
          what_it_cannot_do_is_named);
