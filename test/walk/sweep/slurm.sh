#!/bin/bash
# SPDX-License-Identifier: MIT
# slurm.sh DIR COMMAND...: a Slurm cluster of this machine alone, its files in DIR, while COMMAND
# runs. Root. Exit status: COMMAND's.
set -u
[ $# -ge 2 ] || { echo "usage: $0 DIR COMMAND..." >&2; exit 2; }
mkdir -p "$1/state" "$1/spool"
dir=$(cd "$1" && pwd) host=$(hostname -s)
shift
head -c 32 /dev/urandom >"$dir/munge.key"
chmod 600 "$dir/munge.key"
cat >"$dir/slurm.conf" <<CONF
ClusterName=exhand
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=47617
SlurmdPort=47618
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
CryptoType=crypto/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES State=UP
CONF
export SLURM_CONF=$dir/slurm.conf
munged --foreground --force --socket="$dir/munge.socket" --key-file="$dir/munge.key" \
    --pid-file="$dir/munge.pid" \
    --log-file="$dir/munge.log" --seed-file="$dir/munge.seed" &
sleep 1
slurmctld -D >"$dir/slurmctld.log" 2>&1 &
slurmd -D >"$dir/slurmd.log" 2>&1 &
trap 'kill $(jobs -p) 2>/dev/null; wait 2>/dev/null' EXIT
for _ in $(seq 60); do sinfo -h -t idle -o %n 2>/dev/null | grep -q . && break; sleep 0.5; done
timeout 300 "$@"
