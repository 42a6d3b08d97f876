/* SPDX-License-Identifier: MIT */
/* Contacts and outputs, from libgpiod's side: the tests of v1_test.c and v2_test.c. The library and
 * the chip are fakes; everything above them is as shipped. GPIO_LIBRARY: which it is. */
#ifndef TEST_GPIO_LINES_H
#define TEST_GPIO_LINES_H

#define _XOPEN_SOURCE 700 /* pseudo-terminals */

#include "check.h"
#include "chip.h"
#include "closed/sim/terminal.h"

#include "gpio.h"
#include "posix.h"

#include "box/images.h"
#include "live/live.h"
#include "base/messages.h"
#include "drop/drop.h"
#include "exhand/run/loop.h"

#include "exhand/error.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#define ESTOP   4
#define SECOND  8
#define DEADMAN 5
#define ENABLE  6
#define ALIVE   7
#define ALL     "gpiochip0:estop=4,deadman=5,enable=6,alive=7"
#define PAIR    "gpiochip0:estop=4+8,deadman=5,enable=6,alive=7"
#define BOTH    ((uint32_t)EXH_DIN_ESTOP | EXH_DIN_DEADMAN)

static char said[GPIO_SAID_B];

static int opened(const char *text)
{
    struct gpio_spec s;
    said[0] = '\0';
    CHECK_EQ_I64(gpio_take(&s, text, said), 0);
    return gpio_open(&s, said);
}

/* A chip with all contacts closed, and a loop of 1 kHz: two contacts may differ for 500 ticks. */
static void start(const char *text)
{
    chip_reset();
    CHECK_EQ_I64(opened(text), 0);
    for (unsigned i = 0; i < CHIP_LINES; i++) { chip.line[i].level = 1; }
    gpio_start((struct exh_period){1, 1000});
}

static uint32_t din(void)
{
    uint32_t d = BOTH | EXH_DIN_CARDS;
    CHECK_EQ_I64(gpio_read(&d), 0);
    CHECK(d & EXH_DIN_CARDS, "a bit that is none of ours");
    return d & BOTH;
}

static void tick(uint8_t enable, uint8_t alive)
{
    const struct exh_drive_out out = {.enable = enable, .alive = alive};
    CHECK_EQ_I64(gpio_write(&out), 0);
}

/* What was said on stderr since this began. */
static FILE *listen_to;
static int stderr_was;

static void listen_begin(void)
{
    fflush(stderr);
    listen_to = tmpfile();
    CHECK(listen_to != NULL, "no temporary file");
    stderr_was = dup(2);
    dup2(fileno(listen_to), 2);
}

static const char *listen_end(void)
{
    static char text[4096];
    fflush(stderr);
    dup2(stderr_was, 2);
    close(stderr_was);
    rewind(listen_to);
    text[fread(text, 1, sizeof text - 1, listen_to)] = '\0';
    fclose(listen_to);
    return text;
}

static int times(const char *text, const char *what)
{
    int n = 0;
    for (; (text = strstr(text, what)) != NULL; text++) { n++; }
    return n;
}

/* ---- Requests ------------------------------------------------------------------------------- */

TEST(requested_low_and_pulled_down)
{
    chip_reset();
    chip.line[ENABLE].level = chip.line[ALIVE].level = 1; /* left high by another program */
    CHECK(strcmp(gpio_lines_library, GPIO_LIBRARY) == 0, "%s", gpio_lines_library);
    CHECK_EQ_I64(opened(PAIR), 0);
    for (unsigned i = 0; i < CHIP_LINES; i++) {
        const struct chip_line *l = &chip.line[i];
        const int in = i == ESTOP || i == SECOND || i == DEADMAN, out = i == ENABLE || i == ALIVE;
        CHECK(l->held == (in || out), "line %u: held %d", i, l->held);
        CHECK(l->pulled_down == in && l->output == out, "line %u", i);
        CHECK(!l->held || strcmp(l->consumer, "exhand") == 0, "line %u: %s", i, l->consumer);
    }
    CHECK(chip.line[ENABLE].level == 0 && chip.line[ALIVE].level == 0, "not low");
    gpio_close();
    for (unsigned i = 0; i < CHIP_LINES; i++) {
        CHECK(!chip.line[i].held, "line %u is held on", i);
    }
    CHECK_EQ_I64(chip.opened, 0);
}

