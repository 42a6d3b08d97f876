#!/bin/sh
# SPDX-License-Identifier: MIT
# package.sh DIR: what CMake installs for other projects, with the folder of libraries given in full
# and not. It checks the paths of exhand.pc, the versions that find_package(exhand) takes, and the
# version in the metadata for registries. Exit status: 0, 1 not as it should be, 3 one line names
# what is missing.
set -eu
unset MAKEFLAGS MFLAGS MAKELEVEL CC # of a make that is around
for tool in cmake pkg-config; do
    command -v $tool >/dev/null || { echo "package: skipped: no $tool"; [ -z "${EXH_ALL:-}" ] ||
        exit 3; exit 0; }
done
lib=$(cd "$(dirname "$0")/../../../lib" && pwd)
version=$(awk '/define EXH_VERSION_(MAJOR|MINOR|PATCH) /{v = v s $3; s = "."} END{print v}' \
    "$lib/include/exhand/exhand.h")
minor=${version%.*}
failed=0

# 1: what is asked, 2: 1 found, 0 not
asks() {
    cat >ask/CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.13)
project(ask LANGUAGES NONE)
find_package(exhand $1 QUIET)
if(exhand_FOUND)
  get_target_property(at exhand::static INTERFACE_INCLUDE_DIRECTORIES)
  if(NOT EXISTS \${at}/exhand/exhand.h)
    set(exhand_FOUND "but not its headers: \${at}")
  endif()
endif()
message("found: \${exhand_FOUND}")
END
    rm -rf ask/build
    cmake -S ask -B ask/build -DCMAKE_PREFIX_PATH="$PWD/usr" 2>&1 | grep -qx "found: $2" && return
    echo "package: libraries in $where: find_package(exhand $1): wanted $2" >&2
    failed=1
}

rm -rf "$1"
mkdir -p "$1/ask"
cd "$1"
for where in lib "$PWD/usr/lib"; do
    rm -rf build usr
    cmake -S "$lib" -B build -DCMAKE_INSTALL_PREFIX="$PWD/usr" -DCMAKE_INSTALL_LIBDIR="$where" \
        >said 2>&1 &&
        cmake --build build --target install >>said 2>&1 || { cat said >&2; exit 1; }
    said=$(PKG_CONFIG_PATH=usr/lib/pkgconfig pkg-config --cflags --libs exhand | sed 's/ *$//')
    [ "$said" = "-I$PWD/usr/include -L$PWD/usr/lib -lexhand" ] ||
        { echo "package: libraries in $where: pkg-config: $said" >&2; failed=1; }
    for ask in "" "$minor" "$version" "$version EXACT"; do asks "$ask" 1; done
    for ask in "$minor.999" "${minor%.*}.999" 999; do asks "$ask" 0; done
done
# What registries read says this version, too.
for said in lib/library.json lib/idf_component.yml; do
    grep -qE "^ *\"?version\"?: \"$version\",?$" "$lib/../$said" ||
        { echo "package: $said: its version is not $version" >&2; failed=1; }
done
# A CPU without an operating system gets the static library alone.
if command -v arm-none-eabi-gcc >/dev/null; then
    rm -rf usr
    make -s -C "$lib/.." install-lib B="$PWD/arm" PREFIX="$PWD/usr" CROSS=arm-none-eabi- \
        CFLAGS="-mcpu=cortex-m4 -mthumb" >said 2>&1 || { cat said >&2; exit 1; }
    [ "$(echo usr/lib/libexhand*)" = usr/lib/libexhand.a ] ||
        { echo "package: for a bare-metal CPU: $(echo usr/lib/libexhand*)" >&2; failed=1; }
fi
[ $failed = 0 ] &&
    echo "package: found by CMake and pkg-config, libraries in lib or in full;" \
        "$version as itself and $minor alone"
exit $failed
