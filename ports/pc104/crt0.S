/* SPDX-License-Identifier: MIT */
/* Start: multiboot 1 header, flat segments, stack, zeroed .bss, main().
 *
 * The loader leaves 32-bit protected mode without paging, interrupts off; neither
 * its GDT nor its stack may be relied on, so both are ours before the first call.
 */
    .set MB_MAGIC, 0x1BADB002
    .set MB_FLAGS, 0                /* no modules, no video: nothing asked of the loader */

    .section .multiboot, "a"
    .balign 4
    .long MB_MAGIC
    .long MB_FLAGS
    .long -(MB_MAGIC + MB_FLAGS)

    .section .text.start, "ax"
    .globl _start
    .type _start, @function
_start:
    cli
    cld
    lgdt gdt_pointer
    ljmp $0x08, $1f
1:  movl $0x10, %ecx
    movl %ecx, %ds
    movl %ecx, %es
    movl %ecx, %fs
    movl %ecx, %gs
    movl %ecx, %ss
    movl $__stack_top, %esp         /* ldscripts/pc104.ld, as the guard below it */
    movl %eax, %edx                 /* rep stosl needs EAX */
    movl $__bss_start, %edi
    movl $__bss_end, %ecx
    subl %edi, %ecx
    shrl $2, %ecx
    xorl %eax, %eax
    rep stosl
    movl %edx, pc104_boot_magic
    movl %ebx, pc104_boot_info
    call pc104_i686                 /* before any C; does not return on another processor */
    call pc104_uart_open            /* from here on an exception can say its name */
    call pc104_trap_open
    call pc104_cmdline_open         /* may lie anywhere, so before the guard */
    call pc104_guard_open
    call pc104_mce_open             /* says what the run before ended with */
    call main
2:  cli                             /* main() does not return; if it does, stop */
    hlt
    jmp 2b
    .size _start, . - _start

    .section .data.gdt, "aw"
    .balign 8
    .globl pc104_gdt
pc104_gdt:
    .quad 0
    .quad 0x00CF9A000000FFFF        /* 0x08: code, base 0, 4 GiB */
    .quad 0x00CF92000000FFFF        /* 0x10: data, base 0, 4 GiB */
    .quad 0                         /* 0x18, 0x20: tasks, guard.c */
    .quad 0
gdt_pointer:
    .word gdt_pointer - pc104_gdt - 1
    .long pc104_gdt

    .section .bss.start, "aw", @nobits
    .balign 4
    .globl pc104_boot_magic, pc104_boot_info
pc104_boot_magic:
    .skip 4
pc104_boot_info:
    .skip 4

    .section .note.GNU-stack, "", @progbits
