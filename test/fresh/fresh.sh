#!/bin/sh
# fresh.sh [ROOT]: both README commands in a new Debian 12 root that holds git, make and
# a C compiler and nothing else, on a clone of what is committed. Needs to be root.
# The root (default build/fresh) is removed first and kept afterwards to look into.
set -eu
cd "$(dirname "$0")/../.."
root=$(mkdir -p "${1:-build/fresh}" && cd "${1:-build/fresh}" && pwd)
[ "$(id -u)" = 0 ] || { echo "fresh: needs to be root (debootstrap, chroot)" >&2; exit 3; }
.ci/deps "fresh" debootstrap debootstrap || exit 3

umount "$root/proc" "$root/dev" 2>/dev/null || true
rm -rf --one-file-system "$root"
debootstrap --variant=minbase --include=git,make,gcc,libc6-dev bookworm "$root" >"$root.log" 2>&1 ||
    { tail -n 20 "$root.log"; exit 1; }
trap 'umount "$root/proc" "$root/dev" 2>/dev/null || true' EXIT
mount --bind /proc "$root/proc"
mount --bind /dev "$root/dev"
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
