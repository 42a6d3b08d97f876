# SPDX-License-Identifier: MIT
# exhand: haptic-glove controller library, its ports, its experiments. Each folder brings its own
# part, NAME.mk. Variables for you: PORT SCENE FROZEN B O V CC CROSS CFLAGS LDFLAGS DEPS ARGS. `make
# help` lists the first targets.

PORT   ?= posix
SCENE  ?= drop
B      ?= build
O      ?= 2
ARGS   ?=
DEPS   ?= yes
WERROR ?=

ifneq ($(words [$(B)]) $(words $(B)),1 1)
$(error B="$(B)": the build folder must have a name without blanks)
endif

ports := $(notdir $(patsubst %/port.mk,%,$(wildcard ports/*/port.mk)))
$(if $(filter $(PORT),$(ports)),,$(error PORT=$(PORT): no such port: give one of $(ports)))
include ports/$(PORT)/port.mk
scene_dirs := examples test/image/hil test/port test/figures/bench
scene_mk   := $(or $(wildcard $(scene_dirs:%=%/$(SCENE)/scene.mk)),examples/$(SCENE)/scene.mk)
scenes     := $(notdir $(patsubst %/scene.mk,%,$(wildcard $(scene_dirs:%=%/*/scene.mk))))
$(if $(wildcard $(scene_mk)),,$(error SCENE=$(SCENE): no such scene: give one of $(scenes)))
include $(scene_mk)

# Any C compiler called cc will do. Goals that build install the port's compiler where they may, or
# name its packages.
PORT_PKGS ?= gcc libc6-dev
builds    := $(filter all image run demo test world lab,$(or $(MAKECMDGOALS),all))
ifeq ($(origin CC),default)
CC := $(CROSS)$(if $(or $(CROSS),$(shell command -v gcc)),gcc,cc)
ifeq ($(and $(builds),$(shell command -v $(CC)))$(if $(builds),,none),)
$(info $(shell DEPS=$(DEPS) .ci/deps "PORT=$(PORT)" $(CC) $(PORT_PKGS)))
$(if $(shell command -v $(CC)),,$(error PORT=$(PORT): no compiler $(CC)))
endif
endif
OBJCOPY ?= $(CROSS)objcopy
version := $(shell awk '/define EXH_VERSION_(MAJOR|MINOR|PATCH)/{v=v s $$3; s="."} END{print v}' \
           lib/include/exhand/exhand.h)
Q       := $(if $(V),,@)
out     := $(B)/$(PORT)

# One job per core, unless -j says otherwise. A sub-make prints each recipe's output in one piece.
cores     := $(or $(shell nproc 2>/dev/null),1)
MAKEFLAGS += $(if $(filter 0,$(MAKELEVEL)),-j$(cores),$(if $(filter output-sync,$(.FEATURES)),-O))
jobs       = $(or $(patsubst -j%,%,$(filter -j%,$(MAKEFLAGS))),1)

# The library is C99 without extensions; the strictest warnings from day one.
warn := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wcast-align -Wcast-qual \
        -Wstrict-prototypes -Wmissing-prototypes -Wundef -Wwrite-strings -Wpointer-arith \
        -Wdouble-promotion -Wformat=2 -Wvla -Wswitch-enum $(if $(WERROR),-Werror)
base := -std=c99 -O$(O) -g $(warn) -ffunction-sections -fdata-sections -Ilib/include -Iexamples \
        -MMD -MP \
        $(if $(UNCALIBRATED),-DUNCALIBRATED)

# An assertion names its source without lib/src/: a layer's folder costs an image no bytes.
# No folder's name is in DWARF: the same sources are the same bytes anywhere (make same).
# A compiler that is too old for both goes without.
base += $(shell $(CC) -fmacro-prefix-map=a=b -E -xc /dev/null >/dev/null 2>&1 && echo \
        -fmacro-prefix-map=lib/src/= -fdebug-prefix-map=$(CURDIR)=.)

# What all objects are compiled with. Another text here compiles all anew.
stamp      := $(out)/flags
flags_text := $(CC) | $(base) | $(PORT_CFLAGS) | $(PORT_WHOLE) | $(PORT_INLINE) | $(PORT_FLOAT) | \
              $(PORT_HOSTFLAGS) | $(CFLAGS) | $(LDFLAGS)

