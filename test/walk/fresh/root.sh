#!/bin/sh
# SPDX-License-Identifier: MIT
# root.sh make RELEASE ROOT [PACKAGE...]: a bare Debian of that name (bookworm, trixie, sid, ...) in
# ROOT, with those packages and
#     the way out that this machine has. ROOT must be new, empty or made by an earlier run, which is
#     removed first.
# root.sh copy ROOT NEW: such a root once more; NEW as ROOT above.
# root.sh run ROOT COMMAND: what a shell there makes of COMMAND, and its exit status. What is
# mounted for it goes with it. Needs to be root. Exit status: 1 it failed, 2 ROOT is not ours to
# remove, 3 not root or no debootstrap.
set -eu
mine=.exhand-fresh # written into ROOT before anything else; without it nothing is removed

new() # ROOT: there, empty but for the mark
{
    if [ -e "$1" ] && ! { [ -d "$1" ] && { [ -f "$1/$mine" ] || [ -z "$(ls -A "$1")" ]; }; }; then
        echo "fresh: $1: holds what root.sh did not make: not removed: name a new directory" >&2
        exit 2
    fi
    grep -q " $(realpath -m "$1")/" /proc/mounts &&
        { echo "fresh: $1: something is mounted in it" >&2; exit 2; }
    rm -rf --one-file-system "$1"
    mkdir -p "$1"
    : >"$1/$mine"
}

make_root() # RELEASE ROOT PACKAGE...
{
    release=$1 root=$2
    shift 2
    "$(dirname "$0")/../../../.ci/deps" "fresh" debootstrap debootstrap || exit 3
    new "$root"
    script=$release # one that this debootstrap does not know yet is made as sid is
    [ -e "/usr/share/debootstrap/scripts/$release" ] || script=sid
    debootstrap --variant=minbase --include="$(echo "${*:-apt}" | tr ' ' ,)" "$release" "$root" "" \
        "$script" >"$root.log" 2>&1 ||
        { tail -n 20 "$root.log"; exit 1; }
    # what debootstrap needed
    rm -rf "$root"/var/lib/apt/lists/* "$root"/var/cache/apt/archives/*.deb
    # For a mirror that is not updated. debootstrap does not check the date either.
    echo 'Acquire::Check-Valid-Until "false";' >"$root/etc/apt/apt.conf.d/90fresh"
    # No package of a root that is thrown away needs to survive a power cut: no sync for each file.
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/90fresh"
    for f in /etc/resolv.conf /etc/hosts; do [ ! -f $f ] || cp $f "$root$f"; done
    mkdir -p "$root/usr/local/share/ca-certificates"
    for f in /usr/local/share/ca-certificates/*.crt; do [ ! -f "$f" ] || cp "$f" "$root$f"; done
}

[ "$(id -u)" = 0 ] || { echo "fresh: needs to be root (debootstrap, chroot)" >&2; exit 3; }
what=${1:-}
[ $# = 0 ] || shift
case $what:$# in
make:[2-9] | make:[1-9][0-9]) make_root "$@" ;;
copy:2) new "$2"; cp -a "$1/." "$2" ;;
run:2)
    # shellcheck disable=SC2016 # expanded there
    exec unshare -m sh -ec 'mount --bind /proc "$0/proc"; mount --bind /dev "$0/dev";
         mount --bind /dev/pts "$0/dev/pts"
         exec chroot "$0" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin \
             LC_ALL=C.UTF-8 sh -c "$1"' "$1" "$2"
    ;;
*) sed -n '2,/^set/s/^# //p' "$0" >&2; exit 2 ;;
esac
