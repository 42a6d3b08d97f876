# SPDX-License-Identifier: MIT
# The same tests on other CPUs and by other compilers (test/matrix/README.md).

# Two programs with a separate printer, because CMocka is not there. One is golden vectors over the
# library as it is shipped. The other is all other tests that need no machine, over a library whose
# saturations are counted. SUITE_LINK links what CC compiled, SUITE_LTO is none, gcc or clang,
# SUITE_CFLAGS is for all but the golden vectors.
suite_def   := -D_POSIX_C_SOURCE=200809L -DEXH_CHECK_PLAIN
comma       := ,
suite_dirs  := module/unit module/prop device/cards device/emu $(if $(SUITE_METAL),,image/pc104)
# One of them looks at a box that was never opened: before all others of this program.
suite_first := test/device/cards/box_test.c
suite_test  := $(suite_first) $(filter-out $(suite_first),$(filter \
               $(suite_dirs:%=test/%/%),$(test_src)))
suite_net   := $(if $(SUITE_METAL),,test/image/pc104/frames.c ports/pc104/net.c)
suite_src   := $(sort $(lib_src) test/support.c $(cards_src) $(emu_src) test/device/cards/bus.c \
               test/device/cards/rig.c $(suite_net))
suite_group  = $(subst /,_,$(call test_name,$(1)))
suite_lto   := $(if $(filter gcc clang,$(SUITE_LTO)),-flto)
suite_link  := $(or $(SUITE_LINK),$(CC))
# Without a C library: start, memory's functions and the compiler's helpers (SUITE_METAL:
# test/matrix/NAME.c).
suite_metal := $(if $(SUITE_METAL),$(patsubst %,$(B)/suite/metal/%.o,test/matrix/$(SUITE_METAL) \
               ports/mps2/mem))
suite_bare  := -nostdlib -Wl,--build-id=none -Wl,--no-enum-size-warning -Wl,-z,noexecstack
suite_libs  := $(if $(SUITE_METAL),$(suite_bare) -T test/matrix/$(SUITE_METAL).ld -lgcc)
suite_def   += $(if $(SUITE_METAL),-ffreestanding -DEXH_CHECK_PUTCHAR=metal_putchar)
suite_def   += $(if $(filter-out avr,$(SUITE_METAL)),-DEXH_CHECK_ENV=metal_env)

$(B)/suite/plain/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(CFLAGS) $(suite_lto) -Itest $(suite_def) -c $< -o $@
$(B)/suite/audit/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(tflags) $(suite_lto) $(SUITE_CFLAGS) $(suite_def) -c $< -o $@
$(B)/suite/audit/test/device/cards/%.o $(B)/suite/audit/ports/cards/%.o: tflags += -Iports
$(B)/suite/audit/test/image/pc104/%.o $(B)/suite/audit/ports/pc104/%.o: tflags += -Iports \
    -Itest/image/pc104
$(B)/suite/metal/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(suite_link) $(base) $(CFLAGS) -ffreestanding -c $< -o $@
# Each test's main gets the name of its folder and file.
$(B)/suite/audit/%_test.o: tflags += -Dmain=suite_$(call suite_group,$*.c) -Wno-missing-prototypes
$(B)/suite/groups.inc: FORCE
	@mkdir -p $(@D)
	@printf 'GROUP(%s)\n' $(foreach t,$(suite_test),$(call suite_group,$t)) > $@.new
	@cmp -s $@.new $@ || cp $@.new $@
$(B)/suite/audit/test/matrix/suite.o: $(B)/suite/groups.inc
$(B)/suite/audit/test/matrix/suite.o: tflags += -I$(B)/suite

# AVR: an image a module, which says its digests and compares none; those that do not fit are
# SUITE_WITHOUT. What runs them has 63 KiB of memory for avr_large.
avr_not    := $(patsubst %,test/golden/%.c,digests golden_test explain $(SUITE_WITHOUT))
avr_src    := $(filter-out $(avr_not),$(golden_src) test/support.c $(lib_src))
avr_module := $(filter-out $(SUITE_WITHOUT),$(shell sed -n 's/.* digest_\(\w*\)\[.*/\1/p' \
              test/golden/digests.inc))
