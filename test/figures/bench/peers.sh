#!/bin/sh
# SPDX-License-Identifier: MIT
# Low-passes and sines of others beside ours: peers.sh fetch | fixmath | rust | table
#
# fetch: CMSIS-DSP's C sources, as its package on PyPI holds them, into $B/peers, checked by
# their sum; never committed. Without them it says why, and the table does not have them.
#
# fixmath: libfixmath's C sources, as Debian has them, by apt into $B/peers, also checked. The
# library in its package is compiled without optimisation.
#
# rust: builds the crate idsp, version and sums as peers_rust/Cargo.lock has them, into
# $B/peers/rust.
#
# table: runs $B/bench/peers and, if it was built, peers-i686. Prints both tables, and writes them
# as CSV into $B/bench/filters.csv and sines.csv, errors over fc/fs into sweep.csv. Instructions
# above the requirement are shown as "over", never fatal. SHORT: few cut-offs.
#
# Environment: B (build).
# Exit status: 0 ok, 2 bad usage, 3 valgrind or a binary missing. 1, of table: an error of ours is
# above its bound, or a twin is none. 1, of the others: not there.
set -eu

b=${B:-build}
here=test/figures/bench
name=cmsisdsp-1.10.3
sum=307d32298faa7c58db912851027fce35f886fec7eb1a27c4b309ce1a97f47519
LC_ALL=C
export LC_ALL

missing()
{
    echo "peers: $name: not fetched: $*; the tables do without" >&2
    exit 1
}

sum_is() # SHA-256 FILE
{
    echo "$1  $2" | sha256sum -c --quiet >/dev/null 2>&1 || missing "its SHA-256 is not $1"
}

fetch()
{
    [ ! -r "$b/peers/$name/.complete" ] || exit 0
    [ "${DEPS:-yes}" != no ] || missing "DEPS=no"
    rm -rf "$b/peers/$name" "$b/peers/$name.tar.gz"
    mkdir -p "$b/peers"
    command -v python3 >/dev/null || missing "python3 is missing"
    python3 -m pip --version >/dev/null 2>&1 || missing "pip is missing (python3-pip)"
    timeout 300 python3 -m pip download -q --disable-pip-version-check --no-deps --no-binary \
        cmsisdsp -d "$b/peers" "cmsisdsp==${name#*-}" >"$b/peers/log" 2>&1 ||
        missing "pip download failed ($b/peers/log): $(tail -n 1 "$b/peers/log")"
    sum_is $sum "$b/peers/$name.tar.gz"
    tar -xzf "$b/peers/$name.tar.gz" -C "$b/peers" "$name/Include" "$name/PrivateInclude" \
        "$name/Source" "$name/LICENSE" || missing "the archive does not unpack"
    touch "$b/peers/$name/.complete"
}

# Debian's sources, with lists of apt's own beside the system's, which may have none of sources.
fixmath()
{
    name=libfixmath-20220222
    [ ! -r "$b/peers/$name/.complete" ] || exit 0
    [ "${DEPS:-yes}" != no ] || missing "DEPS=no"
    command -v apt-get >/dev/null || missing "apt-get is missing"
    from=$(apt-cache madison libfixmath-dev 2>/dev/null |
        awk '{ split($6, a, "/"); print $5, a[1], a[2]; exit }')
    [ -n "$from" ] || missing "apt knows no libfixmath-dev (apt-get update)"
    rm -rf "$b/peers/apt" "$b/peers/$name"
    mkdir -p "$b/peers/apt/lists/partial" "$b/peers/$name"
    apt=$(cd "$b/peers/apt" && pwd)
    echo "deb-src $from" >"$apt/sources.list"
    { apt_get update && (cd "$apt" && apt_get source --tar-only --download-only libfixmath); } \
        >"$b/peers/apt.log" 2>&1 ||
        missing "apt-get failed ($b/peers/apt.log): $(tail -n 1 "$b/peers/apt.log")"
    sum_is 38a93f38bcf2b6fbc00bfc4e10905f8f012cc72943ec5eed69a459c3bc0349e0 \
        "$apt/libfixmath_0~20220222.orig.tar.xz"
    tar -xJf "$apt/libfixmath_0~20220222.orig.tar.xz" -C "$b/peers/$name" ./libfixmath ./LICENSE ||
        missing "the archive does not unpack"
    rm -rf "$apt"
    touch "$b/peers/$name/.complete"
}

