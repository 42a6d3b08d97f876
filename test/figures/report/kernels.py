#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Kernels: error over cost, from what `make bench` has left in B/bench; CSV and panels into OUT."""

import csv
import math
import os
import sys

import work

BENCH = os.path.join(os.environ.get("B", "build"), "bench")
OUT = os.environ.get("OUT", "build/report")
RATIOS = ("0.0001", "0.01", "0.4")
STEEP = 0.105  # of the rate: above it ours is of another kind


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


def judged(points, where=""):
    """In which panels is one of ours on the front, alone or beside others?"""
    on = work.on_front(points)
    off = [k for k, v in on.items() if not v]
    alone = [k for k in on
             if all(p.kind == "ours" for p in work.front([q for q in points if q.panel == k]))]
    print("note: %sOurs is on the front of integer code in %d of %d panels, alone on it in %d%s." %
          (where, len(on) - len(off), len(on), len(alone),
           "; not in: " + "; ".join(off) if off else ""))


COSTS = (("x64", "x86-64", "instructions"), ("i686", "i686", "instructions"),
         ("ns", "x86-64 here", "ns"))


def counted(row, cost):
    return row.get(cost, "") not in ("", "-")


def filters():
    """rms of a step at three cut-offs; times are of one of the cheap kind."""
    costs, points, labels = {r["name"]: r for r in rows_of("filters.csv")}, [], []
    swept = [r for r in rows_of("sweep.csv") if r["input"] == "step"]
    for cost, title, unit in COSTS[:2]:
        for ratio in RATIOS:
            key = cost + ("_high" if float(ratio) > STEEP else "")
            mine = [r for r in swept if r["fc_fs"] == ratio and counted(costs[r["name"]], key)]
            points += [work.Point("%s, fc/fs = %s" % (title, ratio), r["name"], kind_of(r["name"]),
                                  costs[r["name"]][key], r["rms_ppm"]) for r in mine]
            labels += [unit + ", 22 channels"] if mine else []
    save("filter", next(iter(costs.values())).keys(), [r.values() for r in costs.values()])
    shown = [p for p in points if p.panel.startswith(COSTS[0][1])]  # i686 is in the table
    work.draw(OUT, "filter", shown, 1e-10, labels[0], "rms error of a step (ppm)")
    judged(points)


def filter_range():
    """rms and peak over fc/fs, of three inputs; a table of the worst over the range."""
    rows = rows_of("sweep.csv")
    names = list(dict.fromkeys(r["name"] for r in rows))
    at = {(r["name"], r["fc_fs"], r["input"], m): r[m + "_ppm"] for r in rows
          for m in ("rms", "max")}
    ratios = sorted({r["fc_fs"] for r in rows}, key=float)
    inputs = ("step", "square", "noise")
    save("filter_range", ["fc_fs", "input", "measure"] + names,
         [[f, i, m] + [at.get((n, f, i, m), "nan") for n in names]
          for m in ("rms", "max") for i in inputs for f in ratios])
    with open(os.path.join(OUT, "filter_range.md"), "w", encoding="utf-8") as f:
        f.write("Worst over fc/fs %s to %s, ppm of full scale: rms; peak:\n\n| | %s |\n%s|\n" % (
            ratios[0], ratios[-1], " | ".join(inputs), "|--" * 4))
        for n in names:
            worst = [[max((float(r[m + "_ppm"]) for r in rows
                           if r["name"] == n and r["input"] == i),
                          key=lambda e: math.inf if math.isnan(e) else e)
                      for m in ("rms", "max")] for i in inputs]
            f.write("| %s | %s |\n" % (n, " | ".join(
                "unstable" if math.isnan(rms) else "%.2g; %.2g" % (rms, peak)
                for rms, peak in worst)))


