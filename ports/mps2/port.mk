# SPDX-License-Identifier: MIT
PORT_DESC      := bare-metal Cortex-M3 (Arm MPS2 with AN385), runs under qemu-system-arm; a \
                  loop-back for drives
CROSS          ?= arm-none-eabi-
PORT_PKGS      := gcc-arm-none-eabi
PORT_QEMU      := qemu-system-arm qemu-system-arm
PORT_SRC       := $(addprefix ports/mps2/,start.c board.c box.c say.c mem.c)
PORT_CFLAGS    := -mcpu=cortex-m3 -mthumb -ffreestanding
PORT_LDFLAGS   := -mcpu=cortex-m3 -mthumb -nostdlib -static -Wl,--build-id=none
PORT_LDSCRIPT  := ldscripts/mps2.ld
PORT_FLOAT_LIBS := -lgcc
PORT_RUN       := ports/mps2/run.sh
PORT_SAY       := mps2_say
PORT_CYCLES_HZ := 25000000
# Ticks, then stop; 0: never.
TICKS          ?= $(if $(SCENE_MAIN),0,2000)
PORT_HOSTFLAGS  = -DMPS2_TICKS=$(TICKS)u
