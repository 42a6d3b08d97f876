# SPDX-License-Identifier: MIT
# Walks: a script types what the documents show to a reader.

##@ Walks through the documents
## Run the sweeps of examples/sweep by GNU parallel, ssh and Slurm on this machine, and compare with
## one process.
.PHONY: scale
scale: $(lab)
	@.ci/deps "GNU parallel" "command -v parallel && command -v rsync" parallel rsync || :
	@.ci/deps "ssh to this machine" "ls /usr/sbin/sshd" openssh-server openssh-client || :
	@.ci/deps "Slurm" "command -v sbatch && command -v slurmctld && command -v slurmd && \
	command -v munged" \
	    slurm-client slurmctld slurmd munge || :
	@test/walk/sweep/scale.sh $(B)/sweep

## Deal sweeps to shards as Slurm arrays and GNU parallel call them, and compare with one process.
.PHONY: shards
shards: $(lab)
	@EXHAND="$(abspath $(lab))" test/walk/sweep/shards.sh $(B)/shards

## Type docs/PORTING.md anew: from the template to a port that passes the contract test.
.PHONY: porting
porting:
	@.ci/deps "a walk of docs/PORTING.md" \
	    "command -v arm-none-eabi-gcc && command -v qemu-system-arm" \
	    gcc-arm-none-eabi qemu-system-arm || exit 3
	@test/walk/pages/walk.py $(B)/porting docs/PORTING.md

## Link the library to a program in each way of examples/link/README.md, and check its ABI.
.PHONY: link
amalgamated := $(patsubst %.c,$(B)/posix/%.o,$(golden_src) test/support.c)
link: $(lib) $(amalgamated) amalgamation
	@.ci/deps "the ways to link" \
	    "for t in cmake pkg-config clang tcc g++; do command -v $$t || exit; done; \
	python3 -c 'import ensurepip'" \
	    cmake pkg-config clang tcc g++ python3-venv || :
	@test/walk/link/abi.py $(lib) gcc $(notdir $(shell command -v i686-linux-gnu-gcc))
	@test/walk/link/package.sh $(B)/link/package
	@WARN="$(warn)" test/walk/link/amalgamation.sh $(B)/amalgamation $(lib) $(amalgamated)
	@test/walk/link/uses.py $(B)/amalgamation
	@test/walk/link/link.py $(B)/link $(ARGS)

## Type each command block of README.md and docs/PORTING.md on a bare Debian (root;
## RELEASE=bookworm, ARGS: pages).
.PHONY: fresh
fresh:
	test/walk/fresh/fresh.sh $(or $(RELEASE),bookworm) $(ARGS)

## Measure each way of examples/link/README.md on a bare Debian 12 (root; ARGS=--update writes its
## table).
.PHONY: fresh-ways
fresh-ways:
	test/walk/fresh/ways.py $(B)/fresh/ways $(ARGS)

## Print the bill of materials, SPDX 2.3: exhand and what it is built, run and tested with here.
.PHONY: sbom
sbom:
	@test/walk/release/sbom.py --check >&2
	@test/walk/release/sbom.py

## Build library and image of SCENE (minimal) for pc104 from two folders: the same bytes? Prints
## their SHA-256.
.PHONY: same
same:
	@.ci/deps "an image for PC/104" i686-linux-gnu-gcc gcc-i686-linux-gnu || exit 3
	@SCENE=$(if $(filter command%,$(origin SCENE)),$(SCENE),minimal) \
	    test/walk/release/same.sh $(B)/same

## Check that all names in the documents exist, and that the documents list every page, port, scene
## and test folder.
.PHONY: doc-names
doc-names: $(exhand) $(lab)
	@ports/stm32f405/wiring.sh --check
	@PYTHONDONTWRITEBYTECODE=1 test/walk/docs/docs.py $(exhand) $(world)

## Check the style of the documents (docs/STYLE.md): sentences, idioms, links, commands, budgets
## (ARGS=--stats, ARGS="--comments FILE...").
.PHONY: prose
prose: $(exhand) $(lab)
	@PYTHONDONTWRITEBYTECODE=1 test/walk/docs/prose_test.py $(exhand) $(world) 2> $(B)/prose.txt || \
	    { cat $(B)/prose.txt; exit 1; }
	@PYTHONDONTWRITEBYTECODE=1 test/walk/docs/prose.py $(ARGS) $(exhand) $(world)

## Check that no two sources need each other, no room includes what it may not, none is above its
## budget.
.PHONY: structure
structure: $(exhand) $(world)
	@if .ci/deps "the symbols of the PC/104" i686-linux-gnu-gcc gcc-i686-linux-gnu; \
	    then for s in minimal bilateral; do \
	    $(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=$$s all || exit; done; fi
	@PYTHONDONTWRITEBYTECODE=1 test/walk/docs/structure_test.py 2> $(B)/structure.txt || \
	    { cat $(B)/structure.txt; exit 1; }
	@PYTHONDONTWRITEBYTECODE=1 test/walk/docs/structure.py $(B)
