/* SPDX-License-Identifier: MIT */
/* The contract on the POSIX port: directly, and through drivers and emulated cards, at several
 * rates; a process each, since a board is set up once a run. Then how exh_board_halt() ends. */
#include "contract.h"

#include "posix.h"

#include "exhand/board.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define HALF_A   923 /* D/A codes */
#define NO_SMALL 97  /* monitor codes, 0.05 A */
#define WAITS    80

uint32_t contract_rate_Hz = 1000;

static void configure(int how)
{
    struct posix_config c = posix_config_default();
    c.drives = (1u << EXH_FINGERS) - 1;
    c.glove = 1;
    c.cards.how = (uint8_t)how;
    posix_configure(&c);
}

/* Its status, or 128 when it was killed. */
static int status_of(pid_t child)
{
    int status;
    if (child < 0 || waitpid(child, &status, 0) < 0 || !WIFEXITED(status)) { return 128; }
    return WEXITSTATUS(status);
}

static int contract(int how, uint32_t rate_Hz)
{
    pid_t child;
    printf("  | %s at %u Hz\n", how == POSIX_CARDS_NONE ? "directly" : "through the cards",
        (unsigned)rate_Hz);
    fflush(NULL);
    child = fork();
    if (child == 0) {
        contract_rate_Hz = rate_Hz;
        configure(how);
        exit(contract_main());
    }
    return status_of(child);
}

static int32_t monitor(const struct exh_drive_out *out)
{
    struct exh_drive_in in = {.din = 0};
    for (int n = 0; n < WAITS; n++) {
        if (exh_board_wait() < 0 || exh_board_read_drive(&in) < 0 ||
            (out && exh_board_write_drive(out) < 0)) {
            _exit(125);
        }
    }
    return in.mon_raw[0];
}

/* After exh_board_halt(), by exit(). */
static void look_at_current(void)
{
    const int32_t code = monitor(NULL);
    if (code <= -NO_SMALL || code >= NO_SMALL) { _exit(126); }
}

/* With current on: the status of the process. */
static int halt(int how, const char *why)
{
    const struct exh_drive_out out = {{32768 + HALF_A, 32768, 32768, 32768, 32768}, 1, 0};
    struct exh_period T;
    pid_t child;
    fflush(NULL);
    child = fork();
    if (child == 0) {
        configure(how);
        if (exh_board_init(1000, &T) < 0 || monitor(&out) < NO_SMALL) { _exit(124); }
        if (atexit(look_at_current)) { _exit(123); }
        exh_board_halt(why);
    }
    return status_of(child);
}

static int expect(const char *what, int got, int want)
{
    if (got == want) { return 0; }
    printf("%s: status %d, want %d\n", what, got, want);
    return 1;
}

int main(void)
{
    static const struct {
        int how;
        uint32_t rate_Hz;
    } run[] = {{POSIX_CARDS_INSTANT, 90}, {POSIX_CARDS_TIMED, 1000}, {POSIX_CARDS_INSTANT, 20000},
        {POSIX_CARDS_NONE, 90}, {POSIX_CARDS_NONE, 1000}, {POSIX_CARDS_NONE, 20000}};
    int failed = 0;
    for (int how = POSIX_CARDS_NONE; how <= POSIX_CARDS_TIMED; how++) {
        failed |= expect("halt, done", halt(how, "done"), 0);
        failed |= expect("halt, other", halt(how, "test"), 1);
    }
    for (unsigned i = 0; i < sizeof run / sizeof run[0]; i++) {
        failed |= expect("contract", contract(run[i].how, run[i].rate_Hz), 0);
    }
    return failed;
}
