#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""structure.py [--root DIR] [BUILD]: the tree keeps its structure.

Circles: no two sources of a scope need each other, by their includes and by the symbols of their
objects under BUILD. Folders of the library and rooms of the program have no circle either.
Arrows: examples never include ports; ports include examples only as ALLOWED says; a room of the
program includes only the base room and what the simulated device offers to all.

Budgets: budget.tsv has a limit for the lines of a room, of its longest file and of its longest
function, and for its bytes. Growth beyond a limit is a decision: change the limit and say why.
Exit status: 0 all hold, 1 not. Standard library only; nm reads the objects.
"""

import argparse
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
BUDGET = "test/walk/docs/budget.tsv"
INCLUDES = ("lib/include", "lib/src", "examples", "ports/posix/exhand", "ports/posix", "ports",
            "test", "")
SCOPES = ("lib", "ports/pc104", "ports/cards", "ports/posix")
PROGRAM = "ports/posix/exhand"
# What every room of the program may include: the rooms below it, which other programs share, too.
COMMON = (PROGRAM, "ports/posix", "ports/cards",
          *("ports/posix/" + r for r in ("base", "box", "falls", "identify", "slave", "sim", "emu",
                                         "world")))
# Folders between which no circle may be.
FOLDERS = (r"lib/src/[a-z]+", r"ports/posix/exhand/[a-z]+",
           r"ports/posix/(?:base|box|falls|identify|slave|sim|emu|world)")

# Circles that may be: (a source, another one): the reason.
CIRCLES = {}
# Symbols of the board's contract, exhand/board.h: a file that calls one calls through the library's
# interface. Every file may end the program that way, and the board that does so uses every file.
CONTRACT = re.compile(r"exh_board_\w+|exh_assert_failed")
# The linker takes it in place of a source of the library: who calls it needs that one, not this.
STAND_INS = ("lib/src/run/crc_table.c",)
# What the processor enters at reset and at an interrupt: no need of the source, so no arrow of it.
ENTRIES = ("ports/pc104/crt0.S", "ports/pc104/vectors.S")
# Headers of examples that ports may include: (who, which). These files set a scene's own parameters
# or read its signals. All others know its descriptor, exhand/run/scene.h.
ALLOWED = (
    (r"ports/fmi/controller\.c", r"examples/drop/drop\.h"),
    (r"ports/posix/base/scene_custom\.c", r"examples/custom/custom\.h"),
    (r"ports/posix/box/(idle\.h|run\.c)", r"examples/drop/drop\.h"),
    (r"ports/posix/box/guard\.h", r"examples/guarded/guarded\.h"),
    (r"ports/posix/box/(hand\.h|glove_line\.c)", r"examples/bilateral/bilateral\.h"),
    (r"ports/posix/box/glove_line\.c", r"examples/glove/glove\.h"),
    (r"ports/posix/world/live\.c", r"examples/bilateral/bilateral\.h"),
    (r"ports/posix/exhand/glove/.*", r"examples/glove/glove\.h"),
    (r"ports/posix/exhand/bench/.*", r"examples/(bringup|calibrate|identify)/\w+\.h"),
    (r"ports/posix/identify/.*", r"examples/identify/identify\.h"),
)


def read(path):
    with open(path, encoding="utf-8", errors="replace") as f:
        return f.read()


def tree(root):
    """Paths of the tree's files: those that git tracks, or all where there is no git."""
    if os.path.exists(os.path.join(root, ".git")):
        git = ["git", "-C", root, "ls-files", "-z"]
        found = subprocess.run(git, stdout=subprocess.PIPE, check=True).stdout
        found = found.decode().split("\0")[:-1]
        return sorted(p for p in found if os.path.isfile(os.path.join(root, p)))
    found = []
    for at, folders, files in os.walk(root):
        folders[:] = [f for f in folders if f not in ("build", "__pycache__")]
        found += [os.path.relpath(os.path.join(at, f), root) for f in files]
    return sorted(found)


# --- what uses what ---


