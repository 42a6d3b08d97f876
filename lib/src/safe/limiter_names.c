/* SPDX-License-Identifier: MIT */
/* Names of a limiter's limits, causes and fields. */
#include "exhand/limiter.h"

static const char *const limits[EXH_LIMITER_LIMITS] = {
    "effort", "rise", "heat", "ramp", "range", "velocity", "acceleration", "release", "state"};
static const char *const causes[EXH_LIMITER_CAUSES] = {
    "logic", "not_a_number", "time", "deadman", "stale", "range", "speed", "stall", "heat", "far"};
static const char *const fields[EXH_LIMITER_FIELDS] = {"kind", "uses", "rate_milli", "effort_max",
    "effort_up_milli", "effort_down_milli", "ramp_ms", "release_ms", "pos_min", "pos_max",
    "pos_over", "vel_max", "acc_max_milli", "first_max", "first", "after", "age_max_us",
    "gap_max_us", "speed_max", "speed_ms", "stall_effort", "stall_move", "stall_ms", "heat_nominal",
    "heat_peak", "heat_ms", "wall_below", "wall_k_milli", "wall_b", "wall_f0"};

const char *exh_limiter_limit_name(unsigned k) { return k < EXH_LIMITER_LIMITS ? limits[k] : ""; }

const char *exh_limiter_cause_name(unsigned k) { return k < EXH_LIMITER_CAUSES ? causes[k] : ""; }

const char *exh_limiter_field_name(unsigned k) { return k < EXH_LIMITER_FIELDS ? fields[k] : ""; }
