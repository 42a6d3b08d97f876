#!/bin/sh
# SPDX-License-Identifier: MIT
# look.sh BINARY: instructions of one look ahead of a fingertip, by callgrind.
looks=20000

for how in "rests 1" "moves 1" "moves 0"; do
    file=$(mktemp)
    # shellcheck disable=SC2086
    told=$(valgrind --tool=callgrind --callgrind-out-file="$file" --toggle-collect=ahead_look \
        "$1" $how 2>/dev/null)
    total=$(sed -n 's/^summary: //p' "$file")
    rm -f "$file"
    echo "$told"
    awk -v t="$total" -v n=$looks -v how="$how" 'BEGIN { split(how, h, " ")
        printf "%8.1f instructions a look, finger %s, culling %s\n", t / n, h[1],
            h[2] ? "on" : "off" }'
done
