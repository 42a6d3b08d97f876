#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""walk.py DIR: types docs/PORTING.md in a new clone under DIR and compares what comes with what
stands there. `...` in a line is any text, on a line of its own any lines. `<!-- file: PATH -->`
writes the block that follows, `<!-- fill: NAME... -->` gives ports/mine/board.c those functions of
ports/mps2, all others being the template's, as a user who got that far. Exit status: 0 all as told,
1 not. Standard library only.
"""

import os
import re
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
sys.dont_write_bytecode = True
from clone import clone  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
DOC = os.path.join(ROOT, "docs", "PORTING.md")


def functions(text):
    """{name: (from, to)} of the board's functions."""
    found = re.finditer(r"^\w+ (exh_board_\w+)\([^;{]*\)(?: \{[^\n]*\}\n|\n\{.*?^\}\n)", text,
                        re.M | re.S)
    return {m.group(1): m.span() for m in found}


def filled(names):
    """ports/mps2/board.c, but what is not among these names as in the template."""
    template, text = (open(os.path.join(ROOT, "ports", p, "board.c")).read()
                      for p in ("template", "mps2"))
    empty = functions(template)
    for name, (lo, hi) in sorted(functions(text).items(), key=lambda f: -f[1][0]):
        if name not in names:
            text = text[:lo] + template[slice(*empty[name])] + text[hi:]
    return text


def matches(want, got):
    """`...` inside a line is any text, a line `...` any lines."""
    pattern = "".join(r"(?:.*\n)*?" if w == "..." else re.escape(w).replace(r"\.\.\.", ".*") + "\n"
                      for w in want)
    return re.fullmatch(pattern, "".join(line + "\n" for line in got)) is not None


def steps():
    """Of the page, in order: ("fill", names), ("file", path, lines), ("type", command, lines)."""
    path = None
    for line in open(DOC).read().splitlines():
        note = re.fullmatch(r"<!-- (fill|file): (.*) -->", line)
        if note and note.group(1) == "fill":
            yield ["fill", note.group(2).split()]
        elif note:
            path, step = note.group(2), None
        elif line.startswith("    $ "):
            step = ["type", line[6:], []]
            yield step
        elif line.startswith("    ") and path:
            step, path = ["file", path, [line[4:]]], None
            yield step
        elif line.startswith("    "):
            step[2].append(line[4:])


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 0 if "--help" in sys.argv else 2
    where = clone(os.path.abspath(sys.argv[1]))
    env = {k: v for k, v in os.environ.items()
           if k not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "WERROR", "B")}
    names, passed, failed = set(), 0, 0
    for kind, what, *rest in list(steps()):
        if kind == "fill":
            names |= set(what)
            with open(os.path.join(where, "ports/mine/board.c"), "w") as f:
                f.write(filled(names))
        elif kind == "file":
            with open(os.path.join(where, what), "w") as f:
                f.write("\n".join(rest[0]) + "\n")
        else:
            done = subprocess.run(what, shell=True, cwd=where, env=dict(env, LC_ALL="C.UTF-8"),
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            got = done.stdout.replace("\r", "").splitlines()
            good = matches(rest[0], got)
            passed, failed = passed + good, failed + (not good)
            if not good:
                print("$ %s\nwant:\n%s\ngot:\n%s\n%s" %
                      (what, "\n".join(rest[0]), "\n".join(got), done.stderr[-2000:]))
    print("porting: %d passed, %d failed" % (passed, failed))
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
