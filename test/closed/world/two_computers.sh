#!/bin/sh
# SPDX-License-Identifier: MIT
# two_computers.sh EXHAND WORLD: the whole command and the whole world program, connected only by
# UDP. They run as two processes on loopback, and in two network namespaces with a cable between.
# The latter needs root or user namespaces. Without, it says so. The world's material is softer than
# the controller's own. The contact must feel so, also for a controller that was started anew.
exhand=$1 world=$2
if [ ! -x "$exhand" ] || [ ! -x "$world" ]; then
    echo "usage: two_computers.sh EXHAND WORLD" >&2
    exit 2
fi

# Without root: root in a user namespace, if there is one, with a separate /run for ip.
if [ "$(id -u)" != 0 ] && [ -z "$TWO_INSIDE" ] && unshare -Urnm true 2>/dev/null; then
    export TWO_INSIDE=1
    exec unshare -Urnm sh -c 'mount -t tmpfs none /run && ip link set lo up && exec "$@"' sh "$0" \
        "$@"
fi

dir=$(mktemp -d) || exit 3
id=$$ port=$((20000 + $$ % 20000)) passed=0 failed=0 pid=
c=exh-c$id w=exh-w$id

clean()
{
    [ -z "$pid" ] || kill "$pid" 2>/dev/null
    ip netns del "$c" 2>/dev/null
    ip netns del "$w" 2>/dev/null
    rm -rf "$dir"
}
trap clean EXIT
trap 'exit 130' INT TERM

check() # WHAT COMMAND...
{
    what=$1
    shift
    if "$@"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAILED: $what"
    fi
}

# k N/m: the block before the index finger.
scene()
{
    sed -e "s/^material wood .*/material wood k $1 b 60 fmax 40/" \
        "$(dirname "$0")/../../../ports/posix/world/scenes/collision.world" >"$dir/scene.world"
}

# Force over depth, held at rest, N/m.
stiffness() # DIRECTORY
{
    awk -F, 'NR > 1 && $6 == 1 && $3 < 0.002 && $3 > -0.002 && $2 - $9 > 1e-4 {
            n++; k += $4 / ($2 - $9) }
             END { print (n > 100 ? int(k / n) : 0) }' "$1/bilateral_fast_index.csv"
}

near() # VALUE WANTED: within 4 %, as 0.1 N pulls all the time
{
    [ "$1" -gt $(($2 * 96 / 100)) ] && [ "$1" -lt $(($2 * 104 / 100)) ]
}

start_world() # PREFIX... ; listens at $at
{
    "$@" "$world" --headless --listen "$at" --scene "$dir/scene.world" --seconds 60 \
        --trace "$dir/trace.csv" >"$dir/world.out" 2>"$dir/world.err" &
    pid=$!
    sleep 0.3
}

end_world()
{
    kill "$pid" 2>/dev/null
    wait "$pid" 2>/dev/null
    pid=
}

felt() # WHERE LIFE K PREFIX...
{
    where=$1 life=$2 k=$3
    shift 3
    "$@" timeout 60 "$exhand" bilateral --udp "$at" --speed fast --approaches 1 --set mat_f_max=40 \
        --out "$dir/out" \
        >"$dir/said" 2>&1
    status=$?
    check "$where: controller $life ends with status $status: $(tail -n 1 "$dir/said")" \
        [ $status = 0 ]
    got=$(stiffness "$dir/out")
    echo "  | $where, controller $life: $got N/m felt, the scene's $k, the controller's own 20000"
    check "$where, controller $life: $got N/m felt, the scene has $k" near "$got" "$k"
    rm -rf "$dir/out"
}

# Every tick of each controller from its first frame on: "CONTROLLERS THOUSANDS-OF-FRAMES ODD-ONES".
traced()
{
    awk -F, 'NR > 1 { if (n && $1 == 0) { lives++ }
                  else if (n && ($1 != number + 1 || $2 != tick + 1)) { odd++ }
                      n++; number = $1; tick = $2 }
             END { print lives + 1, int(n / 1000), odd + 0 }' "$dir/trace.csv"
}

# shellcheck disable=SC2086 # prefixes are words, or none
meet() # WHERE WORLD-PREFIX CONTROLLER-PREFIX
{
    where=$1 there=$2 here=$3
    scene 15000
    start_world $there
    felt "$where" 1 15000 $here
    sleep 2 # without a key a world hears no other peer within a second (docs/WIRE.md)
    felt "$where" 2 15000 $here
    end_world
    check "$where: traces (controllers, thousands of frames, odd): $(traced)" \
        [ "$(traced | sed 's/ [1-9][0-9]* / n /')" = "2 n 0" ]
    check "$where: nothing is said: $(cat "$dir/world.err")" [ ! -s "$dir/world.err" ]
    scene 12000
    start_world $there
    felt "$where, another world" 3 12000 $here
    end_world
}

cable()
{
    {
        ip netns add "$c" && ip netns add "$w" &&
            ip -n "$c" link add v0 type veth peer name v1 netns "$w" &&
            ip -n "$c" addr add 10.77.1.1/24 dev v0 && ip -n "$w" addr add 10.77.1.2/24 dev v1 &&
            ip -n "$c" link set v0 up && ip -n "$w" link set v1 up
    } >/dev/null 2>&1
}

# A world of 52 lines, written from docs/WIRE.md alone: the contact of a plane is the same to the
# bit as over no link, from the first plane on.
stranger()
{
    printf '%s\n' 'hand at 0 0 0 palm 1 0 0 point 0 0 1' 'material wall k 20000 b 60 fmax 40' \
        'plane wall at 0.06 0.03 0.17 normal -0.8 0 0.6 material wall' >"$dir/plane.world"
    python3 "$(dirname "$0")/wall.py" "$port" &
    pid=$!
    sleep 0.5
    for link in "--udp 127.0.0.1:$port" ""; do
        # shellcheck disable=SC2086
        timeout 60 "$exhand" bilateral $link --scene "$dir/plane.world" --speed natural \
            --approaches 1 --out "$dir/out" >"$dir/said" 2>&1
        status=$?
        check "a stranger's world: $(tail -n 1 "$dir/said")" [ $status = 0 ]
        awk -F, '$8 != "" && $1 > 0.1' "$dir/out/bilateral_natural_index.csv" \
            >"$dir/felt.${link:+udp}"
    done
    end_world
    echo "  | a world of $(wc -l <"$(dirname "$0")/wall.py") lines of Python:" \
        "$(grep -c ',1,' "$dir/felt.udp") ticks of contact"
    check "a stranger's world: contact" grep -q ',1,' "$dir/felt.udp"
    check "a stranger's world: other bits" cmp -s "$dir/felt.udp" "$dir/felt."
}

at=127.0.0.1:$port
meet "loopback" "" ""
if command -v python3 >/dev/null; then
    stranger
else
    echo "  | a stranger's world: not tried: it needs python3"
fi
if cable; then
    at=10.77.1.2:4747
    meet "two namespaces" "ip netns exec $w" "ip netns exec $c"
else
    echo "  | two network namespaces: not tried: they need \`ip\` and root, or user namespaces"
fi
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
