#!/bin/bash
# SPDX-License-Identifier: MIT
# modbus.sh: strangers at the registers of the box, then 10^6 reads and 10^6 requests. B: the build.
set -eu
B=${B:-build}
work=$B/modbus
mkdir -p "$work"
python3 -c 'import sys; sys.path.insert(0, "'"$B"'/pymodbus"); import pymodbus, serial' \
    2>/dev/null ||
    python3 -m pip install -q --no-deps --upgrade --target "$B/pymodbus" pymodbus pyserial ||
    {
        echo "modbus: missing: pymodbus, pyserial:" \
            "pip install --target $B/pymodbus pymodbus pyserial" >&2
        exit 3
    }

# Prints the text after "modbus: " once the box has printed its address. A busy machine takes its
# time. A box that has ended never prints one.
told_by()
{
    local from=$SECONDS place state="has ended"
    while [ $((SECONDS - from)) -lt 120 ]; do
        place=$(sed -n 's/^modbus: \([^,]*\).*$/\1/p' "$work/said")
        [ -z "$place" ] || { echo "$place"; return 0; }
        kill -0 "$1" 2>/dev/null || break
        sleep 0.1
    done
    ! kill -0 "$1" 2>/dev/null || state="runs"
    { echo "modbus: no place told after $((SECONDS - from)) s; the box $state, and said:"
    cat "$work/said"; } >&2
    return 1
}

rate=500
box=0 line=0
trap 'for p in $box $line; do [ $p = 0 ] || kill $p 2>/dev/null || true; done' EXIT

# SCENE WHERE [OTHER]: the scene serves WHERE. The clients use the port it prints, or OTHER.
strangers()
{
    local place
    "$B/posix/exhand" regs --scene "$1" --csv > "$work/map.csv"
    rm -f "$work/saved" "$work/log"
    : > "$work/said"
    # Gripped and let go immediately: it stays OFF, but the device still moves.
    "$B/posix/exhand" run --scene "$1" --pace --rate $rate --seconds 600 --let-go 0.001 --slack 1 \
        --save "$work/saved" \
        --log "$work/log" --modbus "$2" --modbus-write > "$work/said" 2>&1 & box=$!
    place=$(told_by $box)
    sleep 0.5
    echo "scene $1, ${2%%:*}"
    PYTHONPATH=$B/pymodbus python3 test/device/modbus/strangers.py "${3:-${place##*:}}" \
        "$work/map.csv" "$work/saved" "$work/read.json"
    kill -INT $box
    wait $box || [ $? = 130 ]
    box=0
    "$B/posix/exhand" csv "$work/log" --all --out "$work/log.csv"
    python3 test/device/modbus/logged.py "$work/read.json" "$work/map.csv" "$work/log.csv" $rate
    rm -f "$work/log" "$work/log.csv"
}

for scene in drop guarded bilateral; do strangers $scene tcp:127.0.0.1:0; done

# The same over a serial line: two pseudo-terminals, crossed.
: > "$work/line"
python3 test/device/modbus/pair.py > "$work/line" & line=$!
for _ in $(seq 100); do [ -s "$work/line" ] && break; sleep 0.1; done
read -r ours theirs < "$work/line"
strangers drop "rtu:$ours:115200" "$theirs"
kill $line
line=0

EXH_READS=${READS:-1000000} EXH_TEST=no_read_is_torn LIMIT=1200 test/run.sh \
    "$B/test/sim/modbus_reads_test"
EXH_REQUESTS=${REQUESTS:-1000000} LIMIT=1200 test/run.sh "$B/test/sim/modbus_fuzz_test"
