# SPDX-License-Identifier: MIT
# Shared by tests of an image under QEMU, which source it. They set name to the test's name, and dir
# to the directory of the image's output (said) and of error messages (err).
# shellcheck shell=bash disable=SC2154 # the sourcing script sets both

failed=0 checks=0

check() # WHAT COMMAND...
{
    local what=$1
    shift
    checks=$((checks + 1))
    "$@" && return
    failed=$((failed + 1))
    echo "$name: FAILED: $what" >&2
    sed 's/^/    /' "$dir/said" "$dir/err" >&2
}

says() # PATTERN: a whole line of what the image said
{
    tr -d '\r' <"$dir/said" | grep -aqE "$1"
}
