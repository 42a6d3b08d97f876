# SPDX-License-Identifier: MIT
# An image that counts what kernels cost on a CPU without an FPU: ours, and the same in double and float by the compiler's software.
SCENE_DESC := kernels counted without an FPU
SCENE_MAIN := test/bench/soft/image.c test/bench/plain.c test/bench/law.c test/bench/tick.c
SCENE_SRC  :=
SCENE_ROM  := yes
SCENE_CFLAGS = -Itest -Itest/bench
SCENE_LIBS := -lgcc
