# SPDX-License-Identifier: MIT
# The golden vectors: made by a model in Python, and checked against planted errors.

##@ Golden vectors
## Make the golden vectors anew from the model of docs/NUMERICS.md (ARGS=--check compares only).
.PHONY: golden
golden:
	$(Q)test/golden/golden.py $(or $(ARGS),--all)

## Plant errors in each module; the golden vectors must find them at 95 % of the rates.
.PHONY: mutants
mutants: $(B)/test/golden/golden_test
	$(Q)CC="$(CC)" B=$(B) test/golden/mutants.py $(ARGS)
