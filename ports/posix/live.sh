#!/bin/bash
# SPDX-License-Identifier: MIT
# live.sh EXHAND WORLD: a world, a box in it, and who watches the box: three programs, until one of
# them ends or Ctrl-C; then none is left. Its exit status is that of the first that ended.
#
# Environment: LIVE_SECONDS (until Ctrl-C), LIVE_SCENE (collision.world), LIVE_FINGERS (all),
# LIVE_UDP and LIVE_MODBUS (ports; free ones), LIVE_ARGS (more options of the box).
exhand=$1 world=$2
if [ ! -x "$exhand" ] || [ ! -x "$world" ]; then
    echo "usage: live.sh EXHAND WORLD" >&2
    exit 2
fi
scene=${LIVE_SCENE:-$(dirname "$0")/world/scenes/collision.world}
dir=$(mktemp -d) || exit 3
head=

is_there() { kill -0 "$1" 2>/dev/null; }

# Asks each program to end. One that does not end within five seconds is killed.
end_all()
{
    trap '' INT TERM HUP
    for pid in $(jobs -pr); do kill -TERM "$pid" 2>/dev/null; done
    for _ in {1..50}; do
        [ -n "$(jobs -pr)" ] || break
        sleep 0.1
    done
    for pid in $(jobs -pr); do kill -KILL "$pid" 2>/dev/null; done
    wait
}

# What box and world said beside the watch, which has the terminal.
tell()
{
    for who in world box; do
        [ ! -s "$dir/$who" ] || sed "s/^/$who: /" "$dir/$who"
    done
}

finish() # STATUS
{
    end_all
    tell
    rm -rf "$dir"
    exit "$1"
}
trap 'finish 130' INT TERM HUP

start_world()
{
    # shellcheck disable=SC2086 # one word, or none
    "$world" $head --scene "$scene" --listen "127.0.0.1:$port" >"$dir/world" 2>&1 &
    there=$!
}

if [ -z "$DISPLAY$WAYLAND_DISPLAY" ]; then
    head=--headless
    echo "world: no screen (DISPLAY, WAYLAND_DISPLAY): it runs without pictures"
fi

without_pictures()
{
    sed 's/^/world: /' "$dir/world"
    echo "world: it runs without pictures"
    head=--headless
}

# What is wrong with the world is said before there is a box. Of free ports the next is taken.
port=${LIVE_UDP:-$((20000 + $$ % 20000))}
for _ in {1..20}; do
    start_world
    sleep 0.3
    is_there "$there" && break
    wait "$there"
    status=$?
    if [ "$status" = 3 ] && [ -z "$head" ]; then
        without_pictures
    elif grep -q "choose another address or port" "$dir/world" && [ -z "$LIVE_UDP" ]; then
        port=$((port + 1))
    else
        finish "$status"
    fi
done

# shellcheck disable=SC2086 # options
"$exhand" run --scene bilateral --udp "127.0.0.1:$port" --fingers "${LIVE_FINGERS:-all}" \
    --modbus "tcp:127.0.0.1:${LIVE_MODBUS:-0}" --grip ${LIVE_SECONDS:+--seconds "$LIVE_SECONDS"} \
    $LIVE_ARGS >"$dir/box" 2>&1 &
box=$!
at=
while is_there "$box" && [ -z "$at" ]; do
    at=$(sed -n 's/^modbus: //p' "$dir/box")
    [ -n "$at" ] || sleep 0.1
done
if [ -n "$at" ]; then
    echo "world: $scene at UDP 127.0.0.1:$port; box: Modbus $at; Ctrl-C ends all"
    "$exhand" watch --modbus "$at" &
fi

while :; do
    wait -n
    status=$?
    # Built without pictures, or no window can be: the box takes another world as it comes.
    if [ "$status" = 3 ] && [ -z "$head" ] && ! is_there "$there" && is_there "$box"; then
        without_pictures
        start_world
        continue
    fi
    finish "$status"
done
