#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""walk.py DIR: follows docs/PORTING.md in a new clone under DIR, typing only what a reader of the
page sees, and compares what comes with what stands there. A line `FILE`: means that the block below
it is that file; a line `FILE`, `NAME`: that the block takes the place of NAME and its comment in
the file. In a block, $ begins what is typed, and what follows is what comes: `...` in a line is any
text, on a line of its own any lines. Exit status: 0 all as told, 1 not. Standard library only.
"""

import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(os.path.dirname(HERE)))
sys.dont_write_bytecode = True
from clone import clone  # noqa: E402

DOC = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(HERE))), "docs", "PORTING.md")
BLOCK = re.compile(r"(?:^`([^`\n]+)`(?:, `([^`\n]+)`)?:\n\n)?^```\w*\n(.*?)^```\n", re.M | re.S)


def matches(want, got):
    """`...` inside a line is any text, a line `...` any lines."""
    pattern = "".join(r"(?:.*\n)*?" if w == "..." else re.escape(w).replace(r"\.\.\.", ".*") + "\n"
                      for w in want)
    return re.fullmatch(pattern, "".join(line + "\n" for line in got)) is not None


def replaced(text, name, block):
    """The definition of name and the comment above it, another now."""
    found = re.search(r"(?:^/\*(?:[^*]|\*(?!/))*\*/\n)?^\w[^;{}\n/]*\b%s\b[^;{}]*\{(?:[^\n]*\};?\n|"
                      r"\n.*?^\};?\n)" % re.escape(name), text, re.M | re.S)
    return text[:found.start()] + block + text[found.end():] if found else None


def commands(block):
    """(What is typed, what comes) in a block."""
    for part in re.split(r"^\$ ", block, flags=re.M)[1:]:
        typed, *want = part.splitlines()
        yield typed, want


class Walk:
    def __init__(self, where):
        self.where, self.passed, self.failed = where, 0, 0
        self.env = {k: v for k, v in os.environ.items()
                    if k not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "WERROR", "B")}
        self.env["LC_ALL"] = "C.UTF-8"

    def judge(self, good, what):
        self.passed, self.failed = self.passed + good, self.failed + (not good)
        if not good:
            print(what)

    def write(self, path, name, block):
        path = os.path.join(self.where, path)
        if name:
            text = replaced(open(path).read(), name, block)
            self.judge(text is not None, "%s has no %s" % (path, name))
            block = text or block
        with open(path, "w") as f:
            f.write(block)

    def type(self, typed, want):
        done = subprocess.run(typed, shell=True, cwd=self.where, env=self.env, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        got = done.stdout.replace("\r", "").splitlines()
        self.judge(matches(want, got), "$ %s\nwant:\n%s\ngot:\n%s\n%s" % (
            typed, "\n".join(want), "\n".join(got), done.stderr[-2000:]))


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 0 if "--help" in sys.argv else 2
    walk = Walk(clone(os.path.abspath(sys.argv[1])))
    for path, name, block in BLOCK.findall(open(DOC).read()):
        if path:
            walk.write(path, name, block)
        else:
            for typed, want in commands(block):
                walk.type(typed, want)
    print("porting: %d passed, %d failed" % (walk.passed, walk.failed))
    return 1 if walk.failed or not walk.passed else 0


if __name__ == "__main__":
    sys.exit(main())
