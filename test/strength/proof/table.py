# SPDX-License-Identifier: MIT
"""The tables of docs/PROOFS.md: what is proved, by unit and by file, and what is not, and why."""
import os
import re

import record
from tools import HERE, WP_PLANTS, read, units

DOC = os.path.join(record.ROOT, "docs", "PROOFS.md")
BEGIN, END = "<!-- proofs: make proof ARGS=--table -->\n", "<!-- end of proofs -->\n"


def told(unit):
    """What a unit's first comment says, in one line, and of WP in another."""
    head = unit.text.split("*/", 1)[0].splitlines()
    lines, wp, into = [], "", None
    for line in (h.lstrip("/* ").rstrip() for h in head):
        key, _, rest = line.partition(": ")
        if key in ("EVA", "WITH", "PLANT"):
            into = None
        elif key == "WP":
            into, wp = "wp", rest
        elif key == "PROVES":
            into = "eva" # these few words are the name in what is printed
        elif into == "wp" and line:
            wp += " " + line
        elif into == "eva" and line:
            lines.append(line)
    return " ".join(lines) or unit.about, wp


def lemma_lines(counts):
    for f in record.LEMMA_FILES:
        for name, text in re.findall(r'^def (\w+)\(\):\n    """(.*?)"""',
                                     read(os.path.join(HERE, f)), re.M | re.S):
            if "smt." + name in counts:
                yield name, text.split("\n\n")[0].replace("\n    ", " ")


def count(row):
    return "%d" % row.proved if row.proved == row.of else "%d of %d" % (row.proved, row.of)


def unit_lines(counts):
    tools = {"eva64": "Eva 64", "eva32": "Eva 32", "every": "every value", "wp": "WP"}
    for u in units():
        rows = [(r.split(".")[1], counts[r]) for r in u.rows() if r in counts]
        eva, wp = told(u)
        plants = len(u.plants) + sum(p[0] == u.name for p in WP_PLANTS)
        what = eva + (" WP: " + wp if wp else "")
        yield "| %s | %s | %s | %d |" % (u.name, what.replace("|", "\\|"),
                                         ", ".join("%s: %s" % (tools[t], count(r))
                                                   for t, r in rows), plants)


def file_lines(best):
    for f, names in sorted(best.items()):
        got = {n: v for n, v in names.items() if v[0] > 0}
        of = sum(v[1] for v in got.values())
        share = "%d of %d" % (sum(v[0] for v in got.values()), of) if of else "none"
        by = sorted({u for v in got.values() for u in v[2][:1]})
        yield "| `%s` | %d of %d | %s | %s |" % (f.replace("lib/include/", "").replace("lib/", ""),
                                                 len(got), len(names), share,
                                                 ", ".join(by) or "none")


def text():
    counts, texts = record.counts(), record.sources()
    best = record.covered(record.reached(), texts)
    rows = [r for k, r in counts.items() if k in record.rows_wanted()]
    functions = [v for names in best.values() for v in names.values()]
    out = ["%d properties are proved and %d are open. At least one unit reaches %d of %d functions "
           "of library and scenes without an alarm."
           % (sum(r.proved for r in rows), sum(r.of - r.proved for r in rows),
              sum(v[0] > 0 for v in functions), len(functions)), "",
           "## Units", "", "Inputs and states are those that the row names.", "",
           "| unit | for all inputs and states | proved | planted |",
           "|---|---|---|---|"]
    out += unit_lines(counts)
    out += ["", "## Lemmas", "", "z3 proves these of expressions that repeat the source.", "",
            "| lemma | statement |", "|---|---|"]
    out += ["| `%s` | %s |" % (name, what.replace("|", "\\|"))
            for name, what in lemma_lines(counts)]
    out += ["", "## Files", "",
            "Functions that a unit reaches, and the statements of these that Eva reaches, in the "
            "best unit. A file with no functions holds tables.", "",
            "| file | functions | statements | units |", "|---|---|---|---|"]
    out += file_lines(best)
    out += ["", "## Not proved, and why", "", "| file | functions | reason |", "|---|---|---|"]
    for line in read(record.NOT_PROVED).splitlines():
        if line[:1] not in ("#", ""):
            where, _, why = line.partition(": ")
            f, names = where.split(None, 1)
            names = "all" if names == "*" else ", ".join("`%s()`" % n for n in names.split())
            out.append("| `%s` | %s | %s |" % (f.replace("lib/", "", 1), names, why))
    return "\n".join(out) + "\n"


def split(doc):
    before, rest = doc.split(BEGIN, 1)
    was, after = rest.split(END, 1)
    return before, was, after


def is_current():
    return split(read(DOC))[1] == text()


def write():
    before, _, after = split(read(DOC))
    now = before + BEGIN + text() + END + after
    with open(DOC, "w") as f:
        f.write(now)
    return 0
