# SPDX-License-Identifier: MIT
SCENE_DESC := what is this device? pulses, pulls, a sweep and drops for exhand identify
SCENE_SRC  := examples/identify/identify.c examples/identify/part.c
