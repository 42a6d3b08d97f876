/* SPDX-License-Identifier: MIT */
/* The controller as a unit: a scene (examples/), its tick and its signal table. */
#include "unit.h"

#include "drop/drop.h"

#include "exhand/error.h"
#include "exhand/exhand.h"

#include <stdio.h>
#include <string.h>

#ifndef EXH_SCENE
#define EXH_SCENE exh_scene_drop
#endif
extern const struct exh_scene EXH_SCENE;
#define scene (&EXH_SCENE)

const char unit_name[] = "ExhandController";
const char unit_help[] = "exhand: fixed-point controller of a force-feedback glove, the scene and "
                         "its safety, counts in, D/A codes out";
const char unit_order[] = "reads its inputs at the beginning of a step: step it before "
                          "ExhandDevice, with that one's outputs";

static struct exh_scene_in in;
static struct exh_drive_out out;
static struct exh_period T;
static uint8_t started;

/* --- what there is beside the scene's tables --- */

enum own {
    PERIOD_NUM,
    PERIOD_DEN,
    ENC_BITS,
    MON,
    SUPPLY,
    DIN,
    MISSED,
    COMMAND,
    ENC,
    DAC,
    ENABLE,
    ALIVE,
    OWN
};
static int32_t enc_bits;

static const struct unit_var own_var[OWN] = {
    [PERIOD_NUM] = {UNIT_INT32, UNIT_FIXED, "period_num", "",
        "period of the loop and of a step, numerator, s", 1, 2147483647, 1},
    [PERIOD_DEN] = {UNIT_INT32, UNIT_FIXED, "period_den", "", "and denominator; 1/20000..1 s", 1,
        2147483647, 2000},
    [ENC_BITS] = {UNIT_INT32, UNIT_FIXED, "enc_bits", "", "width of the encoders' counters", 8, 32,
        24},
    [MON] = {UNIT_INT32, UNIT_INPUT, "mon_raw", "", "current monitor, code", -32768, 32767, 0},
    [SUPPLY] = {UNIT_INT32, UNIT_INPUT, "supply_raw", "", "supply monitor, code", -32768, 32767, 0},
    [DIN] = {UNIT_INT32, UNIT_INPUT, "din", "",
        "digital inputs, bits: 1 e-stop loop, 2 dead-man, 4 watchdog, 8 cards, 256 drive; 1 "
        "is healthy",
        0, 65535, 271},
    [MISSED] = {UNIT_INT32, UNIT_INPUT, "missed", "", "ticks missed before this one", 0, 2147483647,
        0},
    [COMMAND] = {UNIT_INT32, UNIT_INPUT, "command", "",
        "at this tick: 0 none, 1 run, 2 off, 3 clear; -1: run at the first tick, then none", -1, 3,
        -1},
    [ENC] = {UNIT_INT32, UNIT_INPUT, "enc_raw", "",
        "encoder counter; of 32 bits as two's complement", 1, 0, 0},
    [DAC] = {UNIT_INT32, UNIT_OUTPUT, "dac_raw", "", "D/A code, offset binary", 0, 65535, 0},
    [ENABLE] = {UNIT_INT32, UNIT_OUTPUT, "enable", "", "drive enabled", 0, 1, 0},
    [ALIVE] = {UNIT_INT32, UNIT_OUTPUT, "alive", "", "the watchdog's kick: changes each tick", 0,
        255, 0},
};
static int32_t command;

/* With all defaults the run is that of `exhand drop --rate 2000 --falls 1 --runs 1`. These raw
 * values differ from the scene's: the paper's gains at that rate, the wall's place by seed 1, and
 * the scales of the simulated device. That device has no calibration. */
static const struct {
    const char *name;
    int32_t raw;
} drop_value[] = {{"step", 291678445}, {"k", 20480000}, {"b", 62914560}, {"mon_scale", 567801944},
    {"q_lim", 75174133}, {"uncalibrated", 1}};

static int32_t start_raw(const struct exh_signal *row)
{
    for (size_t i = 0; i < sizeof drop_value / sizeof drop_value[0]; i++) {
        if (strcmp(drop_value[i].name, row->name) == 0) { return drop_value[i].raw; }
    }
    return row->dflt;
}

static uint32_t params(void) { return exh_signal_count(scene->params->table); }

static double scaled(const struct exh_signal *row, int32_t raw)
{
    return (double)raw / (double)(INT64_C(1) << row->frac);
}

uint32_t unit_vars(void) { return OWN + params() + exh_signal_count(scene->signals); }

/* Which signal is variable i; NULL: own or a parameter. */
static const struct exh_signal *signal_of(uint32_t i, int32_t *raw)
{
    const uint32_t first = OWN + params();
    if (i < first) { return NULL; }
    *raw = exh_scene_signals(scene)[i - first];
    return exh_signal_at(scene->signals, i - first, NULL);
}

void unit_var(uint32_t i, struct unit_var *v)
{
    int32_t raw = 0;
    const struct exh_signal *row = signal_of(i, &raw);
    uint16_t instance = 0;
    if (i < OWN) {
        *v = own_var[i];
        return;
    }
    if (row == NULL) { row = exh_signal_at(scene->params->table, i - OWN, &instance); }
    *v = (struct unit_var){
        .type = row->frac ? UNIT_FLOAT64 : UNIT_INT32, .unit = row->unit, .help = row->help};
    v->role = row->when == EXH_WHEN_OUTPUT ? UNIT_OUTPUT
              : exh_signal_is_fixed(row)   ? UNIT_FIXED
                                           : UNIT_TUNABLE;
    (void)snprintf(
        v->name, sizeof v->name, instance ? "%s_%u" : "%s", row->name, (unsigned)instance);
    v->min = scaled(row, row->min);
    v->max = scaled(row, row->max);
    v->start = scaled(row, start_raw(row));
    if (v->role == UNIT_OUTPUT && (row->min == INT32_MIN || row->max == INT32_MAX)) {
        v->min = 1;
        v->max = 0;
    }
}

