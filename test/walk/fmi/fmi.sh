#!/bin/bash
# SPDX-License-Identifier: MIT
# fmi.sh RATE...: FMPy and fmuloader at the FMUs, in an environment of their own (build/fmi/venv).
# B: the build.
# FALLS: of a run (1). Exit status: 0, 1 a difference, 3 what is missing.
set -eu
B=${B:-build}
venv=$B/fmi/venv
export MAKEFLAGS= # FMPy's own make gets no flags of this one
command -v cmake >/dev/null ||
    { echo "fmi: missing: cmake: sudo apt-get install -y --no-install-recommends cmake make" >&2
    exit 3; }
"$venv/bin/python" -c 'import fmpy, fmuloader' 2>/dev/null ||
    { python3 -m venv "$venv" && "$venv/bin/pip" install \
    -q --disable-pip-version-check fmpy fmuloader; } >"$B/fmi/pip" 2>&1 ||
    { echo "fmi: missing: python3-venv, or fmpy and fmuloader: pip install fmpy fmuloader" >&2
    exit 3; }
"$venv/bin/python" -c 'import importlib.util as u, sys; sys.exit(u.find_spec("ecospy") is None)' ||
    # one more, where it can be had
    "$venv/bin/pip" install -q --disable-pip-version-check ecospy tbb >"$B/fmi/pip" 2>&1 || true
LD_LIBRARY_PATH=$venv/lib "$venv/bin/python" test/walk/fmi/fmi.py "$B/fmu" "$B/fmi/native" \
    "$B/posix/exhand" "${FALLS:-1}" "$@"
