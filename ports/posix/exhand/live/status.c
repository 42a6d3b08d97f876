/* SPDX-License-Identifier: MIT */
/* exhand run: a line of status on a terminal, and what became of it. */
#include "live/live.h"

#include "gpio.h"
#include "base/lines.h"
#include "base/names.h"
#include "base/option.h"
#include "base/param.h"
#include "base/messages.h"
#include "box/world_line.h"

#include "exhand/safety.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define SHOWN_S 0.25
#define ODD_B   128

static struct {
    const struct exh_scene *sc;
    struct exh_period T;
    unsigned finger;
    uint64_t ticks, missed;
    uint32_t every, faults;
    int on;
    struct timespec last;
} status;

void live_status(unsigned finger)
{
    memset(&status, 0, sizeof status);
    status.finger = finger;
}

void live_status_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    status.sc = sc;
    status.T = board.T;
    status.every = board.T.den / board.T.num / 50 + 1;
    status.on = lines_terminal(STDERR_FILENO);
}

/* In SI, of the finger; 0 where the scene has no such signal. */
static double value(const char *name)
{
    const struct exh_signal_table *t = status.sc->signals;
    const struct exh_signal *row = cli_signal_find(t, name, NULL);
    const int32_t i = row ? exh_signal_find(t, row->id, (uint16_t)status.finger) : -1;
    return i < 0 ? 0 : cli_signal_value(row, exh_scene_signals(status.sc)[i]);
}

static double seconds(void)
{
    return (double)(status.ticks + status.missed) * status.T.num / status.T.den;
}

/* Appends ", 12 missed"; nothing if the count is 0. */
static void count(char to[ODD_B], const char *before, uint64_t n, const char *behind)
{
    const size_t at = strlen(to);
    if (n) { snprintf(to + at, ODD_B - at, ", %s%" PRIu64 " %s", before, n, behind); }
}

/* Irregular events that are no faults. */
static void odd(char to[ODD_B])
{
    const char *const world = world_line_word();
    to[0] = '\0';
    count(to, "", status.missed, "missed");
    count(to, "log: ", live_log_lost(), "records lost");
    count(to, "", words_lost(), "lines not said");
    count(to, "contacts disagreed ", gpio_differed(), "times");
    if (world[0]) { snprintf(to + strlen(to), ODD_B - strlen(to), ", %s", world); }
}

static void show(void)
{
    char faults[NAMES_B], more[ODD_B], line[WORDS_LINE_B - 8];
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if ((double)(now.tv_sec - status.last.tv_sec) +
            (double)(now.tv_nsec - status.last.tv_nsec) * 1e-9 <
        SHOWN_S) {
        return;
    }
    status.last = now;
    names_faults(faults, sizeof faults, status.sc->safety->faults);
    odd(more);
    snprintf(line, sizeof line, "%10.1f s  %-7s  q %7.2f mm  f %7.2f N  faults %s%s", seconds(),
        names_word(&names_state, status.sc->safety->state), value("q") * 1e3, value("f_des"),
        faults, more);
    words_show(line);
}

/* Once of each: a grip that is tried again and again changes nothing. */
static void say_restart(uint32_t faults)
{
    const uint32_t fresh = names_restart(faults) & ~status.faults;
    char clear[NAMES_CLEAR_B];
    if (fresh == 0) { return; }
    names_clear(clear, fresh, fresh);
    cli_complain(
        "%.3f s: %s: end it by Ctrl-C, look for the cause, and start it again", seconds(), clear);
}

void live_status_after(uint32_t tick, const struct exh_scene_in *in)
{
    status.ticks++;
    status.missed += in->missed;
    say_restart(status.sc->safety->faults);
    status.faults |= status.sc->safety->faults;
    if (status.on && tick % status.every == 0) { show(); }
}

void live_status_end(void)
{
    char faults[NAMES_B], more[ODD_B];
    if (status.sc == NULL) { return; }
    names_faults(faults, sizeof faults, status.faults);
    odd(more);
    printf("%" PRIu64 " ticks%s, %.6g s, faults %s\n", status.ticks, more, seconds(), faults);
}
