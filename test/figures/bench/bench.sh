#!/bin/sh
# SPDX-License-Identifier: MIT
# What each kernel costs and how wrong it is: bench.sh [--update]
#
# Builds nothing: runs kernels, velocity and speed from $B/bench, the first and the last also under
# callgrind, and kernels-i686, if it was built, under callgrind alone. Writes $B/bench/bench.csv and
# velocity.csv, prints the tables and the changes since test/figures/bench/baseline.csv.
# Instructions are printed, never fatal: they are the compiler's as much as ours. --update makes
# this run the baseline.
#
# Environment: B (build); SPEED=no: the simulation is left out.
# Exit status: 0 ok, 1 an error above its documented bound, or a kernel of the baseline is gone,
# 2 bad usage, 3 valgrind or a binary missing.
set -eu

b=${B:-build}/bench
here=test/figures/bench
update=no
LC_ALL=C
export LC_ALL

[ "${1:-}" = --update ] && { update=yes; shift; }
[ $# = 0 ] || { echo "usage: bench.sh [--update]" >&2; exit 2; }
[ -r "$here/bench.sh" ] || { echo "bench: run it at the top of the tree" >&2; exit 2; }
for p in kernels velocity speed; do
    [ -x "$b/$p" ] || { echo "bench: $b/$p: not there: make bench builds it" >&2; exit 3; }
done
command -v valgrind >/dev/null 2>&1 || {
    echo "bench: valgrind: missing: install by: sudo apt-get install -y --no-install-recommends" \
        "valgrind" >&2
    exit 3
}

tmp=$(mktemp -d) || exit 3
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM

. "$here/callgrind.sh"

# --- the run ---

built=$("$b/kernels" build)
printf 'build: %s\n' "$built"
printf 'tools: %s; host: %s %s\n\n' "$(valgrind --version)" "$(uname -s)" "$(uname -m)"

"$b/kernels" errors >"$tmp/errors"
"$b/kernels" anchors >"$tmp/anchors"

counts "$b/kernels" >"$tmp/counts"
: >"$tmp/counts-i686"
if [ -x "$b/kernels-i686" ]; then
    counts "$b/kernels-i686" >"$tmp/counts-i686"
else
    echo "i686: not counted, shown as \"-\": i686-linux-gnu-gcc missing"
fi

# name,unit,error_max,error_rms,error_max_lsb,error_rms_lsb,bound_lsb,inputs,why -> bench.csv;
# the first line of the counts is the empty op. Anchors: name,instructions,source.
awk -F, -v OFS=, '
    FNR == 1 { empty = "" }
    FILENAME ~ /counts/ { if (empty == "") empty = $3; n = sprintf("%.2f", ($3 - empty) / $2)
                          if (FILENAME ~ /i686/) i686[$1] = n; else count[$1] = n; next }
    FILENAME ~ /anchors/ { anchor[$1] = $2; next }
    /^#/ { next }
    !n_rows++ { print "name,instructions,error_max_lsb,error_rms_lsb,bound_lsb,unit,error_max," \
                "error_rms,inputs,anchor_instructions,instructions_i686" }
    { print $1, count[$1], $5, $6, $7, $2, $3, $4, $8, \
            ($1 in anchor ? anchor[$1] : ""), ($1 in i686 ? i686[$1] : "-") }
' "$tmp/counts" "$tmp/counts-i686" "$tmp/anchors" "$tmp/errors" >"$b/bench.csv"

# --- kernels ---

awk -F, '
    NR == 1 { printf "%-20s %9s %9s %9s | %-6s %9s %9s | %9s %9s %7s\n", "kernel", "instr/op", \
              "(anchor)", "i686", "unit", "max", "rms", "max LSB", "rms LSB", "bound"; next }
    { printf "%-20s %9.2f %9s %9s | %-6s %9s %9s | %9s %9s %7s\n", $1, $2, \
             ($10 == "" ? "" : "(" $10 ")"), $11, $6, $7, $8, $3, $4, $5 }
' "$b/bench.csv"
echo
echo "instr/op, i686: inside bench_measure() by callgrind, an empty op subtracted;" \
    "mean of 1024 ops."
echo "Errors against long double or exact integers. Bounds and inputs:"
awk -F, '!/^#/ { why = $9; for (i = 10; i <= NF; i++) why = why "," $i
                 printf "  %-20s %s\n", $1, why }' "$tmp/errors"
sed -n 's/^# //p' "$tmp/errors"
echo "(anchor): instructions of a peer on x86-64, measured once elsewhere, NOT in this run:"
awk -F, '{ s = $3; for (i = 4; i <= NF; i++) s = s "," $i
           printf "  %-20s %6s  %s\n", $1, $2, s }' "$tmp/anchors"
