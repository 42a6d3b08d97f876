#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""walk.py [--root ROOT] DIR PAGE...: types each block of a page as it is printed, and compares what
the commands print with the page.

A page is typed in a copy of this tree under DIR. With --root, ROOT is a bare Debian of root.sh:
each page is typed as root in a copy of ROOT under DIR, in a clone of what is committed. Without,
lines that begin with apt-get are not typed.

A block under a line `FILE`: is the content of that file. Under a line `FILE`, `NAME`: it replaces
NAME and the comment above it in that file. In a block with $, a line with $ is typed, and the lines
behind it are its output. Each line of a ```sh block is typed, and the next ```text block is the
output of that block.

In an output, `...` in a line is any text, and a line `...` is any lines. A
block of another kind is a failure, because no one types it. A compiler's warning is a failure, too.

Prints a line for each block: place, result, seconds, first line. Exit status: 0 all blocks did what
the page says, 1 not. Standard library only.
"""

import argparse
import os
import re
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(os.path.dirname(HERE)))
sys.dont_write_bytecode = True
from clone import ROOT, clone  # noqa: E402

ROOT_SH = os.path.join(os.path.dirname(HERE), "fresh", "root.sh")
BLOCK = re.compile(r"(?:^`([^`\n]+)`(?:, `([^`\n]+)`)?:\n\n)?^```(\w*)\n(.*?)^```\n|"
                   r"(?<=\n\n)((?: {4}.*\n)+)", re.M | re.S)


def matches(want, got):
    """`...` inside a line is any text, a line `...` any lines."""
    pattern = "".join(r"(?:.*\n)*?" if w == "..." else re.escape(w).replace(r"\.\.\.", ".*") + "\n"
                      for w in want)
    return re.fullmatch(pattern, "".join(line + "\n" for line in got)) is not None


def replaced(text, name, block):
    """The text with block instead of the definition of name and the comment above it, or None."""
    found = re.search(r"(?:^/\*(?:[^*]|\*(?!/))*\*/\n)?^\w[^;{}\n/]*\b%s\b[^;{}]*\{(?:[^\n]*\};?\n|"
                      r"\n.*?^\};?\n)" % re.escape(name), text, re.M | re.S)
    return text[:found.start()] + block + text[found.end():] if found else None


def steps(text):
    """(line number, kind, a, b) of each block. file: (path, name), content. type: [lines typed],
    output or None for any. other: a block that no one types."""
    found, k = list(BLOCK.finditer(text)), 0
    while k < len(found):
        path, name, language, block, indented = found[k].groups()
        at, k = text.count("\n", 0, found[k].start()) + 1, k + 1
        if path:
            yield at, "file", (path, name), block
        elif indented is None and re.search(r"^\$ ", block, re.M):
            for part in re.split(r"^\$ ", block, flags=re.M)[1:]:
                line, *want = part.splitlines()
                yield at, "type", [line], want
        elif language == "sh":
            want = None
            if k < len(found) and found[k][3] == "text":
                want, k = found[k][4].splitlines(), k + 1
            yield at, "type", block.splitlines(), want
        else:
            yield at, "other", (indented or block).splitlines()[:1], None


class Walk:
    """One page in its clone."""

    def __init__(self, page, where, root):
        self.page, self.passed, self.failed, self.root = page, 0, 0, root
        if root:
            at = os.path.join(where, "root")
            subprocess.run([ROOT_SH, "copy", root, at], check=True)
            self.root, self.tree = at, os.path.join(at, "exhand")
            subprocess.run(["git", "clone", "-q", ROOT, self.tree], check=True)
        else:
            self.tree = clone(where)
        self.env = {k: v for k, v in os.environ.items()
                    if k not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "WERROR", "B")}
        self.env["LC_ALL"] = "C.UTF-8"

    def write(self, path, name, block):
        """Nothing, or what is wrong."""
        file = os.path.join(self.tree, path)
        if name:
            with open(file) as f:
                block = replaced(f.read(), name, block)
            if block is None:
                return "%s has no %s" % (path, name)
        with open(file, "w") as f:
            f.write(block)
        return ""

    def shell(self, line):
        how = {"shell": True, "cwd": self.tree, "env": self.env}
        if self.root:
            line, how = [ROOT_SH, "run", self.root, "cd /exhand && " + line], {}
        return subprocess.run(line, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, errors="replace", **how)

    def type(self, lines, want):
        """Nothing, or what is wrong."""
        out = err = ""
        for line in lines:
            if line.startswith("apt-get ") and not self.root:
                continue
            done = self.shell(line)
            out, err = out + done.stdout, err + done.stderr
            if want is None and done.returncode:
                return "exit status %d: %s\n%s" % (done.returncode, line, (out + err)[-4000:])
        got = out.replace("\r", "").splitlines()
        warned = re.findall(r"^.*\bwarning:.*$", out + err, re.M)
        if warned:
            return "\n".join(warned[:20])
        if want is None or matches(want, got):
            return ""
        return "want:\n%s\ngot:\n%s\n%s" % ("\n".join(want), "\n".join(got[-60:]), err[-2000:])

    def block(self, at, kind, a, b):
        start = time.time()
        wrong = (self.write(*a, b) if kind == "file" else self.type(a, b) if kind == "type"
                 else "not typed: name its file, or make it ```sh or ```text")
        self.passed, self.failed = self.passed + (not wrong), self.failed + bool(wrong)
        print("%s:%-4d %-7s %6.1f s  %s%s" %
              (self.page, at, "FAILED" if wrong else "passed", time.time() - start,
               " ".join(w for w in a if w) if kind == "file" else "; ".join(a),
               "\n" + wrong if wrong else ""), flush=True)


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--root")
    p.add_argument("dir")
    p.add_argument("page", nargs="+")
    a = p.parse_args()
    passed = failed = 0
    for page in a.page:
        where = os.path.join(os.path.abspath(a.dir), os.path.basename(page).split(".")[0])
        walk = Walk(page, where, a.root)
        with open(os.path.join(walk.tree, page)) as f:
            for step in steps(f.read()):
                walk.block(*step)
        passed, failed = passed + walk.passed, failed + walk.failed
    print("pages: %d steps passed, %d failed" % (passed, failed))
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