apt_get()
{
    timeout 120 apt-get -q -o "Dir::Etc::SourceList=$apt/sources.list" \
        -o Dir::Etc::SourceParts=/dev/null \
        -o "Dir::State::Lists=$apt/lists" -o "Dir::Cache=$apt" "$@"
}

# The crate idsp, by cargo; for this CPU alone.
rust()
{
    [ ! -r "$b/peers/rust/release/libpeers.a" ] || exit 0
    [ "${DEPS:-yes}" != no ] ||
        { echo "peers: idsp: not fetched: DEPS=no; the tables do without" >&2
        exit 1; }
    command -v cargo >/dev/null ||
        { echo "peers: idsp: not fetched: cargo is missing; the tables do without" \
        >&2; exit 1; }
    mkdir -p "$b/peers"
    target=$(cd "$b/peers" && pwd)/rust
    (cd "$here/peers_rust" && CARGO_TARGET_DIR=$target timeout 600 cargo build \
        -q --release --locked) >"$b/peers/cargo.log" 2>&1 ||
        {
            echo "peers: idsp: not built ($b/peers/cargo.log):" \
                "$(tail -n 1 "$b/peers/cargo.log"); the tables do without" >&2
            exit 1
        }
}

[ $# = 1 ] || { echo "usage: peers.sh fetch|fixmath|rust|table" >&2; exit 2; }
[ -r "$here/peers.sh" ] || { echo "peers: run it at the top of the tree" >&2; exit 2; }
case $1 in
fetch) fetch; exit 0 ;;
fixmath) fixmath; exit 0 ;;
rust) rust; exit 0 ;;
table) ;;
*) echo "usage: peers.sh fetch|fixmath|rust|table" >&2; exit 2 ;;
esac

[ -x "$b/bench/peers" ] || { echo "peers: $b/bench/peers: not there" >&2; exit 3; }
command -v valgrind >/dev/null 2>&1 || { echo "peers: valgrind: missing" >&2; exit 3; }
tmp=$(mktemp -d) || exit 3
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
. "$here/callgrind.sh"

# name,by 22,by 22 at a high cut-off,by 64 per sample: three lines a peer, one for a sine
instructions()
{
    counts "$1" | awk -F, -v OFS=, '
        NR == 1 { empty = $3 / $2; next }
        $1 != last { if (NR > 2) print row; row = last = $1 }
        { row = row "," sprintf(++of[$1] == 3 ? "%.1f" : "%.0f", $3 / $2 - (of[$1] < 3) * empty) }
        END { print row }'
}

instructions "$b/bench/peers" >"$tmp/x64"
"$b/bench/peers" ram >"$tmp/ram"
"$b/bench/peers" time >"$tmp/ns"
: >"$tmp/i686"
if [ -x "$b/bench/peers-i686" ]; then
    instructions "$b/bench/peers-i686" >"$tmp/i686"
    "$b/bench/peers-i686" ram >"$tmp/ram"
fi
"$b/bench/peers" errors >"$tmp/errors"
"$b/bench/peers" sines >"$tmp/sines"
{
    echo "name,fc_fs,input,max_ppm,rms_ppm"
    "$b/bench/peers" sweep ${SHORT:+few}
} >"$b/bench/sweep.csv"
"$b/bench/peers" twins ||
    { echo "FAIL idsp: its twin in C does not do what the crate does"; status=1; }

echo "low-pass, second order: 22 channels of one sample (x64, i686), and one channel of 64"
echo "samples, each (b64); error in ppm of full scale, worst at rest; rms of a step;" \
    "of a sine at fc."
