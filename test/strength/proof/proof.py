#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Proves the tick path, unit by unit (README.md).

A unit is a file eva/any_UNIT.c, whose first comment has these lines:

    PROVES: what it is about, a few words            (then what is shown, for docs/PROOFS.md)
    WP: what WP shows of it                          (may be missing)
    EVA: more options for Eva                        (may be missing)
    WITH: more files, that it cannot include         (may be missing)
    PLANT: file: text -> what it becomes             (an error that Eva must detect; any number)

A unit of every/ is a program with the same comment that tries every argument, built to stop at
undefined behaviour. It returns 0 if its claim holds for all.

With eva/UNIT.acsl, annotations are put into the copy of the source for Eva, in the form of the
files of wp/. Units that WP judges, too, are listed in tools.py.

  proof.py [--root DIR] [--out DIR] [--only UNIT,...] [--no-mutants] [--update [--shrink]]
           [--jobs N] [--fresh]

  proof.py --table      writes the tables of docs/PROOFS.md, from counts.txt and the units

  proof.py --ci         for CI: the record must be complete and of these sources. Cheap units are
                        proved again

Exit status 0: every unit proves as many as counts.txt has, and every planted error is detected. 1:
not. 3: a tool is missing. An unchanged text is not proved again, except with --fresh.
"""
import argparse
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed

sys.dont_write_bytecode = True

import record  # noqa: E402
import table  # noqa: E402
import tools  # noqa: E402

HERE = tools.HERE


class Job:
    def __init__(self, row, about, tool, expected_s, f, *args, planted=None):
        self.row, self.about, self.tool, self.planted = row, about, tool, planted
        self.expected_s, self.f, self.args = expected_s, f, args


TOOL = {"eva64": "Eva, 64-bit", "eva32": "Eva, 32-bit", "every": "every value", "wp": "WP",
        "smt": "z3"}


def jobs(p, only, was, mutants):
    """All that is to be run: proofs, and planted errors."""
    def expected(row):
        return was[row].s if row in was else 10.0

    found = []
    for u in tools.units(only):
        for row in u.rows():
            tool = row.split(".")[1]
            found.append(Job(row, u.about, tool, expected(row), p.prove, tool, u, row))
        for k, plan in enumerate(u.plants if mutants else ()):
            tool = "every" if u.every else "eva64"
            found.append(Job(u.name, u.about, tool, expected("%s.%s" % (u.name, tool)), p.prove,
                             tool, u, "planted.%s%d" % (u.name, k), plan, planted=plan))
    for k, (name, function, *plan) in enumerate(tools.WP_PLANTS if mutants else ()):
        if not only or name in only:
            unit = tools.units([name])[0]
            found.append(Job(name, unit.about, "wp", 20.0, p.prove, "wp", unit, "planted.wp%d" % k,
                             plan, function, planted=plan))
    if not only or "smt" in only:
        found += [Job("smt." + n, n, "smt", expected("smt." + n), p.lemma, n)
                  for n in record.lemmas()]
    return found


def run_all(todo, parallel):
    """Runs the longest first. Returns row -> result of the proofs, the number of planted errors
    that were not detected, and seconds of a core."""
    got, untold, total_s = {}, [], 0.0
    print("%-44s %-12s %8s %6s %6s" % ("unit", "tool", "proved", "of", "s"))
    pool = ThreadPoolExecutor(parallel)
    try:
        started = {pool.submit(j.f, *j.args): j for j in sorted(todo, key=lambda j: -j.expected_s)}
        for done in as_completed(started):
            j, r = started[done], done.result()
            total_s += r["s"]
            if j.planted:
                told = r["ran"] and r["proved"] < r["of"]
                print("  %-8s %-10s %s, %.1f s: %s: %s -> %s" %
                      (("told" if told else "NOT TOLD", j.row, TOOL[j.tool], r["s"]) +
                       tuple(j.planted)))
                untold += [] if told else [j]
            else:
                got[j.row] = r
                name = j.row.split(".", 1)[int(j.tool == "smt")]
                print("%-44s %-12s %8d %6d %6.1f%s" %
                      (name if j.tool == "smt" else "%s: %s" % (name.split(".")[0], j.about),
                       TOOL[j.tool], r["proved"], r["of"], r["s"],
                       "" if r["proved"] == r["of"] else "  OPEN: build/proof/%s.txt" % j.row))
                for n in r.get("names", ()):
                    print("         not proved: " + n)
            sys.stdout.flush()
    finally:
        pool.shutdown(cancel_futures=True)
    return got, untold, total_s


def held(got, was):
    """Against the committed counts: none may be less, nor may more stay open. What is wrong."""
    rows = sorted(k for k in got if k in was)
    less = ["%s: %d of %d, was %d of %d" %
            (k, got[k]["proved"], got[k]["of"], was[k].proved, was[k].of) for k in rows
            if got[k]["proved"] < was[k].proved or
            got[k]["of"] - got[k]["proved"] > was[k].of - was[k].proved]
    return less


def update(got, was, shrink, everything):
    """Writes the record. A count shrinks only with --shrink."""
    for k, r in got.items():
        old = was.get(k)
        if old and r["proved"] < old.proved and not shrink:
            print("counts: %s: %d, was %d: not written (--shrink)" % (k, r["proved"], old.proved))
            continue
        was[k] = record.Row(r["proved"], r["of"], r["s"], r["key"],
                            record.sealed(r["key"], r["proved"], r["of"]))
    if everything:
        was = {k: r for k, r in was.items() if k in record.rows_wanted()}
    record.write_counts(was)
    found, texts = record.reached(), record.sources()
    names = {u.name: u for u in tools.units()}
    for k, r in got.items():
        if r.get("reached") and k.endswith(".eva64"):
            record.note_reached(found, names[k.split(".")[0]], r["reached"], texts)
    found = {u: f for u, f in found.items() if u in names}
    record.write_reached(found)
    record.drop_reasons(record.covered(found, texts))
    return was


def arguments():
    a = argparse.ArgumentParser(description="Proves the tick path, unit by unit.")
    a.add_argument("--root", default=os.path.dirname(os.path.dirname(os.path.dirname(HERE))))
    a.add_argument("--out", default="build/proof")
    a.add_argument("--only", help="these units alone, with commas between")
    a.add_argument("--jobs", type=int, default=os.cpu_count(), help="provers at a time")
    a.add_argument("--no-mutants", action="store_true", help="no planted errors")
    a.add_argument("--update", action="store_true", help="write counts.txt and reached.txt anew")
    a.add_argument("--shrink", action="store_true", help="with --update: also where less is proved")
    a.add_argument("--fresh", action="store_true",
                   help="prove again what was proved of the same text")
    a.add_argument("--table", action="store_true", help="write the tables of docs/PROOFS.md")
    a.add_argument("--ci", action="store_true", help="the record, and what is cheap")
    return a.parse_args()


def main():
    a = arguments()
    if a.table:
        return table.write()
    p = tools.Proof(os.path.abspath(a.root), os.path.abspath(a.out), a.fresh)
    if a.ci:
        import ci
        return ci.check(p, a.jobs)
    if tools.missing():
        return 3
    p.detect()
    t, was = time.time(), record.counts()
    only = a.only.split(",") if a.only else []
    got, untold, core_s = run_all(jobs(p, only, was, not a.no_mutants), a.jobs)
    wrong = held(got, was)
    if a.update:
        was = update(got, was, a.shrink, not only)
    wrong += ["%s: not in counts.txt" % k for k in sorted(got) if k not in was]
    wrong += [] if only else record.unexplained(record.covered(record.reached(), record.sources()),
                                                record.not_proved())
    for line in wrong:
        print("counts: " + line)
    print("%d proved, %d not; %d planted errors not told; took %.0f s, provers %.0f s of a core "
          "(as measured when they ran)" %
          (sum(r["proved"] for r in got.values()), sum(r["of"] - r["proved"] for r in got.values()),
           len(untold), time.time() - t, core_s))
    return 0 if not wrong and not untold else 1


if __name__ == "__main__":
    sys.exit(main())
