# SPDX-License-Identifier: MIT
SCENE_DESC := first power-up of a box: no motor, dummy load, one motor, one string, one finger
SCENE_SRC  := examples/bringup/bringup.c examples/bringup/setup.c examples/bringup/stage.c \
              examples/bringup/text.c
