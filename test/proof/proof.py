#!/usr/bin/env python3
"""Proves the tick path, unit by unit (README.md).

A unit is a file eva/any_UNIT.c, whose first comment says what has to be known of it:

    PROVES: what it is about, a few words
    EVA: more options for Eva                        (may be missing)
    PLANT: file: text -> what it becomes             (an error that Eva has to tell; any number)

A unit of every/ is a program with the same comment that goes through every argument there is, built
to stop at undefined behaviour; it returns 0 if what it says holds of all.

With eva/UNIT.acsl, annotations are put into the copy of the source for Eva, in the form that the
files of wp/ have. Units that WP judges, too, stand in UNITS below.

  proof.py [--root DIR] [--out DIR] [--only UNIT,...] [--no-mutants] [--update] [--jobs N]

Exit 0 when every unit proves what counts.txt says and every planted error is told, 1 when not,
3 when a tool is missing.
"""
import argparse
import glob
import os
import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

sys.dont_write_bytecode = True

HERE = os.path.dirname(os.path.abspath(__file__))
COUNTS = os.path.join(HERE, "counts.txt")
BOTH = ("gcc_x86_64", "gcc_x86_32")

# Units with functions that WP judges: the source, and which.
WP = {
    "fix": ("lib/src/fix.c", ["exh_sat32", "exh_clamp"]),
    "gate": ("lib/src/gate.c", ["any_gate", "code_of", "exh_safety_open"]),
    "drive": ("lib/src/drive.c",
              ["no_force", "release", "exh_drive_force", "i2t_limit", "exh_drive_current"]),
    "track": ("lib/src/track.c", ["exh_track_step", "exh_track_coded"]),
}

# Planted errors that WP must tell: unit, in which functions, file, text, what it becomes.
MUTANTS = [
    ("gate", "code_of", "lib/src/gate.c", "exh_clamp(asked, -span, span)",
     "exh_clamp(asked, INT32_MIN, INT32_MAX)"),
    ("gate", "code_of", "lib/src/gate.c", "exh_clamp(asked, -span, span)",
     "exh_clamp(asked, -span - 1, span)"),
    ("gate", "code_of", "lib/src/gate.c", "dac_zero_raw + spanned, 0, UINT16_MAX)",
     "dac_zero_raw + spanned, 0, 2 * UINT16_MAX)"),
    ("gate", "any_gate", "lib/src/gate.c", "falls ? s->off_raw[k] : UINT16_MAX", "UINT16_MAX"),
    ("gate", "any_gate", "lib/src/gate.c", "= open ? exh_sat32(asked) : 0;", "= exh_sat32(asked);"),
    ("gate", "any_gate", "lib/src/gate.c", "cfg[k < n ? k : 0].par->dac_zero_raw", "out->dac_raw[k]"),
    ("drive", "exh_drive_force", "lib/src/drive.c", "exh_clamp(asked, 0, most)", "exh_clamp(asked, -most, most)"),
    ("drive", "exh_drive_force", "lib/src/drive.c", "exh_clamp(asked, 0, most)", "exh_clamp(asked, 0, INT32_MAX)"),
    ("drive", "release", "lib/src/drive.c", "rest > 0 ? (int32_t)rest : 0", "(int32_t)rest"),
    ("drive", "exh_drive_current", "lib/src/drive.c", "exh_clamp(peak, -hot, hot)", "exh_clamp(2 * (int64_t)peak, -2 * hot, 2 * hot)"),
    ("track", "exh_track_step", "lib/src/track.c", "s->off_ticks >= cfg->ticks", "s->off_ticks > cfg->ticks"),
]


def run(cmd, limit, env=None):
    try:
        p = subprocess.run(cmd, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=limit, env=env)
        return p.returncode, p.stdout.decode("utf-8", "replace")
    except subprocess.TimeoutExpired as e:
        return 124, (e.stdout or b"").decode("utf-8", "replace") + "\nstopped after %d s\n" % limit


