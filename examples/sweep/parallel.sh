#!/bin/sh
# SPDX-License-Identifier: MIT
# parallel.sh DIR SHARDS HOSTS [OPTION...]: `exhand-lab drop --sweep OPTION... --out DIR` as so many
# shards by GNU parallel, on HOSTS as its --sshlogin has them ("8/big,4/small"; ":" is this
# machine). Nothing needs to be there but ssh and a processor of this kind: the program goes along,
# files of cells come back. Run again after whatever went wrong, it does the shards that failed.
# Environment: EXHAND, the program (build/posix/exhand-lab; for other machines a static one:
# README.md). Exit status: 0, 2 wrong usage,
# 3 no parallel or rsync, else that of parallel or of the program.
set -eu
refuse() { echo "parallel.sh: $1" >&2; exit 2; }
[ $# -ge 3 ] || { sed -n 's/^# \{0,1\}//p' "$0" | sed -n 2,7p >&2; exit 2; }
dir=$1 n=$2 hosts=$3 exhand=${EXHAND:-build/posix/exhand-lab}
shift 3
case $n in '' | 0* | *[!0-9]*) refuse "SHARDS: $n: give a whole number from 1" ;; esac
for t in parallel rsync; do
    command -v $t >/dev/null ||
        { echo "parallel.sh: missing: $t: install by: sudo apt-get install -y parallel rsync" >&2
        exit 3; }
done
[ -f "$exhand" ] && [ -x "$exhand" ] ||
    refuse "EXHAND: $exhand: no program: make lab, or set EXHAND"
exhand=$(cd "$(dirname "$exhand")" && pwd)/${exhand##*/}
mkdir -p "$dir"
dir=$(cd "$dir" && pwd)
if [ "$hosts" = : ]; then
    seq "$n" | parallel --will-cite --quote --retries 3 --resume-failed --joblog "$dir/jobs.tsv" \
        "$exhand" drop --sweep --jobs 1 --shard "{}/$n" --out "$dir" "$@"
else # There the program and the cells lie in a folder of parallel's own.
    (cd "$dir" && seq "$n" | parallel --will-cite --quote --retries 3 --resume-failed \
        --sshlogin "$hosts" --joblog jobs.tsv \
        --transferfile "${exhand%/*}/./${exhand##*/}" --return "stability.{}-of-$n.csv" \
        --cleanup --workdir ... \
        "./${exhand##*/}" drop --sweep --jobs 1 --shard "{}/$n" --out . "$@")
fi
exec "$exhand" drop --sweep --out "$dir" "$@"
