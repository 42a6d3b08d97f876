#!/bin/bash
# SPDX-License-Identifier: MIT
# The image's Modbus slave under QEMU: modbus.sh [READS]
#   ways       what is said where there is no UART, or an option that does not hold
#   master     a separate client (modbus.py) reads, writes and commands; no tick is missed, and the
#              log replays bit for bit
#
# B: the build (build). Time is virtual, 8 ns an instruction (4 at two rates), and the processor
# never sleeps. A request comes when the host sends it, so every run is different. It says nothing
# of a real line's timing.
# Exit status: 0 all as expected, 1 not, 2 bad usage, 3 something is missing (it says what).
set -u

b=${B:-build}
image=$b/pc104/drop-none.elf run=ports/pc104/run.sh reads=${1:-60}
dir=$(mktemp -d) || exit 3
pid=
clean()
{
    [ -z "$pid" ] || kill "$pid" 2>/dev/null
    rm -rf "$dir"
}
trap clean EXIT
trap 'exit 130' INT TERM
name=modbus
. test/image/pc104/check.sh
port=$((20000 + ($$ + 7919) % 20000))

for tool in qemu-system-i386:qemu-system-x86 python3:python3; do
    command -v "${tool%:*}" >/dev/null || {
        echo "modbus: ${tool%:*}: not found: install the package ${tool#*:}" >&2
        exit 3
    }
done

boot() # STATUS LINE OPTION...
{
    local want=$1 line=$2 status
    shift 2
    QEMU_FLAGS="-icount shift=3,sleep=off" TIMEOUT_s=60 $run "$image" "$@" >"$dir/said" 2>"$dir/err"
    status=$?
    check "options '$*': status $status, want $want" [ "$status" = "$want" ]
    check "options '$*': $line" says "$line"
}

form='com2,ADDRESS,BAUD\[,write\]\[,remote\]$'
beside="s526_a=576" # the default base has COM2's ports
boot 0 '^modbus: no 16550 with a FIFO at COM2: goes on without$' ticks=100 $beside \
    modbus=com2,1,57600
boot 2 '^option modbus: its ports 0x000002f8\.\.0x000002ff are also those of s526_a, '\
'0x000002c0\.\.0x000002ff: give that card another base, .* or leave modbus= out$' \
    ticks=100 modbus=com2,1,57600
boot 2 '^option modbus: .* are also those of s526_b, ' modbus=com2,1,57600 $beside s526_b=704 full=1
boot 0 '^done$' ticks=100 modbus=com2,1,57600 $beside s526_b=704 # one finger: that card is not used
boot 2 '^option modbus: baud 115200: its FIFO overflows in a tick of this rate: '\
'take at most 57600, or a rate of at least 823 Hz$' \
    ticks=100 rate=500 modbus=com2,1,115200 $beside
boot 2 '^option modbus: baud 9600: .*: take at most 7200, or a rate of at least 69 Hz$' ticks=100 \
    rate=60 modbus=com2,1,9600 $beside
boot 2 "^option modbus=com1,1,9600: $form" modbus=com1,1,9600
boot 2 "^option modbus=com2,1: $form" modbus=com2,1
boot 2 "^option modbus=com2,1,9600,far: $form" modbus=com2,1,9600,far
boot 2 '^option modbus=com2,0,9600: address 1\.\.247$' modbus=com2,0,9600
boot 2 '^option modbus=com2,1,9601: baud: 115200 and whole parts of it, down to 1200$' \
    modbus=com2,1,9601

replays()
{
    "$b/posix/exhand" replay "$dir/log" >>"$dir/said" 2>&1
}

priced()
{
    says '^budget measured: ' && ! says 'not in the budget$'
}

# master TICKS RATE BAUD [remote]: its client ends long before its ticks do. 4 ns an instruction: at
# 8 ns the dearest tick, with a keyframe and the dearest request, would be more than 0.5 ms.
master()
{
    local ticks=$1 rate=$2 baud=$3 remote=${4:-} status
    QEMU_FLAGS="-icount shift=2,sleep=on -serial tcp:127.0.0.1:$port,server=on,wait=on" \
        RECORDS=$dir/log TIMEOUT_s=300 \
        $run "$image" "ticks=$ticks" "rate=$rate" idle=spin log=debug uncalibrated=1 \
        "modbus=com2,1,$baud,write${remote:+,$remote}" $beside \
        >"$dir/said" 2>"$dir/err" &
    pid=$!
    python3 test/image/pc104/modbus.py "$port" "$reads" $remote >"$dir/client" 2>&1
    status=$?
    check "$rate Hz, $baud baud: client: $(cat "$dir/client")" [ $status = 0 ]
    wait $pid
    status=$?
    pid=
    check "$rate Hz, $baud baud: the image ends with $status" [ $status = 0 ]
    check "$rate Hz, $baud baud: the dearest request is in the budget" priced
    check "$rate Hz, $baud baud: no tick missed" says "^ticks $ticks run, 0 missed$"
    check "$rate Hz, $baud baud: one damaged, one for others" says \
        '^modbus answers [0-9]+, damaged 1, for others 1, refused [0-9]+$'
    check "$rate Hz, $baud baud: its log replays" replays
    tr -d '\r' <"$dir/said" | grep -a '^modbus answers' | sed "s/^/  | $rate Hz, $baud baud: /"
    port=$((port + 1))
}

master 15000 500 57600
master 50000 2000 115200 remote

# The rule of gains holds against a client, too.
gains='rule_on=1 rule_rate=500 rule_k_min=1000 rule_b1=30 rule_k0=9000 rule_k1=2000 k=5000 b=15'
# shellcheck disable=SC2086 # one option a word
QEMU_FLAGS="-icount shift=3,sleep=on -serial tcp:127.0.0.1:$port,server=on,wait=on" TIMEOUT_s=120 \
    $run "$b/pc104/guarded-none.elf" ticks=10000 rate=500 idle=spin uncalibrated=1 \
    modbus=com2,1,57600,write $beside $gains \
    >"$dir/said" 2>"$dir/err" &
pid=$!
python3 test/image/pc104/modbus.py "$port" rule >"$dir/client" 2>&1
status=$?
check "rule of gains: client: $(cat "$dir/client")" [ $status = 0 ]
wait $pid
status=$?
pid=
check "rule of gains: the image ends with $status" [ $status = 0 ]

echo "modbus: $checks checks, $failed failed"
[ "$failed" = 0 ]
