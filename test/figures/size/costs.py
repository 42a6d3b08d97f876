#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What a scene costs, which modules are in it and why, and what one thing more adds: costs.py
[--out DIR] [--short] [--update] [--help]

Reads what size.sh has built and measured in B/size. Runs it if a source is newer. Writes into DIR
(B/size/costs; OUT in the environment) these tables, each as .csv, some as .md too:

    cost      scene x port: bytes, worst stack, instructions per tick (size.sh says how)
    modules   scene x port x library module: bytes in the image, bytes that the module has,
              instructions per tick, and the shortest way to it by the relocations of the objects:
              from the scene's table of functions, or else from main()
    features  scene x port: what the image would lose if nothing called some modules: they, and all
              that only they lead to
    adds      what a finger, the glove, the link, passivity, a log and others add: images and runs
              with and without
    goal      library and scene of `minimal` on Cortex-M3 and M0

--short: no variants are built or run: of adds those between scenes, goal for what size.sh has
built.
--update: the tables of docs/TABLES.md anew, between <!-- costs NAME --> and <!-- end -->.
Instructions of modules and adds are those of this machine's code, by callgrind: the mean of the
ticks that size.sh counts.
Exit status: 0 ok, 1 the walk over the relocations does not find what the linker kept, 2 bad usage,
3 a tool is missing.
"""
import argparse
import csv
import glob
import math
import os
import re
import shutil
import sys

sys.dont_write_bytecode = True
from adds import GOAL_HEAD, all_adds, goal
from built import AT, FEATURES, OWN, PORTS, SCENES, Costs, instructions, module_of, scenes


def bars(out, rows):
    """What adds.plt draws: three panels (text, RAM, instructions), a group for each addition, a bar
    for each port."""
    whats = list(dict.fromkeys(r[0] for r in rows))
    assert not any("," in w for w in whats)  # gnuplot would end them there
    points = []
    for what, port, text, data, bss, insn, _ in rows:
        ram = "-" if data == "-" or bss == "-" else str(int(data) + int(bss))
        for panel, value in enumerate((text, ram, insn), 1):
            if value != "-":
                points.append([panel,
                               len(whats) - whats.index(what) + 0.26 *
                               (1 - list(PORTS).index(port)), list(PORTS).index(port),
                               max(1, int(value)), value])
    save(out, "adds_bars", ["panel", "y", "port", "value", "label"], points)
    save(out, "adds_names", ["y", "name"], [[len(whats) - k, w] for k, w in enumerate(whats)])


def save(out, name, head, rows):
    with open("%s/%s.csv" % (out, name), "w", encoding="utf-8", newline="") as f:
        csv.writer(f).writerows([head] + rows)


def table(head, rows):
    return "\n".join("| %s |" % " | ".join(str(c) for c in r)
                     for r in [head, ["--"] * len(head)] + rows) + "\n"


def matrix(rows, port, column, all_modules):
    """Module x scene of one column of the modules' rows."""
    cells = {(r[2], r[0]): r[column] for r in rows if r[1] == port}
    return [[m] + [cells.get((m, s), "") for s in SCENES] for m in all_modules]


def modules_of(costs):
    rows = []
    insn = {s: instructions(s) for s in SCENES}
    for (scene, port), c in costs.items():
        for m in sorted(c.kept):
            if m.startswith("lib/"):
                n = insn[scene].get(m) if port == "posix" else None
                rows.append([scene, port, m[4:], *c.image.bytes_of(c.kept[m]), c.whole(m),
                             "" if n is None else "%.1f" % n, c.why(m)])
    return rows


def own_insn():
    """Instructions per tick of the scenes' own code, in their order."""
    sums = [sum(v for k, v in instructions(s).items() if not k.startswith("lib/") and
                k != "size/ticks") for s in SCENES]
    return ["%.1f" % v if v else "" for v in sums]


def cells(out, tables):
    """What modules.plt draws: a panel for each table, a square for each number, by its size; and
    the rows' names."""
    names = [r[0] for r in zip_rows(tables)]
    points = [[k + 1, x, len(names) - y, "%.4f" % math.log10(max(1.0, float(v))), "%.0f" % float(v)]
              for k, t in enumerate(tables) for y, name in enumerate(names)
              for r in t if r[0] == name for x, v in enumerate(r[1:], 1) if v not in ("", 0)]
    save(out, "modules_cells", ["panel", "x", "y", "log10", "label"], points)
    save(out, "modules_names", ["y", "name"], [[len(names) - y, n] for y, n in enumerate(names)])


def zip_rows(tables):
    """Rows of the first table that hold a number in any."""
    return [r for r in tables[0]
            if any(c != "" for t in tables for q in t if q[0] == r[0] for c in q[1:])]


