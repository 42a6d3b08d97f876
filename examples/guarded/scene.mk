# SPDX-License-Identifier: MIT
SCENE_DESC := drop, and no contact gives back more energy than it was given; a rule of gains
SCENE_SRC  := examples/guarded/guarded.c examples/drop/drop.c lib/src/run/calib_set.c
SCENE_BOX_B := 1048576
