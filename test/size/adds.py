"""What one thing more adds: images and runs with and without it; and what `minimal` is on Cortex-M."""
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
    stale = "%s/%s/%s/test/size/variant.o" % (VARIANT, directory, scene)
    if os.path.exists(stale):
        os.remove(stale)  # make does not know what it was compiled with
    run(["make", "-s", "PORT=" + directory, "SCENE=" + scene, "B=" + VARIANT, "PORT_SUFFIX=" + suffix, "CC=%sgcc" % cross]
        + (["CROSS=" + cross] if cross else []) + (["CARDS=none"] if port == "pc104" and not [w for w in words if "CARDS" in w] else [])
        + list(words) + [elf])
    return elf, size_of(elf, cross)


def size_of(elf, cross):
    return [int(v) for v in run([cross + "size", elf]).splitlines()[1].split()[:3]]


def ticks(scene, *words):
    """Instructions of a whole tick of a variant on this machine, or None."""
    tool = AT + "/ticks-" + scene
    if not shutil.which("valgrind"):
        return None
    n = int(run([tool, "3000", "run", *words]))
    p = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--toggle-collect=counted_whole_tick", tool,
                        "3000", "run", *words], text=True, capture_output=True, check=True)
    return int(re.search(r"Collected : (\d+)", p.stderr)[1]) / n


def on_mps2(elf, shift=6):
    """Instructions of the dearest tick, of 2^shift ns each: the timer counts 40 ns."""
    out = run(["ports/mps2/run.sh", elf], check=False, QEMU_FLAGS="-icount shift=%d,sleep=off" % shift, TIMEOUT_s="300")
    m = re.search(r"cycles per tick \d+ \.\. (\d+)", out)
    return int(m[1]) * 40 / 2 ** shift if m else None


def on_pc104(elf, *words):
    out = run(["ports/pc104/run.sh", elf, "ticks=2000", "uncalibrated=1", *words], check=False, QEMU_FLAGS="-icount shift=0,sleep=off", TIMEOUT_s="300")
    m = re.search(r"cycles per tick .* (\d+)\r?$", out, re.M)
    return int(m[1]) if m else None


