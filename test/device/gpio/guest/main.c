/* SPDX-License-Identifier: MIT */
/* First process of an emulated Linux: `exhand drop --pace --gpio` on lines of the kernel's
 * simulated chip, of which this program is the contacts, the drive and the other programs. Prints
 * `ok` and `not ok` lines; logs leave through the second serial line. Arguments: versions of
 * libgpiod, as /exhand-v1. */
#define _GNU_SOURCE
#include "sim.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/reboot.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#define LINES   12
#define ESTOP   4
#define SECOND  8
#define DEADMAN 5
#define ENABLE  6
#define ALIVE   7
#define RATE    100
#define PAIR    "estop=4+8,deadman=5,enable=6,alive=7"

static const char *version; /* "v1" */
static char words[4096];    /* what exhand said on stderr */

__attribute__((format(printf, 2, 3))) static void tell(int ok, const char *format, ...)
{
    va_list args;
    printf("%s %s: ", ok ? "ok" : "not ok", version);
    va_start(args, format);
    vprintf(format, args);
    va_end(args);
    printf("\n");
    if (!ok) { printf("# %s\n", words); }
}

/* --- exhand, in a separate process --- */

/* lines: of the simulated chip, or of another where its name and a colon are in them. */
static pid_t run(const char *lines, const char *out, int user)
{
    static char program[32], dir[64], spec[128];
    char *argv[] = {"exhand", "drop", "--pace", "--rate", "100", "--falls", "1", "--k", "2000",
        "--b", "15", "--out", dir, "--gpio", spec, NULL};
    const pid_t pid = fork();
    if (pid != 0) { return pid; }
    snprintf(program, sizeof program, "/exhand-%s", version);
    snprintf(spec, sizeof spec, "%s%s%s", strchr(lines, ':') ? "" : sim_chip(),
        strchr(lines, ':') ? "" : ":", lines);
    snprintf(dir, sizeof dir, "/out/%s_%s", version, out);
    if (!freopen("/said.err", "w", stderr) || !freopen("/said.out", "w", stdout)) { _exit(99); }
    if (user && (setgid(1000) || setuid(1000))) { _exit(99); }
    execv(program, argv);
    _exit(98);
}

static void read_words(void)
{
    const int fd = open("/said.err", O_RDONLY | O_CLOEXEC);
    const ssize_t n = read(fd, words, sizeof words - 1);
    words[n > 0 ? n : 0] = '\0';
    close(fd);
}

