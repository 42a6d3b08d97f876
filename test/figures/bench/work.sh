#!/bin/sh
# SPDX-License-Identifier: MIT
# Kernels of ours, of others and in plain floating point, as CSV: work.sh
#
# Runs $B/bench/work and, if it was built, work-i686. Writes $B/bench/work.csv: kernel, name, kind,
# unit, when (all, or seconds of ticks at 2 kHz), largest and rms error. Then instructions of one op
# on x86-64 and i686, and ns on this machine.
#
# Environment: B (build). Exit status: 0 ok, 3 valgrind or the binary missing.
set -eu

b=${B:-build}/bench
LC_ALL=C
export LC_ALL
[ -x "$b/work" ] || { echo "work: $b/work: not there" >&2; exit 3; }
command -v valgrind >/dev/null 2>&1 || { echo "work: valgrind: missing" >&2; exit 3; }
tmp=$(mktemp -d) || exit 3
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
. test/figures/bench/callgrind.sh

per_op "$b/work" >"$tmp/x64"
: >"$tmp/i686"
[ ! -x "$b/work-i686" ] || per_op "$b/work-i686" >"$tmp/i686"
"$b/work" time >"$tmp/ns"
"$b/work" errors >"$tmp/errors"
awk -F, -v OFS=, '
    FNR == 1 { file++ }
    file == 1 { x64[$1 "," $2] = $3; order[n++] = $1 "," $2; next }
    FILENAME ~ /i686$/ { i686[$1 "," $2] = $3; next }
    FILENAME ~ /ns$/ { ns[$1 "," $2] = $3; next }
    function row(k, rest) { print k, rest, x64[k], (k in i686 ? i686[k] : "-"), ns[k] }
    FILENAME ~ /errors$/ { if (!head++) print "kernel,name,kind,unit,when,max,rms,x64,i686,ns"
                           seen[$1 "," $2] = 1
                           row($1 "," $2, $3 "," $4 "," $5 "," $6 "," $7) }
    END { for (i = 0; i < n; i++) if (!(order[i] in seen)) row(order[i], "float,-,-,-,-") }
' "$tmp/x64" "$tmp/i686" "$tmp/ns" "$tmp/errors" >"$b/work.csv"
