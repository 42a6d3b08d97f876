#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""docs.py EXHAND WORLD: the documents name only what the tree has. EXHAND-lab is beside EXHAND.

In code, between backticks or in a block, it checks every make target, variable, port and scene. It
checks every command of these programs with its options, and that some program or script has an
option that is named alone. It checks names of functions, signals and tests. Anywhere, it checks
files, documents and links.

Also the reverse: every document, port, scene and folder of tests has its place in the page that
lists them. Every picture is shown. The bench's table is that of its baseline. WORLD may be missing.
Exit status: 0 all hold, 1 not. Standard library only.
"""

import functools
import glob
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
TOP = ("lib", "ports", "examples", "test", "docs", "ldscripts")
# A reader of docs/PORTING.md writes these.
OURS_NOT = ("ports/mine", "ldscripts/mine")
# Of libmodbus, CMake, Zephyr, Linux.
OTHERS = ("modbus_get_float_abcd", "add_subdirectory", "qemu_cortex_m3", "latency_timer",
          "mine_clock", "mine_say") # of the port that docs/PORTING.md types

# A page with one fault of each kind, and as much that is no fault.
PLANTED = """
`make no-target`, `make NO_VARIABLE=1 test`, `make PORT=no-port`, `exhand no-command`,
`exhand drop --no-option`, `--none-has-it`, docs/NONE.md, `test/no-place`, [link](no-file.md),
`unit/none`, `build/test/prop/none`, `exh_no_such()`.

    $ make test && build/posix/exhand drop --rate 500   # and make sense of it
