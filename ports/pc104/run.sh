#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs an image under QEMU: run.sh IMAGE [OPTION...], for example
# run.sh build/pc104/minimal-none.elf ticks=5000.
# IMAGE: an ELF, or an .iso that GRUB on it boots (its options are inside). An ELF without ticks=
# runs 1000 ticks, so that it ends.
#
# Exit status: 0 the image said "done", 1 it did not (or took too long), 3 no QEMU.
# 2: bad usage, or it refused an option. 4: cards absent or broken. 5: processor exception.
# 6: rate refused. 7: overload. 8: timer absent or dead.
#
# Environment: QEMU_CPU (n270), TIMEOUT_s (60).
# QEMU_FLAGS: virtual time, 8 ns an instruction. "-icount shift=0,sleep=off" counts instructions. An
# empty value takes the host's time; the host's other work then shows as missed ticks.
# RECORDS: a file for the output of log=debug.
# REBOOT: with "-action reboot=reset" a reset boots again instead of ending QEMU.
# MODULES: files that a loader would bring, separated by commas: calibrations of fingers.
set -u

qemu="qemu-system-i386"

if [ $# -lt 1 ] || [ ! -r "$1" ]; then
    echo "${1:-image}: not readable: usage: $0 IMAGE [OPTION...]" >&2
    exit 2
fi
if ! command -v "$qemu" >/dev/null 2>&1; then
    echo "$qemu: not found: install the package qemu-system-x86" >&2
    exit 3
fi
image=$1
flags=${QEMU_FLAGS--icount shift=3,sleep=off}
shift
case $image in
*.iso) from="-m 64 -boot d -cdrom" ;;
*)
    from="-m 16 -kernel"
    case " $* " in *" ticks="*) ;; *) set -- "$@" ticks=1000 ;; esac
    ;;
esac
[ -z "${MODULES:-}" ] || from="-initrd $MODULES $from"
[ -z "${RECORDS:-}" ] || from="-debugcon file:$RECORDS $from"

# shellcheck disable=SC2086 # lists of words
timeout "${TIMEOUT_s:-60}" "$qemu" -cpu "${QEMU_CPU:-n270}" $from "$image" ${1:+-append "$*"} \
    -nodefaults -display none -serial stdio -monitor none ${REBOOT:--no-reboot} \
    -device isa-debug-exit,iobase=0xf4,iosize=4 $flags </dev/null
status=$?
# board.c writes its pc104_exit, v, to the debug port: 2 v + 1
case $status in
33) exit 0 ;;
37) exit 4 ;;
39) exit 2 ;;
41) exit 5 ;;
43) exit 6 ;;
45) exit 7 ;;
47) exit 8 ;;
124) echo "$image: still running after ${TIMEOUT_s:-60} s (TIMEOUT_s): stopped" >&2 ;;
*) echo "$image: did not end with \"done\" (status $status of $qemu)" >&2 ;;
esac
exit 1
