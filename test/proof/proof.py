#!/usr/bin/env python3
"""Proves the output path: the gate, force and current, tracking, the state machine (README.md).

  proof.py [--root DIR] [--out DIR] [--only UNIT] [--no-mutants] [--update]

Exit 0 when every unit proves what counts.txt says and every planted error is told, 1 when not,
3 when a tool is missing.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import time

sys.dont_write_bytecode = True

HERE = os.path.dirname(os.path.abspath(__file__))
COUNTS = os.path.join(HERE, "counts.txt")
BOTH = ("gcc_x86_64", "gcc_x86_32")

# Unit: what it is about; the functions that WP judges (none: abstract interpretation alone).
UNITS = {
    "fix": ("arithmetic", "lib/src/fix.c", ["exh_sat32", "exh_clamp"]),
    "gate": ("the gate", "lib/src/gate.c", ["any_gate", "code_of", "exh_safety_open"]),
    "drive": ("force and current", "lib/src/drive.c",
              ["no_force", "release", "exh_drive_force", "i2t_limit", "exh_drive_current"]),
    "track": ("current tracking", "lib/src/track.c", ["exh_track_step", "exh_track_coded"]),
    "passivity": ("energy", "lib/src/passivity.c", []),
    "safety": ("state of the box", "lib/src/safety.c", []),
    "law": ("contact law", None, []),
    "watch": ("speed, standing", None, []),
}

# Planted errors: unit, tool that must tell (WP: in which functions), file, text, what it becomes.
MUTANTS = [
    ("gate", "wp code_of", "lib/src/gate.c", "exh_clamp(asked, -span, span)",
     "exh_clamp(asked, INT32_MIN, INT32_MAX)"),
    ("gate", "wp code_of", "lib/src/gate.c", "exh_clamp(asked, -span, span)",
     "exh_clamp(asked, -span - 1, span)"),
    ("gate", "wp code_of", "lib/src/gate.c", "dac_zero_raw + spanned, 0, UINT16_MAX)",
     "dac_zero_raw + spanned, 0, 2 * UINT16_MAX)"),
    ("gate", "wp any_gate", "lib/src/gate.c", "falls ? s->off_raw[k] : UINT16_MAX", "UINT16_MAX"),
    ("gate", "wp any_gate", "lib/src/gate.c", "= open ? exh_sat32(asked) : 0;", "= exh_sat32(asked);"),
    ("gate", "wp any_gate", "lib/src/gate.c", "cfg[k < n ? k : 0].par->dac_zero_raw", "out->dac_raw[k]"),
    ("gate", "eva", "lib/src/gate.c", "(1u << n) - 1u : 0u", "(1u << n) : 0u"),
    ("gate", "eva", "lib/src/gate.c", "exh_wrap_diff64(passed, asked)", "passed - asked"),
    ("drive", "wp exh_drive_force", "lib/src/drive.c", "exh_clamp(asked, 0, most)", "exh_clamp(asked, -most, most)"),
    ("drive", "wp exh_drive_force", "lib/src/drive.c", "exh_clamp(asked, 0, most)", "exh_clamp(asked, 0, INT32_MAX)"),
    ("drive", "wp release", "lib/src/drive.c", "rest > 0 ? (int32_t)rest : 0", "(int32_t)rest"),
    ("drive", "wp exh_drive_current", "lib/src/drive.c", "exh_clamp(peak, -hot, hot)", "exh_clamp(2 * (int64_t)peak, -2 * hot, 2 * hot)"),
    ("drive", "eva", "lib/src/drive.c", "exh_wrap_add64(f->spring_N_q20, f->damper_N_q20)",
     "f->spring_N_q20 + f->damper_N_q20"),
    ("track", "wp exh_track_step", "lib/src/track.c", "s->off_ticks >= cfg->ticks", "s->off_ticks > cfg->ticks"),
    ("passivity", "eva", "lib/src/passivity.c", "= limited(e);", "= e;"),
    ("safety", "eva", "lib/src/safety.c", "if (!sane(s)) {", "if (0) {"),
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

    def eva(self, unit, tree, machdep, name):
        """Alarms, unproved assertions, proved assertions."""
        flags = "-I%s/lib/src -I%s/lib/include -I%s/eva" % (tree, tree, HERE)
        code, said = run(["frama-c", "-cpp-extra-args=" + flags, "-machdep", machdep, "-eva",
                          "-eva-precision", "6", "-eva-split-return", "auto", "-warn-signed-downcast", "-eva-no-show-progress",
                          "-eva-msg-key=-initial-state,-final-states", os.path.join(HERE, "eva", "any_" + unit + ".c")],
                         600, self.env)
        self.log(name, said)
        alarms = re.search(r"(\d+) alarms? generated", said)
        stated = re.search(r"Assertions +(\d+) valid +(\d+) unknown +(\d+) invalid", said)
        needed = re.search(r"Preconditions +(\d+) valid +(\d+) unknown +(\d+) invalid", said)
        # Without the end in reach, nothing would be shown by the rest.
        if code != 0 or "Frama_C_show_each_end" not in said or "ANALYSIS SUMMARY" not in said:
            return 1, 1, 0
        valid = sum(int(m.group(1)) for m in (stated, needed) if m)
        open_ = sum(int(m.group(2)) + int(m.group(3)) for m in (stated, needed) if m)
        return int(alarms.group(1)) if alarms else 0, open_, valid

    def wp(self, unit, tree, name, seconds, functions=None):
        """Goals, proved, names of the others, provers. Of these functions, or all of the unit."""
        _, source, every = UNITS[unit]
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


def prove(p, only):
    """unit.tool -> proved of all; prints the table."""
    import smt
    got, bad = {}, []
    print("%-8s %-18s %-14s %8s %6s  %s" % ("unit", "about", "tool", "proved", "of", "s"))

    def row(unit, about, tool, key, proved, total, t, names=()):
        got[key] = (proved, total)
        print("%-8s %-18s %-14s %8d %6d  %.0f" % (unit, about, tool, proved, total, time.time() - t))
        for n in names:
            print("         not proved: " + n)
            bad.append(n)
        sys.stdout.flush()

    for unit, (about, _, functions) in UNITS.items():
        if only and unit != only:
            continue
        for machdep in BOTH:
            t, tree = time.time(), p.tree(unit)
            alarms, open_, valid = p.eva(unit, tree, machdep, "%s.%s.txt" % (unit, machdep))
            bits = "Eva, %s-bit" % machdep[-2:]
            names = ["%s: %d alarms, %d assertions open: %s.%s.txt" % (unit, alarms, open_, unit, machdep)]
            row(unit, about, bits, "%s.eva%s" % (unit, machdep[-2:]), valid, valid + open_ + alarms, t,
                names if alarms or open_ else ())
        if functions:
            t = time.time()
            total, ok, names, by = p.wp(unit, tree, unit + ".wp.txt", 30)
            row(unit, about, "WP", unit + ".wp", ok, total, t, names)
            if by:
                print("         " + ", ".join("%s %s" % kv for kv in by.items()))
    if not only or only == "smt":
        for lemma in smt.LEMMAS:
            t = time.time()
            ok = lemma()
            row("smt", lemma.__name__, "z3", "smt." + lemma.__name__, int(ok), 1, t,
                () if ok else (lemma.__name__,))
    return got, bad


def plant(p, only):
    """Each planted error has to be told. How many were not."""
    untold = 0
    print("planted errors:")
    for k, (unit, tool, path, old, new) in enumerate(MUTANTS):
        if only and unit != only:
            continue
        tree = p.tree("planted", (path, old, new))
        name = "planted%d.txt" % k
        if tool == "eva":
            alarms, open_, _ = p.eva(unit, tree, BOTH[0], name)
            told = alarms + open_ > 0
        else:
            total, ok, _, by = p.wp(unit, tree, name, 4, tool.split()[1:])
            told = ok < total and bool(by)  # what does not even run is no proof of anything
        untold += not told
        print("  %-8s %s by %s: %s -> %s" % ("told" if told else "NOT TOLD", unit, tool, old, new))
        sys.stdout.flush()
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
    a.add_argument("--only")
    a.add_argument("--no-mutants", action="store_true")
    a.add_argument("--update", action="store_true")
    a = a.parse_args()
    if missing():
        return 3
    p = Proof(os.path.abspath(a.root), os.path.abspath(a.out))
    got, bad = prove(p, a.only)
    ok = held(got, a.update)
    untold = 0 if a.no_mutants else plant(p, a.only)
    print("%d proved, %d not; %d planted errors not told" %
          (sum(v[0] for v in got.values()), sum(v[1] - v[0] for v in got.values()), untold))
    return 0 if ok and not untold else 1


if __name__ == "__main__":
    sys.exit(main())
