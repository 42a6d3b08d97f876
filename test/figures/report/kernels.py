#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
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
    """Our points must be on the front of every panel; whose else are?"""
    on = work.on_front(points)
    off = [k for k, v in on.items() if not v]
    alone = [k for k in on
             if all(p.kind == "ours" for p in work.front([q for q in points if q.panel == k]))]
    print("note: Ours is on the front of integer code in %d of %d panels, alone on it in %d%s." % (
        len(on) - len(off), len(on), len(alone), "; not in: " + "; ".join(off) if off else ""))


COSTS = (("x64", "x86-64", "instructions"), ("i686", "i686", "instructions"),
         ("ns", "x86-64, this machine", "ns"))


def counted(row, cost):
    return row.get(cost, "") not in ("", "-")


def filters():
    rows, points, labels = rows_of("filters.csv"), [], []
    for cost, title, unit in COSTS:
        for k, ratio in enumerate(RATIOS):
            mine = [r for r in rows if counted(r, cost)]
            for r in mine:
                worst = max(ppm(r["%s_%d" % (w, k + 1)]) for w in ("rest", "step", "sine")
                            if r["%s_%d" % (w, k + 1)] != "-")
                points.append(work.Point("%s, fc/fs = %s" %
                                         (title.split(",")[0] + (", ns" if cost == "ns" else ""),
                                          ratio), r["name"],
                                         kind_of(r["name"]), r[cost], worst, r["where"] == "here"))
            labels += [unit + ", 22 channels"] if mine else []
    save("filter", rows[0].keys(), [r.values() for r in rows])
    work.draw(OUT, "filter", points, 1e-10, labels, "largest error, ppm", len(RATIOS))
    judged(points)


def sines():
    rows, points = rows_of("sines.csv"), []
    for cost, title, unit in COSTS:
        points += [work.Point(title, r["name"], kind_of(r["name"]), r[cost], r["worst_ppm"])
                   for r in rows if counted(r, cost)]
    save("sine", rows[0].keys(), [r.values() for r in rows])
    work.draw(OUT, "sine", points, 1e-10,
              [u for c, _, u in COSTS if any(counted(r, c) for r in rows)], "largest error, ppm")
    judged(points)


