# SPDX-License-Identifier: MIT
"""Attacks on the Modbus port: writes, idle clients, half requests."""

import csv
import io
import socket
import struct
import subprocess
import threading
import time

import rig

INPUT, COIL, WRITE = 4, 5, 16
TEST_INT = 0x0004
APPLY, SAVE, RUN, CLEAR = 0, 2, 4, 5
HARDER = (("f_max", 40.0), ("k", 20000.0), ("q_lim", -0.5))
IDLE = 50
PAUSE_S = 0.4  # of a monitor between two reads
READING = []   # options of a box without write permission


class Client:
    """Modbus TCP by hand."""

    def __init__(self, port):
        self.sock = socket.create_connection(("127.0.0.1", port), timeout=5)

    def ask(self, pdu):
        self.sock.sendall(struct.pack(">HHHB", 1, 0, len(pdu) + 1, 1) + pdu)
        head = self.exactly(7)
        return self.exactly(struct.unpack(">H", head[4:6])[0] - 1)

    def exactly(self, n):
        data = b""
        while len(data) < n:
            more = self.sock.recv(n - len(data))
            if not more:
                raise ConnectionError("the box closed the connection")
            data += more
        return data

    def write(self, address, value):
        """0, or the exception."""
        return self.said(struct.pack(">BHHBf", WRITE, address, 2, 4, value))

    def coil(self, n):
        return self.said(struct.pack(">BHH", COIL, n, 0xFF00))

    def said(self, pdu):
        """Asks again while an APPLY is pending, exception 6."""
        for _ in range(500):
            answer = self.ask(pdu)
            if answer[0] & 0x80 == 0 or answer[1] != 6:
                break
            time.sleep(0.005)
        return answer[1] if answer[0] & 0x80 else 0

    def test_int(self):
        return self.ask(struct.pack(">BHH", INPUT, TEST_INT, 2))[2:] == b"\x12\x34\x56\x78"


def addresses(exhand):
    """{name: holding register of the float} of the scene `drop`."""
    out = subprocess.run([exhand, "regs", "--scene", "drop", "--csv"], stdout=subprocess.PIPE,
                         check=True).stdout.decode()
    return {r["name"]: int(r["address"], 16) for r in csv.DictReader(io.StringIO(out))
            if r["table"] == "holding" and r["format"] == "f32"}


class Monitor(threading.Thread):
    """Reads now and then, over one connection for as long as it has it."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.client, self.reads, self.longest_s, self.lost = Client(port), 0, 0.0, None
        self.ended = False

    def run(self):
        while not self.ended:
            begun = time.monotonic()
            try:
                if not self.client.test_int():
                    self.lost = "another value"
                self.reads += 1
            except OSError as error:
                self.lost = "after %d reads: %s" % (self.reads, error)
                return
            self.longest_s = max(self.longest_s, time.monotonic() - begun)
            time.sleep(PAUSE_S)


def watched(report, name, what, port, attack, seconds):
    """A row: what the monitor made of it."""
    monitor = Monitor(port)
    monitor.start()
    time.sleep(0.5)
    tried, kept = attack(port)
    time.sleep(seconds)
    monitor.ended = True
    monitor.join(10)
    wrong = ["the monitor lost its connection %s" % monitor.lost] if monitor.lost else []
    if monitor.longest_s > 1.0:
        wrong.append("an answer took %.1f s" % monitor.longest_s)
    report.row(name, what, tried, "%d reads, longest %.0f ms" % (monitor.reads,
               monitor.longest_s * 1e3), wrong)
    for sock in kept:
        sock.close()


def idle(port):
    kept = []
    for _ in range(IDLE):
        kept.append(socket.create_connection(("127.0.0.1", port), timeout=5))
        time.sleep(0.01)
    return IDLE, kept


def half(port):
    """Requests that never come whole, a byte at a time."""
    request, kept = struct.pack(">HHHBBHH", 1, 0, 6, 1, INPUT, TEST_INT, 2), []
    for _ in range(14):
        kept.append(socket.create_connection(("127.0.0.1", port), timeout=5))
    for n in range(len(request) - 1):
        for sock in kept:
            try:
                sock.sendall(request[n:n + 1])
            except OSError:
                pass  # the box has closed it
        time.sleep(0.2)
    return len(kept), kept


def harder(client, at, times):
    """(tried, refused with exception 3)."""
    tried = refused = 0
    for _ in range(times):
        for name, value in HARDER:
            tried += 1
            refused += client.write(at[name], value) == 3
        client.coil(APPLY)
    return tried, refused


def box_of(options, folder, name, words):
    box = rig.Box(options.exhand, folder, name, ["--set", "f_max=1", "--modbus",
                                                 "tcp:127.0.0.1:0"] + words)
    return box, box.port()


def finish(report, box, rows, allowed):
    """The log's verdict, for all rows of this box."""
    status, text = box.end(), box.text()
    table, changes = box.rows(), [line for tick, line in box.changes() if tick > 0]
    if status not in box.ends_with:
        rows[-1][4].append("the box ended with %d: %s" % (status, text))
    wrong = [line for line in changes if allowed not in line or allowed == ""]
    wrong += rig.above(table)
    if max(float(r["f_des_n"]) for r in table) < 0.5:
        wrong.append("the mass was never held: not judged")
    if allowed and not any(allowed in line for line in changes):
        wrong.append("less was not taken either: not judged")
    for row in rows:
        report.row(*row[:4], row[4] + wrong)


def refusals(tried, refused):
    return [] if tried == refused else ["%d of %d taken" % (tried - refused, tried)]


def reading(report, options, folder, at):
    """A box whose clients only read, a monitor beside."""
    box, port = box_of(options, folder, "reading", READING)
    rows = []
    try:
        client = Client(port)
        time.sleep(1.5)
        tried, refused = harder(client, at, 20)
        rows.append(("write-none", "f_max up, k up, q_lim, no --modbus-write", tried,
                     "%d refused" % refused, refusals(tried, refused)))
        coils = [client.coil(n) for n in (RUN, CLEAR, APPLY, SAVE)]
        rows.append(("coils", "RUN, CLEAR, APPLY, SAVE, no --remote", 4,
                     "%d refused" % coils.count(3), refusals(4, coils.count(3))))
        client.sock.close()
        watched(report, "idle", "idle clients beside a monitor", port, idle, 1.5)
        watched(report, "half", "half requests, a byte each 0.2 s", port, half, 1.0)
    finally:
        finish(report, box, rows, "")


def writing(report, options, folder, at):
    """A box whose clients write: less, while it runs."""
    box, port = box_of(options, folder, "writing", ["--modbus-write"])
    rows = []
    try:
        client = Client(port)
        time.sleep(1.5)  # it runs
        tried, refused = harder(client, at, 20)
        rows.append(("write-run", "the same, in RUN with --modbus-write", tried,
                     "%d refused" % refused, refusals(tried, refused)))
        refused = [client.coil(n) for n in (RUN, CLEAR)].count(3)
        rows.append(("run-coil", "RUN, CLEAR without --remote", 2, "%d refused" % refused,
                     refusals(2, refused)))
        client.write(at["f_max"], 0.75)  # that less is taken shows that it could have been
        client.coil(APPLY)
        time.sleep(1.0)
    finally:
        finish(report, box, rows, "parameter f_max, instance 0: 0.75 N, by register")


def attack(report, options, folder):
    at = addresses(options.exhand)
    reading(report, options, folder, at)
    writing(report, options, folder, at)
