#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the library functions of an image with symbols.tsv: symbols.py [--update] SCENE-PORT
FILE

symbols.tsv has a row a function and a column a scene and port, x where that image has the function.
FILE has the functions of one image, a line each. Each that differs is printed.
--update writes the column anew, and removes rows that no image has.
Exit status: 0 as committed, 1 not.
"""
import os
import sys

TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "symbols.tsv")


def read(path):
    """The names of the columns, and of each the functions that it has."""
    with open(path, encoding="utf-8") as f:
        head, *rows = [line.rstrip("\n").split("\t") for line in f]
    return {name: {r[0] for r in rows if r[i] == "x"} for i, name in enumerate(head) if i > 0}


def write(path, has):
    with open(path, "w", encoding="utf-8") as f:
        print("symbol", *has, sep="\t", file=f)
        for symbol in sorted(set().union(*has.values())):
            print(symbol, *("x" if symbol in s else "-" for s in has.values()), sep="\t", file=f)


def compare(name, want, got):
    """A line for each function that differs."""
    where = "%s on %s" % tuple(name.rsplit("-", 1))
    return (["%s: %s: linked, not in symbols.tsv" % (where, s) for s in sorted(got - want)] +
            ["%s: %s: in symbols.tsv, not linked" % (where, s) for s in sorted(want - got)])


def main(update, name, path):
    with open(path, encoding="utf-8") as f:
        got = set(f.read().split())
    has = read(TABLE) if os.path.exists(TABLE) else {}
    if update:
        has[name] = got
        write(TABLE, has)
        return 0
    if name not in has:
        print("symbols.tsv: no column %s" % name, file=sys.stderr)
        return 1
    told = compare(name, has[name], got)
    print(*told, sep="\n", end="\n" if told else "", file=sys.stderr)
    return 1 if told else 0


if __name__ == "__main__":
    words = sys.argv[1:]
    sys.exit(main(words[0] == "--update", *words[-2:]))