# lib/src/run needs a board and a scene: it is of images, not of the library.
lib_src := $(sort $(filter-out lib/src/run/%,$(wildcard lib/src/*/*.c)))
lib_obj := $(lib_src:%.c=$(out)/%.o)
lib     := $(out)/libexhand.a

.DEFAULT_GOAL := all

##@ First
.PHONY: help help-all
parts = $(filter Makefile %.mk,$(MAKEFILE_LIST))
help:
	@awk -v few=1 -f .ci/help.awk $(parts) | sort | cut -c 2-
	@echo "  PORT=$(PORT)   one of: $(ports)"
	@echo "  SCENE=$(SCENE)   one of:" \
	    "$(notdir $(patsubst %/scene.mk,%,$(wildcard examples/*/scene.mk)))"
##8 List all targets by subject.
help-all:
	@awk -f .ci/help.awk $(parts)

# have: where header 1 is. sees: yes, if this compiler can include it, too.
have  = $(firstword $(wildcard $(addsuffix /$(1),/usr/include /usr/local/include)))
sees  = $(if $(call have,$(1)),$(shell $(CC) $(filter -m% --target%,$(CFLAGS)) -include $(1) \
        -fsyntax-only -xc /dev/null \
          2>/dev/null && echo yes))
# gives: yes, if this compiler and these flags link symbol 3 of library 2, which header 1 declares.
gives = $(if $(call have,$(1)),$(shell t=$$(mktemp) && echo 'int main(void){return !$(3);}' | \
        $(CC) \
          $(filter -m% --target% -static,$(CFLAGS) $(LDFLAGS)) -include $(1) -xc - -o $$t -l$(2) \
          2>/dev/null && echo yes; rm -f $$t))

.PHONY: FORCE
# 1: a file, 2: its text. The file is as old as its text.
define text_file
$(1): export flags = $(2)
$(1): FORCE
	@mkdir -p $$(@D)
	@printf '%s\n' "$$$$flags" | cmp -s - $$@ || printf '%s\n' "$$$$flags" > $$@
endef
$(eval $(call text_file,$(stamp),$$(flags_text)))

$(out)/lib/%.o: lib/%.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(CFLAGS) -c $< -o $@

$(out)/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(PORT_HOSTFLAGS) $(CFLAGS) -c $< -o $@

$(lib): $(lib_obj)
	$(Q)rm -f $@ && $(CROSS)ar rcD $@ $^

include examples/custom/model.mk examples/frozen.mk

# --- what is linked -----------------------------------------------------------

image_of  := $(SCENE)$(if $(FROZEN),-frozen-$(subst /,_,$(FROZEN)))$(if $(filter \
             custom,$(SCENE)),$(filter-out -wall,-$(MODEL_NAME)))
image     := $(out)/$(image_of)$(PORT_SUFFIX).elf
# A scene with SCENE_WHOLE is optimised as one program with library, loop and cards, if the port has
# flags for it (PORT_WHOLE). The port's files are not, as interrupts, faults and tests enter there,
# but for those of PORT_INLINE.
# Records are not, as the bound of the stack finds their indirect calls by file.
one      := $(if $(FROZEN),,$(and $(PORT_WHOLE),$(SCENE_WHOLE)))
one_at   := $(out)$(if $(one),/whole)
one_lib  := $(if $(one),$(one_at)/libexhand.a,$(lib))
one_link := $(if $(one),$(base) $(PORT_CFLAGS) $(PORT_WHOLE) -flto-partition=one \
            -Wno-maybe-uninitialized $(CFLAGS))
ifneq ($(one),)
$(out)/$(SCENE)/ports/cards/%.o: SCENE_CFLAGS += $(PORT_WHOLE)
$(PORT_INLINE:%.c=$(out)/$(SCENE)/%.o): SCENE_CFLAGS += $(PORT_WHOLE) -funroll-loops
$(one_at)/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(if $(filter lib/%,$<),,$(PORT_HOSTFLAGS)) $(PORT_WHOLE) \
	    $(CFLAGS) -c $< -o $@
$(one_lib): $(lib_src:%.c=$(one_at)/%.o)
	$(Q)rm -f $@ && $(CROSS)ar rcD $@ $^
endif
# The frozen scene and library come first, so that the other library gives them nothing.
main_src  := $(or $(SCENE_MAIN),$(PORT_MAIN),lib/src/run/image.c lib/src/run/deadman.c)
image_obj := $(if $(FROZEN),$(frozen_obj) $(frozen_lib)) \
             $(patsubst %,$(out)/$(SCENE)/%.o,$(basename $(main_src) $(PORT_SRC))) \
             $(if $(SCENE_MAIN),,$(one_at)/lib/src/run/loop.o) \
             $(if $(FROZEN),,$(SCENE_SRC:%.c=$(one_at)/%.o)) \
             $(if $(filter custom,$(SCENE)),$(model_obj))

