/* SPDX-License-Identifier: MIT */
/* What CMSIS-DSP asks of CMSIS-Core, which no package here has: the compiler's words, and on a CPU
 * with the DSP extension (Cortex-M4) its instructions by the compiler's own intrinsics. */
#ifndef BENCH_CMSIS_COMPILER_H
#define BENCH_CMSIS_COMPILER_H

#include <arm_acle.h>
#include <stdint.h>
#include <string.h>

/* CMSIS-DSP reads pairs of 16 bits by it; -ffreestanding would make each a call. */
#define memcpy __builtin_memcpy

#define __ALIGNED(x)         __attribute__((aligned(x)))
#define __STATIC_FORCEINLINE static inline __attribute__((always_inline))
#define __STATIC_INLINE      static inline
#define __WEAK               __attribute__((weak))
#define __ASM                __asm__
#define __CLZ(x)             ((uint8_t)((x) ? __builtin_clz(x) : 32))
#define __ROR(x, n)          __ror((x), (n))

#ifdef __ARM_FEATURE_SAT
#define __SSAT(x, bits) __ssat((x), (bits))
#define __USAT(x, bits) __usat((x), (bits))
#else /* a Cortex-M0 has no such instructions */
static inline int32_t __SSAT(int32_t x, uint32_t bits)
{
    const int32_t most = (int32_t)((UINT32_C(1) << (bits - 1)) - 1);
    return x > most ? most : x < -most - 1 ? -most - 1 : x;
}
static inline uint32_t __USAT(int32_t x, uint32_t bits)
{
    const int32_t most = (int32_t)((UINT32_C(1) << bits) - 1);
    return (uint32_t)(x > most ? most : x < 0 ? 0 : x);
}
#endif

#ifdef __ARM_FEATURE_DSP
#define __PKHBT(a, b, n) \
    ((uint32_t)(((uint32_t)(a)&0xFFFFu) | (((uint32_t)(b) << (n)) & 0xFFFF0000u)))
#define __QADD(a, b)      __qadd((a), (b))
#define __QSUB(a, b)      __qsub((a), (b))
#define __QADD16(a, b)    ((uint32_t)__qadd16((int16x2_t)(a), (int16x2_t)(b)))
#define __QSUB16(a, b)    ((uint32_t)__qsub16((int16x2_t)(a), (int16x2_t)(b)))
#define __SMUAD(a, b)     ((uint32_t)__smuad((int16x2_t)(a), (int16x2_t)(b)))
#define __SMUADX(a, b)    ((uint32_t)__smuadx((int16x2_t)(a), (int16x2_t)(b)))
#define __SMLALD(a, b, s) ((uint64_t)__smlald((int16x2_t)(a), (int16x2_t)(b), (int64_t)(s)))
#endif

#endif
