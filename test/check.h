/* SPDX-License-Identifier: MIT */
/* Check: the test API, written once for every place where a test runs.
 *
 * A test file is a list of TEST(name) bodies and one TEST_MAIN("group", name, ...). On a host it
 * uses CMocka, one group a binary. With -DEXH_CHECK_PLAIN it uses its own printer, which needs only
 * a putchar (EXH_CHECK_PUTCHAR names another). So the same file runs on bare metal. The last line
 * is then "N passed, N failed". It uses integers only, since a target may have no floats.
 *
 * Environment on hosts, -D on targets: EXH_SEED, EXH_CASES (cases of a property).
 * Hosts only: EXH_TEST=name runs one test, EXH_CASE=i one case of its properties,
 * EXH_PART=k of EXH_PARTS=n those whose number is k modulo n.
 */
#ifndef TEST_CHECK_H
#define TEST_CHECK_H

#include <stddef.h>
#include <stdint.h>

#if __STDC_HOSTED__
#include <inttypes.h>
#include <string.h>
#else /* without a C library; where int has 32 bits it does whichever of int and long int32_t is \
       */
#include <limits.h>
#if INT_MAX >= INT32_MAX
#define PRId32 "d"
#define PRIu32 "u"
#define PRIx32 "x"
#else
#define PRId32 "ld"
#define PRIu32 "lu"
#define PRIx32 "lx"
#endif
#define PRId64 "lld"
#define PRIu64 "llu"
#define PRIx64 "llx"
void *memcpy(void *dst, const void *src, size_t n);
void *memset(void *dst, int c, size_t n);
int memcmp(const void *a, const void *b, size_t n);
#endif

#if defined(__GNUC__) && __STDC_HOSTED__
#define CHECK_PRINTF(fmt, args) __attribute__((format(printf, fmt, args)))
#else
#define CHECK_PRINTF(fmt, args)
#endif

#define LEN(a)     (sizeof(a) / sizeof((a)[0]))
#define TEST(name) static void name(void)

#define CHECK_NAMES(...) #__VA_ARGS__ /* expands a list that is a macro */
#define TEST_MAIN(group, ...) \
    int main(void) \
    { \
        static const check_fn list[] = {__VA_ARGS__}; \
        return check_main(group, CHECK_NAMES(__VA_ARGS__), list, LEN(list)); \
    } \
    typedef int check_main_defined

/* cond must hold; the message says with which values it did not. CMocka leaves
 * the test at the first failure; the plain printer goes on, so nothing after a
 * CHECK may depend on it to be safe. */
#define CHECK(cond, ...) \
    do { \
        check_count++; \
        if (!(cond)) { check_failed(__FILE__, __LINE__, #cond, __VA_ARGS__); } \
    } while (0)

#define CHECK_EQ_I64(got, want) \
    do { \
        const int64_t check_got = (got); \
        const int64_t check_want = (want); \
        CHECK(check_got == check_want, "got %" PRId64 ", want %" PRId64, check_got, check_want); \
    } while (0)

typedef void (*check_fn)(void);

extern uint64_t check_count;       /* checks made so far */
extern uint32_t check_saturations; /* calls of the audit hook of fix.h so far */

/* 1 if two strings are equal; a target may have no strcmp. */
int check_same_text(const char *a, const char *b);

int check_main(const char *group, const char *names, const check_fn *list, size_t n);
void check_failed(const char *file, int line, const char *cond, const char *fmt, ...)
    CHECK_PRINTF(4, 5);

/* The value of NAME in the environment of a host, or where EXH_CHECK_ENV names a function of that
 * kind in what that says; NULL where there is neither. */
const char *check_env(const char *name);

/* Prints a line: own printer alone. */
void check_line(const char *fmt, ...) CHECK_PRINTF(1, 2);

/* Prints a line that is no failure: what a test found, or could not cover here and why.
 * It begins with "  | ", by which test/run.sh shows it of a test that passed. */
void check_note(const char *fmt, ...) CHECK_PRINTF(1, 2);

/* Properties: while (check_case(1)) { x = check_i32(); ... } runs EXH_CASES
 * cases / slower. Each case has its own generator state, so that one case can be
 * run again alone. 0 ends the loop and makes the next one start afresh. */
int check_case(uint32_t slower);
/* Whether this process has all cases. A part of them need not come to each state. */
int check_has_all(void);

/* The generator, splitmix64, of the case that runs. */
uint64_t check_u64(void);

/* A third uniform, a third log-distributed, a third at or beside a corner. */
int32_t check_i32(void);
int64_t check_i64(void);

/* The same mix within lo..hi, both included and both favoured. */
int32_t check_i32_in(int32_t lo, int32_t hi);

/* Corners of an int32_t argument, for loops over all of them. */
#define CHECK_CORNERS 8
extern const int32_t check_corner[CHECK_CORNERS];

#endif
