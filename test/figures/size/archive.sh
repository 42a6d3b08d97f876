# SPDX-License-Identifier: MIT
# How a check of an archive's object code begins: sourced, with the command line ARCHIVE OBJDUMP.
# Sets archive and objdump, and listing: a file for what objdump says, gone at the end. As set -eu.
# shellcheck shell=sh

set -eu

if [ $# -ne 2 ]; then
    echo "usage: $0 ARCHIVE OBJDUMP" >&2
    exit 2
fi
archive=$1
objdump=$2
[ -r "$archive" ] || { echo "$archive: not readable: build the library first" >&2; exit 2; }
command -v "$objdump" >/dev/null 2>&1 ||
    { echo "$objdump: not found: install its binutils" >&2; exit 3; }

listing=$(mktemp)
trap 'rm -f "$listing"' EXIT