def write_modules(out, rows, costs):
    head = ["scene", "port", "module", "text_B", "data_B", "bss_B", "of_text_B", "insn_per_tick",
            "why"]
    save(out, "modules", head, rows)
    everything = sorted(os.path.basename(f)[:-2] for f in glob.glob("lib/src/[!r]*/*.c"))
    port = "mps2" if any(r[1] == "mps2" for r in rows) else "posix"
    bytes_, insn = matrix(rows, port, 3, everything), matrix(rows, "posix", 7, everything)
    bytes_.append([OWN] + [costs[s, port].image.bytes_of(costs[s, port].own())[0] for s in SCENES])
    insn.append([OWN] + own_insn())
    save(out, "modules_bytes", ["module", *SCENES], bytes_)
    save(out, "modules_insn", ["module", *SCENES], insn)
    sums = ["all"] + [sum(r[k] for r in bytes_ if r[k] != "") for k in range(1, len(SCENES) + 1)]
    cells(out, (bytes_, insn))
    nowhere = [r[0] for r in bytes_ if not any(c != "" for c in r[1:])]
    text = ["Bytes of code and constants in the Cortex-M3 image (of the module's own), and why: "
            "the shortest way from the scene's functions.\n"]
    text.append(table(["module", *SCENES], [r for r in bytes_ if r[0] not in nowhere] + [sums]))
    text.append("In none of these images: %s.\n" % ", ".join(nowhere))
    for scene in SCENES:
        ways = [r for r in rows if r[0] == scene and r[1] == port]
        text.append("**%s**: %s.\n" %
                    (scene,
                     "; ".join("%s %s of %s (`%s`)" % (r[2], r[3], r[6], r[8]) for r in ways)))
    with open(out + "/modules.md", "w", encoding="utf-8") as f:
        f.write("\n".join(text))
    insn = [r for r in insn if any(c != "" for c in r[1:])]
    return "\n".join(
        [table(["bytes", *SCENES], [r for r in bytes_ if r[0] not in nowhere] + [sums]), text[2],
         table(["instructions", *SCENES],
               [r[:1] + ["%.0f" % float(c) if c else "" for c in r[1:]] for r in insn]),
         "Why each is in `minimal` (other scenes: `build/size/costs/modules.md`):\n",
         table(["module", "bytes", "of", "shortest way"],
               [[r[2], r[3], r[6], "`%s`" % r[8]] for r in rows
                if r[0] == "minimal" and r[1] == port])])


def write_features(out, costs):
    rows = []
    for (scene, port), c in costs.items():
        for what, modules in FEATURES:
            went = c.without(modules)
            if any(went):
                rows.append([scene, port, what, *went])
    save(out, "features", ["scene", "port", "what", "text_B", "data_B", "bss_B"], rows)
    cells = {(r[2], r[0]): r[3] for r in rows if r[1] == "mps2"}
    return table(["without (text, mps2)", *SCENES],
                 [[w] + [cells.get((w, s), "") for s in SCENES] for w, _ in FEATURES
                  if any((w, s) in cells for s in SCENES)])


def all_costs(rows):
    costs = {(r[0], r[1]): Costs(r[0], r[1]) for r in rows if r[0] in SCENES}
    for (scene, port), c in costs.items():
        if c.lost():
            raise SystemExit("costs: %s on %s: kept, and nothing is found that leads there: %s" % (
                scene, port, ", ".join("%s %s" % (module_of(n[0]), n[1]) for n in c.lost()[:5])))
    return costs


def update(texts, path="docs/TABLES.md"):
    with open(path, encoding="utf-8") as f:
        page = f.read()
    for name, text in texts.items():
        page, n = re.subn(r"(<!-- costs %s -->\n).*?(<!-- end -->)" % name,
                          lambda m: m[1] + "\n" + text.strip() + "\n\n" + m[2], page, flags=re.S)
        if n != 1:
            raise SystemExit("costs: %s: %d places for %s" % (path, n, name))
    with open(path, "w", encoding="utf-8") as f:
        f.write(page)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0],
                                     epilog=__doc__.split("\n", 2)[2],
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default=os.environ.get("OUT", AT + "/costs"))
    parser.add_argument("--short", action="store_true", default=bool(os.environ.get("SHORT")))
    parser.add_argument("--update", action="store_true")
    args = parser.parse_args()
    if args.update and args.short:
        parser.error("--update wants all of it")
    if not os.path.isfile("test/figures/size/size.sh"):
        parser.error("run it at the top of the tree")
    if not shutil.which("gcc"):
        print("gcc is missing")
        return 3
    os.makedirs(args.out, exist_ok=True)
    rows = [r for r in scenes() if r[1] in PORTS] # stm32f405: make size alone
    has = [p for p in PORTS if any(r[1] == p for r in rows)]
    for port in PORTS:
        if port not in has:
            print("skipped: %s: no %sgcc" % (port, PORTS[port][1]))
    costs = all_costs(rows)
    texts = {"modules": write_modules(args.out, modules_of(costs), costs)}
    features = write_features(args.out, costs)
    goals = goal(args.short) if "mps2" in has else []
    save(args.out, "goal", GOAL_HEAD, goals)
    head = ["scene", "port", "text_B", "data_B", "bss_B", "stack_B", "insn_per_tick", "symbols"]
    save(args.out, "cost", head, rows)
    texts["cost"] = (table(head, rows) + "\nLibrary and scene of `minimal` alone, without port, "
                                         "loop and grip. The goal is 3072 B and 256 B. Frozen: "
                                         "`make image FROZEN=1000`.\n\n" + table(GOAL_HEAD, goals))
    added = all_adds(rows, costs, args.short, has)
    head = ["what", "port", "text_B", "data_B", "bss_B", "insn_per_tick", "how"]
    save(args.out, "adds", head, added)
    bars(args.out, added)
    texts["adds"] = (table(head, added) +
                     "\nBytes that leave the Cortex-M3 image without a feature: its modules, and "
                     "what only they call.\n\n" + features)
    for name in ("cost", "adds"):
        with open("%s/%s.md" % (args.out, name), "w", encoding="utf-8") as f:
            f.write(texts[name])
    if args.update:
        update(texts)
    for name in ("cost", "modules", "adds"):
        print("costs: %s/%s.csv, .md" % (args.out, name))
    return 0


if __name__ == "__main__":
    sys.exit(main())