double unit_get(uint32_t i)
{
    const double own[OWN] = {T.num, T.den, enc_bits, in.drive.mon_raw[0], in.drive.supply_raw,
        in.drive.din, in.missed, command, (int32_t)in.drive.enc_raw[0], out.dac_raw[0],
        out.enable & 1, out.alive};
    int32_t raw = 0;
    const struct exh_signal *row = signal_of(i, &raw);
    if (i < OWN) { return own[i]; }
    if (row) { return scaled(row, raw); }
    return scaled(
        exh_signal_at(scene->params->table, i - OWN, NULL), scene->params->staged[i - OWN]);
}

static int set_own(uint32_t i, double value)
{
    const int32_t v = (int32_t)value;
    if (own_var[i].min <= own_var[i].max && (value < own_var[i].min || value > own_var[i].max)) {
        return -EXH_E_RANGE;
    }
    if (own_var[i].role == UNIT_OUTPUT || (own_var[i].role == UNIT_FIXED && started)) {
        return -EXH_E_STATE;
    }
    switch (i) {
    case PERIOD_NUM: T.num = (uint32_t)v; break;
    case PERIOD_DEN: T.den = (uint32_t)v; break;
    case ENC_BITS: enc_bits = v; break;
    case MON: in.drive.mon_raw[0] = (int16_t)v; break;
    case SUPPLY: in.drive.supply_raw = (int16_t)v; break;
    case DIN: in.drive.din = (uint32_t)v; break;
    case MISSED: in.missed = (uint32_t)v; break;
    case COMMAND: command = v; break;
    default: in.drive.enc_raw[0] = (uint32_t)v; break;
    }
    return 0;
}

int unit_set(uint32_t i, double value)
{
    const struct exh_signal *row;
    uint16_t instance;
    double raw;
    if (i < OWN) { return set_own(i, value); }
    if (i >= OWN + params()) { return -EXH_E_STATE; }
    row = exh_signal_at(scene->params->table, i - OWN, &instance);
    raw = value * (double)(INT64_C(1) << row->frac);
    raw = raw < 0 ? raw - 0.5 : raw + 0.5;
    if (!(raw > -2147483649.0 && raw < 2147483648.0)) { return -EXH_E_RANGE; }
    return exh_params_stage(scene->params, row->id, instance, (int32_t)raw);
}

void unit_reset(void)
{
    static const struct exh_scene_in no_in;
    static const struct exh_drive_out no_out = {
        .dac_raw = {32768}}; /* 0 V: what is there before the first tick */
    in = no_in;
    out = no_out;
    T = (struct exh_period){1, scene->rate_Hz};
    started = 0;
    scene->defaults();
    for (uint32_t i = 0; i < params(); i++) {
        uint16_t instance;
        const struct exh_signal *row = exh_signal_at(scene->params->table, i, &instance);
        (void)exh_params_stage(scene->params, row->id, instance, start_raw(row));
    }
    for (uint32_t i = 0; i < exh_signal_count(scene->signals); i++) {
        exh_scene_signals(scene)[i] = 0;
    } /* of an instance before */
    for (uint32_t i = 0; i < OWN; i++) {
        if (own_var[i].role == UNIT_INPUT || i == ENC_BITS) { (void)set_own(i, own_var[i].start); }
    }
}

int unit_start(const char **which)
{
    int err;
    *which = "these parameters together";
    if (!exh_period_ok(T)) { return -EXH_E_RATE; }
    exh_params_apply(scene->params);
    err = scene->setup((struct exh_scene_board){T, (uint8_t)enc_bits});
    if (err == 0) { scene->params->locked = started = 1; }
    return err;
}

struct exh_period unit_period(void) { return T; }

int unit_step(void)
{
    in.command = (uint8_t)(command < 0 ? EXH_CMD_RUN : command);
    if (command < 0) { command = EXH_CMD_NONE; }
    exh_params_apply(scene->params);
    scene->tick(&in, &out);
    return 0;
}

/* A saved state does not contain the results of set-up. Period and parameters of the state restore
 * them. */
static void set_up_anew(struct exh_bytes *c)
{
    const struct exh_scene_board board = {T, (uint8_t)enc_bits};
    const int fits =
        exh_period_ok(T) && enc_bits >= own_var[ENC_BITS].min && enc_bits <= own_var[ENC_BITS].max;
    if (!exh_bytes_ok(c) || !started) { return; }
    if (!fits || scene->setup(board) < 0) { exh_bytes_fail(c); }
}

void unit_bytes(struct exh_bytes *c)
{
    const uint32_t n = exh_signal_count(scene->signals);
    exh_bytes_u32(c, &T.num);
    exh_bytes_u32(c, &T.den);
    exh_bytes_i32(c, &enc_bits);
    exh_bytes_i32(c, &command);
    exh_bytes_u32(c, &in.missed);
    exh_bytes_u8(c, &started);
    exh_drive_in_serialize(c, &in.drive, EXH_FINGERS);
    exh_drive_out_serialize(c, &out, EXH_FINGERS);
    exh_bytes_i32s(c, exh_scene_signals(scene), n);
    if (c->mode == EXH_BYTES_READ) { scene->params->locked = 0; }
    exh_params_serialize(c, scene->params);
    if (c->mode == EXH_BYTES_READ) { set_up_anew(c); }
    scene->params->locked = started;
    scene->state(c);
}
