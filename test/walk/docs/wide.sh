#!/bin/sh
# SPDX-License-Identifier: MIT
# wide.sh [FILE...]: names file and line of each line with more than 100 columns; of all
# sources that git knows, when no file is given. Left out: what Simulink wrote,
# and the text of the proofs, which is part of their record's keys. Exit status: 0 none, 1 some.
LC_ALL=C.UTF-8
export LC_ALL
[ $# -gt 0 ] || {
    # shellcheck disable=SC2046 # no name has a blank
    set -- $(git ls-files Makefile '*.mk' '*.py' '*.sh' '*.awk' '*.gp' '*.plt' '*.mjs' '*.ld' \
        '*.acsl' '*.c' '*.h' | grep -vE '_ert_rtw/|^test/strength/proof/.*\.(c|h|acsl)$')
}
grep -nHE '^.{101,}' "$@" || exit 0
exit 1
