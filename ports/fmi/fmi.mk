# SPDX-License-Identifier: MIT
# FMI 3.0 source FMUs.

# The FMUs hold the sources that are built here. A program per FMU prints its description from its
# own tables.
fmi_src        := ports/fmi/fmi3.c ports/fmi/absent.c
fmi_controller := ports/fmi/controller.c ports/fmi/stop.c examples/drop/drop.c \
                  lib/src/run/calib_set.c $(lib_src)
fmi_device     := ports/fmi/device.c ports/fmi/stop.c \
                  $(patsubst %,ports/posix/sim/%.c,mass plant device fall bench lag)
fmi_folders    := lib/include/exhand=exhand lib/include/exhand/run=exhand/run \
                  $(foreach d,num sense law act safe bench talk run,lib/src/$d=lib/$d) \
                  examples= examples/drop=drop ports/posix/sim=sim ports/fmi=fmi
$(B)/fmi/describe-controller: $(patsubst %.c,$(B)/posix/%.o,ports/fmi/describe.c $(fmi_controller))
$(B)/fmi/describe-device: $(patsubst %.c,$(B)/posix/%.o,ports/fmi/describe.c $(fmi_device)) \
    $(B)/posix/libexhand.a
$(B)/fmi/describe-%:
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^
fmi_pack = $(Q)ports/fmi/pack.py $@ $< $(fmi_folders) -- $(fmi_src)
$(B)/fmu/ExhandController.fmu: $(B)/fmi/describe-controller $(fmi_controller) $(fmi_src) \
    ports/fmi/pack.py
	@mkdir -p $(@D)
	$(fmi_pack) $(fmi_controller)
$(B)/fmu/ExhandDevice.fmu: $(B)/fmi/describe-device $(fmi_device) $(fmi_src) ports/fmi/pack.py
	@mkdir -p $(@D)
	$(fmi_pack) $(fmi_device) lib/src/num/bytes.c lib/src/num/fix.c

$(B)/fmi/native: $(B)/posix/test/walk/fmi/native.o $(filter-out %/main.o,$(cli_obj)) $(sim_obj) \
    $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(cli_libs)

##@ FMI
## Pack FMI 3.0 source FMUs of the controller and of the simulated device: build/fmu.
.PHONY: fmu
fmu: $(B)/fmu/ExhandController.fmu $(B)/fmu/ExhandDevice.fmu
	@ls -l $^ | awk '{print $$NF ": " $$5 " bytes"}'

FMI_RATES ?= 90 500 2000

## Run the FMUs in FMPy and in another importer; outputs must be the native ones, bit for bit
## (FMI_RATES="90 500 2000").
.PHONY: fmi fmi-run
fmi:
	@.ci/deps "the FMUs" "command -v cmake && command -v python3 && python3 -c 'import ensurepip'" \
	    cmake make python3 python3-venv || exit 3
	@$(MAKE) --no-print-directory $(if $(V),,-s) fmu $(B)/fmi/native $(exhand)
	@$(fmi_run)
fmi_run = B=$(B) test/walk/fmi/fmi.sh $(FMI_RATES)
# The part for CI. Exit status 3 means that the packages cannot be had.
fmi-run:
	@B=$(B) test/walk/fmi/fmi.sh 500 > $(B)/fmi/said 2>&1; s=$$?; tail -n 1 $(B)/fmi/said; \
	    [ $$s = 0 ] || [ $$s = 3 ] || { cat $(B)/fmi/said; exit 1; }
