# SPDX-License-Identifier: MIT
"""The box under attack, the true world that it hears, and what its log says afterwards."""

import csv
import io
import os
import re
import signal
import socket
import subprocess
import threading
import time

import wire

NORMAL = (-0.3382, 0.0345, 0.94044)  # of a wall across the index finger's way
DISTANCE_M = 0.1253                  # of it from the palm: met at some 25 mm of string
RATE_HZ = 500
CEILING = {"person_f": 2.0, "person_i": 0.5}  # N, A
COLUMN = {"person_f": "f_des_n", "person_i": "i_des_a"}
TOLD = {}  # replaces values of CEILING: planted.py


def until(what, seconds, said):
    end = time.monotonic() + seconds
    while not what():
        if time.monotonic() > end:
            raise RuntimeError(said)
        time.sleep(0.02)


def ceiling():
    """Options with the person's ceiling."""
    return [word for name, value in {**CEILING, **TOLD}.items()
            for word in ("--set", "%s=%g" % (name, value))]


class World(threading.Thread):
    """The true peer: answers STATE and HELLO, says HELLO twice a second, notes what it sent.

    Ten times a second it asks for no trace. The answer names the question by its number, so that
    nothing that others send can pass for the peer that is heard.
    """

    def __init__(self, key=None):
        super().__init__(daemon=True)
        self.sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.sock.bind(("127.0.0.1", 0))
        self.sock.settimeout(0.05)
        self.at = "127.0.0.1:%d" % self.sock.getsockname()[1]
        self.key, self.keyed = key, key and wire.Keyed(key)
        self.box, self.version, self.stamp, self.answers, self.state = None, 0, 0, 0, 0
        self.tick = self.number = 0
        self.mute, self.ended = False, False
        self.sent, self.before, self.session = [], [], 0
        self.asked, self.heard = 0, []  # number of the newest question; ticks with an answer
        self.lock, self.stated = threading.RLock(), threading.Event()
        self.anew()

    def wait(self, seconds):
        """So long by the box's own clock."""
        last = self.tick + int(seconds * RATE_HZ)
        until(lambda: self.tick >= last, 120, "the box says no STATE")

    def next(self):
        """Until the next STATE, or a second."""
        self.stated.clear()
        self.stated.wait(1)

    def anew(self):
        with self.lock:
            self.before += self.sent
            self.session = int.from_bytes(os.urandom(4), "little") | 1
            self.number, self.sent, self.asked = 0, [], 0
            self.keyed = self.key and wire.Keyed(self.key)

    def make(self, kind, payload, number=None):
        """A packet as the true peer would make it."""
        stamp = time.monotonic_ns() // 1000
        with self.lock:
            if number is None:
                self.number += 1
                number = self.number
            return wire.packet(kind, self.session, number, stamp, payload)

    def put(self, data):
        """As it is, from the peer's address."""
        if self.box:
            try:
                self.sock.sendto(data, self.box)
            except OSError:
                pass  # the box is gone, or its queue is full

    def say(self, kind, payload):
        with self.lock:
            data = self.make(kind, payload)
            data = self.keyed.seal(data) if self.keyed else data
            self.sent.append(data)
            self.put(data)
            return self.number

    def plane(self, normal=NORMAL, distance_m=DISTANCE_M):
        return wire.planes(self.answers, self.stamp, normal, distance_m)

    def run(self):
        due = ask_due = 0.0
        while not self.ended:
            try:
                data, self.box = self.sock.recvfrom(2048)
            except TimeoutError:
                data = b""
            if self.keyed:
                data = self.keyed.opened(data)
            got = wire.parts(data)
            if got and got[0] == wire.STATE:
                self.tick, self.state = int.from_bytes(got[4][:4], "little"), got[4][5]
                self.stated.set()
            if self.mute or self.box is None:
                continue
            if got and got[0] == wire.HELLO:
                self.version = int.from_bytes(got[4][1:5], "little")
                due = 0.0
            if self.version and time.monotonic() >= due:
                due = time.monotonic() + 0.5
                self.say(wire.HELLO, wire.hello(self.version))
            if self.version and time.monotonic() >= ask_due:
                ask_due = time.monotonic() + 0.1
                self.asked = self.say(wire.TRACE_ASK, bytes(12))
            if got and got[0] == wire.TRACE and got[4][:4] == self.asked.to_bytes(4, "little"):
                self.heard.append(self.tick)
            if got and got[0] == wire.STATE:
                _, _, self.answers, self.stamp, _ = got
                self.say(wire.PLANES, self.plane())


