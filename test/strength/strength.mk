# SPDX-License-Identifier: MIT
# How strong the tests are: MC/DC, mutation, proofs.

##@ Strength of the tests, proofs
## Plant errors in the library's safety; exhand faults must find each (ARGS="--some 8" plants every
## eighth).
.PHONY: faults-mutants
faults-mutants: $(lab)
	$(Q)CC="$(CC)" test/closed/sim/faults_mutants.py $(ARGS) $(filter-out %/exhand/main.o,$(cli_obj)) \
	    $(dev_obj) $(gpio_obj) $(B)/posix/libexhand.a $(cli_libs) $(gpio_libs)

## Prove the tick path module by module (ARGS="--only gate", --update, --table).
.PHONY: proof
proof:
	@test/strength/proof/proof.py --out $(B)/proof $(ARGS)

# Check that the record is complete and of these sources, and repeat its cheap proofs with the
# provers that are here.
.PHONY: proof-ci
proof-ci:
	@.ci/deps "proofs by Frama-C" frama-c frama-c-base || true
	@.ci/deps "proofs by z3" 'python3 -c "import z3"' python3-z3 || true
	@test/strength/proof/proof.py --out $(B)/proof --ci

# Both as shared objects with counters, so that what the tests say of them is in one place; the
# tests too: they call inline functions of the headers.
mcdc_cc    := clang-19
mcdc_flags  = $(filter-out -O$(O),$(base)) -O1 $(PORT_HOSTFLAGS) -Itest -Iports -DEXH_FIX_AUDIT \
              -fPIC -fprofile-instr-generate \
              -fcoverage-mapping -fcoverage-mcdc
# This compiler does not count some decisions (!(a && b)). Write them otherwise. In tests they may
# stay.
mcdc_never := no such message
$(B)/mcdc/obj/lib/%.o $(B)/mcdc/obj/ports/%.o: mcdc_never := unsupported MC/DC
mcdc_src   := $(call tests_in,module/unit module/prop device/cards golden)
mcdc_bin   := $(foreach s,$(mcdc_src),$(B)/mcdc/$(call test_name,$s)_test)
mcdc_fuzz  := $(B)/mcdc/fuzz/wire
mcdc_probe := for t in clang-19 llvm-cov-19 llvm-profdata-19 python3; do command -v $$t || exit; \
              done; \
              ls /usr/lib/llvm-19/lib/clang/19/lib/linux/libclang_rt.profile*
mcdc_obj    = $(patsubst %.c,$(B)/mcdc/obj/%.o,$(1))
$(B)/mcdc/obj/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(mcdc_cc) $(mcdc_flags) -c $< -o $@ 2> $@.said && ! grep -q "$(mcdc_never)" $@.said || \
	    { cat $@.said; rm -f $@; exit 1; }
$(B)/mcdc/libexhand.so: $(call mcdc_obj,$(lib_src))
$(B)/mcdc/libcards.so: $(call mcdc_obj,$(cards_src))
$(B)/mcdc/lib%.so:
	$(Q)$(mcdc_cc) -shared -fprofile-instr-generate -o $@ $^
$(foreach s,$(mcdc_src),$(eval $(call test_of,$s,$(B)/mcdc,$(B)/mcdc/obj)))
$(mcdc_bin): $(call mcdc_obj,test/support.c) $(B)/mcdc/libexhand.so
$(filter $(B)/mcdc/cards/%,$(mcdc_bin)): \
    $(call mcdc_obj,test/device/cards/bus.c test/device/cards/rig.c) $(B)/mcdc/libcards.so
$(B)/mcdc/golden/golden_test: $(call mcdc_obj,$(golden_src))
$(B)/mcdc/fuzz/wire: $(call mcdc_obj,$(fuzz_src))
$(mcdc_fuzz): $(B)/mcdc/libexhand.so
$(mcdc_bin) $(mcdc_fuzz):
	@mkdir -p $(@D)
	$(Q)$(mcdc_cc) -fprofile-instr-generate -o $@ $(sort $^) -Wl,-rpath,$(abspath $(B)/mcdc) -lcmocka

## List conditions of lib/ and ports/cards that no test decides (MC/DC), and compare with
## test/strength/mcdc/missing.txt.
.PHONY: mcdc mcdc-built
mcdc:
	@.ci/deps "MC/DC" "$(mcdc_probe)" clang-19 llvm-19 libclang-rt-19-dev libcmocka-dev python3 || \
	    exit 3
	@$(MAKE) --no-print-directory $(if $(V),,-s) mcdc-built
	@test/strength/mcdc/mcdc.py --build $(B)/mcdc --jobs $(jobs) --strict $(ARGS)
mcdc-built: $(mcdc_bin) $(mcdc_fuzz)

# The tests beside the library as a shared object: a mutant is one source of it, preloaded.
mutation_flags = $(filter-out -O$(O) -g,$(base)) -O1 $(PORT_HOSTFLAGS) -Itest -DEXH_FIX_AUDIT -fPIC
mutation_src   := $(call tests_in,module/unit module/prop golden)
mutation_bin   := $(foreach s,$(mutation_src),$(B)/mutation/$(call test_name,$s)_test)
mutation_obj    = $(patsubst %.c,$(B)/mutation/obj/%.o,$(1))
$(B)/mutation/obj/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(mutation_flags) -c $< -o $@
$(B)/mutation/libexhand.so: $(call mutation_obj,$(lib_src))
	$(Q)$(CC) -shared -o $@ $^
$(foreach s,$(mutation_src),$(eval $(call test_of,$s,$(B)/mutation,$(B)/mutation/obj)))
$(mutation_bin): $(call mutation_obj,test/support.c) $(B)/mutation/libexhand.so
$(B)/mutation/golden/golden_test: $(call mutation_obj,$(golden_src))
$(mutation_bin):
	@mkdir -p $(@D)
	$(Q)$(CC) -o $@ $(filter %.o,$^) $(filter %.so,$^) -Wl,-rpath,$(abspath $(B)/mutation) -lcmocka

## Plant small errors all over lib/src; the tests of a source must find 95 of 100 (ARGS="--sample 30
## quad").
.PHONY: mutation mutation-built
mutation:
	@$(MAKE) --no-print-directory $(if $(V),,-s) mutation-built
	@CC="$(CC)" test/strength/mutation/mutation.py --build $(B)/mutation --jobs $(jobs) $(ARGS)
mutation-built: $(mutation_bin)

planted_bin := $(foreach t,prop/drive prop/safety $(addprefix unit/,authority calib_set calibrate \
               drive gate params polarity rows safety),$(B)/mutation/$(t)_test)

## Plant errors in ceiling, authority, calibration checks and ramp; the test named for each must
## report it.
.PHONY: planted
planted: $(planted_bin)
	@CC="$(CC)" test/strength/mutation/planted.py --build $(B)/mutation --jobs $(jobs) $(ARGS)
