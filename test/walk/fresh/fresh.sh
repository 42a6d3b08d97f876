#!/bin/sh
# SPDX-License-Identifier: MIT
# fresh.sh [RELEASE [ROOT]]: both README commands in a new Debian (default bookworm, which is 12)
# that holds git, make and a C compiler and nothing else, on a clone of what is committed. Needs to
# be root. ROOT (default build/fresh/RELEASE) is kept afterwards to look into; else as root.sh says.
# Exit status: 0 both passed, 1 not, 2 ROOT is not ours to remove, 3 not root or no debootstrap.
set -eu
cd "$(dirname "$0")/../../.."
release=${1:-bookworm}
root=${2:-build/fresh/$release}
test/walk/fresh/root.sh make "$release" "$root" git make gcc libc6-dev
git clone -q . "$root/exhand"

inside() # COMMAND
{
    echo "fresh: $release: $*"
    start=$(date +%s)
    test/walk/fresh/root.sh run "$root" "cd /exhand && $*"
    took="$took, $* in $(($(date +%s) - start)) s"
}
took=
inside 'dpkg -l | grep -c ^ii; gcc --version | head -n 1'
took=
inside make demo
test/walk/fresh/root.sh run "$root" 'cd /exhand && ls -l build/demo/*.png build/demo/table2.csv'
inside make test
echo "fresh: both commands passed: $release$took"
