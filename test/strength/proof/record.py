# SPDX-License-Identifier: MIT
"""What was proved: counts.txt (how much), keys.txt (of which text, in how long) and reached.txt
(which functions of lib)."""
import glob
import hashlib
import os
import re

from tools import HERE, WP, read, units

COUNTS = os.path.join(HERE, "counts.txt")
KEYS = os.path.join(HERE, "keys.txt")
REACHED = os.path.join(HERE, "reached.txt")
NOT_PROVED = os.path.join(HERE, "not_proved.txt")
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))


LEMMA_FILES = ("smt.py", "smt_passivity.py", "smt_hand.py")


def lemmas():
    """Their names, without z3."""
    found = []
    for f in LEMMA_FILES:
        listed = re.search(r"^LEMMAS = \[(.*?)\]", read(os.path.join(HERE, f)), re.M | re.S)
        found += re.findall(r"\w+", listed.group(1))
    return found


def rows_wanted():
    """Every row that counts.txt must have."""
    return [r for u in units() for r in u.rows()] + ["smt." + n for n in lemmas()]


def sealed(key, proved, of):
    """So that a count changed by hand is seen."""
    return hashlib.sha256(("%s %d %d" % (key, proved, of)).encode()).hexdigest()[:4]


class Row:
    def __init__(self, proved, of, s=10.0, key="-", seal="-"):
        self.proved, self.of, self.s, self.key, self.seal = (int(proved), int(of), float(s), key,
                                                             seal)

    def is_whole(self):
        return self.seal == sealed(self.key, self.proved, self.of)


def words(path):
    """Words of its lines but for comments; none where there is no file."""
    lines = read(path).splitlines() if os.path.exists(path) else []
    return [line.split() for line in lines if line[:1] not in ("#", "")]


def counts():
    more = {k: rest for line in words(KEYS) for k, *rest in (word.split(":") for word in line)}
    return {k: Row(proved, of, *more.get(k, ())) for k, proved, of in words(COUNTS)}


def write_counts(rows):
    """The keys are one line, so that a change of the library changes that line and few counts."""
    with open(COUNTS, "w") as f:
        f.write("# unit.tool, proved, of: make proof ARGS=--update. A number may not shrink.\n")
        f.writelines("%s %d %d\n" % (k, r.proved, r.of) for k, r in sorted(rows.items()))
    with open(KEYS, "w") as f:
        f.write("# unit.tool : seconds of a core : key of what was proved : seal\n")
        f.write(" ".join("%s:%.1f:%s:%s" % (k, r.s, r.key, r.seal)
                         for k, r in sorted(rows.items())) + "\n")


# What runs in a tick: the library, the loop, and of the examples the scenes that run fingers and
# gloves.
SOURCES = ("lib/src/[!r]*/*.[ch]", "lib/src/run/deadman.c", "lib/src/run/loop.c",
           "lib/include/exhand/*.h", "examples/minimal/*.[ch]", "examples/drop/*.[ch]",
           "examples/guarded/*.[ch]", "examples/glove/*.[ch]", "examples/bilateral/*.[ch]")


def sources(root=ROOT):
    """These files, as far as there is code in them, by their path."""
    found = sorted(f for part in SOURCES for f in glob.glob(os.path.join(root, part)))
    return {f: text for f, text in ((os.path.relpath(f, root), read(f)) for f in found)
            if functions(text)}


