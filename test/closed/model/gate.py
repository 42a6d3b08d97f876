#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The simulated drop experiment beside a model and an analysis that share no code with it.

    gate.py sample EXHAND [--runs N]   falls.csv anew: N runs a rate by the model of plant.py (60)
    gate.py check EXHAND [--again N]   1 if something differs:
        device   falls.csv is of the device and scene that EXHAND has
        again    N runs of falls.csv (6), drawn, are made anew: the same digits
        analysis of 20 runs a rate of EXHAND, from its CSVs by falls.py: A, B, its interval, r2,
                 falls that rest, where the wall is: the same digits as in its runs.csv
        falls    of these runs impact speed, depth, rest position, contacts of a fall, A, B, r2:
                 each mean beside the model's, two-sided

Work goes to a separate directory that is removed. Standard library only.
"""

import argparse
import csv
import math
import multiprocessing
import os
import random
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import falls  # noqa: E402
import plant  # noqa: E402

TABLE = os.path.join(HERE, "falls.csv")
GAINS = {90: (1500, 0), 100: (2000, 0), 200: (2000, 15), 500: (6000, 20), 1000: (10000, 40),
         2000: (20000, 60)}
SCENE = ("f0", "f0_band", "f_max", "slew_up", "vel_p")
QUANTITIES = ("impact_m_per_s", "depth_m", "rest_m", "contacts", "ln_a", "ln_b", "r2")
SEED, RUNS = 1001, 20
SURE = 4.5  # standard errors
# Allowed difference of two integrators: a share of the quantity. For ln and r2 it is absolute.
ROOM = {"impact_m_per_s": 0.003, "depth_m": 0.005, "rest_m": 0.005, "contacts": 0.02,
        "ln_a": 0.005, "ln_b": 0.005, "r2": 0.002}


def number(word):
    try:
        return float(word)
    except ValueError:
        return None


def values(text):
    """Name and first number of each line of --params."""
    found = {}
    for line in text.splitlines():
        words = line.split()
        numbers = [v for v in map(number, words[1:]) if v is not None]
        if line.startswith("  ") and numbers:
            found[words[0]] = numbers[0]
    return found


def device_of(exhand):
    out = subprocess.run([exhand, "drop", "--params"], check=True, stdout=subprocess.PIPE,
                         text=True).stdout
    scene, device = out.split("The simulated device")
    scene = values(scene)
    return {n: scene[n] for n in SCENE}, values(device)


def summary(seen, stiff):
    """The seven quantities of a run; None: no stiffness."""
    n = len(seen)
    means = [math.fsum(s[i] for s in seen) / n for i in range(4)]
    return means + ([None] * 3 if stiff is None else
                    [math.log(stiff[0]) if stiff[0] > 0 else None, math.log(stiff[1]), stiff[2]])


def digits(v):
    return "" if v is None else "%.6g" % v


def model_run(job):
    scene, device, rate, seed = job
    k, b = GAINS[rate]
    lim_m, done = plant.run(device, rate, k, b, scene, random.Random("%d %d" % (rate, seed)))
    if any(f is None for f in done):
        return None
    return [digits(v) for v in summary([falls.seen(f, lim_m, 1.0 / rate) for f in done],
                                       falls.stiffness(done))]


# --- the committed sample ---

def sample(exhand, runs):
    scene, device = device_of(exhand)
    jobs = [(scene, device, rate, seed) for rate in GAINS for seed in range(runs)]
    with multiprocessing.Pool() as pool:
        rows = []
        for job, row in zip(jobs, pool.imap(model_run, jobs)):
            rows.append([job[2], job[3]] + row)
            if sys.stderr.isatty():
                sys.stderr.write("\rgate: %d of %d runs " % (len(rows), len(jobs)))
    with open(TABLE, "w") as f:
        f.write("# Falls by the model of plant.py: `make gate-sample`. Means of ten falls a run.\n")
        for name, v in list(scene.items()) + list(device.items()):
            f.write("# %s=%.12g\n" % (name, v))
        f.write("rate_hz,run,%s\n" % ",".join(QUANTITIES))
        f.writelines("%s\n" % ",".join(map(str, row)) for row in rows)
    return 0


def kept():
    """({name: value}, [rows as text])"""
    with open(TABLE) as f:
        lines = f.read().splitlines()
    told = dict(line[2:].split("=") for line in lines if re.match(r"# \w+=", line))
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return {n: float(v) for n, v in told.items()}, rows


# --- what EXHAND makes ---

def cut(path, T_s):
    """The falls of a CSV: it has gaps of time between them."""
    out, last = [], None
    with open(path) as f:
        next(f)
        for line in f:
            w = line.split(",")
            t = float(w[0])
            if last is None or t - last > 1.5 * T_s:
                out.append([])
            out[-1].append((t, float(w[1]), float(w[6]), w[5] == "1"))
            last = t
    return out


def observed(fall, observe_s, T_s):
    first = next(t[0] for t in fall if t[3])
    return [t for t in fall if t[0] < first + observe_s - T_s / 2]


def exhand_run(job):
    """[(rate, row of runs.csv, stiffness, falls that rest, summary, wrong contacts)] of a seed."""
    exhand, device, seed, phase = job
    with tempfile.TemporaryDirectory() as where:
        subprocess.run([exhand, "drop", "--runs", "1", "--seed", str(seed), "--jobs", "1", "--out",
                        where] + (["--phase", str(phase)] if phase is not None else []), check=True,
                       stdout=subprocess.DEVNULL)
        with open(os.path.join(where, "runs.csv")) as f:
            rows = list(csv.DictReader(f))
        done = []
        for row in rows:
            rate = int(row["rate_hz"])
            all_ticks = cut(os.path.join(where, "drop_%dHz.csv" % rate), 1.0 / rate)
            watched = [observed(f, device["observe"], 1.0 / rate) for f in all_ticks]
            lim_m = plant.wall_m(device, phase if phase is not None else float(row["wall_phase"]))
            stiff = falls.stiffness(all_ticks)
            room_m = 1e-4 * device["step"] / device["decode"]  # the digits of the phase
            wrong = sum((t[1] >= lim_m) != t[3] for f in all_ticks for t in f
                        if abs(t[1] - lim_m) > room_m)
            seen = [falls.seen(f, lim_m, 1.0 / rate) for f in watched]
            done.append((rate, row, stiff, sum(map(falls.rests, watched)), summary(seen, stiff),
                         wrong))
    return done


# --- the checks: each yields what differs ---

def check_device(scene, device, told):
    for name, v in list(scene.items()) + list(device.items()):
        if told.get(name) is None or abs(told[name] - v) > 1e-9 * abs(v):
            yield "%s is %.9g, falls.csv is of %s: make gate-sample" % (name, v, told.get(name))


def check_again(scene, device, rows, again):
    some = random.SystemRandom().sample(rows, again)
    jobs = [(scene, device, int(r["rate_hz"]), int(r["run"])) for r in some]
    with multiprocessing.Pool() as pool:
        for row, got in zip(some, pool.map(model_run, jobs, chunksize=1)):
            want = [row[q] for q in QUANTITIES]
            if got != want:
                yield "%s Hz, run %s: %s, kept %s" % (row["rate_hz"], row["run"], got, want)


def differs(name, said, got, b_Npm):
    """By more than the six digits of runs.csv; half an interval, m/N, by more than those of t."""
    digits_of = 1e-5 * abs(got)
    if not name.startswith("ci"):
        return abs(said - got) > digits_of
    return abs(1 / said - 1 / got) > 5e-5 * abs(1 / got - 1 / b_Npm) + digits_of / got ** 2


def check_analysis(done):
    """Of one rate of a run: what falls.py and runs.csv do not say alike."""
    rate, row, stiff, rests, _, wrong = done
    where = "%d Hz, seed %s: " % (rate, row["seed"])
    names = ("stiffness_a_n_per_m", "stiffness_b_n_per_m", "r2", "ci_low", "ci_high")
    for name, got in zip(names, stiff or [None] * 5):
        said = number(row[name])
        if (said is None) != (got is None or math.isinf(got)) or (
                said is not None and differs(name, said, got, stiff[1])):
            yield "%s%s is %s, by falls.py %s" % (where, name, row[name], got)
    at_rest = int(row["falls"]) - int(row["oscillating_falls"])
    if at_rest != rests:
        yield "%s%d falls rest, by falls.py %d" % (where, at_rest, rests)
    if wrong:
        yield "%scontact and wall disagree in %d ticks" % (where, wrong)


def statistics(v):
    n = len(v)
    mean = math.fsum(v) / n
    return mean, math.sqrt(math.fsum((x - mean) ** 2 for x in v) / (n - 1) / n), n


def check_falls(rows, done):
    print("  rate  quantity            model                exhand      off, limit")
    for rate in GAINS:
        for i, q in enumerate(QUANTITIES):
            want = [float(r[q]) for r in rows if int(r["rate_hz"]) == rate and r[q]]
            got = [d[4][i] for d in done if d[0] == rate and d[4][i] is not None]
            if len(got) < RUNS / 2 or len(want) < RUNS:
                yield "%d Hz, %s: only %d and %d runs have it" % (rate, q, len(want), len(got))
                continue
            (m, m_se, _), (e, e_se, _) = statistics(want), statistics(got)
            room = ROOM[q] * (1 if q in ("ln_a", "ln_b", "r2") else abs(m))
            limit = SURE * math.hypot(m_se, e_se) + room
            print("%6d  %-15s %10.5g +- %-8.2g %10.5g +- %-8.2g %8.2g %8.2g" %
                  (rate, q, m, m_se, e, e_se, e - m, limit))
            if abs(e - m) > limit:
                yield "%d Hz, %s: %.5g, by the model %.5g, limit %.2g" % (rate, q, e, m, limit)


def told(name, wrong):
    wrong = list(wrong)
    for line in wrong[:10]:
        print("FAIL %s: %s" % (name, line))
    print("%s: %s" % (name, "%d differ" % len(wrong) if wrong else "ok"), flush=True)
    return bool(wrong)


def check(exhand, again):
    scene, device = device_of(exhand)
    of, rows = kept()
    bad = told("device", check_device(scene, device, of))
    if bad:
        return 1
    bad |= told("again", check_again(scene, device, rows, again))
    jobs = [(exhand, device, SEED + n, None) for n in range(RUNS)]
    jobs += [(exhand, device, SEED, phase) for phase in (0.01, 0.99)]
    with multiprocessing.Pool() as pool:
        ran = pool.map(exhand_run, jobs, chunksize=1)
    bad |= told("analysis", [w for run in ran for d in run for w in check_analysis(d)])
    bad |= told("falls", check_falls(rows, [d for run in ran[:RUNS] for d in run]))
    return int(bad)


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("what", choices=("sample", "check"))
    p.add_argument("exhand")
    p.add_argument("--runs", type=int, default=60)
    p.add_argument("--again", type=int, default=6)
    a = p.parse_args()
    return sample(a.exhand, a.runs) if a.what == "sample" else check(a.exhand, a.again)


if __name__ == "__main__":
    sys.exit(main())
