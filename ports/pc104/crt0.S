/* Start: multiboot 1 header, flat segments, stack, zeroed .bss, main().
 *
 * The loader leaves 32-bit protected mode without paging, interrupts off; neither
 * its GDT nor its stack may be relied on, so both are ours before the first call.
 */
    .set MB_MAGIC, 0x1BADB002
    .set MB_FLAGS, 0                /* no modules, no video: nothing asked of the loader */
    .set STACK_B, 16384

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
    movl $stack_top, %esp
    movl %eax, %edx                 /* rep stosl needs EAX */
    movl $__bss_start, %edi
    movl $__bss_end, %ecx
    subl %edi, %ecx
    shrl $2, %ecx
    xorl %eax, %eax
    rep stosl
    movl %edx, pc104_boot_magic
    movl %ebx, pc104_boot_info
    call pc104_uart_open            /* from here on an exception can say its name */
    call pc104_trap_open
    call main
2:  cli                             /* main() does not return; if it does, stop */
    hlt
    jmp 2b
    .size _start, . - _start

    .section .rodata.gdt, "a"
    .balign 8
gdt:
    .quad 0
    .quad 0x00CF9A000000FFFF        /* 0x08: code, base 0, 4 GiB */
    .quad 0x00CF92000000FFFF        /* 0x10: data, base 0, 4 GiB */
gdt_pointer:
    .word gdt_pointer - gdt - 1
    .long gdt

    .section .bss.start, "aw", @nobits
    .balign 16
    .skip STACK_B
stack_top:
    .globl pc104_boot_magic, pc104_boot_info
pc104_boot_magic:
    .skip 4
pc104_boot_info:
    .skip 4

    .section .note.GNU-stack, "", @progbits