# These are compiled for one scene: a set of objects per scene.
$(out)/$(SCENE)/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(PORT_HOSTFLAGS) -DEXH_SCENE=exh_scene_$(SCENE) $(SCENE_CFLAGS) \
	    $(CFLAGS) -c $< -o $@
$(out)/$(SCENE)/%.o: %.S $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) -Ilib/include $(PORT_CFLAGS) $(filter -fdebug%,$(base)) -g -c $< -o $@

$(image): $(image_obj) $(one_lib) $(PORT_LDSCRIPT) $(frozen_stamp)
	$(Q)$(CC) $(if $(FROZEN),$(whole_flags),$(one_link)) $(PORT_LDFLAGS) $(LDFLAGS) \
	    -Wl,--gc-sections,-Map=$(@:.elf=.map) \
	    $(PORT_LDSCRIPT:%=-T %) $(image_obj) $(one_lib) $(SCENE_LIBS) -o $@

# What the machine boots from, if that is not the image itself.
boot := $(if $(PORT_ISO),$(image:.elf=.iso))
$(boot): $(image) $(PORT_ISO) FORCE
	@.ci/deps "$@" \
	    "command -v grub-mkrescue && command -v xorriso && command -v mformat && \
	ls /usr/lib/grub/i386-pc/multiboot.mod" \
	    grub-pc-bin grub-common xorriso mtools || exit 3
	$(Q)$(PORT_ISO) $(image) $@ $(ARGS)

# --- the folders' own parts; a later one may use what an earlier one defines -----------------

include ports/posix/world/world.mk ports/posix/posix.mk ports/fmi/fmi.mk \
    ports/python/python.mk
include test/test.mk $(foreach d,closed golden matrix fuzz strength device image \
    figures,test/$d/$d.mk)
include test/figures/bench/bench.mk test/check.mk test/walk/walk.mk
include lib/lib.mk docs/docs.mk

# Of several goals one runs at a time, because two sub-makes would write the same files. Files and
# these may run together (test/check.mk).
together := $(B)/% images-built variant-% golden-% undef% $(check_runs) $(check_waits)
ifneq ($(and $(filter-out $(together),$(MAKECMDGOALS)),$(word 2,$(MAKECMDGOALS))),)
.NOTPARALLEL:
endif

program := $(if $(filter custom,$(SCENE)),$(exhand_custom),$(exhand))
products := $(if $(filter posix,$(PORT)),$(program),$(image))

##@ Build and run
##1 Build the library, and the host program or the image of SCENE on PORT.
.PHONY: all
all: $(lib) $(products)

##5 Build the image of SCENE on PORT and what the machine boots from (ARGS: its options).
.PHONY: image
image: $(image) $(boot)
	@ls -l $^ | awk '{print $$NF ": " $$5 " bytes"}'

##4 Run the host program (ARGS="drop --help") or the image of SCENE on PORT.
.PHONY: run
run: all
ifeq ($(PORT),posix)
	$(Q)$(program) $(ARGS)
else
	$(if $(PORT_QEMU),@.ci/deps "make run" $(PORT_QEMU) || exit 3)
	$(Q)$(or $(PORT_RUN),$(error PORT=$(PORT) cannot run images: PORT_RUN in ports/$(PORT)/port.mk \
	    names what does)) $(image) $(ARGS)
endif

## Write compile_commands.json for editors and clang tools: library, host program, world, tests.
.PHONY: compile_commands.json
compile_commands.json: $(stamp)
	@$(MAKE) --no-print-directory \
	    -nB V=1 $(lib) $(products) $(if $(filter posix,$(PORT)),$(world) $(test_bin)) | \
	    awk -v dir="$(CURDIR)" -f .ci/compile_commands.awk > $@

##7 Remove everything that was built.
.PHONY: clean
clean:
	rm -rf $(B)

# Headers of what was built here. Builds with a folder of their own below B read their own.
built := $(wildcard $(sort $(out) $(B)/posix $(B)/bench $(B)/test $(B)/suite $(B)/mcdc \
         $(B)/mutation))
-include $(if $(built),$(shell find $(built) -type f -name '*.d')) $(wildcard $(B)/gpio/*.d)
