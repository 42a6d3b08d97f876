# SPDX-License-Identifier: MIT
# Images under emulators of their machines.

pc104_pkgs := gcc-i686-linux-gnu libc6-dev-i386-cross qemu-system-x86

HIL_TICKS ?= 1000000
HIL_FEW   ?= 10000
HIL_QEMU  ?= 100000

unicorn := $(abspath $(B))/unicorn
hil_obj := $(patsubst %.c,$(B)/posix/%.o,$(wildcard test/image/hil/*.c) lib/src/run/deadman.c)
$(filter $(B)/posix/test/image/hil/%,$(hil_obj)): PORT_HOSTFLAGS += -isystem $(unicorn)/include
$(B)/test/hil: $(hil_obj) $(filter-out %/main.o,$(cli_obj)) $(sim_obj) $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(unicorn)/lib/libunicorn.so.2 \
	    -Wl,-rpath,$(unicorn)/lib $(cli_libs)

# An image with the emulated cards instead of port instructions.
hil_inside := PORT=pc104 CARDS=inside \
              cards_inside="$(wildcard ports/cards/*.c) $(emu_src) test/image/hil/inside/inside.c"

##@ Images under emulators
## Run the pc104 images in closed loop with emulated cards (HIL_TICKS=1000000 HIL_FEW=10000
## HIL_QEMU=100000).
.PHONY: hil hil-built hil-run
hil: hil-built
	@$(hil_run)
hil-built:
	@B=$(B) test/image/hil/unicorn.sh
	@for t in i686-linux-gnu-gcc qemu-system-i386; do .ci/deps "the pc104 image" $$t $(pc104_pkgs) || \
	    exit 3; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/test/hil $(exhand)
	@for s in minimal drop bilateral slow contract; \
	    do $(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=$$s all || exit 1; done
	@for s in drop bilateral contract; \
	    do $(MAKE) --no-print-directory $(if $(V),,-s) $(hil_inside) SCENE=$$s all || exit 1; done
hil_run = B=$(B) TICKS=$(HIL_TICKS) FEW=$(HIL_FEW) QEMU=$(HIL_QEMU) test/image/hil/hil.sh $(ARGS)
hil-run:
	@$(hil_run)

boot_scenes := minimal drop glove bilateral calibrate bringup custom

## Boot the pc104 images under QEMU, also from an ISO; each must end well, safe or refused.
.PHONY: boot boot-built boot-run
boot: boot-built
	@$(boot_run)
boot-built: all
	@for t in i686-linux-gnu-gcc qemu-system-i386; do .ci/deps "booting" $$t $(pc104_pkgs) || \
	    exit 3; done
	@for c in real none; do for s in $(boot_scenes); do \
	    $(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=$$s CARDS=$$c all || \
	    exit; done; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=custom \
	    MODEL=test/module/slot/rude_ert_rtw CARDS=none all
	@$(MAKE) --no-print-directory $(if $(V),,-s) SCENE=custom all
	@$(MAKE) --no-print-directory -s PORT=pc104 SCENE=drop CARDS=none image \
	    ARGS="ticks=500 k=1000 uncalibrated=1 idle=spin"
boot_run = EXHAND=$(exhand) test/image/pc104/boot.sh $(B)/pc104
boot-run:
	@$(boot_run)

contract_images := mps2/minimal mps2/contract mps2/contract_slow mps2/contract_fast mps2/overflow \
                   stm32f405/minimal stm32f405/contract stm32f405/contract_slow \
                   stm32f405/contract_fast stm32f405/overflow \
                   pc104/contract pc104/contract_slow pc104/overflow template/contract
# Scene minimal frozen, and frozen for another rate than it runs at; and a digest of what it codes,
# frozen and not. TICKS is the same for all, so that none is compiled anew for another.
contract_frozen := FROZEN=1000 FROZEN=2000
frozen_digest   := TICKS=2000 PORT_SUFFIX=-digest \
                   SCENE_MAIN="test/module/frozen/digest.c lib/src/run/loop.c" \
                   SCENE_CFLAGS=-DSAY=mps2_say

## Run the port contract (test/port) and fault handlers on images under QEMU.
.PHONY: contract contract-built contract-run
contract: contract-built
	@$(contract_run)
contract-built:
	@for t in arm-none-eabi-gcc qemu-system-arm i686-linux-gnu-gcc qemu-system-i386; \
	    do .ci/deps "the port contract" $$t \
	    gcc-arm-none-eabi qemu-system-arm $(pc104_pkgs) || exit 3; done
	@for i in $(contract_frozen); \
	    do $(MAKE) --no-print-directory $(if $(V),,-s) PORT=mps2 SCENE=minimal $$i all || exit; done
	@for i in FROZEN= FROZEN=1000; do \
	    $(MAKE) --no-print-directory $(if $(V),,-s) PORT=mps2 SCENE=minimal $$i $(frozen_digest) \
	    all || exit; done
	@for i in $(contract_images); do \
	    $(MAKE) --no-print-directory $(if $(V),,-s) PORT=$${i%/*} SCENE=$${i#*/} CARDS=none BOX=none \
	    all || exit; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) PORT=stm32f405 SCENE=minimal all
