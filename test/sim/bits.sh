#!/bin/sh
# bits.sh DIR LOGS EXHAND...: every EXHAND (other compilers, optimisations, CPUs) must
# make the same tables and logs as those in LOGS, and replay these bit for bit from
# the start and from keyframes. Works in DIR; ends with `N passed, N failed`.
dir=$1 logs=$2
shift 2
passed=0 failed=0
verdict() { # NAME STATUS
    if [ "$2" = 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)) && echo "FAIL $1"; fi
}
mkdir -p "$dir"
for exe in "$@"; do
    before=$passed of=3
    out=$dir/out
    rm -rf "$out"
    "$exe" drop --out "$out" >"$dir/table.txt" 2>&1
    verdict "$exe: drop" $?
    cmp "$logs/table2.csv" "$out/table2.csv"
    verdict "$exe: table2.csv" $?
    "$exe" calibrate --out "$out/calibration" >"$dir/calibration.txt" 2>&1 &&
        cmp "$logs/calibration/calibration.csv" "$out/calibration/calibration.csv"
    verdict "$exe: calibration.csv" $?
    "$exe" glove --record "$out/glove.exh" --does poses --seconds 5 >"$dir/glove.txt" 2>&1
    for log in "$logs"/*.exh; do
        cmp "$log" "$out/${log##*/}"
        verdict "$exe: ${log##*/} made" $?
        of=$((of + 4))
        for from in 0 1 3000; do
            "$exe" replay "$log" --from $from >"$dir/replay.txt" 2>&1
            status=$?
            verdict "$exe: ${log##*/} replayed from $from" $status
            [ $status = 0 ] || cat "$dir/replay.txt"
        done
    done
    echo "$exe: $((passed - before)) of $of"
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
