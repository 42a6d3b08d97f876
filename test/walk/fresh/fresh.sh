#!/bin/sh
# SPDX-License-Identifier: MIT
# fresh.sh RELEASE [PAGE...]: types each command block of the pages (default README.md and
# docs/PORTING.md) on a bare Debian of that release (bookworm is 12, trixie 13). It works in a clone
# of the last commit. The bare root has no package that the smallest debootstrap leaves out. The
# pages install the others. Environment: AT, the directory of the roots (build/fresh). They are
# kept, for a look into them. Needs root.
#
# Exit status: 0 all blocks passed, 1 not, 2 a root is not ours to remove, 3 not root or no
# debootstrap.
set -eu
cd "$(dirname "$0")/../../.."
release=${1:-bookworm}
shift "$(($# > 0))"
at=${AT:-build/fresh}/$release
mkdir -p "$at"
test/walk/fresh/root.sh make "$release" "$at/bare"
echo "fresh: $release: $(ls "$at"/bare/var/lib/dpkg/info/*.list | wc -l) packages"
[ $# -gt 0 ] || set -- README.md docs/PORTING.md
test/walk/pages/walk.py --root "$at/bare" "$at" "$@"
