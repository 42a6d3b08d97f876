/* SPDX-License-Identifier: MIT */
/* Start: vectors, .data, .bss, main(). Every exception leads to mps2_fault(). */
#include "mps2.h"

#define PAINT 0xA5A5A5A5u /* stack that was never used */

/* Memory protection unit, of most Cortex-M: region, its size and rights, and on. */
#define MPU_CONTROL MPS2_REG(0xE000ED94)
#define MPU_BASE    MPS2_REG(0xE000ED9C)
#define MPU_RIGHTS  MPS2_REG(0xE000EDA0)
#define REGION(n)   (0x10u | (n))
#define SIZE(log2)  (((log2)-1u) << 1 | 1u)
#define NO_ACCESS   (1u << 28)
#define READ_ONLY   (6u << 24 | 1u << 17)
#define ON          5u /* what no region names has the rights it has without */

/* ldscripts/mps2.ld */
extern uint32_t __stack_guard[], __stack_bottom[], __stack_paint_end[], __stack_top[],
    __data_start[], __data_end[], __bss_start[], __bss_end[];
extern const uint32_t __data_load[];

int main(void);
void mps2_reset(void);

uint32_t mps2_stack_B(void)
{
    const uint32_t *p = __stack_bottom;
    while (p < __stack_top && *p == PAINT) { p++; }
    return (uint32_t)((const char *)__stack_top - (const char *)p);
}

/* Code and constants are only read, the 256 bytes below the stack never touched. */
static void protect(void)
{
    MPU_BASE = REGION(0);
    MPU_RIGHTS = READ_ONLY | SIZE(22u);
    MPU_BASE = (uint32_t)__stack_guard | REGION(1);
    MPU_RIGHTS = NO_ACCESS | SIZE(8u);
    MPU_CONTROL = ON;
    __asm__ volatile("dsb\n isb" : : : "memory");
}

void mps2_reset(void)
{
    const uint32_t *from = __data_load;
    for (uint32_t *p = __stack_bottom; p < __stack_paint_end; p++) { *p = PAINT; }
    for (uint32_t *p = __data_start; p < __data_end; p++) { *p = *from++; }
    for (uint32_t *p = __bss_start; p < __bss_end; p++) { *p = 0; }
    protect();
    mps2_say_open();
    (void)main();
    for (;;) {} /* main() does not return */
}

/* A stack that ran over is no place to say so: the handler starts at its top again. The exception's
 * number is the handler's argument. */
__attribute__((naked)) static void fault(void)
{
    __asm__ volatile("cpsid i\n"
                     "ldr r1, =__stack_top\n"
                     "mov sp, r1\n"
                     "mrs r0, ipsr\n"
                     "b mps2_fault\n");
}

/* No interrupt but SysTick is ever enabled, so the table ends with it. */
struct vectors {
    uint32_t *stack;
    void (*handler[15])(void);
};
extern const struct vectors mps2_vectors;
__attribute__((section(".vectors"), used)) const struct vectors mps2_vectors = {
    __stack_top, {mps2_reset, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault,
                     fault, fault, fault, mps2_systick}};
