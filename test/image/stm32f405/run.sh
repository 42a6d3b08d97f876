#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh IMAGE [OPTION...]: `make run PORT=stm32f405`, with options of the emulator (--help). Scenes
# drop, guarded and bilateral run in closed loop with a simulated hand. Every other image, and one
# with BOX=none, runs under QEMU (ports/stm32f405/run.sh), which has only processor, UARTs and
# timers of the chip.
# Environment: B (build). Exit status: as of the one that runs it; 3: it is not built.
set -u

emulator=${B:-build}/test/stm32f405/emulator
case ${1:-} in
*/drop.elf | */guarded.elf | */bilateral.elf)
    [ -x "$emulator" ] || { echo "$emulator: not built: make stm32f405-built" >&2; exit 3; }
    image=$1
    shift
    exec "$emulator" --show "$@" "$image"
    ;;
*) exec ports/stm32f405/run.sh "$@" ;;
esac
