/* SPDX-License-Identifier: MIT */
/* Heat: I2t over minutes and pulses, at rates where a tick is much and little of its time. */
#include "stress.h"

struct hot {
    const char *name;
    struct exh_period T;
    int32_t peak_ms;
};

static const struct hot minute[] = {
    {"full force for a minute, 2000 Hz", {1, 2000}, 2700},
    {"full force for a minute, 7 Hz", {1, 7}, 2700},
    {"full force for a minute, 20000 Hz", {1, 20000}, 2700},
};

static const struct hot pulses[] = {
    {"pulses, 2000 Hz", {1, 2000}, 100},
    {"pulses, 1 Hz", {1, 1}, 2700},
    {"pulses, 90 Hz, peak for 1 ms", {1, 90}, 1},
};

/* All the force there is, at every tick that the string is out. */
static void start_hot(const struct hot *c)
{
    rig.blind = 1;
    set(ID_K, EXH_Q(1000000, 1, EXH_Q_K));
    set(ID_PEAK_TIME, c->peak_ms);
    start(c->T);
    arm();
}

/* All the force there is, for a minute: the peak for its time, then i_cont for ever. */
static void full_force(const struct hot *c)
{
    const double T_s = (double)c->T.num / c->T.den, may_s = c->peak_ms / 1000.0;
    struct exh_drive_out out;
    char besides[64];
    double peak_s = 0, last_A = 0;
    fresh();
    start_hot(c);
    for (double t = 0; t < 60; t += T_s) {
        const struct exh_scene_in in = idle_in(1, 5000);
        tick(&in, &out);
        last_A = rig.sig.i_des_A_q26 / 67108864.0;
        if (last_A > 6.59) { peak_s += T_s; }
    }
    snprintf(besides, sizeof besides, "peak %.2f s of %g, then %.3f A (3.3 + 1 %%)", peak_s, may_s,
        last_A);
    must(peak_s >= 0.7 * may_s && peak_s <= may_s + T_s, "heat", "peak for %.3f s", peak_s);
    must(last_A >= 3.29 && last_A <= 3.3 * 1.01, "heat", "%.4f A after a minute", last_A);
    report(c->name, besides);
}

/* Full force and none in turn for so many ticks: the mean heat must end at i_cont, also
 * where the peak's time is no longer than a tick. */
static void pulsed_force(const struct hot *c)
{
    struct exh_drive_out out;
    char besides[64];
    const double T_s = (double)c->T.num / c->T.den, excess = 6.6 * 6.6 - 3.3 * 3.3;
    /* for ever, and the budget once */
    const double may = 3.3 * 3.3 + excess * (c->peak_ms / 1000.0 + 2 * T_s) / (10000 * T_s);
    double sum = 0;
    fresh();
    start_hot(c);
    for (uint32_t n = 0; n < 10000; n++) {
        const struct exh_scene_in in = idle_in(1, n % 2 ? 5000 : 0);
        tick(&in, &out);
        sum += rig.sig.i_des_A_q26 / 67108864.0 * (rig.sig.i_des_A_q26 / 67108864.0);
    }
    snprintf(besides, sizeof besides, "mean i^2 %.3f A^2, may %.3f", sum / 10000, may);
    must(sum / 10000 <= may * 1.001, "heat", "mean i^2 %.3f A^2, may %.3f", sum / 10000, may);
    report(c->name, besides);
}

void heats(void)
{
    for (size_t i = 0; i < LEN(minute); i++) { full_force(&minute[i]); }
    for (size_t i = 0; i < LEN(pulses); i++) { pulsed_force(&pulses[i]); }
}
