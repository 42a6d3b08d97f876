# SPDX-License-Identifier: MIT
"""Targets and variants of the matrix, digests expected of them, and what is kept of runs:
matrix.tsv and the generated parts of docs/MATRIX.md.
"""

import functools
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
DOC = os.path.join(ROOT, "docs", "MATRIX.md")
sys.path.insert(1, os.path.join(ROOT, "test", "golden"))
import digests  # noqa: E402

OPTIONS = ("O0", "O2", "O3", "Os", "O2-lto", "O3-lto", "Os-lto")
COMPILERS = ("gcc", "clang")


def targets():
    """{name: {column: value}} in the table's order; "-" is empty."""
    with open(os.path.join(HERE, "targets.tsv")) as f:
        lines = [line.rstrip("\n").split("\t") for line in f if not line.startswith("#")]
    head = lines[0]
    return {w[0]: dict(zip(head, ["" if v == "-" else v for v in w])) for w in lines[1:]}


def variants(t):
    """Of this target, all or those that its row names: their numbers, and names."""
    every = ["%s-%s" % (c, o) for c in COMPILERS for o in OPTIONS]
    return [(k, v) for k, v in enumerate(every) if not t["variants"] or
            v in t["variants"].split(",")]


def without(t, variant):
    """The modules that this variant has not: those that a target's row names, as module or
    module@option."""
    option = variant.split("-", 1)[1]
    return " ".join(m for m, _, o in [w.partition("@") for w in t["without"].split()]
                    if o in ("", option))


def clang_of(t):
    """Its name and --target."""
    version, _, target = t["clang"].rpartition(":")
    return "clang" + ("-" + version if version else ""), target


@functools.lru_cache(None)
def expected(lo, hi, step, without=""):
    """{module: CRC of its digests at these rates}, from the host's table, which is held against the
    generator's file."""
    return {m: digests.together([crcs[r - 1] for r in range(lo, hi + 1, step)])
            for m, crcs in singles().items() if m not in without.split()}


@functools.lru_cache(None)
def singles():
    return digests.singles()


def together(crcs):
    """One digest of all modules', in the order of their names."""
    return digests.together([crcs[m] for m in sorted(crcs)])


# --- what is kept of it ---

HEAD = "target variant rates cells digest tests groups seconds failed".split()


def words(r):
    return [r.target, r.variant, "%d..%d:%d" % r.rates, "%d" % r.cells, "%08x" % r.golden,
            "%d" % r.tests, "%d" % r.groups, "%.0f" % r.seconds, "; ".join(r.failed)]


def kept(path):
    """{(target, variant): words} of an earlier table, without results of other bits."""
    try:
        with open(path) as f:
            rows = [line.rstrip("\n").split("\t") for line in f][1:]
    except OSError:
        return {}
    return {(w[0], w[1]): w for w in rows if current(*w[:3], w[4])}


def current(target, variant, rates, digest):
    """Is this what the generator's files say of these rates?"""
    t = targets().get(target, {"without": ""})
    return "%08x" % together(expected(*[int(n) for n in re.split(r"\.\.|:", rates)],
                                      without(t, variant))) == digest


def put(path, table):
    with open(path + ".new", "w") as f:
        f.write("\t".join(HEAD) + "\n")
        for name, t in targets().items():
            for _, v in variants(t):
                if (name, v) in table:
                    f.write("\t".join(table[name, v]) + "\n")
    os.replace(path + ".new", path)


def commit():
    said = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, text=True).stdout
    return said.strip() or "unknown"


def document(table):
    """The generated part of docs/MATRIX.md."""
    good = [w for w in table.values() if not w[8]]
    modules = len(singles())
    yield ("%d of %d variants ran, the last at commit %s. **%d cells** of %d modules agree with "
           "the generator, and %d variants do not." % (
               len(table), sum(len(variants(t)) for t in targets().values()), commit(),
               sum(int(w[3]) for w in good), modules, len(table) - len(good)))
    yield ("%d tests passed with them. The digest of all rates of all modules is `%08x`." % (
               sum(int(w[5]) for w in good), together(expected(1, 2000, 1))))
    yield ""
    yield "| target | bits | compiler and option | rates, Hz | cells | digest | tests | s |"
    yield "|---|---|---|---|---|---|---|---|"
    for name, t in targets().items():
        for _, v in variants(t):
            w = table.get((name, v))
            if w:
                yield ("| %s | %s %s | %s | %s | %s | `%s` | %s | %s |" %
                       (name, t["bits"], t["endian"], v, w[2], w[3], w[4], w[5], w[8] or w[7]))


def section(name, lines):
    """Replaces the text in docs/MATRIX.md between <!-- name --> and the next <!-- end -->."""
    with open(DOC) as f:
        text = f.read()
    begin, end = "<!-- %s -->\n" % name, "<!-- end -->\n"
    start = text.index(begin) + len(begin)
    with open(DOC, "w") as f:
        f.write(text[:start] + "\n".join(lines) + "\n" + text[text.index(end, start):])


def stale():
    """Rows of docs/MATRIX.md whose digest is not the generator's any more."""
    with open(DOC) as f:
        row = re.findall(
            r"^\| (\w+) \| [^|]* \| ([\w-]+) \| (\d+\.\.\d+:\d+) \| \d+ \| `([0-9a-f]{8})` ",
            f.read(), re.M)
    return (["%s-%s" % (t, v) for t, v, rates, digest in row if not current(t, v, rates, digest)],
            len(row))
