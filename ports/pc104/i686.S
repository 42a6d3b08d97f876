/* SPDX-License-Identifier: MIT */
/* Is the processor an i686? Asked before any C, which is compiled for one: a 486 or a Pentium would
 * say "invalid opcode" somewhere. From the no on there is not one instruction that a 386 has not.
 */
    .set NEEDED, 1 << 15 | 1 << 4 | 1 << 3  /* CMOV, time stamp counter, 4 MiB pages */
    .set FLAG_ID, 1 << 21
    .set COM1, 0x3F8
    .set STATUS_READS, 100000       /* a line that takes nothing is no reason to hang */
    .set EXIT_OPTION, 0x13          /* PC104_EXIT_OPTION, for emulators */

    .section .text.pc104_i686, "ax"
    .globl pc104_i686
    .type pc104_i686, @function
pc104_i686:
    pushfl                          /* CPUID is there where this flag can be changed */
    popl %eax
    movl %eax, %ecx
    xorl $FLAG_ID, %eax
    pushl %eax
    popfl
    pushfl
    popl %eax
    xorl %ecx, %eax
    testl $FLAG_ID, %eax
    jz 1f
    movl $1, %eax
    cpuid
    andl $NEEDED, %edx
    cmpl $NEEDED, %edx
    jne 1f
    ret

1:  movl $settings, %esi
    movl $(settings_end - settings) / 2, %ecx
2:  lodsw                           /* register and value */
    movl $COM1, %edx
    addb %al, %dl
    movb %ah, %al
    outb %al, %dx
    loop 2b
    movl $text, %esi
3:  lodsb
    testb %al, %al
    jz 5f
    movb %al, %ah
    movl $COM1 + 5, %edx
    movl $STATUS_READS, %ecx
4:  inb %dx, %al
    testb $0x20, %al
    loopz 4b
    movl $COM1, %edx
    movb %ah, %al
    outb %al, %dx
    jmp 3b
5:  movb $EXIT_OPTION, %al
    outb %al, $0xF4
6:  cli
    hlt
    jmp 6b
    .size pc104_i686, . - pc104_i686

    .section .rodata.pc104_i686, "a"
settings:                           /* 115200 8N1, no interrupts, FIFO on (uart.c) */
    .byte 1, 0, 3, 0x80, 0, 1, 1, 0, 3, 3, 2, 0xC7
settings_end:
text:
    .asciz "this image needs an i686 processor (CMOV, TSC, PSE): nothing was started\r\n"

    .section .note.GNU-stack, "", @progbits
