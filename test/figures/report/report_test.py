#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests report.py with sections that end well, are skipped, fail, take too long or share a run.
Checks its pages and statuses. Exit status: 0 ok, 1 not."""

import os
import re
import subprocess
import sys
import tempfile

import report
import work

HERE = os.path.dirname(os.path.abspath(__file__))
SECTIONS = """# name\tmake\tcommand\tseconds\ttitle\tsays
good\t-\techo once >> "$OUT/runs"; printf 'a,b\\n1,2\\n' > "$OUT/good.csv"; \
echo "skipped: some peer"; echo "note: a < b"\t1\tGood\tFine.
twin\t-\techo once >> "$OUT/runs"; printf 'a,b\\n1,2\\n' > "$OUT/good.csv"; \
echo "skipped: some peer"; echo "note: a < b"\t1\tTwin\tThe same run.
lacks\t-\techo "no such tool" >&2; exit 3\t1\tLacks\tNever.
bad\t-\techo broken; exit 1\t1\tBad\tNever.
busy\t-\techo said; i=0; while [ $i -lt 300000 ]; do i=$((i + 1)); done\t1\tBusy\tCounts.
drawn\t-\tmkdir "$OUT/drawn.log"\t1\tDrawn\tIts log cannot be written.
spoilt\t-\tmkdir "$OUT/spoilt.csv"\t1\tSpoilt\tIts table cannot be read.
unmade\tno-such-target-of-ours\ttrue\t1\tUnmade\tNever.
"""
wrong = []


def expect(what, got, want):
    if got != want:
        wrong.append(what)
        print("report_test: %s: got %r, want %r" % (what, got, want))


def run(out, *args):
    p = subprocess.run([sys.executable, os.path.join(HERE, "report.py"), "--sections",
                        os.path.join(out, "s.tsv"), "--out", out] +
                       list(args), text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                       check=False)
    return p.returncode, p.stdout


def read(out, name):
    with open(os.path.join(out, name), encoding="utf-8") as f:
        return f.read()


def page(out):
    return read(out, "REPORT.md")


def sections():
    with tempfile.TemporaryDirectory() as out:
        with open(os.path.join(out, "s.tsv"), "w", encoding="utf-8") as f:
            f.write(SECTIONS)
        expect("listed", run(out, "--list")[1].count("\n"), 8)
        expect("unknown section", run(out, "--only", "nope")[0], 2)
        expect("jobs", run(out, "--jobs", "0")[0], 2)
        status, said = run(out, "--only", "good,twin,lacks")
        expect("skipped is no failure", status, 0)
        expect("skipped is named", "skipped: lacks" in said, True)
        text = page(out)
        expect("why it was skipped", "**skipped**: no such tool" in text, True)
        expect("a peer that is missing", text.count("Without some peer."), 2)
        expect("a note", "a < b" in text, True)
        expect("the table", "| 1 | 2 |" in text, True)
        with open(os.path.join(out, "REPORT.html"), encoding="utf-8") as f:
            expect("the note in HTML", "a &lt; b" in f.read(), True)
        with open(os.path.join(out, "runs"), encoding="utf-8") as f:
            expect("one run for both", f.read(), "once\n")
        status, said = run(out, "--only", "good,bad")
        expect("a failure", (status, "FAILED: bad" in said), (1, True))
        expect("why", "**failed**: broken" in page(out), True)
        expect("the sentence on top", page(out).splitlines()[2].startswith("**Take exhand"), True)
        status, said = run(out, "--only", "drawn,spoilt,good")
        expect("failures of files", (status, "FAILED: drawn, spoilt" in said), (1, True))
        expect("what is left of the page", ("Fine." in page(out), page(out).count("**failed**")),
               (True, 2))
        status, said = run(out, "--only", "busy")
        took = re.search(r"(\d+) s of CPU", said)
        expect("seconds of CPU", (status, int(took[1]) in range(61) if took else None), (0, True))
        expect("what a command said", read(out, "busy.log"), "said\n")
        status, said = run(out, "--only", "unmade")
        expect("what cannot be made", (status, "FAILED: unmade" in said), (1, True))


def diagrams():
    """Fronts and the place of labels."""
    p = [work.Point("p", n, k, c, e)
         for n, k, c, e in (("us", "ours", 10, 1e-3), ("dear", "integer", 20, 1e-2),
                            ("cheap", "integer", 5, 1), ("double", "float", 1, 1e-9))]
    expect("the front", [q.name for q in work.front(p)], ["cheap", "us"])
    expect("ours is on it", work.on_front(p), {"p": True})
    p.append(work.Point("p", "better", "integer", 10, 1e-4))
    expect("ours is off it", work.on_front(p), {"p": False})
    for k, q in enumerate(p):
        q.label = str(k)
    at = [near for near, _ in work.place(p, (0.5, 40), (1e-10, 10), 400, 400, 18)]
    expect("one point is no front", work.stairs(p[:1], (1, 100), (1e-9, 1)), [])
    expect("labels are inside", all(0 <= x <= 1 and 0 <= y <= 1 for x, y in at), True)
    near = [(a, b) for i, a in enumerate(at) for b in at[:i] if abs(a[0] - b[0]) * 400 < 8 and
            abs(a[1] - b[1]) * 400 < 10]
    expect("labels that cover each other", near, [])


def made():
    lacks = ("the benches: missing: valgrind: install by: apt\nmake[1]: *** [Makefile:1: bench] "
             "Error 3\n")
    expect("a tool that make misses", report.made("bench", 2, lacks),
           ("skipped", "the benches: missing: valgrind: install by: apt"))
    expect("what make cannot", report.made("bench", 2, "cc: broken\nmake: Error 1\n"),
           ("failed", "make bench: make: Error 1"))
    expect("what make can", report.made("bench", 0, lacks), ("ok", ""))


sections()
made()
diagrams()
print("report_test: %s" % ("ok" if not wrong else "%d wrong" % len(wrong)))
sys.exit(1 if wrong else 0)
