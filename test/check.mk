# SPDX-License-Identifier: MIT
# What CI runs after `make test`.

# What is dealt to landings goes by it. Of two parts a landing has one; ALL=1 runs both.
commits = $(or $(shell git rev-list --count HEAD 2>/dev/null),1)
odd     = $(filter %1 %3 %5 %7 %9,$(commits))
turn    = $(if $(ALL),$(1) $(2),$(if $(odd),$(1),$(2)))

# A sub-make, and the time that it took.
timed = +bash -c 'TIMEFORMAT="took: %0R s, %0U + %0S s of a core: $$*"; time "$$@"' make $(MAKE) \
        --no-print-directory -s

check_tools := clang i686-linux-gnu-gcc arm-none-eabi-gcc qemu-system-i386 qemu-system-arm \
               valgrind python3
check_pkgs  := clang $(pc104_pkgs) gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm \
               valgrind python3

# What `make test` and `make check` install, in a call each; .ci/run has the second's at work beside
# `make test`, so what a test looks for is in the first. A target that runs alone asks for its own.
.PHONY: test-packages check-packages
test-packages:
	@.ci/deps "the tests" "command -v gnuplot && cd /usr/include && \
	ls cmocka.h modbus/modbus.h gpiod.h embree*/rtcore.h" \
	    libcmocka-dev libmodbus-dev libgpiod-dev libembree-dev gnuplot-nox fonts-dejavu-core || :
check_more := gcc-mips-linux-gnu libc6-dev-mips-cross gcc-s390x-linux-gnu libc6-dev-s390x-cross \
              qemu-user gcc-avr avr-libc simavr libsimavr-dev libelf-dev clang-19 llvm-19 \
              libclang-rt-19-dev frama-c-base python3-z3 cmake pkg-config tcc g++ python3-venv \
              python3-pip doxygen clang-format grub-pc-bin grub-common xorriso mtools
check_uses := $(check_tools) mips-linux-gnu-gcc s390x-linux-gnu-gcc qemu-mips avr-gcc simavr \
              clang-19 llvm-cov-19 frama-c cmake pkg-config tcc g++ doxygen clang-format \
              grub-mkrescue xorriso mformat
check-packages:
	@.ci/deps "the checks" "for t in $(check_uses); do command -v \$$t || exit; done" \
	    $(check_pkgs) $(check_more) || :
	@B=$(B) test/image/hil/unicorn.sh || :
	@for what in fetch fixmath rust; do B=$(B) test/figures/bench/peers.sh $$what || :; done

##@ CI
## Run what CI runs after `make test`: other compilers and CPUs, mutants, images, sizes, benches,
## documents.
.PHONY: check
check: export WERROR = 1
check:
	@for t in $(check_tools); do .ci/deps "the checks" $$t $(check_pkgs) || exit 3; done
	@$(timed) all lab
	@$(timed) matrix ARGS=--ci
	@$(timed) golden ARGS="--check --every 40"
	@$(timed) golden-beyond ARGS=18
	@$(timed) golden-traces
	@$(timed) gate
	@$(timed) mutants ARGS="--some 4"
	@$(timed) planted
	@$(timed) mcdc
	@$(timed) proof-ci
	@$(timed) fuzz FUZZ_SECONDS=12 FUZZ_SEED=$(commits)000000000
	@$(timed) options sanitized
	@$(timed) demo > $(B)/demo.txt && tail -n 40 $(B)/demo.txt
	@$(timed) images-built $(tried:%=variant-%) $(B)/posix/exhand-linux
	@$(timed) $(patsubst %,golden-%,$(filter-out i686%,$(tried)))
	@$(timed) bits
	@$(timed) undef undef-cortex-m3 undef-cortex-m0
	@$(timed) PORT=pc104 SCENE=minimal undef undef-emu
	@$(timed) PORT=template SCENE=minimal all
	@$(timed) fmu $(B)/fmi/native
	@$(timed) $(check_runs)
	@$(timed) -j3 $(check_waits)
	@$(timed) sbom > $(B)/exhand.spdx
	@$(timed) report ARGS=--short

# Images take one core to link, so variants are compiled beside them.
.PHONY: images-built
images-built:
	@$(MAKE) --no-print-directory world boot-built contract-built nic-built \
	    $(call turn,hil-built,stm32f405-built)

# Goals that may run together, as none compiles what another reads (Makefile). These run what is
# built; the longest come first.
check_runs := $(call turn,hil-short,stm32f405-run) nic-run boot-run contract-run two-run fmi-run \
              structure report-test picture
# Some of these wait for a network or a clock, so three run at a time. Those that compile do so in
# folders of their own.
check_waits := $(call turn,attacks-short size python-run,kill-short attacks-image-short bench \
               porting valgrind stress-short) link prose shards same doc-names fmt-check doc
.PHONY: hil-short picture bits
hil-short:
	@$(MAKE) --no-print-directory hil-run HIL_TICKS=2000 HIL_FEW=500 HIL_QEMU=2000 > $(B)/hil.txt || \
	    { cat $(B)/hil.txt; exit 1; }
	@grep -cE '^  ok' $(B)/hil.txt | sed 's/^/hil, short: ok: /'
picture:
	@$(world) --headless --script --seconds 1 --scene ports/posix/world/scenes/collision.world \
	    --png $(B)/world.png || [ $$? = 3 ]
bits:
	@$(lab) faults --rate 100 > $(B)/faults_100Hz.txt
	@$(lab) drop --runs 3 --out $(B)/drop_3 > $(B)/drop_3.txt
	@JOBS=$(jobs) TABLE2=$(B)/drop_3/table2.csv FAULTS=$(B)/faults_100Hz.txt \
	    test/closed/sim/bits.sh $(B)/bits $(B)/demo $(tried:%=$(B)/variant/%/posix/exhand-lab)
