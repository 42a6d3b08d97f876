#!/bin/sh
# SPDX-License-Identifier: MIT
# size.sh [--update] [SCENE...]: what a scene costs on a port.
# Refutes "a scene links only what it calls". For each scene x port it prints bytes, worst-case
# stack, instructions per tick and the library symbols. It compares the symbols with the committed
# symbols.tsv (symbols.py). --update writes the columns of these scenes anew.
#
#   posix  library and scene by this machine's compiler, in an image linked against ports/template.
#          The simulator around them would be far larger. Instructions by callgrind: the mean of
#          those of 3000 ticks, into the wall and back, that run in contact. Scenes without a wall:
#          of the ticks that run. Without safety: of all. A note beside the table says so.
#   pc104  the image with constants for cards (CARDS=none), as QEMU runs it. It is linked from its
#          parts, so that their bytes can be counted. Of an image that is linked as one program
#          (SCENE_WHOLE) the stack must fit, too.
#          Instructions by its time stamp counter, one per instruction: the longest tick of 2000,
#          with arming, ramp and running among them, and nothing moving.
#   mps2   the image, a loop-back for drives. Instructions in virtual time under QEMU, 64 ns each,
#          to 1 (bilateral: 32 ns, to 2), by a timer of 25 MHz. The longest tick, nothing moving.
#          minimal once more as minimal-frozen-1000 (make FROZEN=1000): scene and library set up and
#          linked as one program.
#   stm32f405  the image for drives: bytes and stack alone. As on pc104, of a scene that is linked
#          as one program the stack must fit, too.
#
# Environment: MAKE (make), B (build). A missing cross compiler, emulator or valgrind
# leaves "-" in the table and says so.
# Exit status: 0 as committed, 1 not, 2 bad usage, 3 no compiler.
set -eu

make=${MAKE:-make}
cc=gcc # the committed figures are its, whatever CC says
b=${B:-build}/size
here=test/figures/size
ticks=2000
sweep=3000
update=no
failed=no
# Nothing more: the caller's options of make (CC, O, ...) would change the figures.
MAKEFLAGS=-j$(nproc 2>/dev/null || echo 1)
export MAKEFLAGS

[ -r "$here/size.sh" ] || { echo "$0: run it at the top of the tree" >&2; exit 2; }
[ "${1:-}" = --update ] && { update=yes; shift; }
command -v "$cc" >/dev/null 2>&1 || { echo "$cc: not found: install gcc" >&2; exit 3; }

note() { echo "size: $*" >&2; }

# one SCENE: it is linked as one program
one()
{
    case $b/$1 in */whole/* | *-frozen-*) return 0 ;; esac
    return 1
}

# build PORT SCENE [VARIABLE...]: the image and the call graphs beside its objects. Of
# SCENE-frozen-RATE those are what the linker made, which it leaves there.
build()
{
    port=$1 scene=$2
    shift 2
    case $scene in *-frozen-*) set -- "$@" "FROZEN=${scene##*-}" ;; esac
    one "$scene" && set -- "$@" LDFLAGS=-save-temps
    # shellcheck disable=SC2046 # none or one word
    $make -s "PORT=$port" "SCENE=${scene%-frozen-*}" "B=$b" CFLAGS=-fcallgraph-info=su "$@" \
        "$b/$port/$scene.elf" $([ "$port" = template ] && echo "$b/template/lib/src/run/log.o")
}

# shared PORT SCENE ENDING: what it has with another scene
shared()
{
    case $2 in
    bilateral) echo "$b/$1/examples/glove/cal.$3 $b/$1/lib/src/run/calib_set.$3" ;;
    drop) echo "$b/$1/lib/src/run/calib_set.$3" ;;
    guarded | custom) echo "$b/$1/examples/drop/drop.$3 $b/$1/lib/src/run/calib_set.$3" ;;
    esac
}

# model PORT SCENE: where the controller in the scene's slot is
model()
{
    case $2 in custom) echo "$b/$1/model/wall" ;; esac
}

# objects PORT SCENE: everything compiled from C for that image. What was linked as one comes last:
# names of it are the library's, too.
objects()
{
    own=$b/$1/examples/$2
    case $2 in *-frozen-*) own= ;; esac
    # shellcheck disable=SC2046,SC2086 # the names of our objects have no blanks
    case $b in
    */whole) find "$b/$1/$2" -name '*.ci' ;;
    *)
        find "$b/$1/lib" "$b/$1/lib/src/run/loop.ci" $own "$b/$1/${2%-frozen-*}" \
            $(shared "$1" "$2" ci) $(model "$1" "$2") -name '*.ci'
        ;;
    esac | sed 's/\.ci$/.o/' | sort
    if one "$2"; then echo "$b/$1/$2.elf.ltrans0.ltrans.o"; fi
}

