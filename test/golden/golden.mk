# SPDX-License-Identifier: MIT
# The golden vectors: made by a model in Python, and checked against planted errors.

# Digests of single rates, as the library here computes them. A reader checks each hundred against
# digests.inc. make test writes them too, so that no rate is computed twice.
golden_rates := $(B)/golden/rates.txt
$(golden_rates): $(B)/test/golden/golden_test
	@mkdir -p $(@D)
	@new=$@.$$$$ && env -u EXH_TEST -u EXH_RATES -u EXH_CELLS EXH_WRITE=$$new $< > $$new.log 2>&1 || \
	    { cat $$new.log; rm -f $$new*; exit 1; }; \
	mv $$new $@ && rm $$new.log
golden_thin := mutants golden-traces mcdc-built mutation-built matrix test-i686 \
               $(if $(findstring --every,$(ARGS)),golden)
$(golden_thin): $(golden_rates)
golden golden-traces mutants mcdc mutation matrix test-i686: export EXH_DIGESTS = $(golden_rates)

##@ Golden vectors
## Make the golden vectors anew from the model of docs/NUMERICS.md (ARGS=--check compares only).
.PHONY: golden
golden:
	$(Q)test/golden/golden.py $(or $(ARGS),--all)

## Write the digest of every module at every single rate, from the library here.
.PHONY: golden-rates
golden-rates: $(golden_rates)

## Compare a quarter of 2001..20000 Hz, drawn anew each time (EXH_SEED=N repeats a draw; ARGS=18: so
## many of 180 hundreds).
.PHONY: golden-beyond
golden-beyond: $(B)/test/golden/golden_test
	@mkdir -p $(B)/golden
	@JOBS=$(jobs) test/matrix/beyond.py $(B)/golden $< $(or $(ARGS),45)

## Make the model's traces at six rates, and compare the library with them tick by tick.
.PHONY: golden-traces
golden_traced := $(B)/golden/trace
$(golden_traced)/made: $(wildcard test/golden/*.py test/golden/model/*.py)
	@test/golden/golden.py --traces $(@D) && touch $@
golden-traces: $(B)/test/golden/golden_test $(golden_traced)/made
	@EXH_TRACES=$(golden_traced) EXH_RATES=90..2000:955 test/run.sh $<

## Plant errors in each module; the golden vectors must find them at 95 % of the rates.
.PHONY: mutants
mutants: $(B)/test/golden/golden_test
	$(Q)CC="$(CC)" B=$(B) test/golden/mutants.py $(ARGS)
