#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""abi.py LIBRARY [--update] [CC...]: does LIBRARY (libexhand.a) offer what lib/exhand.map says, and
are the structures that callers own as large as abi.tsv says, by each compiler CC (default gcc)?
--update writes both.

A name of the map is one that a header declares and the library defines; the library's other names
are its own. A name that went, or another size, is another interface: EXH_VERSION_MINOR goes up, and
the SONAME with it. Exit status: 0 as said, 1 not, 2 wrong usage. Standard library only.
"""

import glob
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
HEADERS = sorted(glob.glob(os.path.join(ROOT, "lib", "include", "exhand", "*.h")))
MAP = os.path.join(ROOT, "lib", "exhand.map")
SIZES = os.path.join(HERE, "abi.tsv")
MAP_HEAD = """/* What libexhand.so offers: all that the headers declare, nothing else. Written by
 * test/walk/link/abi.py --update. */
{
global:
"""


def text():
    return "".join(open(h).read() for h in HEADERS)


def names(library):
    """What the library defines and a header names."""
    out = subprocess.run(["nm", "-g", "--defined-only", library], check=True,
                         stdout=subprocess.PIPE, text=True).stdout
    defined = set(re.findall(r"^[0-9a-f]+ [A-Z] (\w+)$", out, re.M))
    return sorted(defined &
                  set(re.findall(r"\b\w+\b", re.sub(r"/\*.*?\*/", "", text(), flags=re.S))))


def sizes(cc):
    """{structure: bytes} by this compiler, of all that headers define."""
    structs = sorted(set(re.findall(r"^struct (\w+) \{", text(), re.M)))
    with tempfile.TemporaryDirectory() as d:
        source = os.path.join(d, "sizes.c")
        with open(source, "w") as f:
            f.write('#include "exhand/board.h"\n#include "exhand/exhand.h"\n')
            f.writelines("char size_%s[sizeof(struct %s)];\n" % (s, s) for s in structs)
        subprocess.run([cc, "-std=c99", "-fno-common", "-I", os.path.join(ROOT, "lib", "include"),
                        "-c", source, "-o", source + ".o"], check=True)
        out = subprocess.run(["nm", "-S", source + ".o"], check=True, stdout=subprocess.PIPE,
                             text=True).stdout
    return {s: int(n, 16)
            for n, s in re.findall(r"^[0-9a-f]+ ([0-9a-f]+) . size_(\w+)$", out, re.M)}


def read(path):
    try:
        with open(path) as f:
            return f.read()
    except OSError:
        return ""


def kept_sizes():
    lines = [line.split("\t") for line in read(SIZES).splitlines() if not line.startswith("#")]
    return ({cc: {w[0]: int(w[k]) for w in lines[1:]} for k, cc in enumerate(lines[0][1:], 1)}
            if lines else {})


def write(public, by):
    with open(MAP, "w") as f:
        f.write(MAP_HEAD + "".join("    %s;\n" % n for n in public) + "local:\n    *;\n};\n")
    with open(SIZES, "w") as f:
        f.write("# Bytes of each public structure; test/walk/link/abi.py\nstructure\t%s\n" %
                "\t".join(by))
        f.writelines("%s\t%s\n" % (s, "\t".join("%d" % by[cc][s] for cc in by))
                     for s in sorted(next(iter(by.values()))))


def told(what, was, now):
    lines = ["%s: %s: gone, or no header declares it" % (what, n)
             for n in sorted(set(was) - set(now))]
    lines += ["%s: %s: new" % (what, n) for n in sorted(set(now) - set(was))]
    return lines


def main():
    update = "--update" in sys.argv[1:]
    words = [w for w in sys.argv[1:] if not w.startswith("-")]
    if not words or set(sys.argv[1:]) - set(words) - {"--update"}:
        print(__doc__)
        return 0 if "--help" in sys.argv[1:] else 2
    public, by = names(words[0]), {cc: sizes(cc) for cc in words[1:] or ["gcc"]}
    if update:
        write(public, by)
    wrong = told("name", re.findall(r"^    (\w+);$", read(MAP), re.M), public)
    kept = kept_sizes()
    for cc, now in by.items():
        was = kept.get(cc, {})
        wrong += told("structure", was, now)
        wrong += ["structure: %s: %d bytes, were %d (%s)" % (s, now[s], was[s], cc)
                  for s in sorted(was) if now.get(s, was[s]) != was[s]]
    print("\n".join(wrong) + "\nabi: EXH_VERSION_MINOR goes up if a name went or a size changed; "
                             "then test/walk/link/abi.py --update" if wrong
          else "abi: %d names, %d structures, by %s: as they were" %
          (len(public), len(next(iter(by.values()))), " ".join(by)))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
