#!/bin/sh
# SPDX-License-Identifier: MIT
# The processor emulator Unicorn, as its package on PyPI holds it (headers and library), into
# $B/unicorn, checked by its sum; never committed. Debian's 2.0.1 will not do: it cannot hand
# RDTSC to the harness, and lets the host's clock in.
#
# Environment: B (build), DEPS (yes).
# Exit status: 0 it is there, 3 it cannot be had (one line says why).
set -eu

b=${B:-build}
version=2.1.4
case $(uname -m) in
x86_64) sum=9d6e6dea140560de4ebd8446661f7ef84a357d428c14a3ef09dacd306ec8c239 ;;
*) sum= ;;
esac

missing()
{
    echo "hil: unicorn $version: not here: $*" >&2
    exit 3
}

[ ! -r "$b/unicorn/.complete" ] || exit 0
[ "${DEPS:-yes}" != no ] || missing "DEPS=no"
[ -n "$sum" ] || missing "no package for $(uname -m)"
.ci/deps "the processor emulator" "python3 -m pip --version" python3-pip ||
    missing "no pip"
rm -rf "$b/unicorn"
mkdir -p "$b/unicorn"
timeout 300 python3 -m pip download -q --disable-pip-version-check --no-deps --only-binary :all: \
    -d "$b/unicorn" "unicorn==$version" >"$b/unicorn/log" 2>&1 ||
    missing "pip download failed ($b/unicorn/log): $(tail -n 1 "$b/unicorn/log")"
echo "$sum  $(echo "$b"/unicorn/*.whl)" | sha256sum -c --quiet >/dev/null 2>&1 ||
    missing "its SHA-256 is not $sum"
python3 -m zipfile -e "$b"/unicorn/*.whl "$b/unicorn/all" || missing "it does not unpack"
mv "$b/unicorn/all/unicorn/include" "$b/unicorn/include"
mkdir "$b/unicorn/lib"
mv "$b/unicorn/all/unicorn/lib/libunicorn.so.2" "$b/unicorn/lib/"
rm -r "$b/unicorn/all"
rm -f "$b"/unicorn/*.whl
touch "$b/unicorn/.complete"
