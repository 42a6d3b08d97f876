# SPDX-License-Identifier: MIT
# Set-up made at build time (examples/frozen.h), for one loop rate.

# FROZEN: the rate in Hz, or the period N/D in seconds as PORT's timer makes it.
FROZEN    ?=
# Width of the board's counters, from its table. The image refuses any other.
ENC_BITS  ?= $(shell sed -n 's/.*\.enc_bits = \([0-9]*\).*/\1/p' ports/$(PORT)/board.c)
# Scene and library are one small program, so that the constants reach every branch. WHOLE= switches
# that off.
WHOLE     ?= -Os -flto -ffat-lto-objects
HOSTCC    ?= cc

# SCENE:RATE:WIDTH of every frozen set-up: the image's, and those of the tests.
test_rates := 90 1000 20000 1193/1193182
frozen_all := $(sort $(if $(FROZEN),$(SCENE):$(FROZEN):$(ENC_BITS)) $(test_rates:%=minimal:%:24))
frozen_h    = $(B)/frozen/$(subst /,_,$(subst :,_,$(1))).h
define freeze
$(call frozen_h,$(1)): $(B)/freeze-$(firstword $(subst :, ,$(1)))
	@mkdir -p $$(@D)
	$$(Q)$$< $(wordlist 2,3,$(subst :, ,$(1))) > $$@.new && mv $$@.new $$@
endef
$(foreach f,$(frozen_all),$(eval $(call freeze,$f)))
freeze_deps := $(lib_src) $(wildcard lib/include/exhand/*.h lib/src/*/*.h examples/*.h \
               examples/*/*.[ch])
$(B)/freeze-%: examples/freeze.c examples/%/freeze.c $(freeze_deps)
	@mkdir -p $(@D)
	$(Q)$(HOSTCC) -std=c99 $(warn) -Ilib/include -Iexamples \
	    -o $@ examples/freeze.c examples/$*/freeze.c $(lib_src)
# A frozen scene has no set-up, so constants of its set-up are unused.
frozen_flags = -Wno-unused-const-variable -I$(B)/frozen

ifneq ($(FROZEN),)
$(if $(wildcard examples/$(SCENE)/freeze.c),,$(error FROZEN=$(FROZEN): no \
    examples/$(SCENE)/freeze.c: examples/freeze.h says what is in it))
$(if $(ENC_BITS),,$(error FROZEN=$(FROZEN): ports/$(PORT)/board.c has no .enc_bits: name a PORT \
    that has, or ENC_BITS=24))
frozen     := $(call frozen_h,$(SCENE):$(FROZEN):$(ENC_BITS))
frozen_out := $(out)/frozen/$(if $(WHOLE),whole,parts)
frozen_lib := $(frozen_out)/libexhand.a
frozen_stamp := $(out)/frozen/flags
$(eval $(call text_file,$(frozen_stamp),$$(WHOLE) | $$(ENC_BITS)))
frozen_dir := $(frozen_out)/$(basename $(notdir $(frozen)))
frozen_obj := $(SCENE_SRC:%.c=$(frozen_dir)/%.o)
whole_flags = $(if $(WHOLE),$(base) $(PORT_CFLAGS) $(WHOLE) -flto-partition=one $(CFLAGS))
$(frozen_out)/lib/%.o: lib/%.c $(stamp) $(frozen_stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(WHOLE) $(CFLAGS) -c $< -o $@
$(frozen_lib): $(lib_src:%.c=$(frozen_out)/%.o)
	$(Q)rm -f $@ && $(CROSS)ar rcD $@ $^
$(frozen_obj): $(frozen_dir)/%.o: %.c $(frozen) $(stamp) $(frozen_stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(PORT_HOSTFLAGS) $(WHOLE) $(SCENE_CFLAGS) $(frozen_flags) \
	    -DEXH_FROZEN='"$(notdir $(frozen))"' $(CFLAGS) -c $< -o $@
endif

##@ Set-up at build time
## Write the set-up of SCENE as constants to build/frozen, for FROZEN=HZ (or N/D s) and PORT's
## counters.
.PHONY: frozen
frozen: $(frozen)
	$(if $(FROZEN),,$(error FROZEN= says no rate: FROZEN=1000, or a period N/D in seconds))
	@echo $<
