#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whole ticks of the scenes: scenes.py rates | ticks, from B/bench/scenes.csv and scenes_cost.csv
(make scenes-csv)."""

import csv
import os
import sys

import work

BENCH = os.path.join(os.environ.get("B", "build"), "bench")
OUT = os.environ.get("OUT", "build/report")
NAMES = {"fixed": "exhand", "double": "plain double", "float": "plain float"}
FLOOR = {"N": 1e-17, "m": 1e-18, "rad": 1e-17, "J": 1e-20}


def rows_of(name):
    with open(os.path.join(BENCH, name), encoding="utf-8", newline="") as f:
        return list(csv.DictReader(f))


def save(name, rows):
    with open(os.path.join(OUT, name + ".csv"), "w", encoding="utf-8", newline="") as f:
        w = csv.writer(f)
        w.writerow(rows[0].keys())
        w.writerows(r.values() for r in rows)


def rates():
    """One line a scene, quantity and rate, a column a way: what the picture draws; and the table at
    three rates."""
    rows = rows_of("scenes.csv")
    keys = list(dict.fromkeys((r["scene"], r["quantity"], r["unit"]) for r in rows))
    hz = list(dict.fromkeys(r["rate_hz"] for r in rows))
    at = {(r["scene"], r["quantity"], r["rate_hz"], r["way"]): r for r in rows}
    out = []
    for scene, quantity, unit in keys:
        for f in hz:
            line = {"scene": scene, "quantity": quantity, "unit": unit, "rate_hz": f}
            for way in ("fixed", "double", "float"):
                line[way] = "%.3g" % max(float(at[scene, quantity, f, way]["max"]), FLOOR[unit])
            out.append(line)
    save("scenes", out)
    with open(os.path.join(OUT, "scenes.md"), "w", encoding="utf-8") as f:
        some = [k for k in ("90", "2000", "20000") if k in hz]
        f.write("Largest error, fixed point; double; float:\n\n| scene | of | unit | %s |\n|%s\n" %
                (
                    " | ".join(k + " Hz" for k in some), "--|" * (3 + len(some))))
        for scene, quantity, unit in keys:
            cells = ["; ".join("%.2g" % float(at[scene, quantity, k, w]["max"])
                               for w in ("fixed", "double", "float")) for k in some]
            f.write("| %s | %s | %s | %s |\n" % (scene, quantity, unit, " | ".join(cells)))
    worse = [l for l in out if float(l["fixed"]) > float(l["float"])]
    print("note: Fixed point is more exact than float in %d of %d (scene, quantity, rate)%s." % (
        len(out) - len(worse), len(out), "; not in: " +
        ", ".join("%s %s %s Hz" % (l["scene"], l["quantity"], l["rate_hz"]) for l in worse)
        if worse else ""))


def ticks():
    costs = rows_of("scenes_cost.csv")
    errors = {(r["scene"], r["quantity"], r["way"]): r for r in rows_of("scenes.csv")
              if r["rate_hz"] == "2000"}
    points = []
    for scene, quantity in (("minimal", "force"), ("drop", "force"), ("guarded", "force"),
                            ("glove", "fingertips"), ("bilateral", "force")):
        for r in (r for r in costs if r["scene"] == scene and r["x64"] != "-"):
            e = errors[scene, quantity, r["way"]]
            points.append(work.Point("%s: %s (peak, %s)" % (scene, quantity, e["unit"]),
                                     NAMES[r["way"]], "ours" if r["way"] == "fixed" else "float",
                                     r["x64"], e["max"]))
    save("scene_ticks", costs)
    work.draw(OUT, "scene_ticks", points, 1e-20, "instructions of a tick", "error", 3, False)
    goals()


def goals():
    """The integer kernels in one, and the share of the full box, beside what is asked of them."""
    path = os.path.join(BENCH, "bench.csv")
    rows = ({r["name"]: r["instructions_i686"] for r in rows_of("bench.csv")}
            if os.path.exists(path) else {})
    if rows.get("integer_tick_x5", "-") != "-":
        print("note: 22 low-passes, fingertips, distances and laws of five fingers in integers: %s "
              "i686 instructions a tick (asked 4200, goal"
              " 3854; peers' parts sum to 5202, the cheapest double and float parts to 2231)." %
              rows["integer_tick_x5"])
    if rows.get("full_box_tick", "-") != "-":
        share = 100 * float(rows["full_box_tick"]) * 2 / 1.6e9 / 500e-6
        print("note: The full box: %s i686 instructions a tick, %.1f %% of 500 us at 1.6 GHz and "
              "two cycles an instruction (goal 1.5 %%)."
              % (rows["full_box_tick"], share))


if __name__ == "__main__":
    os.makedirs(OUT, exist_ok=True)
    {"rates": rates, "ticks": ticks}[sys.argv[1]]()
