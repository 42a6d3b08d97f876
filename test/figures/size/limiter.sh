#!/bin/sh
# SPDX-License-Identifier: MIT
# Code of the limiter on a Cortex-M3: limiter.sh
# Links limiter.c of this folder, a caller of set-up and step, with the amalgamated limiter, -Os and
# without what is not called. Prints the bytes of each function and table, and of all: the limiter,
# what it needs of the library, and the caller. Refutes "all of them are 3 KiB".
#
# Environment: B (build).
# Exit status: 0 within 3072 bytes, 1 not, 2 bad usage, 3 no compiler.
set -eu

most=3072
here=test/figures/size
b=${B:-build}/size/limiter
cross=arm-none-eabi-

[ $# = 0 ] && [ -r "$here/limiter.sh" ] || {
    echo "usage: $here/limiter.sh, at the top of the tree" >&2
    exit 2
}
command -v "${cross}gcc" >/dev/null 2>&1 || {
    echo "limiter: ${cross}gcc: not found: install gcc-arm-none-eabi" >&2
    exit 3
}
mkdir -p "$b"
lib/amalgamate.py "$b/exhand_limiter" limiter.h >"$b/said.txt"
"${cross}gcc" -std=c99 -Os -mcpu=cortex-m3 -mthumb -ffreestanding -ffunction-sections \
    -fdata-sections -fmacro-prefix-map="$b/=" -I"$b" -nostdlib -static -Wl,--gc-sections \
    -Wl,--build-id=none -Wl,-e,main -o "$b/limiter.elf" "$here/limiter.c" \
    "$b/exhand_limiter.c" -lgcc
"${cross}nm" --size-sort -t d "$b/limiter.elf" | awk '$2 ~ /[rRtT]/ { print $1 + 0, $3 }'
bytes=$("${cross}size" "$b/limiter.elf" | awk 'NR == 2 { print $1 + $2 }')
echo "$bytes of $most: the limiter on a Cortex-M3, with all that it needs and its caller"
[ "$bytes" -le "$most" ]
