#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Golden vectors: what docs/NUMERICS.md says every module computes, tick by tick.

    golden.py --all                      write digests.inc anew (make golden), of 1..2000 Hz
    golden.py --beyond                   the same of 2001..20000 Hz (an hour of one core)
    golden.py --check [--beyond]         compare them instead; 1 if one differs
    golden.py --check --every N          compare every Nth rate and those that have traces, by the
    host's table of single rates golden.py --traces DIR               the traces of every module at
    the paper's six rates (make golden-traces) golden.py --module M --rate R        the trace of one
    module at one rate, with whole states golden.py --module M --hundred R     the digests of one
    module from R Hz on

Standard library only; README.md has the stimuli and the formats.
"""

import argparse
import multiprocessing
import os
import sys
import zlib
from struct import pack

sys.dont_write_bytecode = True
# noqa: E402
from digests import BEYOND, HUNDRED, RATES, commit, committed, hundreds, singles, together
from model import MODULES  # noqa: E402

TRACED = (90, 100, 200, 500, 1000, 2000)
CHUNK = 40
KEPT = len(RATES) // HUNDRED  # a line of digests.inc: these, then those beyond


def digest(ticks):
    crc = 0
    for row, state in ticks:
        crc = zlib.crc32(pack("<%dq" % len(row), *row) + state, crc)
    return crc


def trace(module, rate, whole):
    """Lines: a comment, the columns' names, then one tick each. Whole: with the inputs, and the
    states' bytes; else a value as in the line before is a dot."""
    names, run = MODULES[module]
    inputs, outputs = names.split(" | ") if " | " in names else ("", names)
    shown = inputs.split() + outputs.split() if whole else outputs.split()
    skip = 0 if whole else len(inputs.split())
    yield "# %s at %d Hz" % (module, rate)
    yield " ".join(shown + ["state"])
    before = []
    for row, state in run(rate):
        word = ["%d" % v for v in row[skip:]] + [state.hex() or "-" if whole
                                                 else "%08x" % zlib.crc32(state)]
        assert len(word) == len(shown) + 1, (
            "%s: %d values in %d columns" % (module, len(word), len(shown) + 1))
        yield " ".join(word if whole or not before
                       else ["." if a == b else a for a, b in zip(word, before)])
        before = word


def digests_of(job):
    module, rates = job
    run = MODULES[module][1]
    return [digest(run(rate)) for rate in rates]


def compare(what, want, got):
    """1 and a line if the model says otherwise."""
    if want == got:
        return 0
    print("%s: %08x: kept is %s" % (what, got, "nothing" if want is None else "%08x" % want))
    return 1


def in_parallel(modules, rates):
    """{module: [digest of each rate]}, the work dealt to all cores."""
    parts = [rates[i:i + CHUNK] for i in range(0, len(rates), CHUNK)]
    jobs = [(m, p) for m in modules for p in parts]
    with multiprocessing.Pool() as pool:
        done = pool.map(digests_of, jobs, chunksize=1)
    crcs = {m: [] for m in modules}
    for (m, _), part in zip(jobs, done):
        crcs[m] += part
    return crcs


def hundred(job):
    """The CRC-32 of the digests of a hundred rates."""
    module, first = job
    return together(digests_of((module, range(first, first + HUNDRED))))


def put(module, crcs, at):
    """The committed digests of a module from the hundred `at` on; 1 if they were others."""
    kept = committed()
    line = kept.get(module, [])
    kept[module] = line[:at] + crcs + line[at + len(crcs):]
    changed = commit(kept)
    if changed:
        print("changed: %s" % module)
    return changed


def write_all(modules):
    changed = sum(put(m, hundreds(crcs), 0) for m, crcs in in_parallel(modules, RATES).items())
    print("%d modules, %d rates: %d changed" % (len(modules), len(RATES), changed))
    return 0


def check(modules):
    kept = committed()
    differ = 0
    for m, crcs in in_parallel(modules, RATES).items():
        for i, crc in enumerate(hundreds(crcs)):
            differ += compare("%s from %d Hz" % (m, RATES[i * HUNDRED]),
                              kept[m][i] if m in kept else None, crc)
    print("%d modules, %d rates: %d hundreds differ" % (len(modules), len(RATES), differ))
    return 1 if differ else 0


def check_some(modules, every):
    kept = singles()
    rates = [r for r in RATES if r % every == 0 or r in TRACED]
    differ = 0
    for m, crcs in in_parallel(modules, rates).items():
        for rate, crc in zip(rates, crcs):
            differ += compare("%s at %d Hz" % (m, rate), kept[m][rate - 1] if m in kept else None,
                              crc)
    print("%d modules, %d rates: %d digests differ" % (len(modules), len(rates), differ))
    return 1 if differ else 0


def beyond(modules, check, every):
    """2001..20000 Hz, the work dealt to all cores; a module's digests are written when it is
    done."""
    firsts = BEYOND[::HUNDRED]
    differ = 0
    with multiprocessing.Pool() as pool:
        for m in modules:
            if not check:
                differ += put(m, pool.map(hundred, [(m, r) for r in firsts], chunksize=1), KEPT)
                continue
            kept = committed().get(m, [])[KEPT:]
            some = [i for i in range(len(firsts)) if i % every == every - 1]
            for i, crc in zip(some, pool.map(hundred, [(m, firsts[i]) for i in some], chunksize=1)):
                differ += compare("%s from %d Hz" % (m, firsts[i]), kept[i] if i < len(kept)
                                  else None, crc)
    print("%d modules, %d..%d Hz: %d %s" %
          (len(modules), BEYOND[0], BEYOND[-1], differ, "differ" if check else "changed"))
    return 1 if check and differ else 0


def write_trace(job):
    where, module, rate = job
    with open(os.path.join(where, "%s-%d.txt" % (module, rate)), "w") as f:
        f.write("\n".join(trace(module, rate, False)) + "\n")


def write_traces(modules, where):
    os.makedirs(where, exist_ok=True)
    with multiprocessing.Pool() as pool:
        pool.map(write_trace, [(where, m, rate) for m in modules for rate in TRACED], chunksize=1)
    print("%d traces of %d modules" % (len(modules) * len(TRACED), len(modules)))
    return 0


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--all", action="store_true")
    p.add_argument("--check", action="store_true")
    p.add_argument("--beyond", action="store_true")
    p.add_argument("--every", type=int, default=1, metavar="N")
    p.add_argument("--traces", metavar="DIR")
    p.add_argument("--module", choices=sorted(MODULES))
    p.add_argument("--rate", type=int, choices=range(1, BEYOND[-1] + 1), metavar="1..20000")
    p.add_argument("--hundred", type=int, choices=range(1, BEYOND[-1] + 1, HUNDRED),
                   metavar="1,101..19901")
    a = p.parse_args()
    modules = [a.module] if a.module else sorted(MODULES)
    if a.beyond:
        return beyond(modules, a.check, a.every)
    if a.all:
        return write_all(modules)
    if a.check:
        return check(modules) if a.every == 1 else check_some(modules, a.every)
    if a.traces:
        return write_traces(modules, a.traces)
    if a.module is None or not (a.rate or a.hundred):
        p.error("--all, --check, --traces, or --module and --rate or --hundred")
    if a.hundred:
        print(" ".join("%08x" % crc
                       for crc in digests_of((a.module, range(a.hundred, a.hundred + HUNDRED)))))
        return 0
    for line in trace(a.module, a.rate, True):
        print(line)
    return 0


if __name__ == "__main__":
    sys.exit(main())
