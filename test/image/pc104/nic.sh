#!/bin/bash
# SPDX-License-Identifier: MIT
# The image's network card under QEMU: nic.sh PART... of
#   ways       what is said where there is no card, another card, no peer, or an option that is none
#   bilateral  the paper's second experiment over it: the unmodified world simulator at the other
#              end
#   flood      FRAMES bad frames
#   dump       the black box after a fault, over it
# B: the build (build). SPEEDS (natural), APPROACHES (1), FRAMES (20000), SEED (1).
#
# bilateral: the host's experiment without the card leaves a log. Its inputs are at the connectors
# of emulated cards inside the image (tape.c), tick by tick. Planes, materials and HELLOs come from
# build/posix/world over UDP, and the image's log goes out over UDP. From the first freeze on its
# nine signals must be the host's, in every tick. So the host's strings would have moved as they
# did.
#
# It has a ramp of 200 ms, because arming may end a tick apart and the first contact is at 0.52 s.
# It says nothing of a real machine's timing. Time is virtual, 2 ns an instruction. The budget of a
# tick with all the packets that it may bring must fit.
# Exit status: 0 all as expected, 1 not, 2 bad usage, 3 something is missing (it says what).
set -u

b=${B:-build}
exhand=$b/posix/exhand world=$b/posix/world cable=$b/test/cable run=ports/pc104/run.sh
speeds=${SPEEDS:-natural} frames=${FRAMES:-20000}
dir=$(mktemp -d) || exit 3
pids=
clean()
{
    local p
    for p in $pids; do kill "$p" 2>/dev/null; done
    rm -rf "$dir"
}
trap clean EXIT
trap 'exit 130' INT TERM
name=nic
. test/image/pc104/check.sh
port=$((20000 + $$ % 20000))

command -v qemu-system-i386 >/dev/null || {
    echo "nic: qemu-system-i386: not found: install the package qemu-system-x86" >&2
    exit 3
}
for device in e1000e e1000; do
    qemu-system-i386 -device help 2>/dev/null | grep -q "\"$device\"" || {
        echo "nic: this qemu-system-i386 has no device $device:" \
            "install the package qemu-system-x86 of Debian 12 or later" >&2
        exit 3
    }
done

# boot STATUS FLAGS IMAGE OPTION...
boot()
{
    local want=$1 flags=$2 status
    shift 2
    QEMU_FLAGS="-icount shift=${SHIFT:-1},sleep=off $flags" TIMEOUT_s=${TIMEOUT_s:-900} $run "$@" \
        >"$dir/said" 2>"$dir/err"
    status=$?
    check "options '${*:2}': status $status, want $want" [ "$status" = "$want" ]
}

said_number() # NAME: the number behind it, or 0
{
    tr -d '\r' <"$dir/said" |
        awk -v name="$1" '$0 ~ "^" name " [0-9]+$" { n = $NF } END { print n + 0 }'
}

# --- what is said -----------------------------------------------------------------

card="-device e1000e,netdev=n -netdev user,id=n"

