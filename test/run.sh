#!/bin/sh
# run.sh BINARY...: runs each, shows what failed, ends with `N passed, N failed`.
passed=0 failed=0
log=$(mktemp) || exit 3
trap 'rm -f "$log"' EXIT
for t in "$@"; do
    name=${t#*/} name=${name#test/}
    start=$(date +%s)
    "$t" >"$log" 2>&1
    status=$?
    p=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$log" | tail -n 1)
    f=$(sed -n 's/^\[  FAILED  \] \([0-9]*\) test.*/\1/p' "$log" | tail -n 1)
    if [ -z "$p$f" ]; then # not CMocka: the plain printer's last line
        p=$(sed -n 's/^\([0-9]*\) passed, [0-9]* failed$/\1/p' "$log" | tail -n 1)
        f=$(sed -n 's/^[0-9]* passed, \([0-9]*\) failed$/\1/p' "$log" | tail -n 1)
    fi
    p=${p:-0} f=${f:-0}
    [ "$status" != 0 ] && [ "$f" = 0 ] && f=1 # died before it could say
    [ "$p$f" = 00 ] && f=1                    # ran nothing
    passed=$((passed + p)) failed=$((failed + f))
    printf '%-28s %4d passed %4d failed %4d s\n' "$name" "$p" "$f" $(($(date +%s) - start))
    [ "$f" = 0 ] || cat "$log"
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" != 0 ]
