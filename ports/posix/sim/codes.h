/* SPDX-License-Identifier: MIT */
/* Codes of the simulated device's cards and drive. */
#ifndef SIM_CODES_H
#define SIM_CODES_H

#include "device.h"
#include "random.h"

#include <stdint.h>

static inline int64_t sim_floor(double v)
{
    const int64_t i = (int64_t)v;
    return (double)i > v ? i - 1 : i;
}

/* The 24-bit counter at this string; grid: the encoder's phase, counts; jitter: counts. */
static inline uint32_t sim_encoder_raw(
    const struct sim_device *d, double q_m, double grid, double jitter)
{
    const int64_t cnt = sim_floor(q_m * d->decode / d->step_m + grid + d->enc_start + jitter);
    return (uint32_t)((uint64_t)cnt & 0xFFFFFF);
}

/* The monitor at this current, */
static inline int16_t sim_monitor_code(const struct sim_device *d, double mon_A)
{
    const int64_t raw = sim_floor(mon_A / d->mon_apc + 0.5);
    return (int16_t)(raw > 32767 ? 32767 : raw < -32768 ? -32768 : raw);
}

/* and with its noise. */
static inline int16_t sim_monitor_raw(
    const struct sim_device *d, double mon_A, struct sim_random *r)
{
    return sim_monitor_code(d, mon_A + d->mon_noise_a * sim_random_bell(r));
}

/* The monitor of the supply while the motors take so much in all. */
static inline int16_t sim_supply_raw(const struct sim_device *d, double sum_A)
{
    const double rail_V = d->rail_v - d->rail_ohm * sum_A;
    const int64_t raw = sim_floor((rail_V > 0 ? rail_V : 0) / d->rail_vpc + 0.5);
    return (int16_t)(raw > 32767 ? 32767 : raw);
}

/* What the drive makes of a D/A code: 0 if it is not enabled. */
static inline double sim_drive_A(const struct sim_device *d, uint16_t dac_raw, int enabled)
{
    const double asked_A = ((double)dac_raw - d->dac_zero) / d->dac_perA;
    const double ref_A = asked_A > d->peak_a    ? d->peak_a
                         : asked_A < -d->peak_a ? -d->peak_a
                                                : asked_A;
    return enabled ? ref_A : 0;
}

/* The servo's first sample behind at_s, from its first of all, less than a period behind at_s or
 * before. By a product: a sum of periods drifts by its rounding. */
static inline double sim_servo_s(double first_s, double hz, double at_s)
{
    const double n = (double)(int64_t)((at_s - first_s) * hz + 1);
    const double sample_s = first_s + n / hz;
    return sample_s > at_s ? sample_s : first_s + (n + 1) / hz;
}

/* The place of a wall `phase` (0..1) counts above an encoder count that is nearest to the height of
 * the fall, counted from where the string starts. */
static inline double sim_wall_m(const struct sim_device *d, double phase)
{
    const double step_m = d->step_m / d->decode;
    return ((double)sim_floor(d->height_m / step_m - phase + 0.5) + phase) * step_m;
}

#endif