/* Only named lines are requested. Without inputs or outputs nothing is read or set. */
TEST(a_field_alone)
{
    start("gpiochip0:alive=7");
    CHECK_EQ_I64(din(), BOTH);
    CHECK_EQ_I64(chip.gets, 0);
    gpio_close();
    start("gpiochip0:estop=4");
    tick(1, 1);
    gpio_safe();
    CHECK_EQ_I64(chip.puts, 0);
    chip.line[ESTOP].level = 0;
    CHECK_EQ_I64(din(), EXH_DIN_DEADMAN);
    gpio_close();
    CHECK_EQ_I64(din(), BOTH); /* no lines */
}

/* Each is named with what to do, and leaves nothing held. */
TEST(what_can_be_wrong)
{
    static const struct {
        const char *text;
        int open_error, request_error, busy; /* busy: the line held by "thief" */
        const char *says;
    } row[] = {
        {"gpiochip7:estop=4", 0, 0, -1, "/dev/gpiochip7: there is no such chip (there"},
        {ALL, EACCES, 0, -1, "/dev/gpiochip0: not allowed (Permission denied): join the group"},
        {ALL, EPERM, 0, -1, "not allowed (Operation not permitted)"},
        {ALL, ENOTTY, 0, -1, "/dev/gpiochip0: not a GPIO chip"},
        {"gpiochip0:estop=4+12", 0, 0, -1, "estop=12: /dev/gpiochip0 has lines 0..11: choose one"},
        {"gpiochip0:estop=4,alive=99", 0, 0, -1, "alive=99: /dev/gpiochip0 has lines 0..11"},
        {ALL, 0, 0, ESTOP,
            "estop=4: line 4 of /dev/gpiochip0 is held by \"thief\": end that program"},
        {PAIR, 0, 0, SECOND, "estop=8: line 8 of /dev/gpiochip0 is held by \"thief\""},
        {ALL, 0, 0, ALIVE, "alive=7: line 7 of /dev/gpiochip0 is held by \"thief\""},
        {ALL, 0, EIO, -1, "does not give these lines (Input/output error)"},
        {ALL, 0, EPERM, -1, "does not give these lines (Operation not permitted)"},
        {ALL, 0, EBUSY, -1, "does not give these lines (Device or resource busy)"},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        chip_reset();
        chip.open_error = row[i].open_error;
        chip.request_error = row[i].request_error;
        if (row[i].busy >= 0) { chip.line[row[i].busy].holder = "thief"; }
        CHECK(opened(row[i].text) < 0, "%s: opened", row[i].says);
        CHECK(strstr(said, row[i].says) != NULL, "want %s: %s", row[i].says, said);
        CHECK(strstr(said, ": ") != NULL && chip.opened == 0, "row %u", (unsigned)i);
        for (unsigned k = 0; k < CHIP_LINES; k++) { CHECK(!chip.line[k].held, "line %u held", k); }
    }
    CHECK_EQ_I64(opened(ALL), -1); /* the last row's */
    chip_reset();
    CHECK_EQ_I64(opened(ALL), 0);
    gpio_close();
}

/* ---- Contacts ---------------------------------------------------------------------------------
 */

TEST(closed_if_both_reads_are)
{
    start(ALL);
    CHECK_EQ_I64(din(), BOTH);
    CHECK_EQ_I64(chip.gets, 2);
    chip.flips = ESTOP;
    CHECK_EQ_I64(din(), EXH_DIN_DEADMAN);
    chip.flips = -1;
    chip.first_low = ESTOP;
    CHECK_EQ_I64(din(), EXH_DIN_DEADMAN);
    chip.first_low = DEADMAN;
    CHECK_EQ_I64(din(), EXH_DIN_ESTOP);
    chip.first_low = -1;
    CHECK_EQ_I64(din(), BOTH);
    chip.line[ESTOP].level = chip.line[DEADMAN].level = 0;
    CHECK_EQ_I64(din(), 0);
    gpio_close();
}

/* What the device shows open stays so. */
TEST(a_contact_closes_nothing)
{
    uint32_t d = EXH_DIN_DEADMAN;
    start(ALL);
    CHECK_EQ_I64(gpio_read(&d), 0);
    CHECK_EQ_I64(d, EXH_DIN_DEADMAN);
    gpio_close();
}

