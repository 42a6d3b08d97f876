#!/usr/bin/env python3
"""Kernels: error over cost, from what `make bench` has left in B/bench; CSV and panels into OUT."""

import csv
import os
import sys

import work

BENCH = os.path.join(os.environ.get("B", "build"), "bench")
OUT = os.environ.get("OUT", "build/report")
RATIOS = ("0.1", "0.01", "0.001", "0.0001")
LEVEL_PPM = 370000  # of the input: what an output that stands still is wrong by


def rows_of(name):
    with open(os.path.join(BENCH, name), encoding="utf-8", newline="") as f:
        return list(csv.DictReader(line for line in f if not line.startswith("#")))


def save(name, head, rows):
    with open(os.path.join(OUT, name + ".csv"), "w", encoding="utf-8", newline="") as f:
        w = csv.writer(f)
        w.writerow(head)
        w.writerows(rows)


def kind_of(name):
    if name.startswith("exhand"):
        return "ours"
    return "float" if any(w in name for w in ("double", "float", "f32", "f64")) else "integer"


def ppm(text):
    return LEVEL_PPM if text == "dead" else float(text)


def judged(points):
    """Our points must be on the front of every panel."""
    off = [k for k, v in work.on_front(points).items() if not v]
    print("note: ours is on the front of integer code in %d of %d panels%s." % (
        len(work.on_front(points)) - len(off), len(work.on_front(points)), ", not in: " + "; ".join(off) if off else ""))


def filters():
    rows, points = rows_of("filters.csv"), []
    for cpu in ("x64", "i686"):
        for k, ratio in enumerate(RATIOS):
            for r in rows:
                if r[cpu] in ("", "-"):
                    continue
                worst = max(ppm(r["%s_%d" % (w, k + 1)]) for w in ("rest", "step", "sine") if r["%s_%d" % (w, k + 1)] != "-")
                points.append(work.Point("%s, fc/fs = %s" % ("x86-64" if cpu == "x64" else cpu, ratio), r["name"], kind_of(r["name"]),
                                         r[cpu], worst, r["where"] == "here"))
    save("filter", rows[0].keys(), [r.values() for r in rows])
    work.draw(OUT, "filter", points, 1e-10, "instructions, 22 channels", "largest error, ppm of full scale", 4, True)
    judged(points)


def main():
    os.makedirs(OUT, exist_ok=True)
    {"filter": filters}[sys.argv[1]]()
    if not os.path.exists(os.path.join(os.environ.get("B", "build"), "peers", "cmsisdsp-1.10.3", ".complete")):
        print("skipped: CMSIS-DSP, which could not be fetched; its points are those measured once elsewhere")
    return 0


if __name__ == "__main__":
    sys.exit(main())
