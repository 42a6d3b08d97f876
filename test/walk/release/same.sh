#!/bin/sh
# SPDX-License-Identifier: MIT
# Builds library and image twice from two folders and compares them byte by byte: same.sh DIR
# PORT and SCENE say which (pc104, minimal). Prints the SHA-256 of what is the same.
# Exit status: 0 the same, 1 not, 2 bad usage.
set -eu
[ $# -eq 1 ] || { echo "usage: $0 DIR" >&2; exit 2; }
port=${PORT:-pc104} scene=${SCENE:-minimal}
unset MAKEFLAGS MFLAGS CFLAGS LDFLAGS
rm -rf "$1"
for at in "$1/one" "$1/another/and/deeper"; do
    mkdir -p "$at"
    git ls-files -z | tar -c --null -T - | tar -x -C "$at"
    make -s -C "$at" PORT="$port" SCENE="$scene" all >"$at/said" 2>&1 || { cat "$at/said"; exit 1; }
done
status=0
for file in libexhand.a "$scene.elf"; do
    one=$1/one/build/$port/$file other=$1/another/and/deeper/build/$port/$file
    if cmp "$one" "$other"; then
        echo "$(sha256sum <"$one" | cut -d ' ' -f 1)  $port/$file"
    else
        status=1
    fi
done
exit $status