/* Either contact opens the channel immediately. They may differ for 500 ticks, which is counted. */
TEST(two_contacts)
{
    uint32_t times_differed;
    start(PAIR);
    CHECK_EQ_I64(gpio_differed(), 0);
    listen_begin();
    for (int k = 0; k < 2; k++) {
        const int line = k ? SECOND : ESTOP;
        CHECK_EQ_I64(din(), BOTH);
        chip.line[line].level = 0;
        for (int i = 0; i < 500; i++) { CHECK_EQ_I64(din(), EXH_DIN_DEADMAN); }
        chip.line[line].level = 1;
    }
    CHECK_EQ_I64(din(), BOTH);
    CHECK(times(listen_end(), "disagree") == 0, "said too early");
    CHECK_EQ_I64(gpio_differed(), 2);
    CHECK_EQ_I64((int64_t)(gpio_differed_s(GPIO_ESTOP, &times_differed) * 1000 + 0.5), 500);
    CHECK_EQ_I64(times_differed, 2);
    (void)gpio_differed_s(GPIO_DEADMAN, &times_differed);
    CHECK_EQ_I64(times_differed, 0);
    gpio_close();
    CHECK_EQ_I64(gpio_differed(), 2); /* to be printed at the end */
}

/* A tick more, and the fault is reported once. The channel stays open until both contacts have been
 * open. So a welded contact shows when the other opens, and closing that one again resets
 * nothing. */
TEST(two_contacts_that_disagree)
{
    const char *text;
    start(PAIR);
    listen_begin();
    chip.line[SECOND].level = 0;
    for (int i = 0; i < 501; i++) { CHECK_EQ_I64(din(), EXH_DIN_DEADMAN); }
    for (int i = 0; i < 2000; i++) { CHECK_EQ_I64(din(), EXH_DIN_DEADMAN); }
    text = listen_end();
    CHECK(times(text, "disagree") == 1, "%s", text);
    CHECK(
        strstr(text, "estop: its contacts disagree for more than 500 ticks (line 4 closed, line 8 "
                     "open)") != NULL,
        "%s", text);
    chip.line[SECOND].level = 1;
    for (int i = 0; i < 2000; i++) { CHECK_EQ_I64(din(), EXH_DIN_DEADMAN); }
    chip.line[ESTOP].level = chip.line[SECOND].level = 0;
    CHECK_EQ_I64(din(), EXH_DIN_DEADMAN);
    chip.line[ESTOP].level = chip.line[SECOND].level = 1;
    CHECK_EQ_I64(din(), BOTH);
    gpio_close();
}

/* A terminal that was halted (Ctrl-S) holds no tick up, whatever a tick has to say: it comes when
 * the terminal goes on. */
TEST(a_halted_terminal_stalls_no_tick)
{
    static char text[65536];
    struct terminal tty;
    const int was = dup(2);
    if (terminal_open(&tty) < 0) { return; }
    start(PAIR);
    CHECK_EQ_I64(tcflow(tty.slave, TCOOFF), 0);
    dup2(tty.slave, 2);
    words_begin(1);
    gpio_say(words_say);
    alarm(60);                      /* a tick that blocks ends the test */
    for (int k = 0; k < 100; k++) { /*/* so many lines a ring has room for, and no terminal */
        chip.line[SECOND].level = 0;
        for (int i = 0; i < 501; i++) { CHECK_EQ_I64(din(), EXH_DIN_DEADMAN); }
        chip.line[ESTOP].level = 0;
        CHECK_EQ_I64(din(), EXH_DIN_DEADMAN);
        chip.line[ESTOP].level = chip.line[SECOND].level = 1;
        CHECK_EQ_I64(din(), BOTH);
        CHECK(gpio_differed() == (uint32_t)k + 1, "%d", k);
    }
    alarm(0);
    CHECK_EQ_I64(tcflow(tty.slave, TCOON), 0);
    text[0] = '\0';
    for (int i = 0; i < 3000 && times(text, "disagree") + (int)words_lost() < 100; i++) {
        const struct timespec a_while = {0, 10000000};
        terminal_read(&tty, text, sizeof text);
        (void)nanosleep(&a_while, NULL);
    }
    words_end();
    gpio_say(NULL);
    dup2(was, 2);
    close(was);
    CHECK(times(text, "disagree for more than 500 ticks") + (int)words_lost() == 100 &&
              times(text, "disagree") > 50,
        "%d came, %lu lost", times(text, "disagree"), (unsigned long)words_lost());
    gpio_close();
    terminal_close(&tty);
}

