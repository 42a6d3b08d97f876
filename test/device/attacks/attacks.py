#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""attacks.py [options] EXHAND: a box whose link, ports and files somebody attacks.

A row an attack: what was tried how often, what the box counted, the verdict. By the box's own log:
- in no tick is a force or current above the person's ceiling, person_f and person_i;
- no parameter changes but by who may change it;
- the true peer stays heard where it must, else is heard again within a second of the attack's end;
- a monitor that reads every 0.4 s keeps its connection.
Exit status: 0 all hold, 1 an attack succeeds or a row could not be judged. Standard library only.
"""

import argparse
import os
import re
import shutil
import sys
import tempfile
import threading
import time

import files
import link
import ports
import rig

# Till the peer is heard when the attack is over: `quiet`, or that and the peer's next HELLO.
HEARD_S = {"stays": 0.5, "again": 1.0, "anew": 1.6}
GAP_S = 0.5                # longest hole of a peer that is heard
WAIT_S, ANEW_S = 1.4, 2.5  # what is looked at behind an attack
SUMS = {"late": ("duplicate", "reordered", "old", "stranger"), "bad": ("corrupt", "version",
        "unknown"), "accepted": ("accepted",), "set": ("set",), "refused": ("refused",)}


class Report:
    """A line a row."""

    def __init__(self):
        self.failed, self.rows, self.lock = 0, 0, threading.Lock()

    def row(self, name, what, tried, counted, wrong):
        with self.lock:
            self.rows += 1
            self.failed += bool(wrong)
            print("%-6s %-14s %-46s tried %-6s counted: %-30s %s" % (
                "FAILED" if wrong else "ok", name, what, tried, counted, "; ".join(wrong)),
                flush=True)


def until(what, seconds, said):
    end = time.monotonic() + seconds
    while not what():
        if time.monotonic() > end:
            raise RuntimeError(said)
        time.sleep(0.02)


def hole(ticks, first, last):
    """The longest time in which no question of the true peer was answered."""
    inside = [first] + [t for t in ticks if first < t < last] + [last]
    return max(b - a for a, b in zip(inside, inside[1:])) / rig.RATE_HZ


def heard(ticks, span, must):
    """What is wrong with how the true peer was heard."""
    start, end, behind = span
    settled = end + int(HEARD_S[must] * rig.RATE_HZ)
    wrong, worst = [], hole(ticks, settled, behind)
    if worst > GAP_S:
        wrong.append("%.1f s behind the end the peer is not heard for %.1f s" % (HEARD_S[must],
                     worst))
    if must == "stays" and hole(ticks, start, end) > GAP_S:
        wrong.append("the peer was not heard for %.1f s" % hole(ticks, start, end))
    return wrong


def counts(rows, span, text, keyed):
    """{name: how many}: of the window by the log, or of the whole run by what the box said."""
    start, _, behind = span
    many = {name: sum(int(float(rows[behind - 1][c])) - int(float(rows[start][c])) for c in of)
            for name, of in SUMS.items()}
    found = re.search(r"(\d+) packets of other senders", text)
    many["others"] = int(found[1]) if found else 0
    if keyed:
        for n, name in re.findall(r"(\d+) (without a key|of another key|not proved|again|damaged)",
                                  text):
            many[name] = int(n)
    return many


def judge(report, box, table, done, world):
    """Each row of the table by the log of the box."""
    rows, text, changes = box.rows(), box.text(), box.changes()
    most = max(float(r["f_des_n"]) for r in rows)
    for (name, what, _, want, must), (tried, start, end, last) in zip(table, done):
        behind = min(last, len(rows))
        span = (start, end, behind)
        many = counts(rows, span, text, world.key)
        force = rig.above(rows[start:behind])
        wrong = [force] if force else []
        wrong += [line for tick, line in changes if start <= tick <= behind]
        wrong += heard(world.heard, span, must)
        wrong += ["%s: %d of %d" % (c, many.get(c, 0), tried) for c, share in want.items()
                  if many.get(c, 0) < share * tried]
        if many["set"]:
            wrong.append("%d materials set" % many["set"])
        report.row(name, what, tried, ", ".join("%s %d" % (c, many.get(c, 0)) for c in want), wrong)
    wrong = [] if most > 0.8 * rig.PERSON_A * 3.339 else ["the finger felt nothing: not judged"]
    report.row("ceiling", "no more than %g N, %g A" % (rig.PERSON_N, rig.PERSON_A), len(rows),
               "at most %.3f N" % most, wrong + [w for w in [rig.above(rows)] if w])


def on_link(report, options, folder, table, key=None, approaches=0):
    """One box, one world, and a table of attacks one after the other."""
    world = rig.World(key)
    words = ([] if approaches else ["--scene", "bilateral"]) + ["--udp", world.at]
    name = "approaches" if approaches else "keyed" if key else "open"
    if key:
        path = os.path.join(folder, "key")
        with open(os.open(path, os.O_CREAT | os.O_WRONLY, 0o600), "w", encoding="ascii") as f:
            f.write(key.hex() + "\n")
        words += ["--key", path]
    box = rig.Box(options.exhand, folder, name, words, approaches)
    aim, done = link.Aim(world, options.flood), []
    try:
        world.start()
        until(lambda: world.state == 2, 30, "the box does not run: " + box.text())
        time.sleep(0.5)
        world.mute = True  # a session, its end, another: what is recorded of the first is old
        time.sleep(1.3)
        world.anew()
        world.mute = False
        time.sleep(WAIT_S)
        for row in table:
            start = world.tick
            tried = sum(row[2](aim) for _ in range(10 if options.long else 1))
            end = world.tick
            time.sleep(ANEW_S if row[4] == "anew" else WAIT_S)
            done.append((tried, start, end, world.tick))
    finally:
        status = box.end()
        world.ended = True
    if status not in ((0, 1) if approaches else (130,)):  # 1: an approach while nobody was heard
        raise RuntimeError("the box ended with %d: %s" % (status, box.text()))
    judge(report, box, table, done, world)


def main():
    parser = argparse.ArgumentParser(description="Attack a box, and judge it by its log.")
    parser.add_argument("exhand")
    parser.add_argument("--long", action="store_true", help="each attack ten times")
    parser.add_argument("--flood", type=int, default=100000, help="datagrams of a flood (100000)")
    parser.add_argument("--only", default="link,key,bilateral,modbus,files,listen",
                        help="some of these parts (link,key,bilateral,modbus,files,listen)")
    parser.add_argument("--keep", help="leave logs in this folder")
    options = parser.parse_args()
    folder, report = options.keep or tempfile.mkdtemp(prefix="exhand-attacks-"), Report()
    os.makedirs(folder, exist_ok=True)
    parts = {"link": lambda: on_link(report, options, folder, link.OPEN),
             "key": lambda: on_link(report, options, folder, link.KEYED, os.urandom(16)),
             "bilateral": lambda: on_link(report, options, folder, link.APPROACHES,
                                          approaches=(24 if options.long else 8)),
             "modbus": lambda: ports.attack(report, options, folder),
             "files": lambda: files.attack(report, options, folder),
             "listen": lambda: files.on_listen(report, options, folder)}

    def part(name):
        try:
            parts[name]()
        except Exception as error:  # whatever it is, the row says so and fails
            report.row(name, "could not be judged", 0, "", [repr(error)])

    try:
        at_once = [threading.Thread(target=part, args=(name,)) for name in options.only.split(",")]
        for thread in at_once:
            thread.start()
        for thread in at_once:
            thread.join()
    finally:
        if not options.keep:
            shutil.rmtree(folder, ignore_errors=True)
    print("attacks: %d rows, %d failed" % (report.rows, report.failed))
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
