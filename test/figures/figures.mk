# SPDX-License-Identifier: MIT
# Figures: bytes, symbols, instructions, costs, the report.

##@ Figures
## Check what the library needs from outside: no float or divide instruction, no recursion, no
## memory of its own.
.PHONY: undef
undef: $(lib)
	$(Q)test/figures/size/undef.sh $(lib) $(CROSS)nm $(PORT_HELPERS)
	$(Q)test/figures/size/banned.sh $(lib) $(CROSS)objdump
	$(Q)test/figures/size/habits.sh $(lib) $(CROSS)objdump

# The library alone for small CPUs: what it needs from outside.
u_cortex-m3 := CROSS=arm-none-eabi- CFLAGS="-mcpu=cortex-m3 -mthumb -ffreestanding"
u_cortex-m0 := CROSS=arm-none-eabi- CFLAGS="-mcpu=cortex-m0 -mthumb -ffreestanding" \
               PORT_HELPERS="__aeabi_lmul __aeabi_llsl __aeabi_llsr __aeabi_lasr"

.PHONY: undef-cortex-m3 undef-cortex-m0
undef-cortex-m3 undef-cortex-m0: undef-%:
	@$(MAKE) --no-print-directory PORT=template B=$(B)/$* $(u_$*) undef

# The emulated cards, as they go into an image.
$(out)/libemu.a: $(emu_src:%.c=$(out)/%.o)
	$(Q)rm -f $@ && $(CROSS)ar rcD $@ $^
.PHONY: undef-emu
undef-emu: $(out)/libemu.a
	$(Q)test/figures/size/undef.sh $< $(CROSS)nm $(PORT_HELPERS)

## Print bytes, stack, instructions per tick and library symbols of each scene and port.
.PHONY: size
size:
	@.ci/deps "sizes on a Cortex-M3" \
	    "echo '#include <string.h>' | arm-none-eabi-gcc -fsyntax-only -xc -" \
	    gcc-arm-none-eabi libnewlib-arm-none-eabi || true
	$(Q)B=$(B) test/figures/size/limiter.sh || [ $$? = 3 ]
	$(Q)MAKE="$(MAKE)" B=$(B) test/figures/size/size.sh

## Print the limiter's code on a Cortex-M3, linked with a caller; it may be 3 KiB at most.
.PHONY: limiter-size
limiter-size:
	$(Q)B=$(B) test/figures/size/limiter.sh

## Show which modules a scene links and why, and what each feature adds: build/size/costs
## (ARGS=--update).
.PHONY: costs
costs:
	@.ci/deps "the costs" python3 python3 || exit 3
	$(Q)B=$(B) test/figures/size/costs.py $(ARGS)

## Write pictures and tables of error, run time, stability and costs to build/report (ARGS="--list",
## "--only NAME", "--short").
.PHONY: report
report:
	@.ci/deps "the report's pictures" gnuplot gnuplot-nox fonts-dejavu-core || true
	@test/figures/report/report.py --build $(B) $(ARGS)

.PHONY: report-test
report-test:
	@PYTHONDONTWRITEBYTECODE=1 test/figures/report/report_test.py
