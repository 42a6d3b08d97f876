# SPDX-License-Identifier: MIT
# Closed loops at length: stress, coverage of intervals, and the same bits by every compiler.

##@ Long tests of closed loops
## Check the coverage of the analysis's intervals, and their bias, over 10^4 synthetic runs.
.PHONY: coverage
coverage:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/test/sim/coverage_test
	@LIMIT=86400 EXH_CASES=10000000 test/run.sh $(B)/test/sim/coverage_test

## Compare the drop experiment with a model and an analysis that share no code with it.
.PHONY: gate gate-sample gate-mutants
gate: all
	@test/closed/model/mutants.py --texts
	@test/closed/model/gate.py check $(exhand) $(ARGS)

## Make the model's sample anew: 60 runs a rate (test/closed/model/falls.csv; 14 min of a core).
gate-sample: all
	@test/closed/model/gate.py sample $(exhand) $(ARGS)

## Plant small errors in simulator and analysis; its check must report each (8 min of a core).
gate-mutants:
	@mkdir -p $(B)/gate
	@test/closed/model/mutants.py $(B)/gate $(ARGS)

# What the writers leave when they are ended at random moments, or the disk is full.
kill_run = PYTHONDONTWRITEBYTECODE=1 test/closed/kill/kill.py $(1) $(exhand) $(lab) $(world)

## End every writer of files 200 times at random moments, and on a full disk: nothing is lost
## (ARGS="--only drop").
.PHONY: kill kill-short
kill:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(exhand) $(lab) $(world)
	@$(call kill_run,$(ARGS))

# In a minute of two cores.
kill-short:
	@$(call kill_run,--kills 30 --seconds 40 --without identify) > $(B)/kill.txt || \
	    { cat $(B)/kill.txt; exit 1; }
	@tail -n 1 $(B)/kill.txt

DEVICES ?= 200
## Identify random devices, advise each by its file, and run it inside of its rule (DEVICES=200; two
## hours of two cores; goes on from build/certificate.csv).
.PHONY: certificate
certificate:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(lab)
	@$(lab) certificate --devices $(DEVICES) --seed 1500 --results $(B)/certificate.csv $(ARGS)

