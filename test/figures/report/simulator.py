#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Simulator: error over cost of ways to integrate its plant, from B/bench/sim_work; CSV into
OUT."""

import csv
import glob
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

B = os.environ.get("B", "build")
OUT = os.environ.get("OUT", "build/report")
WORK = os.path.join(B, "bench", "sim_work")
SHORT = ["--short"] if os.environ.get("SHORT") else []
OWN = "0.00025" # the device's own step
KEY = ("problem", "method", "step_s")


def lines(*command):
    p = subprocess.run(command, text=True, stdout=subprocess.PIPE, check=False)
    if p.returncode:
        sys.exit("simulator: %s: status %d" % (" ".join(command), p.returncode))
    return p.stdout.splitlines()


def table(what):
    return list(csv.DictReader(lines(WORK, what, *SHORT)))


def key_of(row):
    return tuple(row[k] for k in KEY)


def counted():
    """Instructions of a second of each problem, method and step, by callgrind; short steps from the
    last counted."""
    order, total = profile("work_run", "work_run", WORK, "count", *SHORT)
    out = {}
    for i, line in enumerate(order):
        problem, method, step, seconds = line.split(",")
        out[problem, method, step] = total[i + 1] / float(seconds)
    return out


def cost_of(count, key):
    if key in count:
        return count[key]
    longer = [k for k in count if k[:2] == key[:2] and float(k[2]) > float(key[2]) and k[2] != OWN]
    last = min(longer, key=lambda k: float(k[2]))
    return count[last] * float(last[2]) / float(key[2])


def profile(fn, dump, *command):
    """What the command prints, and the instructions inside fn of each call of dump."""
    with tempfile.TemporaryDirectory() as tmp:
        said = lines("valgrind", "-q", "--tool=callgrind", "--callgrind-out-file=%s/cg" % tmp,
                     "--collect-atstart=no", "--toggle-collect=" + fn, "--dump-after=" + dump,
                     *command)
        total = {}
        for path in glob.glob(tmp + "/cg.*"):
            with open(path, encoding="utf-8", errors="replace") as f:
                m = re.search(r"^totals: (\d+)", f.read(), re.M)
            total[int(path.rsplit(".", 1)[1])] = int(m[1]) if m else 0
    return said, total


def apart(row, exact, what, error):
    """How far from the exact flow's mean, as a share of it and in standard errors of the
    difference."""
    a, b = float(row[what]), float(exact[what])
    se = math.hypot(float(row[error]), float(exact[error]))
    return a / b - 1, (a - b) / se if se else 0.0


def statistics():
    """simulator_rest: what becomes of Table II and of the time until rest, over what the plant
    costs."""
    program = os.path.join(B, "bench", "sim_statistics")
    said, total = profile("plant_advance_piece", "one_fall", program, *SHORT, "count")
    cost = {}
    for i, line in enumerate(said):
        method, step, seconds = line.split(",")
        cost[method, step] = total[i + 1] / float(seconds) # the second of two is kept
    rows = list(csv.DictReader(lines(program, *SHORT)))
    exact = {r["rate_Hz"]: r for r in rows if r["method"] == "flow"}
    with open(os.path.join(OUT, "simulator_rest_rows.csv"), "w", encoding="utf-8", newline="") as f:
        w = csv.DictWriter(f, rows[0].keys())
        w.writeheader()
        w.writerows(rows)
    with open(os.path.join(OUT, "simulator_rest.csv"), "w", encoding="utf-8", newline="") as f:
        w = csv.writer(f)
        w.writerow(["method", "step_us", "plant_instructions_per_s", "rest_time_off_percent",
                    "standard_errors", "at_Hz", "B_off_percent", "standard_errors", "at_Hz",
                    "at_rest_percent_least", "oscillate_percent_least"])
        for key in sorted(cost, key=lambda k: (k[0], -float(k[1]))):
            mine = [r for r in rows if (r["method"], r["step_s"]) == key]
            out = [key[0], "%g" % (1e6 * float(key[1])), "%.0f" % cost[key]]
            for what, error in (("rest_s", "rest_se"), ("b_Npm", "b_se")):
                off = [(apart(r, exact[r["rate_Hz"]], what, error), r["rate_Hz"]) for r in mine]
                (share, sigma), rate = max(off, key=lambda o: abs(o[0][1]))
                out += ["%.2f" % (100 * share), "%.1f" % sigma, rate]
            w.writerow(out + ["%.0f" % (100 * min(float(r[k]) for r in mine))
                              for k in ("rest", "oscillates")])


def main():
    os.makedirs(OUT, exist_ok=True)
    if not shutil.which("valgrind"):
        print("simulator: valgrind is missing")
        return 3
    if sys.argv[1:] == ["statistics"]:
        statistics()
        return 0
    print("\n".join(lines(WORK, "check")))
    count, ns = counted(), {key_of(r): r["ns_per_s"] for r in table("ns")}
    with open(os.path.join(OUT, "simulator.csv"), "w", encoding="utf-8", newline="") as f:
        w = csv.writer(f)
        w.writerow(KEY + ("error_m", "reference_m", "instructions_per_s", "ns_per_s"))
        for r in table("errors"):
            k = key_of(r)
            w.writerow(k + (r["error_m"], r["reference_m"], "%.0f" % cost_of(count, k), ns[k]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