`make SCENE=drop all`, `--rate`, docs/DESIGN.md, `unit/drive`, `exh_drive_rows`,
`build/test/prop/drive_test`, `exhand drop|bilateral --rate HZ`, `exhand-lab drop --sweep`,
to make no mistake.
"""
PLANTED_FAULTS = 12


def read(path):
    with open(path, encoding="utf-8") as f:
        return f.read()


def folders():
    """Subjects of tests, and the folders of those that have a folder per kind of test."""
    subjects = glob.glob("test/[a-z]*")
    kinds = ("module", "device", "closed", "image", "strength", "figures", "walk")
    return [d for d in subjects + [d for k in kinds for d in glob.glob("test/%s/[a-z]*" % k)]
            if os.path.isdir(d)]


def documents():
    return sorted(glob.glob("*.md") +
                  [p for t in TOP for p in glob.glob(t + "/**/*.md", recursive=True)])


def makefile():
    """Names of targets and of variables."""
    text = read("Makefile") + "".join(read(p) for t in TOP # not build/: it may hold a Debian's root
                                      for p in glob.glob(t + "/**/*.mk", recursive=True))
    heads = re.findall(r"^([^\t#=\n][^=#\n]*?):(?!=)", text, re.M)
    return {t for h in heads for t in h.split()}, set(re.findall(r"\b[A-Z][A-Z0-9_]*\b", text))


@functools.lru_cache(maxsize=None)
def helps(*command):
    """Options and first words of lines in what COMMAND --help prints; None where it ends badly."""
    p = subprocess.run(command + ("--help",), text=True, stdout=subprocess.PIPE,
                       stderr=subprocess.STDOUT, check=False)
    return (set(re.findall(r"(?<![\w-])--?\w[\w-]*|^  \w+", p.stdout, re.M)) if p.returncode == 0
            else None)


@functools.lru_cache(maxsize=None)
def sources():
    """What the sources name: options that something takes, and words, names of files among them."""
    found = ["Makefile"] + [p for t in TOP for p in glob.glob(t + "/**/*", recursive=True)]
    text = "".join(read(p)
                   for p in found if re.search(r"\.(py|sh|[chS]|awk|mk|tsv|gp|plt)$|^Makefile$",
                                               p) and not p.startswith("test/walk/docs/"))
    options = (set(re.findall(r"--\w[\w-]*", text)) |
               {"--" + o for o in re.findall(r'\{"([a-z][\w-]*)",[\s\\]*CLI_', text)})
    return options, set(re.findall(r"\w+", text)) | {os.path.basename(p).split(".")[0]
                                                     for p in found}


def code(text):
    """Pieces of code in a page: lines of blocks, and spans."""
    lines, prose, fenced = [], [], False
    for line in re.sub(r"\\\n\s*", " ", text).split("\n"):
        if line.startswith("```"):
            fenced = not fenced
        elif fenced or re.match(r" {4,}\S", line):
            lines.append(re.sub(r"(^|\s)#\s.*|\s{3,}.*", "", line.strip()))
        prose.append("" if fenced or line.startswith("```") else line)
    return (lines,
            [" ".join(s.split()) for s in re.findall(r"`([^`]+)`(?! is gone)", "\n".join(prose))])


class Page:
    def __init__(self, path, text, program, world):
        self.path, self.text, self.program, self.world = path, text, program, world
        self.wrong, self.checked = [], 0

    def want(self, ok, what):
        self.checked += 1
        if not ok:
            self.wrong.append("%s: %s" % (self.path, what))

    def make(self, words):
        targets, variables = makefile()
        for i, w in enumerate(words):
            name, is_set, value = w.partition("=")
            if w.startswith("-") or words[i - 1] == "-C" or not re.match(r"[A-Za-z]", w):
                continue
            if is_set:
                self.want(name in variables, "make: no variable " + name)
                if (name == "ARGS" and "run" in words and
                    not re.search(r"\bPORT=(?!posix)", " ".join(words))):
                    self.exhand(value.strip("\"'").split())
                elif name == "ARGS":
                    self.want(all(o in sources()[0] for o in re.findall(r"--\w[\w-]*", value)),
                              "nothing has " + value)
                if name == "PORT" and value.islower():
                    self.want(os.path.isdir("ports/" + value) or "ports/" + value in OURS_NOT,
                              "make: no port " + value)
                if name == "SCENE" and value.islower():
                    self.want(glob.glob("examples/%s/scene.mk" % value) +
                              glob.glob("test/**/%s/scene.mk" % value, recursive=True),
                              "make: no scene " + value)
            elif not w.isupper() and not w.startswith("build/test/"): # those are in places()
                self.want(w.replace("build/", "$(B)/") in targets, "make: no target " + w)

    def options(self, command, words):
        for w in words:
            option = re.match(r"--?[a-z][\w-]*", w)
            if option:
                self.want(option.group() in helps(*command),
                          "%s has no %s" % (" ".join(command[1:]) or command[0], option.group()))

    def exhand(self, words, lab=""):
        if not words or not re.match(r"[a-z]", words[0]):
            return
        for sub in words[0].split("|"):
            found = "  " + sub in helps(self.program + lab)
            self.want(found, "exhand%s: no command %s" % (lab, sub))
            more = (words[1].split("|") if sub == "advise" and len(words) > 1 and
                    re.match(r"[a-z]", words[1]) else [None])
            more = ["--glove"] if sub == "calibrate" and "--glove" in words else more
            for m in more if found else ():
                self.options((self.program + lab, sub) + ((m,) if m else ()), words[1:])

    def command(self, text):
        words = re.findall(r"""(?:[^\s"']|"[^"]*"|'[^']*')+""", text)
        while words and (words[0] in ("$", "time", "nice") or re.match(r"[A-Z_]+=", words[0])):
            words = words[1:]
        name = os.path.basename(words[0]) if words else ""
        if name == "make":
            self.make(words[1:])
        elif name == "exhand" and words[0] != "/exhand":
            self.exhand(words[1:])
        elif name == "exhand-lab":
            self.exhand(words[1:], "-lab")
        elif name == "world" and os.path.exists(self.world):
            self.options((self.world,), words[1:])
        elif name.startswith("--") and len(words) < 3:
            self.want(re.match(r"[\w-]+", name).group() in sources()[0], "nothing has " + name)

    def is_there(self, place):
        bases = ("", os.path.dirname(self.path), "test", "test/*", "docs", "ports", "ports/posix",
                 "examples", "lib/src", "lib/src/*", "lib/include/exhand")
        return any(glob.glob(os.path.join(b, place) + end) for b in bases
                   for end in ("", "_test.c", ".c", ".h", ".py", ".sh"))

    def places(self):
        """Files and tests."""
        text = re.sub(r"\{[^}\s]*\}|<[^>\s]*>", "*", self.text)
        for m in re.finditer(r"(?<![\w/.$)}-])(?:%s)/[\w./*-]+|(?<![\w/.*-])[A-Z]+\.md\b" %
                             "|".join(TOP), text):
            place = m.group().rstrip(".-")
            if not place.startswith(OURS_NOT) and "NAME" not in place:
                self.want(self.is_there(place), "not there: " + place)
        for m in re.finditer(r"`((?:%s)/[a-z]\w+)`" %
                             "|".join(os.path.basename(d) for d in folders()), text):
            self.want(self.is_there(m.group(1)), "no such test: " + m.group(1))
        for m in re.finditer(r"build/test/(\w+/\w+)", text):
            self.want(glob.glob("test/%s.c" % m.group(1)) + glob.glob("test/*/%s.c" % m.group(1)),
                      "no such test: " + m.group(1))
        for m in re.finditer(r"\]\(([^)#\s]+)", self.text):
            if "://" not in m.group(1):
                self.want(os.path.exists(os.path.join(os.path.dirname(self.path), m.group(1))),
                          "no link to " + m.group(1))

    def names(self, span):
        """Functions, signals, tests."""
        for name in re.findall(r"(?<![\w$/.*-])(?:[a-z]+_\w*[a-z0-9]|EXH_\w*[A-Z0-9])\b(?![*[./…])",
                               span):
            self.want(name in sources()[1] or name in OTHERS, "nothing is called " + name)

    def all(self):
        lines, spans = code(self.text)
        for span in spans:
            self.names(span)
        for piece in lines + spans:
            for part in re.split(r"\s+(?:&&|\|\||\||&)\s+|;\s+|\s+&$", piece):
                self.command(part)
        self.places()
        return self


def lists():
    """What must be named in the page that lists its kind."""
    front, design, tests = read("README.md"), read("docs/DESIGN.md"), read("test/README.md")
    told = "".join(read(p) for p in documents())
    for path in glob.glob("docs/*.md"):
        yield (os.path.basename(path)[:-3] in re.findall(r"\w+", front),
               "README.md does not name " + path)
    for path in glob.glob("ports/*/") + glob.glob("examples/*/"):
        name = path.split("/")[1]
        for page, text in (("README.md", front), ("docs/DESIGN.md", design)):
            yield name in re.findall(r"\w+", text), "%s does not name %s" % (page, path)
    for path in folders():
        yield "\n| `%s` |" % path[len("test/"):] in tests, "test/README.md has no row of " + path
    for path in glob.glob("docs/*.png") + glob.glob("docs/*.svg"):
        yield os.path.basename(path) in told, "no page shows " + path


def bench():
    """docs/TABLES.md has the instructions of each kernel that `make bench` goes by."""
    told = {m.group(1): m.groups()[1:]
            for m in re.finditer(r"^    (\w+) +(\d+\.\d\d) .*?(\d+\.\d\d) \|",
                                 read("docs/TABLES.md"), re.M)}
    for name, count, _, _, i686 in (line.split(",")
                                    for line in read(
                                            "test/figures/bench/baseline.csv").splitlines()[2:]):
        yield (told.get(name) == (count, i686),
               "docs/TABLES.md: %s is %s and %s on i686" % (name, count, i686))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, world = (os.path.abspath(p) for p in sys.argv[1:])
    os.chdir(ROOT)
    planted = Page("README.md", PLANTED, program, world).all()
    if len(planted.wrong) != PLANTED_FAULTS:
        sys.exit("docs.py: of %d planted faults these were told:\n%s" %
                 (PLANTED_FAULTS, "\n".join(planted.wrong)))
    pages = [Page(p, read(p), program, world).all() for p in documents()]
    listed = list(lists()) + list(bench())
    wrong = [w for p in pages for w in p.wrong] + [what for ok, what in listed if not ok]
    print("\n".join(wrong + ["docs: %d pages, %d names in them, %d of the tree: %d wrong" %
                             (len(pages), sum(p.checked for p in pages), len(listed), len(wrong))]))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
