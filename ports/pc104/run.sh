#!/bin/sh
# Runs an image under QEMU: run.sh IMAGE [OPTION...], e.g. run.sh build/pc104/minimal.elf ticks=5000
# Exit status: 0 the image said "done", 1 it did not (or took too long), 2 bad usage, 3 no QEMU.
# Environment: QEMU_CPU (n270), QEMU_FLAGS (none), TIMEOUT_s (60).
# Counting instructions with the time stamp counter: QEMU_FLAGS="-icount shift=0,sleep=off".
set -u

qemu="qemu-system-i386"
exit_done=33 # board.c writes 0x10 to the debug port: 2 * 0x10 + 1

if [ $# -lt 1 ] || [ ! -r "$1" ]; then
    echo "${1:-image}: not readable: usage: $0 IMAGE [OPTION...]" >&2
    exit 2
fi
if ! command -v "$qemu" >/dev/null 2>&1; then
    echo "$qemu: not found: install the package qemu-system-x86" >&2
    exit 3
fi
image=$1
shift

# shellcheck disable=SC2086 # QEMU_FLAGS is a list of words
timeout "${TIMEOUT_s:-60}" "$qemu" -cpu "${QEMU_CPU:-n270}" -m 16 -kernel "$image" -append "$*" \
    -nodefaults -display none -serial stdio -monitor none -no-reboot \
    -device isa-debug-exit,iobase=0xf4,iosize=4 ${QEMU_FLAGS:-} </dev/null
status=$?
[ "$status" -eq "$exit_done" ] && exit 0
if [ "$status" -eq 124 ]; then
    echo "$image: still running after ${TIMEOUT_s:-60} s (TIMEOUT_s): stopped" >&2
else
    echo "$image: did not end with \"done\" (status $status of $qemu)" >&2
fi
exit 1
