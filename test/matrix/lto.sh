#!/bin/sh
# SPDX-License-Identifier: MIT
# lto.sh OUT "CC FLAGS" BITCODE...: one object OUT.lto.o of all these, optimised as one program. For
# clang, whose bitcode the linkers of other CPUs do not read.
set -e
out=$1 cc=$2
shift 2
v=$(${cc%% *} --version | sed -n 's/.*clang version \([0-9]*\).*/\1/p')
llvm-link-"$v" -o "$out.all.bc" "$@"
opt-"$v" -passes=internalize,globaldce -internalize-public-api-list=main \
    -o "$out.one.bc" "$out.all.bc"
$cc -Wno-override-module -Wno-unused-command-line-argument -c -x ir "$out.one.bc" -o "$out.lto.o"
rm -f "$out.all.bc" "$out.one.bc"
