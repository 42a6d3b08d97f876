# SPDX-License-Identifier: MIT
"""ring: the newest records in memory of the caller's."""

import zlib
from struct import pack, unpack_from

from .num import M32, RANGE, TICKS, Rng

KEYFRAME, PARTS, HEAD = 4, 8, 7
TABLE = bytes(37 * i & 255 for i in range(768))


class Ring:
    def __init__(self, cap):
        self.cap, self.mem = cap, bytearray(cap)
        self.parts = []  # where each begins, in bytes stored since set-up
        self.head = self.lost = 0

    def used(self):
        return self.head - self.parts[0] if self.parts else 0

    def due(self):
        return int(not self.parts or self.head - self.parts[-1] >= self.cap // PARTS)

    def put(self, kind, tick, payload, length):
        begins = kind == KEYFRAME and self.due()
        need = HEAD + length
        if length > 65535 or need >= self.cap or not self.parts and not begins:
            self.lost += 1
            return 0
        if begins and len(self.parts) == PARTS + 2:
            del self.parts[0]
        while self.parts and need >= self.cap - self.used():
            del self.parts[0]
        if not self.parts and not begins:
            self.lost += 1
            return 0
        if begins:
            self.parts.append(self.head)
        for b in pack("<HBI", length, kind, tick) + payload:
            self.mem[self.head % self.cap] = b
            self.head += 1
        return 1

    def read(self, seq):
        """The records, whole, oldest first."""
        at = self.parts[0] % self.cap if self.parts else 0
        rest = (self.mem[at:] + self.mem[:at])[:self.used()]
        while len(rest) >= HEAD:
            length, kind, tick = unpack_from("<HBI", rest)
            if HEAD + length > len(rest):
                return
            body = pack("<HBBHII", 0x5845, kind, 3, length, seq, tick) + rest[HEAD:HEAD + length]
            yield body + pack("<I", zlib.crc32(body))
            del rest[:HEAD + length]
            seq = seq + 1 & M32


def any_put(rng, s):
    due, kind, key, how = s.due(), rng.draw(1, 7), rng.draw(0, 3), rng.draw(0, 23)
    some = rng.draw(0, s.cap >> rng.draw(2, 5))
    near, half, far = (s.cap - rng.draw(5, 9), rng.draw(s.cap >> 1, s.cap - 8),
                       rng.draw(65530, 65540))
    left = s.cap - s.head % s.cap - HEAD
    length = (near if how == 0 else far if how == 1 else half if how == 2 else left if how < 6 and
              left >= 0 else some)
    tick, at = rng.u64() & M32, rng.draw(0, 255)
    kind = KEYFRAME if due and key else kind
    return kind, length, due, s.put(kind, tick, TABLE[at:at + length], length), s.lost


def any_read(rng, s):
    damaged, bit, _, seq = (rng.draw(0, 3) == 0, rng.draw(0, 8 * s.cap - 1), rng.draw(1, 40),
                            rng.u64() & M32)
    flip = damaged << (bit & 7)
    s.mem[bit >> 3] ^= flip
    crc, records = 0, list(s.read(seq))
    s.mem[bit >> 3] ^= flip
    for r in records:
        crc = zlib.crc32(r[:-1], crc)
    first = s.parts[0] % s.cap if s.used() else 0
    return s.used(), first, len(records), crc, sum(map(sum, records))


def ring(rate):
    rng = Rng("ring", rate, 0)
    for k in range(TICKS):
        err = 0
        if k % 32 == 0:
            small, cap = rng.draw(63, 64), rng.draw(64, 64 << rng.draw(0, 3))
            cap = small if rng.draw(0, 1) == 0 else cap
            if cap < 64:
                err, cap = -RANGE, cap + 64
            s = Ring(cap)
        told = any_put(rng, s)
        yield ((err, cap, *told, *(any_read(rng, s) if rng.draw(0, 3) == 0 else (0,) * 5)),
               bytes(s.mem))


COLUMNS = "err cap type len | due put lost left at records crc sum"

MODULES = {"ring": (COLUMNS, ring)}
