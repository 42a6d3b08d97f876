/* SPDX-License-Identifier: MIT */
/* Memory: identity mapping without page 0 and the page below the stack; code and constants are
 * read-only. A stack overflow reaches the guard page, where the processor cannot push the fault.
 * That causes a double fault, which has its own task and stack. */
#include "pc104.h"

#include "exhand/error.h"

#define PAGE_B        4096u
#define PRESENT       1u
#define WRITABLE      2u
#define UNCACHED      0x18u /* and written through */
#define LARGE         0x80u /* 4 MiB */
#define LARGE_B       0x400000u
#define DEVICES       0xC0000000u /* from here on no PC/104 machine has its memory */
#define STACK_B       2048u
#define SEGMENT_CODE  0x08u
#define SEGMENT_DATA  0x10u
#define SEGMENT_MAIN  0x18u
#define SEGMENT_FAULT 0x20u
#define TSS_PRESENT   0x89u /* 32-bit, not busy */

struct tss {
    uint32_t link, esp0, ss0, esp1, ss1, esp2, ss2, cr3, eip, eflags, eax, ecx, edx, ebx, esp, ebp,
        esi, edi;
    uint32_t es, cs, ss, ds, fs, gs, ldt, trap_iomap;
};

extern uint64_t pc104_gdt[5];                /* crt0.S */
extern const char pc104_double_fault_task[]; /* vectors.S */
extern char __text_start[], __data_start[], __stack_guard[];

static uint32_t directory[1024] __attribute__((aligned(4096)));
static uint32_t first[1024] __attribute__((aligned(4096))); /* the first 4 MiB */
static struct tss main_task, fault_task;
static uint8_t fault_stack[STACK_B] __attribute__((aligned(16)));

static uint32_t flags_of(uint32_t address)
{
    if (address < PAGE_B || address == (uint32_t)__stack_guard) { return 0; }
    if (address >= (uint32_t)__text_start && address < (uint32_t)__data_start) { return PRESENT; }
    return PRESENT | WRITABLE;
}

static void open_paging(void)
{
    uint32_t cr;
    for (uint32_t i = 0; i < 1024; i++) {
        const uint32_t at = i * LARGE_B;
        first[i] = i * PAGE_B | flags_of(i * PAGE_B);
        directory[i] = at | PRESENT | WRITABLE | LARGE | (at >= DEVICES ? UNCACHED : 0);
    }
    directory[0] = (uint32_t)first | PRESENT | WRITABLE;
    __asm__ volatile("movl %%cr4, %0" : "=r"(cr));
    __asm__ volatile("movl %0, %%cr4" : : "r"(cr | 0x10u)); /* large pages */
    __asm__ volatile("movl %0, %%cr3" : : "r"(directory) : "memory");
    __asm__ volatile("movl %%cr0, %0" : "=r"(cr));
    __asm__ volatile("movl %0, %%cr0; jmp 1f; 1:"
                     :
                     : "r"(cr | 0x80010000u)
                     : "memory"); /* read-only holds */
}

static uint64_t descriptor(const struct tss *t)
{
    const uint32_t at = (uint32_t)t;
    return (uint64_t)(at & 0xFF000000u) << 32 | (uint64_t)TSS_PRESENT << 40 |
           (uint64_t)(at & 0xFFFFFFu) << 16 | (sizeof *t - 1);
}

static void open_tasks(void)
{
    fault_task.cr3 = (uint32_t)directory;
    fault_task.eip = (uint32_t)pc104_double_fault_task;
    fault_task.eflags = 2;
    fault_task.esp = (uint32_t)(fault_stack + STACK_B - 16);
    fault_task.cs = SEGMENT_CODE;
    fault_task.es = fault_task.ss = fault_task.ds = fault_task.fs = fault_task.gs = SEGMENT_DATA;
    main_task.trap_iomap = fault_task.trap_iomap = (uint32_t)sizeof(struct tss) << 16;
    main_task.cr3 = (uint32_t)directory;
    pc104_gdt[SEGMENT_MAIN / 8] = descriptor(&main_task);
    pc104_gdt[SEGMENT_FAULT / 8] = descriptor(&fault_task);
    __asm__ volatile("ltr %w0" : : "r"(SEGMENT_MAIN) : "memory");
}

void pc104_guard_open(void)
{
    open_paging();
    open_tasks();
}

/* On a machine with little memory, firmware may map a card below DEVICES. Its page becomes
 * uncached. Cached lines are written back now, because they would overwrite later, uncached writes.
 */
int pc104_guard_device(uint32_t address)
{
    const uint32_t i = address / LARGE_B;
    if (i == 0) { return -EXH_E_RANGE; }
    directory[i] |= UNCACHED;
    __asm__ volatile("movl %0, %%cr3; wbinvd" : : "r"(directory) : "memory");
    return 0;
}

int pc104_guard_hit(uint32_t address) { return address - (uint32_t)__stack_guard < PAGE_B; }

uint32_t pc104_guard_eip(void) { return main_task.eip; }
