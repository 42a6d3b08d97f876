#!/bin/bash
# SPDX-License-Identifier: MIT
# shards.sh DIR: examples/sweep with the environment that sbatch gives a task. For any name of the
# array and any path, the map equals that of one process byte for byte, or the script refuses by
# name. GNU parallel is tried if it is installed.
# Exit status: 0 it is so, 1 not.
set -u
[ $# -eq 1 ] || { echo "usage: $0 DIR" >&2; exit 2; }
cd "$(dirname "$0")/../../.." || exit 1
rm -rf "${1:?}" && mkdir -p "$1" && dir=$(cd "$1" && pwd)
failed=0 passed=0
export EXHAND=${EXHAND:-$PWD/build/posix/exhand-lab}
map="--falls 1 --grid 3x2 --rate 90,500 --device observe=0.9"

says() # WHAT OK
{
    if [ "$2" = 1 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $1"; fi
}

# task IDS SHARDS DIR: what sbatch --array=IDS would run, one after the other. COUNT, MIN and MAX
# are those of this array alone.
tasks()
{
    local i status=0
    # shellcheck disable=SC2086 # lists of words
    for i in $1; do
        SLURM_ARRAY_TASK_ID=$i SLURM_ARRAY_TASK_COUNT=$(set -- $1; echo $#) \
            SLURM_ARRAY_TASK_MIN=${1%% *} SLURM_ARRAY_TASK_MAX=${1##* } SLURM_ARRAY_JOB_ID=1 \
            examples/sweep/sweep.sbatch "$3" "$2" $map >>"$dir/said.txt" 2>&1 || status=$?
    done
    return $status
}

# same WHAT DIR: shards there, merged, are the map of one process.
same()
{
    local n
    # shellcheck disable=SC2086 # a list of words
    n=$("$EXHAND" drop --sweep $map --out "$2" 2>&1 >/dev/null |
        sed -n 's/.*from \([0-9]*\).*/\1/p')
    [ "$n" = "$cells" ] && diff -r -x 'stability.*-of-*' -x jobs.tsv "$dir/one" "$2" >/dev/null
    says "$1 (${n:-0} of $cells cells were there)" $(($? == 0))
}

# refused WHAT WORDS COMMAND...
refused()
{
    local what=$1 words=$2 said status
    shift 2
    said=$("$@" 2>&1) && status=0 || status=$?
    [ $status = 2 ] && [ "$(echo "$said" | wc -l)" = 1 ] && [[ $said == *"$words"* ]]
    says "$what: $status: $said" $(($? == 0))
}

# shellcheck disable=SC2086 # a list of words
"$EXHAND" drop --sweep $map --jobs 1 --out "$dir/one" >/dev/null || exit 1
cells=$(grep -c '^[0-9]' "$dir/one/stability.csv")

tasks "1 2 3 4" 4 "$dir/array" && same "an array from 1" "$dir/array"
tasks "1 3" 4 "$dir/subset" && tasks "2 4" 4 "$dir/subset"
shards=$(cd "$dir/subset" && echo stability.*-of-*)
[ "$shards" = "$(cd "$dir/array" && echo stability.*-of-*)" ]
says "--array=2,4 computes shards 2 and 4: $shards" $(($? == 0))
same "a subset submitted again" "$dir/subset"
tasks "0 1 2" 3 "$dir/zero" && same "an array from 0" "$dir/zero"
relative=$(realpath --relative-to=. "$dir")/relative
tasks "1 2" 2 "$relative" && same "a relative path" "$relative"

batch=examples/sweep/sweep.sbatch
refused "a task beyond the shards" "--array: task 5" env SLURM_ARRAY_TASK_ID=5 $batch "$dir/x" 4
refused "no array" "SLURM_ARRAY_TASK_ID: none" env -u SLURM_ARRAY_TASK_ID $batch "$dir/x" 4
refused "no number of shards" "SHARDS: --falls" env SLURM_ARRAY_TASK_ID=1 $batch "$dir/x" --falls 1
refused "no shards" "SHARDS: 0" env SLURM_ARRAY_TASK_ID=1 $batch "$dir/x" 0
refused "a bad id" "SLURM_ARRAY_TASK_ID: 1x" env SLURM_ARRAY_TASK_ID=1x $batch "$dir/x" 4
refused "nothing" "give DIR" $batch
[ ! -e "$dir/x" ]
says "what is refused leaves nothing" $(($? == 0))

parallel=examples/sweep/parallel.sh
refused "parallel.sh: bad SHARDS" "SHARDS: 0" $parallel "$dir/x" 0 :
if command -v parallel >/dev/null && command -v rsync >/dev/null; then
    refused "parallel.sh: no program" "EXHAND: /nosuch" env EXHAND=/nosuch $parallel "$dir/x" 2 :
    for to in "$dir/absolute" "$relative-too"; do
        # shellcheck disable=SC2086 # a list of words
        $parallel "$to" 3 : $map >"$dir/parallel.txt" 2>&1
        grep -q "from $cells cells" "$dir/parallel.txt"
        says "parallel.sh $to: its shards are what it merges" $(($? == 0))
        same "parallel.sh $to" "$to"
    done
else
    echo "GNU parallel: not here: left out"
fi
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