# library_symbols PORT SCENE NM: global symbols of the library that the image has
library_symbols()
{
    "$3" -g -P "$b/$1/libexhand.a" | awk 'NF > 2 && $2 !~ /^[Uwv]$/ { print $1 }' | sort -u \
        >"$b/library.txt"
    "$3" -P "$b/$1/$2.elf" | awk '{ print $1 }' | sort -u | comm -12 - "$b/library.txt"
}

# compare_symbols PORT-as-named SCENE: $b/symbols.txt with its column of the committed table
compare_symbols()
{
    [ "$update" = yes ] && { "$here/symbols.py" --update "$2-$1" "$b/symbols.txt"; return; }
    "$here/symbols.py" "$2-$1" "$b/symbols.txt" && return
    note "$2 on $1: other library symbols than committed: if intended, run $0 --update"
    failed=yes
}

# stack PORT SCENE OBJDUMP: bytes, and the path to stderr
stack()
{
    # shellcheck disable=SC2046 # the names of our objects have no blanks
    if python3 "$here/stack.py" --objdump "$3" $(objects "$1" "$2") >"$b/stack.txt"; then
        note "$2 on $1: stack $(head -n 1 "$b/stack.txt")"
        sed 's/ .*//;q' "$b/stack.txt"
    else
        echo "?"
    fi
}

# stack_fits PORT SCENE STACK NM: below what the image has, where its linker script says
stack_fits()
{
    has=$("$4" "$b/$1/$2.elf" | awk '/ STACK_B$/ { print $1 }')
    if [ "$3" = "?" ] || [ "$3" -ge "$((0x$has))" ]; then
        note "$2 on $1: stack $3, the image has $((0x$has))"
        failed=yes
    fi
}

# linked_bytes SCENE: text, data and bss of library and scene in the image on the template port,
# from the linker's map. Long section names have their own line there.
linked_bytes()
{
    ours="libexhand[.]a[(]|/examples/$1/|/examples/glove/cal[.]o|/examples/drop/drop[.]o"
    awk -v ours="$ours|/lib/src/run/calib_set[.]o" '
        function number(hex,  i, v) {
            for (i = 3; i <= length(hex); i++) {
                v = v * 16 + index("0123456789abcdef", substr(hex, i, 1)) - 1
            }
            return v
        }
        /^Linker script and memory map/ { mapped = 1 }
        !mapped           { next }
        /^ [.][^ ]+$/     { name = $1; next }
        /^ [.]/           { name = $1; address = $2; size = $3; file = $4 }
        /^  +0x/ && name  { address = $1; size = $2; file = $3 }
        file ~ ours && number(address) > 0 {
            if (name ~ /^\.bss/) { bss += number(size) }
            else if (name ~ /^\.data($|\.)/ && name !~ /^\.data\.rel\.ro/) { data += number(size) }
            else if (name ~ /^\.(text|rodata|data\.rel\.ro)/) { text += number(size) }
        }
        { name = file = "" }
        END { printf "%d %d %d\n", text, data, bss }' "$b/template/$1.map"
}

