#!/bin/sh
# SPDX-License-Identifier: MIT
# window.sh WORLD DIR [KEY...]: opens the window of the world simulator on a separate screen,
# presses keys as a user does, and leaves. DIR gets the last draw list. Prints the program's exit
# status. Exit status 77: no screen.
world=$1 dir=$2
shift 2
command -v Xvfb >/dev/null && command -v xdotool >/dev/null || exit 77
rm -f "$dir/display" # of a screen before
Xvfb -displayfd 3 -screen 0 1024x700x24 3>"$dir/display" >/dev/null 2>&1 &
screen=$!
trap 'kill $screen 2>/dev/null; wait $screen 2>/dev/null' EXIT
for _ in $(seq 100); do [ -s "$dir/display" ] && break; sleep 0.1; done
[ -s "$dir/display" ] || exit 77
DISPLAY=:$(cat "$dir/display")
export DISPLAY
SDL_VIDEODRIVER=x11 "$world" --scene ports/posix/world/scenes/collision.world --seconds 60 \
    --list "$dir/list" >"$dir/out" 2>&1 &
program=$!
for _ in $(seq 100); do
    window=$(xdotool search --name '^Collision with simple bodies$' 2>/dev/null | head -n 1)
    [ "$window" ] && break
    kill -0 $program 2>/dev/null || break
    sleep 0.1
done
if [ "$window" ]; then
    xdotool windowfocus "$window" >/dev/null 2>&1
    sleep 0.5
    for key in "$@"; do xdotool key --delay 20 "$key"; sleep 0.05; done
    sleep 1.5
    # to be looked at, where there is such a program
    xwd -silent -root -out "$dir/screen.xwd" 2>/dev/null
    xdotool key q
    for _ in $(seq 50); do kill -0 $program 2>/dev/null || break; sleep 0.1; done
    kill -9 $program 2>/dev/null && echo "q does not end it"
fi
wait $program
echo $?
