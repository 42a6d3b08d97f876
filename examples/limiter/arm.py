#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""arm.py [INCIDENT...] [--out DIR]: a joint whose leader fails, without and with a limiter.

The follower is one simulated joint with a drive of 5 Nm. The leader's messages come 100 times a
second, the loop runs 1000 times a second. "Before" is what is often written by hand: a clamp, and
the last message until another comes. "After" sends the same messages through exhand.Limiter.

    jump    the first position is 1 rad away, and after 1.5 s the leader jumps by 2.5 rad.
    stall   an object stops the joint, and the leader goes on.
    nan     the leader sends torque; for 0.1 s it is not a number.
    silent  the leader sends torque, and nothing after 1.5 s.

Writes INCIDENT.csv and, where gnuplot is there, INCIDENT.png. Needs the package exhand. The arm is
simulated: nothing here was run on hardware. Exit status: 0, 1 the limiter let too much through,
2 wrong usage.
"""
import argparse
import math
import shutil
import subprocess
import sys
from pathlib import Path

import exhand

STEP, END, AT = 0.001, 4.0, 1.5  # s: of the loop, of a run, of the failure
MOST = 5.0                       # Nm, of the drive
COMMON = dict(rate_Hz=1000, ramp_s=0.2, age_max_s=0.05, gap_max_s=0.02)
PLACE = dict(kind="position", uses=("pos", "effort"), pos_min=-3, pos_max=3, vel_max=2, acc_max=20,
             first_max=0.2, first="approach", after="limp", stall_effort=1.5, stall_move=0.01,
             stall_s=0.3)
TORQUE = dict(kind="effort", effort_max=1.0, effort_up=20, effort_down=40, release_s=0.02,
              first_max=1.0)


class Joint:
    """Inertia 0.02 kg m2, friction, ends at 2.5 rad, an object; a drive with its own limit."""

    def __init__(self, object_rad):
        self.q = self.speed = self.torque = 0.0
        self.object_rad = object_rad

    def step(self, torque):
        self.torque = max(-MOST, min(MOST, torque))
        force = self.torque - 0.05 * self.speed
        for end, side in ((2.5, 1), (-2.5, -1), (self.object_rad, 1)):
            if side * (self.q - end) > 0:
                force -= 400 * (self.q - end) + 2 * self.speed
        self.speed += force / 0.02 * STEP
        self.q += self.speed * STEP

    def servo(self, target):
        return 60 * (target - self.q) - 2 * self.speed


def leader(incident, t):
    """What it sends at time t; None: nothing."""
    sine = math.sin(2 * math.pi * t)
    if incident == "jump":
        return 0.3 * sine + 1.0 + (-2.5 if t >= AT else 0)
    if incident == "stall":
        return min(1.5, 0.8 * t)
    if incident == "nan":
        return math.nan if AT <= t < AT + 0.1 else 0.3 * sine
    return None if t >= AT else 0.1 * sine + (0.4 if t > AT - 0.1 else 0)


def run(incident, limiter):
    """Rows of time, message, sent, position, speed, torque; and what the limiter said."""
    joint, rows, step = Joint(0.8 if incident == "stall" else math.inf), [], None
    place, message, came = incident in ("jump", "stall"), math.nan, -math.inf
    said = []
    for k in range(round(END / STEP)):
        t = k * STEP
        if k % 10 == 0 and (new := leader(incident, t)) is not None:
            message, came = new, t
        if limiter is None:  # by hand
            most = 3.0 if place else 1.0
            sent, on = max(-most, min(most, message)), True
        else:
            step = limiter.step(t, message, pos=joint.q, effort=joint.torque, age_s=t - came,
                                run=k > 0)
            sent, on = step.send, step.enable
            if step.first and step.first not in said:
                said.append(step.first)
        joint.step((joint.servo(sent) if place else sent) if on else 0.0)
        rows.append((t, message, sent, joint.q, joint.speed, joint.torque))
    return rows, said


def told(name, rows, said):
    speed, torque = (max(abs(r[c]) for r in rows) for c in (4, 5))
    print("  %-7s %8.1f rad/s %6.2f Nm %10.2f Nm   %s" %
          (name, speed, torque, abs(rows[-1][5]), ", ".join(said) or "-"))
    return speed, torque, abs(rows[-1][5])


def picture(path, incident, place):
    """By gnuplot, where it is there."""
    if shutil.which("gnuplot") is None:
        return
    first = (4, "position, rad") if place else (6, "torque, Nm")
    text = ["set terminal pngcairo size 800,600", "set output '%s.png'" % path,
            "set datafile separator ','", "set key above", "set multiplot layout 2,1"]
    for column, label in (first, (5, "speed, rad/s")):
        text += ["set ylabel '%s'" % label, "plot '%s.csv' every ::1 using 1:%d with lines lw 2 "
                 "title 'before', '' every ::1 using 1:%d with lines lw 2 title 'after'" %
                 (path, column, column + 5)]
        text += ["set xlabel 't, s'"]
    subprocess.run(["gnuplot"], input="\n".join(text), text=True, check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("incident", nargs="*", help="jump, stall, nan, silent (all)")
    parser.add_argument("--out", type=Path, default=Path("build/limiter"))
    args = parser.parse_args()
    names, wrong = ("jump", "stall", "nan", "silent"), 0
    if set(args.incident) - set(names):
        parser.error("give some of %s" % ", ".join(names))
    args.out.mkdir(parents=True, exist_ok=True)
    for name in args.incident or names:
        place = name in ("jump", "stall")
        before, _ = run(name, None)
        after, said = run(name, exhand.Limiter(**COMMON, **(PLACE if place else TORQUE)))
        print("%-9s highest speed    torque    at the end   first cause" % name)
        told("before", before, [])
        speed, torque, last = told("after", after, said)
        fast = name == "jump" and speed > 1.1 * PLACE["vel_max"]
        wrong |= torque > MOST or fast or (name != "jump" and last > 0.01)
        path = args.out / name
        with open("%s.csv" % path, "w", encoding="ascii") as f:
            f.write("t_s" + "".join(",%s_%s" % (c, w) for w in ("before", "after") for c in (
                "message", "sent", "q_rad", "speed_radps", "torque_nm")) + "\n")
            for b, a in zip(before, after):
                f.write(",".join("%.6g" % v for v in (*b, *a[1:])) + "\n")
        picture(path, name, place)
    return int(wrong)


if __name__ == "__main__":
    sys.exit(main())