def includes(root, paths):
    """Path of each C file: the paths of the tree that it includes."""
    there = set(paths)
    uses = {}
    for path in paths:
        if not path.endswith((".c", ".h", ".S")):
            continue
        uses[path] = set()
        text = read(os.path.join(root, path))
        for name in re.findall(r'^\s*#\s*include\s*"([^"]+)"', text, re.M):
            for base in (os.path.dirname(path),) + INCLUDES:
                at = os.path.normpath(os.path.join(base, name))
                if at in there:
                    uses[path].add(at)
                    break
    return uses


def older(a, b):
    return os.path.getmtime(a) < os.path.getmtime(b)


def objects(root, build, paths):
    """Path of each source: its objects of the host and of the PC/104, none older than it."""
    sources = {os.path.splitext(p)[0]: p for p in paths if p.endswith((".c", ".S"))}
    found = {}
    for port in ("posix", "pc104"):
        for at, _, files in os.walk(os.path.join(build, port)):
            for name in files:
                if not name.endswith(".o"):
                    continue
                full = os.path.join(at, name)
                parts = os.path.relpath(full, build)[:-2].split(os.sep)
                for i in range(1, min(len(parts), 3)):
                    source = sources.get("/".join(parts[i:]))
                    if source and not older(full, os.path.join(root, source)):
                        found.setdefault(source, []).append(full)
    return found


def symbols(objs):
    """Source: (names that its objects define, names that they want)."""
    names = {}
    flat = [(s, o) for s, os_ in sorted(objs.items()) for o in os_]
    for first in range(0, len(flat), 200):
        some = flat[first:first + 200]
        nm = subprocess.run(["nm", "-A", "-P", "-g"] + [o for _, o in some], text=True,
                            stdout=subprocess.PIPE, check=True)
        source_of = {o: s for s, o in some}
        for line in nm.stdout.splitlines():
            place, rest = line.split(": ", 1)
            has, wants = names.setdefault(source_of[place], (set(), set()))
            name, kind = rest.split()[:2]
            (wants if kind in "Uvw" else has).add(name)
    return names


def calls(names, paths):
    """Source: the sources in the list that define what it wants, but for the board's contract."""
    homes = {}
    for path in paths:
        for name in () if path in STAND_INS else names.get(path, ((), ()))[0]:
            homes.setdefault(name, set()).add(path)
    uses = {}
    for path in paths:
        wants = () if path in ENTRIES else names.get(path, ((), ()))[1]
        wants = [n for n in wants if not CONTRACT.fullmatch(n)]
        uses[path] = {home for n in wants for home in homes.get(n, ()) if home != path}
    return uses


def circles(uses):
    """Groups of more than one that reach each other (Tarjan, without recursion)."""
    number, low, stack, on, found = {}, {}, [], set(), []
    for start in sorted(uses):
        if start in number:
            continue
        work = [(start, iter(sorted(uses.get(start, ()))))]
        number[start] = low[start] = len(number)
        stack.append(start)
        on.add(start)
        while work:
            node, rest = work[-1]
            for to in rest:
                if to not in number:
                    number[to] = low[to] = len(number)
                    stack.append(to)
                    on.add(to)
                    work.append((to, iter(sorted(uses.get(to, ())))))
                    break
                if to in on:
                    low[node] = min(low[node], number[to])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == number[node]:
                    group = []
                    while not group or group[-1] != node:
                        group.append(stack.pop())
                        on.discard(group[-1])
                    if len(group) > 1:
                        found.append(sorted(group))
    return found


def module(path):
    """A source and its header are one; so are a public header and the source of that name."""
    stem = os.path.splitext(path)[0]
    public = stem.startswith(("lib/src/", "lib/include/"))
    return "lib/" + os.path.basename(stem) if public else stem


def joined(uses, name):
    """The same arrows between what name() makes of the paths."""
    out = {}
    for path, others in uses.items():
        for to in others:
            a, b = name(path), name(to)
            if a and b and a != b:
                out.setdefault(a, set()).add(b)
                out.setdefault(b, set())
    return out


def within(uses, scope):
    return {p: {t for t in others if t.startswith(scope + "/")}
            for p, others in uses.items() if p.startswith(scope + "/")}


def both(a, b):
    return {p: a.get(p, set()) | b.get(p, set()) for p in set(a) | set(b)}


