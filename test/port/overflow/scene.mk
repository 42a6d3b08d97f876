# SPDX-License-Identifier: MIT
# An image that overruns its stack with current on: the port's fault handlers make it safe.
SCENE_DESC := a stack overrun with current on
SCENE_MAIN := test/port/overflow/image.c
SCENE_SRC  :=
SCENE_ROM  := yes
