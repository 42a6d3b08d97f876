#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A Modbus master on the image's COM2, which QEMU has as a TCP socket: modbus.py PORT READS|rule
[remote].

Requests are at most 14 bytes, which QEMU's UART takes in one write. QEMU passes more bytes on
without the timing of a line. Prints what failed. Exit status 0 all as expected, 1 not, 3 no image.
"""
import socket
import struct
import sys
import time

failed = 0


def crc(data):
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return struct.pack("<H", value)


class Line:
    def __init__(self, port):
        for _ in range(100):
            try:
                self.socket = socket.create_connection(("127.0.0.1", port))
                break
            except OSError:
                time.sleep(0.1)
        else:
            sys.exit(3)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.socket.settimeout(0.1)

    def send(self, frame):
        self.socket.sendall(frame)

    def hear(self, length, seconds):
        """length bytes, or those that came in that time."""
        got, end = b"", time.time() + seconds
        while len(got) < length and time.time() < end:
            try:
                got += self.socket.recv(length - len(got))
            except socket.timeout:
                pass
        return got

    def ask(self, pdu, address=1):
        """The PDU of the answer, or None."""
        frame = bytes([address]) + pdu
        self.send(frame + crc(frame))
        got = self.hear(5, 3)
        if len(got) < 5:
            return None
        if not got[1] & 0x80:
            more = got[2] if pdu[0] <= 4 or pdu[0] == 23 else 3
            got += self.hear(more, 3)
        if got[0] != address or crc(got[:-2]) != got[-2:]:
            return None
        return got[1:-2]


def check(what, got, want):
    global failed
    if got != want:
        failed += 1
        print("%s: %r, want %r" % (what, got, want))


def read(line, function, at, words):
    got = line.ask(struct.pack(">BHH", function, at, words))
    return got[2:] if got and got[0] == function else got


def f32(value):
    return struct.pack(">f", value)


K = 0x7006  # stiffness, float; a set-up parameter is vel_p, raw 0x5004
APPLY, OFF, RUN = 0, 3, 4


def coil(line, number):
    return line.ask(struct.pack(">BHH", 5, number, 0xFF00))


def state(line):
    return struct.unpack(">I", read(line, 4, 10, 2))[0]


def wait_for(line, wanted):
    for _ in range(300):
        if state(line) in wanted:
            return True
    return False


def rule(line):
    """Scene guarded with its rule of gains on: a pair outside is refused, and neither taken nor
    held for damage."""
    for _ in range(20):  # it boots
        if read(line, 4, 0, 2) is not None:
            break
    check("k", read(line, 4, K, 2), f32(5000))
    check("k staged", line.ask(struct.pack(">BHHB", 16, K, 2, 4) + f32(500)),
          struct.pack(">BHH", 16, K, 2))
    check("APPLY", coil(line, APPLY), struct.pack(">BHH", 5, APPLY, 0xFF00))
    check("refused", read(line, 4, 48, 4), struct.pack(">Ii", 1, -13))
    time.sleep(0.5)  # a round of the guard
    check("k wanted as before", read(line, 3, K, 2), f32(5000))
    check("k in effect as before", read(line, 4, K, 2), f32(5000))
    check("no damage told", struct.unpack(">I", read(line, 4, 18, 2))[0] & 0x2000, 0)
    print("answers fine" if not failed else "%d failed" % failed)
    sys.exit(1 if failed else 0)


def main():
    if sys.argv[2] == "rule":
        rule(Line(int(sys.argv[1])))
    line, reads = Line(int(sys.argv[1])), int(sys.argv[2])
    for _ in range(20):  # it boots
        if read(line, 4, 0, 2) is not None:
            break
    check("head", read(line, 4, 0, 8), bytes.fromhex("4558483100010001123456783f800000"))
    check("name", read(line, 4, 52, 8), b"drop".ljust(16, b"\0"))
    check("k", read(line, 4, K, 2), f32(1500))
    check("k staged", line.ask(struct.pack(">BHHB", 16, K, 2, 4) + f32(800.5)),
          struct.pack(">BHH", 16, K, 2))
    check("k in effect still", read(line, 4, K, 2), f32(1500))
    check("APPLY", coil(line, APPLY), struct.pack(">BHH", 5, APPLY, 0xFF00))
    for _ in range(300):  # it is slewed
        if read(line, 4, K, 2) == f32(800.5):
            break
    check("k in effect", read(line, 4, K, 2), f32(800.5))
    check("k raw", read(line, 3, 0x5006, 2), struct.pack(">i", int(800.5 * 1024)))
    check("commands done", read(line, 4, 48, 4), struct.pack(">Ii", 1, 0))
    check("outside", line.ask(struct.pack(">BHHB", 16, K, 2, 4) + f32(-1)), bytes([0x90, 3]))
    check("no number", line.ask(struct.pack(">BHHB", 16, K, 2, 4) + b"\x7f\xc0\0\0"),
          bytes([0x90, 3]))
    check("of the set-up", line.ask(struct.pack(">BHHBi", 16, 0x5004, 2, 4, 3)), bytes([0x90, 3]))
    check("nothing there", read(line, 4, 0x9000, 2), bytes([0x84, 2]))
    check("no function", line.ask(b"\x08\0\0\0\0"), bytes([0x88, 1]))
    got = read(line, 4, 0x1000, 22)
    check("all outputs", len(got), 44)

    to_all = struct.pack(">BBHHB", 0, 16, K, 2, 4) + f32(700)
    line.send(to_all + crc(to_all))
    check("said to all", line.hear(1, 0.3), b"")
    check("and done", read(line, 3, K, 2), f32(700))
    line.ask(struct.pack(">BHHB", 16, K, 2, 4) + f32(800.5))
    other = struct.pack(">BBHH", 2, 4, 0, 2)
    line.send(other + crc(other))
    check("for another", line.hear(1, 0.3), b"")
    line.send(other[:3] + b"\x55" + crc(other))
    check("damaged", line.hear(1, 0.3), b"")

    check("it runs", wait_for(line, (2, 3)), True)
    coil(line, OFF)
    check("OFF", wait_for(line, (0,)), True)
    if len(sys.argv) > 3:
        check("RUN", coil(line, RUN), struct.pack(">BHH", 5, RUN, 0xFF00))
        check("arms", wait_for(line, (1, 2, 3)), True)
    else:
        check("RUN without remote", coil(line, RUN), bytes([0x85, 3]))
    last = 0
    for i in range(reads):
        got = read(line, 4, 8, 2)
        tick = struct.unpack(">I", got)[0] if got and len(got) == 4 else -1
        if tick < last:
            check("read %d: tick" % i, got, "later than %d" % last)
        last = tick
    print("answers fine" if not failed else "%d failed" % failed)
    sys.exit(1 if failed else 0)


main()
