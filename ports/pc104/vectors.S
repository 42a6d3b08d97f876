/* SPDX-License-Identifier: MIT */
/* Entries of the interrupt table. They touch no C until something is wrong. */

    .set APIC_END, 0xFEE000B0

/* One 16-byte stub per vector: makes the stack the same with and without the
 * error code that some exceptions push, adds the vector, and calls C. */
    .section .text.pc104_vectors, "ax"
    .globl pc104_vectors
    .set vector, 0
    .balign 16
pc104_vectors:
    .rept 64
    .balign 16
    .if vector != 8 && vector != 17 && (vector < 10 || vector > 14)
    pushl $0
    .endif
    pushl $vector
    jmp to_fault
    .set vector, vector + 1
    .endr

/* A fault while one is reported: an NMI may come before the first has made the outputs safe, so
 * the second does it, too. A third is caused by that: halt, so that it does not recurse until the
 * processor resets. */
to_fault:
    cld
    incl fault_depth
    cmpl $2, fault_depth
    ja 1f
    je 2f
    call pc104_fault                /* its frame as it lies; no return */
2:  call pc104_fault_again          /* no return, either */
1:  cli
    hlt
    jmp 1b

/* Where the task of a double fault begins (guard.c). */
    .section .text.pc104_double_fault_task, "ax"
    .globl pc104_double_fault_task
pc104_double_fault_task:
    jmp pc104_double_fault

/* Timer: counts. The count goes on while a tick overruns, so none is lost. A tick that does not
 * end within pc104_hang_ticks of them (0: none is running) is given up. */
    .section .text.pc104_irq0, "ax"
    .globl pc104_irq0
pc104_irq0:
    pushl %eax
    incl pc104_ticks
    movb $0x20, %al                 /* non-specific end of interrupt */
    outb %al, $0x20
    cmpl $0, pc104_hang_ticks
    je 1f
    movl pc104_ticks, %eax
    subl pc104_tick_began, %eax
    cmpl pc104_hang_ticks, %eax
    ja 2f
1:  popl %eax
    iret
2:  cld
    movl 4(%esp), %eax              /* where it was interrupted */
    pushl %eax
    call pc104_hung                 /* (eip); no return */
3:  cli
    hlt
    jmp 3b

/* The 8259 answers 7 when a request vanishes before it is acknowledged. The line
 * is masked, so it is never a real one. Such an interrupt must not be ended. */
    .section .text.pc104_irq7, "ax"
    .globl pc104_irq7
pc104_irq7:
    incl pc104_spurious
    iret

/* So does the second one, but the first has seen a real request on line 2, which is ended. */
    .section .text.pc104_irq15, "ax"
    .globl pc104_irq15
pc104_irq15:
    pushl %eax
    incl pc104_spurious
    movb $0x20, %al
    outb %al, $0x20
    popl %eax
    iret

    .section .text.pc104_second_irq, "ax"
    .globl pc104_second_irq
pc104_second_irq:
    movl $1, pc104_second_fired
    movl $0, APIC_END
    iret

    .section .text.pc104_apic_spurious, "ax"
    .globl pc104_apic_spurious
pc104_apic_spurious:                /* not ended, as the 8259's */
    incl pc104_spurious
    iret

    .section .bss.pc104_counts, "aw", @nobits
    .balign 4
    .globl pc104_ticks, pc104_tick_began, pc104_hang_ticks, pc104_spurious, pc104_second_fired
pc104_ticks:
    .skip 4
pc104_tick_began:
    .skip 4
pc104_hang_ticks:
    .skip 4
pc104_spurious:
    .skip 4
pc104_second_fired:
    .skip 4
fault_depth:
    .skip 4

    .section .note.GNU-stack, "", @progbits
