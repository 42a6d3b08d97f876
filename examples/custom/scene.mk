# SPDX-License-Identifier: MIT
SCENE_DESC := drop, with a controller of your own in the place of the wall: the generated folder \
              MODEL
SCENE_SRC  := examples/custom/custom.c examples/custom/slot_real.c examples/drop/drop.c \
              lib/src/run/calib_set.c
SCENE_BOX_B := 1048576
# The controller reckons in floats.
SCENE_FLOAT := yes
SCENE_LIBS := $(PORT_FLOAT_LIBS)