class Box:
    """`exhand run`, its log and its output. Or `exhand bilateral`, which ends without a signal."""

    flood = 1000000

    def __init__(self, exhand, folder, name, words, approaches=0):
        self.exhand, self.ends = exhand, approaches > 0
        self.log = os.path.join(folder, name + ".exh")
        command = ["run", "--pace", "--slack", "1", "--log", self.log]
        if self.ends:
            self.log = os.path.join(folder, name, "bilateral_natural.exh")
            command = ["bilateral", "--speed", "natural", "--approaches", str(approaches), "--out",
                       os.path.join(folder, name)]
        self.of = ["--finger", "index"] if "--udp" in words else []
        self.ends_with = (0, 1) if self.ends else (130,)  # 1: an approach without a peer
        self.said = os.path.join(folder, name + ".said")
        with open(self.said, "wb") as said:
            self.process = subprocess.Popen(
                [exhand] + command + ["--rate", str(RATE_HZ)] + ceiling() + words,
                stdout=said, stderr=said)

    def text(self):
        with open(self.said, encoding="utf-8", errors="replace") as said:
            return said.read()

    def named(self):
        """{name: how many} of what the run said at its end."""
        kinds = ("packets of other senders", "of the world's too long", "without a key",
                 "of another key", "not proved", "again", "damaged")
        return {kind: int(n) for n, kind in re.findall(r"(\d+) (%s)" % "|".join(kinds),
                                                       self.text())}

    def port(self):
        for _ in range(600):
            found = re.search(r"modbus: tcp:127\.0\.0\.1:(\d+)", self.text())
            if found:
                return int(found[1])
            if self.process.poll() is not None:
                break
            time.sleep(0.05)
        raise RuntimeError("no Modbus: " + self.text())

    def end(self):
        if self.process.poll() is None and not self.ends:
            self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(60)
        except subprocess.TimeoutExpired:
            self.process.kill()
            return self.process.wait()

    def rows(self):
        words = [self.exhand, "csv", self.log, "--all"] + self.of
        out = subprocess.run(words, stdout=subprocess.PIPE, check=True).stdout.decode()
        return list(csv.DictReader(io.StringIO(out)))

    def changes(self):
        """[(tick, line)] of the log's changes of parameters. It must replay, too."""
        done = subprocess.run([self.exhand, "replay", self.log, "--timeline"],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        text = done.stdout.decode(errors="replace")
        if done.returncode != 0:
            raise RuntimeError("the log does not replay: " + text[-300:])
        to_fault = r"(?:[-+][\d.]+ +)?"
        return [(int(tick), line) for tick, line in re.findall(
            r"^ *(\d+) +[\d.]+ +%s(parameter .*)" % to_fault, text, re.MULTILINE)]


def free_port(kind=socket.SOCK_DGRAM):
    with socket.socket(socket.AF_INET, kind) as sock:
        sock.bind(("127.0.0.1", 0))
        return sock.getsockname()[1]


def key_file(folder, key, name="link"):
    path = os.path.join(folder, name + ".key")
    with open(os.open(path, os.O_CREAT | os.O_WRONLY, 0o600), "w", encoding="ascii") as f:
        f.write(key.hex() + "\n")
    return path


def linked(options, folder, world, approaches):
    """A box that this world is the peer of."""
    name = "approaches" if approaches else "keyed" if world.key else "open"
    words = ([] if approaches else ["--scene", "bilateral"]) + ["--udp", world.at]
    words += ["--key", key_file(folder, world.key)] if world.key else []
    return Box(options.exhand, folder, name, words, approaches)


def most(rows, name):
    return max(float(row[COLUMN[name]]) for row in rows)


def above(rows):
    """Which of the person's ceilings was passed, in words."""
    return ["%s is %g" % (COLUMN[name], most(rows, name)) for name, ceiling in CEILING.items()
            if most(rows, name) > ceiling + 2e-6]


def untried(rows, names=tuple(CEILING)):
    """Which of them was never met, so that nothing was judged."""
    return ["%s is %g at most: not judged" % (COLUMN[name], most(rows, name)) for name in names
            if most(rows, name) < 0.99 * CEILING[name]]
