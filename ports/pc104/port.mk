# SPDX-License-Identifier: MIT
PORT_DESC     := bare-metal 32-bit x86 (i686), multiboot; CARDS=real, or none for a smoke image
CROSS         ?= i686-linux-gnu-
PORT_PKGS     := gcc-i686-linux-gnu libc6-dev-i386-cross
PORT_QEMU     := qemu-system-i386 qemu-system-x86
# real: the drivers over port instructions. none: constants instead of cards.
CARDS         ?= real
cards_real    := $(wildcard ports/cards/*.c) ports/pc104/port_io.c
cards_none    := ports/pc104/cards_none.c
$(if $(cards_$(CARDS)),,$(error CARDS=$(CARDS): one of real, none))
PORT_SUFFIX   := $(if $(filter-out real,$(CARDS)),-$(CARDS))
PORT_MAIN     := ports/pc104/main.c lib/src/run/deadman.c
pc104_parts   := crt0.S i686.S vectors.S board.c box.c timer.c hpet.c pit.c second.c load.c \
                 overload.c gap.c guard.c trap.c mce.c uart.c say.c \
                 number.c cmdline.c option.c provoke.c restart.c halt.c mem.c
pc104_link    := link.c net.c nic.c pci.c
# MODBUS=no: an image without registers on a second serial line.
# A scene with a black box says how much memory that has: SCENE_BOX_B in its scene.mk.
# A scene of constants without log (SCENE_ROM in its scene.mk) links neither parameters, records nor
# a network card.
PORT_SRC       = $(pc104_parts:%=ports/pc104/%) $(cards_$(CARDS)) \
                 ports/pc104/$(if $(SCENE_FLOAT),fpu.c,fpu_none.c) \
                 $(if $(SCENE_ROM),ports/pc104/scene_rom.c ports/pc104/link_none.c, \
                   ports/pc104/scene_full.c ports/pc104/fifo.c ports/pc104/module.c \
                   ports/pc104/$(if $(filter no,$(MODBUS)),modbus_none.c,modbus.c) \
                   $(addprefix lib/src/run/,log.c stream.c crc_table.c) \
                   $(pc104_link:%=ports/pc104/%) \
                   $(if $(SCENE_BOX_B),ports/pc104/dump.c \
                   lib/src/run/blackbox.c,ports/pc104/dump_none.c))
PORT_HOSTFLAGS := -Iports
# No FPU, MMX or SSE register is ever touched, so none has to be set up or saved; PORT_FLOAT is for
# a controller in floats alone.
PORT_CFLAGS   := -m32 -march=i686 -ffreestanding -fno-pic -fno-pie -fno-stack-protector \
                 -fcf-protection=none -fno-asynchronous-unwind-tables -mgeneral-regs-only
# For a scene with much to do in a tick (SCENE_WHOLE): an eighth fewer instructions, and 30 KB more.
# Tuned for an Atom, a tenth fewer; every i686 still runs it. Tuned for the paper's older Atom
# (bonnell) the dearest tick of the full box takes 170 more, and the image 800 B.
PORT_WHOLE    := -O3 -flto -ffat-lto-objects -mtune=silvermont
# Called often, and without state. (The CRC's loop is short, so it is unrolled.)
PORT_INLINE   := ports/pc104/port_io.c lib/src/run/crc_table.c
PORT_FLOAT    := -msse2 -mfpmath=sse -fno-math-errno
comma         := ,
PORT_LDFLAGS   = -m32 -nostdlib -static -no-pie \
                 -Wl,--build-id=none,-z,noexecstack,-z,max-page-size=4096 \
                 $(if $(SCENE_BOX_B),-Wl$(comma)--defsym=BLACKBOX_B=$(SCENE_BOX_B))
PORT_LDSCRIPT := ldscripts/pc104.ld
PORT_RUN      := ports/pc104/run.sh
PORT_SAY      := pc104_say
PORT_ISO      := ports/pc104/iso.sh
