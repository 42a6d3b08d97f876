/* SPDX-License-Identifier: MIT */
/* Names of states, triggers, faults, limits and arming steps. */
#include "exhand/safety.h"

static const char *const states[EXH_STATES] = {"off", "arm", "run", "limit", "release", "fault"};
static const char *const triggers[EXH_TRIGGERS] = {"refused", "cut", "latched", "released", "cause",
    "off", "armed", "limited", "run", "clear", "none"};
static const char *const faults[EXH_FAULTS] = {"estop", "drive", "overrun", "encoder", "deadman",
    "tracking", "stuck", "speed", "glove", "card", "link", "supply", "watchdog", "config", "logic",
    "chatter"};
static const char *const limits[EXH_LIMITS] = {"pull", "force", "slew", "peak", "i2t", "dac",
    "gate", "ramp", "release", "speed", "passivity", "person"};
static const char *const arms[EXH_ARMS] = {
    "selftest", "calibration", "polarity", "encoder", "deadman", "small_force", "ramp"};

const char *exh_state_name(unsigned state) { return state < EXH_STATES ? states[state] : ""; }

const char *exh_trigger_name(unsigned trigger)
{
    return trigger < EXH_TRIGGERS ? triggers[trigger] : "";
}

const char *exh_fault_name(unsigned k) { return k < EXH_FAULTS ? faults[k] : ""; }

const char *exh_limit_name(unsigned k) { return k < EXH_LIMITS ? limits[k] : ""; }

const char *exh_arm_name(unsigned k) { return k < EXH_ARMS ? arms[k] : ""; }
