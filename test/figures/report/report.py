#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the sections of the report, draws their pictures and writes one page that explains each.

    report.py [--build DIR] [--out DIR] [--short] [--only NAME[,NAME...]] [--jobs N] [--list]
              [--help]

A section is a row of sections.tsv: its name, what make has to build (or -), a command, the seconds
that it takes, a title, and the text for its picture. The command runs at the top of the tree. B
(build), OUT (directory of its CSV files) and SHORT (1 with --short: few points) are in its
environment.

NAME.plt then draws NAME.png from them, after style.gp. A section without NAME.plt has
no picture. The table in the page is OUT/NAME.md if the command writes it. Otherwise it is NAME.csv,
if it is not long.

Exit status of a command: 0 ok; 3 a tool is missing, which skips the section and names it; else the
section has failed. Lines of its output that begin with "skipped: " name what it went without, those
with "note: " go into the page, the rest into OUT/NAME.log. One command in several rows runs once.

--short: few points, for CI. --only: these sections. --jobs N: so many sections at a time (the
number of cores). Exit status: 0 ok, 1 a section failed, 2 bad usage, 130 interrupted.
"""

import argparse
import csv
import datetime
import html
import os
import platform
import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", "..", ".."))
TABLE_LINES = 40
MISSING = 3
VERDICT = ("**Take exhand where the CPU has no FPU for double, where a log of one machine must "
           "replay to the bit on another, or where sums may never drift; take plain double where "
           "there is such an FPU and none of these is asked for: it is more exact there and, but "
           "for sines and fingertips, cheaper.**")


class Section:
    """A row of the table and its results."""

    def __init__(self, row):
        self.name, self.make, self.command, seconds, self.title, self.says = row
        self.seconds = float(seconds)
        self.state, self.why, self.took_s, self.cpu_s = "not run", "", 0.0, None
        self.lines = []  # of its command's output

    def fail(self, why):
        self.state, self.why = "failed", why

    def said(self, what):
        return [line[len(what):].strip() for line in self.lines if line.startswith(what)]


def read_sections(path):
    with open(path, encoding="utf-8", newline="") as f:
        rows = [r for r in csv.reader(f, delimiter="\t", quoting=csv.QUOTE_NONE) if r and
                not r[0].startswith("#")]
    for r in rows:
        if len(r) != 6:
            raise SystemExit("report: %s: %d columns of 6: %s" % (path, len(r), r[0]))
    names = [r[0] for r in rows]
    if len(set(names)) != len(names):
        raise SystemExit("report: %s: a name twice" % path)
    return [Section(r) for r in rows]


def run(command, env, limit_s):
    """Its exit status, all it said, and the seconds of CPU that it took (None: not known)."""
    timed = "(%s\n); s=$?; times; exit $s" % command
    p = subprocess.Popen(timed, shell=True, cwd=ROOT, env=env, text=True, errors="replace",
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
    try:
        text = p.communicate(timeout=limit_s)[0]
    except subprocess.TimeoutExpired:
        os.killpg(p.pid, 15)
        return 1, p.communicate()[0] + "\nstopped: longer than %d s" % limit_s, None
    said, cpu = re.match(r"(.*?)((?:\d+m[\d.]+s ?\n?){4})?$", text, re.S).groups()
    took = re.findall(r"(\d+)m([\d.]+)s", cpu or "")
    return p.returncode, said, sum(60 * int(m) + float(x) for m, x in took) if cpu else None


class Report:
    """The requested sections, in one directory."""

    def __init__(self, args, sections):
        self.args, self.sections = args, sections
        self.out = os.path.abspath(args.out or os.path.join(args.build, "report"))
        self.env = dict(os.environ, B=args.build, OUT=self.out, LC_ALL="C",
                        SHORT="1" if args.short else "", PYTHONDONTWRITEBYTECODE="1")
        self.env.pop("MAKEFLAGS", None)
        self.env.pop("MFLAGS", None)
        self.gnuplot = shutil.which("gnuplot")
        self.began = time.time()
        self.made = []  # what make built, and its seconds of CPU
        os.makedirs(self.out, exist_ok=True)

    def say(self, text):
        print("report: %5.0f s: %s" % (time.time() - self.began, text), flush=True)

    def build(self):
        """What make has to, one target after the other: two at a time would write the same
        files."""
        done = {}
        for s in self.sections:
            if s.make != "-" and s.make not in done:
                self.say("make " + s.make)
                status, text, cpu = run("make --no-print-directory -s B='%s' %s" %
                                        (self.args.build, s.make), self.env, 1800)
                done[s.make] = made(s.make, status, text)
                self.made.append((s.make, cpu))
                if status:
                    sys.stdout.write(text)
            if s.make in done and done[s.make][0] != "ok":
                s.state, s.why = done[s.make]

    def measure(self, sections):
        """One command, for all sections that have it. Whatever goes wrong is theirs alone."""
        first, begin = sections[0], time.time()
        self.say("%s: %s (%.0f s)" %
                 (", ".join(s.name for s in sections), first.command, first.seconds))
        try:
            status, text, cpu = run(first.command, self.env, 4 * first.seconds + 120)
        except OSError as e:
            status, text, cpu = 1, str(e), None
        for s in sections:
            s.lines, s.took_s, s.cpu_s = text.splitlines(), time.time() - begin, cpu
            s.state = "ok" if status == 0 else "skipped" if status == MISSING else "failed"
            s.why = "" if status == 0 else last_line(text)
            try:
                with open(os.path.join(self.out, s.name + ".log"), "w", encoding="utf-8") as f:
                    f.write(text)
                self.draw(s)
            except OSError as e:
                s.fail(str(e))
            self.say("%s: %s%s" % (s.name, s.state, ": " + s.why if s.why else ""))

    def draw(self, s):
        plt = os.path.join(HERE, s.name + ".plt")
        if s.state != "ok" or not os.path.exists(plt):
            return
        if not self.gnuplot:
            s.lines.append("skipped: the picture: gnuplot is missing (gnuplot-nox)")
            return
        p = subprocess.run([self.gnuplot, "-e",
                            "data='%s.csv'; out='%s.png'; here='%s'; heading=\"%s\"" %
                            (s.name, s.name, HERE, s.title),
                            os.path.join(HERE, "style.gp"), plt], cwd=self.out, env=self.env,
                           text=True, errors="replace", stdout=subprocess.PIPE,
                           stderr=subprocess.STDOUT, check=False)
        s.lines += p.stdout.splitlines()
        if p.returncode or not os.path.exists(os.path.join(self.out, s.name + ".png")):
            s.fail("gnuplot: " + last_line(p.stdout))

    def commands(self):
        """The sections by command, the longest first; of each no old file is left."""
        by_command = {}
        for s in self.sections:
            for kind in ("png", "md", "csv"):
                path = os.path.join(self.out, "%s.%s" % (s.name, kind))
                if os.path.isfile(path):
                    os.remove(path)
            by_command.setdefault(s.command, []).append(s)
        return sorted(by_command.values(), key=lambda some: -some[0].seconds)

    def run_all(self):
        """What needs nothing made runs beside the making, the longest first."""
        with ThreadPoolExecutor(self.args.jobs) as pool:
            commands = self.commands()
            running = [pool.submit(self.measure, c) for c in commands if c[0].make == "-"]
            self.build()
            for c in commands:
                made = [s for s in c if s.state == "not run"] if c[0].make != "-" else []
                running += [pool.submit(self.measure, made)] if made else []
            for r in running:
                r.result()

    # --- the page ---

    def table(self, s):
        md = os.path.join(self.out, s.name + ".md")
        if os.path.exists(md):
            with open(md, encoding="utf-8") as f:
                return f.read().strip()
        path = os.path.join(self.out, s.name + ".csv")
        if not os.path.exists(path):
            return ""
        with open(path, encoding="utf-8", newline="") as f:
            rows = [r for r in csv.reader(f) if r and not r[0].startswith("#")]
        if len(rows) > TABLE_LINES or not rows:
            return "%d rows: [%s.csv](%s.csv)" % (max(0, len(rows) - 1), s.name, s.name)
        return "\n".join("| %s |" % " | ".join(r)
                         for r in [rows[0], ["--"] * len(rows[0])] + rows[1:])

    def part(self, s):
        text = ["## %s\n" % s.title]
        if s.state != "ok":
            return "\n".join(text + ["**%s**: %s\n" % (s.state, s.why or "-"),
                                     "Command: `%s`\n" % s.command])
        if os.path.exists(os.path.join(self.out, s.name + ".png")):
            text.append("![%s](%s.png)\n" % (s.title, s.name))
        text.append(s.says + "\n")
        text += (["Without %s.\n" % w for w in s.said("skipped:")] +
                 [n + "\n" for n in s.said("note:")])
        made = "make %s, then " % s.make if s.make != "-" else ""
        text.append("Command: %s`%s` (%.0f s%s)\n" % (
            made, s.command, s.took_s, "" if s.cpu_s is None else ", %.0f of CPU" % s.cpu_s))
        return "\n".join(text + [self.table(s) + "\n"])

    def cpu_s(self):
        """Of all that ran, each command once."""
        of = {s.command: s.cpu_s for s in self.sections}
        return sum(cpu or 0 for cpu in list(of.values()) + [cpu for _, cpu in self.made])

    def write(self):
        """The page: a part that cannot be written is a failure of its section."""
        parts = []
        for s in self.sections:
            try:
                parts.append(self.part(s))
            except (OSError, ValueError, csv.Error) as e:
                s.fail(str(e))
                parts.append(self.part(s))
        page = "# exhand: the report\n\n%s\n\n%s; %.0f s of CPU\n\n%s" % (
            VERDICT, "; ".join(machine(self.args)), self.cpu_s(), "\n".join(parts))
        for name, text in (("REPORT.md", page), ("REPORT.html", page_of(page))):
            with open(os.path.join(self.out, name), "w", encoding="utf-8") as f:
                f.write(text)


def made(target, status, text):
    """Status and text for a result of make. .ci/deps names the missing tool."""
    lacks = re.findall(r"^.*: missing: .*$", text, re.M)
    if status and lacks:
        return "skipped", lacks[0].strip()
    return ("failed", "make %s: %s" % (target, last_line(text))) if status else ("ok", "")


def last_line(text):
    lines = [line for line in text.splitlines() if line.strip()]
    return lines[-1].strip() if lines else "nothing was said"


def first_of(command, default="unknown"):
    try:
        p = subprocess.run(command, cwd=ROOT, text=True, stdout=subprocess.PIPE,
                           stderr=subprocess.DEVNULL, check=False)
    except OSError:
        return default
    return (p.stdout.splitlines() or [default])[0]


def machine(args):
    cpu = "unknown"
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo", encoding="utf-8") as f:
            cpu = (re.findall(r"^model name\s*:\s*(.*)$", f.read(), re.M) or [cpu])[0]
    return [datetime.date.today().isoformat(),
            "exhand " + first_of(["git", "describe", "--always", "--dirty"]), "%d x %s" %
            (os.cpu_count() or 1, cpu), "%s %s" % (platform.system(), platform.machine()),
            first_of([os.environ.get("CC", "gcc").split()[0], "--version"]),
            first_of(["valgrind", "--version"], "no valgrind"),
            "short" if args.short else "all points"]


def page_of(md):
    """The Markdown that this program writes, and no other, as HTML."""
    def span(t):
        t = html.escape(t, quote=False)
        t = re.sub(r"!\[([^]]*)\]\(([^)]*)\)", r'<img src="\2" alt="\1">', t)
        t = re.sub(r"\[([^]]*)\]\(([^)]*)\)", r'<a href="\2">\1</a>', t)
        t = re.sub(r"`([^`]*)`", r"<code>\1</code>", t)
        return re.sub(r"\*\*([^*]*)\*\*", r"<b>\1</b>", t)
    out, table = [], False
    for line in md.splitlines():
        if line.startswith("|"):
            if re.fullmatch(r"[|\-: ]+", line):
                continue
            cells = "".join("<td>%s</td>" % span(c.strip()) for c in line.strip("|").split("|"))
            out.append(("" if table else "<table>") + "<tr>%s</tr>" % cells)
            table = True
            continue
        if table:
            out.append("</table>")
            table = False
        h = re.match(r"(#+) (.*)", line)
        out.append("<h%d>%s</h%d>" % (len(h[1]), span(h[2]), len(h[1])) if h
                   else "<p>%s</p>" % span(line) if line else "")
    style = ("body{font-family:sans-serif;max-width:70em;margin:auto}img{max-width:100%}"
             "table{border-collapse:collapse}td{border:1px solid #ddd;padding:.1em .5em}")
    return ("<!DOCTYPE html><meta charset=utf-8><title>exhand: the "
            "report</title><style>%s</style>\n%s\n" % (style, "\n".join(
                out + (["</table>"] if table else []))))


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--build", default=os.environ.get("B", "build"))
    p.add_argument("--out")
    p.add_argument("--sections", default=os.path.join(HERE, "sections.tsv"), help=argparse.SUPPRESS)
    p.add_argument("--only", default="")
    p.add_argument("--short", action="store_true")
    p.add_argument("--list", action="store_true")
    p.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    args = p.parse_args()
    sections = read_sections(args.sections)
    if args.list:
        for s in sections:
            print("%-16s %5.0f s  %s" % (s.name, s.seconds, s.title))
        return 0
    only = [n for n in args.only.split(",") if n]
    unknown = set(only) - {s.name for s in sections}
    if unknown or args.jobs < 1:
        print("report: %s; --list shows what there is" %
              (", ".join(sorted(unknown)) + ": no such section" if unknown else
               "--jobs: at least 1"), file=sys.stderr)
        return 2
    r = Report(args, [s for s in sections if not only or s.name in only])
    r.run_all()
    try:
        r.write()
    except OSError as e:
        print("report: the page: %s" % e, file=sys.stderr)
        return 1
    bad = [s.name for s in r.sections if s.state == "failed"]
    r.say("%s; %d sections, %.0f s of CPU%s%s" %
          (os.path.join(os.path.relpath(r.out, ROOT), "REPORT.md"), len(r.sections), r.cpu_s(),
           "".join(", skipped: " + s.name for s in r.sections if s.state == "skipped"),
           ", FAILED: " + ", ".join(bad) if bad else ""))
    return 1 if bad else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
