/* SPDX-License-Identifier: MIT */
/* What is wired to what: the paper's overview, set-up, both controller models, and what the second
 * of them measures. */
#include "lab/diagram/diagram.h"

#define LEN(a) ((int)(sizeof(a) / sizeof((a)[0])))

static const struct diagram_box overview_box[] = {
    {2, 6, 30, 14, "glove", {"22 joint angles", "not in this scene"}},
    {2, 27, 30, 17, "exoskeleton", {"five strings,", "a motor and an encoder each"}},
    {48,
     6,
     32,
     38,
     "exhand",
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

static const struct diagram_box principle_box[] = {
    {2, 8, 26, 15, "hand", {"in glove", "and exoskeleton"}},
    {48,
     8,
     34,
     38,
     "controller",
     {"{S:d}, {S:q_lim}", "frozen at {P:d_lim}", "contact law, limits", "at its own rate,",
      "waits for nobody"}},
    {112,
     8,
     34,
     38,
     "world simulator",
     {"another computer", "virtual hand, objects", "casts a ray a finger,", "draws bars of F",
      "100 .. 400 frames a second"}},
    {2, 31, 26, 15, "drives", {"five motors", "five strings"}},
};
static const struct diagram_wire principle_wire[] = {
    {2, {{28, 15}, {48, 15}}, "&#966;: 22 angles", 38, 13},
    {2, {{48, 35}, {28, 35}}, "I: currents", 38, 33},
    {2, {{28, 42}, {48, 42}}, "{S:q}", 38, 45},
    {2, {{15, 31}, {15, 23}}, "F", 18, 28},
    {2, {{8, 23}, {8, 31}}, "V", 5, 28},
    {2, {{82, 17}, {112, 17}}, "&#952;, P_F, F: robot joints, forces", 97, 15},
    {2, {{112, 37}, {82, 37}}, "P_C, n_C: a plane a finger", 97, 35},
};
static const char *const principle_svg[] = {
    "<line x1='970' y1='190' x2='970' y2='320' stroke='#888888' stroke-width='2' "
    "stroke-dasharray='6,6'/>",
    "<text x='970' y='262' fill='#555555'>link: late, jittery, lossy</text>", NULL};

static const struct diagram_box bilateral_box[] = {
    {2, 6, 28, 14, "glove, hand", {"22 codes to &#952; and P_F", "{P:glove_fc}"}},
    {2, 28, 28, 14, "wire", {"planes in, &#952; and F out", "every {P:state_every} ticks"}},
    {44,
     6,
     34,
     36,
     "precontact",
     {"d = (P_C - P_F) n + t", "d &lt; d_lim: q_lim = q - s d", "else q_lim stands", "{P:d_lim}",
      "{P:d_hyst}", "{P:age_max}"}},
    {2, 50, 28, 14, "quad, velocity", {"{P:step}", "over 2^p ticks, {P:vel_p}"}},
    {94,
     6,
     26,
     22,
     "contact",
     {"as without a link", "{P:mat_k}", "{P:mat_b}", "taken at the freeze"}},
    {94, 42, 26, 22, "drive, gate", {"{P:i_peak}", "{P:i_cont}", "{P:f_max}", "{P:mat_f_max}"}},
};
static const struct diagram_wire bilateral_wire[] = {
    {2, {{30, 13}, {44, 13}}, "P_F", 37, 11},
    {2, {{30, 35}, {44, 35}}, "P_C, n_C", 37, 33},
    {4, {{30, 57}, {61, 57}, {61, 50}, {61, 42}}, "{S:q}", 55, 51},
    {2, {{78, 16}, {94, 16}}, "{S:q_lim}", 86, 14},
    {4, {{30, 61}, {86, 61}, {86, 23}, {94, 23}}, "{S:q}, {S:qd}", 74, 59},
    {2, {{107, 28}, {107, 42}}, "{S:f_des}", 116, 36},
    {2, {{120, 53}, {136, 53}}, "{S:i_des}", 128, 51},
};

/* The paper's geometry with its own letters: a finger from J_d to its tip, the object, the plane.
 */
static const char *const geometry_svg[] = {
    "<style>.l{stroke:#333333;stroke-width:2.5;fill:none}.t{text-anchor:start}.d{stroke-dasharray:"
    "7,6}"
    ".a{marker-end:url(#tip)}</style>",
    "<path d='M250,150 L470,235' stroke='#c9d6e8' stroke-width='92' stroke-linecap='round'/>",
    "<circle cx='470' cy='235' r='46' fill='#e3ebf6' class='l'/>",
    "<circle cx='250' cy='150' r='9' fill='#333333'/><text class='t' x='180' y='112'>{J_d} joint "
    "of the fingertip</text>",
    "<circle cx='470' cy='235' r='6' fill='#1f5fbf'/><text x='452' y='222'>P_F</text>",
    "<path class='l a' d='M470,235 L505,190'/><path class='l a' d='M470,235 L525,256'/>",
    "<text x='545' y='190'>{F}</text>",
    "<path d='M330,560 A330,330 0 0 1 900,560 Z' fill='#f0e6d8' stroke='#9c7a4d' "
    "stroke-width='2.5'/>",
    "<text x='620' y='535'>O, the object</text>",
    "<line class='l d' x1='255' y1='396' x2='800' y2='396' style='stroke:#1a8f2e'/>",
    "<text class='t' x='805' y='402'>H, the plane that stands for it</text>",
    "<path d='M470,235 L585,391' class='l d a' style='stroke:#d62728'/>",
    "<text x='552' y='310' fill='#d62728'>r</text>",
    "<circle cx='588' cy='396' r='6' fill='#d62728'/><text x='592' y='428'>P_C</text>",
    "<path class='l a' d='M588,396 L588,300'/><text x='618' y='312'>n_C</text>",
    "<path class='l' d='M470,235 L470,281' style='stroke:#1f5fbf'/><text x='458' y='266' "
    "fill='#1f5fbf'>t</text>",
    "<path class='l' d='M455,281 L485,281 M470,281 L470,396' style='stroke:#7a1fa2'/>",
    "<text x='440' y='345' fill='#7a1fa2'>&#8722;d</text>",
    "<path class='l a' d='M90,500 L90,410'/><path class='l a' d='M90,500 L180,500'/>",
    "<text x='70' y='530'>{R}, the palm</text>",
    "<path d='M90,500 L462,238' class='l a d'/><text x='215' y='350'>P_F in {R}</text>",
    "<path d='M90,500 L580,399' class='l a d'/><text x='300' y='492'>P_C in {R}</text>",
    "<text class='t' x='690' y='120'>d = (P_C &#8722; P_F)&#183;n_C + t: below 0 before the "
    "touch</text>",
    "<text class='t' x='690' y='150'>d &lt; d_lim: q_lim = q &#8722; s d moves along</text>",
    "<text class='t' x='690' y='180'>d &#8805; d_lim: q_lim stands, whatever the link says</text>",
    "<text class='t' x='690' y='210'>{P:d_lim}, {P:d_hyst}</text>",
    "<text class='t' x='690' y='240'>t: {P:pad}, s: string per fingertip</text>",
    NULL};

const struct diagram diagrams[] = {
    {"overview", "The box in its surroundings", 126, 54, overview_box, LEN(overview_box),
     overview_wire, LEN(overview_wire), NULL},
    {"setup", "The falling mass", 124, 58, setup_box, LEN(setup_box), setup_wire, LEN(setup_wire),
     NULL},
    {"identification", "One tick of the identification controller", 160, 60, identification_box,
     LEN(identification_box), identification_wire, LEN(identification_wire), NULL},
    {"principle", "Who tells whom what in the bilateral experiment", 148, 50, principle_box,
     LEN(principle_box), principle_wire, LEN(principle_wire), principle_svg},
    {"geometry", "Before a contact", 116, 58, NULL, 0, NULL, 0, geometry_svg},
    {"bilateral", "One tick of the bilateral controller, of a finger", 138, 68, bilateral_box,
     LEN(bilateral_box), bilateral_wire, LEN(bilateral_wire), NULL},
};
const int diagrams_n = LEN(diagrams);
