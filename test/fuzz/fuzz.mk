# SPDX-License-Identifier: MIT
# Random bytes into every parser.

FUZZ_SECONDS ?= 30
FUZZ_SEED    ?= 1
FUZZER       ?= plain
fuzz_src     := test/fuzz/wire_fuzz.c test/fuzz/driver.c

# Packets, without a key and with one: the same corpus.
$(B)/fuzz/plain: $(B)/test/san/test/fuzz/wire_fuzz.o
$(B)/fuzz/keyed: $(B)/test/san/test/fuzz/keyed_fuzz.o
$(B)/fuzz/plain $(B)/fuzz/keyed: $(B)/test/san/test/fuzz/driver.o $(lib_src:%.c=$(B)/test/san/%.o)
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^
$(B)/fuzz/libfuzzer: test/fuzz/wire_fuzz.c
$(B)/fuzz/keyed-libfuzzer: test/fuzz/keyed_fuzz.c
$(B)/fuzz/libfuzzer $(B)/fuzz/keyed-libfuzzer: $(lib_src) $(wildcard lib/include/exhand/*.h) \
    $(stamp)
	@mkdir -p $(@D)
	$(Q)clang $(filter-out -MMD -MP,$(base)) -D_POSIX_C_SOURCE=200809L $(san) -fsanitize=fuzzer \
	    -o $@ $(filter %.c,$^)

# Frames for the pc104 image's network card.
$(B)/fuzz/net: $(B)/test/san/test/fuzz/net_fuzz.o $(pc104_net)
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^
fuzz_net := test/fuzz/net_fuzz.c test/image/pc104/frames.c ports/pc104/net.c
$(B)/fuzz/net-libfuzzer: $(fuzz_net) $(wildcard test/image/pc104/*.h ports/pc104/net.h) $(stamp)
	@mkdir -p $(@D)
	$(Q)clang $(filter-out -MMD -MP,$(base)) -Iports -Itest/image/pc104 -DFUZZ_NO_MAIN $(san) \
	    -fsanitize=fuzzer -o $@ $(filter %.c,$^)

# Requests for the Modbus slave.
$(B)/fuzz/modbus: $(B)/test/san/test/fuzz/modbus_fuzz.o $(lib_src:%.c=$(B)/test/san/%.o)
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^
$(B)/fuzz/modbus-libfuzzer: test/fuzz/modbus_fuzz.c $(lib_src) $(wildcard lib/include/exhand/*.h) \
    $(stamp)
	@mkdir -p $(@D)
	$(Q)clang $(filter-out -MMD -MP,$(base)) -DFUZZ_NO_MAIN $(san) -fsanitize=fuzzer \
	    -o $@ $(filter %.c,$^)

# Files that the host reads. In a separate make: the whole program is built with sanitizers.
files_obj := $(patsubst %,$(B)/posix/test/fuzz/%.o,files_fuzz $(if $(FUZZ_NO_MAIN),,driver)) \
             $(filter-out %/exhand/main.o,$(exh_obj)) $(dev_obj) $(gpio_none)
$(B)/fuzz/files: $(files_obj) $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(cli_libs)
# -O1 -g1 compiles in half of the time, and an error is printed with its line.
san_vars             := B=$(B)/san O=1 CFLAGS="$(san) -g1" LDFLAGS="$(san)"
files_vars_plain     := $(san_vars)
files_vars_libfuzzer := B=$(B)/fuzz/clang CC=clang FUZZ_NO_MAIN=1 \
                        CFLAGS="$(san) -fsanitize=fuzzer-no-link" \
                        LDFLAGS="$(san) -fsanitize=fuzzer"
files_plain          := $(B)/san/fuzz/files
files_libfuzzer      := $(B)/fuzz/clang/fuzz/files

fuzz_more            := net modbus keyed

##@ Fuzzing
## Feed hostile packets, frames, requests and files to every parser (FUZZ_SECONDS=30 FUZZ_SEED=1
## FUZZER=plain or libfuzzer).
.PHONY: fuzz
fuzz:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/fuzz/plain $(B)/fuzz/$(FUZZER) \
	    $(addsuffix $(if $(filter libfuzzer,$(FUZZER)),-libfuzzer),$(fuzz_more:%=$(B)/fuzz/%))
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(files_vars_$(FUZZER)) $(files_$(FUZZER))
	@$(B)/fuzz/plain --check test/fuzz/corpus
ifeq ($(FUZZER),plain)
	@cd $(B)/fuzz && { ./net $(FUZZ_SECONDS) $(FUZZ_SEED) & net=$$!; \
	    ./modbus $(FUZZ_SECONDS) $(FUZZ_SEED) & modbus=$$!; \
	    ./keyed $(FUZZ_SECONDS) $(FUZZ_SEED) $(CURDIR)/test/fuzz/corpus & keyed=$$!; \
	    $(abspath $(files_plain)) $(FUZZ_SECONDS) $(FUZZ_SEED) $(CURDIR)/test/fuzz/files \
	        > files.out 2> files.txt & files=$$!; } && \
	    ./plain $(FUZZ_SECONDS) $(FUZZ_SEED) $(CURDIR)/test/fuzz/corpus; packets=$$?; \
	    wait $$files || { grep -v '^exhand: ' files.txt | tail -n 30; exit 1; }; \
	    tail -n 1 files.out; \
	    wait $$net && wait $$modbus && wait $$keyed && exit $$packets
else
	@mkdir -p $(B)/fuzz/found && cd $(B)/fuzz && \
	    ./libfuzzer -max_total_time=$(FUZZ_SECONDS) -max_len=1024 \
	    -print_final_stats=1 found $(CURDIR)/test/fuzz/corpus
	@mkdir -p $(B)/fuzz/keyed-found && cd $(B)/fuzz && \
	    ./keyed-libfuzzer -max_total_time=$(FUZZ_SECONDS) -max_len=1024 \
	    -print_final_stats=1 keyed-found $(CURDIR)/test/fuzz/corpus
	@mkdir -p $(B)/fuzz/net-found && cd $(B)/fuzz && \
	    ./net-libfuzzer -max_total_time=$(FUZZ_SECONDS) -max_len=6000 \
	    -print_final_stats=1 net-found
	@mkdir -p $(B)/fuzz/modbus-found && cd $(B)/fuzz && \
	    ./modbus-libfuzzer -max_total_time=$(FUZZ_SECONDS) -max_len=2048 \
	    -print_final_stats=1 modbus-found
	@mkdir -p $(B)/fuzz/files-found && cd $(B)/fuzz && \
	    $(abspath $(files_libfuzzer)) -max_total_time=$(FUZZ_SECONDS) -max_len=4096 \
	    -close_fd_mask=1 -print_final_stats=1 files-found $(CURDIR)/test/fuzz/files 2> files.txt; \
	    failed=$$?; grep -v '^exhand: ' files.txt | tail -n 30; exit $$failed
endif

## Try every option of every command of build/posix/exhand-lab with some twenty bad values each.
.PHONY: options
options: $(lab)
	@JOBS=$(jobs) test/fuzz/options.py $(lab) $(ARGS)

# What the command line is tried by under sanitizers: these tests, and five values of each option.
san_cli  := $(patsubst %,$(B)/san/test/sim/%_test,cli csv fifo lab lines listen outfile \
            params_file quad_command regs_command)

## Run the command line's tests and bad values under sanitizers (build/san; 2 min of a core).
.PHONY: sanitized
sanitized:
	@$(MAKE) --no-print-directory $(san_vars) $(if $(V),,-s) $(san_cli) $(B)/san/posix/exhand-lab
	@ASAN_OPTIONS=detect_leaks=0 JOBS=$(jobs) test/run.sh $(san_cli)
	@JOBS=$(jobs) MEMORY_B=0 test/fuzz/options.py --some 5 $(B)/san/posix/exhand-lab

## Run short commands of the host program under valgrind (20 s of a core).
.PHONY: valgrind
valgrind: $(exhand)
	@.ci/deps "make valgrind" valgrind valgrind || exit 3
	@test/closed/valgrind.sh $(exhand)

.PHONY: fuzz-corpus
fuzz-corpus: $(B)/fuzz/plain
	@$(B)/fuzz/plain --write test/fuzz/corpus
