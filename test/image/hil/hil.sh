#!/bin/sh
# SPDX-License-Identifier: MIT
# What `make hil` shows: hil.sh [WHAT...], of these (all of them):
#   count    instructions counted by blocks are those counted one by one
#   spoil    an encoder count more in one tick is found in that tick
#   slow     a scene that is too slow is found late
#   drop     the drop experiment, closed loop: the POSIX port's bits
#   rates    the same at the paper's rates, at 20 kHz and from the 8254
#   box      the full box, closed loop, in the same way
#   replay   the image's own records replay on the host
#   wild     random and extreme inputs
#   absent   no cards, and no HPET
#   board    the contract of the port (test/port), under both emulators
#   qemu     the real timer interrupt, with emulated cards inside
#
# Environment: B (build), TICKS (of the long runs), FEW (of the others), QEMU (of qemu's).
# Exit status: 0 all ok, 1 not, 2 bad usage, 3 something is not built.
set -u

b=${B:-build}
ticks=${TICKS:-1000000}
few=${FEW:-10000}
hil=$b/test/hil
failed=0

[ -x "$hil" ] || { echo "hil: $hil: not built: make hil" >&2; exit 3; }

# run WHAT IMAGE [OPTION...]
run()
{
    echo "$2: $1"
    image=$b/pc104/$2.elf
    shift 2
    "$hil" --quiet "$@" "$image" || { failed=1; echo "  FAILED: $hil $* $image"; }
}

# The A/D of one channel without settling fits 50 us; monitors of the tick before fit with all that
# there is.
fast="supply=0 ad_settle=0"
# The glove's scan runs while the tick before computes.
box="--loop --glove-age 1"
# The most a class of ticks may vary in the scene's instructions, ppm of its dearest tick.
even="--spread 60000"
even_drop="--spread 80000"
# The most instructions that a tick of the full box may take, the image's part and the scene's. With
# a glove frame in every tick. With one in every twentieth, computed and taken in parts.
dear="--most 19500"
dear_parts="--most 13900"
# With as few accesses as a tick can do with (docs/CARDS.md); the glove at 500 Hz, in parts.
sparing="monitor=2 turns=1"
parts="--loop --turns --glove-last --set every=20"

