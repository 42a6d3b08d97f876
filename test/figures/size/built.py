# SPDX-License-Identifier: MIT
"""What size.sh has built and counted: images, their modules, instructions by module."""
import os
import re
import subprocess
import sys

import linked

B = os.environ.get("B", "build")
AT = B + "/size"
# Not custom, which is drop and whatever is in its slot.
SCENES = ("minimal", "drop", "guarded", "glove", "bilateral", "bringup", "calibrate")
PORTS = {"posix": ("template", ""), "pc104": ("pc104", "i686-linux-gnu-"),
         "mps2": ("mps2", "arm-none-eabi-")}
SOURCES = ("lib", "examples", "ports/cards", "ports/mps2", "ports/pc104", "ports/template",
           "ldscripts", "Makefile",
           "test/no_board.c") + tuple("test/figures/size/" + f
                                      for f in ("size.sh", "stack.py", "ticks.c", "world.c",
                                                "world.h"))
OWN = "scene itself"
# of scene and library as one program (make FROZEN=...): what no other object needs is one section
# each
WHOLE = re.compile(r"[.]ltrans[.]o$")
# what the port does then is no need of the scene's
HOOK = re.compile(r"^exh_(assert_failed|board_)")
FEATURES = (("glove: 22 angles", ("lib/glove", "lib/glove_cal", "lib/glove_fit", "glove/cal")),
            ("fingertips of five fingers", ("lib/hand", "lib/hand_hit2")),
            ("contacts before they are touched", ("lib/precontact",)),
            ("link to a world", ("lib/wire", "bilateral/wire", "bilateral/trace")),
            ("passivity and rule of gains", ("lib/passivity", "lib/gains")),
            ("log", ("run/log", "lib/record")),
            ("registers (Modbus)", ("lib/modbus", "lib/modbus_rtu", "pc104/modbus")),
            ("calibration of fingers", ("lib/calibrate", "run/calib_set")),
            ("parameters at run time", ("lib/params", "lib/signal")),
            ("self-test", ("lib/selftest",)), ("guard of memory", ("lib/integrity",)),
            ("watch of speed and encoder", ("lib/motion",)), ("supply", ("lib/supply",)),
            ("state machine and gate", ("lib/safety", "lib/gate")),
            ("current follows what was asked", ("lib/tracking",)))


def say(text):
    print("costs: " + text, file=sys.stderr, flush=True)


def run(command, check=True, **env):
    p = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                       check=False, env=dict(os.environ, MAKEFLAGS="", **env))
    if check and p.returncode:
        sys.stderr.write(p.stdout + p.stderr)
        raise SystemExit("costs: %s: exit status %d" % (" ".join(command)[:120], p.returncode))
    return p.stdout


def newest_source():
    files = [f for f in SOURCES if os.path.isfile(f)]
    for top in (d for d in SOURCES if os.path.isdir(d)):
        files += [os.path.join(d, f) for d, _, names in os.walk(top)
                  for f in names if f.endswith((".c", ".h", ".S", ".ld", ".mk"))]
    return max(os.path.getmtime(f) for f in files)


def scenes():
    """Rows of size.sh's table; it is made first if it is not there, not whole, or old."""
    path = AT + "/table.txt"
    for again in (True, False):
        if os.path.exists(path) and os.path.getmtime(path) > newest_source():
            with open(path, encoding="utf-8") as f:
                rows = [line.split() for line in f]
            if {r[0] for r in rows} >= set(SCENES):
                return [r for r in rows if r[0] in SCENES]
        if again:
            say("test/figures/size/size.sh (two minutes)")
            run(["test/figures/size/size.sh"], B=B)
    raise SystemExit("costs: test/figures/size/size.sh left no whole table")


def module_of(place):
    """'lib/filter', 'run/loop', 'drop/drop', 'pc104/modbus', 'compiler', of an object's path."""
    words = place[:-2].split("/")
    if words[-4:-2] == ["lib", "src"] and words[-2] != "run":
        return "lib/" + words[-1]
    return "/".join(words[-2:]) if place.startswith(AT) else "compiler"


