/* SPDX-License-Identifier: MIT */
/* The FPU, for a scene that uses floats (SCENE_FLOAT in its scene.mk). It is set up once and never
 * saved. No interrupt uses it, since all code but that scene's controller is compiled for general
 * registers only. */
#include "pc104.h"

#define CR0_MP         (1u << 1) /* WAIT heeds TS, which stays clear */
#define CR0_EM         (1u << 2) /* no FPU: every instruction of it would be an exception */
#define CR0_TS         (1u << 3)
#define CR0_NE         (1u << 5) /* its errors are exceptions, not line 13 of the 8259 */
#define CR4_OSFXSR     (1u << 9)
#define CR4_OSXMMEXCPT (1u << 10)
#define EDX_FPU        (1u << 0)
#define EDX_SSE2       (1u << 26)
#define MXCSR \
    0x1F80u /* to nearest, all exceptions masked: a wrong answer is the gate's business \
             */

void pc104_fpu_open(void)
{
    const uint32_t mxcsr = MXCSR;
    uint32_t eax = 1, ebx, ecx, edx, cr;
    __asm__ volatile("cpuid" : "+a"(eax), "=b"(ebx), "=c"(ecx), "=d"(edx));
    if ((edx & EDX_FPU) == 0 || (edx & EDX_SSE2) == 0) {
        pc104_halt(
            PC104_EXIT_OPTION, "this scene reckons in floats, and this processor has no SSE2");
    }
    __asm__ volatile("movl %%cr0, %0" : "=r"(cr));
    cr = (cr & ~(CR0_EM | CR0_TS)) | CR0_MP | CR0_NE;
    __asm__ volatile("movl %0, %%cr0" : : "r"(cr));
    __asm__ volatile("movl %%cr4, %0" : "=r"(cr));
    cr |= CR4_OSFXSR | CR4_OSXMMEXCPT;
    __asm__ volatile("movl %0, %%cr4" : : "r"(cr));
    __asm__ volatile("fninit\n\tldmxcsr %0" : : "m"(mxcsr));
}