awk -F, -v ram="$tmp/ram" -v csv="$b/bench/filters.csv" -v times="$tmp/ns" '
    function triple(k) { return sprintf("%s; %s; %s", $k, $(k + 1), $(k + 2)) }
    function line(a, b, c, d, e, f, g, h, i, j) {
        printf "%-22s %6s %6s %6s %6s | %-25s %-25s %-25s %-25s | %-5s %5s\n", \
               a, b, c, d, e, f, g, h, i, j, mem }
    function of(list) { return ($1 in list) ? list[$1] : "-" }
    FILENAME == ram { ram_B[$1] = $2; next }
    FILENAME == times { ns[$1] = $2; next }
    FILENAME ~ /x64$/ { x64[$1] = $2; high[$1] = $3; x64_b[$1] = $4; next }
    FILENAME ~ /i686$/ { i686[$1] = $2; i686_high[$1] = $3; i686_b[$1] = $4; next }
    !head++ { mem = "RAM B"
              print "name,x64,x64_high,x64_b64,i686,i686_high,rest_1,step_1,sine_1,rest_2,step_2," \
                    "sine_2,rest_3,step_3,sine_3,rest_4,step_4,sine_4,latches,ram_B,ns" > csv
              line("", "x64", "b64", "i686", "b64", "fc/fs = 0.1", "0.01", "0.001", "0.0001",
                   "latch") }
    { mem = ram_B[$1]
      line($1, x64[$1], x64_b[$1], of(i686), of(i686_b), triple(2), triple(5), triple(8),
           triple(11), $14 ? "yes" : "no")
      row = $1 "," x64[$1] "," high[$1] "," x64_b[$1] "," of(i686) "," of(i686_high)
      for (k = 2; k <= 14; k++) row = row "," $k
      print row "," mem "," of(ns) > csv
      if (FNR == 1) {
          ours = $1
          stuck = $14
          for (k = 2; k <= 13; k++) {
              bound = (k - 2) % 3 ? 0.002 : 1 / 2147.483648
              if ($k + 0 > bound) wrong = wrong " " $k } } }
    END {
        a = x64[ours] > 760 ? "over" : x64[ours] > 708 ? "ok" : "goal"
        b = !(ours in i686) ? "not counted" : i686[ours] > 1498 ? "over" : \
            i686[ours] > 1033 ? "ok" : "stretch"
        printf "required of %s: 760 instructions x86-64 (goal 708): %s; 1498 i686 (stretch 1033):" \
               " %s; 28 B of RAM on 32-bit targets: %s\n", ours, a, b,
               (ram_B[ours] > 28 ? "over" : "ok")
        if (wrong != "") {
            printf "FAIL %s: error in ppm above 1 LSB at rest or 0.002 rms:%s\n", ours, wrong
                           bad = 1 }
        if (stuck) { printf "FAIL %s: latches\n", ours; bad = 1 }
        exit bad }
' "$tmp/ram" "$tmp/ns" "$tmp/x64" "$tmp/i686" "$tmp/errors" || status=1

echo
echo "sine and cosine of one angle, both: 2^20 angles"
awk -F, -v i686="$tmp/i686" -v csv="$b/bench/sines.csv" '
    FILENAME == i686 { n32[$1] = $2; next }
    FILENAME ~ /ns$/ { ns[$1] = $2; next }
    FILENAME ~ /x64$/ { n64[$1] = $2; next }
    !head { print "name,x64,i686,worst_ppm,rms_ppm,table_B,ns" > csv }
    { print $1 "," n64[$1] "," ($1 in n32 ? n32[$1] : "-") "," $2 "," $3 "," $4 "," ns[$1] > csv }
    BEGIN { row = "%-29s %6s %6s | %10s %10s | %7s\n" }
    !head++ { printf row, "", "x64", "i686", "worst ppm", "rms ppm", "table B" }
    { printf row, $1, n64[$1], $1 in n32 ? n32[$1] : "-", $2, $3, $4 }
' "$tmp/i686" "$tmp/ns" "$tmp/x64" "$tmp/sines"
exit ${status:-0}
