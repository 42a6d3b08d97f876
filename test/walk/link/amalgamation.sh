#!/bin/sh
# SPDX-License-Identifier: MIT
# amalgamation.sh DIR LIBRARY OBJECT...: each header and source in DIR compiles alone as C99 and as
# C++17 without a warning (WARN: the flags), by gcc and clang. exhand.c offers the symbols of
# LIBRARY; the golden vectors (OBJECTs, and CMocka) run over it, EXH_RATES as elsewhere. The others
# need no symbol beyond mem* and the assertion. Compilers that are not here are named. Exit status:
# 0, 1 not as it should be, 3 what is missing (EXH_ALL=1).
set -eu
dir=$1 library=$2
shift 2
failed=0
symbols() { nm -g --defined-only "$1" | awk 'NF == 3 { print $3 }' | sort; }

# 1: compiler, 2: source, 3: object
compile() {
    cxx=$(echo "$WARN" | sed 's/-W[a-z]*-prototypes//g')
    case $1 in
    *++) $1 -std=c++17 -O2 -Werror $cxx -x c++ -c "$2" -o "$3" ;;
    *) $1 -std=c99 -O2 -Werror $WARN -c "$2" -o "$3" ;;
    esac
}

symbols "$library" >"$dir/wanted"
for cc in gcc clang g++ clang++; do
    command -v $cc >/dev/null || { echo "amalgamation: skipped: no $cc"
        [ -z "${EXH_ALL:-}" ] || exit 3; continue; }
    for source in "$dir"/*.c; do
        name=$(basename "$source" .c)
        object=$dir/$name-$cc.o
        compile $cc "$source" "$object" || { failed=1; continue; }
        echo "#include \"$name.h\"" >"$dir/alone" # a program that has the header alone
        case $cc in *++) set -- -x c++ -std=c++11 "$@" ;; *) set -- -x c -std=c99 "$@" ;; esac
        $cc "$1" "$2" "$3" -Wall -Wextra -Wpedantic -Wshadow -Werror -fsyntax-only -I"$dir" \
            "$dir/alone" || failed=1
        shift 3
        if [ "$name" != exhand ]; then
            nm -u "$object" | awk '{ print $2 }' |
                grep -vE '^(mem(cpy|set|cmp|move)|exh_assert_failed)$' &&
                { echo "amalgamation: $name needs these" >&2; failed=1; }
            continue
        fi
        symbols "$object" | diff "$dir/wanted" - || failed=1
        golden=$dir/golden-$cc
        $cc -no-pie "$@" "$object" -o "$golden" -lcmocka 2>"$dir/said" ||
            { cat "$dir/said"; exit 1; }
        EXH_RATES=${EXH_RATES:-1..100} "$golden" >"$dir/said" 2>&1 || { cat "$dir/said"; failed=1; }
        passed=$(sed -n 's/.*PASSED *\] \([0-9]*\) .*/\1/p' "$dir/said" | tail -n 1)
        echo "amalgamation: $cc: $passed golden modules, $(grep -c . "$dir/wanted") symbols"
    done
done
exit $failed
