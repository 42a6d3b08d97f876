/* SPDX-License-Identifier: MIT */
/* Start: vectors, .data, .bss, clock, pins, lines, main(). Any exception leads to stm_fault(). */
#include "stm.h"

#define PAINT      0xA5A5A5A5u /* stack that was never used */
#define REGION(n)  (0x10u | (n))
#define SIZE(log2) (((log2)-1u) << 1 | 1u)
#define NO_ACCESS  (1u << 28)
#define READ_ONLY  (6u << 24 | 1u << 17)
#define ON         5u /* outside all regions the default rights hold */

/* ldscripts/stm32f405.ld */
extern uint32_t __stack_guard[], __stack_bottom[], __stack_paint_end[], __stack_top[],
    __data_start[], __data_end[], __bss_start[], __bss_end[];
extern const uint32_t __data_load[];

int main(void);
void stm_reset(void);

uint32_t stm_stack_B(void)
{
    const uint32_t *p = __stack_bottom;
    while (p < __stack_top && *p == PAINT) { p++; }
    return (uint32_t)((const char *)__stack_top - (const char *)p);
}

void stm_mpu(int on)
{
    REG(BASE_SCS, MPU_CTRL) = on ? ON : 0;
    __asm__ volatile("dsb\n isb" : : : "memory");
}

/* Code and constants are only read, the 256 bytes below the stack never touched. */
static void protect(void)
{
    REG(BASE_SCS, MPU_RBAR) = 0x08000000u | REGION(0);
    REG(BASE_SCS, MPU_RASR) = READ_ONLY | SIZE(20u);
    REG(BASE_SCS, MPU_RBAR) = (uint32_t)__stack_guard | REGION(1);
    REG(BASE_SCS, MPU_RASR) = NO_ACCESS | SIZE(8u);
    stm_mpu(1);
}

/* Pins first: from here on this port also holds the drives' lines low. The tick has priority over
 * the A/D's interrupt, which waits only for the tick. */
void stm_reset(void)
{
    const uint32_t *from = __data_load;
    stm_pins_open();
    for (uint32_t *p = __stack_bottom; p < __stack_paint_end; p++) { *p = PAINT; }
    for (uint32_t *p = __data_start; p < __data_end; p++) { *p = *from++; }
    for (uint32_t *p = __bss_start; p < __bss_end; p++) { *p = 0; }
    protect();
    REG(BASE_SCS, NVIC_IPR(IRQ_DMA2_STREAM0)) = 0x10u << 8 * (IRQ_DMA2_STREAM0 & 3u);
    stm_clock_open();
    stm_uart_open();
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
                     "b stm_fault\n");
}

/* Of the interrupts only one is ever enabled, so the table ends with it. */
#define FEW(handler) handler, handler, handler, handler, handler, handler, handler, handler
#define UNTIL_DMA2 \
    FEW(fault), FEW(fault), FEW(fault), FEW(fault), FEW(fault), FEW(fault), FEW(fault)
struct vectors {
    uint32_t *stack;
    void (*handler[15 + IRQ_DMA2_STREAM0 + 1])(void);
};
extern const struct vectors stm_vectors;
__attribute__((section(".vectors"), used)) const struct vectors stm_vectors = {
    __stack_top, {stm_reset, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault,
                     fault, fault, fault, stm_systick, UNTIL_DMA2, stm_adc_half}};