/* At a slow rate 0.5 s is two ticks at the least. */
TEST(disagreement_in_ticks)
{
    static const struct {
        struct exh_period T;
        int ticks;
    } row[] = {{{1, 1}, 2}, {{1, 3}, 2}, {{1, 90}, 45}, {{1, 2000}, 1000}, {{597, 1193182}, 999}};
    for (size_t i = 0; i < LEN(row); i++) {
        start(PAIR);
        gpio_start(row[i].T);
        listen_begin();
        chip.line[ESTOP].level = 0;
        for (int k = 0; k < row[i].ticks; k++) { (void)din(); }
        chip.line[ESTOP].level = 1;
        CHECK_EQ_I64(din(), BOTH);
        chip.line[ESTOP].level = 0;
        for (int k = 0; k <= row[i].ticks; k++) { (void)din(); }
        chip.line[ESTOP].level = 1;
        CHECK_EQ_I64(din(), EXH_DIN_DEADMAN);
        CHECK(times(listen_end(), "disagree") == 1, "row %u", (unsigned)i);
        gpio_close();
    }
}

TEST(lines_that_cannot_be_read)
{
    uint32_t d = BOTH;
    const char *text;
    start(ALL);
    chip.get_error = ENODEV;
    listen_begin();
    CHECK_EQ_I64(gpio_read(&d), -EXH_E_IO);
    CHECK_EQ_I64(d, 0);
    d = BOTH;
    CHECK_EQ_I64(gpio_read(&d), -EXH_E_IO);
    CHECK_EQ_I64(d, 0);
    text = listen_end();
    CHECK(times(text, "/dev/gpiochip0: the contacts can't be read (No such device)") == 1, "%s",
        text);
    gpio_close();
}

/* ---- Outputs -------------------------------------------------------------------------------- */

TEST(enable_and_beat)
{
    start(ALL);
    CHECK(chip.line[ENABLE].level == 0 && chip.line[ALIVE].level == 0, "not low at the start");
    tick(0, 1);
    CHECK(chip.line[ENABLE].level == 0 && chip.line[ALIVE].level == 1, "first tick");
    tick(4, 2); /* any finger's drive */
    CHECK(chip.line[ENABLE].level == 1 && chip.line[ALIVE].level == 0, "second tick");
    tick(4, 2); /* a tick that was not completed */
    CHECK(chip.line[ENABLE].level == 1 && chip.line[ALIVE].level == 0, "beats by itself");
    for (int i = 3; i < 600; i++) {
        tick(31, (uint8_t)i);
        CHECK(chip.line[ALIVE].level == i % 2, "tick %d", i);
    }
    tick(0, 88);
    CHECK(chip.line[ENABLE].level == 0, "enabled on");
    gpio_close();
}

TEST(safe_is_low)
{
    start(ALL);
    gpio_safe();
    tick(1, 1);
    gpio_safe();
    gpio_safe();
    CHECK(chip.line[ENABLE].level == 0 && chip.line[ALIVE].level == 0, "not low");
    tick(1, 2);
    CHECK(chip.line[ENABLE].level == 1 && chip.line[ALIVE].level == 1, "goes on");
    gpio_close();
    CHECK(chip.line[ENABLE].level == 0 && chip.line[ALIVE].level == 0, "not low when closed");
    gpio_safe(); /* nothing is open */
}

TEST(lines_that_cannot_be_set)
{
    const struct exh_drive_out out = {.enable = 1, .alive = 1};
    const char *text;
    start(ALL);
    chip.put_error = EIO;
    listen_begin();
    CHECK_EQ_I64(gpio_write(&out), -EXH_E_IO);
    CHECK_EQ_I64(gpio_write(&out), -EXH_E_IO);
    text = listen_end();
    CHECK(
        times(text, "/dev/gpiochip0: the outputs can't be set (Input/output error): outputs CAN'T "
                    "BE SET LOW") == 1,
        "%s", text);
    gpio_close();
}