def missing():
    """What is not here, and the line that installs it. Nothing is installed by this program."""
    apt, pip = [], []
    for tool, package in (("frama-c", "frama-c-base"), ("why3", "why3"), ("cvc4", "cvc4")):
        if shutil.which(tool) is None:
            apt.append(package)
    if not os.path.exists("/usr/bin/z3"):
        apt.append("z3")
    try:
        import z3  # noqa: F401
    except ImportError:
        pip.append("z3-solver")
    if apt:
        print("make proof: missing: sudo apt-get install -y --no-install-recommends " + " ".join(apt))
    if pip:
        print("make proof: missing: pip install " + " ".join(pip))
    return bool(apt or pip)


class Unit:
    """What the first comment of eva/any_NAME.c or every/NAME.c says."""

    def __init__(self, harness):
        self.harness = harness
        self.every = os.path.basename(os.path.dirname(harness)) == "every"
        self.name = os.path.basename(harness)[0 if self.every else 4:-2]
        self.about, self.options, self.plants = "", [], []
        with open(self.harness) as f:
            head = f.read().split("*/", 1)[0]
        for line in head.splitlines():
            key, _, rest = line.lstrip("/* ").partition(": ")
            if key == "PROVES":
                self.about = rest.strip()
            elif key == "EVA":
                self.options = rest.split()
            elif key == "PLANT":
                path, text = rest.split(": ", 1)
                old, new = text.split(" -> ", 1)
                self.plants.append((path, old.strip(), new.strip()))
        if not self.about:
            raise SystemExit(self.harness + ": PROVES: is missing")
        spec = os.path.join(HERE, "eva", self.name + ".acsl")
        self.spec = spec if os.path.exists(spec) else None


def units(only):
    found = [Unit(f) for d in ("eva/any_*.c", "every/*.c") for f in sorted(glob.glob(os.path.join(HERE, d)))]
    return [u for u in found if not only or u.name in only]


class Proof:
    def __init__(self, root, out):
        self.root, self.out, self.logs = root, out, []
        os.makedirs(out, exist_ok=True)
        # Debian's z3 is one that why3 knows; another may stand before it in the path.
        self.env = dict(os.environ, PATH="/usr/bin:" + os.environ["PATH"],
                        WHY3CONFIG=os.path.join(out, "why3.conf"))
        run(["why3", "config", "detect"], 120, self.env)

    def log(self, name, text):
        with open(os.path.join(self.out, name), "w") as f:
            f.write(text)

    def tree(self, name, change=None):
        """A copy of lib to work on, with one text changed."""
        at = os.path.join(self.out, name)
        shutil.rmtree(at, ignore_errors=True)
        shutil.copytree(os.path.join(self.root, "lib"), os.path.join(at, "lib"))
        if change:
            path, old, new = change
            put(os.path.join(at, path), lambda s: once(path, s, old).replace(old, new))
        return at

    def eva(self, unit, machdep, name, change=None):
        """Alarms, unproved assertions, proved assertions, whether it ran."""
        tree = self.tree(name + ".tree", change)
        if unit.spec:
            annotate(unit.spec, tree)
        flags = "-I%s/lib/src -I%s/lib/include -I%s/eva" % (tree, tree, HERE)
        code, said = run(["frama-c", "-cpp-extra-args=" + flags, "-machdep", machdep, "-eva",
                          "-eva-precision", "6", "-eva-split-return", "auto", "-warn-signed-downcast", "-eva-no-show-progress",
                          "-eva-msg-key=-initial-state,-final-states"] + unit.options + [unit.harness], 600, self.env)
        self.log(name + ".txt", said)
        shutil.rmtree(tree)
        alarms = re.search(r"(\d+) alarms? generated", said)
        stated = re.search(r"Assertions +(\d+) valid +(\d+) unknown +(\d+) invalid", said)
        needed = re.search(r"Preconditions +(\d+) valid +(\d+) unknown +(\d+) invalid", said)
        # Without the end in reach, nothing would be shown by the rest.
        if code != 0 or "Frama_C_show_each_end" not in said or "ANALYSIS SUMMARY" not in said:
            return 1, 1, 0, "ANALYSIS SUMMARY" in said
        valid = sum(int(m.group(1)) for m in (stated, needed) if m)
        open_ = sum(int(m.group(2)) + int(m.group(3)) for m in (stated, needed) if m)
        return int(alarms.group(1)) if alarms else 0, open_, valid, True

    def each(self, unit, name, change=None):
        """Whether it holds of every value, and whether it ran."""
        tree = self.tree(name + ".tree", change)
        program = os.path.join(self.out, name + ".bin")
        code, said = run(["gcc", "-std=c99", "-O2", "-fsanitize=undefined", "-fno-sanitize-recover=all",
                          "-I%s/lib/src" % tree, "-I%s/lib/include" % tree, unit.harness, "-o", program], 60)
        built = code == 0
        if built:
            code, said = run([program], 600)
        self.log(name + ".txt", said)
        shutil.rmtree(tree)
        return built and code == 0, built and code != 124

    def wp(self, unit, tree, name, seconds, functions=None):
        """Goals, proved, names of the others, provers. Of these functions, or all of the unit."""
        source, every = WP[unit]
        functions = functions or every
        for spec in sorted({"fix", unit}):
            annotate(os.path.join(HERE, "wp", spec + ".acsl"), tree)
        inline = ["-inline-calls", "exh_gate", "-remove-inlined", "exh_gate"] if unit == "gate" else []
        code, said = run(["frama-c", "-cpp-extra-args=-I%s/lib/include -I%s/lib/src" % (tree, tree),
                          "-machdep", "gcc_x86_64"] + inline +
                         ["-wp", "-wp-prover", "cvc4,z3", "-wp-timeout", str(seconds), "-wp-par", "2",
                          "-wp-fct", ",".join(functions), os.path.join(tree, source)], 900, self.env)
        self.log(name, said)
        total = re.search(r"Proved goals: +(\d+) / (\d+)", said)
        if code != 0 or not total:
            return 1, 0, ["(did not run: see %s)" % name], {}
        bad = [m.group(1) for m in re.finditer(r"^\[wp\] \[[^]]*\] Goal typed_(\S+).*$", said, re.M)
               if " : Valid" not in m.group(0)]
        by = dict(re.findall(r"^  (Qed|CVC4 [\d.]+|Z3 [\d.]+): +(\d+)", said, re.M))
        return int(total.group(2)), int(total.group(1)), bad, by


