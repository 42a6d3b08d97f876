#!/bin/bash
# SPDX-License-Identifier: MIT
# contract.sh DIR: the port contract, and fault handlers, on images under QEMU. DIR holds the images
# of `make contract`, PORT/SCENE.elf. They run in virtual time, the same on every machine. The POSIX
# port runs the same checks in `make test`, pc104 with its cards in `make hil`.
# Exit status: 0 the contract holds, 1 not, 2 bad usage, 3 no emulator.
set -u

[ $# -eq 1 ] && [ -d "$1" ] || { echo "usage: $0 DIR" >&2; exit 2; }
dir=$1 failed=0
out=$(mktemp)
trap 'rm -f "$out"' EXIT

# run IMAGE STATUS PATTERN [OPTION...]: a line must match, extended
run()
{
    local image=$1 want=$2 pattern=$3 status
    shift 3
    "ports/${image%%/*}/run.sh" "$dir/$image.elf" "$@" >"$out" 2>&1 </dev/null
    status=$?
    [ "$status" = 3 ] && { cat "$out" >&2; exit 3; }
    if [ "$status" = "$want" ] && tr -d '\r' <"$out" | grep -aqE "$pattern"; then
        printf '%-24s %s\n' "$image" "$(tr -d '\r' <"$out" | grep -aE -m 1 "$pattern")"
    else
        echo "$image: status $status, want $want, and a line '$pattern'" >&2
        cat "$out" >&2
        failed=1
    fi
}

passed='^21 passed, 0 failed$' # as many as contract_test.c has
off='^dac 32768 32768 32768 32768 32768, enable 0$'

run mps2/contract 0 "$passed"
run mps2/contract_slow 0 "$passed"
# 16 ns an instruction: the checks between two ticks are more than 780 instructions
QEMU_FLAGS="-icount shift=4,sleep=off" run mps2/contract_fast 0 "$passed"
run mps2/minimal 0 '^ticks 2000 run, 0 missed, 1[0-9]{3} with a drive on$'
# Set up when it was built: as small as that, the same codes, and at no other rate.
run mps2/minimal-frozen-1000 0 '^ticks 2000 run, 0 missed, 1[0-9]{3} with a drive on$'
run mps2/minimal-frozen-2000 1 '^loop rate not possible$'
run mps2/minimal-digest 0 '^digest [0-9a-f]{8}$'
run mps2/minimal-frozen-1000-digest 0 "^$(grep -a '^digest' "$out" | tr -d '\r')\$"
run mps2/contract 0 "$off"
run mps2/overflow 5 "$off"
run mps2/overflow 5 '^processor exception 3$'
# Without BOX=none: nothing of the chip is there but processor, UART and timers. Each is named.
for part in clock: D/A: A/D: 'device not found$'; do
    run stm32f405/minimal 1 "^(part )?$part"
done
run stm32f405/contract-none 0 "$passed"
run stm32f405/contract_slow-none 0 "$passed"
QEMU_FLAGS="-icount shift=3,sleep=off" run stm32f405/contract_fast-none 0 "$passed"
run stm32f405/minimal-none 0 '^ticks 2000 run, 0 missed, 1[0-9]{3} with a drive on$'
run stm32f405/overflow-none 5 "$off"
run pc104/contract-none 0 "$passed" ticks=0
run pc104/contract_slow-none 0 "$passed" ticks=0
run pc104/overflow-none 5 'stack' ticks=0
exit $failed
