#!/bin/sh
# SPDX-License-Identifier: MIT
# gpio: `exhand drop --pace --gpio` in an emulated Linux, on the kernel's simulated GPIO chip; then
# its logs, by the program that runs here. The machine's clock counts instructions: how busy this
# one is does not show in it. $B: where to build. LIMIT_S: seconds the machine may take (600).
# Exit 0: all as it should be; 1: not; 3: something is missing.
set -u
here=$(dirname "$0")
B=${B:-build}
dir=$B/gpio
start=$(date +%s)
for f in vmlinuz busybox exhand-v1 exhand-v2 module/gpio-simulated.ko; do
    [ -s "$dir/$f" ] || { echo "gpio: missing: $dir/$f" >&2; exit 3; }
done

gcc -std=gnu99 -O2 -Wall -Wextra -Werror -static -o "$dir/init" "$here"/guest/*.c ||
    { echo "gpio: does not build" >&2; exit 1; }
rm -rf "$dir/ram" "$dir/out" "$dir/logs.tar" && mkdir "$dir/ram" "$dir/out" || exit 1
cp "$dir/init" "$dir/busybox" "$dir/exhand-v1" "$dir/exhand-v2" "$dir/module/configfs.ko" \
    "$dir/module/gpio-simulated.ko" "$dir/ram" &&
    (cd "$dir/ram" && find . | ../busybox cpio -o -H newc > ../ram.cpio 2> /dev/null) &&
    [ -s "$dir/ram.cpio" ] || exit 1

cat "$dir/fetched"
timeout "${LIMIT_S:-600}" qemu-system-x86_64 -accel tcg -icount shift=1,sleep=off -m 256 \
    -nodefaults -display none -no-reboot \
    -kernel "$dir/vmlinuz" -initrd "$dir/ram.cpio" \
    -append "console=ttyS0 quiet panic=-1 mitigations=off rdinit=/init" \
    -serial file:"$dir/said" -serial file:"$dir/logs.tar" < /dev/null
[ $? = 124 ] && echo "not ok: the machine was stopped after ${LIMIT_S:-600} s" >> "$dir/said"
tr -d '\r' < "$dir/said" | grep -E '^(ok|not ok|#)'
failed=$(grep -c '^not ok' "$dir/said")
passed=$(grep -c '^ok' "$dir/said")
grep -q '^done' "$dir/said" || { echo "not ok: the machine did not come to its end:"; tail \
    -n 20 "$dir/said"; failed=$((failed + 1)); }

result() # TEXT, after the status of what it is about
{
    if [ $? = 0 ]; then passed=$((passed + 1)); echo "ok $1"; else failed=$((failed + 1))
    echo "not ok $1"; fi
}

# The box's own record. A fault's tick: nothing coded in it, and a current before it. What crossed
# inward replays bit for bit.
tar -x -m -C "$dir/out" -f "$dir/logs.tar" || failed=$((failed + 1))
for v in v1 v2; do
    for what in estop pair deadman; do
        log=$dir/out/${v}_$what/drop_100Hz.exh
        says=$("$B/posix/exhand" replay "$log" 2>&1)
        result "$v: $what: replay: $(echo "$says" | tail -n 1 | sed 's|.*/out/||')"
        "$B/posix/exhand" csv --all "$log" | awk -F, -v what="$what" '
            NR == 1 { for (i = 1; i <= NF; i++) { c[$i] = i } next }
            $c["faults"] && !seen { seen = NR; before = was; bits = $c["faults"] }
            seen && $c["i_des_a"] != 0 { last = NR }
            { was = $c["i_des_a"] }
            END { ticks = last ? last - seen + 1 : 0; max = what == "deadman" ? 4 : 0
                  printf "%.3f A before; fault %d; current zero %d ticks after the tick that " \
                         "saw it (at most %d)\n", before, bits, ticks, max
                  exit !(seen && before > 0.1 && bits == (what == "deadman" ? 16 : 1) &&
                         ticks <= max) }' > "$dir/judged"
        result "$v: $what: $(cat "$dir/judged")"
    done
done
echo "gpio: $(($(date +%s) - start)) s"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
