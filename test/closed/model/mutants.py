#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Small errors of simulator and analysis, planted one at a time: its check must detect each.

    mutants.py DIR [NUMBER...]    in a copy of the tree in DIR; all, or these
    mutants.py --texts            can each still be planted? (`make gate`)

None of the checks is a digest, and none compares printed digits with a document. Exit status: 0 all
detected, 1 not, or one that cannot be planted. Standard library only; `make gate-mutants`.
"""

import os
import shutil
import subprocess
import sys

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))
GATE = ["test/closed/model/gate.py", "check", "build/posix/exhand", "--again", "0"]


def test(name):
    return ["build/test/sim/%s_test" % name]


# source, text in it, its replacement, the check, required text in the check's output
MUTANTS = [
    ("ports/posix/falls/pairs.c", "FALL_WINDOW / 2]", "FALL_WINDOW / 2 - 1]", GATE,
     "FAIL analysis", "the fifth force of ten"),
    ("ports/posix/falls/fall.c", ".band_hi_N = 4.5", ".band_hi_N = 4.45", GATE, "FAIL analysis",
     "a band to 4.45 N"),
    ("ports/posix/falls/rest.c", ".travel_m = 0.25e-3", ".travel_m = 0.26e-3", test("rest"),
     "the_limits_are_those_that_are_told", "rest within 0.26 mm"),
    ("ports/posix/sim/plant.c", "s.half_mass * d->mu_mass;", "s.half_mass * d->mu_motor;",
     test("plant"), "friction_is_of_second_order", "the mass has the motor's friction"),
    ("ports/posix/sim/codes.h", "d->mon_noise_a * sim_random_bell(r)",
     "0.95 * d->mon_noise_a * sim_random_bell(r)", test("chance"),
     "the_monitors_noise_is_as_wide_as_its_row", "5 % less noise"),
    ("ports/posix/sim/mass.c", "m->servo_s = now_s + sim_random_unit(&m->rng) / d->servo_hz;",
     "m->servo_s = now_s + 0.5 / d->servo_hz;", test("chance"),
     "each_fall_has_its_own_clock_and_height", "a drive's clock that is not chance"),
    ("ports/posix/falls/jackknife.c", "2.2622", "2.2262", test("chance"),
     "the_quantile_is_students", "t of ten falls"),
    ("ports/posix/box/run.c", '{"q_lim", wall_m(c)}',
     '{"q_lim", wall_m(c) + 0.02 * c->board.device.step_m}', GATE, "FAIL analysis",
     "a wall 0.02 counts off in the scene"),
    ("ports/posix/sim/codes.h", "+ phase) * step_m", "+ phase + 0.02) * step_m", GATE,
     "FAIL analysis", "a wall 0.02 counts off where it is made"),
    ("test/lab/glove/table1.c", "<= span", "< span", test("glove_table1"), "FAILED",
     "a stable bit less"),
]


def planted(tree, source, old, new):
    path = os.path.join(tree, source)
    with open(path) as f:
        text = f.read()
    if text.count(old) != 1:
        return None
    with open(path, "w") as f:
        f.write(text.replace(old, new))
    return path, text


def built(tree, check):
    goals = ["all", "lab"] + [c for c in check[:1] if c.startswith("build/")]
    done = subprocess.run(["make", "-s", "--no-print-directory"] + goals, cwd=tree,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        print(done.stdout[-2000:])
    return done.returncode == 0


def run(tree, check):
    done = subprocess.run(check, cwd=tree, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True)
    return done.returncode, done.stdout


def try_one(tree, mutant):
    """1 unless it is detected."""
    source, old, new, check, says, what = mutant
    was = planted(tree, source, old, new)
    if was is None:
        print("CANNOT be planted: %s: %s" % (source, what))
        return 1
    try:
        if not built(tree, check):
            print("DOES NOT compile: %s" % what)
            return 1
        status, said = run(tree, check)
    finally:
        with open(was[0], "w") as f:
            f.write(was[1])
    told = status != 0 and says in said
    print("%s: %s (%s: %s)" % ("told" if told else "NOT TOLD", what, os.path.basename(check[0]),
                               says), flush=True)
    return 0 if told else 1


def texts():
    """1 if one of them is no text of its source any more: then nothing could be planted."""
    lost = []
    for source, old, _, _, _, what in MUTANTS:
        with open(os.path.join(ROOT, source)) as f:
            lost += [(source, what)] if f.read().count(old) != 1 else []
    for where in lost:
        print("CANNOT be planted: %s: %s" % where)
    return 1 if lost else 0


def main():
    if sys.argv[1] == "--texts":
        return texts()
    tree = os.path.join(os.path.abspath(sys.argv[1]), "tree")
    some = [MUTANTS[int(n) - 1] for n in sys.argv[2:]] or MUTANTS
    shutil.rmtree(tree, ignore_errors=True)
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, stdout=subprocess.PIPE, text=True,
                           check=True).stdout.split("\0")
    for name in filter(None, files):
        to = os.path.join(tree, name)
        os.makedirs(os.path.dirname(to), exist_ok=True)
        shutil.copy2(os.path.join(ROOT, name), to)
    failed = 0
    for check in {tuple(m[3]) for m in some}:  # each passes without an error
        ok = built(tree, list(check)) and run(tree, list(check))[0] == 0
        failed += not ok
        if not ok:
            print("FAILS with nothing planted: %s" % " ".join(check))
    failed += sum(try_one(tree, m) for m in some)
    shutil.rmtree(tree)
    print("%d passed, %d failed" % (len(some) - min(failed, len(some)), failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
