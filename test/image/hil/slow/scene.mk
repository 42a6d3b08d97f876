# SPDX-License-Identifier: MIT
SCENE_DESC := test: every hundredth tick takes two and a half periods
SCENE_SRC  := test/image/hil/slow/slow.c
SCENE_ROM  := yes
