/* exhand run: a person at the simulated box. Holds the dead-man switch and looks at the values. */
#include "live.h"

#include "gpio.h"
#include "names.h"
#include "param.h"
#include "posix.h"

#include "deadman.h"

#include "exhand/safety.h"

#include <inttypes.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

#define FIRST_S  0.1 /* a switch that is closed from the start may be stuck     */
#define OPEN_S   0.2
#define THINKS_S 1.0 /* before a grip is given up                                */
#define SHOWN_S  0.25

static struct {
    struct live_person is;
    int gone; /* it was let go, as asked */
    const struct exh_scene *sc;
    struct exh_period T;
    double since_s; /* it is held, or let go, */
    int held;
    uint64_t ticks;
    uint32_t every, faults;
    int shown; /* a line stands on the terminal */
    struct timespec last;
} me;

void live_person(const struct live_person *is)
{
    me.is = *is;
    me.gone = me.held = me.shown = 0;
    me.since_s = FIRST_S - OPEN_S;
    me.ticks = 0;
    me.faults = 0;
    me.sc = NULL;
}

static int stopped(void)
{
    const uint8_t state = me.sc && me.sc->safety ? me.sc->safety->state : (uint8_t)EXH_STATE_RUN;
    return state == EXH_STATE_OFF || state == EXH_STATE_FAULT;
}

void live_wires(struct exh_drive_in *in)
{
    const double now_s = posix_time_s(), for_s = now_s - me.since_s;
    const int goes = me.held && !me.gone && me.is.let_go_s > 0 && now_s >= me.is.let_go_s;
    const int gives_up = me.is.again && stopped() && for_s >= THINKS_S;
    const int grips = for_s >= OPEN_S && (!me.gone || me.is.again);
    if (gpio_has(GPIO_DEADMAN)) { return; } /* a real hand's, and nobody else's */
    me.gone |= goes;
    if (goes || (me.held ? gives_up : grips)) {
        me.held = !me.held;
        me.since_s = now_s;
    }
    if (!me.held) { in->din &= ~(uint32_t)EXH_DIN_DEADMAN; }
}

void live_person_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    me.sc = sc;
    me.T = board.T;
    me.every = board.T.den / board.T.num / 50 + 1;
    exh_deadman_start(sc, board);
}

void live_person_before(uint32_t tick, struct exh_scene_in *in)
{
    exh_deadman_before(tick, in);
}

/* In SI, of the finger; 0 where the scene has no such signal. */
static double value(const char *name)
{
    const struct exh_signal_table *t = me.sc->signals;
    const struct exh_signal *row = cli_signal_find(t, name, NULL);
    const int32_t i = row ? exh_signal_find(t, row->id, (uint16_t)me.is.finger) : -1;
    return i < 0 ? 0 : cli_signal_value(row, me.sc->signal[i]);
}

static double seconds(void)
{
    return (double)me.ticks * me.T.num / me.T.den;
}

static void show(void)
{
    char faults[NAMES_B];
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if ((double)(now.tv_sec - me.last.tv_sec) + (double)(now.tv_nsec - me.last.tv_nsec) * 1e-9 <
        SHOWN_S) {
        return;
    }
    me.last = now;
    me.shown = 1;
    names_faults(faults, sizeof faults, me.sc->safety->faults);
    fprintf(stderr, "\r%10.1f s  %-7s  q %7.2f mm  f %7.2f N  faults %s\033[K", seconds(),
            names_word(&names_state, me.sc->safety->state), value("q") * 1e3, value("f_des"),
            faults);
}

void live_person_after(uint32_t tick, const struct exh_scene_in *in,
                       const struct exh_drive_out *out)
{
    (void)in;
    (void)out;
    me.ticks++;
    me.faults |= me.sc->safety->faults;
    if (tick % me.every == 0 && isatty(STDERR_FILENO)) { show(); }
}

void live_person_end(void)
{
    char faults[NAMES_B];
    if (me.shown) { fputc('\n', stderr); }
    if (me.sc == NULL) { return; }
    names_faults(faults, sizeof faults, me.faults);
    printf("%" PRIu64 " ticks, %.6g s, faults %s\n", me.ticks, seconds(), faults);
}
