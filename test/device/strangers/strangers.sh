#!/bin/sh
# SPDX-License-Identifier: MIT
# strangers: Debian's own drivers of the cards, in Debian's own kernel, against our emulators.
# $B: where to build. ARGS=--update writes the golden register traffic. LIMIT_S: seconds it may take
# (1800). Exit 0: all as it should be; 1: not; 3: something is missing.
set -u
here=$(dirname "$0")
dir=${B:-build}/strangers
golden=test/device/emu/linux_trace.inc
start=$(date +%s)

"$here/fetch.sh" "$dir" || exit 3
for tool in clang i686-linux-gnu-gcc node; do
    command -v "$tool" >/dev/null || { echo "strangers: missing: $tool" >&2; exit 3; }
done
fetched=$(date +%s)

# The emulators, unchanged, and the program that runs as the machine's first process.
wasm()
{
    mkdir -p "$dir/wasm" && rm -f "$dir"/wasm/*.o
    for c in ports/posix/emu/emu.c ports/posix/emu/s526.c ports/posix/emu/mm32xat.c \
        ports/posix/emu/pins.c "$here/box.c"; do
        clang --target=wasm32 -std=c99 -O2 -ffreestanding -fno-builtin -Wall -Wextra -Werror \
            -Iports/posix/emu \
            -c "$c" -o "$dir/wasm/$(basename "$c" .c).o" || return
    done
    "$dir/root/usr/lib/llvm-14/bin/wasm-ld" --no-entry -o "$dir/box.wasm" "$dir"/wasm/*.o
}
guest()
{
    i686-linux-gnu-gcc -std=gnu99 -O2 -Wall -Wextra -Werror -static -o "$dir/init" "$here"/guest/*.c
}
# The host program for the machine, and the logs of the one that runs here.
loops()
{
    i686-linux-gnu-strip -o "$dir/exhand" "${B:-build}/variant/i686-O3/posix/exhand-linux" || return
    rm -rf "$dir/out" "$dir/plain" && mkdir "$dir/plain"
    exhand="${B:-build}/posix/exhand"
    "$exhand" drop --rate 2000 --falls 1 --jobs 1 --out "$dir/out" > /dev/null &&
        "$exhand" bilateral --fingers all --speed fast --approaches 1 --jobs 1 --out "$dir/out" \
        > /dev/null &&
        cp "$dir/out/drop_2000Hz.exh" "$dir/plain/1.exh" &&
        cp "$dir/out/bilateral_fast.exh" "$dir/plain/2.exh"
}
wasm && guest && loops || { echo "strangers: does not build" >&2; exit 1; }

echo "kernel $(ls "$dir"/deb | sed -n 's/linux-image-\(.*\)_i386.deb/\1/p'),"\
    "$(sed -n 's/.*"version": "\(.*\)",/v86 \1/p' "$dir/npm/node_modules/v86/package.json")"
(cd "$dir/module" && sha256sum s526.ko dmm32at.ko)
node "$here/run.mjs" "$dir" "$golden" ${ARGS:-}
status=$?
end=$(date +%s)
echo "strangers: $((end - start)) s, $((fetched - start)) of them to fetch; exit $status"
exit $status
