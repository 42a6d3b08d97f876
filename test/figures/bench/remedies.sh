#!/bin/sh
# SPDX-License-Identifier: MIT
# remedies.sh LAB DIR [OPTION...]: the table of `exhand-lab bilateral --remedies 0`, with the
# instructions that each remedy's tick costs beside it (callgrind, whole ticks of one approach by
# one hand at each speed). LAB: exhand-lab. DIR: files go there.
set -eu
lab=$1 dir=$2
shift 2
. "$(dirname "$0")/callgrind.sh"
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
mkdir -p "$dir"
"$lab" bilateral --remedies 0 --out "$dir" "$@" >"$tmp/table"

cost()
{
    rm -f "$tmp/cg"
    profile held_tick "$lab" bilateral --remedies "$1" --approaches 1 --jobs 1 \
        --out "$tmp" >"$tmp/row"
    total "$tmp/cg" >"$tmp/n"
    awk -F, -v n="$(cat "$tmp/n")" \
        'NR > 1 { ticks += $NF } END { printf "%.0f\n", ticks ? n / ticks : 0 }' \
        "$tmp/remedies.csv"
}

rows=$(grep -c '^| ' "$tmp/table")
k=2 # the first row is the head, and the first remedy has no controller
: >"$tmp/costs"
while [ "$k" -lt "$rows" ]; do
    [ -t 2 ] && printf '\rremedies: instructions, %d of %d ' "$k" "$((rows - 1))" >&2
    cost "$k" >>"$tmp/costs"
    k=$((k + 1))
done
[ -t 2 ] && printf '\r\033[K' >&2
awk -v costs="$tmp/costs" '
    /^\|--/ { print $0 "--:|"; next }
    !/^\|/ { print; next }
    ++row == 1 { print $0 " instructions a tick |"; next }
    row == 2 { print $0 " |"; next }
    { getline c <costs; print $0 " " c " |" }' "$tmp/table" | tee "$dir/remedies.md"
