#!/bin/bash
# SPDX-License-Identifier: MIT
# scale.sh DIR: the sweeps of examples/sweep on this machine: by GNU parallel, by ssh to a local
# server, as a Slurm array on a cluster of one. Each must leave the same file of cells as one
# process, byte for byte. Needs parallel; openssh-server; slurmctld, slurmd, slurm-client, munge and
# root. What is missing is named and left out.
# Exit status: 0 all are equal, 1 not, 2 wrong usage.
set -u
[ $# -eq 1 ] || { echo "usage: $0 DIR" >&2; exit 2; }
cd "$(dirname "$0")/../../.." || exit 1
mkdir -p "$1"
dir=$(realpath --relative-to=. "$1") passed=0 failed=0
rm -rf "${dir:?}"/*
map="--falls 1 --grid 6x5 --rate 90,500"

same() # WHAT DIR
{
    if cmp -s "$dir/one/stability.csv" "$dir/$2/stability.csv"; then
        passed=$((passed + 1))
        echo "$1: $(grep -c '^[0-9]' "$dir/$2/stability.csv") cells, as by one process"
    else
        failed=$((failed + 1))
        echo "$1: FAILED: other cells than by one process"
    fi
}

# shellcheck disable=SC2086 # a list of words
{
build/posix/exhand-lab drop --sweep $map --jobs 1 --out "$dir/one" >/dev/null || exit 1

if command -v parallel >/dev/null; then
    examples/sweep/parallel.sh "$dir/here" 3 : $map >"$dir/here.txt" 2>&1
    same "GNU parallel, here" here
else
    echo "GNU parallel: not here: left out"
fi

if command -v parallel >/dev/null && command -v rsync >/dev/null && [ -x /usr/sbin/sshd ]; then
    key=$PWD/$dir/key
    ssh-keygen -q -t ed25519 -N '' -f "$key"
    cp "$key.pub" "$dir/authorized"
    mkdir -p /run/sshd 2>/dev/null
    printf '%s\n' "Port 47522" "ListenAddress 127.0.0.1" "HostKey $key" \
        "AuthorizedKeysFile $PWD/$dir/authorized" \
        "StrictModes no" "PidFile $PWD/$dir/sshd.pid" "UsePAM no" "PermitRootLogin yes" \
        >"$dir/sshd_config"
    printf '%s\n' "Host loop" "HostName 127.0.0.1" "Port 47522" "IdentityFile $key" \
        "StrictHostKeyChecking no" \
        "UserKnownHostsFile /dev/null" "LogLevel ERROR" >"$dir/ssh_config"
    /usr/sbin/sshd -f "$PWD/$dir/sshd_config" -E "$PWD/$dir/sshd.log"
    PARALLEL_SSH="ssh -F $PWD/$dir/ssh_config" examples/sweep/parallel.sh "$dir/ssh" 3 2/loop $map \
        >"$dir/ssh.txt" 2>&1
    same "GNU parallel, ssh to this machine" ssh
    kill "$(cat "$dir/sshd.pid")"
else
    echo "ssh: no sshd here: left out"
fi

if command -v sbatch >/dev/null && command -v slurmctld >/dev/null && [ "$(id -u)" = 0 ]; then
    test/walk/sweep/slurm.sh "$dir/slurm.d" sbatch --wait --array=1-3 \
        -o "$PWD/$dir/slurm-%a.txt" examples/sweep/sweep.sbatch "$dir/slurm" 3 $map \
        >"$dir/slurm.txt" 2>&1
    build/posix/exhand-lab drop --sweep $map --out "$dir/slurm" >>"$dir/slurm.txt" 2>&1
    same "Slurm, an array of three tasks" slurm
else
    echo "Slurm: not here, or not root: left out"
fi
}
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
