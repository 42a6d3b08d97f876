/* SPDX-License-Identifier: MIT */
#include "base/names.h"

#include "exhand/drive.h"
#include "exhand/safety.h"

#include <stdio.h>
#include <string.h>

static const char *const states[EXH_STATES] = {"no current, drives disabled",
    "arming, step by step", "forces follow the law", "runs, a limit holds something back",
    "the force falls to zero", "no current, drives disabled, until it is cleared"};
static const char *const faults[EXH_FAULTS] = {"emergency stop", "a drive is not ready",
    "too many ticks were missed", "an encoder moved as no hand can",
    "the dead-man switch was let go", "a current does not follow what is coded",
    "an encoder stands while current flows", "a finger moved too fast for too long",
    "the glove is not believed", "a card failed", "the link is lost",
    "the supply is out of its range", "the watchdog fired", "parameters or calibration are damaged",
    "a state that cannot be", "fast oscillation in a contact"};
static const char *const limits[EXH_LIMITS] = {"a string only pulls", "the force limit",
    "how fast force may change", "the peak current", "the motor's heat",
    "the end of the D/A's range", "the gate is closed", "the ramp after arming", "the release law",
    "velocity into the law", "the passivity controller", "the person's ceiling"};
static const char *const arms[EXH_ARMS] = {"known answers come out", "calibration valid",
    "polarity of motor and encoder", "encoders plausible",
    "dead-man switch held, no cause of a fault", "the law asks for a small force only",
    "the force limit rises"};
static const char *const commands[] = {"nothing", "run", "off", "clear the fault"};
static const char *const inputs[] = {"emergency-stop loop", "dead-man switch", "watchdog", "cards",
    NULL, NULL, NULL, NULL, "drive of the thumb", "drive of the index", "drive of the middle",
    "drive of the ring", "drive of the little"};
static const char *const fingers[] = {"thumb", "index", "middle", "ring", "little"};

#define LEN(a) ((unsigned)(sizeof(a) / sizeof((a)[0])))

static const char *command_word(unsigned i)
{
    static const char *const word[LEN(commands)] = {"none", "run", "off", "clear"};
    return i < LEN(word) ? word[i] : "";
}

static const char *input_word(unsigned i)
{
    static const char *const word[LEN(inputs)] = {"estop", "deadman", "watchdog", "cards", "", "",
        "", "", "drive0", "drive1", "drive2", "drive3", "drive4"};
    return i < LEN(word) ? word[i] : "";
}

static const char *finger_word(unsigned i) { return i < LEN(fingers) ? fingers[i] : ""; }

const struct names names_state = {"state", exh_state_name, states, LEN(states)};
const struct names names_fault = {"fault", exh_fault_name, faults, LEN(faults)};
const struct names names_limit = {"limit", exh_limit_name, limits, LEN(limits)};
const struct names names_arm = {"arming step", exh_arm_name, arms, LEN(arms)};
const struct names names_command = {"command", command_word, commands, LEN(commands)};
const struct names names_din = {"input", input_word, inputs, LEN(inputs)};
const struct names names_finger = {"finger", finger_word, fingers, LEN(fingers)};

const char *names_word(const struct names *t, unsigned i)
{
    return t->word(i)[0] ? t->word(i) : "?";
}

const char *names_says(const struct names *t, unsigned i)
{
    return i < t->n && t->says[i] ? t->says[i] : "?";
}

int names_find(const struct names *t, const char *word)
{
    for (unsigned i = 0; word[0] && i < t->n; i++) {
        if (strcmp(t->word(i), word) == 0) { return (int)i; }
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
        if (t->word(i)[0]) {
            n = snprintf(to + at, cap_B - at, "%s%s", at ? "+" : "", t->word(i));
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

const char *names_unit(const char *ascii)
{
    static const char *const unit[][2] = {{"n", "N"}, {"a", "A"}, {"v", "V"}, {"hz", "Hz"},
        {"n_per_m", "N/m"}, {"ns_per_m", "Ns/m"}, {"m_per_s", "m/s"}, {"n_per_s", "N/s"},
        {"n_per_a", "N/A"}, {"per_a", "1/A"}, {"per_m", "1/m"}, {"rad_per_s", "rad/s"},
        {"percent", "%"}, {"w", "W"}, {"j", "J"}};
    for (unsigned i = 0; i < LEN(unit); i++) {
        if (strcmp(ascii, unit[i][0]) == 0) { return unit[i][1]; }
    }
    return ascii;
}

/* What its cause needs to be gone: a new set-up, or power-on (docs/SAFETY.md). */
#define RESTART \
    ((uint32_t)(EXH_FAULT_ENCODER | EXH_FAULT_CARD | EXH_FAULT_WATCHDOG | EXH_FAULT_CONFIG))

uint32_t names_restart(uint32_t latched) { return latched & RESTART; }

void names_clear(char to[NAMES_CLEAR_B], uint32_t latched, uint32_t present)
{
    const uint32_t stays = present & ~(uint32_t)EXH_FAULT_DEADMAN;
    char which[NAMES_B];
    to[0] = '\0';
    if (latched == 0) { return; }
    if (names_restart(latched)) {
        names_faults(which, sizeof which, names_restart(latched));
        (void)snprintf(to, NAMES_CLEAR_B, "only a new start of the box clears %s", which);
    } else if (stays) {
        names_faults(which, sizeof which, stays);
        (void)snprintf(to, NAMES_CLEAR_B, "first end what causes %s", which);
    } else {
        (void)snprintf(
            to, NAMES_CLEAR_B, "let go of the dead-man switch, hold it again, then command CLEAR");
    }
}
