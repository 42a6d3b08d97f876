#!/bin/bash
# modbus.sh: strangers at the registers of the box, then 10^6 reads and 10^6 requests. B: the build.
set -eu
B=${B:-build}
work=$B/modbus
mkdir -p "$work"
python3 -c 'import sys; sys.path.insert(0, "'"$B"'/pymodbus"); import pymodbus' 2>/dev/null ||
    python3 -m pip install -q --no-deps --target "$B/pymodbus" pymodbus ||
    { echo "modbus: missing: pymodbus: pip install --target $B/pymodbus pymodbus" >&2; exit 3; }
for scene in drop guarded bilateral; do
    "$B/posix/exhand" regs --scene $scene --csv > "$work/map.csv"
    rm -f "$work/saved"
    # gripped and let go at once: it stays OFF, and its values stand
    "$B/posix/exhand" run --scene $scene --pace --rate 500 --seconds 600 --let-go 0.001 --save "$work/saved" \
        --modbus tcp:127.0.0.1:0 > "$work/said" & box=$!
    trap 'kill $box 2>/dev/null || true' EXIT
    for i in $(seq 100); do grep -q '^modbus: tcp:' "$work/said" && break; sleep 0.1; done
    port=$(sed -n 's/^modbus: tcp:127.0.0.1://p' "$work/said")
    sleep 0.5
    echo "scene $scene"
    PYTHONPATH=$B/pymodbus python3 test/modbus/strangers.py "$port" "$work/map.csv" "$work/saved"
    kill -INT $box
    wait $box || [ $? = 130 ]
done
EXH_READS=${READS:-1000000} EXH_TEST=no_read_is_torn LIMIT=1200 test/run.sh "$B/test/sim/modbus_test"
EXH_REQUESTS=${REQUESTS:-1000000} LIMIT=1200 test/run.sh "$B/test/sim/modbus_fuzz_test"
