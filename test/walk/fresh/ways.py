#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""ways.py DIR [--release NAME] [--only WORD,...] [--update]: each way of examples/link/README.md
on a bare Debian, or those with a WORD in their name.

DIR gets one bare root and then a copy for each way. All lines are typed as printed, also those that
install packages. `git clone` gives a clone of the last commit here. Prints a table, a row a way.
--update writes these rows into that file:

    commands  all of them, with the three before any way
    packages  of Debian and, behind a plus, of PyPI
    MB        downloaded: apt's lists, these packages, and the clone
    minutes   by the clock, and of them those that did not fetch or install
    seconds   of a core, user and system: they depend less on the machine's other load
    MB        added on the disk: also apt's lists and the archives that it keeps

The packages of PlatformIO's registry are put there in between (registry.py). They count in the last
two alone. Needs root. Exit status: 0 all programs printed what that file says, 1 not, 2 DIR is not
ours, 3 not root or no debootstrap. Standard library only.
"""

import argparse
import os
import re
import resource
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "link"))
sys.dont_write_bytecode = True
import link  # noqa: E402

ROOT_SH = os.path.join(HERE, "root.sh")
HEAD = ("way", "commands", "packages", "MB fetched", "minutes", "of them building", "s of a core",
        "MB on disk")
FETCHES = ("apt-get ", "git clone ", "python3 -m venv ", "pio/bin/pip ")
UNIT = {"B": 1e-6, "kB": 1e-3, "MB": 1, "GB": 1e3}
BEGIN, END = "<!-- make fresh-ways -->\n", "<!-- end -->\n"


def root(*args):
    done = subprocess.run([ROOT_SH, *args])
    if done.returncode:
        sys.exit(done.returncode)


def disk_MB(where):
    return int(subprocess.run(["du", "-sx", "-B1", where], check=True, stdout=subprocess.PIPE,
                              text=True).stdout.split()[0]) / 1e6


def core_s():
    """Of all that was waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def script(commands):
    """The lines, and when each of them began and the last one ended; a line that is not the way's
    has no number."""
    yield "mkdir /work && cd /work"
    for k, c in enumerate(commands):
        yield "echo @%d $(date +%%s.%%N)\n%s" % (k, c)
        yield from ("echo @- $(date +%s.%N)\n" + c for c in link.registry(c, "exhand"))
    yield "echo @end $(date +%s.%N)"


def times(said, commands):
    """Seconds of what fetches and of the rest."""
    marks = [(m.group(1), float(m.group(2)))
             for m in re.finditer(r"^@(\S+) ([0-9.]+)$", said, re.M)]
    spent = [0.0, 0.0]
    for (k, begin), (_, end) in zip(marks, marks[1:]):
        if k != "-":
            spent[not commands[int(k)].startswith(FETCHES)] += end - begin
    return spent


def fetched(said):
    """Packages of Debian, of PyPI, and MB."""
    lists = re.findall(r"^Fetched ([0-9.,]+) ([kMG]?B) in ", said, re.M)
    wheels = re.findall(r"^ *Downloading \S+ \(([0-9.,]+) ([kMG]?B)\)$", said, re.M)
    apt = sum(int(n) for n in re.findall(r"(\d+) newly installed", said))
    return apt, len(wheels), sum(float(n.replace(",", "")) * UNIT[u] for n, u in lists + wheels)


def take(name, commands, want, base, here):
    """A row of the table, and what went wrong or nothing."""
    root("copy", base, here)
    source = os.path.join(here, "exhand.git")
    subprocess.run(["git", "clone", "-q", "--bare", link.ROOT, source], check=True)
    before, source_MB = disk_MB(here), disk_MB(os.path.join(source, "objects"))
    began_s = core_s()
    done = subprocess.run([ROOT_SH, "run", here, "set -e\n" + "\n".join(script(commands))],
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace")
    ran_s = core_s() - began_s
    said = [line for line in done.stdout.splitlines() if not line.startswith("@")]
    warned = [line for line in said if re.search(r"\bwarning:", line)]
    good = done.returncode == 0 and said[-1:] == [want] and not warned
    apt, pypi, got_MB = fetched(done.stdout)
    fetch_s, build_s = times(done.stdout, commands)
    row = (name, "%d" % len(commands), "%d" % apt + (" + %d" % pypi if pypi else ""),
           "%.0f" % (got_MB + source_MB), "%.1f" % ((fetch_s + build_s) / 60),
           "%.1f" % (build_s / 60), "%.0f" % ran_s, "%.0f" % (disk_MB(here) - before))
    return row, "" if good else "\n".join(warned or said[-30:])


def line(row):
    return "| " + " | ".join(row) + " |"


def update(rows, names):
    """Puts the rows, by their names, into the table. Rows of other ways stay as they are."""
    with open(link.README) as f:
        head, rest = f.read().split(BEGIN)
    old, rest = rest.split(END, 1)
    top, old = old.splitlines()[:2], {text.split(" | ")[0][2:]: text
                                      for text in old.splitlines()[2:]}
    table = top + [rows.get(n, old.get(n)) for n in names if n in rows or n in old]
    with open(link.README, "w") as f:
        f.write(head + BEGIN + "\n".join(table) + "\n" + END + rest)


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("dir")
    p.add_argument("--release", default="bookworm")
    p.add_argument("--only", default="")
    p.add_argument("--update", action="store_true")
    a = p.parse_args()
    first, want, ways = link.ways()
    names = [name for name, _ in ways]
    for word in a.only.split(","):
        if not any(word in name for name in names):
            p.error("--only %s: no way has it in its name" % word)
    ways = [(name, [c.replace("...", "file:///exhand.git") for c in first] + commands)
            for name, commands in ways if any(word in name for word in a.only.split(","))]
    base, here = os.path.join(a.dir, a.release), os.path.join(a.dir, "way")
    os.makedirs(a.dir, exist_ok=True)
    root("make", a.release, base)
    print("\n".join([line(HEAD), line(["---"] + ["---:"] * (len(HEAD) - 1))]))
    table, failed = {}, 0
    for name, commands in ways:
        row, wrong = take(name, commands, want, base, here)
        failed += bool(wrong)
        table[name] = line(row)
        print(table[name] + ("  FAILED\n" + wrong if wrong else ""), flush=True)
    print("%d passed, %d failed" % (len(ways) - failed, failed))
    if a.update and not failed:
        update(table, names)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
