# SPDX-License-Identifier: MIT
# Benches: error and instructions of kernels and whole ticks, beside those of others.

# Objects are as they are shipped: no sanitizer, no audit hook. Some valgrinds cannot read some
# compilers' debug information, and the profile needs only symbols, so it is stripped.
bench_parts := kernels measure number estimate force path law filter glove hand precontact \
               passivity scene minimal modbus params keyed tick box limiter
bench_obj := $(bench_parts:%=$(B)/posix/test/figures/bench/%.o)
bench_scenes := examples/drop/drop.c lib/src/run/calib_set.c lib/src/run/crc_table.c \
                examples/glove/cal.c $(wildcard examples/bilateral/*.c)
bench_bin := $(B)/bench/kernels $(B)/bench/velocity $(B)/bench/speed
$(B)/posix/test/figures/bench/kernels.o: \
    PORT_HOSTFLAGS += -DBENCH_FLAGS='"-std=c99 -O$(O)$(if $(CFLAGS), $(CFLAGS))"'
$(B)/bench/kernels: $(bench_obj) $(B)/posix/test/no_board.o $(bench_scenes:%.c=$(B)/posix/%.o)
$(B)/bench/velocity: $(B)/posix/test/figures/bench/velocity.o \
    $(patsubst %,$(B)/posix/test/figures/bench/%.o,measure plain)
$(B)/bench/speed: $(B)/posix/test/figures/bench/speed.o $(filter-out %/main.o,$(exh_obj)) $(sim_obj)
# The same as an image of ports/pc104 is built, whole and by -O3. The figures of the goals are its.
speed_whole := $(B)/whole/bench/speed
.PHONY: speed-whole
speed-whole:
	@$(MAKE) --no-print-directory B=$(B)/whole O=3 \
	    CFLAGS="$(CFLAGS) -fno-pie -no-pie -fno-stack-protector -flto=auto -Wno-maybe-uninitialized" \
	    $(speed_whole)
$(bench_bin): $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(cli_libs) \
	    -Wl,--strip-debug

# Ways to integrate the simulator's plant. The second program is the whole simulator with such a
# plant.
sim_bench_obj := $(patsubst %,$(B)/posix/test/figures/bench/sim/%.o,method semi leapfrog flow wide)
$(B)/bench/sim_work: $(B)/posix/test/figures/bench/sim/work.o $(sim_bench_obj) \
    $(B)/posix/ports/posix/sim/device.o
$(B)/bench/sim_statistics: $(B)/posix/test/figures/bench/sim/statistics.o $(sim_bench_obj) \
                           $(filter-out %/main.o %/sim/plant.o,$(cli_obj) $(sim_obj)) \
                           $(B)/posix/libexhand.a
$(B)/bench/sim_work $(B)/bench/sim_statistics:
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(cli_libs) \
	    -Wl,--strip-debug
.PHONY: sim-built
sim-built: $(B)/bench/sim_work $(B)/bench/sim_statistics

# The kernels for a 32-bit CPU, as ports/pc104 compiles a full box, but not tuned for one CPU. Only
# instructions count there. This program is larger than an image: with the usual limit for
# large units, the compiler would inline less here than there.
i686_flags := -march=i686 -fno-pic -fno-pie -no-pie -fno-stack-protector -fcf-protection=none \
              -fno-asynchronous-unwind-tables -O3 -flto=auto -Wno-maybe-uninitialized \
              --param large-unit-insns=100000 -UBILATERAL_KEEP_FRAMES
bench_i686 := $(B)/bench/kernels-i686
i686_src   := $(patsubst $(B)/posix/%.o,%.c,$(filter-out %/velocity.o,$(bench_obj))) \
              test/no_board.c $(bench_scenes) $(filter-out lib/src/num/crc.c,$(lib_src))
$(bench_i686): $(i686_src) \
    $(wildcard test/figures/bench/*.h lib/src/*/*.h lib/include/exhand/*.h test/wide.h) $(stamp)
	@mkdir -p $(@D)
	$(Q)i686-linux-gnu-gcc -static $(filter-out -MMD -MP -g,$(base)) $(PORT_HOSTFLAGS) $(CFLAGS) \
	    $(i686_flags) -Itest -o $@ $(filter %.c,$^) -lm

# Ours beside others' code: CMSIS-DSP if peers.sh could fetch it. Same compiler and flags.
cmsis     := $(B)/peers/cmsisdsp-1.10.3
cmsis_sin := $(addprefix $(cmsis)/Source/,CommonTables/arm_common_tables.c \
             FastMathFunctions/arm_sin_q31.c FastMathFunctions/arm_cos_q31.c)
biquad    := $(cmsis)/Source/FilteringFunctions/arm_biquad_cascade_
cmsis_src := $(foreach f,df1_q31 df1_fast_q31 df1_init_q31 df1_32x64_q31 df1_32x64_init_q31 \
             df1_q15 df1_init_q15 df2T_f32 df2T_init_f32 df2T_f64 df2T_init_f64,$(biquad)$f.c) \
             $(cmsis)/Source/ControllerFunctions/arm_sin_cos_q31.c $(cmsis_sin)
peers_src := test/figures/bench/peers.c test/figures/bench/peers_plain.c \
             test/figures/bench/peers_idsp.c test/figures/bench/idsp_twin.c \
             test/figures/bench/measure.c $(lib_src)
ifneq ($(wildcard $(cmsis)/.complete),)
peers_src += test/figures/bench/peers_cmsis.c $(cmsis_src)
peers_def := -DPEERS_CMSIS -D__GNUC_PYTHON__ -isystem $(cmsis)/Include -isystem \
             $(cmsis)/PrivateInclude
endif
# libfixmath comes from Debian's sources, because its package was built without optimisation.
fixmath     := $(B)/peers/libfixmath-20220222
fixmath_src := test/figures/bench/peers_fixmath_lut.c \
               $(patsubst %,$(fixmath)/libfixmath/%.c,fix16 fix16_trig fix16_sqrt)
ifneq ($(wildcard $(fixmath)/.complete),)
peers_src += test/figures/bench/peers_fixmath.c $(fixmath_src)
peers_def += -DPEERS_FIXMATH -DFIXMATH_NO_CACHE -isystem $(fixmath)/libfixmath
endif
# The crate idsp, if cargo could build it, for this CPU alone; else its twins in C.
rust      := $(wildcard $(B)/peers/rust/release/libpeers.a)
peers     := $(B)/bench/peers
$(peers): peers_rust := $(if $(rust),-DPEERS_RUST $(rust) -lpthread -ldl)
$(peers): $(rust)
$(peers): peers_cc := $(CC)
$(peers)-i686: peers_cc := i686-linux-gnu-gcc -static
peers_deps := $(wildcard $(cmsis)/.complete $(fixmath)/.complete test/figures/bench/*.h \
              lib/src/*/*.h lib/include/exhand/*.h) $(stamp)
$(peers) $(peers)-i686: $(peers_src) $(peers_deps)
	@mkdir -p $(@D)
	$(Q)$(peers_cc) $(filter-out $(warn) -MMD -MP -g,$(base)) \
	    -w $(PORT_HOSTFLAGS) $(CFLAGS) $(peers_def) -Itest -Wl,--gc-sections \
	    -o $@ $(filter %.c,$^) $(peers_rust) -lm

# Kernels of ours, of others and in plain floating point, built alike, for the report.
work     := $(B)/bench/work
work_src := $(filter-out %/work_cmsis.c %/work_fixmath.c,$(wildcard test/figures/bench/work*.c)) \
            $(addprefix test/figures/bench/,plain.c law.c path.c measure.c) \
            examples/drop/drop.c lib/src/run/calib_set.c
ifneq ($(wildcard $(cmsis)/.complete),)
work_src += test/figures/bench/work_cmsis.c \
            $(wildcard $(cmsis)/Source/ControllerFunctions/arm_pid_*_*.c) $(cmsis_sin) \
            $(cmsis)/Source/InterpolationFunctions/arm_linear_interp_q31.c
endif
ifneq ($(wildcard $(fixmath)/.complete),)
work_src += test/figures/bench/work_fixmath.c $(fixmath_src)
endif
$(work): work_cc := $(CC)
$(work)-i686: work_cc := i686-linux-gnu-gcc -static
$(work): $(B)/posix/libexhand.a
$(work)-i686: $(lib_src)
$(work) $(work)-i686: $(work_src) $(peers_deps)
	@mkdir -p $(@D)
	$(Q)$(work_cc) $(filter-out $(warn) -MMD -MP -g,$(base)) \
	    -w $(PORT_HOSTFLAGS) $(CFLAGS) $(peers_def) -Itest -Wl,--gc-sections \
	    -o $@ $(filter %.c,$^) $(filter %.a,$^) -lm

# Whole ticks of the scenes, beside the same ticks in double and float.
scenes     := $(B)/bench/scenes
scenes_src := $(wildcard test/figures/bench/scenes*.c) test/no_board.c \
              $(addprefix test/figures/bench/,pipe.c measure.c) \
              examples/drop/drop.c examples/guarded/guarded.c \
              $(wildcard examples/glove/*.c examples/bilateral/*.c) lib/src/run/calib_set.c
$(scenes): scenes_cc := $(CC)
$(scenes)-i686: scenes_cc := i686-linux-gnu-gcc -static
$(scenes): $(B)/posix/libexhand.a
$(scenes)-i686: $(lib_src)
scenes_hs := $(wildcard test/figures/bench/*.h examples/*/*.h examples/*.h lib/src/*/*.h \
             lib/include/exhand/*.h)
$(scenes) $(scenes)-i686: $(scenes_src) $(scenes_hs) $(stamp)
	@mkdir -p $(@D)
	$(Q)$(scenes_cc) $(filter-out -MMD -MP -g -Wdouble-promotion,$(base)) $(PORT_HOSTFLAGS) $(CFLAGS) \
	    -Itest -Wl,--gc-sections -o $@ $(filter %.c,$^) $(filter %.a,$^) -lm
.PHONY: scenes-csv
scenes-csv: $(scenes) $(if $(notdir $(shell command -v i686-linux-gnu-gcc)),$(scenes)-i686)
	@B=$(B) test/figures/bench/scenes.sh

##@ Benches
## Compare error and instructions of every kernel with the baseline (ARGS=--update).
.PHONY: bench
bench:
	@.ci/deps "the benches" valgrind valgrind || exit 3
	@$(MAKE) --no-print-directory $(bench_bin)
	@[ "$$SPEED" = no ] || $(MAKE) --no-print-directory speed-whole || true
	@B=$(B) test/figures/bench/peers.sh fetch || true
	@B=$(B) test/figures/bench/peers.sh fixmath || true
	@B=$(B) test/figures/bench/peers.sh rust || true
	@$(MAKE) --no-print-directory $(peers)
	@if .ci/deps "the i686 counts" i686-linux-gnu-gcc gcc-i686-linux-gnu libc6-dev-i386-cross; then \
	    $(MAKE) --no-print-directory $(bench_i686) $(peers)-i686; \
	    else rm -f $(bench_i686) $(peers)-i686; fi
	@B=$(B) test/figures/bench/bench.sh $(ARGS); status=$$?; \
	    echo; B=$(B) test/figures/bench/peers.sh table && exit $$status

# The report's part. make bench reports an exceeded bound, and missing figures fail in their own
# sections. With SHORT it takes the last bench's results if its programs are no newer.
.PHONY: bench-csv
bench-csv:
	@[ -n "$$SHORT" ] && $(MAKE) --no-print-directory -s $(bench_bin) $(peers) && \
	    [ $(B)/bench/velocity.csv -nt $(B)/bench/velocity ] && \
	    [ $(B)/bench/sines.csv -nt $(peers) ] || { \
	    rm -f $(B)/bench/bench.csv $(B)/bench/velocity.csv $(B)/bench/filters.csv \
	        $(B)/bench/sweep.csv $(B)/bench/sines.csv; \
	    SPEED=no $(MAKE) --no-print-directory bench ARGS= || true; }
	@$(MAKE) --no-print-directory \
	    -s $(work) $(if $(notdir $(shell command -v i686-linux-gnu-gcc)),$(work)-i686)
	@B=$(B) test/figures/bench/work.sh
