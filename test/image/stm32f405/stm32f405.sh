#!/bin/sh
# SPDX-License-Identifier: MIT
# The stm32f405 image under emulation, in closed loop: stm32f405.sh [WHAT...], of these (all):
#   drop guarded box   that scene at 1, 2, 5 and 10 kHz, drop at 20, box at 3, too: the same bits as
#                      on this host, tick by tick; what the mean, the 99th of 100 and the dearest
#                      tick take. Where ticks are missed, once more with a processor four times as
#                      fast
#   where              cycles by function: of the mean tick, and of the dearest
#   spoil              a count more in one tick is found in that tick
#   faults             faults from random times: drives off in time, each reported by its name; what
#                      no detector sees took effect, and kept the limits of the parameters; all
#                      scenes in one table, each in $B/test/stm32f405/faults.txt
#   planted            the same with a drive that stays enabled: all are found
#   cuts               the supply fails in each operation of a save into flash
#   jumps              a program that leaves memory ends in a state that has a name
#   show               what make run PORT=stm32f405 prints
# README.md says what is counted. Environment: B (build), TICKS of a run at 1 kHz, TIMES of faults
# in all, LIMIT (86400 s) of a run: a longer run hangs.
# Exit status: 0 all ok, 1 not, 2 bad usage, 3 something is not built.
set -u

b=${B:-build}
ticks=${TICKS:-10000}
times=${TIMES:-10005}
emulator=$b/test/stm32f405/emulator
failed=0

run()
{
    timeout -s KILL "${LIMIT:-86400}" "$emulator" "$@" && return
    [ $? != 137 ] || echo "stm32f405: stopped: it hangs" >&2
    return 1
}

[ -x "$emulator" ] || { echo "stm32f405: $emulator: not built: make stm32f405" >&2; exit 3; }

image()
{
    case $1 in box) echo "$b/stm32f405/bilateral.elf" ;; *) echo "$b/stm32f405/$1.elf" ;; esac
}
rates()
{
    # At 10 kHz scene guarded refuses its set-up, on any board.
    case $1 in
    guarded) at="1000 2000 5000" ;;
    drop) at="1000 2000 5000 10000 20000" ;;
    *) at="1000 2000 3000 5000 10000" ;;
    esac
    for r in $at; do
        said=$(run --rate "$r" --ticks "$((ticks * r / 1000))" "$(image "$1")") || failed=1
        echo "$said"
        case $said in *"missed 0 |"*) continue ;; esac
        run --rate "$r" --ticks "$((ticks * r / 1000))" --speed 4 "$(image "$1")" || failed=1
    done
}
where()
{
    for s in drop box; do
        said=$(run --rate 1000 --ticks 1300 --where "$(image $s)") || failed=1
        echo "$said" | grep -v ^where
        { "${CROSS:-arm-none-eabi-}nm" "$(image $s)" && echo "$said"; } | awk '
            $2 ~ /^[tT]$/ { at[$1] = $3 }
            $1 == "where" { mean[$2] = $3; most[$2] = $4 }
            END { for (a in at) { print a, "a", at[a] }
                  for (b in mean) { print substr(b, 3), "b", mean[b], most[b] } }' |
            sed 's/^\([0-9a-f]\{7\}\) /0\1 /' | sort |
            awk '$2 == "a" { f = $3; next }
                 { mean[f] += $3 / 1300; most[f] += $4 }
                 END { for (f in mean) { printf "%8.0f %8d  %s\n", mean[f], most[f], f } }' |
            sort -rn | head -25
    done
}
spoil()
{
    said=$(run --rate 1000 --ticks 400 --spoil 300 "$(image drop)")
    case $said in
    *"differ, the first is 300: encoder read"*) echo "spoil: found in tick 300" ;;
    *) failed=1 && echo "spoil: FAILED: $said" ;;
    esac
}
faults()
{
    tables=$b/test/stm32f405/faults.txt
    : >"$tables"
    # Scene, rate, seed of hand and device, set of kinds, how many faults, share of 435 of each of
    # 23. The box takes five times as long, and each fault of sets 1 to 4 takes seconds.
    for s in "drop 1000 1 0 23 140" "drop 1000 2 0 23 65" "drop 1000 3 0 23 65" \
        "drop 2000 1 0 23 48" "guarded 1000 1 0 23 48" "guarded 1000 4 0 23 47" \
        "box 1000 1 0 23 22" "box 1000 1 1 9" "box 1000 1 2 15" "drop 1000 5 3 12" \
        "drop 1000 5 4 4"; do
        # shellcheck disable=SC2086 # a list of words
        set -- $s
        n=$5
        case $times.$3.$4 in 10005.* | *.[125].[0124]) ;; *) continue ;; esac # the short form
        if [ "$4" = 0 ]; then
            n=$((times * $6 / 10005 * n)) # a multiple of the kinds
            n=$((n ? n : 23))
        elif [ "$times" -lt 10005 ]; then
            n=$(($4 == 2 ? 3 : 1))
        fi
        run --rate "$2" --seed "$3" --faults "$n" --set "$4" "$(image "$1")" \
            >>"$tables" || failed=1
        echo "$1, $2 Hz, seed $3, set $4: $(tail -n 2 "$tables" | tr '\n' ';')"
    done
    awk -f "$(dirname "$0")/sum.awk" "$tables" || failed=1
}
planted()
{
    said=$(run --rate 1000 --faults 46 --welded "$(image drop)")
    case $said in
    *": 36 wrong") echo "planted: a drive that stays enabled is found" ;;
    *) failed=1 && echo "planted: FAILED: $said" ;;
    esac
}
show()
{
    said=$("$(dirname "$0")/run.sh" "$(image drop)" --ticks 1000)
    case $said in
    *"scene drop
"*"1000 at 2000 Hz, 0 missed"*"bit for bit"*) echo "show: as make run PORT=stm32f405 has it" ;;
    *) failed=1 && echo "show: FAILED: $said" ;;
    esac
}
cuts()
{
    run --cuts 10000 "$(image drop)" || failed=1
}
jumps()
{
    run --jumps || failed=1
}

for what in ${*:-drop guarded box spoil faults planted cuts jumps show}; do
    case $what in
    drop | guarded | box) rates "$what" ;;
    where | spoil | faults | planted | cuts | jumps | show) "$what" ;;
    *)
        echo "usage: stm32f405.sh [drop|guarded|box|where|spoil|faults|planted|cuts|jumps|" \
            "show]..." >&2
        exit 2 ;;
    esac
done
exit $failed
