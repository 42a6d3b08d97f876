#!/bin/sh
# SPDX-License-Identifier: MIT
# valgrind.sh EXHAND: short runs of the host program under valgrind. It detects uninitialised values
# in every linked library, which no sanitizer does. Each run must end with status 0 and no report,
# in its children, too. Exit status: 0 all do, 1 not, 3 there is no valgrind.
[ $# = 1 ] || { echo "usage: $0 EXHAND" >&2; exit 2; }
exhand=$(realpath "$1")
command -v valgrind >/dev/null || { echo "valgrind: missing: nothing was run" >&2; exit 3; }
dir=$(mktemp -d) || exit 2
trap 'rm -rf "$dir"' EXIT
trap 'exit 3' HUP INT TERM
cd "$dir" || exit 2
printf '0,0,0\n1,0,1\n2,1,1\n3,1,0\n' >lines.csv
awk 'BEGIN {for (n = 0; n < 20; n++) for (i = 0; i < 22; i++)
    printf "%.2f%s", 0.1 + 0.01 * n, i < 21 ? "," : "\n"}' >hand.csv

# What its children have used of a core.
children_s()
{
    awk -v hz="$(getconf CLK_TCK)" '{print ($16 + $17) / hz}' /proc/$$/stat
}

failed=0 passed=0
while read -r words; do
    before=$(children_s)
    # shellcheck disable=SC2086 # they are words
    valgrind -q --error-exitcode=99 "$exhand" $words >out 2>err </dev/null
    status=$?
    if [ $status = 0 ] && ! grep -q '^==[0-9]*==' err; then
        passed=$((passed + 1))
        echo "$before $(children_s)" |
            awk -v w="$words" '{printf "  ok %5.1f s of a core: %s\n", $2 - $1, w}'
    else
        failed=$((failed + 1))
        echo "  FAIL: $words: status $status"
        grep -v '^$' err | head -n 20
    fi
done <<END
regs
quad --csv lines.csv
run --seconds 0.3 --log log.exh --let-go 0.1 --blackbox box.exh
csv log.exh --all
replay log.exh
drop --rate 90 --falls 1 --runs 2 --jobs 2 --save-params p.bin --out drop
drop --rate 90 --falls 1 --runs 1 --jobs 1 --load-params p.bin
calibrate --rate 100 --mass 0.3,0.6 --out cal
calibrate --check cal/calibration.bin
bilateral --rate 200 --set glove_fc=50 --speed fast --approaches 1 --seeds 1 --out hand
glove --rate 90 --csv hand.csv --tips
glove --record glove.exh --seconds 0.2 --does grasp
bringup
END
echo "$passed passed, $failed failed"
[ $failed = 0 ]
