/* SPDX-License-Identifier: MIT */
/* CRC-32 for the host: from 64 bytes on by products without carries, where the processor has them,
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
#include <tmmintrin.h>
#include <wmmintrin.h>

#define BLOCK_B  16
#define WIDE_B   (4 * BLOCK_B) /* four sums side by side, since a product takes several cycles */
#define AT(p, i) _mm_loadu_si128((const void *)((p) + (i)*BLOCK_B))
#define PRODUCT  _mm_clmulepi64_si128
#define PRODUCTS __attribute__((target("pclmul,ssse3"))) static

PRODUCTS inline __m128i moved(__m128i sum, __m128i by, __m128i next)
{
    return _mm_xor_si128(_mm_xor_si128(PRODUCT(sum, by, 0x00), PRODUCT(sum, by, 0x11)), next);
}

/* The sum and the last n bytes, 1 to 15, are n bytes and then a block. A shuffle leaves 0 where an
 * index is negative. */
PRODUCTS inline __m128i with_rest(__m128i sum, __m128i by, const uint8_t *end, int n)
{
    const __m128i up = _mm_set_epi64x(INT64_C(0x0F0E0D0C0B0A0908), INT64_C(0x0706050403020100));
    const __m128i last = _mm_add_epi8(up, _mm_set1_epi8((char)(n - BLOCK_B)));
    const __m128i first = _mm_add_epi8(up, _mm_set1_epi8((char)(n - BLOCK_B - 128)));
    const __m128i rest = _mm_and_si128(AT(end, -1), _mm_cmplt_epi8(first, _mm_setzero_si128()));
    return moved(_mm_shuffle_epi8(sum, last), by, _mm_or_si128(_mm_shuffle_epi8(sum, first), rest));
}

PRODUCTS uint32_t by_products(uint32_t crc, const uint8_t *p, size_t len_B)
{
    const __m128i four = _mm_set_epi64x(INT64_C(0x1C6E41596), INT64_C(0x154442BD4));
    const __m128i one = _mm_set_epi64x(INT64_C(0x0CCAA009E), INT64_C(0x1751997D0));
    const __m128i half = _mm_cvtsi64_si128(INT64_C(0x163CD6124)), low = _mm_set_epi32(0, -1, 0, -1);
    const __m128i barrett = _mm_set_epi64x(INT64_C(0x1F7011641), INT64_C(0x1DB710641));
    const __m128i first = _mm_xor_si128(_mm_cvtsi64_si128(~crc), AT(p, 0));
    __m128i s[] = {first, AT(p, 1), AT(p, 2), AT(p, 3)}, q;
    for (p += WIDE_B, len_B -= WIDE_B; len_B >= WIDE_B; p += WIDE_B, len_B -= WIDE_B) {
        for (int i = 0; i < 4; i++) { s[i] = moved(s[i], four, AT(p, i)); }
    }
    for (int i = 1; i < 4; i++) { s[0] = moved(s[0], one, s[i]); }
    for (; len_B >= BLOCK_B; p += BLOCK_B, len_B -= BLOCK_B) { s[0] = moved(s[0], one, AT(p, 0)); }
    if (len_B > 0) { s[0] = with_rest(s[0], one, p + len_B, (int)len_B); }
    q = _mm_xor_si128(_mm_srli_si128(s[0], 8), PRODUCT(s[0], one, 0x10)); /* by Barrett */
    s[0] = _mm_xor_si128(_mm_srli_si128(q, 4), PRODUCT(_mm_and_si128(q, low), half, 0x00));
    q = PRODUCT(_mm_and_si128(s[0], low), barrett, 0x10);
    q = _mm_xor_si128(s[0], PRODUCT(_mm_and_si128(q, low), barrett, 0x00));
    return ~(uint32_t)_mm_cvtsi128_si32(_mm_srli_si128(q, 4));
}
#endif

uint32_t exh_crc32(uint32_t crc, const void *buf, size_t len_B)
{
#ifdef PRODUCTS
    if (len_B >= WIDE_B && __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("ssse3")) {
        return by_products(crc, buf, len_B);
    }
#endif
    return crc32_by_table(crc, buf, len_B);
}
