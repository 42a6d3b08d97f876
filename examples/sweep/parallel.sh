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
[ $# -ge 3 ] || { sed -n 's/^# \{0,1\}//p' "$0" | sed -n 2,7p >&2; exit 2; }
for t in parallel rsync; do
    command -v $t >/dev/null ||
        { echo "parallel.sh: missing: $t: install by: sudo apt-get install -y parallel rsync" >&2
        exit 3; }
done
dir=$1 n=$2 hosts=$3
shift 3
exhand=${EXHAND:-build/posix/exhand-lab}
[ -x "$exhand" ] || { echo "parallel.sh: $exhand: no program: make, or set EXHAND" >&2; exit 2; }
mkdir -p "$dir"
away=
[ "$hosts" = : ] ||
    away="--transferfile ./$exhand --return ./$dir/stability.{}-of-$n.csv --cleanup --workdir ..."
# shellcheck disable=SC2086 # a list of words
seq "$n" | parallel --will-cite --retries 3 --resume-failed --sshlogin "$hosts" $away \
    --joblog "$dir/jobs.tsv" \
    "mkdir -p ./$dir && ./$exhand drop --sweep --jobs 1 --shard {}/$n --out ./$dir" "$@"
exec "$exhand" drop --sweep --out "$dir" "$@"
