/* SPDX-License-Identifier: MIT */
/* Names for states, faults, limits, arming steps, commands, inputs and fingers. Short names are the
 * library's where it has them (safety.h). Sentences and other names are defined here only, for all
 * commands. */
#ifndef CLI_NAMES_H
#define CLI_NAMES_H

#include <stddef.h>
#include <stdint.h>

#define NAMES_B 512 /* room for every bit of any of them */

/* By number, or by the number of a bit. */
struct names {
    const char *what;                /* "fault" */
    const char *(*word)(unsigned i); /* "deadman"; "" for none */
    const char *const *says;         /* "the dead-man switch was let go" */
    unsigned n;
};
extern const struct names names_state, names_command, names_fault, names_limit, names_arm,
    names_din, names_finger;

const char *names_word(const struct names *t, unsigned i); /* "?" for none */
const char *names_says(const struct names *t, unsigned i);
int names_find(const struct names *t, const char *word); /* its number, or -1 */

/* The words of all bits set, with + between; "none" for 0; a bit without a name as bit17. Always
 * ended; cut where it does not fit. */
void names_bits(char *to, size_t cap_B, const struct names *t, uint32_t bits);
void names_faults(char *to, size_t cap_B, uint32_t bits);

/* A row's unit as people write it: N/m for n_per_m. CSV headers and files keep the row's. */
const char *names_unit(const char *ascii);

/* Those of the faults that a new start alone clears. */
uint32_t names_restart(uint32_t latched);

/* What a person does to clear these faults, of which those in `present` still have their cause. */
#define NAMES_CLEAR_B (NAMES_B + 64)
void names_clear(char to[NAMES_CLEAR_B], uint32_t latched, uint32_t present);

#endif
