#!/bin/sh
# SPDX-License-Identifier: MIT
# The pin table and the picture of docs/STM32F405.md, from wiring.tsv: wiring.sh [--check]
# --check compares the table and writes nothing. Exit status: 0 all well, 1 the page is another,
# 2 bad usage, 3 no Graphviz.
set -eu

here=ports/stm32f405 page=docs/STM32F405.md
[ -r "$here/wiring.tsv" ] || { echo "$0: run it at the top of the tree" >&2; exit 2; }
case "$#${1:-}" in 0 | 1--check) ;; *) echo "usage: $0 [--check]" >&2; exit 2 ;; esac
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
awk -v want=md -f "$here/wiring.awk" "$here/wiring.tsv" >"$work/table"
awk -v table="$work/table" '
    /^<!-- end -->/ { skip = 0 }
    !skip { print }
    /^<!-- wiring -->/ { skip = 1; while ((getline line < table) > 0) print line }' \
    "$page" >"$work/page"
if [ "${1:-}" = --check ]; then
    cmp -s "$work/page" "$page" || { echo "$page: not of wiring.tsv: make wiring" >&2; exit 1; }
    exit 0
fi
command -v dot >/dev/null 2>&1 || { echo "dot: not found: install graphviz" >&2; exit 3; }
cat "$work/page" >"$page"
awk -v want=dot -f "$here/wiring.awk" "$here/wiring.tsv" | dot -Tsvg |
    awk '/^<svg/ { on = 1 } !on || /^<!--/ { next }
        { printf "%s%s", $0, /^<\/(g|svg)>$/ ? "\n" : " " }' >docs/stm32f405.svg