def kernel(name, of, unit, floor, scale=1, when=(("all", ""),)):
    """One kernel's diagram: error times scale, in unit; at each time a row of panels."""
    rows = [r for r in rows_of("work.csv") if r["kernel"] == of]
    points, labels = [], []
    for at, said in when:
        for cost, title, label in COSTS:
            mine = [r for r in rows if r["when"] == at and counted(r, cost)]
            points += [work.Point(title + said, r["name"], r["kind"], r[cost],
                                  scale * float(r["max"])) for r in mine]
            labels += [label] if mine else []
    save(name, rows[0].keys(), [r.values() for r in rows])
    work.draw(OUT, name, points, floor, labels, "largest error, " + unit, len(labels) // len(when))
    judged(points)


def drift(name, of, floor):
    """Largest error in the last second, over time."""
    rows = [r for r in rows_of("work.csv") if r["kernel"] == of and r["when"] not in ("all", "-")]
    names = list(dict.fromkeys((r["name"], r["kind"]) for r in rows))
    times = list(dict.fromkeys(r["when"] for r in rows))
    at = {(r["name"], r["when"]): max(float(r["max"]), floor) for r in rows}
    save(name, ["seconds"] + [n for n, _ in names],
         [[t] + ["%.3g" % at[n, t] for n, _ in names] for t in times])
    with open(os.path.join(OUT, name + ".names"), "w", encoding="utf-8") as f:
        f.write("unit = '%s'; n_names = %d\n" % (rows[0]["unit"], len(names)))
        for k, (n, kind) in enumerate(names):
            f.write("name_%d = '%s'; kind_%d = %d\n" % (k + 1, n, k + 1, work.KINDS.index(kind)))


def velocity():
    """Noise and lag over cost, and over each other."""
    cost_of = {r["name"]: r for r in rows_of("work.csv") +
               [dict(r, x64=r["instructions"], i686=r["instructions_i686"])
                for r in rows_of("bench.csv")]}
    rows = [r for r in rows_of("velocity.csv") if r["source"] == "measured" and
            r["step_um"] == "15.7"]
    points, labels = [], []
    for title, key, unit in (("noise at 10 mm/s", "rms_10mmps", "mm/s"), ("lag", "lag_ms", "ms"),
                             ("error on a sine", "sine_rms_mmps", "mm/s")):
        for cost, cpu in (("x64", "x86-64"), ("i686", "i686")):
            mine = [r for r in rows if counted(cost_of[r["kernel"]], cost)]
            points += [work.Point(title + ", " + unit + (" " if cost == "i686" else ""),
                                  label_of(r), kind_of(label_of(r)), cost_of[r["kernel"]][cost],
                                  r[key])
                       for r in mine]
            labels += ["instructions, " + cpu] if mine else []
    points += [work.Point("noise (mm/s) over lag", label_of(r), kind_of(label_of(r)), r["lag_ms"],
                          r["rms_10mmps"]) for r in rows]
    labels.append("lag, ms")
    save("velocity", rows[0].keys(), [r.values() for r in rows])
    work.draw(OUT, "velocity", points, 1e-3, labels, "error", 4, False)
    judged(points)


def soft():
    """Where floating point is software: errors are those of this machine, which has the same
    formats."""
    names = {"fixed": ("exhand", "ours"), "cheap": ("exhand-cheap", "ours"),
             "double": ("plain double, by software", "float"),
             "float": ("plain float, by software", "float")}
    of = {"fixed": "exhand", "cheap": "exhand-cheap", "double": "plain double",
          "float": "plain float"}
    wrong = {("filter", w): max(ppm(r["%s_2" % k]) for k in ("rest", "step", "sine"))
             for r in rows_of("filters.csv")
             for w, n in of.items() if (r["name"] + " ").startswith(n + " ")}
    wrong.update({(r["kernel"], w): float(r["max"]) for r in rows_of("work.csv")
                  for w, n in of.items()
                  if r["name"].startswith(n) and
                  r["when"] == ("3600" if r["kernel"] == "law" else "all")})
    title = {"filter": "22 low-passes (ppm)", "law": "5 laws, after 1 h (N)",
             "table": "table (ppm)", "precontact": "5 distances, freeze (m)"}
    rows = [dict(r, error=wrong.get((r["kernel"], r["way"]), "-")) for r in rows_of("soft.csv")]
    points = [work.Point(title[r["kernel"]], *names[r["way"]], r["instructions"], r["error"])
              for r in rows if r["kernel"] in title]
    save("soft", rows[0].keys(), [r.values() for r in rows])
    work.draw(OUT, "soft", points, 1e-17, "instructions, Cortex-M3", "largest error", 4, False)
    cost = {(r["kernel"], r["way"]): float(r["instructions"]) for r in rows}
    print("note: What double and float cost against ours: " + "; ".join("%s %.1f, %.1f" % (
        k, cost[k, "double"] / cost[k, "fixed"], cost[k, "float"] / cost[k, "fixed"])
                                                                        for k in title) + " times.")
    print("note: All integer kernels of a tick in one (22 low-passes, five fingertips, distances "
          "with the freeze rule, laws): "
          "%.0f instructions." % cost["tick", "fixed"])


def label_of(row):
    return (row["estimator"] if row["estimator"].split("_")[0] in ("double", "float")
            else "exhand " + row["estimator"])


SECTIONS = {
    "filter": filters,
    "sine": sines,
    "law": lambda: kernel("law", "law", "N", 1e-17, 1,
                          (("1", ", after 1 s"), ("3600", ", after 1 h"))),
    "law_drift": lambda: drift("law_drift", "law", 1e-17),
    "table": lambda: kernel("table", "table", "ppm", 1e-11),
    "hand": lambda: kernel("hand", "hand", "m", 1e-17),
    "precontact": lambda: kernel("precontact", "precontact", "m", 1e-17),
    "passivity": lambda: kernel("passivity", "passivity", "J", 1e-17, 1,
                                (("1", ", after 1 s"), ("3600", ", after 1 h"))),
    "passivity_drift": lambda: drift("passivity_drift", "passivity", 1e-17),
    "velocity": velocity,
    "soft": soft,
}


# Others' code: the sections that draw it, the file that says it is there, what is said if not.
PEERS = (
    (("filter", "sine", "law", "law_drift", "table", "hand"), "cmsisdsp-1.10.3/.complete",
     "CMSIS-DSP, which could not be fetched"),
    (("filter", "sine", "law", "law_drift", "table", "hand", "precontact", "passivity",
      "passivity_drift"),
     "libfixmath-20220222/.complete", "libfixmath, which could not be fetched"),
    (("filter", "sine"), "rust/release/libpeers.a", "idsp, which could not be built"),
    (("filter", "sine"), None, "fpm (C++), which no package registry in use here offers"),
)


def main():
    os.makedirs(OUT, exist_ok=True)
    SECTIONS[sys.argv[1]]()
    for sections, there, name in PEERS:
        if (sys.argv[1] in sections and
            not (there and
                 os.path.exists(os.path.join(os.environ.get("B", "build"), "peers", there)))):
            print("skipped: %s; of its points those measured once elsewhere stand, if any" % name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
