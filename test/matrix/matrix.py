#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The matrix: unit tests, laws and golden vectors on every target, by every compiler and option.

    matrix.py                     build and run all (make matrix), docs/MATRIX.md anew
    matrix.py --only WORD[,WORD]  all whose name has all parts of one of them: mips, clang,
                                  mips-gcc-O2, lto
    matrix.py --resume            without what build/matrix/matrix.tsv has
    matrix.py --ci                the part of it that CI runs at this commit
    matrix.py --list              names, and what is thinned
    matrix.py --tables TSV...     runs nothing: adds these tables to build/matrix/matrix.tsv,
                                  docs/MATRIX.md anew

A cell is a module at a rate on a target by a compiler with an option; each is compared with the
digest of the independent generator (test/golden). targets.tsv has the targets, README.md the rest.
Standard library only.
"""

import argparse
import collections
import concurrent.futures
import os
import re
import shutil
import subprocess
import sys
import time

sys.dont_write_bytecode = True
# noqa: E402
from table import (ROOT, clang_of, digests, document, expected, kept, put, section, stale, targets,
                   together, variants, without, words)

WHOLE = "gcc-O2"  # by this, every rate
EVERY = 20        # else every twentieth, from the variant's number on
CASES = 3000      # random cases of a law on the host; fewer on slower targets
# What CI runs of it, 32 and 64 bits big-endian, char unsigned, every optimisation: {name: (every,
# random cases)}. A commit has the first, and every third of the others.
CI = {"i686-gcc-O2": (4, 100000), "mips-gcc-O2": (100, 300), "s390x-clang-O3": (100, 300),
      "cortex_m0-gcc-Os": (100, 300), "avr-gcc-Os": (1000, 0), "x86_64-clang-O0": (100, 300),
      "x86_64-gcc-O3-lto": (100, 300)}
TRAPS = ("i686-gcc-O2",)  # in CI: what overflows in 32 bits and not in 64 traps
# In CI, so many consecutive commits have all of its rates and cases. make test-i686 has them all.
DEALT = {"i686-gcc-O2": 4}
TRAP = "-fsanitize=undefined -fsanitize-undefined-trap-on-error"

Job = collections.namedtuple("Job", "name target variant rates cases parts trap")
Row = collections.namedtuple("Row", "target variant rates golden cells tests groups seconds failed")


def commands(t, variant):
    """Variables for make: how this variant is compiled and linked for this target."""
    compiler, option = variant.split("-", 1)
    level, _, lto = option.partition("-")
    gcc = t["triple"] + "-gcc" if t["triple"] else "gcc"
    clang = "%s --target=%s" % clang_of(t) + (" -isystem /usr/%s/include" % t["triple"]
                                              if t["triple"] else "")
    return ["CC=" + (gcc if compiler == "gcc" else clang), "O=" + level[1:], "SUITE_LINK=" + gcc,
            "SUITE_METAL=" + t["metal"], "SUITE_WITHOUT=" + without(t, variant),
            "LDFLAGS=" + " ".join(["-static", t["flags"] if t["metal"] else "", t["link"]]),
            "CFLAGS=" + (t["flags"] + " -g0").strip(), "SUITE_LTO=" + (compiler if lto else "none")]


def run(command, env, log):
    """(exit status, what it said); all of it in log, too."""
    done = subprocess.run(command, cwd=ROOT, env=dict(os.environ, **env), stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace")
    log.write("$ %s\n%s" % (" ".join(command), done.stdout))
    log.flush()
    return done.returncode, done.stdout


def cells(said):
    """{module: (lo, hi, step, rates, crc)} of a golden run's lines."""
    found = {}
    for m, lo, hi, step, n, crc in re.findall(
            r"^  \| cells: (\w+) (\d+)\.\.(\d+):(\d+) (\d+) ([0-9a-f]{8})$", said, re.M):
        found[m] = (int(lo), int(hi), int(step), int(n), int(crc, 16))
    return found


def judge(said, status, rates, without):
    """Of a golden run: (digest, cells that agree, failures)."""
    want, got = expected(*rates, without), cells(said)
    n = len(range(rates[0], rates[1] + 1, rates[2]))
    wrong = [m for m in want if m not in got or got[m] != rates + (n, want[m])]
    agree = sum(got[m][3] for m in got if m not in wrong)
    unknown = [m for m in got if m not in want]
    failed = ["golden: " + " ".join(wrong + unknown)] if wrong or unknown else []
    if status != 0:
        failed.append("golden: exit %d" % status)
    return together({m: v[4] for m, v in got.items()}), agree, failed


