#!/bin/sh
# Runs what `make hil` shows: hil.sh; each line of a run is one thing checked.
#
# Environment: B (build), TICKS (ticks of the long runs), FEW (of the others).
# Exit status: 0 all ok, 1 not, 3 something is not built.
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
    what=$1 image=$2
    shift 2
    echo "$image: $what"
    "$hil" --quiet "$@" "$b/pc104/$image.elf" || { failed=1; echo "  FAILED: $hil $* $b/pc104/$image.elf"; }
}

run "blocks counted one by one too" drop --singly --options "ticks=1000"
run "a scene too slow: each hundredth tick takes two and a half periods" slow --late 40 --options "ticks=2000"
run "random and extreme inputs" minimal --wild --options "ticks=$few"
run "random and extreme inputs" drop --wild --options "ticks=$few"
run "random and extreme inputs" bilateral --wild --options "ticks=$few"
exit $failed
