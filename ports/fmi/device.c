/* SPDX-License-Identifier: MIT */
/* The simulated device as a unit: what ports/posix/board.c does around sim/mass, a tick at a time.
 */
#include "unit.h"

#include "sim/codes.h"
#include "sim/mass.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/frame.h"
#include "exhand/safety.h"

#include <string.h>

const char unit_name[] = "ExhandDevice";
const char unit_help[] = "exhand: the simulated device, a falling mass on one string: motor, "
                         "drive, encoder and codes; D/A codes in, counts out";
const char unit_order[] = "takes its inputs at the beginning of a step: step it behind "
                          "ExhandController, with that one's outputs";

#define OUTPUTS_MAX 256 /* on their way to the drive: 3 ticks + 10 ms at 20 kHz are 203 */

static struct {
    struct sim_device device;
    struct sim_mass mass;
    struct exh_period T;
    int32_t seed, falls, waits;
    int32_t dac_raw, enable, state; /* inputs */
    uint32_t enc_raw;
    int16_t mon_raw, supply_raw;
    uint64_t tick;
    double now_s;
    struct {
        double at_s, ref_A;
    } queue[OUTPUTS_MAX];
    uint32_t head, queued;
    uint8_t started, ran;
} u;

enum own {
    PERIOD_NUM,
    PERIOD_DEN,
    SEED,
    FALLS,
    WAITS,
    DAC,
    ENABLE,
    STATE,
    ENC,
    MON,
    SUPPLY,
    DIN,
    FALL,
    DONE,
    X,
    Q,
    CURRENT,
    OWN
};

static const struct unit_var own_var[OWN] = {
    [PERIOD_NUM] = {UNIT_INT32, UNIT_FIXED, "period_num", "", "period of a step, numerator, s", 1,
        2147483647, 1},
    [PERIOD_DEN] = {UNIT_INT32, UNIT_FIXED, "period_den", "", "and denominator; 1/20000..1 s", 1,
        2147483647, 2000},
    [SEED] = {UNIT_INT32, UNIT_FIXED, "seed", "", "of all chance", 0, 2147483647, 1},
    [FALLS] = {UNIT_INT32, UNIT_FIXED, "falls", "", "falls, then done", 1, 1000000, 1},
    [WAITS] = {UNIT_INT32, UNIT_FIXED, "waits", "",
        "1: the first fall is held until state says run or limit", 0, 1, 1},
    [DAC] = {UNIT_INT32, UNIT_INPUT, "dac_raw", "", "D/A code, offset binary", 0, 65535, 32768},
    [ENABLE] = {UNIT_INT32, UNIT_INPUT, "enable", "", "drive enabled", 0, 1, 0},
    [STATE] = {UNIT_INT32, UNIT_INPUT, "state", "", "of the box, for whoever holds the mass", 0, 5,
        0},
    [ENC] = {UNIT_INT32, UNIT_OUTPUT, "enc_raw", "", "encoder counter, 24 bits", 1, 0, 0},
    [MON] = {UNIT_INT32, UNIT_OUTPUT, "mon_raw", "", "current monitor, code", 1, 0, 0},
    [SUPPLY] = {UNIT_INT32, UNIT_OUTPUT, "supply_raw", "", "supply monitor, code", 1, 0, 0},
    [DIN] = {UNIT_INT32, UNIT_OUTPUT, "din", "", "digital inputs, bits: all healthy", 1, 0, 0},
    [FALL] = {UNIT_INT32, UNIT_OUTPUT, "fall", "",
        "the fall under observation; 0: the mass is held or lifted", 1, 0, 0},
    [DONE] = {UNIT_INT32, UNIT_OUTPUT, "done", "", "1: all falls are over", 1, 0, 0},
    [X] = {UNIT_FLOAT64, UNIT_OUTPUT, "x", "m", "mass, down positive, 0 is the virtual contact", 1,
        0, 0},
    [Q] = {UNIT_FLOAT64, UNIT_OUTPUT, "q", "m", "string at the motor", 1, 0, 0},
    [CURRENT] = {UNIT_FLOAT64, UNIT_OUTPUT, "current", "a", "motor current", 1, 0, 0},
};

uint32_t unit_vars(void) { return OWN + (uint32_t)sim_device_rows; }

void unit_var(uint32_t i, struct unit_var *v)
{
    const struct sim_device_row *row;
    if (i < OWN) {
        *v = own_var[i];
        return;
    }
    row = &sim_device_row[i - OWN];
    *v = (struct unit_var){.type = UNIT_FLOAT64,
        .role = UNIT_FIXED,
        .unit = row->unit,
        .help = row->help,
        .min = row->min,
        .max = row->max,
        .start = row->value};
    (void)strncpy(v->name, row->name, sizeof v->name - 1);
}

