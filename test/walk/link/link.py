#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""link.py DIR [--only WORD]: the ways of examples/link/README.md, each in a new directory under DIR
beside a clone of the present tree.

Its lines are typed as printed, except those that install packages. The last line's output must be
what the README says. Prints a row a way: commands, seconds, bytes of the program. If a program of
those packages is not installed, it is named and the way is skipped. So is PlatformIO without PyPI.
EXH_ALL=1 makes that a failure. Exit status: 0 all outputs are the same, 1 not. Standard library
only.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
sys.dont_write_bytecode = True
from clone import clone  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
README = os.path.join(ROOT, "examples", "link", "README.md")
NONE = 75 # exit status: what is not ours could not be had


def block(text):
    return [line[4:] for line in text.splitlines() if line.startswith("    ")]


def ways():
    """The lines before any way, what the program must say, and [(name, commands)], of which the
    first installs packages."""
    with open(README) as f:
        head, *sections = re.split(r"^## ", f.read(), flags=re.M)
    *first, want = block(head)
    return first, want, [(s.splitlines()[0], block(s)) for s in sections if block(s)]


def registry(line, tree):
    """The command to insert after this line, because PlatformIO's registry is not available, or
    none."""
    return (["pio/bin/python %s/test/walk/link/registry.py" % tree]
            if line.startswith("pio/bin/pip ") else [])


def run(commands, where, want):
    """(said what it must without a warning, or None, seconds, bytes, the end of what was said)."""
    tree = clone(where)
    if any("file://" in c for c in commands): # fetched by git: what is there now is a commit
        for c in (["init", "-q"], ["add", "-A"],
                  ["-c", "user.name=link", "-c", "user.email=link@localhost",
                   "commit", "-qm", "x"]):
            subprocess.run(["git", "-C", tree] + c, check=True)
    lines = [l for c in commands
             for l in [c + (" || exit %d" % NONE if "pip" in c or "venv" in c else "")] +
             registry(c, "exhand")]
    env = {k: v for k, v in os.environ.items()
           if k not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "CC", "CFLAGS", "WERROR")}
    start = time.time()
    done = subprocess.run(["sh", "-e", "-c", "\n".join(lines)], cwd=where,
                          env=dict(env, LC_ALL="C.UTF-8", PLATFORMIO_CORE_DIR=where + "/core"),
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    took = time.time() - start
    program = os.path.join(where, commands[-1])
    warned = re.findall(r"^.*\bwarning:.*$", done.stdout, re.M)
    good = (None if done.returncode == NONE else done.returncode == 0 and
            done.stdout.rstrip().splitlines()[-1:] == [want] and not warned)
    return (good, took, os.path.getsize(program) if os.path.exists(program) else 0,
            "\n".join(warned or done.stdout.splitlines()[-15:]))


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("dir")
    p.add_argument("--only", default="")
    a = p.parse_args()
    _, want, of = ways()
    failed = passed = 0
    print("%-36s %9s %8s %9s" % ("way", "commands", "seconds", "bytes"))
    for k, (name, (install, *commands)) in enumerate(of):
        if a.only not in name:
            continue
        missing = [p for p in install.split()[2:] if not p.startswith(("-", "lib", "python3-")) and
                   not shutil.which(p) and not shutil.which(p.replace("gcc-", "", 1) + "-gcc")]
        good, took, size, end = ((None, 0, 0, "") if missing
                                 else run(commands,
                                          os.path.join(os.path.abspath(a.dir), "way%d" % k), want))
        if good is None:
            print("%-36s skipped: no %s" %
                  (name, " ".join(missing) or "PyPI, or no python3-venv\n" + end))
            failed += bool(os.environ.get("EXH_ALL"))
            continue
        passed, failed = passed + good, failed + (not good)
        print("%-36s %9d %8.1f %9d%s" %
              (name, len(commands), took, size, "" if good else "  FAILED\n" + end), flush=True)
    print("%d passed, %d failed" % (passed, failed))
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
