#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""kill.py [options] EXHAND LAB WORLD: no file is lost.

Runs every writer of the host programs and ends it at random moments by KILL, INT and TERM in turn.
Then it runs them with too little room: by a limit of a file's size, and on a full disk if a small
one may be mounted. Files of an earlier run are there every other time. After each end:
- what is at a final name is absent, the old file, or whole by the program's own reader;
- an old file is not lost; beside the final names KILL alone leaves anything, and .part at most;
- the exit status is 130 after INT and 143 after TERM, at whatever moment.
Then the same with a device, a FIFO, a link and a mode in place of the file: they stay.
Exit status: 0 all hold, 1 not. Standard library only.
"""

import argparse
import os
import random
import resource
import shutil
import signal
import socket
import stat
import struct
import subprocess
import sys
import tempfile
import threading
import time
import zlib

ENDS = (signal.SIGKILL, signal.SIGINT, signal.SIGTERM)
LIMIT_S = 300
FEW = 6  # trials of each: a device, a FIFO, a link, a mode

# name: the program, its words, the files that it leaves. {d} is their folder, {log} a log.
# What is behind the last column: "same": each is as in an undisturbed run. "log": a log may be
# shorter. "rows": a table may be. "begin": each is the same or its first bytes.
WRITERS = (
    ("save-params", "exhand", "drop --rate 500 --falls 1 --runs 1 --save-params {d}/p.bin", "same"),
    ("calibrate", "exhand", "calibrate --rate 100 --mass 0.3,0.6 --day 20000 --out {d}", "same"),
    ("calibrate-glove", "exhand", "calibrate --glove --day 20000 --out {d}", "same"),
    ("csv", "exhand", "csv {log} --all --out {d}/a.csv", "same"),
    ("drop", "exhand", "drop --rate 500,1000 --falls 3 --runs 2 --jobs 2 --out {d}", "rows"),
    ("bilateral", "exhand",
     "bilateral --rate 500 --speed natural --approaches 1 --seeds 1 --out {d}", "log"),
    ("run-log", "exhand", "run --seconds 20 --log {d}/a.exh", "log"),
    ("run-turns", "exhand", "run --seconds 20 --log {d}/a.exh --log-size 256k", "log"),
    ("run-paced", "exhand", "run --pace --rate 200 --seconds 0.6 --log {d}/a.exh", "log"),
    ("blackbox", "exhand", "run --seconds 4 --let-go 2 --blackbox {d}/b.exh", "log"),
    ("record", "exhand", "glove --does poses --seconds 4 --record {d}/g.exh", "log"),
    ("identify", "exhand", "identify --rate 100 --repeats 2 --out {d}", "log"),
    ("watch", "exhand", "watch --modbus {box} --seconds 0.6 --csv {d}/w.csv", "rows"),
    ("run-save", "exhand", "run --pace --rate 200 --seconds 0.6 --modbus tcp:127.0.0.1:{port} "
     "--modbus-write --save {d}/p.bin", "same"),
    ("listen", "exhand", "listen --at 127.0.0.1:{port} --silence 0.5 --out {d}/l.exh", "begin"),
    ("trace", "world", "--headless --listen 127.0.0.1:{port} --seconds 0.8 --scene {scene} "
     "--trace {d}/t.csv", "rows"),
    ("sweep", "lab", "drop --sweep --rate 90 --grid 2x2 --falls 1 --jobs 2 --out {d}", "rows"),
    ("readings", "lab", "drop --readings --rate 500 --falls 2 --runs 2 --out {d}", "rows"),
    ("list", "world", "--headless --script --frames 20 --scene {scene} --png {d}/a.png", "same"),
)
# Those that run by the clock: on a machine that has much to do their file is shorter.
BY_CLOCK = ("run-paced", "watch", "trace")
# Those of one file, which may be no file.
IN_PLACE = ("save-params", "csv", "run-log", "blackbox", "record", "watch")
SCENE = os.path.join(os.path.dirname(os.path.abspath(__file__)),
                     "../../../ports/posix/world/scenes/collision.world")

SAVE = bytes((0, 1, 0, 0, 0, 6, 1, 5, 0, 2, 255, 0))  # coil 2, by Modbus over TCP
PIECE_B = 1408

faults = []


def fault(writer, what):
    faults.append(f"{writer}: {what}")
    print(f"  FAIL {writer}: {what}", flush=True)


def prepare(limit_B):
    """Before exec: signals wait until the program wants them, and so no moment is too early."""
    signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))
    if limit_B is not None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit_B, limit_B))
    os.setpgid(0, 0)


def start(words, limit_B=None):
    return subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                            stderr=subprocess.PIPE, preexec_fn=lambda: prepare(limit_B))


def end(process):
    """Its status and words; what hangs is a fault by its status."""
    try:
        _, err = process.communicate(timeout=LIMIT_S)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        return "hangs", ""
    return process.returncode, err.decode(errors="replace").strip()


def files(folder):
    """Name: bytes of each file; of what is no file: None."""
    held = {}
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        held[name] = None
        if stat.S_ISREG(os.lstat(path).st_mode):
            with open(path, "rb") as f:
                held[name] = f.read()
    return held


def whole_rows(data):
    """A table, every row of which has the columns of its first."""
    rows = [r for r in data.decode(errors="replace").split("\n") if not r.startswith("#")]
    return rows[-1] == "" and len(rows) > 1 and len({r.count(",") for r in rows[:-1]}) == 1


# --- whom some writers need, until the process ends ---


def save(given, _, process):
    """A client that wants the parameters saved, again and again."""
    while process.poll() is None:
        try:
            with socket.create_connection(("127.0.0.1", given["port"]), LIMIT_S) as line:
                while line.send(SAVE) and line.recv(260):
                    time.sleep(0.01)
        except OSError:
            time.sleep(0.01)


def send(given, folder, process):
    """A box that sends its log as soon as the listener is ready."""
    with open(given["short"], "rb") as f:
        log = f.read()
    while process.poll() is None and "l.exh.part" not in os.listdir(folder):
        time.sleep(0.005)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as line:
        for number, at in enumerate(range(0, len(log), PIECE_B)):
            piece = struct.pack("<4s4I", b"EXL2", 7, number, at, at + PIECE_B >= len(log))
            piece += log[at:at + PIECE_B]
            line.sendto(piece + struct.pack("<I", zlib.crc32(piece)), ("127.0.0.1", given["port"]))
            time.sleep(0.003)


def be_box(given, _, process):
    """A controller that the world answers."""
    words = [given["exhand"], "run", "--scene", "bilateral", "--rate", "500", "--pace", "--grip",
             "--udp", f"127.0.0.1:{given['port']}"]
    with subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as other:
        while process.poll() is None:
            time.sleep(0.01)
        other.terminate()


COMPANIONS = {"run-save": save, "listen": send, "trace": be_box}


class Writer:
    def __init__(self, row, given):
        self.name, program, self.words, self.kind = row
        self.program, self.given = given[program], given
        self.dir = os.path.join(given["tmp"], self.name)
        self.counts = {"ends": 0, "old": 0, "new": 0, "absent": 0}

    def command(self, folder):
        return [self.program] + [w.format(d=folder, **self.given) for w in self.words.split()]

    def begin(self, limit_B=None):
        process = start(self.command(self.dir), limit_B)
        companion = COMPANIONS.get(self.name)
        if companion:
            args = (self.given, self.dir, process)
            threading.Thread(target=companion, args=args, daemon=True).start()
        return process

    def fresh(self, held=None):
        shutil.rmtree(self.dir, ignore_errors=True)
        os.mkdir(self.dir)
        for name, data in (held or {}).items():
            with open(os.path.join(self.dir, name), "wb") as f:
                f.write(data)

    def undisturbed(self):
        """What it leaves, its status and its time. Old files are another run's: one byte more."""
        self.fresh()
        at = time.monotonic()
        self.status, said = end(self.begin())
        self.took_s = time.monotonic() - at
        self.reference = files(self.dir)
        if self.status != 0 or not self.reference:
            return said or "leaves no file"
        self.old = {n: b"old " + d[:1000] for n, d in self.reference.items()}
        if self.name == "sweep":
            self.old = {n: d for n, d in self.old.items() if not n.startswith("stability")}
        return None

    def whole(self, name, data):
        if data == self.reference.get(name):
            return True
        if self.kind == "begin":
            return data and self.reference.get(name, b"").startswith(data)
        if ".exh" in name and self.kind != "same":
            path = os.path.join(self.dir, name)
            return subprocess.run([self.given["exhand"], "csv", path], stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                  check=False).returncode == 0
        if name == "stability.csv":  # grows, and its reader drops a last row that was cut off
            data = data[:data.rfind(b"\n") + 1]
        if self.kind == "rows" and name.endswith(".gp"):  # of fewer runs; a picture ends it
            return data.endswith(b".gp'\n")
        return self.kind == "rows" and name.endswith(".csv") and whole_rows(data)

    def is_final(self, name):
        """Of a log that has many files, more than there were may be left: FILE.N."""
        return (name in self.reference or name == "stability.csv" or
                self.name == "run-turns" and name.startswith("a.exh.") and name[6:].isdigit())

    def judge(self, old, killed, how):
        """Checks the files at the names, and beside them."""
        held = files(self.dir)
        for name, data in held.items():
            if self.is_final(name):
                if data in old.values():
                    self.counts["old"] += 1
                elif self.whole(name, data):
                    self.counts["new"] += 1
                else:
                    fault(self.name, f"{how}: {name} is not whole ({len(data)} bytes)")
            elif not (killed and name.endswith(".part")):
                fault(self.name, f"{how}: {name} is left")
        for name in old:
            if name not in held and old[name] not in held.values():
                fault(self.name, f"{how}: the old {name} is lost")
        self.counts["absent"] += not held

    def one_kill(self, rng, i):
        sig = ENDS[i % len(ENDS)]
        old = self.old if (i // len(ENDS)) % 2 else {}
        self.fresh(old)
        process = self.begin()
        delay_s = rng.random() * 1.1 * self.took_s
        time.sleep(delay_s)
        try:
            if sig == signal.SIGKILL:
                os.killpg(process.pid, sig)
            else:
                process.send_signal(sig)
        except ProcessLookupError:
            pass  # it has ended, and a companion's poll() has reaped it
        status, said = end(process)
        how = f"{sig.name} after {delay_s:.4f} s"
        due = -sig if sig == signal.SIGKILL else 128 + sig
        over = status == self.status  # it had ended before
        if status != due and not over:
            fault(self.name, f"{how}: status {status}, not {due}: {said[-200:]}")
        self.counts["ends"] += not over
        self.judge(old, sig == signal.SIGKILL, how)
        if over and files(self.dir).keys() < self.reference.keys():
            fault(self.name, f"{how}: status {status}, and not all files")

    def one_full(self, rng, i):
        """A file may not become as large as the largest is."""
        old = self.old if i % 2 else {}
        most_B = max(len(d) for d in self.reference.values())
        limit_B = rng.randrange(most_B)
        self.fresh(old)
        status, said = end(self.begin(limit_B))
        how = f"files of at most {limit_B} bytes"
        short = {len(d) < limit_B for d in files(self.dir).values() if d not in old.values()}
        fitted = self.name in BY_CLOCK and short == {True}
        if status not in (1, 2) and not fitted and self.name != "run-save":  # its client gets it
            fault(self.name, f"{how}: status {status}: {said[-200:]}")
        self.judge(old, False, how)

    def on_a_full_disk(self, rng, n):
        """A separate disk with too little room. Returns the number of trials, 0 if none may be
        mounted."""
        room_B = sum(len(d) for d in self.reference.values())
        done = 0
        for i in range(n):
            self.fresh()
            size_B = 4096 * (1 + rng.randrange(max(1, room_B // 4096)))
            if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size_B}", "none", self.dir],
                              stderr=subprocess.DEVNULL, check=False).returncode != 0:
                break
            try:
                old = {n: d for n, d in self.old.items() if i % 2 and len(d) < size_B // 64}
                for name, data in old.items():
                    with open(os.path.join(self.dir, name), "wb") as f:
                        f.write(data)
                status, said = end(self.begin())
                if status not in (0, 1, 2):
                    fault(self.name, f"a disk of {size_B} bytes: status {status}: {said[-200:]}")
                self.judge(old, False, f"a disk of {size_B} bytes")
                done += 1
            finally:
                subprocess.run(["umount", self.dir], check=False)
        return done

    # --- what is no file ---

    def in_place(self, rng, kind, make, check):
        name = next(iter(self.reference))
        path = os.path.join(self.dir, name)
        for i in range(FEW):
            self.fresh()
            undo = make(path)
            process = self.begin()
            if i:
                time.sleep(rng.random() * self.took_s)
                os.killpg(process.pid, ENDS[i % len(ENDS)])
            status, said = end(process)
            if undo:
                undo()
            wrong = check(path)
            if wrong:
                fault(self.name, f"{kind}: {wrong} (status {status}: {said[-100:]})")


def device(minor):
    def make(path):
        os.mknod(path, stat.S_IFCHR | 0o666, os.makedev(1, minor))

    def check(path):
        st = os.lstat(path)
        same = stat.S_ISCHR(st.st_mode) and st.st_rdev == os.makedev(1, minor)
        return None if same and len(os.listdir(os.path.dirname(path))) == 1 else "is another"
    return make, check


def fifo():
    def make(path):
        os.mkfifo(path, 0o600)
        over = threading.Event()

        def read():
            fd = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
            while not over.is_set():
                try:
                    if not os.read(fd, 1 << 20):
                        time.sleep(0.002)
                except BlockingIOError:
                    time.sleep(0.002)
            os.close(fd)
        reader = threading.Thread(target=read)
        reader.start()

        def undo():
            over.set()
            reader.join()
        return undo
    return make, lambda path: None if stat.S_ISFIFO(os.lstat(path).st_mode) else "is none"


def link():
    def make(path):
        with open(path + "-target", "wb") as f:
            f.write(b"old")
        os.chmod(path + "-target", 0o640)
        os.symlink(os.path.basename(path) + "-target", path)

    def check(path):
        if not os.path.islink(path):
            return "the link is none"
        st = os.lstat(path + "-target")
        return None if stat.S_ISREG(st.st_mode) and st.st_mode & 0o7777 == 0o640 else "its target"
    return make, check


def mode():
    def make(path):
        with open(path, "wb") as f:
            f.write(b"old")
        os.chmod(path, 0o600)

    def check(path):
        now = os.lstat(path).st_mode & 0o7777
        return None if now == 0o600 else f"mode {now:o}"
    return make, check


def kinds():
    also = {"a FIFO": fifo(), "a link": link(), "a mode": mode()}
    if os.geteuid() == 0:
        also.update({"/dev/null": device(3), "/dev/full": device(7)})
    return also


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def box(given):
    """A box that is watched; None: this program has no Modbus."""
    words = [given["exhand"], "run", "--pace", "--rate", "200", "--modbus", "tcp:127.0.0.1:0"]
    process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, text=True)
    line = process.stdout.readline()
    if line.startswith("modbus: "):
        given["box"] = line.split()[1]
        return process
    process.wait()
    return None


def one(writer, opt, rng, deadline_s):
    why = writer.undisturbed()
    if why:
        print(f"{writer.name:16} left out: {why.splitlines()[-1][:100]}", flush=True)
        return
    kills = full = 0
    while kills < opt.kills and (kills < 6 or time.monotonic() < deadline_s):
        writer.one_kill(rng, kills)
        kills += 1
    while full < max(2, kills // 10):
        writer.one_full(rng, full)
        full += 1
    disk = writer.on_a_full_disk(rng, max(2, kills // 10))
    places = 0
    if writer.name in IN_PLACE and time.monotonic() < deadline_s + 5:
        for kind, (make, check) in kinds().items():
            writer.in_place(rng, kind, make, check)
            places += FEW
    c = writer.counts
    print(f"{writer.name:16} {kills:4} signals, {c['ends']:4} in time; {full:3} limits, "
          f"{disk:3} full disks, {places:3} in place; files: {c['new']:4} whole, "
          f"{c['old']:4} old; {writer.took_s:.2f} s a run", flush=True)


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--kills", type=int, default=200)
    p.add_argument("--seconds", type=float, default=1e9, help="of all, about")
    p.add_argument("--only", default="")
    p.add_argument("--without", default="")
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("exhand")
    p.add_argument("lab")
    p.add_argument("world")
    opt = p.parse_args()
    given = {n: os.path.abspath(getattr(opt, n)) for n in ("exhand", "lab", "world")}
    given["scene"] = os.path.normpath(SCENE)
    rng = random.Random(opt.seed)
    rows = [r for r in WRITERS if opt.only in ("", r[0]) and r[0] != opt.without]
    watched = None
    with tempfile.TemporaryDirectory(prefix="exhand-kill-") as tmp:
        given["tmp"] = tmp
        given["port"] = free_port()
        for name, seconds in (("log", "8"), ("short", "0.5")):
            given[name] = os.path.join(tmp, name + ".exh")
            subprocess.run([given["exhand"], "run", "--seconds", seconds, "--log", given[name]],
                           stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, check=True)
        if any(r[0] == "watch" for r in rows):
            watched = box(given)
        try:
            for i, row in enumerate(rows):
                if row[0] == "watch" and watched is None:
                    print(f"{row[0]:16} left out: no Modbus in this program")
                    continue
                share_s = opt.seconds / len(rows)
                one(Writer(row, given), opt, rng, time.monotonic() + share_s)
        finally:
            if watched:
                watched.terminate()
                watched.wait()
    print(f"kill: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
