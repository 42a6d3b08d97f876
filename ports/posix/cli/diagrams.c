/* What is wired to what: the paper's overview, set-up and first controller model. */
#include "diagram.h"

#define LEN(a) ((int)(sizeof(a) / sizeof((a)[0])))

static const struct diagram_box overview_box[] = {
    {2, 6, 30, 14, "glove", {"22 joint angles", "not in this scene"}},
    {2, 27, 30, 17, "exoskeleton", {"five strings,", "a motor and an encoder each"}},
    {48, 6, 32, 38, "exhand",
     {"one tick at 1 Hz .. 20 kHz:", "read, law, limits, gate, write", "A/D for 22 glove sensors",
      "counters for 5 encoders", "D/A and A/D for 5 drives"}},
    {96, 6, 28, 14, "another computer", {"world, or a slave hand", "not in this scene"}},
    {96, 27, 28, 17, "motor drives", {"current loop {d:servo_rate}", "{p:i_peak}, {p:i_cont}"}},
};
static const struct diagram_wire overview_wire[] = {
    {2, {{32, 13}, {48, 13}}, "voltages", 40, 11},
    {2, {{80, 13}, {96, 13}}, "link", 88, 11},
    {2, {{32, 35}, {48, 35}}, "encoders", 40, 33},
    {2, {{80, 32}, {96, 32}}, "commands", 88, 30},
    {2, {{96, 40}, {80, 40}}, "monitors", 88, 43},
    {4, {{110, 44}, {110, 51}, {17, 51}, {17, 44}}, "motor currents", 63, 49},
};

static const struct diagram_box setup_box[] = {
    {2, 6, 30, 17, "motor", {"rotor {d:rotor}", "string force {d:kf}", "friction {d:coulomb}"}},
    {2, 31, 30, 14, "encoder", {"{d:step} of string a line", "counts per line {d:decode}"}},
    {48, 6, 28, 17, "string", {"stiffness {d:cable_k}", "damping {d:cable_b}", "pulls only"}},
    {92, 6, 30, 17, "mass", {"{d:mass}", "falls {d:height}", "{d:height_jitter} more or less"}},
    {48, 31, 28, 17, "drive", {"current loop {d:servo_rate}", "peak {d:peak}", "delay {d:delay}"}},
    {92, 31, 30, 14, "controller", {"virtual contact {p:q_lim}", "any loop rate"}},
};
static const struct diagram_wire setup_wire[] = {
    {2, {{32, 14}, {48, 14}}, "tension", 40, 12},
    {2, {{76, 14}, {92, 14}}, "tension", 84, 12},
    {2, {{17, 23}, {17, 31}}, "turns", 21, 28},
    {4, {{17, 45}, {17, 54}, {107, 54}, {107, 45}}, "{s:q}", 62, 52},
    {2, {{92, 36}, {76, 36}}, "{s:i_des}", 84, 34},
    {4, {{48, 38}, {40, 38}, {40, 20}, {32, 20}}, "current", 40, 41},
    {2, {{76, 42}, {92, 42}}, "{s:f_mon}", 84, 45},
};

static const struct diagram_box identification_box[] = {
    {2, 6, 26, 14, "quad", {"{p:step}", "{p:speed_max}"}},
    {2, 29, 26, 11, "velocity", {"over 2^p ticks, {p:vel_p}"}},
    {40, 6, 24, 22, "contact", {"{p:q_lim}", "{p:k}", "{p:b}", "{p:f0}", "{p:f0_band}"}},
    {78, 6, 26, 22, "drive", {"{p:f_max}", "{p:slew_up}", "{p:kf}", "{p:i_peak}", "{p:i_cont}"}},
    {78, 37, 26, 11, "safety", {"{p:missed_max}"}},
    {118, 6, 24, 22, "gate", {"{p:dac_zero}", "{p:dac_span}", "{p:dac_scale}"}},
    {40, 37, 28, 14, "monitor", {"{p:mon_zero}", "{p:mon_scale}"}},
};
static const struct diagram_wire identification_wire[] = {
    {2, {{28, 12}, {40, 12}}, "{s:q}", 34, 10},
    {2, {{15, 20}, {15, 29}}, "count", 19, 26},
    {4, {{28, 35}, {34, 35}, {34, 23}, {40, 23}}, "{s:qd}", 34, 38},
    {2, {{64, 14}, {78, 14}}, "ledger, {s:c}", 71, 12},
    {2, {{104, 14}, {118, 14}}, "{s:f_des}", 111, 12},
    {3, {{104, 43}, {130, 43}, {130, 28}}, "{s:state}, {s:faults}", 118, 46},
    {2, {{91, 37}, {91, 28}}, "run", 94, 34},
    {2, {{142, 14}, {156, 14}}, "{s:i_des}", 149, 12},
    {3, {{156, 56}, {54, 56}, {54, 51}}, "monitor code", 105, 54},
    {2, {{40, 44}, {28, 44}}, "{s:f_mon}", 34, 47},
};

const struct diagram diagrams[] = {
    {"overview", "The box in its surroundings", 126, 54, overview_box, LEN(overview_box),
     overview_wire, LEN(overview_wire)},
    {"setup", "The falling mass", 124, 58, setup_box, LEN(setup_box), setup_wire,
     LEN(setup_wire)},
    {"identification", "One tick of the identification controller", 160, 60, identification_box,
     LEN(identification_box), identification_wire, LEN(identification_wire)},
};
const int diagrams_n = LEN(diagrams);
