#!/bin/sh
# SPDX-License-Identifier: MIT
# A bootable ISO of an image: iso.sh IMAGE ISO [OPTION...]; GRUB 2 on it starts the image with
# these options after two seconds, in which others can be typed (e).
# Environment: MODULES, files that GRUB brings along, blanks between: calibrations of fingers.
# Exit status: 0 made, 1 not, 2 bad usage, 3 a tool is missing.
set -eu

if [ $# -lt 2 ] || [ ! -r "$1" ]; then
    echo "${1:-image}: not readable: usage: $0 IMAGE ISO [OPTION...]" >&2
    exit 2
fi
image=$1 iso=$2
shift 2
for tool in grub-mkrescue xorriso mformat; do
    command -v "$tool" >/dev/null 2>&1 ||
        { echo "$tool: not found: install grub-pc-bin grub-common xorriso mtools" >&2; exit 3; }
done
modules=/usr/lib/grub/i386-pc
[ -r "$modules/multiboot.mod" ] || { echo "$modules: not found: install grub-pc-bin" >&2; exit 3; }

tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/disc/boot/grub"
cp "$image" "$tree/disc/boot/exhand.elf"
bring=
for file in ${MODULES:-}; do
    bring="$bring    module /boot/$(basename "$file")
"
    cp "$file" "$tree/disc/boot/"
done
cat >"$tree/disc/boot/grub/grub.cfg" <<EOF
set timeout=${ISO_TIMEOUT_s:-2}
menuentry "exhand $(basename "$image" .elf) $*" {
    multiboot /boot/exhand.elf $*
$bring}
EOF
grub-mkrescue -d "$modules" --install-modules="multiboot iso9660 biosdisk normal part_msdos" \
    --fonts= --locales= --themes= -o "$iso.new" "$tree/disc" >"$tree/said" 2>&1 ||
    { cat "$tree/said" >&2; rm -f "$iso.new"; exit 1; }
mv "$iso.new" "$iso"
