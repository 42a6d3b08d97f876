#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Mutants of the library's safety that `exhand-lab faults` must detect: errors planted one at a
time.

Each row: source, a text in it, its replacement, the arguments of exhand-lab faults, the promise
that it breaks. The arguments are TABLE: the table at one rate, or TIMES: so many random times. The
changed source is linked before the library. exhand-lab faults must end with status 1 and a WRONG,
which is printed with V=1.

    faults_mutants.py [--some N] [--seed S] OBJECTS... LIBRARIES...

CC: the compiler (cc). --some N: every Nth, as the seed chooses them.

Exit status: 0 all detected, 1 not, or one that cannot be planted; 2 bad usage.
"""

import argparse
import glob
import os
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
CC = os.environ.get("CC", "cc").split()
FLAGS = "-std=c99 -O1 -w -Ilib/include".split()
TABLE = ["--rate", "1000"]
TIMES = ["--times", "1200"]

MUTANTS = (
    ("safety", "s->steps, add_sat(missed, 1)", "s->steps, 1", TIMES,
     "missed ticks are steps of a release"),
    ("safety", "s->state == EXH_STATE_RELEASE && s->steps >= cfg->release_ticks",
     "s->state == EXH_STATE_RELEASE && s->steps >= 3 * cfg->release_ticks", TABLE,
     "a release ends"),
    ("safety", "if (!(in->din & EXH_DIN_DEADMAN)) { c |= EXH_FAULT_DEADMAN; }", "", TABLE,
     "an open dead-man switch is a cause"),
    ("safety", "if (!(in->din & EXH_DIN_ESTOP)) { c |= EXH_FAULT_ESTOP; }", "", TABLE,
     "so is the e-stop"),
    ("safety", "if (!(in->din & EXH_DIN_WATCHDOG)) { c |= EXH_FAULT_WATCHDOG; }", "", TABLE,
     "so is a watchdog that fired"),
    ("safety", "if ((in->din & drives) != drives)", "if (0)", TABLE,
     "a drive in use must be ready"),
    ("safety", "ON(CUT, s->present & EXH_FAULT_CUT) |", "", TABLE, "a hard cause cuts"),
    ("safety", "/* run     */ {F, F, F, F, E,", "/* run     */ {F, E, F, F, E,", TABLE,
     "CUT in RUN is no release"),
    ("safety", "/* limit   */ {F, F, F, F, E,", "/* limit   */ {F, E, F, F, E,", TABLE,
     "nor in LIMIT"),
    ("safety", "/* arm     */ {O, F, F, F, E,", "/* arm     */ {O, F, F, F, A,", TABLE,
     "a cause in the ramp releases"),
    ("safety", "/* release */ {F, F, F, O, E,", "/* release */ {F, E, F, O, E,", TABLE,
     "a cut is a cut in RELEASE, too"),
    ("safety", "/* release */ {F, F, F, O, E, E, F, F, E,",
     "/* release */ {F, F, F, O, E, E, F, F, R,", TIMES, "RUN does not end a release"),
    ("safety", "s->state = exh_safety_next[before][s->trigger];",
     "s->state = exh_safety_next[before][s->trigger]; if (s->state == EXH_STATE_FAULT && "
     "s->present == 0) { s->faults = 0; s->state = EXH_STATE_OFF; }",
     TABLE, "a fault stays when its cause is gone"),
    ("safety", "!s->present &&\n                         s->opened", "!s->present", TIMES,
     "CLEAR wants the dead-man let go and taken"),
    ("safety", "if (s->late > cfg->late_max)", "if (s->late > 2 * cfg->late_max)", TIMES,
     "more than one tick missed is an overrun"),
    ("safety", "if (!sane(s))", "if (0)", TABLE, "a state that is none is a fault"),
    ("gate", "= (uint8_t)(open ? (1u << n) - 1u : 0u);", "= (uint8_t)((1u << n) - 1u);", TABLE,
     "a gate that is shut enables none"),
    ("gate", "open ? exh_sat32(asked) : 0", "exh_sat32(asked)", TIMES,
     "nor lets a current through"),
    ("drive", "(int32_t)exh_gain_floor(permit->fall, s->force_N_q20) + 1;",
     "(int32_t)exh_gain_floor(permit->fall, s->force_N_q20) / 2 + 1;", TABLE, "zero in R ticks"),
    ("drive", "if (permit->mode == EXH_PERMIT_RELEASE) {", "if (0) {", TABLE,
     "a law that lost its inputs does not speak"),
    ("motion", "return (s->fast_ticks >= cfg->speed_ticks ?",
     "return (s->fast_ticks > cfg->speed_ticks ?", TABLE, "a string that runs is told"),
    ("motion", "s->stuck_ticks >= cfg->stuck_ticks ?", "s->stuck_ticks > cfg->stuck_ticks ?", TABLE,
     "an encoder that stands is told"),
    ("integrity", "if (exh_params_verify(g->params)) { g->broken = 1; }", "", TABLE,
     "a parameter that changed is told"),
    ("integrity", "if (g->crc != g->want) { g->broken = 1; }", "", TABLE,
     "a table that changed is told"),
    ("supply", "return s->off_ticks >= cfg->ticks;", "return 0;", TABLE,
     "a supply outside its limits is told"),
    ("supply", "raw <= cfg->max_raw", "1", TABLE, "above them, too"),
    ("chatter", "s->net_Acnt_q20 >= cfg->energy_Acnt_q20", "0", TABLE,
     "a contact that buzzes is told"),
    ("tracking", "return s->off_ticks >= cfg->ticks;", "return s->off_ticks >= 40 * cfg->ticks;",
     TABLE, "a monitor that does not follow is told in time"),
)


def plant(where, source, old, new):
    path = next(glob.iglob(os.path.join(ROOT, "lib/src/*", source + ".c")))
    with open(path) as f:
        text = f.read()
    if old not in text:
        raise ValueError("not in %s.c, whoever changed that changes its mutant" % source)
    to = os.path.join(where, source + ".c")
    with open(to, "w") as f:
        f.write(text.replace(old, new, 1))
    return to


def told(mutant, link):
    """The WRONG of this mutant, '' for none, or raises ValueError."""
    source, old, new, asked, _ = mutant
    with tempfile.TemporaryDirectory() as where:
        exe, obj = os.path.join(where, "exhand"), os.path.join(where, source + ".o")
        for command in (CC + FLAGS + ["-c", plant(where, source, old, new), "-o", obj],
                        CC + ["-o", exe, obj] + link):
            built = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
            if built.returncode:
                raise ValueError(built.stderr.strip().split("\n")[0])
        ran = subprocess.run([exe, "faults", *asked, "--jobs", "1"], cwd=ROOT, capture_output=True,
                             text=True, timeout=600)
        if ran.returncode not in (0, 1):
            raise ValueError("status %d: %s" % (ran.returncode, ran.stderr))
        wrong = [s for s in ran.stdout.split("\n") if "WRONG" in s]
        return wrong[0] if ran.returncode == 1 and wrong else ""


def ask(mutant, link):
    try:
        return told(mutant, link), ""
    except ValueError as e:
        return "", str(e)


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--some", type=int, default=1, metavar="N")
    p.add_argument("--seed", type=int, default=1, metavar="S")
    p.add_argument("link", nargs="+")
    a, libraries = p.parse_known_args()
    wanted = (random.Random(a.seed).sample(MUTANTS, -(-len(MUTANTS) // a.some)) if a.some > 1
              else MUTANTS)
    bad = 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for m, (wrong, error) in zip(wanted,
                                     pool.map(lambda m: ask(m, a.link + libraries), wanted)):
            bad += not wrong
            if error or not wrong:
                print("faults_mutants: not told: %s: %s.c: %s -> %s%s" %
                      (m[4], m[0], m[1], m[2] or "nothing", error and ": " + error))
            elif os.environ.get("V"):
                print("%s: %s" % (m[4], wrong))
    print("faults: %d errors planted, %d not told" % (len(wanted), bad))
    return 1 if bad or not wanted else 0


if __name__ == "__main__":
    sys.exit(main())
