#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Golden vectors: what docs/NUMERICS.md says every module computes, tick by tick.

    golden.py --all                      write digest/ and trace/ anew (make golden)
    golden.py --check [--every N]        compare them instead, at every Nth rate; 1 if one differs
    golden.py --beyond [--check]         the same of 2001..20000 Hz: beyond/, a CRC each hundred rates (an hour of one core)
    golden.py --module M --rate R        the trace of one module at one rate, with whole states

Standard library only; README.md has the stimuli and the formats.
"""

import argparse
import multiprocessing
import os
import sys
import zlib
from struct import pack

sys.dont_write_bytecode = True
from model import MODULES  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
RATES = range(1, 2001)
TRACED = (90, 100, 200, 500, 1000, 2000)
PER_LINE = 8
CHUNK = 40
BEYOND = range(2001, 20001)
HUNDRED = 100


def digest(ticks):
    crc = 0
    for row, state in ticks:
        crc = zlib.crc32(pack("<%dq" % len(row), *row) + state, crc)
    return crc


def trace(module, rate, whole):
    """Lines: a comment, the columns' names, then one tick each. Whole: with the inputs, and the states'
    bytes; else a value as in the line before is a dot."""
    names, run = MODULES[module]
    inputs, outputs = names.split(" | ") if " | " in names else ("", names)
    shown = inputs.split() + outputs.split() if whole else outputs.split()
    skip = 0 if whole else len(inputs.split())
    yield "# %s at %d Hz" % (module, rate)
    yield " ".join(shown + ["state"])
    before = []
    for row, state in run(rate):
        word = ["%d" % v for v in row[skip:]] + [state.hex() or "-" if whole else "%08x" % zlib.crc32(state)]
        assert len(word) == len(shown) + 1, "%s: %d values in %d columns" % (module, len(word), len(shown) + 1)
        yield " ".join(word if whole or not before else ["." if a == b else a for a, b in zip(word, before)])
        before = word


def digests_of(job):
    module, rates = job
    run = MODULES[module][1]
    return [digest(run(rate)) for rate in rates]


def digest_file(module):
    return os.path.join(HERE, "digest", module + ".inc")


def trace_file(module, rate):
    return os.path.join(HERE, "trace", "%s-%d.txt" % (module, rate))


def digest_text(crcs):
    word = ["0x%08x," % c for c in crcs]
    return "".join(" ".join(word[i:i + PER_LINE]) + "\n" for i in range(0, len(word), PER_LINE))


def read(path):
    try:
        with open(path) as f:
            return f.read()
    except OSError:
        return ""


def put(path, text):
    """Writes text; 1 if the file was another."""
    if read(path) == text:
        return 0
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as f:
        f.write(text)
    print("changed: " + os.path.relpath(path, HERE))
    return 1


def compare(path, want, got):
    """want: the file's; 1 and a line if the model says otherwise."""
    if want == got:
        return 0
    print("%s: %s: the file has %s" % (os.path.relpath(path, HERE), got, want or "nothing"))
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


def write_all(modules):
    changed = 0
    for m, crcs in in_parallel(modules, RATES).items():
        changed += put(digest_file(m), digest_text(crcs))
        for rate in TRACED:
            changed += put(trace_file(m, rate), "\n".join(trace(m, rate, False)) + "\n")
    print("%d modules, %d rates: %d files changed" % (len(modules), len(RATES), changed))
    return 0


def check(modules, every):
    rates = [r for r in RATES if r % every == 0 or r in TRACED]
    differ = 0
    for m, crcs in in_parallel(modules, rates).items():
        word = read(digest_file(m)).split()
        for rate, crc in zip(rates, crcs):
            kept = word[rate - 1] if len(word) == len(RATES) else ""
            differ += compare("%s at %d Hz" % (digest_file(m), rate), kept, "0x%08x," % crc)
        for rate in TRACED:
            if read(trace_file(m, rate)) != "\n".join(trace(m, rate, False)) + "\n":
                print("%s differs" % os.path.relpath(trace_file(m, rate), HERE))
                differ += 1
    print("%d modules, %d rates: %d digests and traces differ" % (len(modules), len(rates), differ))
    return 1 if differ else 0


def hundred(job):
    """The CRC-32 of the digests of a hundred rates, each as 32 bits, little-endian."""
    module, first = job
    run = MODULES[module][1]
    return zlib.crc32(b"".join(pack("<I", digest(run(rate))) for rate in range(first, first + HUNDRED)))


def beyond(modules, check, every):
    """2001..20000 Hz, the work dealt to all cores; a module's file is written when it is done."""
    firsts = BEYOND[::HUNDRED]
    differ = 0
    with multiprocessing.Pool() as pool:
        for m in modules:
            path = os.path.join(HERE, "beyond", m + ".inc")
            kept = read(path).split()
            if not check:
                differ += put(path, digest_text(pool.map(hundred, [(m, r) for r in firsts], chunksize=1)))
                continue
            some = [i for i in range(len(firsts)) if i % every == every - 1]
            for i, crc in zip(some, pool.map(hundred, [(m, firsts[i]) for i in some], chunksize=1)):
                differ += compare("%s from %d Hz" % (path, firsts[i]), kept[i] if i < len(kept) else "", "0x%08x," % crc)
    print("%d modules, %d..%d Hz: %d %s" % (len(modules), BEYOND[0], BEYOND[-1], differ, "differ" if check else "files changed"))
    return 1 if check and differ else 0


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--all", action="store_true")
    p.add_argument("--check", action="store_true")
    p.add_argument("--beyond", action="store_true")
    p.add_argument("--every", type=int, default=1, metavar="N")
    p.add_argument("--module", choices=sorted(MODULES))
    p.add_argument("--rate", type=int, choices=range(1, BEYOND[-1] + 1), metavar="1..20000")
    a = p.parse_args()
    modules = [a.module] if a.module else sorted(MODULES)
    if a.beyond:
        return beyond(modules, a.check, a.every)
    if a.all:
        return write_all(modules)
    if a.check:
        return check(modules, a.every)
    if a.module is None or a.rate is None:
        p.error("--all, --check, or --module and --rate")
    for line in trace(a.module, a.rate, True):
        print(line)
    return 0


if __name__ == "__main__":
    sys.exit(main())
