# SPDX-License-Identifier: MIT
# Scene custom runs a controller that a code generator wrote into folder MODEL.

# MODEL_NAME is the prefix of its functions. MODEL_RATE is the one rate in Hz that it was made for,
# if any. MODEL_MAP="THEIRS=OURS ..." renames its ports.
MODEL        ?= examples/custom/wall_ert_rtw
model_name    = $(patsubst %_ert_rtw,%,$(notdir $(patsubst %/,%,$(1))))
MODEL_NAME   ?= $(call model_name,$(MODEL))
# Its objects and the adapter, without the generator's example of a main program.
model_objects = $(patsubst %,$(2)/%.o,adapter $(filter-out ert_main,$(notdir $(basename $(wildcard \
                $(1)/*.c)))))
model_obj     = $(call model_objects,$(MODEL),$(out)/model/$(MODEL_NAME))
# Only a scene with floats may use FPU registers. Without a libm the compiler expands fabs() and
# sqrt(). Warnings are off for generated code.
float_cflags  = $(filter-out -mgeneral-regs-only -ffreestanding,$(PORT_CFLAGS)) $(PORT_FLOAT)
model_base   := $(filter-out $(warn),$(base))
$(out)/examples/custom/slot_real.o: PORT_CFLAGS := $(float_cflags)

# 1: folder, 2: name, 3: rate, 4: names of ports, 5: folder to build in
define model
$(call text_file,$(5)/made_of,$(abspath $(1)) $(3) $(4) $$(MODEL_CFLAGS))
$(5)/adapter.c: $(1)/$(2).h examples/custom/adapter.awk $(5)/made_of
	$$(Q)awk -v model=$(2) -v rate=$(3) -v map="$(4)" -f examples/custom/adapter.awk $$< > $$@.new && \
	    mv $$@.new $$@
$(5)/adapter.o: $(5)/adapter.c $(stamp)
	$$(Q)$$(CC) $$(base) $$(float_cflags) $$(PORT_HOSTFLAGS) $$(CFLAGS) -Iexamples/custom \
	    -I$(1) $$(MODEL_CFLAGS) -c $$< -o $$@
$(5)/%.o: $(1)/%.c $(stamp) $(5)/made_of
	$$(Q)$$(CC) $$(model_base) $$(float_cflags) $$(PORT_HOSTFLAGS) $$(CFLAGS) -I$(1) $$(MODEL_CFLAGS) \
	    -c $$< -o $$@
endef
$(eval $(call model,$(patsubst \
    %/,%,$(MODEL)),$(MODEL_NAME),$(MODEL_RATE),$(MODEL_MAP),$(out)/model/$(MODEL_NAME)))
