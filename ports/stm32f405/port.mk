# SPDX-License-Identifier: MIT
PORT_DESC      := bare-metal Cortex-M4 (STM32F405), no vendor library; BOX=real, or none for a \
                  loop-back that QEMU runs
CROSS          ?= arm-none-eabi-
PORT_PKGS      := gcc-arm-none-eabi libnewlib-arm-none-eabi
# In closed loop with a simulated hand, on an emulated chip; other images run under QEMU.
stm_emulated   := $(if $(filter real,$(or $(BOX),real)),$(filter drop guarded bilateral,$(SCENE)))
PORT_QEMU      := $(if $(stm_emulated),,qemu-system-arm qemu-system-arm)
# real: encoders, D/A and A/D. none: a loop-back in their place.
BOX            ?= real
box_real       := box.c da.c adc.c
box_none       := box_none.c
crc_real       := ports/stm32f405/crc.c
crc_none       := lib/src/run/crc_table.c
$(if $(box_$(BOX)),,$(error BOX=$(BOX): one of real, none))
PORT_SUFFIX    := $(if $(filter-out real,$(BOX)),-$(BOX))
# Megahertz of the crystal; RATE: of the loop, 0 the scene's; MODBUS=write: clients may change
# parameters; TICKS: then stop, 0 never.
HSE            ?= 8
RATE           ?= 0
TICKS          ?= $(if $(SCENE_MAIN),0,$(if $(filter none,$(BOX)),2000,0))
PORT_MAIN      := ports/stm32f405/main.c lib/src/run/deadman.c
PORT_SRC        = $(addprefix ports/stm32f405/,start.c clock.c pins.c say.c uart.c watchdog.c \
                  log.c link.c mem.c board.c $(box_$(BOX)) \
                  $(if $(SCENE_MAIN),,$(if $(SCENE_ROM),scene_rom.c, \
                  scene_full.c slot.c modbus.c))) \
                  $(if $(SCENE_MAIN)$(SCENE_ROM),,$(addprefix lib/src/run/,log.c log_later.c) \
                  $(crc_$(BOX)))
PORT_CFLAGS    := -mcpu=cortex-m4 -mthumb -mfloat-abi=soft -ffreestanding
PORT_LDFLAGS   := -mcpu=cortex-m4 -mthumb -nostdlib -static -Wl,--build-id=none
PORT_LDSCRIPT  := ldscripts/stm32f405.ld
PORT_FLOAT_LIBS := -lgcc
PORT_WHOLE     := -O3 -flto -ffat-lto-objects
PORT_RUN       := B=$(B) test/image/stm32f405/run.sh
# Each scene with records is optimised as one program, not only the largest.
SCENE_WHOLE     = $(if $(SCENE_MAIN)$(SCENE_ROM),,yes)
PORT_SAY       := stm_say
# TIM5. Where there is no RCC QEMU counts nanoseconds.
PORT_CYCLES_HZ := $(if $(filter none,$(BOX)),1000000000,84000000)
PORT_HOSTFLAGS  = -I$(B)/stm32f405 -DSTM_TICKS=$(TICKS)u -DSTM_RATE_HZ=$(RATE)u \
                  -DSTM_HSE_MHz=$(HSE)u $(if $(filter write,$(MODBUS)),-DSTM_MODBUS_WRITE=1)

# The pins, from their table.
stm_wiring     := $(B)/stm32f405/wiring.h
$(stm_wiring): ports/stm32f405/wiring.tsv ports/stm32f405/wiring.awk
	@mkdir -p $(@D)
	@awk -v want=h -f ports/stm32f405/wiring.awk $< >$@ || { rm -f $@; exit 1; }
$(patsubst %.c,$(B)/stm32f405/$(SCENE)/%.o,$(filter ports/stm32f405/%,$(PORT_SRC) $(PORT_MAIN))): \
    $(stm_wiring)

.PHONY: stm-emulator
run: $(if $(stm_emulated),stm-emulator)
stm-emulator:
	@B=$(B) test/image/hil/unicorn.sh
	@$(MAKE) --no-print-directory $(if $(V),,-s) PORT=posix $(B)/test/stm32f405/emulator

# What flashing tools take, and how, behind `make image`.
.PHONY: stm-flash
image: | stm-flash
stm-flash: all
	@$(OBJCOPY) -O binary $(image) $(image:.elf=.bin)
	@$(OBJCOPY) -O ihex $(image) $(image:.elf=.hex)
	@echo "never run on hardware: read docs/STM32F405.md before you flash; motors disconnected"
	@echo "openocd -f interface/stlink.cfg -f target/stm32f4x.cfg" \
	    "-c 'program $(image) verify reset exit'"
	@echo "st-flash --reset write $(image:.elf=.bin) 0x08000000"
	@echo "dfu-util -a 0 -s 0x08000000:leave -D $(image:.elf=.bin)"
