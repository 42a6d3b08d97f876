# SPDX-License-Identifier: MIT
"""What an attacker knows of the wire: docs/WIRE.md, written without a look at the library."""

import os
import struct
import zlib

HELLO, STATE, PLANES, PARAM, TRACE_ASK, TRACE = 1, 2, 3, 4, 6, 7
WORD = (1 << 64) - 1


def packet(kind, session, number, stamp, payload):
    head = struct.pack("<HBBHIII", 0x5758, 3, kind, len(payload), session, number & 0xFFFFFFFF,
                       stamp & 0xFFFFFFFF)
    return head + payload + struct.pack("<I", zlib.crc32(head + payload))


def parts(data):
    """(kind, session, number, stamp, payload) of a packet that is whole, else None."""
    if len(data) < 22 or zlib.crc32(data[:-4]) != struct.unpack("<I", data[-4:])[0]:
        return None
    kind, _, session, number, stamp = struct.unpack_from("<BHIII", data, 3)
    return kind, session, number, stamp, data[18:-4]


def hello(version):
    return struct.pack("<BII", 1, version, 0) + bytes(20)


def planes(answers, stamp, normal, distance_m):
    """Of the index finger: the plane of that normal, so far from the origin."""
    def q30(v):
        return max(-(1 << 31), min((1 << 31) - 1, round(v * (1 << 30))))
    point = [q30(n * distance_m) for n in normal]
    told = struct.pack("<BBH9i", 2, 0, 1, *(q30(n) for n in normal), *point, *point)
    return struct.pack("<IIB", answers, stamp, 2) + bytes(40) + told + bytes(120)


def param(row, raw):
    return struct.pack("<HHi", row, 0, raw)


def turned(x, n):
    return (x << n | x >> (64 - n)) & WORD


def mac(key, data):
    """SipHash-2-4, of the paper of 2012."""
    k0, k1 = struct.unpack("<QQ", key)
    v = [k0 ^ 0x736F6D6570736575, k1 ^ 0x646F72616E646F6D, k0 ^ 0x6C7967656E657261,
         k1 ^ 0x7465646279746573]

    def rounds(n):
        a, b, c, d = v
        for _ in range(n):
            a, c = (a + b) & WORD, (c + d) & WORD
            b, d = turned(b, 13) ^ a, turned(d, 16) ^ c
            a = turned(a, 32)
            c, a = (c + b) & WORD, (a + d) & WORD
            b, d = turned(b, 17) ^ c, turned(d, 21) ^ a
            c = turned(c, 32)
        v[:] = a, b, c, d

    whole = data + bytes(-(len(data) + 1) % 8) + bytes((len(data) & 255,))
    for (word,) in struct.iter_unpack("<Q", whole):
        v[3] ^= word
        rounds(2)
        v[0] ^= word
    v[2] ^= 0xFF
    rounds(4)
    return v[0] ^ v[1] ^ v[2] ^ v[3]


class Keyed:
    """A world's end of a link with a key."""

    def __init__(self, key):
        self.key, self.heard = key, 0
        self.next = struct.unpack("<Q", os.urandom(8))[0] >> 2 | 1 << 63

    def seal(self, data):
        body = data + struct.pack("<QQ", self.next, self.heard)
        self.next += 1
        return body + struct.pack("<Q", mac(self.key, body))

    def opened(self, data):
        if len(data) < 46 or struct.pack("<Q", mac(self.key, data[:-8])) != data[-8:]:
            return b""
        self.heard = max(self.heard, struct.unpack("<Q", data[-24:-16])[0])
        return data[:-24]
