#include "names.h"

#include <stdio.h>
#include <string.h>

#define LEN(a)         (sizeof(a) / sizeof((a)[0]))
#define TABLE(w, rows) {(w), (rows), LEN(rows)}

/* In the order of enum exh_state. */
static const struct name states[] = {
    {"off", "no current, drives disabled"},
    {"arm", "arming, step by step"},
    {"run", "forces follow the law"},
    {"limit", "runs, a limit holds something back"},
    {"release", "the force falls to zero"},
    {"fault", "no current, drives disabled, until it is cleared"},
};
/* enum exh_command */
static const struct name commands[] = {
    {"none", "nothing"},
    {"run", "run"},
    {"off", "off"},
    {"clear", "clear the fault"},
};
/* Bits of enum exh_fault. */
static const struct name faults[] = {
    {"estop", "emergency stop"},
    {"drive", "a drive is not ready"},
    {"overrun", "too many ticks were missed"},
    {"encoder", "an encoder moved as no hand can"},
    {"deadman", "the dead-man switch was let go"},
    {"tracking", "a current does not follow what is coded"},
    {"stuck", "an encoder stands while current flows"},
    {"speed", "a finger moved too fast for too long"},
    {"glove", "the glove is not believed"},
    {"card", "a card failed"},
    {"link", "the link is lost"},
    {"supply", "the supply is out of its range"},
    {"watchdog", "the watchdog fired"},
    {"config", "parameters or calibration are damaged"},
    {"logic", "a state that is none"},
};
/* Bits of enum exh_limit. */
static const struct name limits[] = {
    {"pull", "a string only pulls"},
    {"force", "the force limit"},
    {"slew", "how fast force may change"},
    {"peak", "the peak current"},
    {"i2t", "the motor's heat (I2t)"},
    {"dac", "the end of the D/A's range"},
    {"gate", "the gate is closed"},
    {"ramp", "the ramp after arming"},
    {"release", "the release law"},
    {"speed", "velocity into the law is held back"},
    {"passivity", "the passivity controller"},
};
/* Bits of enum exh_arm. */
static const struct name arms[] = {
    {"selftest", "self-test"},
    {"calibration", "calibration valid"},
    {"polarity", "polarity plausible"},
    {"encoder", "encoders plausible"},
    {"deadman", "dead-man switch held, emergency stop closed, drives ready"},
    {"small_force", "the law asks for a small force only"},
    {"ramp", "the force limit rises"},
};
/* Bits of enum exh_din: 1 is good. */
static const struct name dins[] = {
    {"estop", "emergency-stop loop"}, {"deadman", "dead-man switch"}, {"watchdog", "watchdog"},
    {"cards", "cards"},               {NULL, NULL},                   {NULL, NULL},
    {NULL, NULL},                     {NULL, NULL},                   {"drive0", "drive of the thumb"},
    {"drive1", "drive of the index"}, {"drive2", "drive of the middle"},
    {"drive3", "drive of the ring"},  {"drive4", "drive of the little"},
};
static const struct name fingers[] = {
    {"thumb", "thumb"}, {"index", "index"}, {"middle", "middle"}, {"ring", "ring"}, {"little", "little"},
};

const struct names names_state = TABLE("state", states);
const struct names names_command = TABLE("command", commands);
const struct names names_fault = TABLE("fault", faults);
const struct names names_limit = TABLE("limit", limits);
const struct names names_arm = TABLE("arming step", arms);
const struct names names_din = TABLE("input", dins);
const struct names names_finger = TABLE("finger", fingers);

const char *names_word(const struct names *t, unsigned i)
{
    return i < t->n && t->name[i].word ? t->name[i].word : "?";
}

const char *names_says(const struct names *t, unsigned i)
{
    return i < t->n && t->name[i].says ? t->name[i].says : "?";
}

int names_find(const struct names *t, const char *word)
{
    for (unsigned i = 0; i < t->n; i++) {
        if (t->name[i].word && strcmp(t->name[i].word, word) == 0) { return (int)i; }
    }
    return -1;
}

void names_bits(char *to, size_t cap_B, const struct names *t, uint32_t bits)
{
    size_t at = 0;
    if (cap_B == 0) { return; }
    snprintf(to, cap_B, "none");
    for (unsigned i = 0; i < 32 && at + 1 < cap_B; i++) {
        int n;
        if (!(bits >> i & 1)) { continue; }
        if (i < t->n && t->name[i].word) {
            n = snprintf(to + at, cap_B - at, "%s%s", at ? "+" : "", t->name[i].word);
        } else {
            n = snprintf(to + at, cap_B - at, "%sbit%u", at ? "+" : "", i);
        }
        at += n > 0 ? (size_t)n : 0;
    }
}

void names_faults(char *to, size_t cap_B, uint32_t bits)
{
    names_bits(to, cap_B, &names_fault, bits);
}
