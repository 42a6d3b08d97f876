# SPDX-License-Identifier: MIT
# What bench.sh and peers.sh share; to be sourced. Needs $tmp, a directory for profiles.

# profile FUNCTION COMMAND...: callgrind collects inside FUNCTION only
profile()
{
    fn=$1
    shift
    valgrind -q --tool=callgrind --callgrind-out-file="$tmp/cg" --collect-atstart=no \
        --toggle-collect="$fn" "$@"
}

# total FILE: instructions in a profile, 0 if there is none
total()
{
    n=0
    [ ! -r "$1" ] || n=$(awk '/^totals:/ { print $2 }' "$1")
    echo "${n:-0}"
}

# counts BINARY: name,ops,instructions of each of its ops, the empty one first
counts()
{
    rm -f "$tmp"/cg*
    profile bench_measure --dump-after=bench_measure "$1" count >"$tmp/order"
    k=0
    while IFS=, read -r name ops; do
        k=$((k + 1))
        n=$(total "$tmp/cg.$k")
        [ "$n" -gt 0 ] || { echo "bench: $name: callgrind counted nothing" >&2; return 1; }
        echo "$name,$ops,$n"
    done <"$tmp/order"
}

# per_op BINARY: kernel,name,instructions of one op, the empty one subtracted; of programs whose ops
# have both
per_op()
{
    rm -f "$tmp"/cg*
    profile bench_measure --dump-after=bench_measure "$1" count >"$tmp/order"
    k=0
    while IFS=, read -r kernel name ops; do
        k=$((k + 1))
        echo "$kernel,$name,$ops,$(total "$tmp/cg.$k")"
    done <"$tmp/order" |
        awk -F, -v OFS=, \
        'NR == 1 { empty = $4 / $3; next } { print $1, $2, sprintf("%.1f", $4 / $3 - empty) }'
}