def sines():
    rows, points = rows_of("sines.csv"), []
    for cost, title, unit in COSTS:
        points += [work.Point(title, r["name"], kind_of(r["name"]), r[cost], r["worst_ppm"])
                   for r in rows if counted(r, cost)]
    save("sine", rows[0].keys(), [r.values() for r in rows])
    work.draw(OUT, "sine", points, 1e-10,
              [u for c, _, u in COSTS if any(counted(r, c) for r in rows)], "peak error, ppm")
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
    work.draw(OUT, name, points, floor, labels, "peak error, " + unit, len(labels) // len(when))
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


def estimates():
    """Velocities of an encoder of 15.7 um."""
    return [r for r in rows_of("velocity.csv") if r["source"] == "measured" and
            r["step_um"] == "15.7"]


def label_of(row):
    return ("exhand " if row["kernel"].startswith("velocity_") else "") + row["estimator"].replace(
        "_", " ")


def velocity():
    """Noise and lag over cost, and over each other."""
    cost_of = {r["name"]: r for r in rows_of("work.csv") +
               [dict(r, x64=r["instructions"], i686=r["instructions_i686"])
                for r in rows_of("bench.csv")]}
    rows, points, labels = estimates(), [], []
    for cost, cpu in (("x64", "x86-64"), ("i686", "i686")):
        for title, key in (("rms noise at 10 mm/s (mm/s)", "rms_10mmps"), ("lag (ms)", "lag_ms"),
                           ("rms on a sine (mm/s)", "sine_rms_mmps")):
            mine = [r for r in rows if counted(cost_of[r["kernel"]], cost)]
            points += [work.Point(title + (" " if cost == "i686" else ""), label_of(r),
                                  kind_of(label_of(r)), cost_of[r["kernel"]][cost], r[key])
                       for r in mine]
            labels += ["instructions, " + cpu] if mine else []
    points += [work.Point("rms noise (mm/s) over lag", label_of(r), kind_of(label_of(r)),
                          r["lag_ms"], r["rms_10mmps"]) for r in rows]
    labels.append("lag (ms)")
    save("velocity", rows[0].keys(), [r.values() for r in rows])
    shown = {p.panel for p in points if not p.panel.endswith(" ") and "sine" not in p.panel}
    work.draw(OUT, "velocity", [p for p in points if p.panel in shown], 1e-3,
              [labels[0], labels[0], labels[-1]], "error (unit above)", 3, False)
    judged(points)


def cortex(cpu):
    """Errors are those of this machine, which has the same formats."""
    wrong = {("filter", r["name"]): r["rms_ppm"] for r in rows_of("sweep.csv")
             if (r["fc_fs"], r["input"]) == ("0.01", "step")}
    wrong["filter_high", "exhand"] = next(r["rms_ppm"] for r in rows_of("sweep.csv") if (
        r["name"], r["fc_fs"], r["input"]) == ("exhand", "0.4", "step"))
    wrong.update((("sine", r["name"]), r["worst_ppm"]) for r in rows_of("sines.csv"))
    wrong.update((("velocity", r["kernel"]), r["rms_10mmps"]) for r in estimates())
    wrong.update(((r["kernel"], r["name"]), r["max"]) for r in rows_of("work.csv")
                 if r["when"] == ("3600" if r["kernel"] == "law" else "all"))
    title = {"filter": "22 low-passes, 0.01 (rms, ppm)", "sine": "sine and cosine (peak, ppm)",
             "law": "5 laws, after 1 h (peak, N)", "table": "table (peak, ppm)",
             "velocity": "velocity (rms noise, mm/s)",
             "precontact": "5 distances, freeze (peak, m)"}
    rows = [dict(r, error=wrong.get((r["kernel"], r["name"]), "-")) for r in rows_of("soft.csv")
            if r["cpu"] == cpu]
    named = {r["kernel"]: label_of(r) for r in estimates()}
    points = [work.Point(title[k], n, kind_of(n), r["instructions"], r["error"])
              for k in title for r in rows if r["kernel"] == k
              for n in [named.get(r["name"], r["name"])]]
    save("cortex_" + cpu, rows[0].keys(), [r.values() for r in rows])
    work.draw(OUT, "cortex_" + cpu, points, 1e-17, "instructions", "error", 3, False)
    where = "On a Cortex-%s: " % cpu.upper()
    judged(points, where)
    cost = {(r["kernel"], r["name"]): float(r["instructions"]) for r in rows}
    ours = {k: v for (k, n), v in cost.items() if n.startswith("exhand") and n != "exhand-cheap"}
    times = {k: ["%.1f" % (v / ours[k]) for (j, n), v in cost.items()
                 if j == k and n.startswith("plain")] for k in ours}
    print("note: %splain double and float cost so many times ours: %s." % (where, "; ".join(
        "%s %s" % (k, " and ".join(v)) for k, v in times.items() if v)))
    print("note: %sabove fc/fs = %s the 22 low-passes take %.0f instructions. All integer kernels "
          "of a tick in one (22 low-passes, fingertips, distances, laws of five fingers): %.0f."
          % (where, STEEP, cost["filter_high", "exhand"], cost["tick", "exhand"]))


SECTIONS = {
    "filter": filters,
    "filter_range": filter_range,
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
    "cortex_m3": lambda: cortex("m3"),
    "cortex_m4": lambda: cortex("m4"),
}


# Others' code: the sections that draw it, the file that says it is there, what is said if not.
PEERS = (
    ("filter filter_range sine law law_drift table hand cortex_m3 cortex_m4",
     "cmsisdsp-1.10.3/.complete", "CMSIS-DSP, which could not be fetched"),
    ("filter filter_range sine law law_drift table hand precontact passivity passivity_drift",
     "libfixmath-20220222/.complete", "libfixmath, which could not be fetched"),
    ("sine", "rust/release/libpeers.a", "idsp's sine, which could not be built"),
)


def main():
    os.makedirs(OUT, exist_ok=True)
    for name in sys.argv[1:]:
        SECTIONS[name]()
        for sections, there, what in PEERS:
            if name in sections.split() and not os.path.exists(
                    os.path.join(os.environ.get("B", "build"), "peers", there)):
                print("skipped: " + what)
    return 0


if __name__ == "__main__":
    sys.exit(main())
