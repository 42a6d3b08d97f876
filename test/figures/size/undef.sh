#!/bin/sh
# SPDX-License-Identifier: MIT
# undef.sh ARCHIVE NM [ALLOWED_HELPER...]: what the library needs from outside. It refutes "needs
# nothing but four string functions and the assertion hook". Helpers of the compiler (shifts,
# multiplications on small machines) are named one by one. Division helpers are refused even then:
# the tick must not divide, and set-up has its own division.
# Exit status: 0 nothing else, 1 something else, 2 bad usage, 3 no such tool.
set -eu

if [ $# -lt 2 ]; then
    echo "usage: $0 ARCHIVE NM [ALLOWED_HELPER...]" >&2
    exit 2
fi
archive=$1
nm=$2
shift 2
[ -r "$archive" ] || { echo "$archive: not readable: build the library first" >&2; exit 2; }
command -v "$nm" >/dev/null 2>&1 || { echo "$nm: not found: install its binutils" >&2; exit 3; }

symbols=$(mktemp)
trap 'rm -f "$symbols"' EXIT
"$nm" -g -P "$archive" >"$symbols"

# -P: name, type, value, size. A header "archive[member]:" has no type. Weak references count as
# needs: without them the library would not work fully. The linker makes the table of offsets of
# position-independent code, so it is no need.
awk -v archive="$archive" \
    -v allowed="memcpy memset memmove memcmp exh_assert_failed${*:+ $*}" '
    NF < 2 || $1 == "_GLOBAL_OFFSET_TABLE_" { next }
    $2 ~ /^[Uwv]$/ { needed[$1] = 1; next }
                   { defined[$1] = 1; members++ }
    END {
        if (!members) { print archive ": defines no symbol" > "/dev/stderr"; exit 1 }
        n = split(allowed, word, " ")
        for (i = 1; i <= n; i++) { ok[word[i]] = 1 }
        for (name in needed) {
            if (name in defined) { continue }
            if (name ~ /^__.*(div|mod)/) {
                print archive ": " name " (none allowed): division; use exh_udiv64" | "sort >&2"
                bad = 1
            } else if (!(name in ok)) {
                print archive ": " name " (allowed: " allowed "): not in the library" | "sort >&2"
                bad = 1
            } else {
                uses = uses " " name
            }
        }
        close("sort >&2")
        if (!bad) { print archive ": needs only" (uses ? uses : " nothing") }
        exit bad
    }' "$symbols"