# callgrind SCENE: instructions per tick on this machine, or -
callgrind()
{
    tool=$b/ticks-$1
    # shellcheck disable=SC2046 # the names of our objects have no blanks
    "$cc" -std=c99 -O2 -g -Ilib/include -Iexamples "-DEXH_SCENE=exh_scene_$1" "$here/ticks.c" \
        "$here/world.c" test/no_board.c \
        $(find "$b/template/examples/$1" $(model template "$1") -name '*.o') \
        $(shared template "$1" o) "$b/template/lib/src/run/log.o" \
        "$b/template/libexhand.a" -o "$tool"
    needs=
    [ "$1" = calibrate ] && needs=0x8220.0=524288 # one mass, 0.5 kg
    for which in contact run all; do
        # shellcheck disable=SC2086 # none or one word
        n=$("$tool" "$sweep" "$which" $needs)
        [ "$n" = 0 ] || break
    done
    note "$1 on posix: $n ticks counted of $sweep: $which"
    echo "$n $which" >"$b/callgrind-$1.ticks" # with what callgrind found: for costs.py
    if ! command -v valgrind >/dev/null 2>&1; then
        note "valgrind: not found: no instructions for posix"
        echo "-"
        return
    fi
    # shellcheck disable=SC2086 # none or one word
    valgrind --tool=callgrind --callgrind-out-file="$b/callgrind-$1.out" \
        --toggle-collect=counted_tick "$tool" \
        "$sweep" "$which" $needs 2>&1 |
        awk -v n="$n" '/Collected/ { per_tick = sprintf("%.1f", $NF / n) }
            END { print per_tick ? per_tick : "-" }'
}

# without SCENE: what lets it arm, if it would want a calibration
without()
{
    case $1 in drop | guarded | custom | bilateral) echo uncalibrated=1 ;; esac
}

# counted SCENE: most instructions of one tick on pc104, or -
counted()
{
    [ "$1" = calibrate ] && { echo -; return; } # it needs a known mass
    # shellcheck disable=SC2046 # none or one word
    QEMU_FLAGS="-icount shift=0,sleep=off" ports/pc104/run.sh "$b/pc104/$1.elf" "ticks=$ticks" \
        $(without "$1") \
        >"$b/run.txt" || note "$1 on pc104: did not run"
    awk '/^cycles per tick/ { sub(/\r/, ""); n = $NF } END { print n ? n : "-" }' "$b/run.txt"
}

# counted_m SCENE: most instructions of one tick on mps2, or -
counted_m()
{
    [ "$1" = calibrate ] && { echo -; return; }
    shift=6
    [ "$1" = bilateral ] && shift=5 # or it would not be over before the next tick
    QEMU_FLAGS="-icount shift=$shift,sleep=off" ports/mps2/run.sh "$b/mps2/$1.elf" >"$b/run.txt" ||
        note "$1 on mps2: did not run"
    awk -v shift=$shift '/^cycles per tick/ { n = int($NF * 40 / 2 ^ shift + 0.5) }
        END { print n ? n : "-" }' "$b/run.txt"
}

# row SCENE PORT TEXT DATA BSS STACK INSTRUCTIONS
row()
{
    printf '%-19s %-9s %8s %6s %6s %8s %12s %8s\n' "$@" "$(wc -l <"$b/symbols.txt")"
}

posix_row()
{
    build template "$1" "CC=$cc"
    library_symbols template "$1" nm >"$b/symbols.txt"
    compare_symbols posix "$1"
    bytes=$(linked_bytes "$1")
    # shellcheck disable=SC2086 # three numbers
    row "$1" posix $bytes "$(stack template "$1" objdump)" "$(callgrind "$1")"
}

# whole_fits PORT SCENE [VARIABLE...]: the stack of an image that the linker makes one program of
whole_fits()
{
    parts=$b b=$b/whole
    build "$@" "CROSS=$cross" "CC=${cross}gcc"
    stack_fits "$1" "$2" "$(stack "$1" "$2" "${cross}objdump")" "${cross}nm"
    b=$parts
}

