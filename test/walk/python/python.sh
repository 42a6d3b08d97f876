#!/bin/bash
# SPDX-License-Identifier: MIT
# python.sh SCENES [ARG...]: builds sdist and wheel of ports/python, installs the wheel in a
# separate environment (build/python/venv), and runs the tests by pytest ARG.... B: the build. Exit
# status: 0, 1 a test failed, 3 one line names what is missing.
set -eu
B=${B:-build}
scenes=$1
shift
dir=$B/python tree=$B/python/tree venv=$B/python/venv
export MAKEFLAGS= PIP_DISABLE_PIP_VERSION_CHECK=1
mkdir -p "$dir"
"$venv/bin/python" -c 'import build, pytest, numpy, pandas, mcap' 2>/dev/null ||
    { python3 -m venv "$venv" && "$venv/bin/pip" install -q build pytest numpy pandas mcap; } \
    >"$dir/pip" 2>&1 ||
    { echo "python: missing: build pytest numpy pandas mcap: no package index can be reached:" \
    "see $dir/pip" >&2
    exit 3; }

# The source distribution has its own copy of the library.
rm -rf "$tree" "$dir/dist"
mkdir -p "$tree/examples"
cp -R ports/python/. LICENSE lib "$tree"
for s in $scenes; do cp -R "examples/$s" "$tree/examples"; done
"$venv/bin/python" -m build --outdir "$dir/dist" "$tree" >"$dir/build.txt" 2>&1 ||
    { tail -n 30 "$dir/build.txt" | cut -c 1-300; exit 1; }
grep -E '\.[ch]:[0-9]+:.*warning:' "$dir/build.txt" &&
    { echo "python: a warning: see $dir/build.txt" >&2; exit 1; }
"$venv/bin/pip" install -q --force-reinstall --no-deps "$dir"/dist/*.whl
EXHAND=$(realpath "$B/posix/exhand") "$venv/bin/python" -m pytest -q -p no:cacheprovider \
    test/walk/python "$@"
ls -l "$dir"/dist/* | awk '{print $NF ": " $5 " bytes"}'
