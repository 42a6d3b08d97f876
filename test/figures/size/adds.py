# SPDX-License-Identifier: MIT
"""What one thing more adds: images and runs with and without it; and what `minimal` is on
Cortex-M."""
import os
import re
import shutil
import subprocess

from built import AT, FEATURES, PORTS, Costs, run, say

VARIANT = AT + "/variant"

def image(scene, port, suffix, *words):
    """Builds it in B/size/variant; its [text, data, bss]."""
    directory, cross = PORTS[port]
    elf = "%s/%s/%s%s.elf" % (VARIANT, directory, scene, suffix)
    stale = "%s/%s/%s/test/figures/size/variant.o" % (VARIANT, directory, scene)
    if os.path.exists(stale):
        os.remove(stale)  # make does not know what it was compiled with
    run(["make", "-s", "PORT=" + directory, "SCENE=" + scene, "B=" + VARIANT,
         "PORT_SUFFIX=" + suffix, "CC=%sgcc" % cross]
        + (["CROSS=" + cross] if cross else []) +
        (["CARDS=none"] if port == "pc104" and not [w for w in words if "CARDS" in w] else [])
        + list(words) + [elf])
    return elf, size_of(elf, cross)


def size_of(elf, cross):
    return [int(v) for v in run([cross + "size", elf]).splitlines()[1].split()[:3]]


def i686_tool(scene):
    """ticks.c around the pc104 image's own objects, for this machine's kernel."""
    at, tool = AT + "/pc104", "%s/ticks-%s-i686" % (AT, scene)
    own = [os.path.join(d, f) for d, _, files in os.walk("%s/examples/%s" % (at, scene))
           for f in files if f.endswith(".o")]
    own += [at + "/lib/src/run/calib_set.o"] + ([at + "/examples/glove/cal.o"]
                                                if scene == "bilateral" else [])
    run(["i686-linux-gnu-gcc", "-std=c99", "-O2", "-g", "-static", "-no-pie", "-Ilib/include",
         "-Iexamples", "-DEXH_SCENE=exh_scene_" + scene, "test/figures/size/ticks.c",
         "test/figures/size/world.c", "test/no_board.c", "lib/src/run/log.c", *own,
         at + "/libexhand.a", "-o", tool])
    return tool


def ticks(port, scene, *words):
    """Instructions of a whole tick of a variant, the mean of 3000, by callgrind; None where that
    cannot be."""
    if port == "mps2" or not shutil.which("valgrind"):
        return None
    tool = "%s/ticks-%s" % (AT, scene) + ("-i686" if port == "pc104" else "")
    n = int(run([tool, "3000", "run", *words]))
    p = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
                        "--toggle-collect=counted_whole_tick", tool, "3000", "run", *words],
                       text=True, capture_output=True, check=False)
    m = re.search(r"Collected : (\d+)", p.stderr)
    return int(m[1]) / n if m else None


def on_mps2(elf, shift=6):
    """Instructions of the dearest tick, of 2^shift ns each: the timer counts 40 ns."""
    out = run(["ports/mps2/run.sh", elf], check=False,
              QEMU_FLAGS="-icount shift=%d,sleep=off" % shift, TIMEOUT_s="300")
    m = re.search(r"cycles per tick \d+ \.\. (\d+)", out)
    return int(m[1]) * 40 / 2 ** shift if m else None


def shares(port):
    directory, cross = PORTS[port]
    obj = "%s/shares-%s.o" % (AT, directory)
    run([cross + "gcc", "-std=c99", "-Ilib/include", "-Iexamples"] +
        {"mps2": ["-mcpu=cortex-m3", "-mthumb"], "pc104": ["-march=i686"]}.get(port, []) +
        ["-c", "test/figures/size/shares.c", "-o", obj])
    return {m[2]: int(m[1], 16) for m in re.finditer(r"^[0-9a-f]+ ([0-9a-f]+) R share_(\w+)",
                                                     run([cross + "nm", "-S", obj]), re.M)}


def less(a, b):
    return [x - y for x, y in zip(a, b)]


