# SPDX-License-Identifier: MIT
SCENE_DESC := calibration of one finger: zero, polarity, home, F0, masses
SCENE_SRC  := examples/calibrate/calibrate.c
