#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the tests that `make mcdc-built` made, and says of lib/ and ports/cards which conditions
they leave undecided.

A condition of a decision of several (a && b) is covered by two runs of the decision: its value and
the decision's differ, and no other evaluated condition does. This is MC/DC, unique cause with short
circuits, as clang counts it. A decision of one condition is covered when it was true and false. A
case is covered when it was taken, a function when it was called.

Each that is not covered must be in missing.txt with its reason. A row that is covered, or that no
longer exists, must go. Exit status 1: either of these, or a failing test. With --strict, a reason
"to do" too.

    mcdc.py [--build DIR] [--jobs N] [--update] [--strict] [--only FILE] [--tests TEXT]

--update: missing.txt anew; reasons are kept, new ones get "to do"
--tests:  only binaries whose path has TEXT in it, for the coverage of one test. Nothing is compared
"""

import argparse
import collections
import glob
import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", "..", ".."))
MISSING = os.path.join(HERE, "missing.txt")
PLACES = ("lib/", "ports/cards/")
RATES = "1..20"
CASES = {"": 2000, "prop/safety_test": 100000}  # fewer never get into every state
TODO = "to do"
EXPANSION, DECISION = 1, 6  # clang's numbers of a macro's use, and of a condition of several

Item = collections.namedtuple("Item", "file function text what")


def run_tests(build, jobs, text):
    """Every binary once; the counters go to prof/, one file a shared object or binary. The names of
    those that failed."""
    prof = os.path.join(build, "prof")
    os.makedirs(prof, exist_ok=True)
    for f in glob.glob(prof + "/*"):
        os.remove(f)
    build = os.path.abspath(build)
    binary = sorted(glob.glob(build + "/*/*_test")) + [build + "/fuzz/wire"]
    binary = [b for b in binary if text in b]

    def run(b):
        name = os.path.relpath(b, build)
        env = dict(os.environ, LLVM_PROFILE_FILE=prof + "/%m.profraw", EXH_RATES=RATES,
                   EXH_SEED="1", EXH_CASES=str(CASES.get(name, CASES[""])))
        for v in ("EXH_TEST", "EXH_CASE", "EXH_PART", "EXH_PARTS"):
            env.pop(v, None)
        arg = sorted(glob.glob(ROOT + "/test/fuzz/corpus/*")) if name.startswith("fuzz/") else []
        p = subprocess.run([b] + arg, cwd=ROOT, env=env, stdout=subprocess.PIPE,
                           stderr=subprocess.STDOUT, text=True)
        return (name, p.returncode, p.stdout)

    with ThreadPoolExecutor(jobs) as pool:
        done = list(pool.map(run, binary))
    for name, status, said in done:
        if status:
            print(f"{name}: exit {status}\n{said[-2000:]}", file=sys.stderr)
    return binary, [name for name, status, _ in done if status]


def export(build, binary):
    """What clang says of each function of ours, in each object that has it."""
    data = build + "/all.profdata"
    subprocess.run(["llvm-profdata-19", "merge", "-o", data] + glob.glob(build + "/prof/*.profraw"),
                   check=True)
    objects = ([build + "/libexhand.so", build + "/libcards.so"] +
               [b for b in binary if "/golden/" not in b])
    args = ["llvm-cov-19", "export", "-format=text", "-instr-profile=" + data, objects[0]]
    for o in objects[1:]:
        args += ["-object", o]
    p = subprocess.run(args + [os.path.join(ROOT, d) for d in PLACES], stdout=subprocess.PIPE,
                       stderr=subprocess.PIPE, text=True)
    if p.returncode:
        sys.exit(p.stderr)
    return json.loads(p.stdout)["data"][0]["functions"]


class Source:
    """Lines of files, and the functions in them."""

    def __init__(self):
        self.line_of = {}

    def lines(self, path):
        if path not in self.line_of:
            with open(path, encoding="utf-8") as f:
                self.line_of[path] = f.read().split("\n")
        return self.line_of[path]

    def text(self, path, l0, c0, l1, c1):
        line = self.lines(path)[l0 - 1:l1]
        line[-1] = line[-1][:c1 - 1]
        line[0] = line[0][c0 - 1:]
        return re.sub(r"\s+", " ", " ".join(line)).strip()

    def use(self, path, line, col):
        """A macro's use, with its arguments."""
        rest = "\n".join(self.lines(path)[line - 1:line + 20])[col - 1:]
        m, depth = re.match(r"\w+", rest), 0
        end = m.end()
        if rest[end:end + 1] == "(":
            for end in range(end, len(rest)):
                depth += {"(": 1, ")": -1}.get(rest[end], 0)
                if depth == 0:
                    break
            end += 1
        return re.sub(r"\s+", " ", rest[:end])


