#!/bin/sh
# SPDX-License-Identifier: MIT
# fresh.sh ROOT SDIST: in ROOT, a bare Debian with gcc, libc6-dev and python3-venv (root.sh),
# installs SDIST into an empty environment and runs the tests that need no host program. Needs to be
# root.
set -eu
root=$1
rm -rf "$root/exhand" "$root/v"
git clone -q . "$root/exhand"
cp "$2" "$root/exhand"
exec test/walk/fresh/root.sh run "$root" '
    set -e
    update-ca-certificates >/dev/null 2>&1 || :
    export PIP_CERT=/etc/ssl/certs/ca-certificates.crt
    find / -xdev -name Python.h | wc -l | sed "s/$/ files Python.h/"
    cd /exhand && python3 -m venv /v && /v/bin/pip install -q pytest ./*.tar.gz
    cd test/walk/python
    exec /v/bin/python -m pytest -q -p no:cacheprovider \
        test_kernels.py test_library.py test_limiter.py \
        test_examples.py'
