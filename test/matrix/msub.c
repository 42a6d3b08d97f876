/* SPDX-License-Identifier: MIT */
/* An error of clang before 15 for 32-bit MIPS. For "a product less a value" it emits `msub`,
 * which subtracts the product from the value, so the sign is wrong (LLVM issue 50458, fixed in 15).
 * In the library that affects peak^2 - cont^2 of the heat in lib/src/act/drive.c, and similar
 * terms.
 *
 *     for cc in "clang-14 --target=mips-linux-gnu -isystem /usr/mips-linux-gnu/include" \
 *               "clang-19 --target=mips-linux-gnu -isystem /usr/mips-linux-gnu/include" \
 *               mips-linux-gnu-gcc; do
 *         $cc -O2 -c test/matrix/msub.c -o msub.o && mips-linux-gnu-gcc -static -o msub msub.o &&
 *         qemu-mips ./msub
 *     done
 *
 * prints -58, 58, 58. The status is 1 where it is wrong. Not part of a build. */
#include <stdint.h>
#include <stdio.h>

__attribute__((noinline)) static int64_t less(int32_t a, int64_t b) { return (int64_t)a * a - b; }

int main(int argc, char **argv)
{
    (void)argv;
    const int64_t got = less(7 + argc, 5 + argc); /* 8^2 - 6 */
    printf("%ld\n", (long)got);
    return got != 58;
}
