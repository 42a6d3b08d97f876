# SPDX-License-Identifier: MIT
"""What was read of a box's ticks, in its log.

logged.py READ MAP CSV RATE: READ by strangers.py, MAP is `exhand regs --csv`, CSV `exhand csv
--all` of the log, RATE in Hz. Of each request all outputs and limits must be those of one tick,
from the tick read before it to the one read behind it. CSV has nine digits, so that much is
compared. Exit 1 if one is not.
"""
import csv
import json
import re
import struct
import sys

LIMITS, TICK = 0x14, 0x08
# "There is none", blank in the CSV: -2**31 and 2**31 - 1, and as floats -2 m and 2 m.
NONE = {1: (0x80000000, 0x7FFFFFFF), 3: (0xC0000000, 0x40000000)}
reads = json.load(open(sys.argv[1]))
rate = float(sys.argv[4])
rows = [r for r in csv.DictReader(open(sys.argv[2])) if r["table"] == "input" and
        int(r["address"], 16) >> 12 == 1]
frac = [int(re.search(r"q(\d+)", r["format"]).group(1)) if "q" in r["format"] else 0 for r in rows]
limits = [i for i, r in enumerate(rows) if r["name"].split("[")[0] == "limits"]

wanted = {t for first, last, *_ in reads for t in range(first, last + 1)}
logged = {}
with open(sys.argv[3]) as f:
    next(f)
    for line in f:
        # behind the first tick, of 0 s, the head counts 1
        t = round(float(line[: line.index(",")]) * rate) + 1
        if t in wanted:
            logged[t] = [float(v) if v else None for v in line.split(",")[1 : len(rows) + 1]]


def near(v, of, bits):
    """To nine digits, and to what bits of a binary fraction hold."""
    return abs(v - of) <= abs(of) * (6e-9 + 2.0**-bits)


def is_of(t, table, at, values):
    row = logged[t]
    acting = 0
    for i in limits:
        acting |= int(row[i])
    if table == "discrete":
        return all(v == acting >> at + i - 0x80 & 1 for i, v in enumerate(values)
                   if 0x80 <= at + i < 0xA0)
    for i in range(0, len(values) - 1, 2):
        a, w = at + i, values[i] << 16 | values[i + 1]
        k = (a & 0xFFF) // 2
        if a >> 12 in NONE and row[k] is None:
            good = w in NONE[a >> 12]
        elif a >> 12 == 1:
            raw = w - (w >> 31 << 32)
            good = near(raw, row[k] * 2.0 ** frac[k], 32)
        elif a >> 12 == 3:
            good = near(struct.unpack(">f", struct.pack(">I", w))[0], row[k], 24)
        else:
            good = w == {LIMITS: acting, TICK: t}.get(a, w)
        if not good:
            return False
    return True


for first, last, who, table, at, values in reads:
    missing = [t for t in range(first, last + 1) if t not in logged]
    if missing == list(range(first, last + 1)):
        sys.exit(f"logged: {who} {table} {at:#x}: no tick from {first} to {last} in the log")
    if not any(is_of(t, table, at, values) for t in range(first, last + 1) if t in logged):
        sys.exit(f"logged: {who} {table} {at:#x}: {values} is of no tick from {first} to {last}")
if not reads:
    sys.exit("logged: nothing was read")
print(f"log:      {len(reads)} requests of outputs or limits, each of one tick of the log")
