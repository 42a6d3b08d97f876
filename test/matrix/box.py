#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""box.py DIR [--only T,T]: the host program for every target of targets.tsv, by its gcc.
test/closed/sim/bits.sh compares each target's results with the host's in DIR/host: Table II, logs
of it and of the full box, a calibration, replays, faults. `make matrix-box`. Writes DIR/box.tsv,
keeps the rows of other targets, and writes docs/MATRIX.md's table anew. Standard library only.
"""

import argparse
import os
import re
import subprocess
import sys
import time

sys.dont_write_bytecode = True
from matrix import commands, there  # noqa: E402
from table import ROOT, commit, section, targets  # noqa: E402


def built(t, where):
    """The host program in where, and what runs it; None if it does not build."""
    make = [os.environ.get("MAKE", "make"), "--no-print-directory", "-s",
            "-j" + (os.environ.get("JOBS") or "1"), "B=" + where, "WERROR=1", "PORT=posix"]
    make += [c for c in commands(t, "gcc-O2") if not c.startswith("SUITE")]
    if subprocess.run(make + [where + "/posix/exhand-lab"], cwd=ROOT,
                      env=dict(os.environ, MAKEFLAGS="")).returncode != 0:
        return None
    script = os.path.join(where, "exhand")
    with open(script, "w") as f:
        f.write('#!/bin/sh\nexec %s "${0%%/*}/posix/exhand-lab" "$@"\n' % t["emulator"])
    os.chmod(script, 0o755)
    return script


def kept(path):
    """{target: (target, agree, of, commit)} of earlier runs."""
    if not os.path.exists(path):
        return {}
    with open(path) as f:
        return {w[0]: w for w in [tuple(line.rstrip("\n").split("\t")) for line in f][1:]}


def document(rows):
    yield "| target | agree | of | at commit |"
    yield "|---|---|---|---|"
    for r in rows:
        yield "| %s | %s | %s | %s |" % r


def put(path, table):
    rows = [table[name] for name in targets() if name in table]
    with open(path, "w") as f:
        f.write("".join("\t".join(r) + "\n" for r in [("target", "agree", "of", "commit")] + rows))
    section("make matrix-box", document(rows))


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("dir")
    p.add_argument("--only", default="")
    a = p.parse_args()
    some = [t for n, t in targets().items() if not t["metal"] and
            (not a.only or n in a.only.split(","))]
    if not all([there(t) for t in some]):
        return 3
    script = {t["name"]: built(t, os.path.join(a.dir, t["name"])) for t in some}
    start = time.time()
    run = subprocess.run(["test/closed/sim/bits.sh", a.dir + "/bits", a.dir + "/host"] +
                         [s for s in script.values() if s], cwd=ROOT,
                         stdout=subprocess.PIPE, text=True)
    print(run.stdout, end="")
    table = kept(os.path.join(a.dir, "box.tsv"))
    for name, s in script.items():
        said = re.search("^%s: (\\d+) of (\\d+)$" % re.escape(s or "-"), run.stdout, re.M)
        table[name] = (name,) + (said.groups() if said else ("0", "0")) + (commit(),)
    put(os.path.join(a.dir, "box.tsv"), table)
    bad = [n for n, s in script.items() if s is None]
    print("%d targets in %.0f s, not built: %s" %
          (len(script), time.time() - start, " ".join(bad) or "none"))
    return 1 if bad or run.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
