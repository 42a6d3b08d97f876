#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plants small errors all over lib/src, one at a time, and runs the tests of that source, which
should detect them.

    mutation.py [--build DIR] [--jobs N] [--sample N | --all] [--seed S] [--limit SECONDS]
                [--report] [--list] [SOURCE...]

A mutant (mutate.py) is compiled with -O2. It is left out if it does not compile, or if its object
equals the original's or another mutant's bit for bit. The others are preloaded into the tests of
their source (tests.txt), which stop at the first that fails: killed. A survivor runs once more with
undefined behaviour trapped, as `make test` has sanitizers.

survivors.tsv lists the survivors with their reasons. Exit status 1: a survivor is not in it, a
mutant in it is killed or its lines no longer exist. Also if less than 95 of 100 mutants of a source
are killed, not counting those with a reason.

--sample N (100): so many of each source, as the seed (1) chooses them. --all: all.
--limit SECONDS: begin no mutant after that. Results are kept, and are not run again while their
source stays unchanged.
--report: the table of all that ran so far, and nothing else. --list: the survivors without reason.
"""

import argparse
import collections
import glob
import hashlib
import json
import os
import random
import re
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

import mutate

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", "..", ".."))
LEAST = 0.95
CC = os.environ.get("CC", "cc").split()
FLAGS = "-std=c99 -w -fPIC -DEXH_FIX_AUDIT -Ilib/include".split()
TRAP = "-fsanitize=undefined,bounds-strict -fsanitize-undefined-trap-on-error".split()
RATES = {"EXH_RATES": "91..1900:603", "EXH_EXPLAIN": "0",
         "EXH_DIGESTS": os.environ.get("EXH_DIGESTS", "build/golden/rates.txt")}
CASES = "1000"
# of a core, of one test, which takes a tenth of a second otherwise: an endless loop, however busy
# the machine
SLOW_S = 5
STUCK_S = 300  # by the clock: waits
KILLED, SURVIVED = ("killed", "survived")


def read_tests():
    """The tests of each source in their order. A source without a line has the tests of its
    name."""
    of = {}
    with open(os.path.join(HERE, "tests.txt"), encoding="utf-8") as f:
        for line in f:
            line = line.split("#")[0].strip()
            if line:
                name, _, tests = line.partition(":")
                of[name.strip()] = tests.split()
    return of


def read_survivors():
    """{source: {(function, now, new): reason}}"""
    of, reason = collections.defaultdict(dict), None
    with open(os.path.join(HERE, "survivors.tsv"), encoding="utf-8") as f:
        for line in f:
            if not line.startswith("#"):
                source, function, now, new, said = line.rstrip("\n").split("\t")
                reason = reason if said == '"' else said
                of[source][function, now, new] = reason
    return of


def ends_well(exe, env, so=""):
    """Whether the test passes, with that object before all others."""
    try:
        p = subprocess.run(["sh", "-c", f'ulimit -t {SLOW_S}; export LD_PRELOAD="$1"; exec "$0"',
                            exe, so], cwd=ROOT, env=env, stdin=subprocess.DEVNULL,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=STUCK_S)
    except subprocess.TimeoutExpired:
        return False
    return p.returncode == 0


class Tests:
    """Runs the tests of a source with a mutant preloaded."""

    def __init__(self, build):
        self.build, self.of = os.path.abspath(build), read_tests()

    def run(self, test, so):
        """Whether it passes; nothing at all counts as that."""
        kind, _, name = test.partition("/")
        if kind == "with":
            return self.run_with(name, os.path.dirname(so))
        env = {k: v for k, v in os.environ.items() if not k.startswith("EXH_")}
        env.update(EXH_SEED="1", EXH_CASES=CASES)
        exe = os.path.join(self.build, kind, ("golden" if kind == "golden" else name) + "_test")
        if kind == "golden":
            env.update(RATES, EXH_TEST=name)
        return ends_well(exe, env, so)

    def run_with(self, name, where):
        """A test that has the source in itself: made of it anew."""
        own, exe = "test/module/unit/%s_test.c" % name, os.path.join(where, "own")
        with open(os.path.join(ROOT, own),
                  encoding="utf-8") as f, open(exe + ".c", "w", encoding="utf-8") as to:
            to.write(re.sub(r'"[./]*lib/src/\w+/(\w+\.c)"', r'"\1"', f.read()))
        p = subprocess.run(CC + FLAGS + ["-Itest", "-I" + where, exe + ".c", self.build +
                                         "/obj/test/support.o", "-L" + self.build, "-lexhand",
                                         "-lcmocka", "-Wl,-rpath," + self.build, "-o", exe],
                           cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if p.returncode:
            sys.exit("%s: does not build with a mutant" % own)
        return ends_well(exe, None)

    def killer(self, source, so):
        return next((t for t in self.of[os.path.basename(source)[:-2]] if not self.run(t, so)),
                    None)


class Planted:
    """One source: its mutants in the order the seed deals them, and what became of each."""

    def __init__(self, source, build, seed, tests):
        self.source, self.tests, self.build = source, tests, build
        with open(os.path.join(ROOT, source), encoding="utf-8") as f:
            self.c = mutate.Source(source, f.read())
        self.mutants = mutate.mutants(self.c.text)
        self.dealt = list(self.mutants)
        random.Random(f"{seed} {source}").shuffle(self.dealt)
        text = hashlib.sha256(self.c.text.encode()).hexdigest()[:16]
        self.path = os.path.join(build, "state", os.path.basename(source)[:-2] + ".json")
        self.state = {}
        if os.path.exists(self.path):
            with open(self.path, encoding="utf-8") as f:
                kept = json.load(f)
            if kept["text"] == text:
                self.state = kept["mutants"]
        self.kept, self.objects = text, {s["object"] for s in self.state.values() if "object" in s}
        self.original = None

    def save(self):
        os.makedirs(os.path.dirname(self.path), exist_ok=True)
        with open(self.path + ".new", "w", encoding="utf-8") as f:
            json.dump({"text": self.kept, "mutants": self.state}, f, indent=0)
        os.replace(self.path + ".new", self.path)

    def compile(self, where, text, *more):
        """The object of that text in place of the source, which it has the name of."""
        c, o = os.path.join(where, os.path.basename(self.source)), os.path.join(where, "m.o")
        with open(c, "w", encoding="utf-8") as f:
            f.write(text)
        flags = [f if not f.startswith("-I") else "-I" + os.path.join(ROOT, f[2:]) for f in FLAGS]
        flags.append("-I" + os.path.join(ROOT, os.path.dirname(self.source)))
        p = subprocess.run(CC + flags + list(more or ("-O2",)) +
                           ["-c", os.path.basename(c), "-o", "m.o"], cwd=where,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return o if p.returncode == 0 else None

    def load(self, o):
        so = o[:-2] + ".so"
        subprocess.run(CC + ["-shared", "-o", so, o], check=True)
        return so

    def digest(self, o):
        with open(o, "rb") as f:
            return hashlib.sha256(f.read()).hexdigest()[:16]

    def plant(self, m):
        """{what, by, object}: the result for this mutant."""
        with tempfile.TemporaryDirectory(dir=self.build) as where:
            o = self.compile(where, self.c.changed(m))
            if o is None:
                return {"what": "no C"}
            digest = self.digest(o)
            if digest == self.original:
                return {"what": "same object"}
            if digest in self.objects:
                return {"what": "same as another"}
            self.objects.add(digest)
            by = self.tests.killer(self.source, self.load(o))
            if by is None:
                o = self.compile(where, self.c.changed(m), "-O1", *TRAP)
                by = self.tests.killer(self.source, self.load(o))
                by = by and by + " (trap)"
            return {"what": KILLED if by else SURVIVED, "by": by, "object": digest}

    def begin(self):
        """The unchanged source must pass."""
        with tempfile.TemporaryDirectory(dir=self.build) as where:
            o = self.compile(where, self.c.text)
            self.original = self.digest(o)
            start = time.time()
            by = self.tests.killer(self.source, self.load(o))
            took = time.time() - start
            by = by or self.tests.killer(self.source,
                                         self.load(self.compile(where, self.c.text, "-O1", *TRAP)))
        if by:
            sys.exit(f"{self.source}, unchanged: {by} fails")
        return took

    def run(self, n, jobs, until):
        took = self.begin()
        # tests may have come since
        again = [m for m in self.mutants if self.state.get(key(m), {}).get("what") == SURVIVED]
        for m in again:
            self.objects.discard(self.state[key(m)]["object"])
        fresh = [m for m in self.dealt if key(m) not in self.state]
        with ThreadPoolExecutor(jobs) as pool:
            while (again or fresh and len(self.ran()) < n) and time.time() < until:
                some, again = (again, []) if again else (fresh[:4 * jobs], [])
                fresh = [m for m in fresh if m not in some]
                for m, got in zip(some, pool.map(self.plant, some)):
                    self.state[key(m)] = got
        self.save()
        return took

    def ran(self):
        return [m for m in self.mutants
                if self.state.get(key(m), {}).get("what") in (KILLED, SURVIVED)]


def key(m):
    return f"{m.at} {m.end} {m.new}"


class Account:
    """Of one source: the survivors, and the reasons that are no longer needed."""

    def __init__(self, planted, reasons):
        ran = planted.ran()
        of = {m: planted.state[key(m)] for m in ran}
        shown = {m: planted.c.shown(m) for m in ran}
        lived = [m for m in ran if of[m]["what"] == SURVIVED]
        self.planted, self.ran, self.killed = planted, len(ran), len(ran) - len(lived)
        self.open = [shown[m] for m in lived if shown[m] not in reasons]
        self.explained = len(lived) - len(self.open)
        self.by = collections.Counter(re.sub(r"/\S*", "", s["by"])
                                      for s in of.values() if s.get("by"))
        may = {planted.c.shown(m) for m in planted.mutants}
        dead = {shown[m] for m in ran} - {shown[m] for m in lived}
        self.stale = ([("killed", r) for r in reasons if r in dead] +
                      [("no more", r) for r in reasons if r not in may])

    def score(self):
        judged = self.killed + len(self.open)
        return self.killed / judged if judged else 1.0


def show(source, item, reason=""):
    """As its row in survivors.tsv."""
    return "\t".join((source, *item[:3], reason))


def report(accounts):
    """Markdown: what ran of each source, and which tests killed it."""
    print("| source | mutants | ran | killed | by unit, golden, prop, trap | survive for a reason "
          "| survive | score |")
    print("|---|---|---|---|---|---|---|---|")
    total = [0] * 5
    for a in accounts:
        by = [a.by["unit"], a.by["golden"], a.by["prop"],
              sum(v for k, v in a.by.items() if "trap" in k)]
        row = [len(a.planted.mutants), a.ran, a.killed, a.explained, len(a.open)]
        total = [t + r for t, r in zip(total, row)]
        score = "%.1f %%" % (100 * a.score()) if a.ran else "-"
        print("| `%s` | %d | %d | %d | %s | %d | %d | %s |" %
              (os.path.basename(a.planted.source)[:-2], *row[:3], ", ".join(map(str, by)), *row[3:],
               score))
    print("| all | %d | %d | %d | | %d | %d | %.1f %% |" %
          (*total, 100 * total[2] / max(1, total[2] + total[4])))


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--build", default="build/mutation")
    p.add_argument("--jobs", type=int, default=os.cpu_count())
    p.add_argument("--sample", type=int, default=100, metavar="N")
    p.add_argument("--all", action="store_true")
    p.add_argument("--seed", type=int, default=1, metavar="S")
    p.add_argument("--limit", type=float, default=1e9, metavar="SECONDS")
    p.add_argument("--report", action="store_true")
    p.add_argument("--list", action="store_true")
    p.add_argument("source", nargs="*")
    a = p.parse_args()
    tests, reasons, until = Tests(a.build), read_survivors(), time.time() + a.limit
    sources = [os.path.relpath(s, ROOT) for s in sorted(glob.glob(ROOT + "/lib/src/*/*.c"))]
    # which images have, not the library
    sources = [s for s in sources if not s.startswith("lib/src/run/")]
    wanted = [s for s in sources if not a.source or os.path.basename(s)[:-2] in a.source]
    missing = [s for s in sources if os.path.basename(s)[:-2] not in tests.of]
    if missing or not wanted:
        sys.exit("tests.txt has no line of " + " ".join(missing) if missing else "no such source")
    accounts, bad = [], 0
    for s in wanted:
        planted = Planted(s, os.path.abspath(a.build), a.seed, tests)
        took = None if a.report or a.list else planted.run(10**9 if a.all else a.sample, a.jobs,
                                                           until)
        account = Account(planted, reasons.get(s, {}))
        accounts.append(account)
        low = account.score() < LEAST and account.ran > 0
        bad += low or len(account.open) + len(account.stale) > 0
        if a.report:
            continue
        if took is not None:
            print("%s %-14s %3d of %3d ran, %3d killed, %d survive for a reason, %d without: %.1f "
                  "%%; tests %.1f s" %
                  ("! " if low else "  ", os.path.basename(s)[:-2], account.ran,
                   len(planted.mutants), account.killed, account.explained, len(account.open),
                   100 * account.score(), took), flush=True)
        for item in account.open:
            print(show(s, item))
        for why, item in account.stale:
            print("survivors.tsv, %s: %s" % (why, show(s, item)))
    if a.report:
        report(accounts)
        return 0
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