/* A line that fails once or twice is still set low. */
TEST(low_at_the_third_try)
{
    const struct exh_drive_out out = {.enable = 1, .alive = 2};
    const char *text;
    start(ALL);
    tick(1, 1);
    chip.puts_fail = 2;
    gpio_safe();
    CHECK(chip.line[ENABLE].level == 0 && chip.line[ALIVE].level == 0, "not low");
    tick(1, 1);
    CHECK_EQ_I64(chip.line[ENABLE].level, 1);
    chip.puts_fail = 1;
    listen_begin();
    CHECK_EQ_I64(gpio_write(&out), -EXH_E_IO);
    text = listen_end();
    CHECK(strstr(text, "outputs go low, the run ends") != NULL, "%s", text);
    CHECK_EQ_I64(chip.line[ENABLE].level, 0);
    gpio_close();
}

/* A child with everything high ends by a signal, or as others do. What its outputs are set to comes
 * through a pipe: high once, and low ever after. */
enum ending { BY_EXIT, BY_SIGNAL, BY_STOP };

static void child(enum ending how, int sig, int to)
{
    if (sig) { signal(sig, SIG_DFL); }
    (void)setpgid(0, 0); /* the kernel stops no orphaned group, such as a service's */
    start(ALL);
    chip.put_fd = to;
    tick(1, 1);
    if (how == BY_EXIT) { exit(7); }
    raise(sig);
    tick(1, 2); /* stopped it was, and on it goes: nothing is as it was */
    _exit(din() == 0 ? 7 : 8);
}

static int ends_low(enum ending how, int sig)
{
    int to[2], status = 0;
    char told[65] = "";
    pid_t pid;
    CHECK(pipe(to) == 0, "no pipe");
    fflush(NULL);
    pid = fork();
    if (pid == 0) { child(how, sig, to[1]); }
    close(to[1]);
    if (how == BY_STOP) {
        CHECK(waitpid(pid, &status, WUNTRACED) == pid && WIFSTOPPED(status), "not stopped");
        CHECK(read(to[0], told, 4) == 4 && strcmp(told, "1100") == 0, "stopped: outputs %s", told);
        kill(pid, SIGCONT);
    }
    CHECK(waitpid(pid, &status, 0) == pid, "lost it");
    CHECK(read(to[0], told + (how == BY_STOP ? 4 : 0), sizeof told - 5) >= (how == BY_STOP ? 2 : 4),
        "outputs %s", told);
    CHECK(strncmp(told, "1100", 4) == 0 && strchr(told + 2, '1') == NULL, "outputs %s", told);
    close(to[0]);
    return status;
}

TEST(low_when_the_program_ends)
{
    const int sig[] = {SIGHUP, SIGINT, SIGTERM, SIGQUIT, SIGPIPE, SIGALRM, SIGUSR1, SIGUSR2,
        SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS, SIGXCPU, SIGXFSZ, SIGPROF,
        SIGPOLL, SIGVTALRM, SIGRTMIN, SIGRTMIN + 5, SIGRTMAX};
    for (size_t i = 0; i < LEN(sig); i++) {
        const int status = ends_low(BY_SIGNAL, sig[i]);
        CHECK(WIFSIGNALED(status) && WTERMSIG(status) == sig[i], "signal %d: status %x", sig[i],
            status);
    }
    CHECK_EQ_I64(WEXITSTATUS(ends_low(BY_EXIT, 0)), 7);
}

TEST(low_when_it_is_stopped) { CHECK_EQ_I64(WEXITSTATUS(ends_low(BY_STOP, SIGTSTP)), 7); }

/* ---- In closed loop: a fall onto the wall, in virtual time ---------------------------------- */

enum { OPEN_NEVER, OPEN_ESTOP, OPEN_SECOND, OPEN_DEADMAN, OPEN_BEFORE, CHIP_GONE };
#define ZERO 32768
#define PAST 40 /* ticks looked at after the contact opens */

static struct {
    int how;
    uint32_t opened; /* the last tick with it closed, 0: not yet */
    struct exh_drive_out out[PAST + 1];
    struct drop_signals sig[PAST + 1];
    int enable[PAST + 1], alive[PAST + 1]; /* the lines */
} fall;

static void fall_before(uint32_t tick, struct exh_scene_in *in)
{
    if (tick == 0) { in->command = EXH_CMD_RUN; }
    if (tick == 600) { posix_ready(); }
}

