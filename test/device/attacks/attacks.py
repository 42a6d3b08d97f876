#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""attacks.py [options] EXHAND: attacks on the link, the ports and the files of a box.

A row an attack: what was tried how often, what the box counted, the verdict. By the box's own log:
- in no tick is a force or current above the person's ceiling, person_f and person_i;
- no parameter changes but by who may change it;
- the true peer stays heard where it must, else is heard again within a second of the attack's end;
- a monitor that reads every 0.4 s keeps its connection.
Exit status: 0 all hold, 1 an attack succeeds or a row could not be judged. Standard library only.
"""

import argparse
import os
import shutil
import sys
import tempfile
import threading
import time

import files
import image
import link
import planted
import ports
import rig

GAP_S = {"stays": 0.5, "again": 1.0}  # how long the peer may not be heard behind an attack
WAIT_S = 1.5                          # what is looked at behind it
SUMS = {"late": ("duplicate", "reordered", "old", "stranger"), "bad": ("corrupt", "version",
        "unknown"), "accepted": ("accepted",), "set": ("set",), "refused": ("refused",)}


class Report:
    """A line a row."""

    def __init__(self, quiet=False):
        self.failed, self.rows, self.wrong, self.lock = 0, 0, [], threading.Lock()
        self.quiet = quiet

    def row(self, name, what, tried, counted, wrong):
        with self.lock:
            self.rows += 1
            self.failed += bool(wrong)
            self.wrong += wrong
            if not self.quiet:
                print("%-6s %-14s %-46s tried %-6s counted: %-30s %s" % (
                    "FAILED" if wrong else "ok", name, what, tried, counted, "; ".join(wrong)),
                    flush=True)


def hole(ticks, first, last):
    """The longest time in which no question of the true peer was answered."""
    inside = [first] + [t for t in ticks if first < t < last] + [last]
    return max(b - a for a, b in zip(inside, inside[1:])) / rig.RATE_HZ


def heard(ticks, span, must):
    """What is wrong with how the true peer was heard."""
    start, end, behind = span
    holes = [("behind it", end, behind, GAP_S[must])]
    holes += [("meanwhile", start, end, GAP_S["stays"])] if must == "stays" else []
    return ["%s the peer was not heard for %.2f s" % (when, hole(ticks, first, last))
            for when, first, last, most in holes if hole(ticks, first, last) > most]


def counts(rows, span, named):
    """{name: how many}: of the window by the log, or of the whole run by what the box said."""
    start, _, behind = span
    return {name: sum(int(float(rows[behind - 1][c])) - int(float(rows[start][c])) for c in of)
            for name, of in SUMS.items()} | named


def judge(report, box, table, done, world):
    """Each row of the table by the log of the box."""
    rows, named, changes = box.rows(), box.named(), box.changes()
    for (name, what, _, want, must), (tried, start, end, last) in zip(table, done):
        behind = min(last, len(rows))
        span = (start, end, behind)
        many = counts(rows, span, named)
        wrong = rig.above(rows[start:behind])
        wrong += [line for tick, line in changes if start <= tick <= behind]
        wrong += heard(world.heard, span, must)
        wrong += ["%s: %d of %d" % (c, many.get(c, 0), tried) for c, share in want.items()
                  if many.get(c, 0) < share * tried]
        if many["set"]:
            wrong.append("%d materials set" % many["set"])
        if any(r["state"] in ("0", "5") for r in rows[start:behind]):
            wrong.append("the box was off or in fault: not judged")
        report.row(name, what, tried, ", ".join("%s %d" % (c, many.get(c, 0)) for c in want), wrong)
    report.row("ceiling", "no more than %g N, %g A" % tuple(rig.CEILING.values()), len(rows),
               "at most %.3f N, %.3f A" % tuple(rig.most(rows, n) for n in rig.CEILING),
               rig.above(rows) + rig.untried(rows))


def on_link(report, options, folder, table, key=None, approaches=0, make=rig.linked):
    """One box, one world, and a table of attacks one after the other."""
    world = rig.World(key)
    box = make(options, folder, world, approaches)
    aim, done = link.Aim(world, min(options.flood, box.flood)), []
    try:
        world.start()
        rig.until(lambda: world.state in (2, 3), 30, "the box does not run: " + box.text())
        world.wait(0.5)
        world.mute = True  # a session, its end, another: what is recorded of the first is old
        world.wait(0.8)
        world.anew()
        world.mute = False
        world.wait(1.0)
        for row in table:
            start = world.tick
            tried = sum(row[2](aim) for _ in range(10 if options.long else 1))
            end = world.tick
            world.wait(WAIT_S)
            done.append((tried, start, end, world.tick))
    finally:
        status = box.end()
        world.ended = True
    if status not in box.ends_with:
        raise RuntimeError("the box ended with %d: %s" % (status, box.text()))
    judge(report, box, table, done, world)


PARTS = {
    "link": lambda *of: on_link(*of, link.OPEN),
    "key": lambda *of: on_link(*of, link.KEYED, os.urandom(16)),
    "bilateral": lambda report, options, folder: on_link(
        report, options, folder, link.APPROACHES, approaches=24 if options.long else 8),
    "image": lambda *of: on_link(*of, image.OPEN, make=image.Linked),
    "image-key": lambda *of: on_link(*of, image.KEYED, os.urandom(16), make=image.Linked),
    "image-com2": image.on_com2,
    "modbus": ports.attack, "files": files.attack, "listen": files.on_listen}


def part(report, options, folder, name):
    os.makedirs(folder, exist_ok=True)
    try:
        PARTS[name](report, options, folder)
    except Exception as error:  # whatever it is, the row says so and fails
        report.row(name, "could not be judged", 0, "", [repr(error)])


def attack(options, folder):
    report = Report()
    at_once = [threading.Thread(target=part, args=(report, options, folder, name))
               for name in options.only.split(",")]
    for thread in at_once:
        thread.start()
    for thread in at_once:
        thread.join()
    print("attacks: %d rows, %d failed" % (report.rows, report.failed))
    return 1 if report.failed else 0


def plant(options, folder):
    def parts(name, number):
        report = Report(quiet=True)
        part(report, options, os.path.join(folder, str(number)), name)
        return report.wrong
    return planted.run(parts, options.only.split(","))


def main():
    parser = argparse.ArgumentParser(description="Attack a box, and judge it by its log.")
    parser.add_argument("exhand")
    parser.add_argument("--long", action="store_true", help="each attack ten times")
    parser.add_argument("--flood", type=int, default=100000, help="datagrams of a flood (100000)")
    parser.add_argument("--only", default="link,key,bilateral,modbus,files,listen",
                        help="some of the parts, or image,image-key,image-com2 (%(default)s)")
    parser.add_argument("--images", default="build/pc104", help="where they are (%(default)s)")
    parser.add_argument("--planted", action="store_true",
                        help="each verdict must tell an error that is planted for it")
    parser.add_argument("--keep", help="leave logs in this folder")
    options = parser.parse_args()
    folder = options.keep or tempfile.mkdtemp(prefix="exhand-attacks-")
    try:
        return (plant if options.planted else attack)(options, folder)
    finally:
        if not options.keep:
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
