# SPDX-License-Identifier: MIT
# An image that counts what kernels cost on a small CPU: ours, others' integer code, and the same in
# double and float. CMSIS: CMSIS-DSP's sources, if there are any.
SCENE_DESC := kernels counted on a small CPU
SCENE_MAIN := $(addprefix test/figures/bench/,soft/image.c soft/others.c soft/limiter.c \
              idsp_twin.c plain.c law.c tick.c) $(if $(CMSIS),test/figures/bench/soft/cmsis.c)
SCENE_SRC  :=
SCENE_ROM  := yes
SCENE_CFLAGS = -Itest -Itest/figures/bench $(if $(CMSIS),-DPEERS_CMSIS -isystem $(CMSIS)/Include \
               -isystem $(CMSIS)/PrivateInclude -isystem $(CMSIS)/Source \
               -isystem test/figures/bench/soft)
SCENE_LIBS := -lgcc
# A system header, which -MMD does not list.
$(B)/mps2/soft/test/figures/bench/soft/cmsis.o: test/figures/bench/soft/cmsis_compiler.h
