/* Words for what the library counts in bits and numbers: the one place of them, for every command
 * that tells a person of states, faults, limits, arming steps, commands or inputs. */
#ifndef CLI_NAMES_H
#define CLI_NAMES_H

#include <stddef.h>
#include <stdint.h>

#define NAMES_B 512 /* room for every bit of any of them                        */

/* The name of one, by its number or by the number of its bit; NULL: there is none. `word` is short,
 * as in options and tables ("deadman"); `says` is for people ("dead-man switch released"). */
struct name {
    const char *word, *says;
};
struct names {
    const char *what; /* "fault"                                               */
    const struct name *name;
    unsigned n;
};
extern const struct names names_state, names_command, names_fault, names_limit, names_arm,
    names_din, names_finger;

const char *names_word(const struct names *t, unsigned i); /* "fault 17" is not there: "?" */
const char *names_says(const struct names *t, unsigned i);
int names_find(const struct names *t, const char *word); /* its number, or -1    */

/* The words of all bits set, with + between; "none" for 0; a bit without a name as bit17. Always
 * ended; cut where it does not fit. */
void names_bits(char *to, size_t cap_B, const struct names *t, uint32_t bits);
void names_faults(char *to, size_t cap_B, uint32_t bits);

#endif