class Adds:
    """The table, row by row; None: not measured there."""

    def __init__(self, table, costs):
        self.rows, self.table, self.costs = [], {(r[0], r[1]): r[2:] for r in table}, costs

    def add(self, what, port, bytes_, ram, insn, how):
        text, data, bss = bytes_ or (None, None, None)
        if ram is not None:
            bss = ram
        cells = [what, port, text, data, bss, None if insn is None else round(insn)]
        self.rows.append(["-" if c is None else str(c) for c in cells] + [how])

    def of_table(self, scene, port):
        row = self.table.get((scene, port))
        return row and [int(v) for v in row[:3]], row and (None if row[4] == "-" else float(row[4]))

    def between(self, what, more, few):
        for port in PORTS:
            (a, i), (b, j) = self.of_table(more, port), self.of_table(few, port)
            if a and b:
                self.add(what, port, less(a, b), None, i - j if i and j else None,
                         "image and run of %s less those of %s" % (more, few))

    def full_box(self, has):
        """Fingers, glove and link are in every image of the full box: what they take there, and
        what a tick without them does not."""
        for port in has:
            costs, share = self.costs["bilateral", port], shares(port)
            if port == "pc104":
                i686_tool("bilateral")
            none, off, on, world = (ticks(port, "bilateral", *words) for words in (
                ("link=0",), ("link=1", "glove=0", "0x8615=0"), ("link=1",), ("link=2",)))
            self.add("one more finger of the full box", port, [0, 0, 0], share["finger"],
                     *self.fingers_on(port))
            self.add("glove: 22 angles", port, costs.without(FEATURES[0][1]), share["glove"],
                     on and on - off, "its modules and memory; run with a frame in every tick, "
                                      "and with none")
            self.add("link without a world", port, costs.without(FEATURES[3][1]),
                     share["link"], on and on - none, "its modules and memory; run with a state "
                                                      "in every fifth tick, and with none")
            if on:
                self.add("link with a world", port, [0, 0, 0], 0, world - on,
                         "planes, and contacts with them; over a link without a world")

    def fingers_on(self, port):
        """(Instructions of one more, how they were seen)."""
        if port == "mps2":
            main = "SCENE_MAIN=test/figures/size/variant.c lib/src/run/deadman.c lib/src/run/loop.c"
            n = [on_mps2(image("bilateral", port, "-f%d" % m, main, "TICKS=500",
                               "SCENE_CFLAGS=-DVARIANT_FINGERS=%d" % m)[0], 4) for m in (1, 31)]
            how = "dearest tick with 1 and 5 fingers"
        else:
            n = [ticks(port, "bilateral", "link=2", "0x8610=%d" % ((1 << k) - 1))
                 for k in range(1, 6)]
            how = "run with 1 .. 5 fingers"
        if None in n:
            return None, how + ": did not run"
        return ((n[-1] - n[0]) / 4,
                "%s: %s; memory is for five" % (how, ", ".join("%.0f" % v for v in n)))

    def log(self, has):
        main = ("SCENE_MAIN=test/figures/size/variant.c lib/src/run/deadman.c lib/src/run/log.c "
                "lib/src/run/loop.c")
        for scene, words in (("drop", ("link=0",)), ("bilateral", ("link=2",))):
            for port in has:
                bytes_ = None
                if port == "pc104":  # its main() has the log in all images but those of constants
                    i686_tool(scene)
                    bytes_ = self.costs[scene, port].without(FEATURES[5][1])
                    how = "its modules"
                else:
                    bytes_ = less(
                        *(image(scene, port, suffix, main, "TICKS=500", "SCENE_CFLAGS=" + flag)[1]
                          for suffix, flag in (("-log", "-DVARIANT_LOG"), ("-plain", ""))))
                    how = "image with and without lib/src/run/log.c"
                insn = ticks(port, scene, *words, "log=1"), ticks(port, scene, *words)
                self.add("log of every tick (%s)" % scene, port, bytes_, None,
                         insn[0] and insn[0] - insn[1],
                         how + ("; run with and without it" if insn[0] else ""))

    def of_pc104(self):
        base = self.of_table("drop", "pc104")[0]
        for what, suffix, word in (("registers by Modbus (drop)", "-plain", "MODBUS=no"),
                                   ("black box (drop)", "-unboxed", "SCENE_BOX_B=")):
            self.add(what, "pc104", less(base, image("drop", "pc104", suffix, word)[1]), None, None,
                     "image with and without: make " + word)
        self.add("drivers of the cards (drop)", "pc104",
                 less(image("drop", "pc104", "-real", "CARDS=real")[1], base), None, None,
                 "image with CARDS=real and none")