awk -F, '{ n[$1] = $2 }
    END { printf "Ratios in this run, x5: law / double %.2f, law / float %.2f; law and force," \
                 " which has the clamp too: %.2f, %.2f.\n", \
                 n["contact_law_x5"] / n["plain_double_law_x5"], \
                 n["contact_law_x5"] / n["plain_float_law_x5"], \
                 n["law_and_force_x5"] / n["plain_double_law_x5"], \
                 n["law_and_force_x5"] / n["plain_float_law_x5"] }' "$b/bench.csv"

# --- velocity ---

"$b/velocity" >"$tmp/velocity"
awk -F, -v OFS=, '
    NR == FNR { count[$1] = $2; next }
    FNR == 1 { print $0, "instructions"; next }
    { print $0, ($1 == "measured" ? count[$3] : "") }
' "$b/bench.csv" "$tmp/velocity" >"$b/velocity.csv"
echo
echo "velocity at 2 kHz: error at constant speed, rms/max in mm/s; lag at 5 m/s2; rms on a sine of"
echo "5 Hz, 10 mm. theory: the same estimators, simulated once in floating point, not in this run."
awk -F, '
    $4 != step { step = $4
        if (FNR > 1) printf "%-22s %13s %13s %13s %13s %7s %7s %7s\n", "D = " step " um", \
            "1 mm/s", "10 mm/s", "0.1 m/s", "1 m/s", "lag ms", "sine", "instr" }
    FNR > 1 { printf "%-22s %13s %13s %13s %13s %7s %7s %7s\n", \
        ($1 == "theory" ? "  theory" : $2), $5 "/" $6, $7 "/" $8, $9 "/" $10, $11 "/" $12, \
        $13, $14, $15 }
' "$b/velocity.csv"

# --- simulation ---

simulated()
{
    echo
    "$b/speed"
    whole=${B:-build}/whole/bench/speed
    if [ -x "$whole" ]; then
        echo "The same, compiled whole by -O3:"
        "$whole"
    fi
    for e in drop bilateral bilateral5; do
        for fn in exh_loop tick advance_to; do # the scene is reached as a static function, tick
            profile "$fn" "$b/speed" "$e" 4000 >/dev/null
            echo "$fn,$(total "$tmp/cg")"
        done | awk -F, -v e="$e" '{ n[$1] = $2 }
            END { all = n["exh_loop"]
                  ticks = e == "drop" ? 4000 : 3 * 4000 # at each of three speeds
                  printf "  %s: %.0f instructions a tick (of the first 4000): device %.1f %%," \
                         " scene tick %.1f %%, board, glove, link and loop %.1f %%\n", \
                         e, all / ticks, 100 * n["advance_to"] / all, 100 * n["tick"] / all, \
                         100 * (all - n["advance_to"] - n["tick"]) / all }'
    done
}
[ "${SPEED:-yes}" = no ] || simulated

# --- baseline ---

if [ $update = yes ]; then
    { echo "# $built; $(valgrind --version); made by make bench ARGS=--update"
      cut -d, -f1-4,11 "$b/bench.csv"; } >"$here/baseline.csv"
    echo
    echo "$here/baseline.csv: written"
fi
[ -r "$here/baseline.csv" ] || {
    echo "bench: $here/baseline.csv: not there: bench.sh --update makes it" >&2
    exit 1
}

echo
awk -F, '
    function moved(from, to) { return sprintf("%10.2f %10.2f %+8.1f %%", from, to, \
                                              from ? 100 * (to / from - 1) : 0) }
    /^#/ { base = substr($0, 3); next }
    $1 == "name" { next }
    NR == FNR { was[$1] = $2; max[$1] = $3; was_i686[$1] = $5; order[n++] = $1; next }
    { now[$1] = $2
      if ($3 + 0 > $5 + 0) { printf "FAIL %s: error %s LSB above its bound of %s\n", $1, $3, $5
                             bad = 1 }
      if (!($1 in was)) { printf "new: %s, %s instructions, i686 %s\n", $1, $2, $11; next }
      if ($2 != was[$1]) change[$1] = moved(was[$1], $2)
      if ($11 != "-" && was_i686[$1] + 0 > 0 && $11 != was_i686[$1])
          change[$1] = (($1 in change) ? change[$1] : sprintf("%32s", "")) " | i686" \
                       moved(was_i686[$1], $11)
      if ($3 != max[$1]) { printf "error of %s: max was %s, now %s LSB\n", $1, max[$1], $3 } }
    END {
      for (i = 0; i < n; i++) {
          k = order[i]
          if (!(k in now)) { printf "FAIL %s: in the baseline, gone now\n", k; bad = 1 }
          if (k in change) {
              if (!shown++) printf "%-20s %10s %10s %11s\n", "instructions of", "was", "now", ""
              printf "%-20s %s\n", k, change[k] } }
      if (!shown && !bad) print "instructions: as in the baseline (" base ")"
      else if (shown) print "baseline: " base
      exit bad }
' "$here/baseline.csv" "$b/bench.csv"