def path_of(group, uses):
    """One circle of the group, spelled out: the shortest way from its first back to it."""
    first = group[0]
    ways = [[first]]
    seen = set()
    for way in ways:
        for to in sorted(uses.get(way[-1], ())):
            if to == first:
                others = [g for g in group if g not in way]
                more = ", and in it " + ", ".join(others) if others else ""
                return " -> ".join(way + [first]) + more
            if to in group and to not in seen:
                seen.add(to)
                ways.append(way + [to])
    return " <-> ".join(group)


def allowed_circle(group):
    return any(set(group) == set(pair) for pair in CIRCLES)


def folder(path):
    for pattern in FOLDERS:
        m = re.match("(" + pattern + ")/", path)
        if m:
            return m.group(1)
    return None


def needs(by_include, by_symbol):
    """What circles are looked for in: a header needs what it includes, a source what it calls.
    That a source includes a header is no need of that header's source: several may share it."""
    own = {p: {t for t in others if p.endswith(".h") or t.endswith(".c")}
           for p, others in by_include.items()}
    return both(own, by_symbol)


def circle_faults(by_include, by_symbol):
    faults, uses = [], needs(by_include, by_symbol)
    for scope in SCOPES:
        of = joined(within(uses, scope), module)
        faults += ["circle: " + path_of(g, of) for g in circles(of) if not allowed_circle(g)]
    of = joined(both(by_include, by_symbol), folder)
    return faults + ["circle of folders: " + path_of(g, of) for g in circles(of)]


# --- arrows between rooms ---


def room_of(path):
    m = re.match(PROGRAM + r"/[a-z]+/", path)
    return m.group()[:-1] if m else None


def forbidden(path, to):
    """Why path may not include that, or None."""
    if path.startswith("lib/") and not to.startswith("lib/"):
        return "the library includes itself only"
    if path.startswith("examples/") and to.startswith("ports/"):
        return "examples include ports never"
    if path.startswith("ports/") and to.startswith("examples/"):
        named = any(re.fullmatch(a, path) and re.fullmatch(b, to) for a, b in ALLOWED)
        return None if named else "not a header of examples for ports"
    if room_of(path) and to.startswith("ports/"):
        there = os.path.dirname(to)
        open_to_all = there in COMMON or there == room_of(path)
        return None if open_to_all else "a room includes only base and the simulator"
    return None


def arrow_faults(uses):
    return ["arrow: %s includes %s: %s" % (path, to, forbidden(path, to))
            for path, others in sorted(uses.items()) for to in sorted(others)
            if forbidden(path, to)]


# --- budgets ---

WHAT = ("lines", "lines in one file", "lines in one function", "bytes")
WORDS = {"if", "for", "while", "switch", "do", "else", "return", "sizeof"}


def plain(text):
    """C without comments, texts, characters and lines of the preprocessor, line by line."""
    def blank(m):
        return re.sub(r"[^\n]", " ", m.group())
    away = r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\''
    text = re.sub(away, blank, text, flags=re.S)
    return re.sub(r"^[ \t]*#(?:[^\n\\]|\\.|\\\n)*", blank, text, flags=re.M | re.S)


HEAD = re.compile(r"(\w+)\s*\((?:[^()]|\([^()]*(?:\([^()]*\))*[^()]*\))*\)\s*$", re.S)


def function_of(head):
    """Name of the function whose text before the brace this is; None where it is no function."""
    call = HEAD.search(head)
    if not call or call.group(1) in WORDS or "=" in head[:call.start()]:
        return None
    return call.group(1)


def functions(text):
    """(name, lines) of each function, from the first line of its head to its last brace."""
    text, found, depth, start, name = plain(text), [], 0, 0, None
    since = 0  # where the text of this declaration begins
    for m in re.finditer(r"[{};]", text):
        if m.group() == "{":
            if depth == 0:
                head = text[since:m.start()]
                name = function_of(head)
                start = since + len(head) - len(head.lstrip())
            depth += 1
        elif m.group() == "}":
            depth -= 1
            if depth == 0:
                if name:
                    found.append((name, text.count("\n", start, m.start()) + 1))
                since, name = m.end(), None
        elif depth == 0:
            since = m.end()
    return found


