/* SPDX-License-Identifier: MIT */
/* Anything: for the abstract interpreter alone. A harness includes the source it judges, gives it
 * every value the documents allow (of a state: every bit pattern), and ends with END(). */
#ifndef PROOF_ANY_H
#define PROOF_ANY_H

#include "__fc_builtin.h"

#include <stdint.h>

#define ANY(object) Frama_C_make_unknown((char *)&(object), sizeof(object))
#define END()       Frama_C_show_each_end(1)

static int32_t any32(void) { return Frama_C_interval(INT32_MIN, INT32_MAX); }

static uint8_t any8(void) { return (uint8_t)Frama_C_unsigned_int_interval(0, 255); }

static uint32_t any_u32(void) { return Frama_C_unsigned_int_interval(0, UINT32_MAX); }

static int64_t any64(void)
{
    int64_t v;
    ANY(v);
    return v;
}

static uint64_t any_u64(void) { return (uint64_t)any64(); }

/* A gain as exh_gain_set() leaves it. */
#define ANY_GAIN(g) \
    ((g).mant = Frama_C_interval(0, INT32_MAX), \
        (g).shift = (uint8_t)Frama_C_unsigned_int_interval(0, 62))

/* A state as its function of bytes leaves it, whatever was read. */
#define FROM_BYTES(state, f) \
    do { \
        static uint8_t read_B[4096]; \
        struct exh_bytes c; \
        ANY(read_B); \
        c = exh_bytes_reader(read_B, sizeof read_B); \
        f(&c, &(state)); \
    } while (0)

/* As the library's: it does not return, and is not called; but where the harness gives what breaks a
 * contract (MAY_STOP), since to stop is the answer to that. */
void exh_assert_failed(const char *file, int line)
{
    (void)file;
    (void)line;
#ifndef MAY_STOP
    /*@ assert no_assertion_fails: \false; */
#endif
    for (;;) {}
}

#endif