avr_large  := precontact
avr_link   := -Wl,--gc-sections -Wl,--defsym=__DATA_REGION_LENGTH__=0xFF00
$(avr_module:%=$(B)/suite/avr/%.elf): $(B)/suite/avr/%.elf: test/matrix/avr.c \
    $(patsubst %.c,$(B)/suite/plain/%.o,$(avr_src))
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(CFLAGS) $(suite_lto) -Itest -Itest/golden $(suite_def) -DMETAL_MODULE=$* \
	    -c $< -o $(@:.elf=.main.o)
	$(Q)$(CC) -O$(O) $(CFLAGS) $(suite_lto) $(avr_link) \
	    $(if $(filter $*,$(avr_large)),-Wl$(comma)--defsym=__stack=0xFFFF) \
	    -o $@ $(@:.elf=.main.o) $(filter %.o,$^)
$(B)/suite/avr_run: test/matrix/avr_run.c $(stamp)
	@mkdir -p $(@D)
	$(Q)gcc -std=gnu99 -O2 -Wall -Wextra -Werror -o $@ $< -lsimavr -lelf
$(B)/suite/images: $(avr_module:%=$(B)/suite/avr/%.elf) $(B)/suite/avr_run FORCE
	@echo $(filter %.elf,$^) > $@

$(B)/suite/golden: $(patsubst %.c,$(B)/suite/plain/%.o,$(golden_src) test/support.c $(lib_src))
$(B)/suite/tests: $(patsubst %.c,$(B)/suite/audit/%.o,$(suite_src) $(suite_test) \
    test/matrix/suite.c)
$(B)/suite/golden $(B)/suite/tests: $(suite_metal)
ifeq ($(SUITE_LTO),clang)
	$(Q)test/matrix/lto.sh $@ "$(CC) -O$(O) $(CFLAGS)" $(filter-out $(suite_metal),$^)
	$(Q)$(suite_link) $(LDFLAGS) -o $@ $@.lto.o $(suite_metal) $(suite_libs)
else
	$(Q)$(suite_link) $(if $(suite_lto),-flto=1 -O$(O)) $(if $(filter $(CC),$(suite_link)),$(CFLAGS)) \
	    $(SUITE_CFLAGS) $(LDFLAGS) \
	    -o $@ $^ $(suite_libs)
endif

# Every rate on a 32-bit CPU; what overflows there alone traps.
.PHONY: test-i686
test-i686:
	$(matrix) --only i686-gcc-O2 --trap --cases 100000

matrix = @MAKE="$(MAKE)" JOBS=$(jobs) test/matrix/matrix.py --dir $(B)/matrix

##@ Other CPUs and compilers
## Run unit, property and golden tests on eight CPUs by two compilers, and write docs/MATRIX.md
## (ARGS="--only mips").
.PHONY: matrix
matrix:
	$(matrix) $(ARGS)

# Digests of 2001..20000 Hz, on the host.
.PHONY: matrix-beyond
matrix-beyond: $(B)/test/golden/golden_test
	@mkdir -p $(B)/matrix
	@JOBS=$(jobs) test/matrix/beyond.py $(B)/matrix $<

## Run Table II, the full box and faults on the eight CPUs; digits and logs must be the host's
## (ARGS="--only mips").
.PHONY: matrix-box
matrix-box: all $(lab)
	@mkdir -p $(B)/box/host
	@$(lab) drop --out $(B)/box/host --runs 3 > $(B)/box/host/table2.txt
	@$(exhand) calibrate --out $(B)/box/host/calibration > $(B)/box/host/calibration.txt
	@$(exhand) bilateral --out $(B)/box/host/bilateral > $(B)/box/host/bilateral.txt
	@$(exhand) glove --record $(B)/box/host/glove.exh --does poses --seconds 5 \
	    > $(B)/box/host/glove.txt
	@$(lab) faults --rate 100 > $(B)/box/host/faults.txt
	@MAKE="$(MAKE)" JOBS=$(jobs) FAULTS=$(B)/box/host/faults.txt \
	    TABLE2=$(B)/box/host/table2.csv test/matrix/box.py $(B)/box $(ARGS)