pc104_row()
{
    cross=i686-linux-gnu-
    if ! command -v "${cross}gcc" >/dev/null 2>&1; then
        note "${cross}gcc: not found: no pc104 (package gcc-i686-linux-gnu)"
        return
    fi
    build pc104 "$1" "CROSS=$cross" "CC=${cross}gcc" CARDS=none PORT_SUFFIX= PORT_WHOLE=
    library_symbols pc104 "$1" "${cross}nm" >"$b/symbols.txt"
    compare_symbols pc104 "$1"
    bytes=$("${cross}size" "$b/pc104/$1.elf" | awk 'NR == 2 { print $1, $2, $3 }')
    stack=$(stack pc104 "$1" "${cross}objdump")
    stack_fits pc104 "$1" "$stack" "${cross}nm"
    if grep -q '^SCENE_WHOLE' "examples/$1/scene.mk"; then
        whole_fits pc104 "$1" CARDS=none PORT_SUFFIX=
    fi
    # shellcheck disable=SC2086 # three numbers
    row "$1" pc104 $bytes "$stack" "$(counted "$1")"
}

mps2_row()
{
    cross=arm-none-eabi-
    if ! command -v "${cross}gcc" >/dev/null 2>&1; then
        note "${cross}gcc: not found: no mps2 (package gcc-arm-none-eabi)"
        return
    fi
    # shellcheck disable=SC2046 # none or one word
    build mps2 "$1" "CROSS=$cross" "CC=${cross}gcc" $(without "$1" | sed 's/.*/UNCALIBRATED=1/')
    library_symbols mps2 "$1" "${cross}nm" >"$b/symbols.txt"
    compare_symbols mps2 "$1"
    bytes=$("${cross}size" "$b/mps2/$1.elf" | awk 'NR == 2 { print $1, $2, $3 }')
    stack=$(stack mps2 "$1" "${cross}objdump")
    stack_fits mps2 "$1" "$stack" "${cross}nm"
    # shellcheck disable=SC2086 # three numbers
    row "$1" mps2 $bytes "$stack" "$(counted_m "$1")"
}

# The image for drives, linked from its parts, so that its bytes can be counted. It is not run
# here: no emulator of it is part of this. Its library symbols are those of mps2.
stm32f405_row()
{
    cross=arm-none-eabi-
    command -v "${cross}gcc" >/dev/null 2>&1 || return 0
    build stm32f405 "$1" "CROSS=$cross" "CC=${cross}gcc" PORT_WHOLE=
    library_symbols stm32f405 "$1" "${cross}nm" >"$b/symbols.txt"
    bytes=$("${cross}size" "$b/stm32f405/$1.elf" | awk 'NR == 2 { print $1, $2, $3 }')
    stack=$(stack stm32f405 "$1" "${cross}objdump")
    stack_fits stm32f405 "$1" "$stack" "${cross}nm"
    case $1 in
    custom | calibrate) ;; # as one object, their calls through pointers look like recursion
    *) grep -Eq '^SCENE_(MAIN|ROM)' "examples/$1/scene.mk" || whole_fits stm32f405 "$1" ;;
    esac
    # shellcheck disable=SC2086 # three numbers
    row "$1" stm32f405 $bytes "$stack" -
}

mkdir -p "$b"
[ $# -gt 0 ] || set -- minimal drop guarded custom glove bilateral bringup calibrate
: >"$b/table.txt"
for scene in "$@"; do
    [ -r "examples/$scene/scene.mk" ] || { note "$scene: no examples/$scene/scene.mk"; continue; }
    {
        posix_row "$scene"
        pc104_row "$scene"
        mps2_row "$scene"
        stm32f405_row "$scene"
        if [ "$scene" = minimal ]; then mps2_row minimal-frozen-1000; fi
    } >>"$b/table.txt"
done
printf '%-19s %-9s %8s %6s %6s %8s %12s %8s\n' scene port text_B data_B bss_B stack_B \
    insn/tick symbols
cat "$b/table.txt"
[ "$failed" = no ]
