/* Entries of the interrupt table. They touch no C until something is wrong. */

/* One 16-byte stub per vector: makes the stack the same with and without the
 * error code that some exceptions push, adds the vector, and tells C. */
    .section .text.pc104_vectors, "ax"
    .globl pc104_vectors
    .set vector, 0
    .balign 16
pc104_vectors:
    .rept 48
    .balign 16
    .if vector != 8 && vector != 17 && (vector < 10 || vector > 14)
    pushl $0
    .endif
    pushl $vector
    jmp to_fault
    .set vector, vector + 1
    .endr

/* A fault while one is reported: the outputs are safe since the first, so stand still
 * rather than recurse until the processor resets itself. */
to_fault:
    cld
    incl fault_depth
    cmpl $1, fault_depth
    jne 1f
    call pc104_fault                /* (vector, error, eip), as they lie; no return */
1:  cli
    hlt
    jmp 1b

/* Timer: counts. The count goes on while a tick overruns, so none is lost. */
    .section .text.pc104_irq0, "ax"
    .globl pc104_irq0
pc104_irq0:
    pushl %eax
    incl pc104_ticks
    movb $0x20, %al                 /* non-specific end of interrupt */
    outb %al, $0x20
    popl %eax
    iret

/* The 8259 answers 7 when a request vanishes before it is acknowledged; the line
 * is masked, so it is never a real one, and such a one must not be ended. */
    .section .text.pc104_irq7, "ax"
    .globl pc104_irq7
pc104_irq7:
    iret

    .section .bss.pc104_ticks, "aw", @nobits
    .balign 4
    .globl pc104_ticks
pc104_ticks:
    .skip 4

    .section .bss.pc104_fault_depth, "aw", @nobits
    .balign 4
fault_depth:
    .skip 4

    .section .note.GNU-stack, "", @progbits
