/* SPDX-License-Identifier: MIT */
/* CRC-32 for the host: 16 bytes a step by products without carries, where the processor has them,
 * else by the library's table.
 *
 * A block of 16 bytes moves on by n bits if its halves are multiplied by x^(n+63) and x^(n-1)
 * modulo the polynomial, bits reflected (V. Gopal et al., Fast CRC Computation for Generic
 * Polynomials Using PCLMULQDQ Instruction, Intel 2009). */
#include "exhand/bytes.h"

#define exh_crc32 crc32_by_table
uint32_t crc32_by_table(uint32_t crc, const void *buf, size_t len_B);
#include "../../lib/src/run/crc_table.c"
#undef exh_crc32

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__TINYC__)
#include <wmmintrin.h>

#define BLOCK_B     16
#define WIDE_B      (4 * BLOCK_B) /* four sums side by side, since a product takes several cycles */
#define BLOCK(p, i) _mm_loadu_si128((const void *)((p) + (i)*BLOCK_B))

__attribute__((target("pclmul"))) static inline __m128i moved(__m128i sum, __m128i by, __m128i next)
{
    const __m128i low = _mm_clmulepi64_si128(sum, by, 0x00);
    const __m128i high = _mm_clmulepi64_si128(sum, by, 0x11);
    return _mm_xor_si128(_mm_xor_si128(low, high), next);
}

/* Of 16 bytes, modulo the polynomial, by Barrett. */
__attribute__((target("pclmul"))) static inline uint32_t rest(__m128i sum, __m128i block)
{
    const __m128i low = _mm_set_epi32(0, -1, 0, -1), half = _mm_cvtsi64_si128(INT64_C(0x163CD6124));
    const __m128i barrett = _mm_set_epi64x(INT64_C(0x1F7011641), INT64_C(0x1DB710641));
    __m128i q = _mm_clmulepi64_si128(sum, block, 0x10);
    sum = _mm_xor_si128(_mm_srli_si128(sum, 8), q);
    q = _mm_clmulepi64_si128(_mm_and_si128(sum, low), half, 0x00);
    sum = _mm_xor_si128(_mm_srli_si128(sum, 4), q);
    q = _mm_clmulepi64_si128(_mm_and_si128(sum, low), barrett, 0x10);
    q = _mm_clmulepi64_si128(_mm_and_si128(q, low), barrett, 0x00);
    return (uint32_t)_mm_cvtsi128_si32(_mm_srli_si128(_mm_xor_si128(sum, q), 4));
}

__attribute__((target("pclmul"))) static uint32_t by_products(
    uint32_t crc, const uint8_t *p, size_t len_B)
{
    const __m128i block = _mm_set_epi64x(INT64_C(0x0CCAA009E), INT64_C(0x1751997D0));
    const __m128i wide = _mm_set_epi64x(INT64_C(0x1C6E41596), INT64_C(0x154442BD4));
    __m128i sum[4] = {_mm_cvtsi64_si128(~crc)};
    sum[0] = _mm_xor_si128(sum[0], BLOCK(p, 0));
    for (int i = 1; i < 4; i++) { sum[i] = BLOCK(p, i); }
    for (p += WIDE_B, len_B -= WIDE_B; len_B >= WIDE_B; p += WIDE_B, len_B -= WIDE_B) {
        for (int i = 0; i < 4; i++) { sum[i] = moved(sum[i], wide, BLOCK(p, i)); }
    }
    for (int i = 1; i < 4; i++) { sum[0] = moved(sum[0], block, sum[i]); }
    for (; len_B >= BLOCK_B; p += BLOCK_B, len_B -= BLOCK_B) {
        sum[0] = moved(sum[0], block, BLOCK(p, 0));
    }
    return crc32_by_table(~rest(sum[0], block), p, len_B);
}

uint32_t exh_crc32(uint32_t crc, const void *buf, size_t len_B)
{
    if (len_B < WIDE_B || !__builtin_cpu_supports("pclmul")) {
        return crc32_by_table(crc, buf, len_B);
    }
    return by_products(crc, buf, len_B);
}
#else
uint32_t exh_crc32(uint32_t crc, const void *buf, size_t len_B)
{
    return crc32_by_table(crc, buf, len_B);
}
#endif