def all_adds(rows, costs, short, has):
    adds = Adds(rows, costs)
    adds.between("passivity and rule of gains", "guarded", "drop")
    adds.between("drop over minimal", "drop", "minimal")
    if not short:
        say("variants (a minute)")
        adds.full_box(has)
        adds.log(has)
        if "pc104" in has:
            adds.of_pc104()
    return adds.rows


GOAL_HEAD = ["processor", "set-up on", "compiled", "text_B", "data_B", "bss_B", "RAM_B",
             "with loop and grip: text_B", "RAM_B", "stack_B", "insn/tick",
             "share of 3072 B, 256 B"]
FROZEN = "1000"
# Where set-up is, how it is compiled, and the arguments of make.
GOAL_WAYS = [("target", "-O2", ()), ("target", "-Os", ("O=s",)),
             ("frozen", "-O2", ("FROZEN=" + FROZEN, "WHOLE=")),
             ("frozen", "-Os", ("O=s", "FROZEN=" + FROZEN, "WHOLE=")),
             ("frozen", "with -flto, -O2", ("FROZEN=" + FROZEN, "WHOLE=-flto -ffat-lto-objects")),
             ("frozen", "with -flto, -Os", ("O=s", "FROZEN=" + FROZEN))]


def worst_stack(at, name):
    """Bytes of the image's deepest path; the objects that the scene is in come last, since names of
    theirs are in the library's, too."""
    found = ["%s/mps2/lib/src/run/loop.o" % at]
    found += [os.path.join(d, f)[:-3] + ".o" for top in ("lib", "examples/minimal", "minimal")
              for d, _, files in os.walk("%s/mps2/%s" % (at, top))
              for f in files if f.endswith(".ci")]
    mine = ["%s/mps2/%s.elf.ltrans0.ltrans.o" % (at, name)]
    if not os.path.exists(mine[0]):
        mine = [os.path.join(d, f)[:-3] + ".o"
                for d, _, files in os.walk("%s/mps2/frozen/parts" % at)
                for f in files if f.endswith(".ci")]
    return int(run(["python3", "test/figures/size/stack.py", "--objdump", "arm-none-eabi-objdump",
                    *found, *mine]).split()[0])


def goal(short):
    """Library and scene of minimal, by processor, where set-up is, and optimisation; short: the one
    that size.sh has built."""
    rows = [["Cortex-M3", *GOAL_WAYS[0][:2], *goal_of(AT, "minimal")]]
    for cpu in () if short else ("Cortex-M3", "Cortex-M0"):
        for where, compiled, words in GOAL_WAYS[cpu == "Cortex-M3":]:
            at = "%s/goal/%s%s%s" % (AT, cpu[-2:].lower(), where,
                                     compiled.replace(", ", "").replace(" ", ""))
            name = "minimal" + ("-frozen-" + FROZEN if where == "frozen" else "")
            m0 = cpu == "Cortex-M0"
            run(["make", "-s", "PORT=mps2", "SCENE=minimal", "CROSS=arm-none-eabi-",
                 "CC=arm-none-eabi-gcc", "B=" + at, *words,
                 "CFLAGS=-fcallgraph-info=su" + " -mcpu=cortex-m0" * m0,
                 *["LDFLAGS=-mcpu=cortex-m0"] * m0, "SCENE_LIBS=-save-temps" + " -lgcc" * m0,
                 "%s/mps2/%s.elf" % (at, name)])
            rows.append([cpu, where, compiled, *goal_of(at, name)])
    return rows


def goal_of(at, name):
    """The numbers of a row."""
    costs = Costs("minimal", "mps2", at, name)
    helpers = costs.image.bytes_of(costs.helpers())
    ours = [a + b + c for a, b, c in zip(costs.library_and_scene(False),
                                         costs.image.bytes_of(costs.kept.get("compiler", [])),
                                         costs.image.bytes_of(n
                                                              for m in ("run/loop",
                                                                        "run/deadman",
                                                                        "run/image")
                                                              for n in costs.kept[m]))]
    alone = [a + b for a, b in zip(costs.library_and_scene(True), helpers)]
    insn = on_mps2("%s/mps2/%s.elf" % (at, name))
    return [*alone, alone[1] + alone[2], ours[0], ours[1] + ours[2], worst_stack(at, name),
            "-" if insn is None else round(insn),
            "%.0f %%, %.0f %%" % (100 * alone[0] / 3072, 100 * (alone[1] + alone[2]) / 256)]
