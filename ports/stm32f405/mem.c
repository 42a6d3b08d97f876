/* SPDX-License-Identifier: MIT */
/* The four string functions, by words: a log's largest record, 5120 bytes, is to be copied within a
 * tick of 50 us. This processor reads and writes words at any address. */
#include <stddef.h>
#include <stdint.h>

#pragma GCC optimize("no-tree-loop-distribute-patterns")

typedef uint32_t __attribute__((may_alias, aligned(1))) word;

void *memcpy(void *restrict dst, const void *restrict src, size_t len_B);
void *memmove(void *dst, const void *src, size_t len_B);
void *memset(void *dst, int value, size_t len_B);
int memcmp(const void *a, const void *b, size_t len_B);

/* Four words an instruction, from aligned addresses: 15 cycles instead of 23. */
static size_t copy_words(unsigned char *d, const unsigned char *s, size_t len_B)
{
    const size_t left = len_B & 15u;
    for (unsigned char *const end = d + (len_B - left); d < end;) {
        __asm__ volatile("ldmia %1!, {r3, r4, r5, r12}\n"
                         "stmia %0!, {r3, r4, r5, r12}"
                         : "+r"(d), "+r"(s)
                         :
                         : "r3", "r4", "r5", "r12", "memory");
    }
    return len_B - left;
}

void *memcpy(void *restrict dst, const void *restrict src, size_t len_B)
{
    unsigned char *d = dst;
    const unsigned char *s = src;
    if (len_B >= 16 && (((uintptr_t)d | (uintptr_t)s) & 3u) == 0) {
        const size_t n = copy_words(d, s, len_B);
        d += n;
        s += n;
        len_B -= n;
    }
    for (; len_B >= 16; len_B -= 16, d += 16, s += 16) {
        word *const to = (word *)d;
        const word *const from = (const word *)s;
        to[0] = from[0];
        to[1] = from[1];
        to[2] = from[2];
        to[3] = from[3];
    }
    while (len_B--) { *d++ = *s++; }
    return dst;
}

void *memmove(void *dst, const void *src, size_t len_B)
{
    unsigned char *const d = dst;
    const unsigned char *const s = src;
    if ((size_t)d - (size_t)s >= len_B) { return memcpy(dst, src, len_B); }
    while (len_B--) { d[len_B] = s[len_B]; } /* dst lies inside what is copied: from the end */
    return dst;
}

void *memset(void *dst, int value, size_t len_B)
{
    unsigned char *d = dst;
    const uint32_t four = (unsigned char)value * 0x01010101u;
    for (; len_B >= 4; len_B -= 4, d += 4) { *(word *)d = four; }
    while (len_B--) { *d++ = (unsigned char)value; }
    return dst;
}

int memcmp(const void *a, const void *b, size_t len_B)
{
    const unsigned char *p = a, *q = b;
    for (; len_B && *p == *q; len_B--, p++, q++) {}
    return len_B ? *p - *q : 0;
}