# Recorded networks beside them, where there are any.
SEEDS    ?= 5
comma    := ,
empty    :=
NETWORKS ?= $(subst $(empty) $(empty),$(comma),$(wildcard $(addprefix $(or \
            $(EXH_DATA),none)/,net-ethernet-direct/*.csv.xz net-internet-ping/*.dat)))
## Feel every shipped scene by every finger at three speeds over good and bad links; none may be
## missed (SEEDS=5; table in build/contacts/contacts.csv).
.PHONY: contacts
contacts:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(lab)
	@mkdir -p $(B)/contacts
	@$(lab) bilateral --contacts $(SEEDS) $(if $(NETWORKS),--networks $(NETWORKS)) \
	    --out $(B)/contacts $(ARGS)

## Compare what makes a contact settle and be silent, over 80 hands, with what it costs (table in
## build/remedies/remedies.md).
.PHONY: remedies
remedies:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(lab)
	@test/figures/bench/remedies.sh $(lab) $(B)/remedies $(ARGS)

# `make stress` builds these once more under sanitizers, in build/san.
stress_obj := $(patsubst %.c,$(B)/posix/%.o,$(wildcard test/closed/stress/*.c))
stress_model := $(call model_objects,examples/custom/wall_ert_rtw,$(call \
                slot_built,examples/custom/wall_ert_rtw))
$(B)/test/stress: $(stress_obj) $(slot_obj) $(stress_model) $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(cli_libs)

# The library's code against theory: the sampled wall, filters at rest, drift.
stability_obj := $(patsubst %.c,$(B)/posix/%.o,$(wildcard test/figures/stability/*.c) \
                 ports/posix/sim/eigen.c ports/posix/sim/linear.c)
$(B)/test/stability: $(stability_obj) $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ -lm

.PHONY: stability-built
stability-built: $(B)/test/stability

## Compare stability with theory: maps, steps and friction, filters at rest, drift (ARGS="--full
## map"); CSV in build/stability.
.PHONY: stability
stability:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/test/stability
	@mkdir -p $(B)/stability
	@$(B)/test/stability --out $(B)/stability $(ARGS)

STRESS_TICKS ?= 1000000
STRESS_CASES ?= 100000000
STRESS_PARTS := 8
prop_bin     := $(filter $(B)/test/prop/%,$(test_bin))

## Run stiff and extreme cases under sanitizers, and each property test with 10^8 random cases.
.PHONY: stress
stress:
	@$(MAKE) --no-print-directory $(san_vars) $(if $(V),,-s) \
	    $(B)/san/test/stress
	@$(B)/san/test/stress $(STRESS_TICKS)
	@$(MAKE) --no-print-directory $(san_vars) $(if $(V),,-s) \
	    $(B)/san/test/stability $(B)/san/test/sim/late_test
	@$(B)/san/test/stability --short
	@EXH_CASES=$(STRESS_CASES) $(B)/san/test/sim/late_test
	@$(MAKE) --no-print-directory stability ARGS=--full
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(prop_bin)
	@echo "laws at $(STRESS_CASES) random cases each, under sanitizers," \
	    "dealt to $(STRESS_PARTS) processes:"
	@LIMIT=86400 EXH_CASES=$(STRESS_CASES) PARTS=$(STRESS_PARTS) JOBS=$$(nproc) test/run.sh $(prop_bin)

# The same cases with fewer ticks and without sanitizers, so that CI runs the judge of each case,
# too.
.PHONY: stress-short
stress-short:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/test/stress
	@$(B)/test/stress 10000 > $(B)/stress.txt || { grep -A 1 FAIL $(B)/stress.txt; \
	    tail -n 1 $(B)/stress.txt; exit 1; }
	@$(MAKE) --no-print-directory stability ARGS=--short >> $(B)/stress.txt || \
	    { grep FAIL $(B)/stress.txt; exit 1; }
	@echo "stress, short: $$(grep -c '| ok$$' $(B)/stress.txt) cases ok"

# Host programs by other compilers, optimisations and for 32 bits. -g0: no debugger needs them.
v_gcc-O0   := CC=gcc O=0 CFLAGS=-g0
v_gcc-O3   := CC=gcc O=3 CFLAGS=-g0
v_clang-O0 := CC=clang O=0 CFLAGS=-g0
v_clang-O3 := CC=clang O=3 CFLAGS=-g0
v_32       := CFLAGS="-g0 -msse2 -mfpmath=sse" LDFLAGS=-static
v_i686-O0  := CC=i686-linux-gnu-gcc O=0 $(v_32)
v_i686-O3  := CC=i686-linux-gnu-gcc O=3 $(v_32)
clang_i686 := clang --target=i686-linux-gnu -isystem /usr/i686-linux-gnu/include
v_i686-clang-O0 := CC="$(clang_i686)" O=0 $(v_32)
v_i686-clang-O3 := CC="$(clang_i686)" O=3 $(v_32)
variants   := $(filter-out 32,$(patsubst v_%,%,$(filter v_%,$(.VARIABLES))))
# Each pair has both compilers, optimisations and numbers of bits. CI takes one of four in turn.
pairs      := i686-clang-O0,gcc-O3 i686-O0,clang-O3 gcc-O0,i686-clang-O3 clang-O0,i686-O3
pair        = $(word $(shell expr $(commits) % 4 + 1),$(pairs))
tried       = $(or $(VARIANTS),$(if $(ALL),$(variants),$(subst $(comma), ,$(pair))))

.PHONY: $(variants:%=variant-%)
$(variants:%=variant-%): variant-%:
	@$(MAKE) --no-print-directory B=$(B)/variant/$* $(v_$*) WERROR=1 all lab

# Golden vectors by the compilers that link CMocka, at a tenth of the rates.
.PHONY: $(variants:%=golden-%)
$(variants:%=golden-%): golden-%:
	@$(MAKE) --no-print-directory -s B=$(B)/variant/$* $(v_$*) WERROR=1 \
	    $(B)/variant/$*/test/golden/golden_test
	@echo "$*:" && EXH_RATES=1..200 test/run.sh $(B)/variant/$*/test/golden/golden_test

## Compare golden vectors, tables and logs of host programs by other compilers, optimisations and
## for 32 bits (VARIANTS: all eight).
.PHONY: variants
variants: VARIANTS = $(variants)
variants: demo
	@$(MAKE) --no-print-directory -s $(tried:%=variant-%)
	@$(MAKE) --no-print-directory -s $(patsubst %,golden-%,$(filter-out i686%,$(tried)))
	@$(MAKE) --no-print-directory -s bits VARIANTS="$(tried)"
