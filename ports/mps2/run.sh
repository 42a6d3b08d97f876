#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs an image under QEMU: run.sh IMAGE.
# Exit status: 0 the image said "done", 1 it did not (or took too long), 2 bad usage, 3 no QEMU,
# 5 processor exception.
# Environment: QEMU_FLAGS (virtual time, 64 ns an instruction: 1.6 cycles of 25 MHz), TIMEOUT_s
# (60), MACHINE (mps2-an385), SERIAL (-serial stdio).
set -u

qemu="qemu-system-arm"
if [ $# -ne 1 ] || [ ! -r "$1" ]; then
    echo "${1:-image}: not readable: usage: $0 IMAGE" >&2
    exit 2
fi
if ! command -v "$qemu" >/dev/null 2>&1; then
    echo "$qemu: not found: install the package qemu-system-arm" >&2
    exit 3
fi
# shellcheck disable=SC2086 # a list of words
timeout "${TIMEOUT_s:-60}" "$qemu" -M "${MACHINE:-mps2-an385}" -kernel "$1" -display none \
    ${SERIAL--serial stdio} -monitor none -semihosting-config enable=on,target=native \
    ${QEMU_FLAGS--icount shift=6,sleep=off} </dev/null
status=$?
case $status in
0 | 5) exit $status ;;
124) echo "$1: still running after ${TIMEOUT_s:-60} s (TIMEOUT_s): stopped" >&2 ;;
*) echo "$1: did not end with \"done\" (status $status of $qemu)" >&2 ;;
esac
exit 1
