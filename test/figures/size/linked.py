# SPDX-License-Identifier: MIT
"""What a linked image consists of, and why: out of the linker's map, and of the relocations of the
objects that it was linked from.

Every function and table of ours has a separate section (-ffunction-sections). The linker keeps each
section that a kept section refers to. The same walk here, over the objects' relocations, shows the
way to a module. It also shows what the image would lose if some functions were never called.
"""
import glob
import re
import subprocess

INPUT = re.compile(r"^ (\.\S+|COMMON)(?:\s+(0x[0-9a-f]+)\s+(0x[0-9a-f]+)\s+(\S.*))?$")
REST = re.compile(r"^\s+(0x[0-9a-f]+)\s+(0x[0-9a-f]+)\s+(\S.*)$")
MEMBER = re.compile(r"^(.*)/libexhand\.a\(([^)]*)\)$")
SYMBOL = re.compile(r"^[0-9a-f]+ (.{7}) (\S+)\t[0-9a-f]+ (?:\.hidden |\.internal )?(.*)$")
HEADER = re.compile(r"^ *\d+ (\S+) +([0-9a-f]{8}) ")
RECORDS = re.compile(r"^RELOCATION RECORDS FOR \[(.*)\]:")
RELOCATION = re.compile(r"^[0-9a-f]+ +R_\S+ +(\S+?)([+-]0x[0-9a-f]+)?$")
KINDS = (("text", ("vectors", "text", "rodata", "data.rel.ro", "multiboot", "init")),
         ("data", ("data",)), ("bss", ("bss", "COMMON")))


def kind_of(section):
    """text (code and constants), data (initialised), bss, or None: nothing of the image's
    memory."""
    name = section.lstrip(".")
    for kind, begins in KINDS:
        if any(name == b or name.startswith(b + ".") for b in begins):
            return kind
    return None


def object_of(place):
    """The object file that a map names, our archive's members beside their sources in the build
    directory."""
    member = MEMBER.match(place)
    if not member:
        return place
    found = glob.glob("%s/lib/src/*/%s" % member.groups())
    if len(found) != 1:
        raise SystemExit("%s: %d objects of this name under lib/src" % (place, len(found)))
    return found[0]


def kept(path):
    """{(object, section): bytes} of what the map at path says is in the image."""
    sizes, name, on = {}, None, False
    with open(path, encoding="utf-8", errors="replace") as f:
        for line in f:
            line = line.rstrip("\n")
            on = on or line.startswith("Linker script and memory map")
            if not on:
                continue
            if line.startswith("/DISCARD/"):
                break
            m = INPUT.match(line)
            if m and m[2] is None:
                name = m[1]
                continue
            at = (m.groups() if m else (name,) + REST.match(line).groups() if name and
                  REST.match(line) else None)
            name = None
            if (at and kind_of(at[0]) and int(at[2], 16) and "size before" not in at[3] and
                not at[3].startswith("0x")):
                key = (object_of(at[3]), at[0])
                sizes[key] = sizes.get(key, 0) + int(at[2], 16)
    return sizes


class Object:
    """Symbols, and what each section refers to, of one object file."""

    def __init__(self, path, objdump):
        self.symbols, self.is_global, self.refers, self.sizes = {}, set(), {}, {}
        text = subprocess.run([objdump, "-h", "-t", "-r", path], check=True, capture_output=True,
                              text=True).stdout
        section = None
        for line in text.splitlines():
            records, symbol, relocation = (RECORDS.match(line), SYMBOL.match(line),
                                           RELOCATION.match(line))
            header = HEADER.match(line)
            if header and section is None:
                self.sizes[header[1]] = int(header[2], 16)
            elif records:
                section = records[1]
            elif symbol and symbol[2] not in ("*UND*", "*ABS*"):
                self.symbols[symbol[3]] = symbol[2]
                if symbol[1][0] in "gu" or "w" in symbol[1]:
                    self.is_global.add(symbol[3])
            elif relocation and section:
                self.refers.setdefault(section, set()).add(relocation[1])


class Image:
    """The map at path and the objects that it names."""

    def __init__(self, path, objdump):
        self.sizes = kept(path)
        self.objects, self.where = {}, {}
        for place in dict.fromkeys(obj for obj, _ in self.sizes):
            if place.startswith("/") or "/lib/gcc" in place or "(" in place:
                continue  # the compiler's
            self.objects[place] = Object(place, objdump)
            for name in self.objects[place].is_global:
                self.where.setdefault(name, (place, self.objects[place].symbols[name]))

    def wants(self, nodes):
        """Names that these sections refer to and that no object of ours has: mem*, the compiler's
        helpers."""
        found = set()
        for place, section in nodes:
            obj = self.objects.get(place)
            found |= {n for n in obj.refers.get(section, ()) if n[0] != "." and
                      n not in obj.symbols and n not in self.where} if obj else set()
        return found

    def next_of(self, node):
        """Sections of the image that this one refers to."""
        place, section = node
        obj = self.objects.get(place)
        found = []
        for name in sorted(obj.refers.get(section, ())) if obj else ():
            if name in obj.symbols:
                to = (place, obj.symbols[name])
            elif name.startswith("."):
                to = (place, name)
            else:
                to = self.where.get(name)
            if to and to in self.sizes:
                found.append(to)
        return found

    def node(self, symbol):
        """Its section, or None."""
        return self.where.get(symbol)

    def walk(self, roots, cut=lambda node: False):
        """{node: the one it was reached from first} by the shortest ways from the roots that lead
        through nothing cut."""
        came, todo = ({r: None for r in roots if r and not cut(r)},
                      [r for r in roots if r and not cut(r)])
        for node in todo:
            for to in self.next_of(node):
                if to not in came and not cut(to):
                    came[to] = node
                    todo.append(to)
        return came

    def bytes_of(self, nodes):
        """[text, data, bss] of these."""
        sums = {"text": 0, "data": 0, "bss": 0}
        for n in nodes:
            sums[kind_of(n[1])] += self.sizes.get(n, 0)
        return [sums[k] for k in ("text", "data", "bss")]


def word(node):
    """A section's function or table, as a person says it."""
    name = re.sub(
        r"^\.(text|rodata|data|bss)(\.rel\.ro)?(\.local)?"
        r"(\.(startup|unlikely|cst\d+|str\d+\.\d+))?\.?", "", node[1])
    name = re.sub(r"\.(isra|part|constprop|cold)\.\d+|\.\d+$", "", name)
    return name or node[0].rsplit("/", 1)[-1]


def way(came, node):
    """The words from the root to this node."""
    words = []
    while node:
        words.append(word(node))
        node = came[node]
    return words[::-1]
