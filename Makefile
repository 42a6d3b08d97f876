# SPDX-License-Identifier: MIT
# exhand: haptic-glove controller library, its ports, its experiments.
# Variables for you: PORT SCENE FROZEN B O V CC CROSS CFLAGS LDFLAGS DEPS ARGS. `make help` lists the targets.

PORT   ?= posix
SCENE  ?= drop
B      ?= build
O      ?= 2
ARGS   ?=
DEPS   ?= yes
WERROR ?=

ifneq ($(words [$(B)]) $(words $(B)),1 1)
$(error B="$(B)": the place to build in must be named, and without blanks)
endif

include ports/$(PORT)/port.mk
scene_mk := $(or $(wildcard $(addsuffix /$(SCENE)/scene.mk,examples test/hil test/board test/bench)),examples/$(SCENE)/scene.mk)
include $(scene_mk)

ifeq ($(origin CC),default)
CC := $(CROSS)gcc
endif
OBJCOPY ?= $(CROSS)objcopy
version := $(shell awk '/define EXH_VERSION_(MAJOR|MINOR|PATCH)/{v=v s $$3; s="."} END{print v}' lib/include/exhand/exhand.h)
Q       := $(if $(V),,@)
out     := $(B)/$(PORT)

# A job a core, unless -j says otherwise. What is built by a make of ours says what it has to in one piece.
MAKEFLAGS += $(if $(filter 0,$(MAKELEVEL)),-j$(or $(shell nproc 2>/dev/null),1),$(if $(filter output-sync,$(.FEATURES)),-O))
jobs       = $(or $(patsubst -j%,%,$(filter -j%,$(MAKEFLAGS))),1)

# These call make for what they need, or take it away: two at a time would write the same files.
callers := all test demo run image coverage stress stability test-i686 matrix matrix-box mutants mcdc mutation fuzz hil hil-built strangers gpio linux-program link porting scale \
           fmi boot boot-built \
           contract contract-built nic nic-built modbus-image modbus world two-computers bench-world bench report size costs cards install diagrams clean check
ifneq ($(and $(filter $(callers),$(MAKECMDGOALS)),$(word 2,$(MAKECMDGOALS))),)
.NOTPARALLEL:
endif

# The library is C99 without extensions; the strictest warnings from day one.
warn := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wcast-align -Wcast-qual \
        -Wstrict-prototypes -Wmissing-prototypes -Wundef -Wwrite-strings -Wpointer-arith \
        -Wdouble-promotion -Wformat=2 -Wvla -Wswitch-enum $(if $(WERROR),-Werror)
base := -std=c99 -O$(O) -g $(warn) -ffunction-sections -fdata-sections -Ilib/include -Iexamples -MMD -MP $(if $(UNCALIBRATED),-DUNCALIBRATED)

# What objects are compiled with, of every kind of them: another text, and all are compiled anew.
stamp      := $(out)/flags
flags_text := $(CC) | $(base) | $(PORT_CFLAGS) | $(PORT_FLOAT) | $(PORT_HOSTFLAGS) | $(CFLAGS) | $(LDFLAGS)

lib_src := $(sort $(wildcard lib/src/*.c))
lib_obj := $(lib_src:%.c=$(out)/%.o)
lib     := $(out)/libexhand.a

.DEFAULT_GOAL := all

## Show this help
.PHONY: help
help:
	@awk '/^## /{d=substr($$0,4); getline; while(/^\.PHONY/) getline; sub(/:.*/,""); \
	     printf "  %-10s %s\n",$$0,d}' $(firstword $(MAKEFILE_LIST))
	@echo "  PORT=$(PORT)    one of: $(notdir $(patsubst %/port.mk,%,$(wildcard ports/*/port.mk)))"
	@echo "  SCENE=$(SCENE)    one of: $(notdir $(patsubst %/scene.mk,%,$(wildcard examples/*/scene.mk)))"

.PHONY: FORCE
$(stamp): export flags = $(flags_text)
$(stamp): FORCE
	@mkdir -p $(@D)
	@printf '%s\n' "$$flags" | cmp -s - $@ || printf '%s\n' "$$flags" > $@

$(out)/lib/%.o: lib/%.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(CFLAGS) -c $< -o $@

$(out)/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(PORT_HOSTFLAGS) $(CFLAGS) -c $< -o $@

$(lib): $(lib_obj)
	$(Q)rm -f $@ && $(CROSS)ar rcD $@ $^


# --- a controller of your own, in scene custom: MODEL is the folder that a generator wrote ------------------------------

