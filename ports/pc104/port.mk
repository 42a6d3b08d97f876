PORT_DESC     := bare-metal 32-bit x86 (i686), multiboot; no cards yet
CROSS         ?= i686-linux-gnu-
PORT_SRC      := ports/pc104/crt0.S ports/pc104/vectors.S ports/pc104/board.c \
                 ports/pc104/timer.c ports/pc104/trap.c ports/pc104/uart.c ports/pc104/say.c \
                 ports/pc104/option.c ports/pc104/mem.c
# No FPU, MMX or SSE register is ever touched, so none has to be set up or saved.
PORT_CFLAGS   := -m32 -march=i686 -ffreestanding -fno-pic -fno-pie -fno-stack-protector \
                 -fcf-protection=none -fno-asynchronous-unwind-tables -mgeneral-regs-only
PORT_LDFLAGS  := -m32 -nostdlib -static -no-pie -Wl,--build-id=none,-z,noexecstack
PORT_LDSCRIPT := ldscripts/pc104.ld
PORT_RUN      := ports/pc104/run.sh