ways()
{
    local image=$b/pc104/bilateral-none.elf ip=(ip=10.0.2.15 peer=10.0.2.2)
    boot 0 "" "$image" ticks=300
    check "no ip: said" says '^link: none, as no ip= is given$'
    boot 0 "" "$image" ticks=300 "${ip[@]}"
    check "no card: named" says '^nic: no Intel 82574L \(8086:10D3\)$'
    check "no card: the scene goes on" says '^ticks 300 run, '
    boot 0 "-device e1000,netdev=n -netdev user,id=n" "$image" ticks=300 "${ip[@]}"
    check "another card: named" says \
        '^nic: 0x8086100e at PCI 0:[0-9]+\.0: not one this port drives$'
    boot 0 "-M isapc -cpu pentium2" "$image" ticks=300 timer=pit rate=1000 budget=1 "${ip[@]}"
    check "no PCI: said" says '^nic: no PCI bus$'
    boot 0 "$card" "$image" ticks=300 ip=10.0.2.15 peer=10.0.2.77
    check "nobody at that address: said" says '^link: the peer does not answer yet: goes on$'
    check "nobody at that address: the scene goes on" says '^ticks 300 run, '
    boot 0 "$card,hostfwd=udp::$port-:4747" "$image" ticks=300 "${ip[@]}"
    check "a peer: said" says '^link: the peer answers$'
    boot 0 "$card" "$b/pc104/drop-none.elf" ticks=300 log=udp "${ip[@]}"
    check "a scene without link logs over it" says '^log pieces [1-9]'
    boot 2 "" "$image" ip=10.0.2.256 peer=10.0.2.2
    check "address refused" says "^option ip=10.0.2.256: a host's address, as 10.0.0.2$"
    boot 2 "" "$image" ip=10.0.2.15
    boot 2 "" "$image" "${ip[@]}" port=0
    check "port refused" says '^option port=0: allowed 1\.\.65535$'
    boot 2 "" "$image" ip=10.0.2.15 peer=10.0.2.15
    boot 2 "" "$image" "${ip[@]}" log_port=4747
    check "one port for both refused" says '^option log_port=: the same as port$'
    boot 2 "" "$image" log=udp
    check "a log needs a way out" says '^option log=udp: needs ip= and peer=$'
    boot 2 "" "$b/pc104/minimal-none.elf" ip=10.0.2.15
}

# --- the experiment ---------------------------------------------------------------

replays() # LOG
{
    "$exhand" replay "$1" >"$dir/replay"
}

# nine LOG TICKS: t and the eight signals of the index finger from its first freeze on
nine()
{
    "$exhand" csv --all --finger index "$1" | awk -F, -v ticks="$2" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == "frozen") bits = i; next }
        NR > ticks + 1 { exit }
        $bits % 2 { on = 1 } # it is frozen
        on { print $1 "," $2 "," $3 "," $4 "," $5 "," $6 "," $7 "," $8 "," $9 }'
}

start_world()
{
    # A quarter of the frames that the host has, as the image runs at about a quarter of real time.
    "$world" --headless --listen "127.0.0.1:$port" --fps 100 --seconds 900 \
        --scene ports/posix/world/scenes/collision.world >"$dir/world" 2>&1 &
    other=$!
    pids="$pids $other"
}

start_listener()
{
    "$exhand" listen --at "127.0.0.1:$((port + 1))" --out "$dir/image.exh" --silence 30 \
        >"$dir/listen" 2>&1 &
    listener=$!
    pids="$pids $listener"
    sleep 0.3
}

one_speed() # SPEED
{
    local speed=$1 log=$dir/host/bilateral_$1.exh ticks rows
    ticks=$(($("$exhand" csv "$log" | wc -l) - 1))
    start_world # another for each: the log's `session` is the same
    start_listener
    SHIFT=0 boot 0 "-m 256 -initrd $log $card" "$b/pc104/bilateral-tape.elf" ip=10.0.2.15 \
        peer=10.0.2.2 \
        port="$port" log=udp log_port=$((port + 1)) budget=1 scan=1 idle=spin ticks="$ticks"
    wait "$listener"
    check "$speed: the log came whole: $(cat "$dir/listen")" [ $? = 0 ]
    kill "$other" && wait "$other"
    check "$speed: no tick missed" says "^ticks $ticks run, 0 missed$"
    check "$speed: no record lost" says '^records lost 0$'
    check "$speed: the log is replayed" replays "$dir/image.exh"
    nine "$log" "$ticks" >"$dir/nine.host"
    nine "$dir/image.exh" "$ticks" >"$dir/nine.image"
    rows=$(wc -l <"$dir/nine.host")
    check "$speed: contacts were felt" [ "$(awk -F, '$6 == 1' "$dir/nine.host" | wc -l)" -gt 100 ]
    check "$speed: nine signals from the first freeze on are the host's" cmp "$dir/nine.host" \
        "$dir/nine.image"
    echo "  $speed: $ticks ticks, $(said_number tick_missed) missed;" \
        "nine signals of $rows ticks from the first freeze on:" \
        "without the card $(cksum <"$dir/nine.host" | cut -d' ' -f1)," \
        "over it $(cksum <"$dir/nine.image" | cut -d' ' -f1);" \
        "$(said_number "link datagrams") packets came, $(said_number "nic sent") frames went," \
        "$(said_number "log pieces") of the log"
}