show_count() { run "blocks counted one by one too" drop --loop --singly --ticks 2000; }
# must_differ TICK IMAGE [OPTION...]
must_differ()
{
    tick=$1 image=$b/pc104/$2.elf
    echo "$2: one count more in tick $tick"
    shift 2
    "$hil" --quiet --ticks "$((tick + 100))" --spoil "$tick" "$@" "$image" >"$b/hil-spoil.txt"
    status=$?
    if [ $status = 1 ] && grep -q "the first is $tick:" "$b/hil-spoil.txt"; then
        echo "  ok     found:$(sed -n 's/.*the first is/ tick/p' "$b/hil-spoil.txt")"
    else
        failed=1
        echo "  FAILED status $status, see $b/hil-spoil.txt"
    fi
}
show_spoil()
{
    must_differ 1000 drop --loop
    # shellcheck disable=SC2086
    must_differ 1000 bilateral $box
}
show_replay()
{
    run "with records" drop --loop --ticks 5000 --options log=debug --records "$b/hil-drop.exh"
    # shellcheck disable=SC2086
    run "with records" bilateral $box --rate 1000 --ticks 3000 --options log=debug \
        --records "$b/hil-box.exh"
    for f in drop box; do
        if said=$("$b/posix/exhand" replay "$b/hil-$f.exh"); then
            echo "  ok     replayed: $said"
        else
            failed=1
            echo "  FAILED $b/posix/exhand replay $b/hil-$f.exh"
        fi
    done
}
show_slow() { run "every hundredth tick takes two and a half periods" slow --ticks 2050 --late 40; }
show_drop()
{
    # shellcheck disable=SC2086
    run "the paper's first experiment, 2 kHz" drop --loop $even_drop --ticks "$ticks"
    run "another seed" drop --loop --seed 2 --ticks "$few"
}
show_rates()
{
    for r in 90 100 200 500 1000; do run "$r Hz" drop --loop --rate "$r" --ticks "$few"; done
    run "20 kHz" drop --loop --rate 20000 --ticks 10000 --options "$fast"
    run "20 kHz, monitors of the tick before" drop --loop --monitor-age 1 --rate 20000 \
        --ticks 10000 --options "monitor=2"
    run "20 kHz, monitors and supply in turn" drop --loop --turns --rate 20000 --ticks 10000 \
        --options "$sparing"
    run "an HPET of 100 MHz" drop --loop --hpet 100 --ticks "$few"
    run "ticks from the 8254" drop --loop --ticks "$few" --options "timer=pit"
}
show_box()
{
    # shellcheck disable=SC2086 # lists of options
    run "the full box, 2 kHz" bilateral $box $even $dear --ticks "$ticks"
    # shellcheck disable=SC2086
    run "another seed" bilateral $box --seed 2 --ticks "$few"
    # shellcheck disable=SC2086
    for r in 90 100 200; do run "the full box, $r Hz" bilateral $box --set glove_fc=20 --rate "$r" \
        --ticks "$few"; done
    # shellcheck disable=SC2086
    for r in 500 1000; do run "the full box, $r Hz" bilateral $box --rate "$r" --ticks "$few"; done
    # shellcheck disable=SC2086
    run "the full box, 10 kHz" bilateral $parts $dear_parts --rate 10000 --ticks 10000 \
        --options "$sparing scan_slice=2 headroom=15"
}
show_wild()
{
    # shellcheck disable=SC2086
    for seed in 1 2 3; do
        for i in minimal drop; do
            run "random and extreme inputs, seed $seed" $i --wild $even --seed $seed --ticks "$few"
        done
        run "random and extreme inputs, five fingers, seed $seed" bilateral --wild $box $even \
            --seed $seed --ticks "$few"
    done
}
show_absent()
{
    run "no cards: status 0x12" drop --absent --status 18
    run "no HPET: the 8254" drop --loop --hpet 0 --ticks 2000
}

# qemu IMAGE TICKS [OPTION...]: the timer interrupt of qemu, in virtual time, 8 ns an instruction.
# The processor does not sleep: from HLT qemu goes immediately to the next timer, and now and then
# to the one behind it.
qemu()
{
    image=$b/pc104/$1.elf n=$2
    shift 2
    echo "$image: $n ticks under qemu $*"
    TIMEOUT_s=1800 ports/pc104/run.sh "$image" "ticks=$n" idle=spin "$@" >"$b/hil-qemu.txt"
    status=$?
    grep -E '^(rate|ticks|tick_max|dac)' "$b/hil-qemu.txt" | sed 's/^/  /'
    if [ $status = 0 ] && grep -q "^ticks $n run, 0 missed" "$b/hil-qemu.txt"; then
        echo "  ok     no tick missed"
    else
        failed=1
        echo "  FAILED status $status, see $b/hil-qemu.txt"
    fi
}
show_qemu()
{
    qemu drop-inside "${QEMU:-100000}"
    qemu bilateral-inside "$((${QEMU:-100000} / 10))" rate=500 fingers=31
}

show_board()
{
    run "the contract of board.h, cards in the loop" contract --board --ticks 1000000
    echo "contract-inside: the same under qemu"
    ports/pc104/run.sh "$b/pc104/contract-inside.elf" ticks=0 >"$b/hil-qemu.txt" || failed=1
    grep -E ' passed, |FAILED|^done|^  \|' "$b/hil-qemu.txt" | sed 's/^/  /'
}

for what in ${*:-count spoil slow drop rates box replay wild absent board qemu}; do
    case $what in
    count | spoil | slow | drop | rates | box | replay | wild | absent | board | qemu)
        show_"$what" ;;
    *)
        echo "usage: hil.sh [count|spoil|slow|drop|rates|box|replay|wild|absent|board|qemu]..." >&2
        exit 2 ;;
    esac
done
exit $failed