def put(path, f):
    with open(path) as i:
        s = f(i.read())
    with open(path, "w") as o:
        o.write(s)


def once(where, text, part):
    if text.count(part) != 1:
        raise SystemExit("%s: %d times, once is wanted: %s" % (where, text.count(part), part))
    return text


def annotate(spec, tree):
    """Puts contracts before the lines they belong to. They are comments: the code stays what it is."""
    path = anchor = None
    block = []

    def done():
        if path is None or not block:
            return
        text = "".join(block)
        if anchor is None:
            put(path, lambda s: s + text)
        else:
            def insert(s):
                line = s.rfind("\n", 0, once(path, s, anchor).index(anchor)) + 1
                return s[:line] + text + s[line:]
            put(path, insert)

    with open(spec) as f:
        for line in f:
            if line[:2] in ("@@", "<<", ">>"):
                done()
                block = []
                if line[:2] == "@@":
                    path, anchor = os.path.join(tree, line[2:].strip()), None
                else:
                    anchor = line[2:].strip() or None
            else:
                block.append(line)
    done()


def timed(f, *args):
    t = time.time()
    return f(*args), time.time() - t


def prove(p, only, pool):
    """unit.tool -> proved of all; prints the table."""
    import smt
    got, bad = {}, []
    print("%-10s %-20s %-12s %8s %6s  %s" % ("unit", "about", "tool", "proved", "of", "s"))

    def row(unit, about, tool, key, proved, total, s, names=()):
        got[key] = (proved, total)
        print("%-10s %-20s %-12s %8d %6d  %.0f" % (unit, about, tool, proved, total, s))
        for n in names:
            print("         not proved: " + n)
            bad.append(n)
        sys.stdout.flush()

    every = units(only)
    judged = [(u, m, pool.submit(timed, p.eva, u, m, "%s.%s" % (u.name, m)))
              for u in every for m in BOTH if not u.every]
    gone_through = [(u, pool.submit(timed, p.each, u, u.name + ".every")) for u in every if u.every]
    for u, m, job in judged:
        (alarms, open_, valid, _), s = job.result()
        names = ["%s: %d alarms, %d assertions open: %s.%s.txt" % (u.name, alarms, open_, u.name, m)]
        row(u.name, u.about, "Eva, %s-bit" % m[-2:], "%s.eva%s" % (u.name, m[-2:]), valid, valid + open_ + alarms, s,
            names if alarms or open_ else ())
    for u, job in gone_through:
        (holds, _), s = job.result()
        row(u.name, u.about, "every value", u.name + ".every", int(holds), 1, s, () if holds else (u.name,))
    for u in every:
        if u.name not in WP:
            continue
        (total, ok, names, by), s = timed(p.wp, u.name, p.tree(u.name), u.name + ".wp.txt", 30)
        row(u.name, u.about, "WP", u.name + ".wp", ok, total, s, names)
        if by:
            print("         " + ", ".join("%s %s" % kv for kv in by.items()))
    if not only or "smt" in only:
        for lemma in smt.LEMMAS:
            ok, s = timed(lemma)
            row("smt", lemma.__name__, "z3", "smt." + lemma.__name__, int(ok), 1, s,
                () if ok else (lemma.__name__,))
    return got, bad


