#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh BINARY...: runs each test, prints its result and its notes (lines that begin with "  | "),
# and all output of a failed one. Ends with `N passed, N failed`.
#
# Environment: PARTS (1): so many processes share the random cases of each test (EXH_PART,
# EXH_PARTS). JOBS (1) of them run at a time, and each prints a line when it ends. LIMIT (3600 s): a
# longer run hangs, and has failed. The longest takes a minute of a core.

# run_part BINARY PART: its line, and `PASSED FAILED` at the end of the file $TALLY
run_part()
{
    name=${1#"${1%/*/*}"/} log=$(mktemp) || return 1
    [ "$PARTS" = 1 ] || name="$name $(($2 + 1))/$PARTS"
    start=$(date +%s)
    EXH_PART=$2 EXH_PARTS=$PARTS timeout --foreground "${LIMIT:-3600}" "$1" >"$log" 2>&1
    status=$?
    [ "$status" != 124 ] || echo "stopped after ${LIMIT:-3600} s: it hangs" >>"$log"
    p=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$log" | tail -n 1)
    f=$(sed -n 's/^\[  FAILED  \] \([0-9]*\) test.*/\1/p' "$log" | tail -n 1)
    if [ -z "$p$f" ]; then # not CMocka: the plain printer's last line
        p=$(sed -n 's/^\([0-9]*\) passed, [0-9]* failed$/\1/p' "$log" | tail -n 1)
        f=$(sed -n 's/^[0-9]* passed, \([0-9]*\) failed$/\1/p' "$log" | tail -n 1)
    fi
    p=${p:-0} f=${f:-0}
    [ "$status" != 0 ] && [ "$f" = 0 ] && f=1 # died before it could say
    [ "$p$f" = 00 ] && f=1                    # ran nothing
    { # in one piece, as others run beside it
        printf '%-28s %4d passed %4d failed %4d s\n' "$name" "$p" "$f" $(($(date +%s) - start))
        if [ "$f" = 0 ]; then grep '^  | ' "$log"; else cat "$log"; fi
    } >"$log.said"
    cat "$log.said"
    echo "$p $f" >>"$TALLY"
    rm -f "$log" "$log.said"
}

if [ "${1:-}" = --part ]; then
    run_part "$3" "$2"
    exit 0
fi

[ $# -gt 0 ] || { echo "usage: $0 BINARY..." >&2; exit 2; }
PARTS=${PARTS:-1} TALLY=$(mktemp) || exit 3
export PARTS TALLY
trap 'rm -f "$TALLY"' EXIT
trap 'exit 3' HUP INT TERM
part=0
while [ "$part" -lt "$PARTS" ]; do
    for t in "$@"; do echo "$part $t"; done
    part=$((part + 1))
done | xargs -n 2 -P "${JOBS:-1}" "$0" --part
awk -v want=$(($# * PARTS)) '
    { passed += $1; failed += $2 }
    END { failed += want - NR # killed with their line unsaid
          printf "%d passed, %d failed\n", passed, failed; exit failed || !passed }' "$TALLY"
