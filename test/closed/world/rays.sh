#!/bin/sh
# SPDX-License-Identifier: MIT
# rays.sh BINARY: instructions of one ray by callgrind, ours beside code by hand for that scene
# alone.
rays=50000

count() # FUNCTION ARGUMENT...
{
    function=$1 file=$(mktemp)
    shift
    valgrind --tool=callgrind --callgrind-out-file="$file" --toggle-collect="$function" "$@" \
        2>/dev/null
    sed -n 's/^summary: /|/p' "$file"
    rm -f "$file"
}

for where in near far; do
    plain=$(count plain "$1" aligned $where 1)
    echo "$plain" | awk -F '|' -v n=$rays \
        '{ printf "%s\n%8.1f instructions a ray, by hand for this scene alone\n", $1, $2 / n }'
    for how in "aligned 1" "turned 1" "turned 0"; do
        # shellcheck disable=SC2086
        ours=$(count cast "$1" ${how% *} $where ${how#* })
        echo "$ours" | awk -F '|' -v n=$rays -v how="$how" '{ split(how, h, " ")
            printf "%8.1f instructions a ray, box %s, culling %s\n", $2 / n, h[1],
                h[2] ? "on" : "off" }'
    done
done
