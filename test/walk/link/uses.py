#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""uses.py AMALGAMATION: what README.md and examples/link/README.md promise a user of a part.

A ```c block is a whole program. It compiles as printed, without a warning, with the pair of each
header of AMALGAMATION that it includes. It runs, and prints the ```text block behind it (```sh
blocks may be between). A ```python block does so by EXH_PYTHON (python3). If that has no exhand,
the block is named and left out.

A row of the table of uses links by its own sources, and by no fewer.

The first lines of examples/limiter/README.md are typed beside the tree's lib and examples. They
print its next block. A line that needs a missing program is named and left out.

A public header alone compiles as C99 and C++11, and declares exh_assert_failed() where its sources
call it. Exit status: 0, 1 not as it should be. Standard library only.
"""

import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../.."))
INCLUDE = os.path.join(ROOT, "lib", "include")
PAGES = ("README.md", "examples/link/README.md")
STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror"]
C99 = ["gcc", "-std=c99", "-O1"] + STRICT
ALONE = {"units", "angle", "mac"} # neither an error nor an assertion behind them
said = []


def read(path):
    with open(os.path.join(ROOT, path)) as f:
        return f.read()


def fail(what):
    said.append(what)
    print("uses: FAILED: " + what)


def run(command, **more):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          **more)


def blocks(page):
    """(line, language, text, what it prints) of each fenced program."""
    fence = re.compile(r"^```(c|python)\n(.*?)^```$(?:(?:(?:(?!^```).)*?^```sh\n.*?^```$)*"
                       r"(?:(?!^```).)*?^```text\n(.*?)^```$)?", re.S | re.M)
    text = read(page)
    for m in fence.finditer(text):
        yield text.count("\n", 0, m.start()) + 1, m[1], m[2], m[3]


def printed(page, line, language, text, want, pairs, at):
    """1 if the program ran."""
    where = "%s:%d" % (page, line)
    source = os.path.join(at, {"c": "one.c", "python": "one.py"}[language])
    with open(source, "w") as f:
        f.write(text)
    if language == "python":
        python = os.environ.get("EXH_PYTHON", "python3")
        if run([python, "-c", "import exhand"]).returncode != 0:
            print("uses: skipped: %s: %s has no package exhand" % (where, python))
            return 0
        done = run([python, source], cwd=at)
    else:
        parts = [os.path.join(pairs, h + ".c") for h in re.findall(r'#include "(\w+)\.h"', text)]
        missing = [p for p in parts if not os.path.exists(p)]
        if missing:
            fail("%s: no %s" % (where, missing[0]))
            return 0
        done = run(C99 + ["-I" + pairs, source] + parts + ["-o", at + "/one"])
        if done.returncode == 0:
            done = run([at + "/one"])
    if done.returncode != 0 or done.stdout != want:
        fail("%s: exit status %d, wanted\n%sgot\n%s" %
             (where, done.returncode, want or "a ```text block behind it", done.stdout))
    return 1


def rows():
    """(use, headers, sources, calls) of the table of uses."""
    table = read(PAGES[1]).split("<!-- uses -->")[1].split("<!-- end -->")[0]
    for line in table.strip().splitlines()[2:]:
        cells = [c.strip() for c in line.strip("|").split("|")]
        code = [re.findall(r"`([^`]+)`", c) for c in cells]
        yield cells[0], code[1], code[2], code[3] + code[4]


def links(headers, sources, calls, at):
    main = os.path.join(at, "main.c")
    with open(main, "w") as f:
        f.writelines('#include "exhand/%s"\n' % h for h in headers)
        f.write("void exh_assert_failed(const char *f, int l) { (void)f, (void)l; for (;;) {} }\n")
        f.write("void (*use[])(void);\nvoid (*use[])(void) = {%s};\n" %
                ", ".join("(void (*)(void))" + c.rstrip("()") for c in calls))
        f.write("int main(void) { return use[0] == 0; }\n")
    return run(["gcc", "-std=c99", "-I" + INCLUDE, main] + sources + ["-o", at + "/main"])


def table(at):
    n = 0
    for use, headers, names, calls in rows():
        n += 1
        sources = [os.path.join(ROOT, "lib/src", s) for s in names]
        done = links(headers, sources, calls, at)
        if done.returncode != 0:
            fail("%s: %s" % (use, done.stdout))
            continue
        for s in sources:
            if links(headers, [o for o in sources if o != s], calls, at).returncode == 0:
                fail("%s: links without %s as well" % (use, os.path.relpath(s, ROOT)))
    return n


def headers(at):
    """Each alone, before anything else."""
    paths = sorted(glob.glob(INCLUDE + "/exhand/*.h"))
    for path in paths:
        name = os.path.splitext(os.path.basename(path))[0]
        text = '#include "exhand/%s.h"\n' % name
        if name not in ALONE:
            text += ("void exh_assert_failed(const char *file, int line)\n{\n    (void)file;\n"
                     "    for (;;) { (void)line; }\n}\n")
        for compiler in (["gcc", "-std=c99", "-x", "c", "-Wmissing-prototypes"],
                         ["g++", "-std=c++11", "-x", "c++", "-Wmissing-declarations"]):
            done = run(compiler + STRICT + ["-Wno-error=shadow", "-I" + INCLUDE, "-fsyntax-only",
                                            "-"], input=text, cwd=at)
            if done.returncode != 0:
                fail("%s.h alone by %s: %s" % (name, compiler[0], done.stdout))
    return len(paths)


def typed(page, at):
    """The lines of the page's first block, run; its second is the end of what they say."""
    lines, want = [re.sub("^    ", "", b, flags=re.M)
                   for b in re.findall(r"(?:^    .*\n)+", read(page), re.M)][:2]
    for name in ("lib", "examples"):
        os.symlink(os.path.join(ROOT, name), os.path.join(at, name))
    os.mkdir(at + "/build")
    there = []
    for line in lines.splitlines():
        tool = line.split()[0]
        if os.sep in tool or shutil.which(tool):
            there.append(line)
        else:
            print("uses: skipped: %s: no %s" % (page, tool))
    done = run(["sh", "-e", "-c", "\n".join(there)], cwd=at)
    if done.returncode != 0 or not done.stdout.endswith(want):
        fail("%s: exit status %d, wanted\n%sgot\n%s" % (page, done.returncode, want, done.stdout))


def main():
    pairs = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as at:
        ran = sum(printed(page, *b, pairs, at) for page in PAGES for b in blocks(page))
        n, alone = table(at), headers(at)
        typed("examples/limiter/README.md", at)
    print("uses: %d programs of the pages, %d rows of the table of uses, %d headers alone: "
          "%d failed" % (ran, n, alone, len(said)))
    return 1 if said or not ran or not n else 0


if __name__ == "__main__":
    sys.exit(main())
