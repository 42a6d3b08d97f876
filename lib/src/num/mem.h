/* SPDX-License-Identifier: MIT */
/* memcpy() and memset() without <string.h>, which a freestanding compiler does not have. */
#ifndef NUM_MEM_H
#define NUM_MEM_H

#include <stddef.h>

void *memcpy(void *to, const void *from, size_t n);
void *memset(void *to, int value, size_t n);

#endif