def inside(path):
    rel = os.path.relpath(path, ROOT)
    return rel if rel.startswith(PLACES) else None


class Condition:
    def __init__(self):
        self.true = self.false = 0
        self.several = self.alone = False

    def lacks(self, text):
        """What is missing, "" if nothing is."""
        if not self.true:
            return "never gone to" if re.match(r"(case|default)\b", text) else "never true"
        if not self.false:
            return "" if re.match(r"(case|default)\b", text) else "never false"
        return "never decides alone" if self.several and not self.alone else ""


def add_function(f, condition, called, name_of, source):
    """Adds what this copy of a function has seen. A test that includes a source may name it
    otherwise: the library's name counts."""
    files, use = f["filenames"], {}
    for l0, c0, _, _, _, fid, sub, kind in f["regions"]:
        if kind == EXPANSION:
            use[sub] = (fid, l0, c0)
    home = next(r for r in f["regions"] if r[5] not in use)
    path = inside(files[home[5]])
    if path is None:
        return
    name = name_of.setdefault((path, *home[:2]), f["name"].split(":")[-1])
    called[(path, name, *home[:2])] += f["count"]

    of_branch, nth = [], collections.Counter()
    for l0, c0, l1, c1, true, false, fid, _, kind in f["branches"]:
        text, at = source.text(files[fid], l0, c0, l1, c1), (fid, l0, c0)
        if re.fullmatch(r".*\bU?INT64_C", text):  # a macro ends it
            text += re.match(r"\([^)]*\)",
                             "".join(source.lines(files[fid])[l1 - 1][c1 - 1:])).group()
        while at[0] in use:  # of a macro: where it is used
            at = use[at[0]]
            text = source.use(files[at[0]], *at[1:])
        nth[at] += 1
        if nth[at] > 1:
            text += f" ({nth[at]})"
        c = condition[(path, name, *at[1:], text)]
        c.true, c.false, c.several = c.true + true, c.false + false, c.several or kind == DECISION
        of_branch.append(c)

    again = collections.Counter()
    for l0, c0, l1, c1, _, _, alone in f["mcdc_records"]:
        mine = collections.defaultdict(list)  # by use of the macro that contains it
        for b, c in zip(f["branches"], of_branch):
            if b[8] == DECISION and (l0, c0) <= (b[0], b[1]) and (b[2], b[3]) <= (l1, c1):
                mine[b[6]].append(c)
        conditions = list(mine.values())[again[(l0, c0)]]
        again[(l0, c0)] += 1
        if len(conditions) != len(alone):
            sys.exit(f"{path}:{l0}: {len(conditions)} conditions, clang counts {len(alone)}")
        for c, yes in zip(conditions, alone):
            c.alone |= yes


def gaps(functions, source):
    """What is missing, and of each file what there is: (conditions of several, of them covered;
    others, covered)."""
    condition, called, name_of = collections.defaultdict(Condition), collections.Counter(), {}
    for f in functions:
        add_function(f, condition, called, name_of, source)
    missing, have, seen = [], collections.defaultdict(lambda: [0, 0, 0, 0]), collections.Counter()

    def add(path, name, line, text, what):
        seen[(path, name, text, what)] += 1
        n = seen[(path, name, text, what)]
        missing.append((Item(path, name, text + (f" [{n}]" if n > 1 else ""), what), line))

    for (path, name, line, _), n in sorted(called.items()):
        if not n:
            add(path, name, line, name + "()", "never called")
    for (path, name, line, _, text), c in sorted(condition.items()):
        what = c.lacks(text)
        have[path][0 if c.several else 2] += 1
        have[path][1 if c.several else 3] += not what
        if what:
            add(path, name, line, text, what)
    return missing, have


# --- missing.txt: a line each, and its item ---


