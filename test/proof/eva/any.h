/* Anything: for the abstract interpreter alone. A harness includes the source it judges, gives it
 * every value the documents allow (of a state: every bit pattern), and ends with END(). */
#ifndef PROOF_ANY_H
#define PROOF_ANY_H

#include "__fc_builtin.h"

#include <stdint.h>

#define ANY(object) Frama_C_make_unknown((char *)&(object), sizeof(object))
#define END()       Frama_C_show_each_end(1)

static int32_t any32(void)
{
    return Frama_C_interval(INT32_MIN, INT32_MAX);
}

static uint8_t any8(void)
{
    return (uint8_t)Frama_C_unsigned_int_interval(0, 255);
}

static uint32_t any_u32(void)
{
    return Frama_C_unsigned_int_interval(0, UINT32_MAX);
}

static int64_t any64(void)
{
    int64_t v;
    ANY(v);
    return v;
}

/* As the library's: it does not return. */
void exh_assert_failed(const char *file, int line)
{
    (void)file;
    (void)line;
    for (;;) {}
}

#endif
