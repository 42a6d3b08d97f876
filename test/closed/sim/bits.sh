#!/bin/sh
# SPDX-License-Identifier: MIT
# bits.sh DIR LOGS EXHAND...: every EXHAND must make the same tables and logs as those in LOGS, and
# replay these bit for bit from the start and from keyframes. EXHAND are builds by other compilers,
# optimisations or CPUs. Works in DIR. Ends with `N passed, N failed`.
# Environment: JOBS (1), of them at a time. TABLE2, the table of `exhand drop --runs 3`. FAULTS, the
# output of `exhand-lab faults --rate 100`, if it is to be compared, too.

# one EXHAND: what it says, and its `N of N` at the end
one()
{
    exe=$1 passed=0 failed=0
    work=$(mktemp -d "$dir/XXXXXX") || exit 3
    out=$work/out
    "$exe" drop --runs 3 --out "$out" >"$work/table.txt" 2>&1
    verdict drop $?
    cmp "$TABLE2" "$out/table2.csv"
    verdict table2.csv $?
    "$exe" calibrate --out "$out/calibration" >"$work/calibration.txt" 2>&1 &&
        cmp "$logs/calibration/calibration.csv" "$out/calibration/calibration.csv"
    verdict calibration.csv $?
    "$exe" bilateral --out "$out/bilateral" >"$work/bilateral.txt" 2>&1
    verdict bilateral $?
    for made in "$logs"/bilateral/*.exh "$logs/bilateral/contacts.csv"; do
        cmp "$made" "$out/bilateral/${made##*/}"
        verdict "bilateral: ${made##*/}" $?
    done
    if [ -n "${FAULTS:-}" ]; then
        "$exe" faults --rate 100 --jobs 1 >"$work/faults.txt" 2>&1 &&
            cmp "$FAULTS" "$work/faults.txt"
        verdict faults $?
    fi
    "$exe" glove --record "$out/glove.exh" --does poses --seconds 5 >"$work/glove.txt" 2>&1
    for log in "$logs"/*.exh; do
        cmp "$log" "$out/${log##*/}"
        verdict "${log##*/} made" $?
        for from in 0 1 3000; do
            "$exe" replay "$log" --from $from >"$work/replay.txt" 2>&1
            status=$?
            verdict "${log##*/} replayed from $from" $status
            [ $status = 0 ] || cat "$work/replay.txt"
        done
    done
    rm -rf "$work"
    echo "$exe: $passed of $((passed + failed))"
}
verdict() # NAME STATUS
{
    if [ "$2" = 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)) &&
        echo "FAIL $exe: $1"; fi
}

if [ "$1" = --one ]; then
    dir=$2 logs=$3
    said=$(one "$4" 2>&1)
    echo "$said"
    exit 0
fi

dir=$1 logs=$2
shift 2
rm -rf "$dir"
mkdir -p "$dir"
for exe in "$@"; do echo "$exe"; done | xargs -n 1 -P "${JOBS:-1}" "$0" --one "$dir" "$logs" \
    >"$dir/said"
cat "$dir/said"
awk -v want=$# '
    / [0-9]+ of [0-9]+$/ { n++; passed += $(NF - 2); all += $NF }
    END { failed = all - passed + want - n # one that said nothing has failed
          printf "%d passed, %d failed\n", passed, failed; exit failed || !passed }' "$dir/said"
