# SPDX-License-Identifier: MIT
# What tests of an image under QEMU share: sourced, with name set to the test's, and dir to where
# it keeps what the image said (said) and what went wrong (err).
# shellcheck shell=bash disable=SC2154 # both are whoever sources it's

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
