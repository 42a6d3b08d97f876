#!/bin/sh
# SPDX-License-Identifier: MIT
# fetch: gets what gpio.sh needs into DIR, by a private apt that leaves the system's unchanged. The
# packages are Debian's kernel, busybox, libgpiod of this Debian (1.6) and of the next one (2).
# Debian does not build its simulated GPIO chip, so its source and a compiler for the module are
# among them. Nothing is installed, and nothing of it is kept in the repository. Exit status 3: one
# line names what is missing.
set -u
dir=$1
mkdir -p "$dir" && cd "$dir" || exit 3
dir=$PWD
[ ! -f fetched ] || exit 0

missing()
{
    echo "gpio: missing: $*" >&2
    exit 3
}

command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null ||
    missing "apt-get (this needs a Debian 12)"
[ "$(dpkg --print-architecture)" = amd64 ] || missing "an amd64 machine: the kernel is one's"

private_apt() # NAME SOURCES
{
    mkdir -p "$1/state/lists/partial" "$1/cache/archives/partial"
    : > "$1/status"
    cat > "$1/apt.conf" <<END
Dir::State "$dir/$1/state";
Dir::State::status "$dir/$1/status";
Dir::Cache "$dir/$1/cache";
Dir::Etc::SourceParts "-";
Dir::Etc::SourceList "$2";
APT::Sandbox::User "root";
Acquire::Languages "none";
Acquire::Retries "2";
END
    export APT_CONFIG="$dir/$1/apt.conf"
    apt-get -qq update > "$1/log" 2>&1
}

# A mirror that is being renewed may lack one of several lists; what counts is whether the packages
# come.
download() # NAME PACKAGE...
{
    to=deb-$1
    log=$dir/$1/log
    shift
    rm -rf "$to" && mkdir "$to" && (cd "$to" && apt-get -qq download "$@" >> "$log" 2>&1)
}

this_debian()
{
    for list in /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list; do
        [ -r "$list" ] || continue
        private_apt v1 "$list"
        kernel=$(apt-cache depends linux-image-amd64 2>/dev/null |
            sed -n 's/.*Depends: linux-image-\([^ :]*\).*/\1/p' | head -n 1)
        [ -n "$kernel" ] || continue
        series=$(echo "$kernel" | cut -d . -f 1,2)
        download v1 "linux-image-$kernel" "linux-headers-$kernel" \
            "linux-headers-${kernel%-amd64}-common" "linux-kbuild-$series" \
            "linux-source-$series" busybox-static libgpiod-dev && return
    done
    tail -n 5 v1/log >&2
    missing "linux-image-amd64, its headers and source, busybox-static or libgpiod-dev \
from Debian's archive"
}

next_debian()
{
    uri=$(sed -n 's/^URIs: *//p; s/^deb  *\(\[[^]]*\] *\)\?\([^ ]*\).*/\2/p' "$list" | head -n 1)
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $uri trixie main" > v2.list
    private_apt v2 "$dir/v2.list"
    download v2 libgpiod-dev || { tail -n 5 v2/log >&2
    missing "libgpiod-dev of trixie from Debian's archive"; }
}

# Linked statically: a header and an archive are all.
library() # v1 v2
{
    rm -rf "root-$1" && dpkg-deb -x deb-"$1"/libgpiod-dev_*.deb "root-$1" &&
        cp root-"$1"/usr/include/gpiod.h root-"$1"/usr/lib/*/libgpiod.a "$1" ||
        missing "libgpiod.a in libgpiod-dev of $1"
}

# The module: the kernel's own two files, one line other, since it exports another name for the
# same.
module()
{
    rm -rf root source module && mkdir root source module
    for p in linux-image linux-headers linux-kbuild busybox-static; do
        for f in deb-v1/$p*.deb; do dpkg-deb -x "$f" root || missing "$f"; done
    done
    dpkg-deb --fsys-tarfile deb-v1/linux-source-*.deb | tar -x -O --wildcards '*.tar.xz' |
        xz -d -T 2 |
        tar -x -C source --strip-components=1 --wildcards '*/drivers/gpio/gpiolib.h' \
        '*/drivers/gpio/gpio-sim.c' '*/kernel/irq/irq_sim.c' ||
        missing "gpio-sim.c in the kernel's source"
    cp source/drivers/gpio/* module
    sed 's/handle_simple_irq(irq_to_desc(\(.*\)));/generic_handle_irq_safe(\1);/' \
        source/kernel/irq/irq_sim.c > module/irq_sim.c
    printf 'obj-m := gpio-simulated.o\ngpio-simulated-y := gpio-sim.o irq_sim.o\n' > module/Kbuild
    sed -i "s|/usr/src/linux-headers-|$dir/root/usr/src/linux-headers-|" \
        "root/usr/src/linux-headers-$kernel/Makefile"
    make -s -C "root/usr/src/linux-headers-$kernel" M="$dir/module" modules > module/log 2>&1 ||
        { tail -n 5 module/log >&2; missing "a module that builds: is gcc-12 there?"; }
    cp "$(find root/lib/modules -name configfs.ko)" module && cp root/boot/vmlinuz-* vmlinuz &&
        cp root/bin/busybox . ||
        missing "configfs.ko, vmlinuz or busybox"
}

unset MAKEFLAGS MAKELEVEL MAKEOVERRIDES
this_debian
next_debian
library v1
library v2
module
rm -rf source root root-v1 root-v2 # the packages go, too, once their names are known
{ ls deb-v1 |
    sed -n \
    's/linux-image-\(.*\)_amd64.deb/kernel \1/p; s/libgpiod-dev_\(.*\)_amd64.deb/libgpiod \1/p'
  ls deb-v2 | sed -n 's/libgpiod-dev_\(.*\)_amd64.deb/libgpiod \1/p'; } > fetched.new
rm -rf deb-v1 deb-v2 && mv fetched.new fetched
