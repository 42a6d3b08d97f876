/* SPDX-License-Identifier: MIT */
/* exhand run: a person at the simulated box. Holds the dead-man switch. */
#include "live/live.h"

#include "gpio.h"
#include "posix.h"

#include "exhand/run/deadman.h"

#include "exhand/safety.h"

#define FIRST_S  0.1 /* a switch that is closed from the start may be stuck */
#define OPEN_S   0.2
#define THINKS_S 1.0 /* before a grip is given up */

static struct {
    struct live_person is;
    int gone; /* it was opened on request */
    const struct exh_scene *sc;
    double since_s; /* closed, or open, since */
    int held;
} me;

void live_person(const struct live_person *is)
{
    me.is = *is;
    me.gone = me.held = 0;
    me.since_s = FIRST_S - OPEN_S;
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
    if (gpio_has(GPIO_DEADMAN)) { return; } /* a real switch is used instead */
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
    exh_deadman_start(sc, board);
}

void live_person_before(uint32_t tick, struct exh_scene_in *in) { exh_deadman_before(tick, in); }
