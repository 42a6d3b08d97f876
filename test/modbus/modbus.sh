#!/bin/bash
# modbus.sh: strangers at the registers of the box, then 10^6 reads and 10^6 requests. B: the build.
set -eu
B=${B:-build}
work=$B/modbus
mkdir -p "$work"
python3 -c 'import sys; sys.path.insert(0, "'"$B"'/pymodbus"); import pymodbus' 2>/dev/null ||
    python3 -m pip install -q --no-deps --target "$B/pymodbus" pymodbus ||
    { echo "modbus: missing: pymodbus: pip install --target $B/pymodbus pymodbus" >&2; exit 3; }

# The port, once the box has told it: a busy machine takes its time, a box that has ended never will.
port_of() {
    local from=$SECONDS port state="has ended"
    while [ $((SECONDS - from)) -lt 120 ]; do
        port=$(sed -n 's/^modbus: tcp:127\.0\.0\.1:\([0-9][0-9]*\)$/\1/p' "$work/said")
        [ -z "$port" ] || { echo "$port"; return 0; }
        kill -0 "$1" 2>/dev/null || break
        sleep 0.1
    done
    ! kill -0 "$1" 2>/dev/null || state="runs"
    { echo "modbus: no port told after $((SECONDS - from)) s; the box $state, and said:"; cat "$work/said"; } >&2
    return 1
}

rate=500
for scene in drop guarded bilateral; do
    "$B/posix/exhand" regs --scene $scene --csv > "$work/map.csv"
    rm -f "$work/saved" "$work/log"
    : > "$work/said"
    # gripped and let go at once: it stays OFF; what the device does goes on
    "$B/posix/exhand" run --scene $scene --pace --slack 1 --rate $rate --seconds 600 --let-go 0.001 --save "$work/saved" \
        --log "$work/log" --modbus tcp:127.0.0.1:0 > "$work/said" 2>&1 & box=$!
    trap 'kill $box 2>/dev/null || true' EXIT
    port=$(port_of $box)
    sleep 0.5
    echo "scene $scene"
    PYTHONPATH=$B/pymodbus python3 test/modbus/strangers.py "$port" "$work/map.csv" "$work/saved" "$work/read.json"
    kill -INT $box
    wait $box || [ $? = 130 ]
    trap - EXIT
    "$B/posix/exhand" csv "$work/log" --all --out "$work/log.csv"
    python3 test/modbus/logged.py "$work/read.json" "$work/map.csv" "$work/log.csv" $rate
    rm -f "$work/log" "$work/log.csv"
done
EXH_READS=${READS:-1000000} EXH_TEST=no_read_is_torn LIMIT=1200 test/run.sh "$B/test/sim/modbus_test"
EXH_REQUESTS=${REQUESTS:-1000000} LIMIT=1200 test/run.sh "$B/test/sim/modbus_fuzz_test"
