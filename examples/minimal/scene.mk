# SPDX-License-Identifier: MIT
SCENE_DESC := one finger against one virtual wall, constants in ROM, no log
SCENE_SRC  := examples/minimal/minimal.c
SCENE_ROM  := yes
