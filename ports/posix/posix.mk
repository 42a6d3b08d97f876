# SPDX-License-Identifier: MIT
# The host program build/posix/exhand, and what it prints for the documents.

# Every scene that has a subcommand, over the simulated device.
cli_src := $(wildcard ports/posix/exhand/*.c ports/posix/exhand/*/*.c) \
           $(wildcard $(addprefix ports/posix/,base/*.c box/*.c falls/*.c identify/*.c slave/*.c)) \
           $(addprefix lib/src/run/,log.c blackbox.c deadman.c calib_set.c) ports/posix/crc.c \
           $(addprefix examples/,drop/drop.c guarded/guarded.c calibrate/calibrate.c glove/glove.c \
             glove/cal.c) \
           $(wildcard $(addprefix examples/,bilateral/*.c bringup/*.c identify/*.c)) \
           lib/src/run/stream.c
modbus   := $(if $(call gives,modbus/modbus.h,modbus,modbus_reply),libmodbus,none)
by_modbus := $(wildcard ports/posix/slave/libmodbus*.c ports/posix/slave/none.c \
             ports/posix/exhand/live/watch_libmodbus.c ports/posix/exhand/live/watch_none.c)
cli_src  := $(filter-out $(by_modbus) ports/posix/base/scene_custom.c,$(cli_src)) \
            $(foreach f,$(by_modbus),$(if $(findstring $(modbus),$f),$f))
# The world's core answers in the same process, without pictures.
exh_obj  := $(cli_src:%.c=$(B)/posix/%.o) $(world_core:%.c=$(B)/posix/%.o) $(world_mesh)
# Proofs and studies are in a separate program, which also has all commands of the other.
lab_obj  := $(patsubst %.c,$(B)/posix/%.o,$(wildcard test/lab/*.c test/lab/*/*.c))
cli_obj  := $(exh_obj) $(lab_obj)
cli_libs := $(if $(world_tree),-ldl) $(if $(filter libmodbus,$(modbus)),-lmodbus) -pthread -lm
# Lines of a GPIO chip, by the version of libgpiod. Tests and benches link none, so that they are
# the same on every machine.
gives_gpio = $(call gives,gpiod.h,gpiod,$(1))
gpio     := $(if $(call gives_gpio,gpiod_line_request_bulk),v1,$(if $(call \
            gives_gpio,gpiod_chip_request_lines),v2,none))
gpio_none := $(B)/posix/ports/posix/gpio_none.o
gpio_obj := $(B)/posix/ports/posix/gpio_$(gpio).o
gpio_libs := $(if $(filter none,$(gpio)),,-lgpiod)

# The board and the device, without lines.
dev_src := $(filter-out ports/posix/gpio_v%.c ports/posix/gpio_none.c,$(wildcard ports/posix/*.c)) \
           $(wildcard ports/posix/sim/*.c ports/posix/emu/*.c ports/cards/*.c)
dev_obj := $(dev_src:%.c=$(B)/posix/%.o) $(B)/posix/lib/src/run/loop.o
sim_obj := $(dev_obj) $(gpio_none)
exhand  := $(B)/posix/exhand
lab     := $(B)/posix/exhand-lab

$(exhand): $(exh_obj) $(dev_obj) $(gpio_obj) $(B)/posix/libexhand.a
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(cli_libs) $(gpio_libs)
$(lab): $(filter-out %/exhand/main.o,$(cli_obj)) $(dev_obj) $(gpio_obj) $(B)/posix/libexhand.a
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(cli_libs) $(gpio_libs)

# The host program with a model in it.
exhand_custom := $(B)/posix/exhand-$(MODEL_NAME)
custom_obj    := $(patsubst %.c,$(B)/posix/%.o,ports/posix/base/scene_custom.c \
                 examples/custom/custom.c examples/custom/slot_real.c)
$(exhand_custom): $(filter-out %/scene_none.o,$(exh_obj)) $(custom_obj) $(model_obj) $(dev_obj) \
    $(gpio_obj) $(B)/posix/libexhand.a
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(cli_libs) $(gpio_libs)

##@ The host program
##2 Run the paper's experiments on the simulated device; build/demo/index.html shows the results.
.PHONY: demo demo-begins
demo: Q := $(if $(V),,@printf .;)
demo-begins:
	@printf 'Compiling exhand and exhand-lab, a dot a file: '
demo: demo-begins all $(lab)
	@echo
	@.ci/deps "the pictures" gnuplot gnuplot-nox fonts-dejavu-core || true
	@ports/posix/demo.sh $(lab) $(B)/demo "$(CURDIR)/ports/posix/plot"

##2 Build exhand-lab, the program for proofs and studies (build/posix/exhand-lab).
.PHONY: lab
lab: $(lab)

##2 Run a world, a box in it and `exhand watch` until one ends or Ctrl-C (SECONDS=10, ARGS: of the
## box).
.PHONY: live
live:
	@.ci/deps "a box that is watched" "test -f /usr/include/modbus/modbus.h" libmodbus-dev || exit 3
	@$(MAKE) --no-print-directory world
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(exhand)
	@LIVE_SECONDS="$(SECONDS)" LIVE_ARGS="$(ARGS)" ports/posix/live.sh $(exhand) $(world)

FIT_BUDGET ?= 6000

## Search for the plant by every reading of the analysis, for hours (FIT_BUDGET=N plants); state is
## in build/fit.
.PHONY: fit
fit: $(lab)
	$(Q)$(lab) fit --budget $(FIT_BUDGET) --out $(B)/fit $(ARGS) > $(B)/fit.txt.new
	@mv $(B)/fit.txt.new $(B)/fit.txt && cat $(B)/fit.txt
