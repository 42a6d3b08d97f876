#!/bin/sh
# SPDX-License-Identifier: MIT
# soft.sh: kernels on small CPUs. Builds the image of this directory for a Cortex-M3, a Cortex-M0,
# and a Cortex-M4 with its DSP extension and FPU. Runs each under QEMU, where virtual time is 64 ns
# an instruction, by a timer of 25 MHz. CMSIS-DSP is among them if peers.sh has fetched it. Writes
# $B/bench/soft.csv: cpu, kernel, name, instructions of one op.
# Environment: B (build), MAKE. Exit status: 0 ok, 1 it did not run, 3 no compiler or emulator.
set -eu
b=${B:-build}
unset CC CFLAGS LDFLAGS # of this machine's compiler
for t in arm-none-eabi-gcc qemu-system-arm; do
    command -v $t >/dev/null 2>&1 ||
        { echo "soft: $t: missing (gcc-arm-none-eabi, qemu-system-arm)" >&2; exit 3; }
done
cmsis=$b/peers/cmsisdsp-1.10.3
[ -r "$cmsis/.complete" ] || cmsis=
if [ -n "$cmsis" ] &&
    ! echo '#include <string.h>' | arm-none-eabi-gcc -fsyntax-only -xc - 2>/dev/null; then
    echo "skipped: CMSIS-DSP on a Cortex-M: no C library's headers (libnewlib-arm-none-eabi)"
    cmsis=
fi

# counted CPU MACHINE FLAG...
counted()
{
    at=$b/soft-$1
    name=$1
    machine=$2
    shift 2
    ${MAKE:-make} --no-print-directory -s "B=$at" PORT=mps2 SCENE=soft "CMSIS=$cmsis" \
        "PORT_CFLAGS=$* -mthumb -ffreestanding" \
        "PORT_LDFLAGS=$* -mthumb -nostdlib -static -Wl,--build-id=none" "$at/mps2/soft.elf"
    MACHINE=$machine ports/mps2/run.sh "$at/mps2/soft.elf" >"$at/said.txt" ||
        { cat "$at/said.txt"; exit 1; }
    awk -F, -v OFS=, -v cpu="$name" '
        $1 == "soft" { printf "%s,%s,%s,%.1f\n", cpu, $2, $3, $4 * 40 / 64 / 1024; n++ }
        END { exit n == 0 }' "$at/said.txt"
}

mkdir -p "$b/bench"
{
    echo "cpu,kernel,name,instructions"
    counted m3 mps2-an385 -mcpu=cortex-m3
    counted m0 mps2-an385 -mcpu=cortex-m0
    counted m4 mps2-an386 -mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16
} >"$b/bench/soft.csv"
