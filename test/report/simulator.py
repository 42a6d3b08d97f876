#!/usr/bin/env python3
"""Simulator: error over cost of ways to integrate its plant, from B/bench/sim_work; CSV into OUT."""

import csv
import glob
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
    """Instructions of a second of each problem, method and step, by callgrind; short steps from the last counted."""
    with tempfile.TemporaryDirectory() as tmp:
        order = lines("valgrind", "-q", "--tool=callgrind", "--callgrind-out-file=%s/cg" % tmp, "--collect-atstart=no",
                      "--toggle-collect=work_run", "--dump-after=work_run", WORK, "count", *SHORT)
        total = {}
        for path in glob.glob(tmp + "/cg.*"):
            with open(path, encoding="utf-8", errors="replace") as f:
                m = re.search(r"^totals: (\d+)", f.read(), re.M)
            total[int(path.rsplit(".", 1)[1])] = int(m[1]) if m else 0
    out = {}
    for i, line in enumerate(order):
        problem, method, step, seconds = line.split(",")
        out[problem, method, step] = total[i + 1] / float(seconds)
    return out


def cost_of(count, key):
    if key in count:
        return count[key]
    longer = [k for k in count if k[:2] == key[:2] and float(k[2]) > float(key[2]) and k[2] != "2.5e-05"]
    last = min(longer, key=lambda k: float(k[2]))
    return count[last] * float(last[2]) / float(key[2])


def main():
    os.makedirs(OUT, exist_ok=True)
    if not shutil.which("valgrind"):
        print("simulator: valgrind is missing")
        return 3
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