def measure(root, paths):
    """Of these files: lines in all, (lines, file), (lines, function), bytes."""
    total, size, longest, deepest = 0, 0, (0, ""), (0, "")
    for path in paths:
        full = os.path.join(root, path)
        size += os.path.getsize(full)
        with open(full, "rb") as f:
            data = f.read()
        if b"\0" in data[:8000]:
            continue
        n = data.count(b"\n")
        total += n
        longest = max(longest, (n, path))
        if path.endswith((".c", ".h")) and "_ert_rtw/" not in path:
            for name, lines in functions(data.decode("utf-8", "replace")):
                deepest = max(deepest, (lines, "%s() of %s" % (name, path)))
    return total, longest, deepest, size


def budgets(text):
    """(room, its four limits): a room is a folder, or patterns of paths."""
    for line in text.splitlines():
        if line.startswith("#") or not line.strip():
            continue
        room, *limits = line.split("\t")
        yield room, [None if x == "-" else int(x) for x in limits]


def matches(room):
    """A room's paths: patterns, * within a folder, ** any; those behind a - are left out."""
    wanted = [x for x in room.split() if not x.startswith("-")]
    without = [x[1:] for x in room.split() if x.startswith("-")]

    def one(pattern):
        pattern = "**" if pattern == "." else pattern + "**" if pattern.endswith("/") else pattern
        parts = re.split(r"(\*\*/|\*\*|\*)", pattern)
        any_of = {"**/": "(?:.*/)?", "**": ".*", "*": "[^/]*"}
        return re.compile("".join(any_of.get(p, re.escape(p)) for p in parts))
    take, leave = [one(x) for x in wanted], [one(x) for x in without]
    return lambda p: any(x.fullmatch(p) for x in take) and not any(x.fullmatch(p) for x in leave)


def budget_faults(root, paths, text):
    """Faults, and the table of what is and what may be."""
    faults = []
    table = [("room", "lines", "longest file", "longest function", "bytes")]
    for room, limits in budgets(text):
        wanted = matches(room)
        here = [p for p in paths if wanted(p)]
        total, longest, deepest, size = measure(root, here)
        if not here:
            faults.append("budget: %s: no such room: leave its line out of %s" % (room, BUDGET))
        actual = (total, longest[0], deepest[0], size)
        for what, is_, limit, where in zip(WHAT, actual, limits, ("", longest[1], deepest[1], "")):
            if limit is not None and is_ > limit:
                at = ": " + where if where else ""
                faults.append("budget: %s: %d %s, limit %d%s" % (room, is_, what, limit, at))
        table.append([room] + ["%d/%s" % (n, "-" if x is None else x)
                               for n, x in zip(actual, limits)])
    return faults, table


def check(root, build):
    """All faults of the tree, the table of budgets, and what was looked at."""
    paths = tree(root)
    by_include = includes(root, paths)
    objs = objects(root, build, paths) if build else {}
    names = symbols(objs)
    # The host's alternatives of a symbol and those of a bare machine never meet: a scope at a time.
    by_symbol = {}
    for scope in SCOPES:
        inside = [p for p in paths if p.startswith(scope + "/") and p in names]
        by_symbol.update(calls(names, inside))
    seen = {s: sum(p.startswith(s + "/") for p in names) for s in SCOPES}
    faults, table = budget_faults(root, paths, read(os.path.join(root, BUDGET)))
    return circle_faults(by_include, by_symbol) + arrow_faults(by_include) + faults, table, seen


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--root", default=ROOT)
    parser.add_argument("build", nargs="?")
    args = parser.parse_args()
    faults, table, seen = check(args.root, args.build)
    widths = [max(len(row[i]) for row in table) for i in range(5)]
    for row in table:
        cells = [x.rjust(w) for x, w in zip(row, widths)]
        print("  ".join([row[0].ljust(widths[0])] + cells[1:]))
    for scope, n in seen.items():
        what = "symbols of %d sources" % n if n else "no objects: includes alone"
        print("%s: %s" % (scope, what))
    for f in faults:
        print(f)
    print("structure: %d faults" % len(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