/* Its exit status, 128 + a signal's number, or -1: it would not end. */
static int ended(pid_t pid, double limit_s)
{
    const double until = now_s() + limit_s;
    int status = 0;
    while (waitpid(pid, &status, WNOHANG) == 0) {
        if (now_s() > until) {
            kill(pid, SIGKILL);
            waitpid(pid, &status, 0);
            return -1;
        }
        wait_s(0.01);
    }
    read_words();
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

static int until_level(int line, int level, double limit_s)
{
    const double until = now_s() + limit_s;
    while (sim_level(line) != level) {
        if (now_s() > until) { return 0; }
        wait_s(0.001);
    }
    return 1;
}

static void contacts(int up)
{
    sim_pull(ESTOP, up);
    sim_pull(SECOND, up);
    sim_pull(DEADMAN, up);
}

/* Starts it with all contacts closed. The simulated chip has one pull for bias and for what hangs
 * on the line, so they are closed once the lines were requested: it waits for its pull-downs. */
static pid_t armed(const char *out)
{
    const double until = now_s() + 20;
    const pid_t pid = run(PAIR, out, 0);
    while (!sim_held(ALIVE) && now_s() < until) { wait_s(0.001); }
    contacts(1);
    if (!until_level(ENABLE, 1, 20)) { tell(0, "%s: it does not arm", out); }
    return pid;
}

/* --- what is refused --- */

/* says: words of it; %s in them is the chip's name. */
static void refused(const char *what, const char *lines, int user, const char *says)
{
    const int status = ended(run(lines, "refused", user), 20);
    const char *rest = strstr(says, "%s");
    char want[160];
    snprintf(want, sizeof want, "%.*s%s%s", rest ? (int)(rest - says) : 79, says,
        rest ? sim_chip() : "", rest ? rest + 2 : "");
    tell(status == 3 && strstr(words, want) != NULL, "%s: status %d: %s", what, status, words);
}

static void refusals(void)
{
    int thief;
    refused("chip missing", "gpiochip9:estop=4", 0,
        "/dev/gpiochip9: there is no such chip (there are: %s)");
    refused("no chip", "null:estop=4", 0, "/dev/null: not a GPIO chip");
    refused("no line", "estop=40", 0, "estop=40: /dev/%s has lines 0..11");
    refused("no permission", PAIR, 1, "/dev/%s: not allowed (Permission denied)");
    thief = sim_take(ESTOP, "thief");
    refused("line stolen", PAIR, 0, "estop=4: line 4 of /dev/%s is held by \"thief\"");
    close(thief);
    thief = sim_take(ALIVE, "thief");
    refused("output stolen", PAIR, 0, "alive=7: line 7 of /dev/%s is held by \"thief\"");
    close(thief);
}

/* --- what happens while it runs --- */

/* A contact opens while the mass rests on the wall; how many beats until the enable is low. */
static int beats_until_low(int line)
{
    const double until = now_s() + 5;
    int beats = 0, was = sim_level(ALIVE);
    sim_pull(line, 0);
    while (sim_level(ENABLE) == 1 && now_s() < until) {
        const int is = sim_level(ALIVE);
        beats += is != was;
        was = is;
    }
    return sim_level(ENABLE) == 0 ? beats : -1;
}

static void opens(const char *what, int line, int beats_max)
{
    const pid_t pid = armed(what);
    int beats, status;
    wait_s(2.5);
    beats = beats_until_low(line);
    tell(beats >= 0 && beats <= beats_max, "%s: enable is low after %d beats (0..%d)", what, beats,
        beats_max);
    wait_s(line == SECOND ? 0.8 : 0.2);
    kill(pid, SIGINT);
    status = ended(pid, 10);
    tell(status == 130, "%s: status %d", what, status);
    if (line == SECOND) {
        tell(strstr(words, "estop: its contacts disagree for more than 50 ticks (line 4 closed, "
                           "line 8 open)") != NULL,
            "%s: the disagreement is named", what);
    } else {
        /* One contact of two opened. It is reported at the end, because the run ended before the
         * pair became a fault. */
        tell(strstr(words, "disagree for") == NULL, "%s: no disagreement at fault", what);
        tell(
            (strstr(words, "estop: its two contacts disagreed 1 times") != NULL) == (line == ESTOP),
            "%s: the short disagreement is told", what);
    }
}

static void beats_and_holds(void)
{
    const pid_t pid = armed("beat");
    double until = now_s() + 1;
    int beats = 0, was = sim_level(ALIVE), thief, status;
    while (now_s() < until) {
        const int is = sim_level(ALIVE);
        beats += is != was;
        was = is;
        wait_s(0.0005);
    }
    tell(beats >= RATE - 1 && beats <= RATE + 1, "alive: %d beats in 1 s at %d Hz", beats, RATE);
    thief = sim_take(ESTOP, "thief");
    tell(thief < 0 && errno == EBUSY, "a line that is held cannot be stolen: %s", strerror(errno));
    kill(pid, SIGTSTP);
    tell(until_level(ENABLE, 0, 1) && sim_level(ALIVE) == 0 && sim_held(ENABLE),
        "stopped: both outputs are low, and held");
    kill(pid, SIGCONT);
    wait_s(0.3);
    tell(sim_level(ENABLE) == 0 && sim_level(ALIVE) == 0, "it goes on: they stay low");
    kill(pid, SIGINT);
    status = ended(pid, 10);
    tell(status == 130, "interrupted: status %d", status);
}

/* `exhand run`: only the real switch commands. */
static void a_hand(void)
{
    static char program[32], spec[128], log[32];
    const pid_t pid = fork();
    int first, low, cleared, again;
    snprintf(program, sizeof program, "/exhand-%s", version);
    snprintf(log, sizeof log, "/out/%s_run.exh", version);
    snprintf(spec, sizeof spec, "%s:" PAIR, sim_chip());
    if (pid == 0) {
        if (!freopen("/said.err", "w", stderr) || !freopen("/said.out", "w", stdout)) { _exit(99); }
        execl(program, "exhand", "run", "--pace", "--rate", "100", "--gpio", spec, "--log", log,
            (char *)NULL);
        _exit(98);
    }
    while (!sim_held(ALIVE)) { wait_s(0.001); }
    sim_pull(ESTOP, 1);
    sim_pull(SECOND, 1);
    tell(!until_level(ENABLE, 1, 1), "run: nobody grips, nothing is enabled");
    sim_pull(DEADMAN, 1);
    first = until_level(ENABLE, 1, 1);
    wait_s(0.2); /* the mass is held yet */
    sim_pull(DEADMAN, 0);
    low = until_level(ENABLE, 0, 0.2);
    wait_s(0.3);
    sim_pull(DEADMAN, 1);
    cleared = !until_level(ENABLE, 1, 0.5);
    sim_pull(DEADMAN, 0);
    wait_s(0.3);
    sim_pull(DEADMAN, 1);
    again = until_level(ENABLE, 1, 1);
    tell(first && low && cleared && again,
        "run: a grip enables %d, letting go disables %d, a grip clears %d, another enables %d",
        first, low, cleared, again);
    kill(pid, SIGINT);
    first = ended(pid, 10);
    tell(first == 130, "run: status %d", first);
}

static void chip_goes(void)
{
    const pid_t pid = armed("gone");
    int status;
    sim_unmake();
    status = ended(pid, 10);
    tell(status == 1 && strstr(words, "the contacts can't be read (No such device)"),
        "chip taken away: status %d: %s", status, words);
    if (sim_make(LINES)) { tell(0, "no other chip"); }
}

static void all(void)
{
    struct stat st;
    char program[32];
    snprintf(program, sizeof program, "/exhand-%s", version);
    if (stat(program, &st)) { return; }
    refusals();
    beats_and_holds();
    opens("estop", ESTOP, 2);
    opens("pair", SECOND, 2);
    opens("deadman", DEADMAN, 7);
    a_hand();
    chip_goes();
}

/* What is in /out, as a tar file, raw. */
static void send_logs(void)
{
    struct termios t;
    const int fd = open("/dev/ttyS1", O_RDWR | O_NOCTTY);
    pid_t pid;
    if (fd < 0 || tcgetattr(fd, &t)) { return; }
    cfmakeraw(&t);
    cfsetspeed(&t, B115200);
    tcsetattr(fd, TCSANOW, &t);
    pid = fork();
    if (pid == 0) {
        dup2(fd, 1);
        execl("/busybox", "tar", "-c", "-C", "/out", ".", (char *)NULL);
        _exit(98);
    }
    waitpid(pid, NULL, 0);
    tcdrain(fd);
}

int main(void)
{
    static const char *const versions[] = {"v1", "v2"};
    setvbuf(stdout, NULL, _IOLBF, 0);
    mkdir("/proc", 0755);
    mkdir("/sys", 0755);
    mkdir("/dev", 0755);
    umask(0);
    mkdir("/out", 0777);
    mount("proc", "/proc", "proc", 0, NULL);
    mount("sys", "/sys", "sysfs", 0, NULL);
    mount("dev", "/dev", "devtmpfs", 0, NULL);
    version = "linux";
    if (sim_load("/configfs.ko") == 0 &&
        mount("config", "/sys/kernel/config", "configfs", 0, NULL) == 0 &&
        sim_load("/gpio-simulated.ko") == 0 && sim_make(LINES) == 0) {
        for (size_t i = 0; i < sizeof versions / sizeof versions[0]; i++) {
            version = versions[i];
            all();
        }
    } else {
        tell(0, "no simulated chip: %s", strerror(errno));
    }
    send_logs();
    printf("done\n");
    fflush(NULL);
    sync();
    reboot(RB_POWER_OFF);
    for (;;) { pause(); }
}
