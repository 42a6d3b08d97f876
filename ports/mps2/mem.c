/* SPDX-License-Identifier: MIT */
/* The four string functions that library and compiler call. The Makefile's flags would let the
 * compiler see memcpy in a loop of memcpy and call itself: not in this file. */
#include <stddef.h>

#pragma GCC optimize("no-tree-loop-distribute-patterns")

void *memcpy(void *restrict dst, const void *restrict src, size_t len_B);
void *memmove(void *dst, const void *src, size_t len_B);
void *memset(void *dst, int value, size_t len_B);
int memcmp(const void *a, const void *b, size_t len_B);

void *memcpy(void *restrict dst, const void *restrict src, size_t len_B)
{
    unsigned char *d = dst;
    const unsigned char *s = src;
    while (len_B--) { *d++ = *s++; }
    return dst;
}

void *memmove(void *dst, const void *src, size_t len_B)
{
    unsigned char *d = dst;
    const unsigned char *s = src;
    if ((size_t)d - (size_t)s >= len_B) { return memcpy(dst, src, len_B); }
    while (len_B--) { d[len_B] = s[len_B]; } /* dst lies inside what is copied: from the end */
    return dst;
}

void *memset(void *dst, int value, size_t len_B)
{
    unsigned char *d = dst;
    while (len_B--) { *d++ = (unsigned char)value; }
    return dst;
}

int memcmp(const void *a, const void *b, size_t len_B)
{
    const unsigned char *p = a, *q = b;
    for (; len_B; len_B--, p++, q++) {
        if (*p != *q) { return *p - *q; }
    }
    return 0;
}
