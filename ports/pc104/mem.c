/* SPDX-License-Identifier: MIT */
/* The four string functions that the library and the compiler may call. The string
 * instructions keep the compiler from turning a loop back into a call of itself. */
#include <stddef.h>
#include <stdint.h>

void *memcpy(void *restrict dst, const void *restrict src, size_t len_B);
void *memmove(void *dst, const void *src, size_t len_B);
void *memset(void *dst, int value, size_t len_B);
int memcmp(const void *a, const void *b, size_t len_B);

void *memcpy(void *restrict dst, const void *restrict src, size_t len_B)
{
    void *d = dst;
    size_t words = len_B / 4, rest_B = len_B % 4;
    __asm__ volatile("rep movsl" : "+D"(d), "+S"(src), "+c"(words) : : "memory");
    __asm__ volatile("rep movsb" : "+D"(d), "+S"(src), "+c"(rest_B) : : "memory");
    return dst;
}

void *memmove(void *dst, const void *src, size_t len_B)
{
    if ((size_t)dst - (size_t)src >= len_B) { return memcpy(dst, src, len_B); }
    /* dst lies inside what is copied: from the end */
    char *d = (char *)dst + len_B - 1;
    const char *s = (const char *)src + len_B - 1;
    __asm__ volatile("std; rep movsb; cld" : "+D"(d), "+S"(s), "+c"(len_B) : : "memory");
    return dst;
}

void *memset(void *dst, int value, size_t len_B)
{
    const uint32_t word = (uint32_t)(unsigned char)value * 0x01010101u;
    void *d = dst;
    size_t words = len_B / 4, rest_B = len_B % 4;
    __asm__ volatile("rep stosl" : "+D"(d), "+c"(words) : "a"(word) : "memory");
    __asm__ volatile("rep stosb" : "+D"(d), "+c"(rest_B) : "a"(word) : "memory");
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
