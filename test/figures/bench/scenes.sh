#!/bin/sh
# SPDX-License-Identifier: MIT
# Whole ticks of the scenes, as CSV: scenes.sh
#
# Runs $B/bench/scenes and, if it was built, scenes-i686. Writes $B/bench/scenes.csv: scene, rate,
# way (fixed, double, float), quantity, unit, largest and rms error. Writes scenes_cost.csv: scene,
# way, instructions of a tick at 2 kHz on x86-64 and i686, ns on this machine.
#
# Environment: B (build), SHORT (not empty: a tenth of the time). Exit status: 0 ok, 3 valgrind or
# the binary missing.
set -eu

b=${B:-build}/bench
LC_ALL=C
export LC_ALL
[ -x "$b/scenes" ] || { echo "scenes: $b/scenes: not there" >&2; exit 3; }
command -v valgrind >/dev/null 2>&1 || { echo "scenes: valgrind: missing" >&2; exit 3; }
tmp=$(mktemp -d) || exit 3
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
. test/figures/bench/callgrind.sh

{
    echo "scene,rate_hz,way,quantity,unit,max,rms"
    "$b/scenes" errors "$([ -n "${SHORT:-}" ] && echo 2 || echo 6)"
} >"$tmp/scenes.csv"
per_op "$b/scenes" >"$tmp/x64"
: >"$tmp/i686"
[ ! -x "$b/scenes-i686" ] || per_op "$b/scenes-i686" >"$tmp/i686"
"$b/scenes" time >"$tmp/ns"
awk -F, -v OFS=, '
    FILENAME ~ /i686$/ { i686[$1 "," $2] = $3; next }
    FILENAME ~ /ns$/ { ns[$1 "," $2] = $3; next }
    FNR == 1 { print "scene,way,x64,i686,ns" }
    { k = $1 "," $2; print k, $3, (k in i686 ? i686[k] : "-"), ns[k] }
' "$tmp/i686" "$tmp/ns" "$tmp/x64" >"$b/scenes_cost.csv"
mv "$tmp/scenes.csv" "$b/scenes.csv"
