# SPDX-License-Identifier: MIT
"""The CI's part of the proofs. The record must be complete, and the document must match it. Cheap
units are proved again, first those whose text has changed.

A changed unit that is expensive is reported and does not fail: make proof ARGS=--update is due
then. Frama-C is large (README.md). Without it, z3 and the programs of every/ run, if they are
installed.
"""
import time
from concurrent.futures import ThreadPoolExecutor

import record
import table
import tools

BUDGET_S = 35.0  # seconds of a core, from the record


def on_record(p, was):
    """Rows whose text is another than what was proved; what is wrong with the record; what is
    behind with it for that reason."""
    stale, wrong = [], []
    tree = p.tree("ci.tree")
    for row in record.rows_wanted():
        if row not in was:
            wrong.append(row + ": not in counts.txt")
        elif not was[row].is_whole():
            wrong.append(row + ": what it says is not what --update wrote")
        elif was[row].proved < was[row].of:
            wrong.append("%s: %d of %d" % (row, was[row].proved, was[row].of))
    for u in tools.units():
        for row in u.rows():
            tool = row.split(".")[1]
            if row not in was:
                continue
            if was[row].key != p.keyed(tool, u, tree):
                stale.append(row)
            stated = len(set(tools.re.findall(r"/\*@ assert (\w+):", u.text)))
            if tool.startswith("eva") and was[row].proved < stated:
                wrong.append("%s: %d proved, but the unit states %d" %
                             (row, was[row].proved, stated))
    for name, path, old in tools.planted():
        if len(tools.places(tools.read(p.root + "/" + path), old)) != 1:
            wrong.append("%s: an error cannot be planted any more: %s: %s" % (name, path, old))
    for n in record.lemmas():
        row = "smt." + n
        if row in was and was[row].key != p.lemma_key(n):
            stale.append(row)
    wrong += [k + ": in counts.txt, but there is no such unit"
              for k in was if k not in record.rows_wanted()]
    behind = record.unexplained(record.covered(record.reached(), record.sources()),
                                record.not_proved())
    if not table.is_current():
        behind.append("docs/PROOFS.md: its tables are not those of counts.txt: run make proof "
                      "ARGS=--table")
    return stale, wrong + ([] if stale else behind), behind if stale else []


def chosen(was, stale, can):
    """Rows to prove here: those whose text has changed, then others, the cheapest first."""
    rows = sorted((r for r in record.rows_wanted() if r in was),
                  key=lambda r: (r not in stale, was[r].s))
    take, left = [], BUDGET_S
    for r in rows:
        if can[tool_of(r)] and was[r].s <= left:
            take.append(r)
            left -= was[r].s
    return take


def tool_of(row):
    return "smt" if row.startswith("smt.") else row.split(".")[1].rstrip("0123456789")


def check(p, parallel):
    t, was = time.time(), record.counts()
    stale, wrong, behind = on_record(p, was)
    can = {"eva": tools.shutil.which("frama-c") is not None, "wp": False, "smt": tools.has_z3(),
           "every": True}
    take = chosen(was, stale, can)
    units, s = {u.name: u for u in tools.units()}, 0.0

    def prove(row):
        name, tool = row.split(".", 1)
        return p.lemma(tool) if name == "smt" else p.prove(tool, units[name], row)

    with ThreadPoolExecutor(parallel) as pool:
        for row, r in zip(take, pool.map(prove, take)):
            s += r["s"]
            if r["proved"] < was[row].proved or r["proved"] < r["of"]:
                wrong.append("%s: %d of %d, was %d" % (row, r["proved"], r["of"], was[row].proved))
    for line in wrong:
        print("proof: " + line)
    for line in behind:
        print("proof: behind: " + line)
    if stale:
        print("proof: behind: %d rows are of another text, %d of them not proved here: make proof "
              "ARGS=\"--only %s --update\"" %
              (len(stale), len(set(stale) - set(take)),
               ",".join(sorted({r.split(".")[0] for r in stale}))))
    print("proof: %d rows on record, %d properties; proved again: %d rows (%s), %d of them since "
          "their text has "
          "changed; %d wrong; %.0f s, %.0f s of a core" %
          (len(was), sum(r.proved for r in was.values()), len(take),
           ", ".join("%s %d" % (k, n) for k, n in ((k, sum(tool_of(r) == k for r in take))
                                                   for k in can) if n) or "none",
           len([r for r in stale if r in take]), len(wrong), time.time() - t, s))
    return 1 if wrong else 0