static void open_it(void)
{
    static const int line[] = {0, ESTOP, SECOND, DEADMAN, ESTOP};
    if (fall.how == CHIP_GONE) {
        chip.get_error = chip.put_error = ENODEV;
    } else if (fall.how != OPEN_NEVER) {
        chip.line[line[fall.how]].level = 0;
    }
}

static void fall_after(
    uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const uint32_t at = fall.opened ? tick - fall.opened : 0;
    (void)in;
    if (at <= PAST) {
        fall.out[at] = *out;
        memcpy(&fall.sig[at], exh_scene_signals(&exh_scene_drop), sizeof fall.sig[at]);
        fall.enable[at] = chip.line[ENABLE].level;
        fall.alive[at] = chip.line[ALIVE].level;
    }
    if (!fall.opened && out->dac_raw[0] > ZERO + 2000) {
        fall.opened = tick;
        open_it();
    }
}

static int falls(int how)
{
    static const struct exh_loop_hooks hooks = {NULL, fall_before, fall_after};
    struct posix_config c = posix_config_default();
    int err;
    c.gpio = 1;
    c.wait = 1;
    c.max_ticks = 2000;
    memset(&fall, 0, sizeof fall);
    fall.how = how;
    start(PAIR);
    if (how == OPEN_BEFORE) { open_it(); }
    posix_configure(&c);
    exh_scene_drop.defaults();
    CHECK_EQ_I64(images_give(NULL, &exh_scene_drop), 0);
    err = exh_loop(&exh_scene_drop, 1000, &hooks);
    CHECK(chip.line[ENABLE].level == 0 || how == CHIP_GONE, "enabled at the end");
    CHECK(chip.line[ALIVE].level == 0 || how == CHIP_GONE, "alive at the end");
    gpio_close();
    return err;
}

TEST(closed_contacts_change_nothing)
{
    CHECK_EQ_I64(falls(OPEN_NEVER), 0);
    CHECK(fall.opened > 600, "no current");
    for (int i = 0; i <= PAST; i++) {
        CHECK(fall.enable[i] == 1 && fall.sig[i].faults == 0, "tick %d", i);
        CHECK(i == 0 || fall.alive[i] != fall.alive[i - 1], "tick %d: no beat", i);
    }
}

/* The tick that sees it open has no current, and the enable falls with its outputs; the beat goes
 * on: the box is alive. */
TEST(estop_cuts_in_its_tick)
{
    for (int how = OPEN_ESTOP; how <= OPEN_SECOND; how++) {
        CHECK_EQ_I64(falls(how), 0);
        CHECK(fall.opened > 600, "no current");
        CHECK(fall.out[0].dac_raw[0] > ZERO + 2000 && fall.out[0].enable == 1, "the tick before");
        for (int i = 1; i <= PAST; i++) {
            CHECK(fall.out[i].dac_raw[0] == ZERO && fall.out[i].enable == 0, "tick %d: code %u", i,
                fall.out[i].dac_raw[0]);
            CHECK(fall.enable[i] == 0, "tick %d: enable is high", i);
            CHECK(fall.alive[i] != fall.alive[i - 1], "tick %d: no beat", i);
            CHECK_EQ_I64(fall.sig[i].faults, EXH_FAULT_ESTOP);
        }
    }
}

/* The force held goes in 15 ms, the enable falls with it. */
TEST(deadman_lets_go)
{
    CHECK_EQ_I64(falls(OPEN_DEADMAN), 0);
    CHECK(fall.opened > 600, "no current");
    CHECK_EQ_I64(fall.sig[1].faults, EXH_FAULT_DEADMAN);
    CHECK_EQ_I64(fall.sig[1].state, EXH_STATE_RELEASE);
    CHECK(fall.enable[14] == 1 && fall.enable[17] == 0, "enable");
    for (int i = 1; i <= PAST; i++) {
        CHECK(fall.out[i].dac_raw[0] <= fall.out[i - 1].dac_raw[0], "tick %d: more", i);
        CHECK(i < 16 || fall.out[i].dac_raw[0] == ZERO, "tick %d: code %u", i,
            fall.out[i].dac_raw[0]);
    }
}

/* Nothing arms while a contact is open. */
TEST(no_start_with_an_open_contact)
{
    CHECK_EQ_I64(falls(OPEN_BEFORE), 0);
    CHECK_EQ_I64(fall.opened, 0);
    CHECK_EQ_I64(fall.enable[0], 0);
}

