#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""options.py [--some N] PROGRAM [COMMAND...]: every option of every command, as --help lists them,
with bad values.

Each option gets each of some twenty bad values, or N of them in turn. A run must not crash, hang,
or end well in silence. One line on standard error must name the option and the value. ALLOWED lists
values that are no mistake, with the reason. Prints each finding and a count. Exit status: 0 none, 1
findings.
Environment: JOBS, runs at a time. MEMORY_B, of a run, 0: no limit, as sanitizers need."""
import collections
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

CPU_S = int(os.environ.get("CPU_S", "10"))  # of a core; what runs longer hangs
WALL_S = float(os.environ.get("WALL_S", "120"))  # a busy machine is no finding
MEMORY_B = int(os.environ.get("MEMORY_B", 2 << 30))

VALUES = ["", "nan", "-inf", "-1", "1e400", "5N", "5,0", "0x10", " 5", "5 ", "1e", "=", "k=nan",
          "99999999999999999999", "%s%n", "a\x1b[2Jb\nc", "\u0663", "x" * 4000,
          "/nosuch/dir/file", ".", "/dev/zero", "/dev/full"]

# What each command needs beside the option on trial, so that it ends soon: {dir} is a folder of
# the run's own, {log} a short log. "advise gains" and its like are commands of their own here.
RUN = ["--rate", "90"]
COMMANDS = {
    "advise freeze": [], "advise gains": ["--rate", "90", "--cases", "2", "--jobs", "1"],
    "bilateral": ["--speed", "fast", "--approaches", "1", "--seeds", "1", "--jobs", "1"],
    "bringup": [], "budget": [], "cards": ["--jobs", "1"],
    "calibrate": ["--mass", "0.1,0.5", "--rate", "500"],
    "calibrate --glove": [], "certificate": ["--devices", "1"], "csv": ["{log}"],
    "diagram": ["{log}"], "drop": [*RUN, "--falls", "1", "--runs", "1", "--jobs", "1"],
    "faults": ["--times", "1", "--jobs", "1"],
    "fit": ["--budget", "8", "--jobs", "1", "--out", "{dir}/fit"],
    "glove": ["--record", "{dir}/glove.exh", "--seconds", "0.1"],
    "identify": ["--repeats", "2"], "listen": ["--out", "{dir}/listen.exh", "--at", "127.0.0.1:0"],
    "quad": ["--csv", "{csv}"], "regs": [], "replay": ["{log}"],
    "run": ["--seconds", "0.05"], "watch": ["--seconds", "0.1"],
}

# What single options need instead, so that they are looked at at all.
BILATERAL = COMMANDS["bilateral"]
NEEDS = {
    ("run", "record-columns"): ["--scene", "bilateral", "--record", "{hand}", *COMMANDS["run"]],
    ("run", "save"): ["--modbus", "tcp:127.0.0.1:0", "--modbus-write", *COMMANDS["run"]],
    ("run", "glove-serial"): ["--scene", "bilateral", "--pace", *COMMANDS["run"]],
    ("run", "glove-calibration"): ["--scene", "bilateral", "--pace", "--glove-serial", "{csv}",
                                   *COMMANDS["run"]],
    ("drop", "grid"): ["--sweep", "--out", "{dir}/map", *COMMANDS["drop"]],
    ("drop", "shard"): ["--sweep", "--out", "{dir}/map", *COMMANDS["drop"]],
    ("glove", "csv"): RUN, ("glove", "unit"): [*RUN, "--csv", "{hand}"],
    ("glove", "columns"): [*RUN, "--csv", "{hand}"],
    ("glove", "scale"): [*RUN, "--csv", "{hand}"],
    ("glove", "log"): ["--selftest"],
    ("calibrate --glove", "columns"): ["--poses", "{hand}"],
    ("calibrate --glove", "scale"): ["--poses", "{poses}", "--columns", "2-23,label=1"],
    ("bilateral", "record-columns"): ["--record", "{hand}", *BILATERAL],
    ("faults", "out"): [], ("faults", "rate"): [],
    ("watch", "csv"): ["--listen", "127.0.0.1:0", *COMMANDS["watch"]],
    ("watch", "finger"): ["--listen", "127.0.0.1:0", *COMMANDS["watch"]],
    ("watch", "plot"): ["--listen", "127.0.0.1:0", *COMMANDS["watch"]],
    ("watch", "peer"): ["--listen", "127.0.0.1:0", *COMMANDS["watch"]],
    ("watch", "key"): ["--listen", "127.0.0.1:0", *COMMANDS["watch"]],
}

# (command, option, value, finding) as patterns, and why that is no mistake.
LIST = "a list: its first bad word is named"
ALLOWED = [
    ("advise freeze", "d-lim", "-1", "0 lines", "a distance before the surface is negative"),
    ("bringup", "boot", "", "accepted", "an empty boot line has no options"),
    ("bringup", "boot", "a.*", "value not named", "words end at blanks: the first is named"),
    ("bilateral", "world-until", "9{20}", "accepted", "a time in its range"),
    (".*", "link|calibration|mass|hung|fingers|networks|signals", ".*,.*", "value not named", LIST),
    ("calibrate", "hung", " 5", "value not named", "one mass: how many are due is told"),
    ("watch", "signals", ".*", ".*", "names are known when a box is heard"),
    ("advise gains", "device", ".*", "value not named", LIST),
    (".*", "(record-)?columns", ".*", "option not named", "file, columns and word are named"),
    ("calibrate --glove", "scale", "-1|5,0", "option not named", "a scale; one pose is too few"),
    ("glove", "scale", "-1|5,0", "accepted", "A, or A,B"),
    ("run|bilateral", "blackbox", ".*", "accepted", "the file is made when a fault comes"),
    ("run", "save", ".*", "accepted", "the file is made when a client asks for it"),
    ("quad", "position", " 5|9{20}", "value not named", "a column behind the last: file and line "
     "are named"),
]

# Any name is good for a file or a folder that is written: of these only what can't be.
WRITTEN = {"out", "results", "log", "blackbox", "save", "save-params", "plot"}
WRITTEN_IN = {("watch", "csv"), ("glove", "record")}
UNWRITABLE = ["", "x" * 4000, "/nosuch/dir/file", "/dev/full/x"]

CRASH = re.compile("died|exit status|a sanitizer")  # never allowed

Finding = collections.namedtuple("Finding", "what command option value said")


def shown(value):
    """How a message writes it: bytes that are no text as \\x1b."""
    return "".join(c if c.isprintable() else "".join(f"\\x{b:02x}" for b in c.encode())
                   for c in value)


def options(program, command):
    """(name, whether it takes a value) of each, from --help."""
    text = subprocess.run([program, *command.split(), "--help"], capture_output=True, text=True,
                          check=True).stdout
    found = re.findall(r"^  --(\S+)((?: \S+)?) ", text, re.M)
    return [(name, bool(arg.strip())) for name, arg in found if name != "help"]


# A sanitizer's report is no status of the program's own. Leaks end with the program.
REPORT = "exitcode=199"
SANITIZED = dict(os.environ, ASAN_OPTIONS=f"{REPORT}:detect_leaks=0", UBSAN_OPTIONS=REPORT)
REPORTED = re.compile(r"AddressSanitizer|runtime error:")


def limits():
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S))
    if MEMORY_B:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_B, MEMORY_B))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(program, shared, command, arguments):
    """Status (None: it hangs) and standard error, in a separate folder."""
    option = arguments[0].split("=")[0][2:]
    needs = NEEDS.get((command, option), COMMANDS[command])
    with tempfile.TemporaryDirectory(dir=shared["dir"]) as folder:
        own = dict(shared, dir=folder)
        words = [program, *command.split(), *(a.format(**own) for a in needs),
                 *arguments]
        try:
            done = subprocess.run(words, cwd=folder, stdin=subprocess.DEVNULL, env=SANITIZED,
                                  capture_output=True, timeout=WALL_S, preexec_fn=limits,
                                  check=False)
        except subprocess.TimeoutExpired:
            return None, ""
    if -done.returncode in (signal.SIGXCPU, signal.SIGKILL):
        return None, ""
    return done.returncode, done.stderr.decode(errors="replace")


def allowed(command, option, value, why):
    return not CRASH.match(why) and any(re.fullmatch(c, command) and re.fullmatch(o, option) and
               re.fullmatch(v, value, re.S) and re.fullmatch(w, why) for c, o, v, w, _ in ALLOWED)


def judge(command, option, value, status, said):
    """None, or what is wrong with it."""
    if status is None:
        return "hangs"
    if REPORTED.search(said):
        return "a sanitizer reports"
    if status < 0 or status >= 126:
        return f"died by signal {-status}" if status < 0 else f"exit status {status}"
    if status == 0:
        return "accepted"
    lines = said.splitlines()
    if len(lines) != 1:
        return f"{len(lines)} lines"
    if f"--{option}" not in lines[0]:
        return "option not named"
    named = shown(value)[:30] or None
    if named and named not in lines[0] and named.strip() not in lines[0]:
        return "value not named"
    return None


def trials(program, command, some):
    """Of the values so many, which go on from option to option."""
    deal = 0
    for option, takes in options(program, command):
        if option in WRITTEN or (command, option) in WRITTEN_IN:
            values = UNWRITABLE
        else:
            values = VALUES
        if takes:
            for i in range(min(some, len(values))):
                value = values[(deal + i) % len(values)]
                yield command, option, value, [f"--{option}", value]
            deal += some
        else:
            yield command, option, "yes", [f"--{option}=yes"]


def main():
    words = sys.argv[1:]
    some = len(VALUES)
    if words[0] == "--some":
        some, words = int(words[1]), words[2:]
    program = os.path.abspath(words[0])
    commands = words[1:] or list(COMMANDS)
    listed = re.findall(r"^  ([a-z]+) ", subprocess.run([program, "help"], capture_output=True,
                                                       text=True, check=True).stdout, re.M)
    missing = set(listed) - {c.split()[0] for c in COMMANDS} - {"help"}
    if missing:
        print(f"COMMANDS has no {', '.join(sorted(missing))}")
        return 1
    folder = tempfile.mkdtemp(prefix="exhand-options-")
    shared = {"dir": folder, "log": f"{folder}/log.exh", "csv": f"{folder}/lines.csv"}
    shared.update(hand=f"{folder}/hand.csv", poses=f"{folder}/poses.csv")
    codes = ",".join(["0.1"] * 22)
    for name, row in (("hand", codes), ("poses", "flat," + codes)):
        with open(shared[name], "w", encoding="ascii") as f:
            f.write(3 * (row + "\n"))
    with open(shared["csv"], "w", encoding="ascii") as f:
        f.write("0,0,0\n1,0,1\n2,1,1\n")
    subprocess.run([program, "run", "--seconds", "0.2", "--log", shared["log"]], check=True,
                   stdout=subprocess.DEVNULL)
    todo = [t for c in commands for t in trials(program, c, some)]
    findings = []
    with ThreadPoolExecutor(int(os.environ.get("JOBS", os.cpu_count() or 1))) as pool:
        done = pool.map(lambda t: run(program, shared, t[0], t[3]), todo)
        for (command, option, value, _), (status, said) in zip(todo, done):
            what = judge(command, option, value, status, said)
            if what and not allowed(command, option, value, what):
                findings.append(Finding(what, command, option, value, said))
    shutil.rmtree(folder)
    alike = collections.defaultdict(list)
    for f in findings:
        alike[f.command, f.option, f.what].append(f)
    for (command, option, what), some in alike.items():
        values = [f.value[:20] for f in some]
        print(f"{command} --{option}: {what}: {values}: {some[0].said[:200]!r}")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{len(todo) - len(findings)} passed, {len(findings)} failed "
          f"({used.ru_utime + used.ru_stime:.0f} s of a core)")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
