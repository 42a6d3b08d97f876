/* SPDX-License-Identifier: MIT */
/* The one shared object of all tests: runner, printer, generator, and the two
 * hooks that the library asks of a program. */
#include "check.h"

#include "exhand/error.h"

#include <stdarg.h>

#ifndef EXH_SEED
#define EXH_SEED 1
#endif
#ifndef EXH_CASES
#define EXH_CASES 1000000
#endif

#if __STDC_HOSTED__
#include <stdlib.h>
#endif
#ifndef EXH_CHECK_PLAIN
#include <setjmp.h>
#include <stdio.h>
/* cmocka.h wants the three headers above it first */
#include <cmocka.h>
#elif !defined(EXH_CHECK_PUTCHAR)
#include <stdio.h>
#define EXH_CHECK_PUTCHAR putchar
#else
int EXH_CHECK_PUTCHAR(int c);
#endif

void exh_fix_saturated(const char *file, int line);

#define TESTS_MAX  64
#define NAME_MAX_B 48
#define NO_CASE    UINT64_MAX

uint64_t check_count;
uint32_t check_saturations;
const int32_t check_corner[CHECK_CORNERS] = {
    INT32_MIN, INT32_MIN + 1, -65536, -1, 0, 1, 65535, INT32_MAX};

static struct {
    const char *test; /* the one that runs */
    uint64_t seed, cases, only;
    uint64_t part, parts; /* of all cases, those that are part modulo parts */
    uint64_t next;        /* case after the one that runs, 0 outside a property */
    uint64_t state;       /* of the generator */
} run = {"", EXH_SEED, EXH_CASES, NO_CASE, 0, 1, 0, 0};

/* --- what the environment asks for --- */

#ifdef EXH_CHECK_ENV
const char *EXH_CHECK_ENV(const char *name);
#endif

const char *check_env(const char *name)
{
#ifdef EXH_CHECK_ENV
    return EXH_CHECK_ENV(name);
#elif __STDC_HOSTED__
    return getenv(name);
#else
    (void)name;
    return NULL;
#endif
}

static uint64_t env_u64(const char *name, uint64_t otherwise)
{
    const char *p = check_env(name);
    uint64_t v = 0;
    if (p == NULL || *p == '\0') { return otherwise; }
    for (; *p >= '0' && *p <= '9'; p++) { v = v * 10 + (uint64_t)(*p - '0'); }
    return v;
}

static void read_env(void)
{
    run.seed = env_u64("EXH_SEED", run.seed);
    run.cases = env_u64("EXH_CASES", run.cases);
    run.only = env_u64("EXH_CASE", NO_CASE);
    run.part = env_u64("EXH_PART", run.part);
    run.parts = env_u64("EXH_PARTS", run.parts);
}