def tests(said, status):
    """Of a run of the other tests: (tests passed, groups, failures)."""
    passed = sum(int(n) for n in re.findall(r"^(\d+) passed, \d+ failed$", said, re.M))
    end = re.search(r"^(\d+) groups passed, (\d+) failed$", said, re.M)
    failed = ([] if status == 0 and end
              else ["tests: exit %d" % status] + re.findall(r"^FAILED .*$", said, re.M))
    return passed, int(end.group(1)) if end else 0, failed


def build_of(job, a):
    return os.path.join(a.dir, job.name + ("-trap" if job.trap else ""))


def programs(t):
    """What is built for a target and run there: golden vectors, and tests."""
    return ["images"] if t["metal"] == "avr" else ["golden", "tests"]


def made(job, build, a, log):
    """Builds these; what went wrong."""
    make = [os.environ.get("MAKE", "make"), "--no-print-directory", "-s", "-j1", "B=" + build,
            "WERROR=1", "SUITE_CFLAGS=" + (TRAP if job.trap else "")
            ] + commands(job.target, job.variant)
    status, said = run(make +
                       [build + "/suite/" + p for p in programs(job.target)[:1 if a.golden else 2]],
                       {"MAKEFLAGS": ""}, log)
    if status != 0:
        print(said)
    return ["build: exit %d" % status] if status else []


def one(job, a):
    """Builds and runs a target's variant: its Row."""
    build, start = build_of(job, a), time.time()
    emulator = job.target["emulator"].split()
    os.makedirs(build, exist_ok=True)
    golden = agree = passed = groups = 0
    with open(os.path.join(build, "log.txt"), "w") as log:
        failed = made(job, build, a, log)
        if not failed:
            program = [build + "/suite/" + p for p in programs(job.target)]
            status, said = run(emulator + program[:1],
                               {"EXH_CELLS": "1", "EXH_RATES": "%d..%d:%d" % job.rates}, log)
            golden, agree, failed = judge(said, status, job.rates, without(job.target, job.variant))
            if program[1:] and not a.golden:
                status, said = run(emulator + program[1:], {
                    "EXH_CASES": str(job.cases), "EXH_PARTS": str(job.parts),
                    "EXH_PART": str(digests.commits() % job.parts)}, log)
                passed, groups, worse = tests(said, status)
                failed += worse
    if not a.keep and not failed:
        shutil.rmtree(os.path.join(build, "suite"))
    return Row(job.target["name"], job.variant, job.rates, golden, agree, passed, groups,
               time.time() - start, failed)


def there(t, variants=(WHOLE,)):
    """Are compilers and emulator for these variants of this target here, or can they be had?"""
    runs = {"": t["emulator"], "cortex_m": "qemu-system-arm",
            "avr": "avr-nm && test -f /usr/include/simavr/sim_avr.h"}[t["metal"]]
    programs = [t["triple"] + "-gcc" if t["triple"] else "gcc", runs]
    packages = t["packages"].split() + (["qemu-user"] if t["emulator"] and not t["metal"] else [])
    if any(v.startswith("clang") for v in variants):
        programs, packages = programs + [clang_of(t)[0]], packages + [clang_of(t)[0]]
    if any(v.startswith("clang") and v.endswith("lto") for v in variants):
        llvm = clang_of(t)[0].replace("clang", "llvm")
        programs, packages = programs + [llvm.replace("llvm", "llvm-link")], packages + [llvm]
    probe = " && ".join("command -v %s" % w for w in programs if w)
    return subprocess.run([os.path.join(ROOT, ".ci", "deps"), "the matrix: " + t["name"], probe] +
                          packages).returncode == 0


def asked_for(name, word):
    """All parts of the word are target, compiler or option of that name; lto is every option with
    it."""
    part = name.split("-", 2)
    return all(w in part or (w == "lto" and part[2].endswith("-lto"))
               for w in re.findall(r"O\w-lto|[^-]+", word))


def in_ci():
    """Names of what CI runs at this commit."""
    return list(CI)[:1] + list(CI)[1 + digests.commits() % 3::3]