# MODEL_NAME: as its functions begin. MODEL_RATE: Hz, of a model made for one. MODEL_MAP="THEIRS=OURS ...": ports named otherwise.
MODEL        ?= examples/custom/wall_ert_rtw
model_name    = $(patsubst %_ert_rtw,%,$(notdir $(patsubst %/,%,$(1))))
MODEL_NAME   ?= $(call model_name,$(MODEL))
# Its objects, but for the generator's example of a main program; and what plugs it in.
model_objects = $(patsubst %,$(2)/%.o,adapter $(filter-out ert_main,$(notdir $(basename $(wildcard $(1)/*.c)))))
model_obj     = $(call model_objects,$(MODEL),$(out)/model/$(MODEL_NAME))
# No FPU register is an image's but where a scene reckons in floats; and fabs() or sqrt() are what the compiler makes of
# them, where no libm is. Others' code, others' warnings.
float_cflags  = $(filter-out -mgeneral-regs-only -ffreestanding,$(PORT_CFLAGS)) $(PORT_FLOAT)
model_base   := $(filter-out $(warn),$(base))
$(out)/examples/custom/slot_real.o: PORT_CFLAGS := $(float_cflags)

# 1: folder, 2: name, 3: rate, 4: names of ports, 5: where it is built
define model
$(5)/made_of: FORCE
	@mkdir -p $$(@D)
	@printf '%s\n' "$(abspath $(1)) $(3) $(4) $$(MODEL_CFLAGS)" | cmp -s - $$@ || printf '%s\n' "$(abspath $(1)) $(3) $(4) $$(MODEL_CFLAGS)" > $$@
$(5)/adapter.c: $(1)/$(2).h examples/custom/adapter.awk $(5)/made_of
	$$(Q)awk -v model=$(2) -v rate=$(3) -v map="$(4)" -f examples/custom/adapter.awk $$< > $$@.new && mv $$@.new $$@
$(5)/adapter.o: $(5)/adapter.c $(stamp)
	$$(Q)$$(CC) $$(base) $$(float_cflags) $$(PORT_HOSTFLAGS) $$(CFLAGS) -Iexamples/custom -I$(1) $$(MODEL_CFLAGS) -c $$< -o $$@
$(5)/%.o: $(1)/%.c $(stamp) $(5)/made_of
	$$(Q)$$(CC) $$(model_base) $$(float_cflags) $$(PORT_HOSTFLAGS) $$(CFLAGS) -I$(1) $$(MODEL_CFLAGS) -c $$< -o $$@
endef
$(eval $(call model,$(patsubst %/,%,$(MODEL)),$(MODEL_NAME),$(MODEL_RATE),$(MODEL_MAP),$(out)/model/$(MODEL_NAME)))


# --- set-up when the image is built (examples/frozen.h): FROZEN=HZ, or the period N/D in seconds as PORT's timer makes it ---

FROZEN    ?=
# Width of the board's counters: what its table says. The image refuses any other.
ENC_BITS  ?= $(shell sed -n 's/.*\.enc_bits = \([0-9]*\).*/\1/p' ports/$(PORT)/board.c)
# Scene and library as one small program, so that the constants reach every branch. WHOLE= leaves that out.
WHOLE     ?= -Os -flto -ffat-lto-objects
HOSTCC    ?= cc

# SCENE:RATE:WIDTH of all that may be asked for; those of the tests are beside that of an image.
test_rates := 90 1000 20000 1193/1193182
frozen_all := $(sort $(if $(FROZEN),$(SCENE):$(FROZEN):$(ENC_BITS)) $(test_rates:%=minimal:%:24))
frozen_h    = $(B)/frozen/$(subst /,_,$(subst :,_,$(1))).h
define freeze
$(call frozen_h,$(1)): $(B)/freeze-$(firstword $(subst :, ,$(1)))
	@mkdir -p $$(@D)
	$$(Q)$$< $(wordlist 2,3,$(subst :, ,$(1))) > $$@.new && mv $$@.new $$@
endef
$(foreach f,$(frozen_all),$(eval $(call freeze,$f)))
$(B)/freeze-%: examples/freeze.c examples/%/freeze.c $(lib_src) $(wildcard lib/include/exhand/*.h lib/src/*.h examples/*.h examples/*/*.[ch])
	@mkdir -p $(@D)
	$(Q)$(HOSTCC) -std=c99 $(warn) -Ilib/include -Iexamples -o $@ examples/freeze.c examples/$*/freeze.c $(lib_src)
# What set-up alone reads is not read there.
frozen_flags = -Wno-unused-const-variable -I$(B)/frozen

ifneq ($(FROZEN),)
$(if $(wildcard examples/$(SCENE)/freeze.c),,$(error FROZEN=$(FROZEN): no examples/$(SCENE)/freeze.c: examples/freeze.h says what is in it))
$(if $(ENC_BITS),,$(error FROZEN=$(FROZEN): ports/$(PORT)/board.c has no .enc_bits: name a PORT that has, or ENC_BITS=24))
frozen     := $(call frozen_h,$(SCENE):$(FROZEN):$(ENC_BITS))
frozen_out := $(out)/frozen/$(if $(WHOLE),whole,parts)
frozen_lib := $(frozen_out)/libexhand.a
# As the stamp, of what is asked for here alone.
frozen_stamp := $(out)/frozen/flags
$(frozen_stamp): export flags = $(WHOLE) | $(ENC_BITS)
$(frozen_stamp): FORCE
	@mkdir -p $(@D)
	@printf '%s\n' "$$flags" | cmp -s - $@ || printf '%s\n' "$$flags" > $@
frozen_obj := $(SCENE_SRC:%.c=$(frozen_out)/$(basename $(notdir $(frozen)))/%.o)
$(frozen_out)/lib/%.o: lib/%.c $(stamp) $(frozen_stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(WHOLE) $(CFLAGS) -c $< -o $@
$(frozen_lib): $(lib_src:%.c=$(frozen_out)/%.o)
	$(Q)rm -f $@ && $(CROSS)ar rcD $@ $^
$(frozen_obj): $(frozen_out)/$(basename $(notdir $(frozen)))/%.o: %.c $(frozen) $(stamp) $(frozen_stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(PORT_HOSTFLAGS) $(WHOLE) $(SCENE_CFLAGS) $(frozen_flags) -DEXH_FROZEN='"$(notdir $(frozen))"' $(CFLAGS) -c $< -o $@
endif

## The set-up of SCENE as constants, for FROZEN=HZ (or N/D s) and the counters of PORT: build/frozen
.PHONY: frozen
frozen: $(frozen)
	$(if $(FROZEN),,$(error FROZEN= says no rate: FROZEN=1000, or a period N/D in seconds))
	@echo $<


# --- what is linked -----------------------------------------------------------

image     := $(out)/$(SCENE)$(if $(FROZEN),-frozen-$(subst /,_,$(FROZEN)))$(if $(filter custom,$(SCENE)),$(filter-out -wall,-$(MODEL_NAME)))$(PORT_SUFFIX).elf
# What is frozen comes first, so that its library gives it all it needs, and nobody else what he could have from the other.
image_obj := $(if $(FROZEN),$(frozen_obj) $(frozen_lib)) \
             $(patsubst %,$(out)/$(SCENE)/%.o,$(basename $(or $(SCENE_MAIN),$(PORT_MAIN),examples/image.c examples/deadman.c) \
             $(PORT_SRC))) $(if $(SCENE_MAIN),,$(out)/examples/loop.o) $(if $(FROZEN),,$(SCENE_SRC:%.c=$(out)/%.o)) $(if $(filter custom,$(SCENE)),$(model_obj))

# These know which scene they serve: one set of objects per scene.
$(out)/$(SCENE)/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(PORT_HOSTFLAGS) -DEXH_SCENE=exh_scene_$(SCENE) $(SCENE_CFLAGS) $(CFLAGS) -c $< -o $@
$(out)/$(SCENE)/%.o: %.S $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) -Ilib/include $(PORT_CFLAGS) -g -c $< -o $@

$(image): $(image_obj) $(lib) $(PORT_LDSCRIPT) $(frozen_stamp)
	$(Q)$(CC) $(if $(FROZEN),$(if $(WHOLE),$(base) $(PORT_CFLAGS) $(WHOLE) -flto-partition=one $(CFLAGS))) $(PORT_LDFLAGS) $(LDFLAGS) -Wl,--gc-sections,-Map=$(@:.elf=.map) \
	    $(PORT_LDSCRIPT:%=-T %) $(image_obj) $(lib) $(SCENE_LIBS) -o $@

# What the machine boots from, where that is not the image itself.
boot := $(if $(PORT_ISO),$(image:.elf=.iso))
$(boot): $(image) $(PORT_ISO) FORCE
	@.ci/deps "$@" "command -v grub-mkrescue && command -v xorriso && command -v mformat && ls /usr/lib/grub/i386-pc/multiboot.mod" \
	    grub-pc-bin grub-common xorriso mtools || exit 3
	$(Q)$(PORT_ISO) $(image) $@ $(ARGS)

# The host program: every scene that has a subcommand, over the simulated device.
cli_src := $(wildcard ports/posix/cli/*.c ports/posix/fit/*.c) examples/log.c examples/blackbox.c examples/deadman.c examples/drop/drop.c \
           examples/guarded/guarded.c examples/calib.c \
           examples/calibrate/calibrate.c examples/glove/glove.c examples/glove/cal.c \
           $(wildcard examples/bilateral/*.c examples/bringup/*.c) ports/pc104/stream.c
# The world's core, without its pictures, answers in the same process.
world_opt  := main live alone bench solo link link_param link_trace view gl gl_form gl_batch gl_solid gl_layer gl_text picture_none mesh_embree mesh_none
world_core := $(filter-out $(world_opt:%=examples/world/%.c),$(wildcard examples/world/*.c))

# Rays into meshes where the package is, this compiler sees it, and what is linked can load it when it runs.
have        = $(firstword $(wildcard $(addsuffix /$(1),/usr/include /usr/local/include)))
sees        = $(if $(call have,$(1)),$(shell $(CC) $(filter -m% --target%,$(CFLAGS)) -include $(1) -fsyntax-only -xc /dev/null 2>/dev/null && echo yes))
world_rays := $(if $(filter -static,$(LDFLAGS)),,$(if $(call sees,embree3/rtcore.h),3,$(if $(call sees,embree4/rtcore.h),4)))
world_mesh := $(B)/posix/examples/world/$(if $(world_rays),mesh_embree,mesh_none).o

# 1: header, 2: library, 3: what of it: "yes" where the package has it, for this compiler and this way to link.
gives     = $(if $(call have,$(1)),$(shell t=$$(mktemp) && echo 'int main(void){return !$(3);}' | $(CC) \
              $(filter -m% --target% -static,$(CFLAGS) $(LDFLAGS)) -include $(1) -xc - -o $$t -l$(2) 2>/dev/null && echo yes; rm -f $$t))

modbus   := $(if $(call gives,modbus/modbus.h,modbus,modbus_reply),libmodbus,none)
cli_src  := $(filter-out ports/posix/cli/modbus_%.c ports/posix/cli/scene_custom.c,$(cli_src)) ports/posix/cli/modbus_mail.c $(wildcard ports/posix/cli/modbus_$(modbus)*.c)
cli_obj  := $(cli_src:%.c=$(B)/posix/%.o) $(world_core:%.c=$(B)/posix/%.o) $(world_mesh)
cli_libs := $(if $(world_rays),-ldl) $(if $(filter libmodbus,$(modbus)),-lmodbus) -pthread -lm
# Lines of a GPIO chip, by the package's version. The program alone has them: tests and benches must be the same on every machine.
gives_gpio = $(call gives,gpiod.h,gpiod,$(1))
gpio     := $(if $(call gives_gpio,gpiod_line_request_bulk),v1,$(if $(call gives_gpio,gpiod_chip_request_lines),v2,none))
gpio_none := $(B)/posix/ports/posix/gpio_none.o
gpio_obj := $(B)/posix/ports/posix/gpio_$(gpio).o
gpio_libs := $(if $(filter none,$(gpio)),,-lgpiod)

# The board and the device, without lines.
dev_obj := $(patsubst %.c,$(B)/posix/%.o,$(filter-out ports/posix/gpio_v%.c ports/posix/gpio_none.c,$(wildcard ports/posix/*.c)) \
                                         $(wildcard ports/posix/sim/*.c ports/posix/emu/*.c ports/cards/*.c)) \
           $(B)/posix/examples/loop.o
sim_obj := $(dev_obj) $(gpio_none)
exhand  := $(B)/posix/exhand

$(exhand): $(cli_obj) $(dev_obj) $(gpio_obj) $(B)/posix/libexhand.a
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(cli_libs) $(gpio_libs)

# The host program with a model in it.
exhand_custom := $(B)/posix/exhand-$(MODEL_NAME)
custom_obj    := $(patsubst %.c,$(B)/posix/%.o,ports/posix/cli/scene_custom.c examples/custom/custom.c examples/custom/slot_real.c)
$(exhand_custom): $(filter-out %/scene_none.o,$(cli_obj)) $(custom_obj) $(model_obj) $(dev_obj) $(gpio_obj) $(B)/posix/libexhand.a
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(cli_libs) $(gpio_libs)

program := $(if $(filter custom,$(SCENE)),$(exhand_custom),$(exhand))
ifeq ($(PORT),posix)
products := $(program)
else
products := $(image)
endif

## Build the library, and the host program or the image of SCENE on PORT
.PHONY: all
all: $(lib) $(products)

# Coarse where the answer does not hang on it: `exhand drop --sweep` and --friction have finer ones.
demo_runs := calibration:"calibrate --out $(B)/demo/calibration" table2:"drop --out $(B)/demo --spread 20" \
             stability:"drop --out $(B)/demo --sweep --grid 12x10 --falls 3" \
             friction:"drop --out $(B)/demo --friction 5 --falls 3" table1:"glove --selftest" \
             glove:"glove --record $(B)/demo/glove.exh --does poses --seconds 5" \
             bilateral:"bilateral --out $(B)/demo/bilateral"

## The paper's first experiment on the simulated device: tables, plots, logs in build/demo
.PHONY: demo
demo: all
	@.ci/deps "the pictures" gnuplot gnuplot-nox fonts-dejavu-core || true
	@mkdir -p $(B)/demo && rm -f $(B)/demo/stability*.csv
	@for r in $(demo_runs); do \
	    $(if $(V),echo "$(exhand) $${r#*:}";) \
	    $(exhand) $${r#*:} > $(B)/demo/$${r%%:*}.txt || { s=$$?; cat $(B)/demo/$${r%%:*}.txt; exit $$s; }; \
	done
	@s=0; if command -v gnuplot >/dev/null; then \
	    for g in pictures sweep friction calibration/pictures bilateral/bilateral; do (cd $(B)/demo/$$(dirname $$g) && \
	        gnuplot -c $$(basename $$g).gp "$(CURDIR)/ports/posix/cli/plot") || s=1; done; fi; \
	for p in force_position fall stability friction calibration/calibration bilateral/contact bilateral/force; do p=$(B)/demo/$$p.png; \
	    if [ -s $$p ]; then echo "picture: $$p"; else echo "picture missing: $$p" >&2; fi; done; \
	cat $(B)/demo/bilateral.txt $(B)/demo/calibration.txt $(B)/demo/table1.txt $(B)/demo/stability.txt $(B)/demo/friction.txt $(B)/demo/table2.txt; exit $$s

## Build the image of SCENE on PORT and what the machine boots from (ARGS: its options, kept there)
.PHONY: image
image: $(image) $(boot)
	@ls -l $^ | awk '{print $$NF ": " $$5 " bytes"}'

## Run the host program (ARGS="drop --help") or the image of SCENE on PORT
.PHONY: run
run: all
ifeq ($(PORT),posix)
	$(Q)$(program) $(ARGS)
else
	$(Q)$(or $(PORT_RUN),$(error PORT=$(PORT) cannot run images: PORT_RUN in ports/$(PORT)/port.mk names what does)) $(image) $(ARGS)
endif

# --- the world simulator ----------------------------------------------------------------

# Its core needs a C compiler alone. Pictures and rays into meshes are in it where their packages are.
world_gl   := $(and $(call have,SDL2/SDL_ttf.h),$(call have,GL/gl.h),$(call have,png.h))
world_pkgs := libsdl2-dev libsdl2-ttf-dev libgl-dev libegl-dev libgl1-mesa-dri libpng-dev fonts-dejavu-core
world      := $(B)/posix/world

world_part := main live alone bench solo link link_param link_trace view $(if $(world_gl),gl gl_form gl_batch gl_solid gl_layer gl_text,picture_none)
world_core_obj := $(patsubst %.c,$(B)/posix/%.o,$(world_core) ports/posix/sim/lag.c ports/posix/sim/plant.c ports/posix/sim/device.c)
world_obj  := $(world_core_obj) $(world_mesh) $(world_part:%=$(B)/posix/examples/world/%.o) \
              $(B)/posix/ports/posix/cli/option.o $(B)/posix/examples/bilateral/tables.o $(B)/posix/examples/glove/cal.o \
              $(B)/posix/examples/calib.o
world_libs := $(if $(world_gl),-lSDL2 -lSDL2_ttf -lGL -lpng) $(if $(world_rays),-ldl) -lpthread -lm

$(filter $(B)/posix/examples/world/%,$(world_obj)): PORT_HOSTFLAGS += -fno-math-errno \
    $(if $(world_gl),-I$(dir $(call have,SDL2/SDL_ttf.h)) -D_REENTRANT) $(if $(world_rays),-DWORLD_EMBREE=$(world_rays))

$(world): $(world_obj) $(B)/posix/libexhand.a
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(world_libs)

## The world simulator, build/posix/world (pictures and meshes with the packages it names)
.PHONY: world
world:
	@.ci/deps "the world's pictures" "test -f /usr/include/SDL2/SDL_ttf.h && test -f /usr/include/GL/gl.h && test -f /usr/include/png.h" $(world_pkgs) || true
	@.ci/deps "the world's meshes" "ls /usr/include/embree*/rtcore.h" libembree-dev || true
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(world)

## The command and the world program over UDP: two processes, and two network namespaces where it may
.PHONY: two-computers
two-computers:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(exhand) $(world)
	@$(two_run)
two_run = test/world/two_computers.sh $(exhand) $(world)
.PHONY: two-run
two-run:
	@$(two_run)

$(B)/bench/rays: $(B)/posix/test/world/rays.o $(world_core_obj) $(world_mesh)
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(if $(world_rays),-ldl) -lm

## Frames and rays a second of the world simulator, with and without culling; instructions of a ray
.PHONY: bench-world
bench-world: world $(B)/bench/rays
	@command -v valgrind >/dev/null && test/world/rays.sh $(B)/bench/rays || echo "instructions: not counted: install valgrind"
	@$(world) --bench --scene examples/world/scenes/collision.world $(ARGS)

FIT_BUDGET ?= 6000

## Search for the plant by every reading of the analysis, hours (FIT_BUDGET=N plants); state in build/fit
.PHONY: fit
fit: all
	$(Q)$(exhand) fit --budget $(FIT_BUDGET) --out $(B)/fit $(ARGS) > $(B)/fit.txt.new
	@mv $(B)/fit.txt.new $(B)/fit.txt && cat $(B)/fit.txt

# --- FMI ------------------------------------------------------------------------------------------------

# Source FMUs: what is in them is what is built here; a program of each prints its description from its own tables.
fmi_src        := ports/fmi/fmi3.c ports/fmi/absent.c
fmi_controller := ports/fmi/controller.c examples/drop/drop.c examples/calib.c $(lib_src)
fmi_device     := ports/fmi/device.c $(patsubst %,ports/posix/sim/%.c,mass plant device fall bench lag)
fmi_folders    := lib/include/exhand=exhand lib/src=lib examples= examples/drop=drop ports/posix/sim=sim ports/fmi=fmi
$(B)/fmi/describe-controller: $(patsubst %.c,$(B)/posix/%.o,ports/fmi/describe.c $(fmi_controller))
$(B)/fmi/describe-device: $(patsubst %.c,$(B)/posix/%.o,ports/fmi/describe.c $(fmi_device)) $(B)/posix/libexhand.a
$(B)/fmi/describe-%:
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^
fmi_pack = $(Q)ports/fmi/pack.py $@ $< $(fmi_folders) -- $(fmi_src)
$(B)/fmu/ExhandController.fmu: $(B)/fmi/describe-controller $(fmi_controller) $(fmi_src) ports/fmi/pack.py
	@mkdir -p $(@D)
	$(fmi_pack) $(fmi_controller)
$(B)/fmu/ExhandDevice.fmu: $(B)/fmi/describe-device $(fmi_device) $(fmi_src) ports/fmi/pack.py
	@mkdir -p $(@D)
	$(fmi_pack) $(fmi_device) lib/src/bytes.c

$(B)/fmi/native: $(B)/posix/test/fmi/native.o $(filter-out %/main.o,$(cli_obj)) $(sim_obj) $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(cli_libs)

## FMI 3.0 source FMUs of the controller and of the simulated device: build/fmu
.PHONY: fmu
fmu: $(B)/fmu/ExhandController.fmu $(B)/fmu/ExhandDevice.fmu
	@ls -l $^ | awk '{print $$NF ": " $$5 " bytes"}'

FMI_RATES ?= 90 500 2000

## FMPy validates, compiles and runs the FMUs, another importer too: the native outputs, bit for bit (FMI_RATES="90 500 2000")
.PHONY: fmi fmi-run
fmi:
	@.ci/deps "the FMUs" "command -v cmake && command -v python3 && python3 -c 'import ensurepip'" cmake make python3 python3-venv || exit 3
	@$(MAKE) --no-print-directory $(if $(V),,-s) fmu $(B)/fmi/native
	@$(fmi_run)
fmi_run = B=$(B) test/fmi/fmi.sh $(FMI_RATES)
# What of it CI has; nothing where the packages cannot be had.
fmi-run:
	@B=$(B) test/fmi/fmi.sh 500 > $(B)/fmi/said 2>&1; s=$$?; tail -n 1 $(B)/fmi/said; [ $$s = 0 ] || [ $$s = 3 ] || { cat $(B)/fmi/said; exit 1; }

# --- tests ----------------------------------------------------------------------

san       := -fsanitize=address,undefined -fno-sanitize-recover=all
test_dirs := golden sim prop world slot gpio serial cards emu pc104 board frozen unit # in this order: long ones first
test_src  := $(foreach d,$(test_dirs),$(wildcard test/$(d)/*_test.c))
test_bin  := $(test_src:test/%_test.c=$(B)/test/%_test)
tflags     = $(base) $(CFLAGS) -Itest -DEXH_FIX_AUDIT

# Sanitized: library and tests of it.
$(B)/test/san/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(tflags) $(san) -D_POSIX_C_SOURCE=200809L -c $< -o $@
lib_test_bin := $(filter $(B)/test/unit/% $(B)/test/prop/%,$(test_bin))
$(lib_test_bin): $(B)/test/san/test/support.o $(lib_src:%.c=$(B)/test/san/%.o)
$(B)/test/unit/%_test: $(B)/test/san/test/unit/%_test.o
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^ -lcmocka
$(B)/test/prop/%_test: $(B)/test/san/test/prop/%_test.o
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^ -lcmocka

# The emulated cards, at their registers: without the bus, and the glove on its line.
emu_src := $(wildcard ports/posix/emu/[!bc]*.c)
$(B)/test/emu/%_test: $(B)/test/san/test/emu/%_test.o $(B)/test/san/test/support.o $(emu_src:%.c=$(B)/test/san/%.o)
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^ -lcmocka

# Scene minimal with the set-up of its own, and frozen: a side each.
frozen_sides := live $(subst /,_,$(test_rates))
$(frozen_sides:%=$(B)/test/frozen/side_%.o): $(B)/test/frozen/side_%.o: test/frozen/side.c $(stamp) $(foreach r,$(test_rates),$(call frozen_h,minimal:$r:24))
	@mkdir -p $(@D)
	$(Q)$(CC) $(tflags) $(san) $(frozen_flags) -DSIDE=side_$* $(if $(filter live,$*),,-DEXH_FROZEN='"minimal_$*_24.h"') -c $< -o $@
$(B)/test/san/test/frozen/%.o: tflags += -DFREEZE='"$(B)/freeze-minimal"' -DFREEZE_PLANTED='"$(B)/test/frozen/planted"'
$(B)/test/frozen/planted: examples/freeze.c test/frozen/planted.c $(lib_src) $(B)/freeze-minimal
	@mkdir -p $(@D)
	$(Q)$(HOSTCC) -std=c99 $(warn) -Ilib/include -Iexamples -o $@ $(filter %.c,$^)
$(B)/test/frozen/%_test: $(B)/test/san/test/frozen/%_test.o $(B)/test/san/test/support.o $(frozen_sides:%=$(B)/test/frozen/side_%.o) \
                         $(lib_src:%.c=$(B)/test/san/%.o) | $(B)/freeze-minimal $(B)/test/frozen/planted
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^ -lcmocka

# Scene custom with generated folders, as they are: those of the example, and others.
slot_rate_count := 500
slot_map_count  := position=q pull=f steps=f_not
slot_models     := $(wildcard examples/custom/*_ert_rtw test/slot/*_ert_rtw)
slot_built       = $(B)/test/model/$(call model_name,$(1))
$(foreach m,$(slot_models),$(eval $(call model,$m,$(call model_name,$m),$(slot_rate_$(call model_name,$m)),$(slot_map_$(call model_name,$m)),$(call slot_built,$m))))
$(foreach m,$(slot_models),$(eval $(B)/test/slot/$(call model_name,$m)_test: $(call model_objects,$m,$(call slot_built,$m))))
$(filter $(B)/test/slot/%,$(test_bin)): $(B)/test/slot/%_test: $(B)/posix/test/slot/%_test.o $(B)/posix/test/support.o $(custom_obj) \
                      $(filter-out %/main.o %/loop.o %/scene_none.o,$(cli_obj) $(sim_obj)) $(B)/test/loop.o $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) -o $@ $^ -lcmocka $(cli_libs)

# What of the pc104 port knows no machine.
pc104_net := $(patsubst %.c,$(B)/test/san/%.o,test/pc104/frames.c ports/pc104/net.c ports/pc104/stream.c)
$(B)/test/san/test/pc104/%.o $(B)/test/san/ports/pc104/%.o $(B)/test/san/test/fuzz/%.o: tflags += -Iports -Itest/pc104
$(B)/test/pc104/%_test: $(B)/test/san/test/pc104/%_test.o $(B)/test/san/test/support.o $(pc104_net)
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^ -lcmocka

# Drivers of the cards, over a bus that a test scripts.
cards_src := $(wildcard ports/cards/*.c)
$(filter $(B)/test/cards/%,$(test_bin)): $(B)/test/san/test/cards/bus.o $(B)/test/san/test/cards/rig.o $(cards_src:%.c=$(B)/test/san/%.o) \
                                         $(B)/test/san/test/support.o $(lib_src:%.c=$(B)/test/san/%.o)
$(B)/test/san/test/cards/%.o $(B)/test/san/ports/cards/%.o: tflags += -Iports
$(B)/test/cards/%_test: $(B)/test/san/test/cards/%_test.o
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^ -lcmocka

# Closed loops: the port, the simulator and the subcommands as they are shipped.
$(B)/test/sim/%_test: $(B)/posix/test/sim/%_test.o $(B)/posix/test/support.o \
                      $(filter-out %/main.o %/loop.o,$(cli_obj) $(sim_obj)) $(B)/test/loop.o $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) -o $@ $^ -lcmocka $(cli_libs)
$(if $(filter libmodbus,$(modbus)),$(B)/posix/test/sim/modbus%.o: PORT_HOSTFLAGS += -DEXH_MODBUS)
$(B)/posix/test/%.o: test/%.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_HOSTFLAGS) $(CFLAGS) -Itest -c $< -o $@
# The loop without its assertion hook, which tests define themselves.
$(B)/test/loop.o: examples/loop.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(CFLAGS) -Dexh_assert_failed=exh_loop_assert_failed -Wno-missing-prototypes -c $< -o $@
# The text after --gpio; and the lines by both versions of libgpiod, of which test/gpio has headers and a chip of its own.
$(B)/test/san/ports/posix/gpio_take.o $(B)/test/san/test/gpio/take_test.o: tflags += -Iports/posix
$(B)/test/gpio/take_test: $(B)/test/san/test/gpio/take_test.o $(B)/test/san/ports/posix/gpio_take.o $(B)/test/san/test/support.o
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^ -lcmocka
$(B)/test/gpio/v%_test: $(B)/posix/test/gpio/v%_test.o $(B)/test/gpio/v%.o $(B)/test/gpio/v%_fake.o $(B)/posix/test/gpio/chip.o \
                        $(B)/posix/test/support.o $(filter-out %/main.o %/loop.o,$(cli_obj) $(dev_obj)) $(B)/test/loop.o $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) -o $@ $^ -lcmocka $(cli_libs)
# The bytes of a stock glove's line, and the glove at its other end.
serial_obj := $(patsubst %.c,$(B)/test/san/%.o,ports/posix/cyberglove.c ports/posix/emu/cyber.c test/support.c)
$(B)/test/san/test/serial/%.o $(serial_obj): tflags += -Iports/posix
$(B)/test/serial/%_test: $(B)/test/san/test/serial/%_test.o $(serial_obj)
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^ -lcmocka
gpio_fake = $(Q)mkdir -p $(@D) && $(CC) $(base) $(PORT_HOSTFLAGS) $(CFLAGS) -Itest/gpio/v$* -Itest/gpio -c $< -o $@
$(B)/test/gpio/v%.o: ports/posix/gpio_v%.c $(stamp)
	$(gpio_fake)
$(B)/test/gpio/v%_fake.o: test/gpio/v%/fake.c $(stamp)
	$(gpio_fake)
# The virtual world; rays into meshes where their package is.
$(B)/test/world/%_test: $(B)/posix/test/world/%_test.o $(B)/posix/test/support.o $(world_core_obj) $(world_mesh) \
                        $(B)/posix/examples/world/solo.o $(B)/posix/examples/world/link.o \
                        $(B)/posix/examples/world/link_param.o $(B)/posix/examples/world/link_trace.o $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) -o $@ $^ -lcmocka $(if $(world_rays),-ldl) -lm
$(B)/test/world/window_test: | $(world)
$(B)/posix/test/world/window_test.o: PORT_HOSTFLAGS += -DWORLD_PROGRAM='"$(world)"'
# The port contract, on the port that runs here.
$(B)/test/board/%_test: $(B)/posix/test/board/%_test.o $(B)/posix/test/board/posix.o $(B)/posix/test/support.o \
                        $(filter-out %/loop.o,$(sim_obj)) $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) -o $@ $^ -lcmocka -lm

# Golden vectors: the objects as they are shipped, at every rate.
golden_src := $(wildcard test/golden/*.c) examples/drop/drop.c examples/guarded/guarded.c examples/calib.c examples/glove/cal.c \
              $(wildcard examples/bilateral/*.c)
$(B)/test/golden/golden_test: $(golden_src:%.c=$(B)/posix/%.o) $(B)/posix/test/support.o $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) -o $@ $^ -lcmocka

## Every test that needs no more than a compiler and CMocka, in minutes
.PHONY: test
test:
	@.ci/deps "the tests" "$(CC) $(foreach h,stdarg stddef setjmp stdint cmocka,-include $h.h) -fsyntax-only -xc /dev/null" libcmocka-dev || exit 3
	@.ci/deps "the tests of Modbus" "test -f /usr/include/modbus/modbus.h" libmodbus-dev || true
	@.ci/deps "lines of a GPIO chip" "test -f /usr/include/gpiod.h" libgpiod-dev || true
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(test_bin)
	@JOBS=$(jobs) test/run.sh $(test_bin)

## Intervals of the analysis over 10^4 synthetic runs: coverage, and bias to k
.PHONY: coverage
coverage:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/test/sim/coverage_test
	@LIMIT=86400 EXH_CASES=10000000 test/run.sh $(B)/test/sim/coverage_test

# Stiff and extreme cases, under sanitizers: a build of its own.
stress_obj := $(patsubst %.c,$(B)/posix/%.o,$(wildcard test/stress/*.c))
$(B)/test/stress: $(stress_obj) $(filter-out %/main.o %/loop.o %/scene_none.o,$(cli_obj) $(sim_obj)) $(custom_obj) \
                  $(call model_objects,examples/custom/wall_ert_rtw,$(call slot_built,examples/custom/wall_ert_rtw)) \
                  $(B)/test/loop.o $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(cli_libs)

# What theory says of the sampled wall, of filters at rest and of drift, against the library's code.
stability_obj := $(patsubst %.c,$(B)/posix/%.o,$(wildcard test/stability/*.c) ports/posix/sim/eigen.c ports/posix/sim/linear.c)
$(B)/test/stability: $(stability_obj) $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ -lm

.PHONY: stability-built
stability-built: $(B)/test/stability

## Stability against theory: maps, the plane of steps and friction, filters at rest, drift (ARGS="--full map", CSV in build/stability)
.PHONY: stability
stability:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/test/stability
	@mkdir -p $(B)/stability
	@$(B)/test/stability --out $(B)/stability $(ARGS)

STRESS_TICKS ?= 1000000
STRESS_CASES ?= 100000000
STRESS_PARTS := 8
prop_bin     := $(filter $(B)/test/prop/%,$(test_bin))

## Stiff and extreme cases: what must hold and what held; laws at 10^8 random cases each
.PHONY: stress
stress:
	@$(MAKE) --no-print-directory B=$(B)/san CFLAGS="$(san)" LDFLAGS="$(san)" $(if $(V),,-s) $(B)/san/test/stress
	@$(B)/san/test/stress $(STRESS_TICKS)
	@$(MAKE) --no-print-directory B=$(B)/san CFLAGS="$(san)" LDFLAGS="$(san)" $(if $(V),,-s) $(B)/san/test/stability
	@$(B)/san/test/stability --short
	@$(MAKE) --no-print-directory stability ARGS=--full
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(prop_bin)
	@echo "laws at $(STRESS_CASES) random cases each, under sanitizers, dealt to $(STRESS_PARTS) processes:"
	@LIMIT=86400 EXH_CASES=$(STRESS_CASES) PARTS=$(STRESS_PARTS) JOBS=$$(nproc) test/run.sh $(prop_bin)

# The same cases, fewer ticks of each, without sanitizers: so that what judges the scene does not fall behind it.
.PHONY: stress-short
stress-short:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/test/stress
	@$(B)/test/stress 10000 > $(B)/stress.txt || { grep -A 1 FAIL $(B)/stress.txt; tail -n 1 $(B)/stress.txt; exit 1; }
	@$(MAKE) --no-print-directory stability ARGS=--short >> $(B)/stress.txt || { grep FAIL $(B)/stress.txt; exit 1; }
	@echo "stress, short: $$(grep -c '| ok$$' $(B)/stress.txt) cases ok"

## Make the golden vectors anew from the model of docs/NUMERICS.md (ARGS=--check: compare only)
.PHONY: golden
golden:
	$(Q)test/golden/golden.py $(or $(ARGS),--all)

## Change each module in small ways: the golden vectors must tell at 95 % of the rates
.PHONY: mutants
mutants: $(B)/test/golden/golden_test
	$(Q)CC="$(CC)" B=$(B) test/golden/mutants.py $(ARGS)

## Errors planted in the library's safety: exhand faults must tell each (ARGS="--some 8": every eighth)
.PHONY: faults-mutants
faults-mutants: $(exhand)
	$(Q)CC="$(CC)" test/sim/faults_mutants.py $(ARGS) $(cli_obj) $(dev_obj) $(gpio_obj) $(B)/posix/libexhand.a $(cli_libs) $(gpio_libs)

# --- the matrix: the same tests on other CPUs, by other compilers (test/matrix/README.md) ---

# Two programs with a printer of their own, as CMocka is not there: golden vectors over the library as it is shipped, and all other
# tests that need no machine as one, over a library whose saturations are counted. SUITE_LINK links what CC compiled, SUITE_LTO is
# none, gcc or clang, SUITE_CFLAGS is for all but the golden vectors.
suite_def   := -D_POSIX_C_SOURCE=200809L -DEXH_CHECK_PLAIN
comma       := ,
suite_dirs  := unit prop cards emu $(if $(SUITE_METAL),,pc104)
# One of them looks at a box that was never opened: before all others of this program.
suite_first := test/cards/box_test.c
suite_test  := $(suite_first) $(filter-out $(suite_first),$(filter $(suite_dirs:%=test/%/%),$(test_src)))
suite_src   := $(sort $(lib_src) test/support.c $(cards_src) $(emu_src) test/cards/bus.c test/cards/rig.c $(if $(SUITE_METAL),,test/pc104/frames.c ports/pc104/net.c))
suite_group  = $(subst /,_,$(1:test/%_test.c=%))
suite_lto   := $(if $(filter gcc clang,$(SUITE_LTO)),-flto)
suite_link  := $(or $(SUITE_LINK),$(CC))
# Without a C library: start, memory's functions and the compiler's helpers (SUITE_METAL: test/matrix/NAME.c).
suite_metal := $(if $(SUITE_METAL),$(patsubst %,$(B)/suite/metal/%.o,test/matrix/$(SUITE_METAL) ports/mps2/mem))
suite_bare  := -nostdlib -Wl,--build-id=none -Wl,--no-enum-size-warning -Wl,-z,noexecstack
suite_libs  := $(if $(SUITE_METAL),$(suite_bare) -T test/matrix/$(SUITE_METAL).ld -lgcc)
suite_def   += $(if $(SUITE_METAL),-ffreestanding -DEXH_CHECK_PUTCHAR=metal_putchar $(if $(filter avr,$(SUITE_METAL)),,-DEXH_CHECK_ENV=metal_env))

$(B)/suite/plain/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(CFLAGS) $(suite_lto) -Itest $(suite_def) -c $< -o $@
$(B)/suite/audit/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(tflags) $(suite_lto) $(SUITE_CFLAGS) $(suite_def) -c $< -o $@
$(B)/suite/audit/test/cards/%.o $(B)/suite/audit/ports/cards/%.o: tflags += -Iports
$(B)/suite/audit/test/pc104/%.o $(B)/suite/audit/ports/pc104/%.o: tflags += -Iports -Itest/pc104
$(B)/suite/metal/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(suite_link) $(base) $(CFLAGS) -ffreestanding -c $< -o $@
# Each test's main under its folder and name.
$(B)/suite/audit/%_test.o: tflags += -Dmain=suite_$(call suite_group,$*.c) -Wno-missing-prototypes
$(B)/suite/groups.inc: FORCE
	@mkdir -p $(@D)
	@printf 'GROUP(%s)\n' $(foreach t,$(suite_test),$(call suite_group,$t)) > $@.new
	@cmp -s $@.new $@ || cp $@.new $@
$(B)/suite/audit/test/matrix/suite.o: $(B)/suite/groups.inc
$(B)/suite/audit/test/matrix/suite.o: tflags += -I$(B)/suite

# AVR: an image a module, which says its digests and compares none; those that do not fit are SUITE_WITHOUT. What runs them
# has 63 KiB of memory for avr_large.
avr_src    := $(filter-out $(patsubst %,test/golden/%.c,digests golden_test explain $(SUITE_WITHOUT)),$(golden_src) test/support.c $(lib_src))
avr_module := $(filter-out $(SUITE_WITHOUT),$(patsubst test/golden/digest/%.inc,%,$(sort $(wildcard test/golden/digest/*.inc))))
avr_large  := bilateral precontact
avr_link   := -Wl,--gc-sections -Wl,--defsym=__DATA_REGION_LENGTH__=0xFF00
$(B)/suite/avr/%.elf: test/matrix/avr.c $(patsubst %.c,$(B)/suite/plain/%.o,$(avr_src))
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(CFLAGS) $(suite_lto) -Itest -Itest/golden $(suite_def) -DMETAL_MODULE=$* -c $< -o $(@:.elf=.main.o)
	$(Q)$(CC) -O$(O) $(CFLAGS) $(suite_lto) $(avr_link) $(if $(filter $*,$(avr_large)),-Wl$(comma)--defsym=__stack=0xFFFF) \
	    -o $@ $(@:.elf=.main.o) $(filter %.o,$^)
# A size at which this compiler fails.
$(if $(filter avr,$(SUITE_METAL)),$(B)/suite/plain/test/golden/bilateral.o: suite_def += -O2)
$(B)/suite/avr_run: test/matrix/avr_run.c $(stamp)
	@mkdir -p $(@D)
	$(Q)gcc -std=gnu99 -O2 -Wall -Wextra -Werror -o $@ $< -lsimavr -lelf
$(B)/suite/images: $(avr_module:%=$(B)/suite/avr/%.elf) $(B)/suite/avr_run FORCE
	@echo $(filter %.elf,$^) > $@

$(B)/suite/golden: $(patsubst %.c,$(B)/suite/plain/%.o,$(golden_src) test/support.c $(lib_src))
$(B)/suite/tests: $(patsubst %.c,$(B)/suite/audit/%.o,$(suite_src) $(suite_test) test/matrix/suite.c)
$(B)/suite/golden $(B)/suite/tests: $(suite_metal)
ifeq ($(SUITE_LTO),clang)
	$(Q)test/matrix/lto.sh $@ "$(CC) -O$(O) $(CFLAGS)" $(filter-out $(suite_metal),$^)
	$(Q)$(suite_link) $(LDFLAGS) -o $@ $@.lto.o $(suite_metal) $(suite_libs)
else
	$(Q)$(suite_link) $(if $(suite_lto),-flto=1 -O$(O)) $(if $(filter $(CC),$(suite_link)),$(CFLAGS)) $(SUITE_CFLAGS) $(LDFLAGS) -o $@ $^ $(suite_libs)
endif

# For a 32-bit CPU; what overflows there and not in 64 bits traps. Every rate.
.PHONY: test-i686
test-i686:
	$(matrix) --only i686-gcc-O2 --trap --cases 100000

matrix = @MAKE="$(MAKE)" JOBS=$(jobs) test/matrix/matrix.py --dir $(B)/matrix

## Unit tests, laws and golden vectors on eight CPUs, by gcc and clang, -O0 -O2 -O3 -Os, with LTO: docs/MATRIX.md anew (ARGS="--only mips")
.PHONY: matrix
matrix:
	$(matrix) $(ARGS)

# 2001..20000 Hz of the modules whose digests are there, on the host.
.PHONY: matrix-beyond
matrix-beyond: $(B)/test/golden/golden_test
	@mkdir -p $(B)/matrix
	@JOBS=$(jobs) test/matrix/beyond.py $(B)/matrix $<

## Table II, an experiment of the full box and a run of faults on the eight CPUs: the host's digits and logs (ARGS="--only mips")
.PHONY: matrix-box
matrix-box: all
	@mkdir -p $(B)/box/host
	@$(exhand) drop --out $(B)/box/host --spread 20 > $(B)/box/host/table2.txt
	@$(exhand) calibrate --out $(B)/box/host/calibration > $(B)/box/host/calibration.txt
	@$(exhand) bilateral --out $(B)/box/host/bilateral > $(B)/box/host/bilateral.txt
	@$(exhand) glove --record $(B)/box/host/glove.exh --does poses --seconds 5 > $(B)/box/host/glove.txt
	@$(exhand) faults --rate 100 > $(B)/box/host/faults.txt
	@MAKE="$(MAKE)" JOBS=$(jobs) FAULTS=$(B)/box/host/faults.txt test/matrix/box.py $(B)/box $(ARGS)

# --- anything into the packet parser ------------------------------------------------------

FUZZ_SECONDS ?= 30
FUZZ_SEED    ?= 1
FUZZER       ?= plain
fuzz_src     := test/fuzz/wire_fuzz.c test/fuzz/driver.c

$(B)/fuzz/plain: $(fuzz_src:%.c=$(B)/test/san/%.o) $(lib_src:%.c=$(B)/test/san/%.o)
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^
$(B)/fuzz/libfuzzer: test/fuzz/wire_fuzz.c $(lib_src) $(wildcard lib/include/exhand/*.h) $(stamp)
	@mkdir -p $(@D)
	$(Q)clang $(filter-out -MMD -MP,$(base)) -D_POSIX_C_SOURCE=200809L $(san) -fsanitize=fuzzer -o $@ $(filter %.c,$^)

# Frames for the pc104 image's network card.
$(B)/fuzz/net: $(B)/test/san/test/fuzz/net_fuzz.o $(pc104_net)
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^
$(B)/fuzz/net-libfuzzer: test/fuzz/net_fuzz.c test/pc104/frames.c ports/pc104/net.c $(wildcard test/pc104/*.h ports/pc104/net.h) $(stamp)
	@mkdir -p $(@D)
	$(Q)clang $(filter-out -MMD -MP,$(base)) -Iports -Itest/pc104 -DFUZZ_NO_MAIN $(san) -fsanitize=fuzzer -o $@ $(filter %.c,$^)

# Requests for the Modbus slave.
$(B)/fuzz/modbus: $(B)/test/san/test/fuzz/modbus_fuzz.o $(lib_src:%.c=$(B)/test/san/%.o)
	@mkdir -p $(@D)
	$(Q)$(CC) $(san) -o $@ $^
$(B)/fuzz/modbus-libfuzzer: test/fuzz/modbus_fuzz.c $(lib_src) $(wildcard lib/include/exhand/*.h) $(stamp)
	@mkdir -p $(@D)
	$(Q)clang $(filter-out -MMD -MP,$(base)) -DFUZZ_NO_MAIN $(san) -fsanitize=fuzzer -o $@ $(filter %.c,$^)

## Hostile packets, frames and requests, under sanitizers (FUZZ_SECONDS=30 FUZZ_SEED=1 FUZZER=plain or libfuzzer)
.PHONY: fuzz
fuzz:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/fuzz/plain $(B)/fuzz/$(FUZZER) $(addsuffix $(if $(filter libfuzzer,$(FUZZER)),-libfuzzer),$(B)/fuzz/net $(B)/fuzz/modbus)
	@$(B)/fuzz/plain --check test/fuzz/corpus
ifeq ($(FUZZER),plain)
	@cd $(B)/fuzz && { ./net $(FUZZ_SECONDS) $(FUZZ_SEED) & net=$$!; ./modbus $(FUZZ_SECONDS) $(FUZZ_SEED) & modbus=$$!; } && \
	    ./plain $(FUZZ_SECONDS) $(FUZZ_SEED) $(CURDIR)/test/fuzz/corpus; packets=$$?; wait $$net && wait $$modbus && exit $$packets
else
	@mkdir -p $(B)/fuzz/found && cd $(B)/fuzz && ./libfuzzer -max_total_time=$(FUZZ_SECONDS) -max_len=1024 \
	    -print_final_stats=1 found $(CURDIR)/test/fuzz/corpus
	@mkdir -p $(B)/fuzz/net-found && cd $(B)/fuzz && ./net-libfuzzer -max_total_time=$(FUZZ_SECONDS) -max_len=6000 \
	    -print_final_stats=1 net-found
	@mkdir -p $(B)/fuzz/modbus-found && cd $(B)/fuzz && ./modbus-libfuzzer -max_total_time=$(FUZZ_SECONDS) -max_len=2048 \
	    -print_final_stats=1 modbus-found
endif

.PHONY: fuzz-corpus
fuzz-corpus: $(B)/fuzz/plain
	@$(B)/fuzz/plain --write test/fuzz/corpus

## Prove the tick path, module by module (ARGS="--only gate", --update, --table; test/proof)
.PHONY: proof
proof:
	@test/proof/proof.py --out $(B)/proof $(ARGS)

# That the record is whole and of these sources, and what is cheap of it once more; by what can be had here.
.PHONY: proof-ci
proof-ci:
	@.ci/deps "proofs by Frama-C" frama-c frama-c-base || true
	@.ci/deps "proofs by z3" 'python3 -c "import z3"' python3-z3 || true
	@test/proof/proof.py --out $(B)/proof --ci

# --- every condition of the library and of the drivers of the cards -------------------------

# Both as shared objects with counters, so that what the tests say of them is in one place; the tests too: they call
# inline functions of the headers.
mcdc_cc    := clang-19
mcdc_flags  = $(filter-out -O$(O),$(base)) -O1 $(PORT_HOSTFLAGS) -Itest -Iports -DEXH_FIX_AUDIT -fPIC -fprofile-instr-generate \
              -fcoverage-mapping -fcoverage-mcdc
# A decision that this compiler does not count (!(a && b)) is to be written otherwise; in tests it may stand.
mcdc_never := no such message
$(B)/mcdc/obj/lib/%.o $(B)/mcdc/obj/ports/%.o: mcdc_never := unsupported MC/DC
mcdc_bin   := $(patsubst test/%_test.c,$(B)/mcdc/%_test,$(filter test/unit/% test/prop/% test/cards/% test/golden/%,$(test_src)))
mcdc_fuzz  := $(B)/mcdc/fuzz/wire
mcdc_probe := for t in clang-19 llvm-cov-19 llvm-profdata-19 python3; do command -v $$t || exit; done; ls /usr/lib/llvm-19/lib/clang/19/lib/linux/libclang_rt.profile*
mcdc_obj    = $(patsubst %.c,$(B)/mcdc/obj/%.o,$(1))
$(B)/mcdc/obj/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(mcdc_cc) $(mcdc_flags) -c $< -o $@ 2> $@.said && ! grep -q "$(mcdc_never)" $@.said || { cat $@.said; rm -f $@; exit 1; }
$(B)/mcdc/libexhand.so: $(call mcdc_obj,$(lib_src))
$(B)/mcdc/libcards.so: $(call mcdc_obj,$(cards_src))
$(B)/mcdc/lib%.so:
	$(Q)$(mcdc_cc) -shared -fprofile-instr-generate -o $@ $^
$(mcdc_bin): $(B)/mcdc/%_test: $(B)/mcdc/obj/test/%_test.o $(call mcdc_obj,test/support.c) $(B)/mcdc/libexhand.so
$(filter $(B)/mcdc/cards/%,$(mcdc_bin)): $(call mcdc_obj,test/cards/bus.c test/cards/rig.c) $(B)/mcdc/libcards.so
$(B)/mcdc/golden/golden_test: $(call mcdc_obj,$(golden_src))
$(B)/mcdc/fuzz/wire: $(call mcdc_obj,$(fuzz_src))
$(mcdc_fuzz): $(B)/mcdc/libexhand.so
$(mcdc_bin) $(mcdc_fuzz):
	@mkdir -p $(@D)
	$(Q)$(mcdc_cc) -fprofile-instr-generate -o $@ $(sort $^) -Wl,-rpath,$(abspath $(B)/mcdc) -lcmocka

## Conditions of lib/ and ports/cards that no test decides by (MC/DC), beside test/mcdc/missing.txt
.PHONY: mcdc mcdc-built
mcdc:
	@.ci/deps "MC/DC" "$(mcdc_probe)" clang-19 llvm-19 libclang-rt-19-dev libcmocka-dev python3 || exit 3
	@$(MAKE) --no-print-directory $(if $(V),,-s) mcdc-built
	@test/mcdc/mcdc.py --build $(B)/mcdc --jobs $(jobs) --strict $(ARGS)
mcdc-built: $(mcdc_bin) $(mcdc_fuzz)

# --- small errors planted everywhere in the library ----------------------------------------

# The tests beside the library as a shared object: a mutant is one source of it, preloaded.
mutation_flags = $(filter-out -O$(O) -g,$(base)) -O1 $(PORT_HOSTFLAGS) -Itest -DEXH_FIX_AUDIT -fPIC
mutation_bin   := $(patsubst test/%_test.c,$(B)/mutation/%_test,$(filter test/unit/% test/prop/% test/golden/%,$(test_src)))
mutation_obj    = $(patsubst %.c,$(B)/mutation/obj/%.o,$(1))
$(B)/mutation/obj/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(mutation_flags) -c $< -o $@
$(B)/mutation/libexhand.so: $(call mutation_obj,$(lib_src))
	$(Q)$(CC) -shared -o $@ $^
$(mutation_bin): $(B)/mutation/%_test: $(B)/mutation/obj/test/%_test.o $(call mutation_obj,test/support.c) $(B)/mutation/libexhand.so
$(B)/mutation/golden/golden_test: $(call mutation_obj,$(golden_src))
$(mutation_bin):
	@mkdir -p $(@D)
	$(Q)$(CC) -o $@ $(filter %.o,$^) $(filter %.so,$^) -Wl,-rpath,$(abspath $(B)/mutation) -lcmocka

## Small errors planted all over lib/src: the unit tests, laws and golden vectors of a source must tell 95 of 100 (ARGS="--sample 30 quad")
.PHONY: mutation mutation-built
mutation:
	@$(MAKE) --no-print-directory $(if $(V),,-s) mutation-built
	@CC="$(CC)" test/mutation/mutation.py --build $(B)/mutation --jobs $(jobs) $(ARGS)
mutation-built: $(mutation_bin)

# --- the pc104 image in the loop ----------------------------------------------------------

HIL_TICKS ?= 1000000
HIL_FEW   ?= 10000
HIL_QEMU  ?= 100000

unicorn := $(abspath $(B))/unicorn
hil_obj := $(patsubst %.c,$(B)/posix/%.o,$(wildcard test/hil/*.c) examples/deadman.c)
$(filter $(B)/posix/test/hil/%,$(hil_obj)): PORT_HOSTFLAGS += -isystem $(unicorn)/include
$(B)/test/hil: $(hil_obj) $(filter-out %/main.o,$(cli_obj)) $(sim_obj) $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(unicorn)/lib/libunicorn.so.2 -Wl,-rpath,$(unicorn)/lib $(cli_libs)

# An image with the emulated cards in the place of port instructions.
hil_inside := PORT=pc104 CARDS=inside cards_inside="$(wildcard ports/cards/*.c) $(emu_src) test/hil/inside/inside.c"

## The pc104 images in closed loop under processor emulators (HIL_TICKS=1000000 HIL_FEW=10000 HIL_QEMU=100000)
.PHONY: hil hil-built hil-run
hil: hil-built
	@$(hil_run)
hil-built:
	@B=$(B) test/hil/unicorn.sh
	@for t in i686-linux-gnu-gcc qemu-system-i386; do .ci/deps "the pc104 image" $$t gcc-i686-linux-gnu qemu-system-x86 || exit 3; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/test/hil $(exhand)
	@for s in minimal drop bilateral slow contract; do $(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=$$s all || exit 1; done
	@for s in drop bilateral contract; do $(MAKE) --no-print-directory $(if $(V),,-s) $(hil_inside) SCENE=$$s all || exit 1; done
hil_run = B=$(B) TICKS=$(HIL_TICKS) FEW=$(HIL_FEW) QEMU=$(HIL_QEMU) test/hil/hil.sh $(ARGS)
hil-run:
	@$(hil_run)

# --- strangers' drivers ---------------------------------------------------------------------

# The host program with Linux's drivers of the cards in the place of ours, and cards that are outside.
strangers_obj := $(B)/posix/test/strangers/cards.o $(B)/posix/test/strangers/guest/linux.o
$(B)/posix/exhand-linux: $(cli_obj) $(filter-out %/ports/posix/cards.o,$(sim_obj)) $(strangers_obj) $(B)/posix/libexhand.a
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(cli_libs)

.PHONY: linux-program
linux-program:
	@$(MAKE) --no-print-directory B=$(B)/variant/i686-O3 $(v_i686-O3) $(B)/variant/i686-O3/posix/exhand-linux

## Debian's own drivers of the cards, in Debian's kernel, against the emulators (fetches 60 MB; nightly)
.PHONY: strangers
strangers:
	@.ci/deps "strangers' drivers" "command -v clang && command -v i686-linux-gnu-gcc && command -v node && command -v npm" \
	    clang gcc-i686-linux-gnu libc6-dev-i386-cross nodejs npm || exit 3
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(exhand)
	@$(MAKE) --no-print-directory $(if $(V),,-s) linux-program
	@B=$(B) ARGS="$(ARGS)" test/strangers/strangers.sh

## Registers of the running box: mbpoll and pymodbus by TCP and a serial line, 10^6 reads none torn, 10^6 requests as the library's slave
.PHONY: modbus
modbus:
	@.ci/deps "Modbus" "test -f /usr/include/modbus/modbus.h && command -v mbpoll && command -v python3" libmodbus-dev mbpoll python3 python3-pip || exit 3
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(exhand) $(B)/test/sim/modbus_reads_test $(B)/test/sim/modbus_fuzz_test
	@B=$(B) test/modbus/modbus.sh

# The host program for an emulated Linux, with either libgpiod in it.
gpio_src := $(filter-out ports/posix/cli/modbus_%.c,$(cli_src)) $(wildcard ports/posix/cli/modbus_mail.c ports/posix/cli/modbus_none*.c)
gpio_all := $(gpio_src:%.c=$(B)/posix/%.o) $(world_core:%.c=$(B)/posix/%.o) $(B)/posix/examples/world/mesh_none.o $(dev_obj)
$(B)/gpio/gpio_v%.o: ports/posix/gpio_v%.c $(stamp)
	$(Q)$(CC) $(base) $(PORT_HOSTFLAGS) -isystem $(B)/gpio/v$* -c $< -o $@
$(B)/gpio/exhand-v%: $(gpio_all) $(B)/gpio/gpio_v%.o $(B)/posix/libexhand.a
	$(Q)$(CC) -static -o $@ $^ $(B)/gpio/v$*/libgpiod.a -lpthread -lm && strip $@

## Contacts and outputs on the kernel's simulated GPIO chip in an emulated Linux, by both libgpiod (fetches 220 MB; nightly)
.PHONY: gpio
gpio: all
	@.ci/deps "the emulated Linux" "command -v qemu-system-x86_64 && command -v gcc-12 && command -v xz && ls /usr/lib/x86_64-linux-gnu/libelf.so.1" \
	    qemu-system-x86 gcc-12 xz-utils libelf1 || exit 3
	@test/gpio/fetch.sh $(B)/gpio
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/gpio/exhand-v1 $(B)/gpio/exhand-v2
	@B=$(B) test/gpio/gpio.sh

# --- the same bits everywhere -----------------------------------------------------------

# Host programs by other compilers, optimisations and for 32 bits: name, CC, flags.
v_gcc-O0   := CC=gcc O=0
v_gcc-O3   := CC=gcc O=3
v_clang-O0 := CC=clang O=0
v_clang-O3 := CC=clang O=3
v_i686-O0  := CC=i686-linux-gnu-gcc O=0 CFLAGS="-msse2 -mfpmath=sse" LDFLAGS=-static
v_i686-O3  := CC=i686-linux-gnu-gcc O=3 CFLAGS="-msse2 -mfpmath=sse" LDFLAGS=-static
clang_i686 := clang --target=i686-linux-gnu -isystem /usr/i686-linux-gnu/include
v_i686-clang-O0 := CC="$(clang_i686)" O=0 CFLAGS="-msse2 -mfpmath=sse" LDFLAGS=-static
v_i686-clang-O3 := CC="$(clang_i686)" O=3 CFLAGS="-msse2 -mfpmath=sse" LDFLAGS=-static
variants   := $(patsubst v_%,%,$(filter v_%,$(.VARIABLES)))

.PHONY: $(variants:%=variant-%)
$(variants:%=variant-%): variant-%:
	@$(MAKE) --no-print-directory B=$(B)/variant/$* $(v_$*) WERROR=1 all

# Golden vectors by the compilers that link CMocka; a tenth of the rates.
.PHONY: $(variants:%=golden-%)
$(variants:%=golden-%): golden-%:
	@$(MAKE) --no-print-directory -s B=$(B)/variant/$* $(v_$*) WERROR=1 $(B)/variant/$*/test/golden/golden_test
	@echo "$*:" && EXH_RATES=1..200 test/run.sh $(B)/variant/$*/test/golden/golden_test

# The library alone for small CPUs: what it needs from outside.
u_cortex-m3 := CROSS=arm-none-eabi- CFLAGS="-mcpu=cortex-m3 -mthumb -ffreestanding"
u_cortex-m0 := CROSS=arm-none-eabi- CFLAGS="-mcpu=cortex-m0 -mthumb -ffreestanding" \
               PORT_HELPERS="__aeabi_lmul __aeabi_llsl __aeabi_llsr __aeabi_lasr"

.PHONY: undef-cortex-m3 undef-cortex-m0
undef-cortex-m3 undef-cortex-m0: undef-%:
	@$(MAKE) --no-print-directory PORT=template B=$(B)/$* $(u_$*) undef

check_tools := clang i686-linux-gnu-gcc arm-none-eabi-gcc qemu-system-i386 qemu-system-arm valgrind python3
check_pkgs  := clang gcc-i686-linux-gnu libc6-dev-i386-cross gcc-arm-none-eabi qemu-system-x86 qemu-system-arm valgrind python3

## What CI runs after `test`: other compilers and CPUs, mutants, the pc104 image, sizes, costs
.PHONY: check
check: export WERROR = 1
check:
	@for t in $(check_tools); do .ci/deps "the checks" $$t $(check_pkgs) || exit 3; done
	@$(timed) all
	@$(timed) matrix ARGS=--ci
	@$(timed) golden ARGS="--check --every 40"
	@$(timed) mutants ARGS="--some 4"
	@$(timed) mcdc
	@$(timed) proof-ci
	@$(timed) fuzz
	@$(timed) demo > $(B)/demo.txt && tail -n 40 $(B)/demo.txt
	@$(timed) $(variants:%=variant-%)
	@$(timed) linux-program
	@$(timed) link porting
	@$(timed) $(patsubst %,golden-%,$(filter-out i686%,$(variants)))
	@$(timed) bits
	@$(timed) undef undef-cortex-m3 undef-cortex-m0
	@$(timed) PORT=pc104 SCENE=minimal undef undef-emu
	@$(timed) PORT=template SCENE=minimal all
	@$(timed) fmu $(B)/fmi/native
	@$(timed) world boot-built contract-built nic-built hil-built
	@$(timed) $(check_runs)
	@$(timed) stress-short
	@$(timed) size
	@$(timed) fmt-check
	@$(timed) doc doc-names
	@$(timed) bench
	@$(timed) report-test
	@$(timed) report ARGS=--short

# What runs built images and programs, one core each: as many at a time as there are cores.
check_runs := boot-run hil-short nic-run contract-run two-run fmi-run picture
.PHONY: hil-short picture bits
hil-short:
	@$(MAKE) --no-print-directory hil-run HIL_TICKS=2000 HIL_FEW=500 HIL_QEMU=2000 > $(B)/hil.txt || { cat $(B)/hil.txt; exit 1; }
	@grep -cE '^  ok' $(B)/hil.txt | sed 's/^/hil, short: ok: /'
picture:
	@$(world) --headless --script --seconds 1 --scene examples/world/scenes/collision.world --png $(B)/world.png || [ $$? = 3 ]
bits:
	@$(exhand) faults --rate 100 > $(B)/faults_100Hz.txt
	@JOBS=$(jobs) FAULTS=$(B)/faults_100Hz.txt test/sim/bits.sh $(B)/bits $(B)/demo $(variants:%=$(B)/variant/%/posix/exhand)

# A make of its own, and what it took.
timed = +bash -c 'TIMEFORMAT="took: %0R s, %0U + %0S s of a core: $$*"; time "$$@"' make $(MAKE) --no-print-directory -s

boot_scenes := minimal drop glove bilateral calibrate bringup custom

## Boot images of PORT=pc104 under QEMU, from an ISO too: what must end well, safe or refused
.PHONY: boot boot-built boot-run
boot: boot-built
	@$(boot_run)
boot-built: all
	@.ci/deps "booting" qemu-system-i386 qemu-system-x86 || exit 3
	@for c in real none; do for s in $(boot_scenes); do \
	    $(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=$$s CARDS=$$c all || exit; done; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=custom MODEL=test/slot/rude_ert_rtw CARDS=none all
	@$(MAKE) --no-print-directory $(if $(V),,-s) SCENE=custom all
	@$(MAKE) --no-print-directory -s PORT=pc104 SCENE=drop CARDS=none image ARGS="ticks=500 k=1000 uncalibrated=1 idle=spin"
boot_run = EXHAND=$(exhand) test/pc104/boot.sh $(B)/pc104
boot-run:
	@$(boot_run)

contract_images := mps2/minimal mps2/contract mps2/contract_slow mps2/contract_fast mps2/overflow \
                   pc104/contract pc104/contract_slow pc104/overflow template/contract
# Scene minimal frozen, and frozen for another rate than it runs at; and what it codes, frozen and not. TICKS: of all
# alike, or each would be compiled anew for the other.
contract_frozen := FROZEN=1000 FROZEN=2000
frozen_digest   := TICKS=2000 PORT_SUFFIX=-digest SCENE_MAIN="test/frozen/digest.c examples/loop.c" SCENE_CFLAGS=-DSAY=mps2_say

## The port contract (test/board) and fault handlers on images under QEMU; `test` and `hil` run it too
.PHONY: contract contract-built contract-run
contract: contract-built
	@$(contract_run)
contract-built:
	@for t in arm-none-eabi-gcc qemu-system-arm i686-linux-gnu-gcc qemu-system-i386; do .ci/deps "the port contract" $$t \
	    gcc-arm-none-eabi qemu-system-arm gcc-i686-linux-gnu qemu-system-x86 || exit 3; done
	@for i in $(contract_frozen); do $(MAKE) --no-print-directory $(if $(V),,-s) PORT=mps2 SCENE=minimal $$i all || exit; done
	@for i in FROZEN= FROZEN=1000; do $(MAKE) --no-print-directory $(if $(V),,-s) PORT=mps2 SCENE=minimal $$i $(frozen_digest) all || exit; done
	@for i in $(contract_images); do \
	    $(MAKE) --no-print-directory $(if $(V),,-s) PORT=$${i%/*} SCENE=$${i#*/} CARDS=none all || exit; done
contract_run = test/board/contract.sh $(B)
contract-run:
	@$(contract_run)

# The other end of the image's network cable, and the image with a log at its cards' connectors.
$(B)/test/cable: test/pc104/cable.c test/pc104/frames.c test/pc104/frames.h ports/pc104/net.h $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(CFLAGS) -D_POSIX_C_SOURCE=200809L -Iports $(filter %.c,$^) $(LDFLAGS) -o $@
nic_tape := PORT=pc104 SCENE=bilateral CARDS=tape cards_tape="$(wildcard ports/cards/*.c) $(emu_src) test/pc104/tape.c"

NIC_FRAMES ?= 20000
NIC_SPEEDS ?= natural
NIC_APPROACHES ?= 1

## The pc104 image's network under QEMU: experiment, bad frames (NIC_FRAMES=1000000 NIC_SPEEDS=slow,natural,fast)
.PHONY: nic nic-built nic-run
nic: nic-built
	@$(nic_run)
nic-built: all
	@for t in i686-linux-gnu-gcc qemu-system-i386; do .ci/deps "the pc104 image's network" $$t gcc-i686-linux-gnu qemu-system-x86 || exit 3; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(B)/test/cable $(world)
	@for s in minimal drop bilateral; do $(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=$$s CARDS=none all || exit; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(nic_tape) all
nic_run = B=$(B) FRAMES=$(NIC_FRAMES) SPEEDS=$(NIC_SPEEDS) APPROACHES=$(NIC_APPROACHES) test/pc104/nic.sh $(or $(ARGS),ways bilateral flood dump)
nic-run:
	@$(nic_run)

## The pc104 image's Modbus slave under QEMU: a master of its own, options, no tick missed
.PHONY: modbus-image
modbus-image: all
	@for t in i686-linux-gnu-gcc qemu-system-i386 python3; do .ci/deps "the pc104 image's Modbus slave" $$t gcc-i686-linux-gnu qemu-system-x86 python3 || exit 3; done
	@$(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=drop CARDS=none all
	@$(MAKE) --no-print-directory $(if $(V),,-s) PORT=pc104 SCENE=guarded CARDS=none all
	@B=$(B) test/pc104/modbus.sh $(ARGS)

# --- figures ------------------------------------------------------------------------

## What the library needs from outside; no float or divide instruction, recursion or memory of its own
.PHONY: undef
undef: $(lib)
	$(Q)test/size/undef.sh $(lib) $(CROSS)nm $(PORT_HELPERS)
	$(Q)test/size/banned.sh $(lib) $(CROSS)objdump
	$(Q)test/size/habits.sh $(lib) $(CROSS)objdump

# The emulated cards, as they go into an image.
$(out)/libemu.a: $(emu_src:%.c=$(out)/%.o)
	$(Q)rm -f $@ && $(CROSS)ar rcD $@ $^
.PHONY: undef-emu
undef-emu: $(out)/libemu.a
	$(Q)test/size/undef.sh $< $(CROSS)nm $(PORT_HELPERS)

## Bytes, stack, instructions per tick and library symbols of each scene and port
.PHONY: size
size:
	$(Q)MAKE="$(MAKE)" B=$(B) test/size/size.sh

## Which modules a scene links and why, what a finger, glove, link, log, ... add: build/size/costs (ARGS=--update)
.PHONY: costs
costs:
	@.ci/deps "the costs" python3 python3 || exit 3
	$(Q)B=$(B) test/size/costs.py $(ARGS)

# Objects as they are shipped: no sanitizer, no audit hook. Linked without debug information,
# which not every valgrind reads of every compiler; its profile needs the symbols alone.
bench_obj := $(patsubst %,$(B)/posix/test/bench/%.o,kernels measure number estimate force path law filter glove hand precontact passivity scene minimal modbus params tick box)
bench_scenes := examples/drop/drop.c examples/calib.c examples/glove/cal.c $(wildcard examples/bilateral/*.c)
bench_bin := $(B)/bench/kernels $(B)/bench/velocity $(B)/bench/speed
$(B)/posix/test/bench/kernels.o: PORT_HOSTFLAGS += -DBENCH_FLAGS='"-std=c99 -O$(O)$(if $(CFLAGS), $(CFLAGS))"'
$(B)/bench/kernels: $(bench_obj) $(B)/posix/test/no_board.o $(bench_scenes:%.c=$(B)/posix/%.o)
$(B)/bench/velocity: $(B)/posix/test/bench/velocity.o $(B)/posix/test/bench/measure.o $(B)/posix/test/bench/plain.o
$(B)/bench/speed: $(B)/posix/test/bench/speed.o $(B)/posix/examples/drop/drop.o $(B)/posix/examples/calib.o $(sim_obj)
$(bench_bin): $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(filter %.a,$^) -Wl,--strip-debug -lm

# Ways to integrate the simulator's plant; the second has the whole simulator, with its plant from there.
sim_bench_obj := $(patsubst %,$(B)/posix/test/bench/sim/%.o,method semi leapfrog flow wide)
$(B)/bench/sim_work: $(B)/posix/test/bench/sim/work.o $(sim_bench_obj) $(B)/posix/ports/posix/sim/device.o
$(B)/bench/sim_statistics: $(B)/posix/test/bench/sim/statistics.o $(sim_bench_obj) \
                           $(filter-out %/main.o %/sim/plant.o,$(cli_obj) $(sim_obj)) $(B)/posix/libexhand.a
$(B)/bench/sim_work $(B)/bench/sim_statistics:
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(cli_libs) -Wl,--strip-debug
.PHONY: sim-built
sim-built: $(B)/bench/sim_work $(B)/bench/sim_statistics

# The kernels again for a 32-bit CPU, where only instructions are counted: the same flags, static.
bench_i686 := $(B)/bench/kernels-i686
i686_src   := $(patsubst $(B)/posix/%.o,%.c,$(filter-out %/velocity.o,$(bench_obj))) test/no_board.c $(bench_scenes) $(lib_src)
$(bench_i686): $(i686_src) $(wildcard test/bench/*.h lib/src/*.h lib/include/exhand/*.h test/wide.h) $(stamp)
	@mkdir -p $(@D)
	$(Q)i686-linux-gnu-gcc -static $(filter-out -MMD -MP -g,$(base)) $(PORT_HOSTFLAGS) $(CFLAGS) -Itest \
	    -o $@ $(filter %.c,$^) -lm

# Ours beside peers; CMSIS-DSP where peers.sh could fetch it. Same compiler and flags for all, but
# for warnings: others' code has its own.
cmsis     := $(B)/peers/cmsisdsp-1.10.3
biquad    := $(cmsis)/Source/FilteringFunctions/arm_biquad_cascade_
cmsis_src := $(foreach f,df1_q31 df1_fast_q31 df1_init_q31 df1_32x64_q31 df1_32x64_init_q31 df1_q15 df1_init_q15 \
             df2T_f32 df2T_init_f32 df2T_f64 df2T_init_f64,$(biquad)$f.c) \
             $(cmsis)/Source/ControllerFunctions/arm_sin_cos_q31.c $(cmsis)/Source/CommonTables/arm_common_tables.c \
             $(cmsis)/Source/FastMathFunctions/arm_sin_q31.c $(cmsis)/Source/FastMathFunctions/arm_cos_q31.c
peers_src := test/bench/peers.c test/bench/peers_plain.c test/bench/measure.c $(lib_src)
ifneq ($(wildcard $(cmsis)/.complete),)
peers_src += test/bench/peers_cmsis.c $(cmsis_src)
peers_def := -DPEERS_CMSIS -D__GNUC_PYTHON__ -isystem $(cmsis)/Include -isystem $(cmsis)/PrivateInclude
endif
# libfixmath, out of Debian's sources: its package holds a library built without optimisation, and for one CPU.
fixmath     := $(B)/peers/libfixmath-20220222
fixmath_src := test/bench/peers_fixmath_lut.c $(patsubst %,$(fixmath)/libfixmath/%.c,fix16 fix16_trig fix16_sqrt)
ifneq ($(wildcard $(fixmath)/.complete),)
peers_src += test/bench/peers_fixmath.c $(fixmath_src)
peers_def += -DPEERS_FIXMATH -DFIXMATH_NO_CACHE -isystem $(fixmath)/libfixmath
endif
# The crate idsp, where cargo could build it; for this CPU alone.
rust      := $(wildcard $(B)/peers/rust/release/libpeers.a)
peers     := $(B)/bench/peers
$(peers): peers_rust := $(if $(rust),-DPEERS_RUST test/bench/peers_rust.c $(rust) -lpthread -ldl)
$(peers): $(rust)
$(peers): peers_cc := $(CC)
$(peers)-i686: peers_cc := i686-linux-gnu-gcc -static
$(peers) $(peers)-i686: $(peers_src) $(wildcard $(cmsis)/.complete $(fixmath)/.complete test/bench/*.h lib/src/*.h lib/include/exhand/*.h) $(stamp)
	@mkdir -p $(@D)
	$(Q)$(peers_cc) $(filter-out $(warn) -MMD -MP -g,$(base)) -w $(PORT_HOSTFLAGS) $(CFLAGS) $(peers_def) -Itest \
	    -Wl,--gc-sections -o $@ $(filter %.c,$^) $(peers_rust) -lm

# Kernels of ours, of others and in plain floating point, for the report; built alike.
work     := $(B)/bench/work
work_src := $(filter-out %/work_cmsis.c %/work_fixmath.c,$(wildcard test/bench/work*.c)) $(addprefix test/bench/,plain.c law.c path.c measure.c) \
            examples/drop/drop.c examples/calib.c
ifneq ($(wildcard $(cmsis)/.complete),)
work_src += test/bench/work_cmsis.c $(wildcard $(cmsis)/Source/ControllerFunctions/arm_pid_*_q31.c \
            $(cmsis)/Source/ControllerFunctions/arm_pid_*_q15.c $(cmsis)/Source/ControllerFunctions/arm_pid_*_f32.c) \
            $(cmsis)/Source/CommonTables/arm_common_tables.c $(cmsis)/Source/FastMathFunctions/arm_sin_q31.c \
            $(cmsis)/Source/FastMathFunctions/arm_cos_q31.c $(cmsis)/Source/InterpolationFunctions/arm_linear_interp_q31.c
endif
ifneq ($(wildcard $(fixmath)/.complete),)
work_src += test/bench/work_fixmath.c $(fixmath_src)
endif
$(work): work_cc := $(CC)
$(work)-i686: work_cc := i686-linux-gnu-gcc -static
$(work): $(B)/posix/libexhand.a
$(work)-i686: $(lib_src)
$(work) $(work)-i686: $(work_src) $(wildcard $(cmsis)/.complete $(fixmath)/.complete test/bench/*.h lib/src/*.h lib/include/exhand/*.h) $(stamp)
	@mkdir -p $(@D)
	$(Q)$(work_cc) $(filter-out $(warn) -MMD -MP -g,$(base)) -w $(PORT_HOSTFLAGS) $(CFLAGS) $(peers_def) -Itest \
	    -Wl,--gc-sections -o $@ $(filter %.c,$^) $(filter %.a,$^) -lm

# Whole ticks of the scenes, beside the same in double and float.
scenes     := $(B)/bench/scenes
scenes_src := $(wildcard test/bench/scenes*.c) test/no_board.c $(addprefix test/bench/,pipe.c measure.c) examples/drop/drop.c examples/guarded/guarded.c \
              $(wildcard examples/glove/*.c examples/bilateral/*.c) examples/calib.c
$(scenes): scenes_cc := $(CC)
$(scenes)-i686: scenes_cc := i686-linux-gnu-gcc -static
$(scenes): $(B)/posix/libexhand.a
$(scenes)-i686: $(lib_src)
$(scenes) $(scenes)-i686: $(scenes_src) $(wildcard test/bench/*.h examples/*/*.h examples/*.h lib/src/*.h lib/include/exhand/*.h) $(stamp)
	@mkdir -p $(@D)
	$(Q)$(scenes_cc) $(filter-out -MMD -MP -g -Wdouble-promotion,$(base)) $(PORT_HOSTFLAGS) $(CFLAGS) -Itest \
	    -Wl,--gc-sections -o $@ $(filter %.c,$^) $(filter %.a,$^) -lm
.PHONY: scenes-csv
scenes-csv: $(scenes) $(if $(notdir $(shell command -v i686-linux-gnu-gcc)),$(scenes)-i686)
	@B=$(B) test/bench/scenes.sh

## Error and instructions of every kernel, beside test/bench/baseline.csv (ARGS=--update)
.PHONY: bench
bench:
	@.ci/deps "the benches" valgrind valgrind || exit 3
	@$(MAKE) --no-print-directory $(bench_bin)
	@B=$(B) test/bench/peers.sh fetch || true
	@B=$(B) test/bench/peers.sh fixmath || true
	@B=$(B) test/bench/peers.sh rust || true
	@$(MAKE) --no-print-directory $(peers)
	@if .ci/deps "the i686 counts" i686-linux-gnu-gcc gcc-i686-linux-gnu libc6-dev-i386-cross; then \
	    $(MAKE) --no-print-directory $(bench_i686) $(peers)-i686; else rm -f $(bench_i686) $(peers)-i686; fi
	@B=$(B) test/bench/bench.sh $(ARGS)
	@echo; B=$(B) test/bench/peers.sh table

# What the report draws of the bench; with SHORT what the last bench has left, if its binaries are no newer.
.PHONY: bench-csv
bench-csv:
	@[ -n "$$SHORT" ] && $(MAKE) --no-print-directory -s $(bench_bin) $(peers) && [ $(B)/bench/velocity.csv -nt $(B)/bench/velocity ] && \
	    [ $(B)/bench/sines.csv -nt $(peers) ] || $(MAKE) --no-print-directory bench ARGS=
	@$(MAKE) --no-print-directory -s $(work) $(if $(notdir $(shell command -v i686-linux-gnu-gcc)),$(work)-i686)
	@B=$(B) test/bench/work.sh

## Error against run time, stability, costs: pictures and one page in build/report (ARGS="--list", "--only NAME", "--short")
.PHONY: report
report:
	@.ci/deps "the report's pictures" gnuplot gnuplot-nox fonts-dejavu-core || true
	@test/report/report.py --build $(B) $(ARGS)

.PHONY: report-test
report-test:
	@PYTHONDONTWRITEBYTECODE=1 test/report/report_test.py

## Make the table of docs/CARDS.md anew: every misbehaviour of a card in every phase of its driver
.PHONY: cards
cards: all
	@$(exhand) cards > $(B)/cards.md
	@awk '/^<!-- end -->/ { skip = 0 } !skip { print } /^<!-- exhand cards -->/ { skip = 1; while ((getline line < "$(B)/cards.md") > 0) print line }' \
	    docs/CARDS.md > $(B)/CARDS.md.new && cp $(B)/CARDS.md.new docs/CARDS.md && tail -n 1 $(B)/cards.md

FAULTS_TIMES ?= 100000

## Every fault in every state, any fault at any tick: docs/FAULTS.md anew (FAULTS_TIMES=100000, ten minutes)
.PHONY: faults
faults: all
	@$(exhand) faults > $(B)/faults.md || { tail -n 3 $(B)/faults.md; exit 1; }
	@$(exhand) faults --rate 20000 > $(B)/faults_20kHz.md || { tail -n 3 $(B)/faults_20kHz.md; exit 1; }
	@$(exhand) faults --times $(FAULTS_TIMES) > $(B)/faults_times.md || { cat $(B)/faults_times.md; exit 1; }
	@awk -v a="$(B)/faults.md" -v b="$(B)/faults_times.md" 'function put(f, l) { skip = 1; while ((getline l < f) > 0) print l } \
	    /^<!-- end -->/ { skip = 0 } !skip { print } /^<!-- exhand faults -->/ { put(a) } /^<!-- exhand faults --times -->/ { put(b) }' \
	    docs/FAULTS.md > $(B)/FAULTS.md.new && cp $(B)/FAULTS.md.new docs/FAULTS.md
	@mkdir -p $(B)/faults && $(exhand) faults --out $(B)/faults && if command -v gnuplot >/dev/null; then \
	    (cd $(B)/faults && gnuplot -c faults.gp "$(CURDIR)/ports/posix/cli/plot") && cp $(B)/faults/faults.png docs/faults.png; fi
	@tail -n 1 $(B)/faults.md; tail -n 1 $(B)/faults_20kHz.md; grep 'times:' $(B)/faults_times.md

# --- keeping house ------------------------------------------------------------------

PREFIX     ?= /usr/local
LIBDIR     ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
DESTDIR    ?=

# The library as a shared one: all that lib/exhand.map names. Until 1.0 each minor version is an interface of its own.
soname := libexhand.so.$(word 1,$(subst ., ,$(version))).$(word 2,$(subst ., ,$(version)))
shared := $(out)/libexhand.so.$(version)
pic    := $(lib_src:%.c=$(out)/pic/%.o)
$(out)/pic/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(CFLAGS) -fPIC -c $< -o $@
$(shared): $(pic) lib/exhand.map
	$(Q)$(CC) $(PORT_CFLAGS) $(CFLAGS) -shared -Wl,-soname,$(soname) -Wl,--version-script=lib/exhand.map $(LDFLAGS) $(pic) -o $@

# What a program that links the library finds: libraries, headers, exhand.pc and the CMake package.
packages := $(DESTDIR)$(LIBDIR)/pkgconfig/exhand.pc $(patsubst %,$(DESTDIR)$(LIBDIR)/cmake/exhand/exhand-%.cmake,config config-version)
fill_in  := sed 's|@prefix@|$(PREFIX)|; s|@libdir@|$(LIBDIR:$(PREFIX)/%=$${prefix}/%)|; s|@includedir@|$(INCLUDEDIR:$(PREFIX)/%=$${prefix}/%)|; s|@version@|$(version)|; \
            s|@includedir_from_package@|'"$$(realpath -m --relative-to=$(LIBDIR)/cmake/exhand $(INCLUDEDIR))"'|'

## Sweeps of examples/sweep by GNU parallel, by ssh and by Slurm on this machine, against one process (nightly)
.PHONY: scale
scale: all
	@.ci/deps "GNU parallel" "command -v parallel && command -v rsync" parallel rsync || :
	@.ci/deps "ssh to this machine" "ls /usr/sbin/sshd" openssh-server openssh-client || :
	@.ci/deps "Slurm" "command -v sbatch && command -v slurmctld && command -v slurmd && command -v munged" slurm-client slurmctld slurmd munge || :
	@test/sweep/scale.sh $(B)/sweep

## docs/PORTING.md typed anew: a port from the template to a contract test that passes
.PHONY: porting
porting:
	@.ci/deps "a walk of docs/PORTING.md" "command -v arm-none-eabi-gcc && command -v qemu-system-arm" gcc-arm-none-eabi qemu-system-arm || exit 3
	@test/porting/walk.py $(B)/porting

## Each way of examples/link/README.md to link the library to a program: commands, seconds, bytes; and its ABI
.PHONY: link
link: $(lib)
	@.ci/deps "the ways to link" "command -v cmake && command -v pkg-config && command -v clang && command -v tcc && command -v g++ && python3 -c 'import ensurepip'" \
	    cmake pkg-config clang tcc g++ python3-venv || :
	@test/link/abi.py $(lib) gcc $(notdir $(shell command -v i686-linux-gnu-gcc))
	@test/link/package.sh $(B)/link/package
	@test/link/link.py $(B)/link $(ARGS)

## Install library (static; shared on posix), headers, exhand.pc and CMake package, host program under DESTDIR/PREFIX
.PHONY: install install-lib
install: all install-lib
	$(if $(filter posix,$(PORT)),install -d $(DESTDIR)$(PREFIX)/bin && install -m 755 $(program) $(DESTDIR)$(PREFIX)/bin)

## The same without the host program
install-lib: $(lib) $(if $(filter posix,$(PORT)),$(shared))
	install -d $(DESTDIR)$(LIBDIR)/pkgconfig $(DESTDIR)$(LIBDIR)/cmake/exhand $(DESTDIR)$(INCLUDEDIR)/exhand
	install -m 644 $(lib) $(DESTDIR)$(LIBDIR)
	install -m 644 lib/include/exhand/*.h $(DESTDIR)$(INCLUDEDIR)/exhand
	$(Q)for f in $(packages); do $(fill_in) lib/$$(basename $$f).in > $$f && chmod 644 $$f || exit 1; done
	$(if $(filter posix,$(PORT)),install -m 755 $(shared) $(DESTDIR)$(LIBDIR) && cd $(DESTDIR)$(LIBDIR) && \
	    ln -sf libexhand.so.$(version) $(soname) && ln -sf $(soname) libexhand.so)

## Both README commands in a fresh Debian with only git, make and a C compiler (root; RELEASE=bookworm, 12)
.PHONY: fresh
fresh:
	test/fresh/fresh.sh $(RELEASE)

## Each way of examples/link/README.md on a bare Debian 12: commands, packages, minutes, disk (root; ARGS=--update: its table anew)
.PHONY: fresh-ways
fresh-ways:
	test/fresh/ways.py $(B)/fresh/ways $(ARGS)

## The public headers as pages, build/doc/html: every symbol documented
.PHONY: doc
doc:
	@.ci/deps "$@" doxygen doxygen || exit 3
	@rm -rf $(B)/doc && mkdir -p $(B)/doc
	@{ cat docs/Doxyfile; echo 'OUTPUT_DIRECTORY = $(B)/doc'; echo 'PROJECT_NUMBER = $(version)'; } | doxygen - 2> $(B)/doc/warnings || true
	@if [ -s $(B)/doc/warnings ] || ! [ -s $(B)/doc/html/index.html ]; then cat $(B)/doc/warnings; echo "doc: not documented, or no pages" >&2; exit 1; fi
	@echo "$(B)/doc/html/index.html"

## Every command, option, file and test that the documents name is there, and every document, port, scene and test folder is listed
.PHONY: doc-names
doc-names: $(exhand)
	@PYTHONDONTWRITEBYTECODE=1 test/docs/docs.py $(exhand) $(world)

## Format every C source by .clang-format (clang-format 14)
.PHONY: fmt fmt-check
fmt_src = $(shell git ls-files '*.c' '*.h' | grep -v _ert_rtw/)
fmt:
	$(Q)clang-format -i $(fmt_src)
# Another version of the program lays some lines out in another way.
fmt-check:
	@.ci/deps "$@" clang-format clang-format || exit 3
	@clang-format --version | grep -q 'version 14' || { echo "$@: left out: this clang-format is not 14"; exit 0; }; \
	    clang-format --dry-run -Werror $(fmt_src)

## Draw the block diagrams in docs/ from the signal and device tables
.PHONY: diagrams
diagrams: all
	$(Q)for d in overview setup identification principle geometry bilateral; do $(exhand) diagram $$d > docs/$$d.svg || exit 1; done

## Remove everything that was built
.PHONY: clean
clean:
	rm -rf $(B)

.SECONDARY:
# Not of the machine that `make fresh` makes there.
-include $(shell find $(B) -path $(B)/fresh -prune -o -type f -name '*.d' -print 2>/dev/null)
