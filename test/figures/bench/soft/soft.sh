#!/bin/sh
# SPDX-License-Identifier: MIT
# Kernels on a CPU without an FPU: soft.sh
# Builds the image of this directory for a Cortex-M3 and runs it under QEMU, where virtual time is
# 64 ns an instruction, seen by a timer of 25 MHz. Writes $B/bench/soft.csv: kernel, way,
# instructions of one op.
# Environment: B (build), MAKE. Exit status: 0 ok, 1 it did not run, 3 no compiler or emulator.
set -eu
b=${B:-build}
for t in arm-none-eabi-gcc qemu-system-arm; do
    command -v $t >/dev/null 2>&1 ||
        { echo "soft: $t: missing (gcc-arm-none-eabi, qemu-system-arm)" >&2; exit 3; }
done
${MAKE:-make} --no-print-directory -s "B=$b/soft" PORT=mps2 SCENE=soft "$b/soft/mps2/soft.elf"
mkdir -p "$b/bench"
ports/mps2/run.sh "$b/soft/mps2/soft.elf" >"$b/soft/said.txt" || { cat "$b/soft/said.txt"; exit 1; }
awk -F, -v OFS=, 'BEGIN { print "kernel,way,instructions" }
    $1 == "soft" { printf "%s,%s,%.1f\n", $2, $3, $4 * 40 / 64 / 1024; n++ }
    END { exit n == 0 }' "$b/soft/said.txt" >"$b/bench/soft.csv"