def chosen(a):
    """[Job] of what is asked."""
    jobs, ci = [], in_ci() if a.ci else []
    for t in targets().values():  # each is one object: jobs of one target share it
        for k, v in variants(t):
            name = t["name"] + "-" + v
            if ((a.ci and name not in ci) or
                (a.only and not any(asked_for(name, w) for w in a.only.split(",")))):
                continue
            step, cases = CI[name] if a.ci else (int(t["every"] or (1 if v == WHOLE else EVERY)),
                                                 max(300, CASES // int(t["weight"])))
            step, cases = a.every or step, a.cases or cases
            parts = DEALT.get(name, 1) if a.ci else 1
            first = 1 + (k if parts == 1 else digests.commits()) % step
            jobs.append(Job(name, t, v, (first, 2000, step), cases, parts,
                            a.trap or (a.ci and name in TRAPS)))
    return jobs


def ran(jobs, a, table, path):
    """Runs them, as many at a time as there are cores, the longest first; (how many failed, cells
    that agree)."""
    bad = agree = 0
    order = sorted(jobs, key=lambda j: -int(j.target["weight"]) / j.rates[2])
    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS", "0")) or
                                               os.cpu_count()) as pool:
        for f in concurrent.futures.as_completed([pool.submit(one, j, a) for j in order]):
            r = f.result()
            bad += bool(r.failed)
            agree += r.cells
            table[r.target, r.variant] = words(r)
            put(path, table)
            print("%-24s %6d cells, digest %08x, %4d tests in %d groups, %4.0f s %s" % (
                r.target + "-" + r.variant, r.cells, r.golden, r.tests, r.groups, r.seconds,
                "; ".join(r.failed) or "ok"), flush=True)
    return bad, agree


def added(tables, path, table):
    """Tables of runs elsewhere, to this one."""
    for t in tables:
        table.update(kept(t))
    os.makedirs(os.path.dirname(path), exist_ok=True)
    put(path, table)
    section("make matrix", document(table))
    print("%d variants" % len(table))
    return 0


def done(job, a, w):
    """Does this row say what the job would, or more?"""
    return (w is not None and w[2] in ("%d..%d:%d" % job.rates, "1..2000:1") and not w[8] and
            (int(w[6]) > 0 or a.golden or job.target["metal"] == "avr"))


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--dir", default="build/matrix")
    p.add_argument("--only", default="")
    p.add_argument("--ci", action="store_true")
    p.add_argument("--list", action="store_true")
    p.add_argument("--tables", nargs="*", metavar="TSV")
    p.add_argument("--golden", action="store_true",
                   help="golden vectors alone, without the other tests")
    p.add_argument("--resume", action="store_true",
                   help="leave out what build/matrix/matrix.tsv has")
    p.add_argument("--trap", action="store_true", help="what overflows traps")
    p.add_argument("--cases", type=int, default=0, help="random cases of a law")
    p.add_argument("--every", type=int, default=0, metavar="N", help="every Nth rate alone")
    p.add_argument("--keep", action="store_true", help="leave what was built")
    a = p.parse_args()
    path = os.path.join(a.dir, "ci.tsv" if a.ci or a.trap else "matrix.tsv")
    table = {} if a.ci or a.trap else kept(path)
    if a.tables is not None:
        return added(a.tables, path, table)
    jobs = chosen(a)
    if not jobs:
        p.error("nothing is called " + a.only)
    if a.list:
        for j in jobs:
            print("%s: %d..%d:%d Hz, %d cases%s" %
                  ((j.name,) + j.rates + (j.cases, ", traps" if j.trap else "")))
        return 0
    if not all([there(t, [j.variant for j in jobs if j.target is t])
                for t in {id(j.target): j.target for j in jobs}.values()]):
        return 3
    os.makedirs(a.dir, exist_ok=True)
    if a.resume:
        jobs = [j for j in jobs if not done(j, a, table.get((j.target["name"], j.variant)))]
    bad, agree = ran(jobs, a, table, path)
    print("%d cells agree" % agree)
    if not (a.ci or a.trap):
        section("make matrix", document(table))
    old, rows = stale()
    print("docs/MATRIX.md: %d rows, %d of other bits%s" %
          (rows, len(old), ": make matrix makes them anew: " + " ".join(old[:3]) if old else ""))
    print("%d passed, %d failed" % (len(jobs) - bad, bad))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
