#!/bin/sh
# SPDX-License-Identifier: MIT
# avr.sh IMAGES: runs the images that this file names, by the program beside it.
# shellcheck disable=SC2046 # a list of words
exec timeout "${TIMEOUT_s:-7200}" "$(dirname "$1")/avr_run" $(cat "$1")
