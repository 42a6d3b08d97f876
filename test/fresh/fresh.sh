#!/bin/sh
# fresh.sh [ROOT]: both README commands in a new Debian 12 root that holds git, make and
# a C compiler and nothing else, on a clone of what is committed. Needs to be root.
# ROOT (default build/fresh) must be new, empty or made by an earlier run, which is removed first,
# and is kept afterwards to look into.
# Exit status: 0 both passed, 1 not, 2 ROOT is not ours to remove, 3 not root or no debootstrap.
set -eu
cd "$(dirname "$0")/../.."
root=${1:-build/fresh}
mine=.exhand-fresh # written into ROOT before anything else; without it nothing is removed

ours() # ROOT: new, empty, or marked
{
    if [ ! -e "$1" ]; then return 0; fi
    [ -d "$1" ] && { [ -f "$1/$mine" ] || [ -z "$(ls -A "$1")" ]; }
}

ours "$root" || {
    echo "fresh: $root: holds what fresh.sh did not make: not removed: name a new directory" >&2
    exit 2
}
[ "$(id -u)" = 0 ] || { echo "fresh: needs to be root (debootstrap, chroot)" >&2; exit 3; }
.ci/deps "fresh" debootstrap debootstrap || exit 3

mkdir -p "$root"
root=$(cd "$root" && pwd -P)
release() { umount "$root/proc" "$root/dev/pts" "$root/dev" 2>/dev/null || true; }
release
grep -q " $root/" /proc/mounts && { echo "fresh: $root: something is still mounted in it" >&2; exit 2; }
rm -rf --one-file-system "$root"
mkdir "$root"
: >"$root/$mine"
debootstrap --variant=minbase --include=git,make,gcc,libc6-dev bookworm "$root" >"$root.log" 2>&1 ||
    { tail -n 20 "$root.log"; exit 1; }
trap release EXIT
mount --bind /proc "$root/proc"
mount --bind /dev "$root/dev"
mount --bind /dev/pts "$root/dev/pts"
cp /etc/resolv.conf "$root/etc/resolv.conf"
[ -f /etc/hosts ] && cp /etc/hosts "$root/etc/hosts"
git clone -q . "$root/exhand"

inside() {
    echo "fresh: $*"
    chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
        sh -c "cd /exhand && $*"
}
inside 'dpkg -l | grep -c ^ii'
inside make demo
inside 'ls -l build/demo/*.png build/demo/table2.csv'
inside make test
echo "fresh: both commands passed"