bilateral()
{
    check "the host's experiment" "$exhand" bilateral \
        --scene ports/posix/world/scenes/collision.world --speed "$speeds" \
        --approaches "${APPROACHES:-1}" --out "$dir/host" >"$dir/said" 2>"$dir/err"
    for speed in ${speeds//,/ }; do one_speed "$speed"; done
}

# --- the flood --------------------------------------------------------------------

flood()
{
    local ticks=$((frames / 6 + 1000)) end
    "$cable" "$dir/cable" "$frames" "${SEED:-1}" >"$dir/sent" 2>&1 &
    end=$!
    pids="$pids $end"
    sleep 0.3
    cable="stream,id=n,server=off,addr.type=unix,addr.path=$dir/cable"
    boot 0 "-device e1000e,netdev=n -netdev $cable" \
        "$b/pc104/bilateral-none.elf" ip=10.0.0.2 peer=10.0.0.1 uncalibrated=1 idle=spin \
        ticks="$ticks"
    wait "$end"
    check "all frames were sent before the image ended: $(cat "$dir/sent")" [ $? = 0 ]
    check "no tick missed" says "^ticks $ticks run, 0 missed$"
    check "no tick late" says '^tick_late 0$'
    check "nothing the card sent had to be left out" [ "$(said_number "link unsent")" = 0 ]
    check "every frame that a card lets through was counted: $(cat "$dir/sent")" \
        grep -q " $(said_number "link frames") to be seen" "$dir/sent"
    for cause in long others type arp arp_others arp_conflict arp_unasked ip ip_options ip_sum \
        ip_others fragment \
        protocol stranger udp port empty too_long udp_sum; do
        check "frames dropped as $cause" [ "$(said_number "link drop_$cause")" -gt 0 ]
    done
    echo "  flood: $(cat "$dir/sent"); $ticks ticks, $(said_number tick_missed) missed," \
        "$(said_number tick_late) late;" \
        "dropped $(awk '/^link drop_/ { n += $NF } END { print n + 0 }' "$dir/said")," \
        "longest tick $(awk '/^tick_max/ { print $2 / 1000 }' "$dir/said") us" \
        "at 2 ns an instruction"
}

# --- the black box ----------------------------------------------------------------

# A wall where the string begins, and a monitor that reads nothing: a fault while the loop runs on.
dump()
{
    start_listener
    boot 0 "$card" "$b/pc104/drop-none.elf" dump=udp ip=10.0.2.15 peer=10.0.2.2 log_port=$((port + \
        1)) idle=spin \
        ticks=8000 uncalibrated=1 q_lim=-0.0004 k=2000 track_tol=0.1
    wait "$listener"
    check "the dump came whole: $(cat "$dir/listen")" [ $? = 0 ]
    check "no tick missed" says '^ticks 8000 run, 0 missed$'
    check "it was out before the end" fails says '^black box: '
    check "the dump is replayed" replays "$dir/image.exh"
    check "it has the fault: $(cat "$dir/replay")" grep -q 'fault tracking at tick' "$dir/replay"
    start_listener
    boot 5 "$card" "$b/pc104/drop-none.elf" dump=udp ip=10.0.2.15 peer=10.0.2.2 log_port=$((port + \
        1)) \
        ticks=1000 uncalibrated=1 provoke=divide provoke_at=800
    wait "$listener"
    check "the dump of a halt came whole: $(cat "$dir/listen")" [ $? = 0 ]
    check "words come before it" says '^black box: the dump follows$'
    check "the dump of a halt is replayed" replays "$dir/image.exh"
    echo "  dump: $(cat "$dir/listen")"
}

fails() # COMMAND...
{
    ! "$@"
}

[ $# -gt 0 ] || {
    echo "usage: $0 ways|bilateral|flood|dump..." >&2
    exit 2
}
for part in "$@"; do
    case $part in
    ways | bilateral | flood | dump) $part ;;
    *)
        echo "nic: $part: one of ways, bilateral, flood, dump" >&2
        exit 2
        ;;
    esac
done
echo "nic: $((checks - failed)) of $checks checks hold"
[ "$failed" = 0 ]