class Costs:
    """An image, its modules, and the ways to them."""

    def __init__(self, scene, port, at=AT, name=None):
        self.scene, self.port = scene, port
        directory, self.cross = PORTS[port]
        self.image = linked.Image("%s/%s/%s.map" % (at, directory, name or scene),
                                  self.cross + "objdump")
        hook = lambda node: HOOK.match(linked.word(node)) is not None
        self.root, self.main = self.image.node("exh_scene_" + scene), self.image.node("main")
        self.of_scene = self.image.walk([self.root], hook)
        self.of_main = self.image.walk([self.main])
        self.kept = {}
        for node in self.image.sizes:
            self.kept.setdefault(module_of(node[0]), []).append(node)

    def lost(self):
        """What the linker kept of the library and the walk does not find: nothing, or the ways are
        not true."""
        return [n for n in self.image.sizes
                if module_of(n[0]).startswith("lib/") and n not in self.of_main]

    def why(self, module):
        for came in (self.of_scene, self.of_main):
            for node in came:
                if node in self.kept[module]:
                    words = linked.way(came, node)
                    return " > ".join(words[1:] if came is self.of_scene else words)
        return "-"

    def whole(self, module):
        """Text of the module's object, linked or not."""
        obj = self.image.objects[self.kept[module][0][0]]
        return sum(size for section, size in obj.sizes.items() if linked.kind_of(section) == "text")

    def without(self, modules):
        """Bytes that would go if nothing led into these."""
        left = self.image.walk([self.main], lambda node: module_of(node[0]) in modules)
        return self.image.bytes_of(n for n in self.of_main if n not in left)

    def own(self):
        """Sections of the scene itself, without library, loop or port."""
        ours = re.compile(r"^(%s|drop|glove)/|^run/calib_set$" % self.scene)
        return [n for n in self.image.sizes if ours.match(module_of(n[0]))]

    def library_and_scene(self, of_scene_alone):
        """[text, data, bss] of library and scene: all of them in the image, or what the scene leads
        to."""
        own = set(self.own())
        return self.image.bytes_of(n
                                   for n in (self.of_scene if of_scene_alone else self.image.sizes)
                                   if n in own or module_of(n[0]).startswith("lib/") or
                                   WHOLE.search(n[0]))

    def helpers(self):
        """Sections of the compiler's own functions that the scene leads to: not what the port
        divides with."""
        wanted, names, found = self.image.wants(self.of_scene), {}, []
        for node in self.kept.get("compiler", []):
            archive, _, member = node[0].rstrip(")").partition("(")
            if member and archive not in names:
                names[archive] = run([self.cross + "nm", "-g", "-A", "--defined-only", archive])
            if (member and
                wanted & set(re.findall(r":%s:\S+ \S (\S+)" % re.escape(member), names[archive]))):
                found.append(node)
        return found


def instructions(scene):
    """{module: instructions per tick} by callgrind, of what size.sh counted."""
    out = AT + "/callgrind-%s.out" % scene
    if not os.path.exists(out):
        return {}
    with open(AT + "/callgrind-%s.ticks" % scene, encoding="utf-8") as f:
        ticks = int(f.read().split()[0])
    names, sums, here, called = {}, {}, None, False
    with open(out, encoding="utf-8", errors="replace") as f:
        for line in f:
            m = re.match(r"(fl|cfi|cfl|fi|fe)=(\(\d+\))(?: (.*))?", line)
            if m:
                if m[3]:
                    names[m[2]] = m[3].rstrip()
                if m[1] == "fl":
                    here = re.sub(r"\.c$", "",
                                  "/".join(re.sub(r"lib/src/(?!run/)\w+/", "lib/",
                                                  names[m[2]]).split("/")[-2:]))
            elif line.startswith("calls="):
                called = True  # the next line is the callee's
            elif re.match(r"[+\-*\d]", line):
                if not called:
                    sums[here] = sums.get(here, 0) + int(line.split()[1])
                called = False
    return {k: v / ticks for k, v in sums.items()}


