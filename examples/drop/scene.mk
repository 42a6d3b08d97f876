# SPDX-License-Identifier: MIT
SCENE_DESC := falling-mass step response: one motor, no glove, no link
SCENE_SRC  := examples/drop/drop.c lib/src/run/calib_set.c
SCENE_BOX_B := 1048576
