#!/bin/sh
# SPDX-License-Identifier: MIT
# Bytes of an image by where its code came from: parts.sh MAP... (build/pc104/SCENE.map). Alignment
# between pieces is in none of them.
# Exit status: 0, 2 bad usage.
[ $# -gt 0 ] && [ -r "$1" ] || { echo "usage: $0 MAP...: make PORT=pc104 SCENE=drop" >&2; exit 2; }
for map in "$@"; do
    echo "$map: code and constants, data, zeroed"
    awk '
    function number(hex,    i, n) {
        n = 0
        for (i = 3; i <= length(hex); i++) {
            n = 16 * n + index("0123456789abcdef", substr(hex, i, 1)) - 1
        }
        return n
    }
    function part(f) {
        if (f ~ /libexhand\.a/) return "library"
        if (f ~ /ports\/cards/) return "card drivers"
        if (f ~ /ports\/[a-z0-9]+\//) return "port"
        if (f ~ /examples\//) return "scene and loop"
        return "compiler"
    }
    /^Linker script and memory map/ { on = 1 }
    !on || /^ \*/ { next }
    /^ \.[a-z]/ && NF == 1 { name = $1; next } # a long name has its own line
    /^ \.[a-z]/ && NF >= 4 { name = $1; at = $2; size = $3; file = $4 }
    /^  +0x/ && NF >= 3 && name != "" { at = $1; size = $2; file = $3 }
    size ~ /^0x/ && at !~ /^0x0+$/ {
        kind = name ~ /^\.(text|rodata)/ ? 1 : name ~ /^\.data/ ? 2 :
               name ~ /^\.(bss|COMMON)/ ? 3 : 0
        n = number(size)
        if (kind && n) { sum[part(file), kind] += n; seen[part(file)] = 1; all[kind] += n }
    }
    { if (size != "" || NF > 1) { name = ""; size = ""; at = "" } }
    END {
        for (p in seen) printf "  %-16s %8d %6d %8d\n", p, sum[p, 1], sum[p, 2], sum[p, 3] | "sort"
        close("sort")
        printf "  %-16s %8d %6d %8d\n", "all", all[1], all[2], all[3]
    }' "$map"
done
