#!/bin/bash
# SPDX-License-Identifier: MIT
# mutants.sh DIR: breaks the small port's promises one by one, and the contract must detect each.
# DIR holds the objects of `make image PORT=mps2 SCENE=contract`. Each line below is a file of
# ports/mps2, a sed expression, and the promise of board.h that it breaks.
# Exit status: 0 all were detected, 1 not, 2 bad usage.
set -u

[ $# -eq 1 ] && [ -d "$1/mps2/contract" ] ||
    { echo "usage: $0 DIR, with mps2/contract in it" >&2; exit 2; }
objects=$1/mps2/contract
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cc="arm-none-eabi-gcc -std=c99 -O2 -mcpu=cortex-m3 -mthumb -ffreestanding"
cc="$cc -ffunction-sections -fdata-sections"
off='^dac 32768 32768 32768 32768 32768, enable 0$'
told=0 untold=0

while IFS='#' read -r file change promise; do
    until [ -n "$promise" ]; do # it goes on in the next line
        IFS='#' read -r more promise || exit 1
        change="$change $more"
    done
    sed -E "$change" "ports/mps2/$file.c" >"$work/$file.c"
    if cmp -s "ports/mps2/$file.c" "$work/$file.c"; then
        echo "mutants: $change: changes nothing in $file.c" >&2
        exit 1
    fi
    # shellcheck disable=SC2046,SC2086 # lists of words
    $cc -Iports/mps2 -Ilib/include -DMPS2_TICKS=0u -c "$work/$file.c" -o "$work/$file.o" &&
        $cc -nostdlib -static -Wl,--gc-sections -T ldscripts/mps2.ld "$work/$file.o" \
            $(find "$objects" -name '*.o' ! -path "*/mps2/$file.o") "$1/mps2/libexhand.a" -lgcc \
            -o "$work/image.elf" || exit 1
    if TIMEOUT_s=20 ports/mps2/run.sh "$work/image.elf" >"$work/said" 2>&1 &&
        grep -aqE "$off" "$work/said"; then
        echo "mutants: not told: $promise: $change" >&2
        untold=$((untold + 1))
    else
        told=$((told + 1))
        [ -z "${V:-}" ] ||
            echo "$promise: $(grep -a -m 1 '^FAILED' "$work/said" || tail -n 1 "$work/said")"
    fi
done <<'END'
board#s/"mps2"/"mps 2"/#a name of printable characters
board#s/= EXH_BOARD_VERSION/= EXH_BOARD_VERSION + 1/#its version
board#s/(\.enc_bits = ).*/\18,/#width of its counters
board#s/ \|\| rate_Hz > exh_board_info.rate_max_Hz//#rates above its own are refused
board#s/\{counts, CLOCK_HZ\}/{counts + counts \/ 500, CLOCK_HZ}/#the period is what was set
board#s/SYST_RELOAD = counts - 1;/& SYST_VALUE = 0; SYST_CONTROL = SYST_RUN;/
    #set-up is no missed tick
board#s/seen = now;/seen++;/#missed ticks are counted once
board#s/(n - 1 > INT_MAX.*)\(int\)\(n - 1\)/\10/#missed ticks are counted
board#s/(n - 1 > INT_MAX.*)\(int\)\(n - 1\)/\1(int)n/#a tick on time is 0 missed
board#s/ticks\+\+;/static uint32_t half; ticks += ++half % 2;/
    #ticks come at the period, by the cycles
box#s/EXH_DIN_CARDS\}/EXH_DIN_CARDS | 0x80u}/#no input that is not there
box#s/\{\.din = EXH_DIN_ESTOP \| /{.din = /#inputs of an idle box are healthy
box#s/EXH_DIN_WATCHDOG \| //#a box whose watchdog has not fired says so
box#s/ \| EXH_DIN_CARDS\}/}/#cards that are healthy say so
box#s/(in->mon_raw\[i\] =)/in->enc_raw[i] = frames * 50; \1/#counts of an idle box stand still
box#s/enabled >> i \& 1 \?/1 ?/#a drive that is not enabled has no current
box#s/enabled >> i \& 1 \?/enabled \& 1 ?/#each finger has its own enable
box#s/(enabled = out->enable);/if (out->enable) { \1; }/#enables are taken away again
box#s/(for \(unsigned i.*) \{ (ref.i. = within.*)/if (!out->enable) \1 { \2/
    #codes act together with enables
box#s/\{ ref\[i\] = 0; \}/{}/; s/^    enabled = 0;//#safe takes the current away
box#s/(void mps2_box_safe.*)/static int safe_calls; \1/; s/^    enabled = 0;/if (++safe_calls <
    10) { return; } enabled = 0;/#safe works the first time
board#s/^    exh_board_safe\(\);//#halt is safe
board#s/is_done\(why\) \? EXIT_DONE : exit_status/EXIT_FAILED/#halt says that it is done
box#s/age_ticks = 0/age_ticks = UINT16_MAX/#there is a glove frame
box#s/(\*in = \(struct exh_glove_in\)\{\.age_ticks =) 0\};/static uint16_t age; \1 age++};
    in->raw[0] = (int16_t)age;/#a glove frame that grows older stays the same
box#s/(\*in = \(struct exh_glove_in\)\{\.age_ticks =) 0\};/static uint16_t age; \1 age}; age =
    (uint16_t)(age + 3);/#a glove frame grows older by a tick a tick
board#s/return ~TIMER_VALUE;/return 1;/#cycles run
board#s/return ~TIMER_VALUE;/return ~TIMER_VALUE \& 0xFFFF;/#cycles are modulo 2^32
board#/^int exh_board_log/,/^}/s/return 0;/return (int)(len_B \/ 2);/#a record is taken whole
board#/^int exh_board_log/,/^}/s/return 0;/for (volatile int i = 0; i < 30000; i++) {} return
    0;/#log does not block
board#/^int exh_board_link_send/,/^}/s/return 0;/return 3;/#a packet is sent whole
board#/^int exh_board_link_send/,/^}/s/return 0;/for (volatile int i = 0; i < 30000; i++) {}
    return 0;/#send does not block
board#/^int exh_board_link_recv/,/^}/s/return 0;/return 4;/#no packet, no bytes
board#/^int exh_board_link_recv/,/^}/s/\(void\)buf;/if (cap_B > 4) { ((char *)buf)[4] = 1; }/
    #no packet, nothing written
board#/^int exh_board_link_recv/,/^}/s/return 0;/for (volatile int i = 0; i < 30000; i++) {}
    return 0;/#receive does not block
END
echo "mutants of a port: $told told by the contract, $untold not"
[ "$untold" = 0 ]
