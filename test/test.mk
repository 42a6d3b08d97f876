# SPDX-License-Identifier: MIT
# The tests of `make test`: programs with CMocka. Test FOLDER/NAME is
# test/SUBJECT/FOLDER/NAME_test.c, or test/FOLDER/NAME_test.c.

san       := -fsanitize=address,undefined -fno-sanitize-recover=all
# Folders with long tests come first.
test_dirs := golden closed/sim module/prop closed/world module/slot device/gpio device/serial \
             device/cards device/emu \
             image/pc104 image/stm32f405 port module/frozen module/unit
test_src  := $(foreach d,$(test_dirs),$(wildcard test/$(d)/*_test.c))
test_name  = $(notdir $(patsubst %/,%,$(dir $(1))))/$(patsubst %_test.c,%,$(notdir $(1)))
test_bin  := $(foreach s,$(test_src),$(B)/test/$(call test_name,$s)_test)
tflags     = $(base) $(CFLAGS) -Itest -DEXH_FIX_AUDIT

# Objects of two kinds: with sanitizers, and as they are shipped. -O1 compiles the first in half of
# the time, and runs a tenth longer.
in_san    := $(B)/test/san
san_cc     = $(CC) $(tflags) $(if $(filter 2,$(O)),-O1) $(san)
$(in_san)/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(san_cc) -D_POSIX_C_SOURCE=200809L -c $< -o $@
$(B)/posix/test/%.o: test/%.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_HOSTFLAGS) $(CFLAGS) -Itest -c $< -o $@

# tests_in: the sources of folders 1, with tests. test_of: 1: a source, 2: where programs are, 3:
# where its object is
tests_in   = $(filter $(1:%=test/%/%),$(test_src))
define test_of
$(2)/$(call test_name,$(1))_test: $(3)/$(1:.c=.o)
endef
# 1: folder below test/, 2: where objects are, 3: what else is linked, 4: libraries, 5: pattern of
# names, if not all
define tests
$(filter $(B)/test/$(notdir $(1))/$(or $(5),%)_test,$(test_bin)): $(B)/test/$(notdir $(1))/%_test: \
    $(2)/test/$(1)/%_test.o $(3)
	@mkdir -p $$(@D)
	$$(Q)$$(CC) $(if $(filter $(in_san),$(2)),$(san),$(filter -fsanitize%,$(LDFLAGS))) -o $$@ $$^ \
	    -lcmocka $(4)
endef
san_support := $(in_san)/test/support.o
san_lib     := $(san_support) $(lib_src:%.c=$(in_san)/%.o)
posix_lib   := $(B)/posix/test/support.o $(B)/posix/libexhand.a

# The library.
$(eval $(call tests,module/unit,$(in_san),$(san_lib)))
$(eval $(call tests,module/prop,$(in_san),$(san_lib)))

# Golden vectors over the library and the scenes, at every rate.
golden_src := $(wildcard test/golden/*.c) examples/drop/drop.c examples/guarded/guarded.c \
              lib/src/run/calib_set.c examples/glove/cal.c \
              $(wildcard examples/bilateral/*.c)
$(eval $(call tests,golden,$(B)/posix,$(golden_src:%.c=$(B)/posix/%.o) $(posix_lib)))

# Registers of the emulated cards; the bus and the glove's line have tests of their own.
emu_src := $(wildcard ports/posix/emu/[!bc]*.c)
$(eval $(call tests,device/emu,$(in_san),$(san_support) $(emu_src:%.c=$(in_san)/%.o)))

# Models of an STM32F405's parts, without a processor.
stm_models := $(addprefix test/image/stm32f405/,bus.c core.c rcc.c flash.c port.c tim.c adc.c \
              dma.c serial.c iwdg.c crc.c da.c)
$(eval $(call tests,image/stm32f405,$(in_san),$(san_support) $(stm_models:%.c=$(in_san)/%.o)))

# Drivers of the cards, over a bus that a test scripts.
cards_src := $(wildcard ports/cards/*.c)
$(in_san)/test/device/cards/%.o $(in_san)/ports/cards/%.o: tflags += -Iports
cards_obj := $(patsubst %.c,$(in_san)/%.o,test/device/cards/bus.c test/device/cards/rig.c \
             $(cards_src))
$(eval $(call tests,device/cards,$(in_san),$(cards_obj) $(san_lib)))

# The line of a stock glove, and the glove at its other end.
serial_obj := $(patsubst %.c,$(in_san)/%.o,ports/posix/cyberglove.c ports/posix/emu/cyber.c) \
              $(san_support)
$(in_san)/test/device/serial/%.o $(serial_obj): tflags += -Iports/posix
$(eval $(call tests,device/serial,$(in_san),$(serial_obj)))

# The parts of the pc104 port that need no machine.
pc104_net := $(patsubst %.c,$(in_san)/%.o,test/image/pc104/frames.c ports/pc104/net.c \
             lib/src/run/stream.c lib/src/talk/mac.c lib/src/num/bytes.c lib/src/num/crc.c)
$(in_san)/test/image/pc104/%.o $(in_san)/ports/pc104/%.o $(in_san)/test/fuzz/%.o: \
    tflags += -Iports -Itest/image/pc104
$(eval $(call tests,image/pc104,$(in_san),$(san_support) $(pc104_net)))

# Scene minimal with its own set-up and with frozen ones, all in one program.
frozen_sides := live $(subst /,_,$(test_rates))
frozen_hs    := $(foreach r,$(test_rates),$(call frozen_h,minimal:$r:24))
$(frozen_sides:%=$(B)/test/frozen/side_%.o): $(B)/test/frozen/side_%.o: test/module/frozen/side.c \
    $(stamp) $(frozen_hs)
	@mkdir -p $(@D)
	$(Q)$(san_cc) $(frozen_flags) \
	    -DSIDE=side_$* $(if $(filter live,$*),,-DEXH_FROZEN='"minimal_$*_24.h"') -c $< -o $@
$(in_san)/test/module/frozen/%.o: tflags += -DFREEZE='"$(B)/freeze-minimal"' \
    -DFREEZE_PLANTED='"$(B)/test/frozen/planted"'
$(B)/test/frozen/planted: examples/freeze.c test/module/frozen/planted.c $(lib_src) \
    $(B)/freeze-minimal
	@mkdir -p $(@D)
	$(Q)$(HOSTCC) -std=c99 $(warn) -Ilib/include -Iexamples -o $@ $(filter %.c,$^)
$(eval $(call tests,module/frozen,$(in_san),$(frozen_sides:%=$(B)/test/frozen/side_%.o) $(san_lib)))
$(filter $(B)/test/frozen/%,$(test_bin)): | $(B)/freeze-minimal $(B)/test/frozen/planted

# Closed loops: the port, the simulator and the subcommands as they are shipped. Tests define the
# loop's assertion hook themselves.
$(B)/test/loop.o: lib/src/run/loop.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(CFLAGS) -Dexh_assert_failed=exh_loop_assert_failed -Wno-missing-prototypes \
	    -c $< -o $@
closed_obj := $(filter-out %/main.o %/loop.o,$(cli_obj) $(dev_obj)) $(B)/test/loop.o \
              $(B)/posix/lib/src/run/log_later.o
$(if $(filter libmodbus,$(modbus)),$(B)/posix/test/closed/sim/modbus%.o \
    $(B)/posix/test/closed/sim/live_world_test.o: PORT_HOSTFLAGS += -DEXH_MODBUS)
$(eval $(call tests,closed/sim,$(B)/posix,$(closed_obj) $(gpio_none) $(posix_lib),$(cli_libs)))

# Scene custom with generated folders: those of the example, and others.
slot_rate_count := 500
slot_map_count  := position=q pull=f steps=f_not
slot_models     := $(wildcard examples/custom/*_ert_rtw test/module/slot/*_ert_rtw)
slot_built       = $(B)/test/model/$(call model_name,$(1))
slot_model       = $(call model,$(1),$(2),$(slot_rate_$(2)),$(slot_map_$(2)),$(slot_built))
$(foreach m,$(slot_models),$(eval $(call slot_model,$m,$(call model_name,$m))))
$(foreach m,$(slot_models),$(eval $(B)/test/slot/$(call model_name,$m)_test: $(call \
    model_objects,$m,$(call slot_built,$m))))
slot_obj := $(custom_obj) $(filter-out %/scene_none.o,$(closed_obj)) $(gpio_none)
$(eval $(call tests,module/slot,$(B)/posix,$(slot_obj) $(posix_lib),$(cli_libs)))

# The text after --gpio; and GPIO lines by both versions of libgpiod, over headers and a chip of the
# tests.
$(in_san)/ports/posix/gpio_take.o $(in_san)/test/device/gpio/take_test.o: tflags += -Iports/posix
$(eval $(call tests,device/gpio,$(in_san),$(in_san)/ports/posix/gpio_take.o $(san_support),,take))
gpio_fake = $(Q)mkdir -p $(@D) && $(CC) $(base) $(PORT_HOSTFLAGS) $(CFLAGS) -Itest/device/gpio/v$* \
            -Itest/device/gpio -c $< -o $@
$(B)/test/gpio/v%.o: ports/posix/gpio_v%.c $(stamp)
	$(gpio_fake)
$(B)/test/gpio/v%_fake.o: test/device/gpio/v%/fake.c $(stamp)
	$(gpio_fake)
gpio_parts := $(B)/test/gpio/%.o $(B)/test/gpio/%_fake.o $(B)/posix/test/device/gpio/chip.o
$(eval $(call tests,device/gpio,$(B)/posix,$(gpio_parts) $(closed_obj) $(posix_lib),$(cli_libs),v%))

# The virtual world, with meshes if their package is there.
world_test_obj := $(world_core_obj) $(world_mesh) \
                  $(patsubst %,$(B)/posix/ports/posix/world/%.o,solo link link_put link_param \
                  link_trace) \
                  $(patsubst %,$(B)/posix/ports/posix/base/%.o,none fifo option near lines outpart \
                  outfile)
$(eval $(call tests,closed/world,$(B)/posix,$(world_test_obj) $(posix_lib),$(if \
    $(world_tree),-ldl) -lm))
$(B)/test/world/window_test $(B)/test/sim/live_world_test: | $(world) $(exhand)
$(B)/posix/test/closed/world/window_test.o $(B)/posix/test/closed/sim/live_world_test.o: \
    PORT_HOSTFLAGS += -DWORLD_PROGRAM='"$(world)"' -DEXHAND_PROGRAM='"$(exhand)"'

# The port contract, on the port that runs here.
$(eval $(call tests,port,$(B)/posix,$(B)/posix/test/port/posix.o $(filter-out %/loop.o,$(sim_obj)) \
    $(posix_lib),-lm))

# Some tests wait for a clock, so one more runs than there are cores.
##@ Tests
##3 Run every test that needs no more than a compiler and CMocka, in minutes.
.PHONY: test
test_headers := $(foreach h,stdarg stddef setjmp stdint cmocka,-include $h.h)
test:
	@.ci/deps "the tests" "$(CC) $(test_headers) -fsyntax-only -xc /dev/null" libcmocka-dev || exit 3
	@.ci/deps "the tests of Modbus" "test -f /usr/include/modbus/modbus.h" libmodbus-dev || true
	@.ci/deps "lines of a GPIO chip" "test -f /usr/include/gpiod.h" libgpiod-dev || true
	@$(world_mesh_deps)
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(test_bin)
	@mkdir -p $(dir $(golden_rates)) && rm -f $(golden_rates).new
	@EXH_WRITE=$(golden_rates).new JOBS=$$(($(jobs) + ($(jobs) > 1))) test/run.sh $(test_bin)
	@$(if $(EXH_TEST)$(EXH_RATES)$(EXH_CELLS),:,mv $(golden_rates).new $(golden_rates))