def functions(text):
    """Names of the functions defined in it."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    return re.findall(r"^(?!#|typedef\b)\w[^;{}()#]*?\b(\w+)\([^;{}]*\)\s*\{", text, re.M)


def renamed(unit, texts):
    """What the unit calls the functions of the sources that it includes: name -> file and
    function."""
    found = {n: (f, n) for f, text in texts.items() if f.endswith(".h") for n in functions(text)}
    for f in unit.beside:
        found.update({n: (f, n) for n in functions(texts.get(f, ""))})
    other = {}
    for line in unit.text.splitlines():
        m = re.match(r'#(define|undef|include) +"?([\w./]+)"? *(\w*)', line)
        if not m:
            continue
        if m.group(1) == "define":
            other[m.group(2)] = m.group(3)
        elif m.group(1) == "undef":
            other.pop(m.group(2), None)
        else:
            f = "examples/" + m.group(2)
            if f not in texts:
                f = "lib/src/" + m.group(2)
            found.update({other.get(n, n): (f, n) for n in functions(texts.get(f, ""))})
    return found


def reached():
    """unit -> {file -> {function -> (statements reached, of)}}"""
    found = {}
    for line in read(REACHED).splitlines() if os.path.exists(REACHED) else ():
        if line[:1] == "#":
            continue
        unit, f, *names = line.split()
        at = found.setdefault(unit, {}).setdefault(f, {})
        for n in names:
            name, _, part = n.partition(":")
            a, _, b = part.partition("/")
            at[name] = (int(a), int(b or a))
    return found


def write_reached(found):
    with open(REACHED, "w") as f:
        f.write("# unit, file, functions that Eva reached there, with their statements, or those "
                "reached of all:\n"
                "# make proof ARGS=--update\n")
        for unit in sorted(found):
            for at in sorted(found[unit]):
                f.write("%s %s %s\n" % (unit, at, " ".join(
                    "%s:%d" % (n, a) if a == b else "%s:%d/%d" % (n, a, b)
                    for n, (a, b) in sorted(found[unit][at].items()))))


def note_reached(found, unit, by_name, texts):
    """What Eva said of a unit, into what reached() gave."""
    names = renamed(unit, texts)
    found[unit.name] = {}
    for n, (a, b) in by_name.items():
        if n in names:
            f, name = names[n]
            found[unit.name].setdefault(f, {})[name] = (a, b)


def covered(found, texts):
    """file -> {function -> (statements reached, of, units)}: the most that one unit reaches; (0, 1,
    ()) where none does."""
    best = {f: {n: (0, 1, ()) for n in functions(text)} for f, text in texts.items()}
    for unit, files in sorted(found.items()):
        for f, names in files.items():
            for n, (a, b) in names.items():
                c, d, by = best.get(f, {}).get(n, (0, 1, ()))
                if f in best and n in best[f]:
                    best[f][n] = (a, b, by + (unit,)) if a * d > c * b else (c, d, by + (unit,))
    for u in units():
        for names in best.values() if u.every else ():
            for n in names:
                if names[n][0] == 0 and re.search(r"\b%s\(" % n, u.body):
                    names[n] = (1, 1, (u.name + " (every value)",))
    for unit, (f, names) in WP.items():
        for n in names:
            if n in best.get(f, {}) and best[f][n][0] == 0:
                best[f][n] = (1, 1, (unit + " (WP)",))
    return best


def not_proved():
    """Reasons: (file, function or *) -> why."""
    found = {}
    for line in read(NOT_PROVED).splitlines() if os.path.exists(NOT_PROVED) else ():
        if line[:1] in ("#", ""):
            continue
        where, _, why = line.partition(": ")
        f, names = where.split(None, 1)
        for n in names.split():
            found[f, n] = why
    return found


def drop_reasons(best):
    """Takes out of not_proved.txt what is reached now."""
    lines = []
    for line in read(NOT_PROVED).splitlines():
        where, _, why = line.partition(": ")
        f, _, names = where.partition(" ")
        left = [n for n in names.split() if best.get(f, {}).get(n, (0,))[0] == 0]
        if (line[:1] in ("#", "") or names == "*" and
            not all(v[0] for v in best.get(f, {}).values())):
            lines.append(line)
        elif names != "*" and left:
            lines.append("%s %s: %s" % (f, " ".join(left), why))
    with open(NOT_PROVED, "w") as o:
        o.write("\n".join(lines) + "\n")


def unexplained(best, reasons):
    """What is wrong: functions that no unit reaches and not_proved.txt does not name; reasons for
    what is proved or is not there."""
    wrong = []
    used = set()
    for f, names in sorted(best.items()):
        for n, (a, _, _) in names.items():
            if a > 0:
                continue
            key = (f, n) if (f, n) in reasons else (f, "*")
            if key in reasons:
                used.add(key)
            else:
                wrong.append("%s: %s(): no unit reaches it and not_proved.txt does not say why" %
                             (f, n))
    return wrong + ["not_proved.txt: %s %s: %s" % (f, n, "is reached, or is not there")
                    for f, n in sorted(set(reasons) - used)]
