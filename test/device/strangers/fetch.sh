#!/bin/sh
# SPDX-License-Identifier: MIT
# fetch: gets what strangers.sh needs into DIR. A private apt that leaves the system's unchanged
# gets Debian's i386 kernel with the drivers, a BIOS and a linker for WebAssembly. npm gets v86.
# Nothing of it is kept in the repository. Exit status 3: one line names what is missing.
set -u
dir=$1
mkdir -p "$dir" && cd "$dir" || exit 3
dir=$PWD

missing()
{
    echo "strangers: missing: $*" >&2
    exit 3
}

command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null ||
    missing "apt-get (this needs a Debian 12)"
command -v npm >/dev/null ||
    missing "npm: install by: sudo apt-get install -y --no-install-recommends npm"

private_apt()
{
    mkdir -p apt/state/lists/partial apt/cache/archives/partial
    : > apt/status
    cat > apt/apt.conf <<END
Dir::State "$dir/apt/state";
Dir::State::status "$dir/apt/status";
Dir::Cache "$dir/apt/cache";
Dir::Etc::SourceParts "-";
Dir::Etc::SourceList "$1";
APT::Architectures {"$(dpkg --print-architecture)"; "i386";};
APT::Sandbox::User "root";
Acquire::Languages "none";
Acquire::Retries "2";
END
    export APT_CONFIG="$dir/apt/apt.conf"
}

# A mirror that is being renewed may lack one of several lists; what counts is whether the packages
# come.
packages()
{
    for list in /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list; do
        [ -r "$list" ] || continue
        private_apt "$list"
        apt-get -qq update > apt/log 2>&1
        kernel=$(apt-cache depends linux-image-686:i386 2>/dev/null |
                 sed -n 's/.*Depends: \(linux-image-[^ :]*\).*/\1/p' | head -n 1)
        [ -n "$kernel" ] || continue
        rm -rf deb && mkdir deb
        (cd deb && apt-get -qq download "$kernel:i386" seabios lld-14 >> ../apt/log 2>&1) && return
    done
    tail -n 5 apt/log >&2
    missing "linux-image-686:i386, seabios or lld-14 from Debian's archive"
}

unpack()
{
    rm -rf root module && mkdir root module
    dpkg-deb --fsys-tarfile deb/linux-image-*.deb |
        tar -x -C root --wildcards './boot/vmlinuz*' '*/comedi.ko*' '*/comedi_8255.ko*' \
        '*/s526.ko*' '*/dmm32at.ko*' ||
        missing "the drivers in $kernel"
    for p in seabios lld-14; do dpkg-deb -x deb/"$p"_*.deb root || missing "$p"; done
    find root/lib/modules -name '*.ko.xz' -exec xz -d {} +
    find root/lib/modules -name '*.ko' -exec cp {} module \;
    cp root/boot/vmlinuz* vmlinuz
    [ "$(ls module | wc -l)" = 4 ] ||
        missing "one of the drivers comedi, comedi_8255, s526, dmm32at in $kernel"
}

v86()
{
    mkdir -p npm && cd npm || exit 3
    [ -f package.json ] || echo '{"private": true}' > package.json
    npm install --silent --no-audit --no-fund v86 > log 2>&1 ||
        { tail -n 5 log >&2; missing "v86 from npm"; }
    cd ..
}

if [ ! -f fetched ]; then
    packages
    unpack
    v86
    touch fetched
fi