def read_missing():
    """{Item: reason}. A reason goes for the lines above it that have none: FILE | FUNCTION |
    CONDITION | WHAT, then "  REASON"."""
    reason, block = {}, []
    if not os.path.exists(MISSING):
        return reason
    with open(MISSING, encoding="utf-8") as f:
        for line in f.read().split("\n"):
            if line.startswith("  "):
                for item in block:
                    reason[item] = (reason[item] + " " + line.strip()).strip()
            elif line and not line.startswith("#"):
                if block and reason[block[-1]]:
                    block = []
                part = line.split(" | ")
                item = Item(part[0], part[1], " | ".join(part[2:-1]), part[-1])
                reason[item] = ""
                block.append(item)
    return reason


HEAD = """# What the tests of `make mcdc` leave undecided, and why. FILE | FUNCTION | CONDITION |
# WHAT, then, two blanks before it, the reason: of that line and those above it that have none. A
# new one fails, one that is covered or is no more fails.
"""


def write_missing(missing, reason):
    with open(MISSING, "w", encoding="utf-8") as f:
        f.write(HEAD)
        for i, (item, _) in enumerate(missing):
            why = reason.get(item) or TODO
            f.write(("\n" if i == 0 or item.file != missing[i - 1][0].file else "") +
                    " | ".join(item) + "\n")
            last = (i + 1 == len(missing) or missing[i + 1][0].file != item.file or
                    (reason.get(missing[i + 1][0]) or TODO) != why)
            if last:
                words, line = why.split(), " "
                for w in words:
                    if len(line) + len(w) > 125:
                        f.write(line + "\n")
                        line = " "
                    line += " " + w
                f.write(line + "\n")


def compare(missing, reason):
    bad = 0
    for item, line in missing:
        if not reason.get(item):
            print(f"{item.file}:{line}: {item.function}: {item.what}: {item.text}")
            bad += 1
    for item in reason.keys() - {m for m, _ in missing}:
        print(f"test/strength/mcdc/missing.txt: covered, or no more: {' | '.join(item)}")
        bad += 1
    return bad


def table(have, missing):
    n_missing = collections.Counter(m.file for m, _ in missing)
    of_place = collections.defaultdict(lambda: [0, 0, 0, 0, 0])
    print(f"{'':34} MC/DC of conditions   other conditions   missing")
    for path, n in sorted(have.items()):
        for p in PLACES:
            if path.startswith(p):
                of_place[p] = [a + b for a, b in zip(of_place[p], n + [n_missing[path]])]
        if n_missing[path]:
            print(f"{path:34} {n[1]:8} of {n[0]:5} {n[3]:10} of {n[2]:5} {n_missing[path]:9}")
    for p, n in of_place.items():
        print(f"{p + ', all':34} {n[1]:8} of {n[0]:5} {n[3]:10} of {n[2]:5} {n[4]:9}   "
              f"{share(n[1], n[0])}, {share(n[3], n[2])}")


def share(a, b):
    return f"{100 * a / b:.2f} %" if b else "none"


def main():
    ap = argparse.ArgumentParser(usage=__doc__)
    ap.add_argument("--build", default="build/mcdc")
    ap.add_argument("--jobs", type=int, default=1)
    ap.add_argument("--update", action="store_true")
    ap.add_argument("--strict", action="store_true")
    ap.add_argument("--only", default="")
    ap.add_argument("--tests", default="")
    arg = ap.parse_args()
    binary, failed = run_tests(arg.build, arg.jobs, arg.tests)
    missing, have = gaps(export(arg.build, binary), Source())
    if arg.tests or arg.only:
        missing = [m for m in missing if arg.only in m[0].file]
        have = {p: n for p, n in have.items() if arg.only in p}
    table(have, missing)
    if arg.tests:
        for item, line in missing if arg.only else ():
            print(f"{item.file}:{line}: {item.function}: {item.what}: {item.text}")
        return 1 if failed else 0
    reason = {i: r for i, r in read_missing().items() if arg.only in i.file}
    if arg.update:
        write_missing(missing, reason)
        reason = read_missing()
    bad = compare(missing, reason)
    todo = sum(reason.get(m) in (None, TODO) for m, _ in missing)
    print(f"{len(binary)} tests, {len(failed)} failed; {len(missing)} missing, "
          f"{len(missing) - todo} of them explained, {todo} to do; "
          f"{bad} not as in missing.txt")
    return 1 if failed or bad or (arg.strict and todo) else 0


if __name__ == "__main__":
    sys.exit(main())