def shares(port):
    directory, cross = PORTS[port]
    obj = "%s/shares-%s.o" % (AT, directory)
    run([cross + "gcc", "-std=c99", "-Ilib/include", "-Iexamples"] +
        {"mps2": ["-mcpu=cortex-m3", "-mthumb"], "pc104": ["-march=i686"]}.get(port, []) + ["-c", "test/size/shares.c", "-o", obj])
    return {m[2]: int(m[1], 16) for m in re.finditer(r"^[0-9a-f]+ ([0-9a-f]+) R share_(\w+)", run([cross + "nm", "-S", obj]), re.M)}


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
                self.add(what, port, less(a, b), None, i - j if i and j else None, "image and run of %s less those of %s" % (more, few))

    def full_box(self, has):
        """Fingers, glove and link are in every image of the full box: what they take there, and what a tick without them does not."""
        f = {n: ticks("bilateral", "link=2", "0x8610=%d" % ((1 << n) - 1)) for n in range(1, 6)}
        glove = ticks("bilateral", "link=1"), ticks("bilateral", "link=1", "glove=0", "0x8615=0")
        link = ticks("bilateral", "link=0"), glove[0], ticks("bilateral", "link=2")
        for port in has:
            costs, share = self.costs["bilateral", port], shares(port)
            if port == "posix":
                one, how = f[5] and (f[5] - f[1]) / 4, "run with 1 .. 5 fingers: " + ", ".join("%.0f" % f[n] for n in f if f[n])
            else:
                one, how = self.fingers_on(port)
            self.add("one more finger of the full box", port, [0, 0, 0], share["finger"], one, how + "; memory for five is always there")
            here = port == "posix" and glove[0]
            self.add("glove: 22 angles", port, costs.without(FEATURES[0][1]), share["glove"], here and glove[0] - glove[1] or None,
                     "its modules, its share of memory; run with a frame in every tick, and with none")
            self.add("link to a world with nobody there", port, costs.without(FEATURES[3][1]), share["link"], here and link[1] - link[0] or None,
                     "its modules, its share of memory; run with states written every fifth tick, and with none")
            if here:
                self.add("link: a world that answers", port, [0, 0, 0], 0, link[2] - link[1], "planes, and contacts with them; beside nobody there")

    def fingers_on(self, port):
        if port == "mps2":
            n = [on_mps2(image("bilateral", port, "-f%d" % m, "SCENE_MAIN=test/size/variant.c examples/deadman.c examples/loop.c", "TICKS=500",
                               "SCENE_CFLAGS=-DVARIANT_FINGERS=%d" % m)[0], 4) for m in (1, 31)]
        else:
            n = [on_pc104("%s/pc104/bilateral.elf" % AT, "fingers=%d" % m) for m in (1, 31)]
        ok = all(v is not None for v in n)
        return (n[1] - n[0]) / 4 if ok else None, "dearest tick with 1 and 5 fingers: " + (", ".join("%.0f" % v for v in n) if ok else "did not run")

    def log(self, has):
        main = "test/size/variant.c examples/deadman.c examples/log.c examples/loop.c"
        for scene in ("drop", "bilateral"):
            for port in has:
                if port == "pc104":
                    continue
                with_log = image(scene, port, "-log", "SCENE_MAIN=" + main, "TICKS=2000", "SCENE_CFLAGS=-DVARIANT_LOG")[1]
                plain = image(scene, port, "-plain", "SCENE_MAIN=" + main, "TICKS=2000", "SCENE_CFLAGS=")[1]
                words = ("link=2",) if scene == "bilateral" else ("link=0",)
                insn = (ticks(scene, *words, "log=1"), ticks(scene, *words)) if port == "posix" else (None, None)
                self.add("log of every tick (%s)" % scene, port, less(with_log, plain), None, insn[0] and insn[0] - insn[1],
                         "image and run with and without examples/log.c" if port == "posix" else "image with and without examples/log.c")

    def of_pc104(self):
        base = self.of_table("drop", "pc104")[0]
        for what, suffix, word in (("registers by Modbus (drop)", "-plain", "MODBUS=no"), ("black box (drop)", "-unboxed", "SCENE_BOX_B=")):
            self.add(what, "pc104", less(base, image("drop", "pc104", suffix, word)[1]), None, None, "image with and without: make " + word)
        self.add("drivers of the cards (drop)", "pc104", less(image("drop", "pc104", "-real", "CARDS=real")[1], base), None, None,
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


GOAL_HEAD = ["processor", "compiled", "text_B", "data_B", "bss_B", "RAM_B", "with loop and grip: text_B", "RAM_B", "insn/tick", "of the goal's 3072 B, 256 B"]


def goal(short, insn_M3):
    """Library and scene of minimal, by processor and optimisation."""
    rows = []
    ways = [("Cortex-M3", "-O2", None)]
    if not short:
        m0 = ("CFLAGS=-mcpu=cortex-m0", "LDFLAGS=-mcpu=cortex-m0", "SCENE_LIBS=-lgcc")
        ways += [("Cortex-M3", "-Os", ("O=s",)), ("Cortex-M0", "-O2", m0), ("Cortex-M0", "-Os", m0 + ("O=s",))]
    for cpu, option, words in ways:
        at = AT
        if words:
            at = "%s/%s%s" % (AT, cpu[-2:].lower(), option)
            run(["make", "-s", "PORT=mps2", "SCENE=minimal", "CROSS=arm-none-eabi-", "CC=arm-none-eabi-gcc", "B=" + at, *words, at + "/mps2/minimal.elf"])
        costs = Costs("minimal", "mps2", at)
        alone = costs.library_and_scene(True)
        helpers = costs.image.bytes_of(costs.kept.get("compiler", []))
        ours = [a + b + c for a, b, c in zip(costs.library_and_scene(False), helpers,
                                             costs.image.bytes_of(n for m in ("examples/loop", "examples/deadman", "examples/image") for n in costs.kept[m]))]
        alone = [a + b for a, b in zip(alone, helpers)]
        insn = on_mps2(at + "/mps2/minimal.elf") if words else insn_M3
        rows.append([cpu, option, *alone, alone[1] + alone[2], ours[0], ours[1] + ours[2], "-" if insn in (None, "-") else round(float(insn)),
                     "%.0f %%, %.0f %%" % (100 * alone[0] / 3072, 100 * (alone[1] + alone[2]) / 256)])
    return rows