static double *device_value(uint32_t row) { return (double *)(void *)&u.device + row; }

double unit_get(uint32_t i)
{
    const int32_t done = u.mass.fall.phase == FALL_DONE;
    const double own[OWN] = {u.T.num, u.T.den, u.seed, u.falls, u.waits, u.dac_raw, u.enable,
        u.state, u.enc_raw, u.mon_raw, u.supply_raw,
        EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS | EXH_DIN_DRIVE0,
        u.mass.fall.phase == FALL_FREE ? u.mass.fall.number : 0, done, u.mass.plant.x_m,
        u.mass.plant.q_m, u.mass.plant.cur_A};
    return i < OWN ? own[i] : *device_value(i - OWN);
}

int unit_set(uint32_t i, double value)
{
    struct unit_var v;
    int32_t *const own[] = {
        NULL, NULL, &u.seed, &u.falls, &u.waits, &u.dac_raw, &u.enable, &u.state};
    unit_var(i, &v);
    if (v.role == UNIT_OUTPUT || (v.role == UNIT_FIXED && u.started)) { return -EXH_E_STATE; }
    if (!(value >= v.min && value <= v.max)) { return -EXH_E_RANGE; }
    if (i >= OWN) {
        *device_value(i - OWN) = value;
    } else if (i == PERIOD_NUM) {
        u.T.num = (uint32_t)value;
    } else if (i == PERIOD_DEN) {
        u.T.den = (uint32_t)value;
    } else {
        *own[i] = (int32_t)value;
    }
    return 0;
}

void unit_reset(void)
{
    memset(&u, 0, sizeof u);
    u.device = sim_device_default();
    u.T = (struct exh_period){1, 2000};
    for (uint32_t i = SEED; i <= STATE; i++) { (void)unit_set(i, own_var[i].start); }
}

/* What the codes are at this instant: noise and supply, once a tick, as a board reads them. */
static void read_codes(void)
{
    const double load_A = u.mass.ref_A < 0 ? -u.mass.ref_A : u.mass.ref_A;
    sim_mass_read(&u.mass, 0, &u.enc_raw, &u.mon_raw);
    u.supply_raw = sim_supply_raw(&u.device, load_A);
}

int unit_start(const char **which)
{
    *which = "period_num, period_den";
    if (!exh_period_ok(u.T)) { return -EXH_E_RATE; }
    *which = "substep: too long for this string, rotor and mass (mass, rotor, cable_k, cable_b): "
             "give a shorter one, "
             "or a heavier rotor";
    if (plant_take_step(&u.device, 0, 0) < 0) { return -EXH_E_RANGE; }
    sim_mass_fall(&u.mass, &u.device, (uint64_t)u.seed, u.falls, (double)u.T.num / (double)u.T.den);
    u.mass.fall.waits = u.waits;
    u.started = 1;
    sim_mass_advance(&u.mass, 0);
    read_codes();
    return 0;
}

struct exh_period unit_period(void) { return u.T; }

/* The code begins its way now, and arrives when its delay is over. */
static void put(void)
{
    const uint32_t at = (u.head + u.queued++) % OUTPUTS_MAX;
    u.queue[at].at_s =
        u.now_s + u.device.delay_tick * ((double)u.T.num / (double)u.T.den) + u.device.delay_s;
    u.queue[at].ref_A = sim_drive_A(&u.device, (uint16_t)u.dac_raw, u.enable);
}

int unit_step(void)
{
    double end_s;
    if (u.queued == OUTPUTS_MAX) { return -EXH_E_IO; }
    put();
    if (!u.ran && (u.state == EXH_STATE_RUN || u.state == EXH_STATE_LIMIT)) {
        u.ran = 1;
        fall_ready(&u.mass.fall, u.now_s);
    }
    end_s = (double)++u.tick * (double)u.T.num / (double)u.T.den;
    while (u.queued && u.queue[u.head].at_s <= end_s) {
        sim_mass_latch(&u.mass, u.queue[u.head].at_s, u.queue[u.head].ref_A);
        u.head = (u.head + 1) % OUTPUTS_MAX;
        u.queued--;
    }
    sim_mass_advance(&u.mass, end_s);
    u.now_s = end_s;
    read_codes();
    return 0;
}

/* As it lies in memory: numbers alone, no pointers. */
void unit_bytes(struct exh_bytes *c)
{
    uint8_t *byte = (uint8_t *)&u;
    for (size_t i = 0; i < sizeof u; i++) { exh_bytes_u8(c, &byte[i]); }
    if (u.head >= OUTPUTS_MAX || u.queued > OUTPUTS_MAX || !exh_period_ok(u.T)) {
        exh_bytes_fail(c);
    }
}
