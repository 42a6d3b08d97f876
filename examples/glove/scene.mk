# SPDX-License-Identifier: MIT
SCENE_DESC := senses only: 22 glove codes to angles, robot joints, fingertips; no motor runs
SCENE_SRC  := examples/glove/glove.c examples/glove/cal.c
