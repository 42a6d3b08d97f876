#!/bin/bash
# SPDX-License-Identifier: MIT
# boot.sh DIR: boots images under QEMU in every way that must end well, safe or refused. DIR holds
# the images of all scenes, SCENE.elf and SCENE-none.elf (CARDS=none), and drop-none.iso.
#
# Each case has the exit status of ports/pc104/run.sh, the expected output of the image, and its
# options. Time is virtual. Yet when the processor sleeps, QEMU may take it past the next tick, too
# (some in 10^5, more on a loaded host). In cases that may miss none, it does not sleep (idle=spin).
#
# EXHAND names the host program, which replays the records.
# Exit status: 0 all as expected, 1 not, 2 bad usage, 3 no QEMU.
set -u

run=ports/pc104/run.sh
exhand=${EXHAND:-build/posix/exhand}
[ $# -eq 1 ] && [ -r "$1/drop-none.elf" ] || { echo "usage: $0 DIR" >&2; exit 2; }
image=$1/drop-none.elf
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
virtual="-icount shift=3,sleep=off"
cases=0 failed=0

fail() # WHAT
{
    echo "boot: $*" >&2
    tr -cd '\11\12\40-\176' <"$out/said" >&2 # a dump on the same line has other bytes
    failed=$((failed + 1))
}

# boots STATUS PATTERN OPTION...: the pattern, extended, must match a line
boots()
{
    local want=$1 pattern=$2 status
    shift 2
    cases=$((cases + 1))
    RECORDS="$out/records" TIMEOUT_s=60 $run "$image" "$@" >"$out/said" 2>"$out/err"
    status=$?
    [ "$status" = 3 ] && { cat "$out/err" >&2; exit 3; }
    [ "$status" = "$want" ] || { fail "options '$*': status $status, want $want"; return; }
    tr -d '\r' <"$out/said" | grep -aqE "$pattern" || fail "options '$*': no line '$pattern'"
}

# says PATTERN: the last image said that, too
says()
{
    tr -d '\r' <"$out/said" | grep -aqE "$1" || fail "no line '$1'"
}

says_not() # PATTERN
{
    tr -d '\r' <"$out/said" | grep -aqE "$1" && fail "a line '$1'"
}

# safe STATUS PATTERN OPTION...: nothing was said in the loop before the outputs were safe
safe()
{
    boots "$@"
    tr -d '\r' <"$out/said" | grep -a -A 1 '^budget measured' | tail -n 1 |
        grep -qx 'outputs safe' ||
        fail "said something before the outputs were safe"
}

# monitored STATUS PATTERN COMMANDS OPTION...: as safe, with commands for QEMU's monitor in the
# loop; its answers are in $out/monitor
monitored()
{
    local want=$1 pattern=$2 commands=$3 feeder reader
    shift 3
    mkfifo "$out/m.in" "$out/m.out"
    (
        for _ in {1..300}; do
            grep -aqs '^budget measured' "$out/said" && break
            sleep 0.2
        done
        sleep 1
        printf '%s\n' "$commands"
    ) >"$out/m.in" & # opened when QEMU opens it
    feeder=$!
    tr -d '\r' <"$out/m.out" >"$out/monitor" &
    reader=$!
    QEMU_FLAGS="$virtual -chardev pipe,id=m,path=$out/m -mon chardev=m" \
        safe "$want" "$pattern" ticks=0 "$@"
    kill "$feeder" "$reader" 2>"$out/err"
    wait "$feeder" "$reader" 2>"$out/err"
    rm "$out/m.in" "$out/m.out"
}

# Well.
boots 0 '^rate 2000 Hz asked, timer HPET of 100000000 Hz, period 1/2000 s, 0 ppm off$' ticks=4000 \
    uncalibrated=1 idle=spin
says '^exhand [0-9.]+, wire [0-9]+, record [0-9]+, board pc104 version 1, scene drop$'
says '^second clock local APIC$'
says '^budget measured: scene [0-9.]+ us, cards and link [0-9.]+ us, with headroom [0-9.]+ us$'
says '^ticks 4000 run, 0 missed$'
says '^tick_max [0-9]+ ns$'
says '^tick_wake [0-9]+ ns$'
says '^tick_bin 4000( 0){16}$'
says ', enable 0x00000001$' # the dead-man switch was taken: it ran
says '^done$'
boots 0 'period 1111111/100000000 s, 0.0' rate=90 ticks=300
boots 0 '^ticks 2000 run, 0 missed$' rate=20000 ticks=2000 idle=spin
boots 0 'timer 8254 of 1193182 Hz, period 1193/1193182 s, 152' timer=pit rate=1000 ticks=1000 \
    idle=spin
says '^ticks 1000 run, 0 missed$'

boots 0 '^gap longest [0-9.]+ us in 0.25 s, a tick of this rate leaves 9[0-9.]+ us, longer 0$' \
    gap=0.25 rate=1000 ticks=100
boots 0 '^gap longest [0-9.]+ us in 0.125 s, a tick of this rate leaves 0 us, longer [1-9][0-9]*$' \
    gap=0.125 rate=1000 ticks=100 budget=1000 headroom=0
boots 0 '^gap longest [0-9.]+ us in 0.125 s,' gap=0.125 rate=1000 ticks=100 timer=pit

# Records of bare metal, replayed here bit for bit.
if [ -x "$exhand" ]; then
    boots 0 '^records lost 0$' log=debug ticks=3000 uncalibrated=1 k=1234.5 q_lim=0.05 b=12
    "$exhand" replay "$out/records" >"$out/replay" 2>&1 || { fail "replay"; cat "$out/replay" >&2; }
    grep -q '3000 ticks from tick 0 and 3 keyframes identical' "$out/replay" ||
        { fail "replay"; cat "$out/replay" >&2; }
    boots 0 '^records lost 0$' log=serial ticks=1000 rate=1000
fi

# Calibrations. Without one the box does not arm, with a good one it does. Others are refused by
# name: invalid, of another box, too old, of another finger, made with other scales.
boots 0 '^arming refused at calibration$' ticks=1000
says '^no calibration: arming will be refused at calibration '
says ', enable 0x00000000$'
if [ -x "$exhand" ]; then
    calibrated() # DIR [FINGER [OPTION...]]: made with the scales that the scene has
    {
        dir=$out/$1 finger=${2:-$1}
        shift $(($# > 2 ? 2 : $#))
        "$exhand" calibrate --finger "$finger" "$@" --day 20000 --device dac_scale=1846.02272034 \
            --device mon_scale=0.000516399999469 \
            --out "$dir" >"$out/replay" || { fail "calibrate"; cat "$out/replay" >&2; }
    }
    calibrated 0
    export MODULES=$out/0/calibration.bin
    boots 0 '^module 1: calibration, 132 bytes$' ticks=1000 device_id=1 day=20090
    says ', enable 0x00000001$'
    boots 2 '^calibration 1: device: refused$' ticks=1000 day=20000
    boots 2 '^calibration 1: age: refused$' ticks=1000 device_id=1
    boots 2 '^calibration 1: age: refused$' ticks=1000 device_id=1 day=20091
    boots 2 '^calibration 1: scale or zero of D/A or monitor: refused$' ticks=1000 device_id=1 \
        day=20000 dac_zero=32700
    says '^calibration too old, or made before a change$'
    # Sound in all else, but of a motor with twice the force: refused, unless that is waived.
    calibrated 2 0 --device kf=7
    MODULES=$out/2/calibration.bin
    boots 2 '^calibration 1: force over current, finger 0, point 1: 6[.].*: refused$' ticks=1000 \
        device_id=1 day=20000
    says 'far_calibration=1 believes it$'
    boots 0 ', enable 0x00000001$' ticks=1000 device_id=1 day=20000 far_calibration=1
    MODULES=$out/1.bin
    head -c 100 "$out/0/calibration.bin" >"$MODULES"
    boots 2 '^calibration 1: image: refused$' ticks=1000 device_id=1 day=20000 uncalibrated=1
    image=$1/bilateral-none.elf
    MODULES=$out/0/calibration.bin
    # of the index finger there is none
    boots 0 '^arming refused at calibration$' ticks=1000 device_id=1 day=20000
    says ', enable 0x00000000$'
    calibrated 1
    MODULES=$out/1/calibration.bin,$out/0/calibration.bin
    boots 0 '^module 2: calibration, 132 bytes$' ticks=1000 device_id=1 day=20000 fingers=3
    says ', enable 0x00000003$'
    image=$1/drop-none.elf
    MODULES=$out/1/calibration.bin
    boots 2 '^calibration 1: finger: refused$' ticks=1000 device_id=1 day=20000
    unset MODULES
fi

# The black box: 0.8 N of a wall at the string's start, and a monitor that reads nothing. The fault
# is reported by the image and again by the host. In the loop, after a processor exception, and on
# the words' own line.
told() # FILE PATTERN
{
    "$exhand" replay --timeline "$1" >"$out/replay" 2>&1 ||
        { fail "replay of a dump"; cat "$out/replay" >&2; }
    grep -qE "$2" "$out/replay" || { fail "a dump without '$2'"; cat "$out/replay" >&2; }
}
if [ -x "$exhand" ]; then
    wall="uncalibrated=1 q_lim=-0.0004 k=2000 track_tol=0.1 rate=1000"
    # shellcheck disable=SC2086 # words
    boots 0 '^ticks 2000 run, 0 missed$' dump=debug ticks=2000 idle=spin $wall
    told "$out/records" 'FAULT tracking: '
    boots 5 '^black box: its end$' dump=debug uncalibrated=1 provoke=divide provoke_at=800
    told "$out/records" 'the box was halted: the black box ends here$'
    # shellcheck disable=SC2086 # words
    boots 0 '^ticks 2500 run, 0 missed$' dump=serial dump_kib=48 ticks=2500 idle=spin $wall
    told "$out/said" 'FAULT tracking: '
    # shellcheck disable=SC2086 # words
    boots 0 '^records lost 0$' dump=serial log=debug dump_kib=48 ticks=2500 idle=spin $wall
    told "$out/said" 'FAULT tracking: '
    told "$out/records" 'FAULT tracking: '
fi
boots 2 '^option dump: the log goes there$' dump=debug log=debug
boots 2 '^option dump_kib: too little to hold a fault at this rate$' dump=debug dump_kib=16

# Refused.
boots 2 '^option k=2e7: allowed 0\.\.' k=2e7
boots 2 '^option stiffness=1: no such parameter' stiffness=1
boots 2 '^option timer=quartz: one of auto hpet pit$' timer=quartz
boots 2 '^option k=1x: allowed' k=1x
boots 2 '^option k: not name=value$' k
# shellcheck disable=SC2046 # words
boots 2 '^options longer than 1023 characters$' $(printf 'k=1000 %.0s' {1..150})
boots 2 '^option rate=20001: allowed 0..20000 hz$' rate=20001
boots 6 '^rate 20000 Hz \(the 8254 does not come within 1000 ppm of it\): take 19906$' timer=pit \
    rate=20000
boots 6 '^rate 2000 Hz: a tick costs more than its period: take at most 1333 Hz$' budget=600 \
    rate=2000
boots 0 'done' budget=600 rate=1333 ticks=100

# Safe. Provoked faults show that the outputs were made safe before the message.
safe 5 '^divide error, vector 0, error 0x00000000, eip 0x001[0-9a-f]+, tick 300$' provoke=divide \
    provoke_at=300
safe 5 '^invalid opcode, vector 6, ' provoke=opcode
safe 5 '^page fault, vector 14, error 0x00000000, .* address 0x00000010, tick 100$' provoke=null
safe 5 '^page fault, vector 14, error 0x00000003, ' provoke=write
safe 5 '^stack overflow, vector 8, ' provoke=stack
safe 5 '^NMI, vector 2, ' provoke=nmi
safe 5 '^machine check, vector 18, ' provoke=mce
# One that the processor itself raises, and what its bank says.
# The page of restart.c's mark is uncached and written through (C, T); that of the image is not.
monitored 5 '^machine check, vector 18, ' 'info tlb
mce 0 1 0xb200000000000123 0x4 0 0'
says '^machine check bank 1: status 0xb2000000 0x00000123$'
grep -qE '^0+c00000: .*CT' "$out/monitor" || fail "the page of the mark at 14 MiB is cached"
grep -E '^0+100000: ' "$out/monitor" | grep -q CT && fail "the page of the image is not cached"
QEMU_CPU=n270,-mca safe 5 '^machine check, vector 18, ' provoke=mce
boots 0 '^irq_spurious 2$' provoke=spurious ticks=300
safe 7 '^overload: a tick hangs$' provoke=hang
safe 7 '^overload: more ticks late than overload_max allows$' provoke=slow
says '^tick_late 10[12]$'
safe 7 'overload_max allows$' provoke=slow overload_max=0
says '^tick_late [12]$'
boots 0 '^tick_late 30[0-9]$' provoke=slow overload_max=0 grace=400 ticks=300
safe 8 '^timer: no tick for four periods, by the second clock$' provoke=timer
safe 8 '^timer: no tick for four periods, by the second clock$' provoke=timer timer=pit rate=1000
safe 7 '^overload: a tick hangs$' provoke=hang provoke_at=10 grace=2000000000
safe 5 '^another exception while one was dealt with$' provoke=twice
safe 7 '^overload: a tick hangs$' provoke=idle
safe 7 '^tick does not end, vector 32, error 0x00000065,' provoke=hang hang=10000 rate=100
safe 8 '^timer: no tick for four periods, by the second clock$' provoke=mask
safe 8 '^timer: it counts, but its interrupts do not come$' provoke=mask idle=spin
safe 1 '^ports/pc104/provoke.c:[0-9]+$' provoke=assert

# A reset in the middle of a run: the next boot says so and runs nothing.
REBOOT="-action reboot=reset" boots 0 '^restart: the run before did not end: ' provoke=reset \
    ticks=500 idle=spin
says '^ticks 500 run, 0 missed$'
says ', enable 0x00000000$'
[ "$(tr -d '\r' <"$out/said" | grep -ac '^exhand ')" = 2 ] || fail "two boots"

# Other machines: no HPET, nothing but what a PC/AT had, no local APIC.
QEMU_FLAGS="$virtual -M q35" boots 0 'timer HPET of' ticks=500
QEMU_FLAGS="$virtual -no-hpet" boots 0 'timer 8254 of' ticks=500
says '^timer HPET: not there$'
QEMU_FLAGS="$virtual -no-hpet" boots 8 '^timer HPET: not there$' timer=hpet
QEMU_FLAGS="$virtual -M isapc" boots 0 '^ticks 500 run, 0 missed$' ticks=500 idle=spin
QEMU_CPU=n270,-apic boots 0 '^second clock none: ' ticks=500
for cpu in 486 pentium n270,-cmov; do
    QEMU_CPU=$cpu boots 2 '^this image needs an i686 processor \(CMOV'
done
QEMU_CPU=pentium2 boots 0 '^done$' ticks=100

# Nothing there: every card that the scene uses is named with its address.
image=$1/drop.elf
boots 4 '^card S526 A at 0x02C0: detect: no answer' ticks=10
says_not '^arming refused' # dry ticks', and no cause
boots 4 '^card S526 A at 0x0240: detect: no answer' s526_a=576
image=$1/bilateral.elf
boots 4 '^card S526 A at 0x02C0: detect: no answer' ticks=10
says '^card S526 B at 0x0280: detect: no answer'
says '^card MM-32X-AT at 0x0300: detect: no answer'
image=$1/calibrate.elf
boots 4 'S526 A' ticks=10

# The other scenes, and the ISO.
for scene in minimal glove bilateral; do
    image=$1/$scene-none.elf
    boots 0 '^ticks 1000 run, 0 missed$' ticks=1000 idle=spin
done
image=$1/glove-none.elf
boots 2 '^option dump: this scene has no black box$' dump=serial
# First power-up, without a person: words as the host's, and no stage without the one before.
image=$1/bringup-none.elf
boots 0 '^encoder: pull the string out by hand' ticks=4000 stage=1
says '^rest: ok, monitor 0 mA, moved 0.0 mm$'
says ', enable 0x00000000$'
boots 0 '^STOP in rest: the stage before was not shown' ticks=100 stage=2
boots 2 '^option stage=6: allowed 1..5$' stage=6
boots 2 '^option f_finger=2.5: allowed 0.5..2 n$' f_finger=2.5

# A controller in floats: 2000 N/m times 0.4 mm in every tick, and its records replay. Another that
# is none: no number, and one that does not come back.
image=$1/custom-none.elf
boots 0 '^ticks 3000 run, 0 missed$' ticks=3000 uncalibrated=1 q_lim=-0.0004 k=2000 track_tol=0.9 \
    log=debug idle=spin
says ', enable 0x00000001$'
custom=${exhand%/*}/exhand-wall
if [ -x "$custom" ]; then
    "$custom" csv "$out/records" --all --out "$out/csv" >"$out/replay" ||
        { fail "csv"; cat "$out/replay" >&2; }
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "ask_n") at = i; next }
             at { n++; off += ($at - 0.8) ^ 2 > 1e-11 } END { exit !(n == 3000 && !off) }' \
                 "$out/csv" || fail "ask is not 0.8 N"
    "$custom" replay "$out/records" >"$out/replay" 2>&1 || { fail "replay"; cat "$out/replay" >&2; }
fi
image=$1/custom-rude-none.elf
# a cause is present
boots 0 '^arming refused at deadman$' ticks=3000 uncalibrated=1 q_lim=-0.0004 k=1 idle=spin
says ', enable 0x00000000$'
# 5 N: a root, without libm
boots 0 '^arming refused at small_force$' ticks=3000 uncalibrated=1 q_lim=-0.0004 k=9 idle=spin
safe 7 '^tick does not end, vector 32, error 0x00000015, ' ticks=6000 uncalibrated=1 q_lim=-0.0004 \
    k=8 idle=spin

image=$1/drop-none.iso
boots 0 '^ticks 500 run, 0 missed$'
says '^set k 1000$'

echo "boot: $((cases - failed)) of $cases ways to boot end as they must"
[ "$failed" = 0 ]