def plant(p, only, pool):
    """Each planted error has to be told. How many were not."""
    untold = 0
    print("planted errors:")

    def tell(told, unit, tool, old, new):
        nonlocal untold
        untold += not told
        print("  %-8s %s by %s: %s -> %s" % ("told" if told else "NOT TOLD", unit, tool, old, new))
        sys.stdout.flush()

    def told(u, name, plan):
        # What does not even run is no proof of anything.
        if u.every:
            holds, ran = p.each(u, name, plan)
            return ran and not holds
        alarms, open_, _, ran = p.eva(u, BOTH[0], name, plan)
        return ran and alarms + open_ > 0

    planted = [(u, plan, pool.submit(told, u, "planted.%s%d" % (u.name, k), plan))
               for u in units(only) for k, plan in enumerate(u.plants)]
    for u, (_, old, new), job in planted:
        tell(job.result(), u.name, "every value" if u.every else "Eva", old, new)
    for k, (unit, functions, path, old, new) in enumerate(MUTANTS):
        if only and unit not in only:
            continue
        tree = p.tree("planted", (path, old, new))
        total, ok, _, by = p.wp(unit, tree, "planted%d.txt" % k, 4, functions.split())
        tell(ok < total and bool(by), unit, "WP " + functions, old, new)
    return untold


def held(got, update):
    """Against the committed counts: none may be less, nor may more stay open."""
    old = {}
    if os.path.exists(COUNTS):
        with open(COUNTS) as f:
            old = {k: (int(a), int(b)) for k, a, b in (line.split() for line in f if line[:1] not in "#\n")}
    if update:
        old.update(got)
        with open(COUNTS, "w") as f:
            f.write("# unit.tool, proved, of: make proof ARGS=--update. A number may not shrink.\n")
            f.writelines("%s %d %d\n" % (k, *old[k]) for k in sorted(old))
    less = ["%s: %d of %d, was %d of %d" % (k, *v, *old[k]) for k, v in sorted(got.items())
            if k in old and (v[0] < old[k][0] or v[1] - v[0] > old[k][1] - old[k][0])]
    new = ["%s: not in counts.txt" % k for k in sorted(got) if k not in old]
    for line in less + new:
        print("counts: " + line)
    return not less and not new


def main():
    a = argparse.ArgumentParser()
    a.add_argument("--root", default=os.path.dirname(os.path.dirname(HERE)))
    a.add_argument("--out", default="build/proof")
    a.add_argument("--only", help="these units alone, with commas between")
    a.add_argument("--jobs", type=int, default=2, help="Eva runs at a time")
    a.add_argument("--no-mutants", action="store_true")
    a.add_argument("--update", action="store_true")
    a = a.parse_args()
    if missing():
        return 3
    p = Proof(os.path.abspath(a.root), os.path.abspath(a.out))
    only = a.only.split(",") if a.only else []
    with ThreadPoolExecutor(a.jobs) as pool:
        got, _ = prove(p, only, pool)
        ok = held(got, a.update)
        untold = 0 if a.no_mutants else plant(p, only, pool)
    print("%d proved, %d not; %d planted errors not told" %
          (sum(v[0] for v in got.values()), sum(v[1] - v[0] for v in got.values()), untold))
    return 0 if ok and not untold else 1


if __name__ == "__main__":
    sys.exit(main())
