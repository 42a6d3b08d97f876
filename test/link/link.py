#!/usr/bin/env python3
"""link.py DIR [--only WORD]: the ways of examples/link/README.md, each in a new directory under DIR beside a clone of what is
there now, its lines as they stand; the last line's output must be what the README says. Prints a row a way: commands, seconds,
bytes of the program. What a section needs ("Needs:") and is not here is named and its section skipped; EXH_ALL=1 makes
that a failure. Exit status: 0 all said the same, 1 not. Standard library only.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.dont_write_bytecode = True
from clone import clone  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
README = os.path.join(ROOT, "examples", "link", "README.md")
SCONS = "from SCons.Script import main\nmain()\n"


def block(text):
    return [line[4:] for line in text.splitlines() if line.startswith("    ")]


def ways():
    """What the program must say, and [(name, needs, commands)]."""
    with open(README) as f:
        head, *sections = re.split(r"^## ", f.read(), flags=re.M)
    of = [(s.splitlines()[0], re.search(r"^Needs: ([^.]*)\.", s, re.M).group(1).split(), block(s)) for s in sections]
    return block(head)[0], of


def pio(where):
    """The environment in which `pio` is there, from PyPI, with what its registry would have brought: SCons of PyPI, too, and a
    platform of ours. None: no pip, or no PyPI."""
    site, core = os.path.join(where, "site"), os.path.join(where, "core")
    env = {"PYTHONPATH": site, "PATH": os.path.join(site, "bin") + ":" + os.environ["PATH"], "PLATFORMIO_CORE_DIR": core, "PLATFORMIO_SETTING_ENABLE_TELEMETRY": "no"}
    if not os.path.exists(os.path.join(site, "bin", "pio")):
        if subprocess.run([sys.executable, "-m", "pip", "install", "-q", "--target", site, "platformio", "scons"]).returncode != 0:
            return None
    ask = "from platformio.dependencies import get_core_dependencies as g; print(g()['tool-scons'].strip('~^'))"
    version = subprocess.run([sys.executable, "-c", ask], check=True, stdout=subprocess.PIPE, text=True, env=dict(os.environ, **env)).stdout.strip()
    tool = os.path.join(core, "packages", "tool-scons")
    os.makedirs(tool, exist_ok=True)
    shutil.copytree(os.path.join(HERE, "platformio"), os.path.join(core, "platforms", "native"), dirs_exist_ok=True)
    spec = '"spec": {"owner": "platformio", "id": null, "name": "tool-scons", "requirements": null, "uri": null}'
    for name, text in (("scons.py", SCONS), ("package.json", '{"name": "tool-scons", "version": "%s"}' % version),
                       (".piopm", '{"type": "tool", "name": "tool-scons", "version": "%s", %s}' % (version, spec))):
        with open(os.path.join(tool, name), "w") as f:
            f.write(text)
    return env


def run(commands, where, want, more):
    """(said what it must without a warning, seconds, bytes, the end of what was said)."""
    clone(where)
    env = {k: v for k, v in os.environ.items() if k not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "CFLAGS", "WERROR")}
    start = time.time()
    done = subprocess.run(["sh", "-e", "-c", "\n".join(commands)], cwd=where, env=dict(env, LC_ALL="C.UTF-8", **more),
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    took = time.time() - start
    program = os.path.join(where, commands[-1])
    warned = re.findall(r"^.*\bwarning:.*$", done.stdout, re.M)
    good = done.returncode == 0 and done.stdout.rstrip().splitlines()[-1:] == [want] and not warned
    return good, took, os.path.getsize(program) if os.path.exists(program) else 0, "\n".join(warned or done.stdout.splitlines()[-15:])


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("dir")
    p.add_argument("--only", default="")
    a = p.parse_args()
    want, of = ways()
    failed = passed = 0
    print("%-36s %9s %8s %9s" % ("way", "commands", "seconds", "bytes"))
    for k, (name, needs, commands) in enumerate(of):
        if a.only not in name:
            continue
        missing = [n for n in needs if n != "pio" and not shutil.which(n)]
        more = pio(os.path.join(os.path.abspath(a.dir), "pio")) if "pio" in needs and not missing else {}
        if missing or more is None:
            print("%-36s skipped: no %s" % (name, " ".join(missing) or "pip, or no PyPI: pip install platformio"))
            failed += bool(os.environ.get("EXH_ALL"))
            continue
        good, took, size, end = run(commands, os.path.join(os.path.abspath(a.dir), "way%d" % k), want, more)
        passed, failed = passed + good, failed + (not good)
        print("%-36s %9d %8.1f %9d%s" % (name, len(commands), took, size, "" if good else "  FAILED\n" + end), flush=True)
    print("%d passed, %d failed" % (passed, failed))
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