int check_same_text(const char *a, const char *b)
{
    while (*a != '\0' && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

/* --- names: "one, two, three" as the macro hands them over --- */

static char name_of[TESTS_MAX][NAME_MAX_B];

static void split_names(const char *names, size_t n)
{
    for (size_t i = 0; i < n && i < TESTS_MAX; i++) {
        size_t k = 0;
        while (*names == ' ' || *names == ',') { names++; }
        for (; *names != '\0' && *names != ','; names++) {
            if (k < NAME_MAX_B - 1) { name_of[i][k++] = *names; }
        }
        name_of[i][k] = '\0';
    }
}

static void start_test(const char *name)
{
    run.test = name;
    run.next = 0;
    run.state = run.seed;
}

static int wanted(const char *name)
{
    const char *only = check_env("EXH_TEST");
    return only == NULL || check_same_text(only, name);
}

#ifndef EXH_CHECK_PLAIN
/* --- CMocka --- */

static check_fn fn_of[TESTS_MAX];

static void trampoline(void **state)
{
    const size_t i = *(const size_t *)*state;
    start_test(name_of[i]);
    fn_of[i]();
}

int check_main(const char *group, const char *names, const check_fn *list, size_t n)
{
    static struct CMUnitTest test[TESTS_MAX];
    static size_t index_of[TESTS_MAX];
    size_t m = 0;
    int failed;
    read_env();
    if (n > TESTS_MAX || run.part >= run.parts) { return 2; }
    split_names(names, n);
    for (size_t i = 0; i < n; i++) {
        fn_of[i] = list[i];
        index_of[i] = i;
        if (!wanted(name_of[i])) { continue; }
        test[m].name = name_of[i];
        test[m].test_func = trampoline;
        test[m].initial_state = &index_of[i];
        m++;
    }
    if (m == 0) { return 2; }
    failed = _cmocka_run_group_tests(group, test, m, NULL, NULL);
    print_message("%s: %" PRIu64 " checks, seed %" PRIu64 "\n", group, check_count, run.seed);
    return failed != 0;
}

static void print_again(void)
{
    if (run.next == 0) {
        print_error("    again: EXH_TEST=%s\n", run.test);
    } else {
        print_error("    again: EXH_TEST=%s EXH_SEED=%" PRIu64 " EXH_CASE=%" PRIu64 "\n", run.test,
            run.seed, run.next - 1);
    }
}

void check_failed(const char *file, int line, const char *cond, const char *fmt, ...)
{
    char text[400];
    va_list ap;
    va_start(ap, fmt);
    (void)vsnprintf(text, sizeof text, fmt, ap);
    va_end(ap);
    print_error("%s:%d: %s\n    %s\n", file, line, cond, text);
    print_again();
    _fail(file, line);
}

void check_note(const char *fmt, ...)
{
    char text[400];
    va_list ap;
    va_start(ap, fmt);
    (void)vsnprintf(text, sizeof text, fmt, ap);
    va_end(ap);
    print_message("  | %s\n", text);
}

void exh_assert_failed(const char *file, int line)
{
    print_error("%s:%d: the library's assertion\n", file, line);
    print_again();
    _fail(file, line);
    abort(); /* the hook must not return */
}

#else
/* --- own printer --- */

#define SHOWN_MAX 3 /* failures of one test that are worth a line */

static unsigned failures;

static void put_text(const char *s)
{
    while (*s != '\0') { (void)EXH_CHECK_PUTCHAR(*s++); }
}

static void put_u64(uint64_t v, unsigned base, unsigned width, char pad)
{
    char digit[24];
    unsigned n = 0;
    do {
        digit[n++] = "0123456789abcdef"[v % base];
        v /= base;
    } while (v != 0);
    for (; width > n; width--) { (void)EXH_CHECK_PUTCHAR(pad); }
    while (n > 0) { (void)EXH_CHECK_PUTCHAR(digit[--n]); }
}

/* The conversions that <inttypes.h> can name: d i u x X s c %, width, l ll z. */
static void put_args(const char *fmt, va_list ap)
{
    for (; *fmt != '\0'; fmt++) {
        unsigned longs = 0;
        unsigned width = 0;
        char pad = ' ';
        uint64_t v;
        if (*fmt != '%') {
            (void)EXH_CHECK_PUTCHAR(*fmt);
            continue;
        }
        fmt++;
        if (*fmt == '0') { pad = '0'; }
        for (; *fmt >= '0' && *fmt <= '9'; fmt++) { width = width * 10 + (unsigned)(*fmt - '0'); }
        for (; *fmt == 'l' || *fmt == 'z'; fmt++) {
            longs = *fmt == 'z' ? (sizeof(size_t) > sizeof(long) ? 2 : 1) : longs + 1;
        }
        if (*fmt == 's') {
            put_text(va_arg(ap, const char *));
        } else if (*fmt == 'd' || *fmt == 'i') {
            const int64_t s = longs == 0 ? va_arg(ap, int)
                              : longs == 1 ? (int64_t)va_arg(ap, long)
                                           : (int64_t)va_arg(ap, long long);
            if (s < 0) { (void)EXH_CHECK_PUTCHAR('-'); }
            put_u64(s < 0 ? (uint64_t)0 - (uint64_t)s : (uint64_t)s, 10, width, pad);
        } else if (*fmt == 'u' || *fmt == 'x' || *fmt == 'X') {
            v = longs == 0 ? va_arg(ap, unsigned)
                : longs == 1 ? (uint64_t)va_arg(ap, unsigned long)
                             : (uint64_t)va_arg(ap, unsigned long long);
            put_u64(v, *fmt == 'u' ? 10 : 16, width, pad);
        } else {
            (void)EXH_CHECK_PUTCHAR(*fmt == 'c' ? va_arg(ap, int) : *fmt);
        }
    }
}

static void put_line_of(const char *fmt, va_list ap)
{
    put_args(fmt, ap);
    (void)EXH_CHECK_PUTCHAR('\n');
}

void check_line(const char *fmt, ...)
{
    va_list ap;
    va_start(ap, fmt);
    put_line_of(fmt, ap);
    va_end(ap);
}

void check_note(const char *fmt, ...)
{
    va_list ap;
    put_text("  | ");
    va_start(ap, fmt);
    put_line_of(fmt, ap);
    va_end(ap);
}

void check_failed(const char *file, int line, const char *cond, const char *fmt, ...)
{
    va_list ap;
    if (++failures > SHOWN_MAX) { return; }
    check_line("%s:%d: %s", file, line, cond);
    va_start(ap, fmt);
    put_line_of(fmt, ap);
    va_end(ap);
    if (run.next == 0) {
        check_line("    again: EXH_TEST=%s", run.test);
    } else {
        check_line("    again: EXH_TEST=%s EXH_SEED=%" PRIu64 " EXH_CASE=%" PRIu64, run.test,
            run.seed, run.next - 1);
    }
}

int check_main(const char *group, const char *names, const check_fn *list, size_t n)
{
    unsigned passed = 0;
    unsigned failed = 0;
    check_count = 0; /* of another group of this program */
    read_env();
    if (n > TESTS_MAX || run.part >= run.parts) { return 2; }
    split_names(names, n);
    for (size_t i = 0; i < n; i++) {
        if (!wanted(name_of[i])) { continue; }
        failures = 0;
        start_test(name_of[i]);
        list[i]();
        if (failures == 0) {
            passed++;
            check_line("ok     %s", name_of[i]);
        } else {
            failed++;
            check_line("FAILED %s (%u)", name_of[i], failures);
        }
    }
    check_line("%s: %" PRIu64 " checks, seed %" PRIu64, group, check_count, run.seed);
    check_line("%u passed, %u failed", passed, failed);
    return passed == 0 || failed != 0;
}

void exh_assert_failed(const char *file, int line)
{
    check_line("%s:%d: the library's assertion, in %s\n0 passed, 1 failed", file, line, run.test);
    for (;;) {
#if __STDC_HOSTED__
        abort();
#endif
    }
}
#endif

void exh_fix_saturated(const char *file, int line)
{
    (void)file;
    (void)line;
    check_saturations++;
}

/* --- generator --- */

uint64_t check_u64(void)
{
    uint64_t z = run.state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

static uint64_t next_case(void)
{
    if (run.only != NO_CASE) { return run.next == 0 ? run.only : NO_CASE; }
    return run.next == 0 ? run.part : run.next - 1 + run.parts;
}

int check_has_all(void) { return run.parts == 1; }

int check_case(uint32_t slower)
{
    const uint64_t share = run.cases / slower, n = share > 0 ? share : 1;
    const uint64_t i = next_case();
    if (i == NO_CASE || (i >= n && run.only == NO_CASE)) {
        run.next = 0;
        return 0;
    }
    run.state = run.seed ^ i * UINT64_C(0xD1342543DE82EF95);
    run.state = check_u64(); /* neighbours must not share a stream */
    run.next = i + 1;
    return 1;
}

static int64_t signed_of(uint64_t u)
{
    return u <= INT64_MAX ? (int64_t)u : -(int64_t)(UINT64_MAX - u) - 1;
}

int64_t check_i64(void)
{
    static const int64_t corner[] = {INT64_MIN, INT32_MIN, 0, INT32_MAX, INT64_MAX};
    const uint64_t how = check_u64();
    const uint64_t u = check_u64();
    if (how % 3 == 0) { return signed_of(u); }
    if (how % 3 == 1) { return signed_of(u) >> (how >> 8) % 64; }
    return signed_of((uint64_t)corner[(how >> 8) % 5] + u % 5 - 2);
}

int32_t check_i32(void)
{
    const uint64_t how = check_u64();
    const int64_t s = signed_of(how);
    if (how % 3 == 0) { return (int32_t)(s >> 32); }
    if (how % 3 == 1) { return (int32_t)(s >> (32 + (how >> 8) % 32)); }
    return check_i32_in(INT32_MIN, INT32_MAX);
}

int32_t check_i32_in(int32_t lo, int32_t hi)
{
    const uint64_t how = check_u64();
    const uint64_t span = (uint64_t)((int64_t)hi - lo);
    const uint64_t far = how >> 8 & UINT32_MAX;
    int64_t v;
    if (how % 3 == 0) {
        v = lo + (int64_t)(far % (span + 1));
    } else if (how % 3 == 1) { /* log-distributed distance from either end */
        const uint64_t d = far >> (how >> 40) % 32;
        v = how & 8 ? lo + (int64_t)d : hi - (int64_t)d;
    } else {
        v = (int64_t)check_corner[(how >> 40) % CHECK_CORNERS] + (int64_t)(far % 3) - 1;
    }
    return (int32_t)(v < lo ? lo : v > hi ? hi : v);
}