contract_run = test/port/contract.sh $(B)
contract-run:
	@$(contract_run)

# The other end of the image's network cable, and the image with a log at its cards' connectors.
$(B)/test/cable: test/image/pc104/cable.c test/image/pc104/frames.c test/image/pc104/frames.h \
    ports/pc104/net.h $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(CFLAGS) -D_POSIX_C_SOURCE=200809L -Iports $(filter %.c,$^) $(LDFLAGS) -o $@
nic_tape := PORT=pc104 SCENE=bilateral CARDS=tape \
            cards_tape="$(wildcard ports/cards/*.c) $(emu_src) test/image/pc104/tape.c"

NIC_FRAMES ?= 20000
NIC_SPEEDS ?= natural
NIC_APPROACHES ?= 1

## Run the pc104 image's network under QEMU: an experiment, bad frames (NIC_FRAMES=1000000
## NIC_SPEEDS=slow,natural,fast).
.PHONY: nic nic-built nic-run
nic: nic-built
	@$(nic_run)
nic-built: all
	@for t in i686-linux-gnu-gcc qemu-system-i386; \
	    do .ci/deps "the pc104 image's network" $$t $(pc104_pkgs) || exit 3; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/test/cable $(world)
	@for s in minimal drop bilateral; \
	    do $(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=$$s CARDS=none all || \
	    exit; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(nic_tape) all
nic_run = B=$(B) FRAMES=$(NIC_FRAMES) SPEEDS=$(NIC_SPEEDS) APPROACHES=$(NIC_APPROACHES) \
          test/image/pc104/nic.sh $(nic_what)
nic_what = $(or $(ARGS),ways bilateral flood dump)
nic-run:
	@$(nic_run)

## Run the pc104 image's Modbus slave under QEMU; it must miss no tick.
.PHONY: modbus-image
modbus-image: all
	@for t in i686-linux-gnu-gcc qemu-system-i386 python3; do \
	    .ci/deps "the pc104 image's Modbus slave" $$t $(pc104_pkgs) python3 || exit 3; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=drop CARDS=none all
	@$(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=guarded CARDS=none all
	@B=$(B) test/image/pc104/modbus.sh $(ARGS)

# --- the STM32F405 ---

stm_dir := test/image/stm32f405

## Compare the register numbers of the STM32F405 port with those of two register crates.
.PHONY: stm32f405-regs
stm32f405-regs:
	@python3 $(stm_dir)/crate.py check $(stm_dir)/crate.tsv ports/stm32f405/regs.h
	@python3 $(stm_dir)/crate.py planted $(stm_dir)/crate.tsv ports/stm32f405/regs.h

stm_objs := $(patsubst %.c,$(B)/posix/%.o,$(filter-out %_test.c,$(wildcard $(stm_dir)/*.c)) \
            $(addprefix test/image/hil/,image.c ref.c setup.c) lib/src/run/deadman.c)
$(filter $(B)/posix/$(stm_dir)/%,$(stm_objs)): PORT_HOSTFLAGS += -isystem $(unicorn)/include
$(B)/test/stm32f405/emulator: $(stm_objs) $(filter-out %/main.o,$(cli_obj)) $(sim_obj) \
                                $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(unicorn)/lib/libunicorn.so.2 \
	    -Wl,-rpath,$(unicorn)/lib $(cli_libs)

STM_TICKS ?= 10000
STM_TIMES ?= 10005

## Run the stm32f405 image in closed loop under emulation (STM_TICKS=10000 STM_TIMES=10005
## ARGS="drop guarded box where spoil faults planted cuts jumps show").
.PHONY: stm32f405 stm32f405-built stm32f405-run
stm32f405: stm32f405-built
	@B=$(B) TICKS=$(STM_TICKS) TIMES=$(STM_TIMES) $(stm_dir)/stm32f405.sh $(ARGS)
stm32f405-built:
	@B=$(B) test/image/hil/unicorn.sh
	@.ci/deps "the stm32f405 image" arm-none-eabi-gcc gcc-arm-none-eabi || exit 3
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/test/stm32f405/emulator
	@for s in drop guarded bilateral; \
	    do $(MAKE) --no-print-directory $(if $(V),,-s) PORT=stm32f405 SCENE=$$s all || exit 1; done
# The short form: what is built, with few ticks.
stm32f405-run: stm32f405-regs
	@B=$(B) TICKS=600 TIMES=400 LIMIT=600 $(stm_dir)/stm32f405.sh \
	    $(or $(ARGS),drop guarded box spoil faults planted cuts jumps show)
