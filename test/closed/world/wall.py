#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""wall.py PORT: a world of one plane, written from docs/WIRE.md alone. It answers every STATE."""
import socket
import struct
import sys
import time
import zlib

HEAD, MAGIC, VERSION, HELLO, STATE, PLANES = "<HBBHIII", 0x5758, 3, 1, 2, 3
NORMAL, AT = (-0.8, 0.0, 0.6), (0.06, 0.03, 0.17)  # outward; any point of it, m, in {R}


def q30(v):
    return int(v * 2 ** 30 + 0.5 // 1) if v >= 0 else -int(-v * 2 ** 30 + 0.5)


def plane():
    """Hit, material 0, object 1, normal, the point nearest the origin, P_C."""
    away = sum(n * p for n, p in zip(NORMAL, AT))
    point = [n * away for n in NORMAL]
    return struct.pack("<BBH9i", 2, 0, 1, *map(q30, [*NORMAL, *point, *AT]))


class World:
    def __init__(self, port):
        self.udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.udp.bind(("127.0.0.1", port))
        self.session, self.seq = int(time.time()) & 0x7FFFFFFF | 1, 0

    def send(self, to, kind, body):
        stamp = int(time.monotonic() * 1e6) & 0xFFFFFFFF
        head = struct.pack(HEAD, MAGIC, VERSION, kind, len(body), self.session, self.seq, stamp)
        self.seq += 1
        self.udp.sendto(head + body + struct.pack("<I", zlib.crc32(head + body)), to)

    def serve(self):
        while True:
            p, peer = self.udp.recvfrom(512)
            magic, version, kind, n, _, seq, stamp = struct.unpack_from(HEAD, p)
            crc, = struct.unpack_from("<I", p, len(p) - 4)
            if (magic, version) != (MAGIC, VERSION) or crc != zlib.crc32(p[:-4]):
                continue
            if kind == HELLO:  # role 1, no library, no table, no pulls
                self.send(peer, HELLO, struct.pack("<BII20x", 1, 0, 0))
            if kind == STATE:
                fingers = p[18 + 4]
                told = [plane() if fingers >> f & 1 else bytes(40) for f in range(5)]
                self.send(peer, PLANES, struct.pack("<IIB", seq, stamp, fingers) + b"".join(told))


World(int(sys.argv[1])).serve()
