# SPDX-License-Identifier: MIT
SCENE_DESC := the full box: five fingers with glove, link, pre-contact and contact; one costs one
SCENE_SRC  := $(wildcard examples/bilateral/*.c) examples/glove/cal.c lib/src/run/calib_set.c
# Optimised as one program where the port says how.
SCENE_WHOLE := yes
SCENE_BOX_B := 4194304
