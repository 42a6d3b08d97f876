# SPDX-License-Identifier: MIT
# Devices and protocols against programs of others.

# The host program with Linux's drivers of the cards instead of ours. The cards are outside the
# machine.
strangers_obj := $(B)/posix/test/device/strangers/cards.o \
                 $(B)/posix/test/device/strangers/guest/linux.o
$(B)/posix/exhand-linux: $(exh_obj) $(filter-out %/ports/posix/cards.o,$(sim_obj)) \
    $(strangers_obj) $(B)/posix/libexhand.a
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(cli_libs)

.PHONY: linux-program
linux-program:
	@$(MAKE) --no-print-directory B=$(B)/variant/i686-O3 $(v_i686-O3) \
	    $(B)/variant/i686-O3/posix/exhand-linux

##@ Devices and protocols against programs of others
## Run Debian's drivers of the cards, in Debian's kernel, against the emulated cards (fetches 60
## MB).
.PHONY: strangers
strangers:
	@.ci/deps "strangers' drivers" \
	    "command -v clang && command -v i686-linux-gnu-gcc && command -v node && command -v npm" \
	    clang gcc-i686-linux-gnu libc6-dev-i386-cross nodejs npm || exit 3
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(exhand)
	@$(MAKE) --no-print-directory $(if $(V),,-s) linux-program
	@B=$(B) ARGS="$(ARGS)" test/device/strangers/strangers.sh

## Read registers of the running box with mbpoll and pymodbus, by TCP and a serial line; 10^6 reads,
## none torn.
.PHONY: modbus
modbus:
	@.ci/deps "Modbus" "test -f /usr/include/modbus/modbus.h && command -v mbpoll && \
	command -v python3" \
	    libmodbus-dev mbpoll python3 python3-pip || exit 3
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(exhand) $(B)/test/sim/modbus_reads_test \
	    $(B)/test/sim/modbus_fuzz_test
	@B=$(B) test/device/modbus/modbus.sh

attacks_run = PYTHONDONTWRITEBYTECODE=1 test/device/attacks/attacks.py $(1) $(exhand)

## Attack the box's link, ports, files and log, and judge it by its log (half a minute; ARGS="--long
## --only key"; ARGS=--planted: each verdict must report an error).
.PHONY: attacks attacks-short
attacks: all
	@.ci/deps "the attacks" "test -f /usr/include/modbus/modbus.h && command -v python3" \
	    libmodbus-dev python3 || exit 3
	@$(call attacks_run,$(ARGS))

attacks-short:
	@for a in "" --planted; do $(call attacks_run,$$a) > $(B)/attacks.txt || \
	    { cat $(B)/attacks.txt; exit 1; }; tail -n 1 $(B)/attacks.txt; done

## Attack the pc104 image under QEMU, over its network and its COM2 (half a minute; ARGS=--planted).
.PHONY: attacks-image attacks-image-short
attacks-image: all
	@for t in i686-linux-gnu-gcc qemu-system-i386 python3; do .ci/deps "attacks on the image" $$t \
	    $(pc104_pkgs) python3 || exit 3; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=drop CARDS=none all
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(nic_tape) all
	@$(attacks_image) $(ARGS)
attacks_image = $(call attacks_run,--only image$(comma)image-key$(comma)image-com2)
attacks-image-short:
	@$(attacks_image) > $(B)/attacks-image.txt || { cat $(B)/attacks-image.txt; exit 1; }
	@tail -n 1 $(B)/attacks-image.txt

# The host program for an emulated Linux, with either libgpiod in it.
gpio_src := $(sort $(filter-out $(by_modbus),$(cli_src)) ports/posix/slave/none.c \
            ports/posix/exhand/live/watch_none.c)
gpio_all := $(gpio_src:%.c=$(B)/posix/%.o) $(world_core:%.c=$(B)/posix/%.o) \
            $(B)/posix/ports/posix/world/mesh_none.o $(dev_obj)
$(B)/gpio/gpio_v%.o: ports/posix/gpio_v%.c $(stamp)
	$(Q)$(CC) $(base) $(PORT_HOSTFLAGS) -isystem $(B)/gpio/v$* -c $< -o $@
$(B)/gpio/exhand-v1 $(B)/gpio/exhand-v2: $(B)/gpio/exhand-v%: $(gpio_all) $(B)/gpio/gpio_v%.o \
    $(B)/posix/libexhand.a
	$(Q)$(CC) -static -o $@ $^ $(B)/gpio/v$*/libgpiod.a -lpthread -lm && strip $@

## Run contacts and outputs on the simulated GPIO chip of an emulated Linux, by both libgpiod
## (fetches 220 MB).
.PHONY: gpio
gpio: all
	@.ci/deps "the emulated Linux" \
	    "command -v qemu-system-x86_64 && command -v gcc-12 && command -v xz && \
	ls /usr/lib/x86_64-linux-gnu/libelf.so.1" \
	    qemu-system-x86 gcc-12 xz-utils libelf1 || exit 3
	@test/device/gpio/fetch.sh $(B)/gpio
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/gpio/exhand-v1 $(B)/gpio/exhand-v2
	@B=$(B) test/device/gpio/gpio.sh