/* A chip that goes away while it runs ends the run, safe as far as lines can be. */
TEST(a_chip_that_is_gone)
{
    listen_begin();
    CHECK_EQ_I64(falls(CHIP_GONE), -EXH_E_IO);
    CHECK(times(listen_end(), "can't be read") == 1, "not said once");
    CHECK_EQ_I64(fall.sig[1].faults & EXH_FAULT_CARD, EXH_FAULT_CARD);
}

/* ---- `exhand run`: whose hand it is -----------------------------------------------------------
 */

static struct {
    uint8_t state[2000]; /* of the box, by tick */
    int held;            /* 1: the real switch is closed from the start and never moved */
} hand;

/* Gripped at tick 300, let go at 1000, gripped at 1200, let go at 1400, gripped at 1600. */
static void hand_before(uint32_t tick, struct exh_scene_in *in)
{
    if (!hand.held) {
        chip.line[DEADMAN].level =
            (tick >= 300 && tick < 1000) || (tick >= 1200 && tick < 1400) || tick >= 1600;
    }
    live_person_before(tick, in);
}

static void hand_after(
    uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    (void)in;
    (void)out;
    hand.state[tick] = exh_scene_drop.safety->state;
}

static void hand_runs(int held)
{
    static const struct exh_loop_hooks hooks = {live_person_start, hand_before, hand_after};
    const struct live_person person = {1, 0.5}; /* --grip --let-go 0.5 */
    struct posix_config c = posix_config_default();
    c.gpio = 1;
    c.wait = 1;
    c.max_ticks = LEN(hand.state);
    c.wires_in = live_wires;
    memset(&hand, 0, sizeof hand);
    hand.held = held;
    start(ALL);
    if (!held) { chip.line[DEADMAN].level = 0; }
    posix_configure(&c);
    live_person(&person);
    exh_scene_drop.defaults();
    CHECK_EQ_I64(images_give(NULL, &exh_scene_drop), 0);
    CHECK_EQ_I64(exh_loop(&exh_scene_drop, 1000, &hooks), 0);
    gpio_close();
}

/* Only the real switch commands: a grip runs the box, letting go is a fault, the next grip clears
 * it and the one after runs it. The simulated person, who would have gripped at 0.1 s and let go at
 * 0.5 s, is not there. */
TEST(a_real_hand)
{
    static const struct {
        uint32_t tick;
        uint8_t state;
    } row[] = {{299, EXH_STATE_OFF}, {345, EXH_STATE_OFF}, {360, EXH_STATE_ARM},
        {999, EXH_STATE_RUN}, {1001, EXH_STATE_RELEASE}, {1030, EXH_STATE_FAULT},
        {1245, EXH_STATE_FAULT}, {1260, EXH_STATE_OFF}, {1599, EXH_STATE_OFF},
        {1660, EXH_STATE_ARM}};
    hand_runs(0);
    for (size_t i = 0; i < LEN(row); i++) {
        CHECK(hand.state[row[i].tick] == row[i].state, "tick %u: state %u, want %u", row[i].tick,
            hand.state[row[i].tick], row[i].state);
    }
}

/* One that was never seen open may be stuck. */
TEST(a_switch_that_is_closed_from_the_start)
{
    hand_runs(1);
    for (size_t i = 0; i < LEN(hand.state); i++) {
        CHECK(hand.state[i] == EXH_STATE_OFF, "tick %u: state %u", (unsigned)i, hand.state[i]);
    }
}

#define LINES_TESTS \
    requested_low_and_pulled_down, a_field_alone, what_can_be_wrong, closed_if_both_reads_are, \
        a_contact_closes_nothing, two_contacts, two_contacts_that_disagree, \
        a_halted_terminal_stalls_no_tick, disagreement_in_ticks, lines_that_cannot_be_read, \
        enable_and_beat, safe_is_low, lines_that_cannot_be_set, low_at_the_third_try, \
        low_when_the_program_ends, low_when_it_is_stopped, closed_contacts_change_nothing, \
        estop_cuts_in_its_tick, deadman_lets_go, no_start_with_an_open_contact, \
        a_chip_that_is_gone, a_real_hand, a_switch_that_is_closed_from_the_start

#endif
