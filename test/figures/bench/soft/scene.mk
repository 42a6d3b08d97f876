# SPDX-License-Identifier: MIT
# An image that counts what kernels cost on a CPU without an FPU: ours, and the same in double and
# float by the compiler's software.
SCENE_DESC := kernels counted without an FPU
SCENE_MAIN := test/figures/bench/soft/image.c test/figures/bench/plain.c test/figures/bench/law.c \
              test/figures/bench/tick.c
SCENE_SRC  :=
SCENE_ROM  := yes
SCENE_CFLAGS = -Itest -Itest/figures/bench
SCENE_LIBS := -lgcc
