# SPDX-License-Identifier: MIT
"""signal: a table's CRC, and parameters staged, applied immediately or little by little, saved and
loaded."""

import zlib
from struct import pack

from .num import AGAIN, RANGE, STATE, TICKS, UNKNOWN, Rng, period

SETUP, ANY, SLEWED, LIMIT, MATERIAL = 1, 2, 3, 4, 9

# (id, frac, when, min, max, default) of each row, and how many instances of them.
GROUPS = (
    (((0x7001, 10, LIMIT, 0, 1024000000, 7), (0x7002, 20, SETUP, -(1 << 31), (1 << 31) - 1, -1),
      (0x7003, 0, MATERIAL, -5, 5, 0)), 2),
    (((0x7101, 0, SETUP, 1, 2, 1), (0x7102, 30, SLEWED, -(1 << 31), (1 << 31) - 1, 0)), 1),
)


def table_crc():
    b = b""
    for rows, instances in GROUPS:
        b += pack("<H", len(rows))
        b += b"".join(pack("<HBBiiH", *row[:5], instances) for row in rows)
    return zlib.crc32(b)


VALUES = [(row, i) for rows, n in GROUPS for i in range(n) for row in rows]
TABLE_CRC = table_crc()


class Params:
    def __init__(self):
        self.active = [row[5] for row, _ in VALUES]
        self.staged, self.locked, self.pending, self.moving = self.active[:], 0, 0, 0
        self.shift = self.at = 0

    def slew(self, ms, T):
        """The first power of two of ticks that takes no less than so long."""
        self.shift = next(s for s in range(16) if 1000 * T[0] << s >= ms * T[1] or s == 15)

    def may(self, i, raw):
        """0 or the error of value i becoming raw."""
        row = VALUES[i][0]
        if not row[3] <= raw <= row[4]:
            return RANGE
        if row[2] == SETUP and self.locked and raw != self.staged[i]:
            return STATE
        return 0

    def world_may(self, i, raw):
        """The same, asked over the link of a box that may have a force once it is locked."""
        material = VALUES[i][0][2] == MATERIAL
        return self.may(i, raw) or (0 if material and (not self.locked or raw <= self.staged[i])
                                    else STATE)

    def stage(self, ident, instance, raw, world=False):
        for i, (row, n) in enumerate(VALUES):
            if row[0] == ident and n == instance:
                err = (self.world_may if world else self.may)(i, raw)
                if not err:
                    self.staged[i], self.pending = raw, 1
                return -err
        return -UNKNOWN

    def apply(self):
        done = self.pending | self.moving
        if done:
            for i, (row, _) in enumerate(VALUES):
                left = self.staged[i] - self.active[i]
                if self.locked and (row[2] == SLEWED or (row[2] == LIMIT and left > 0)):
                    part = -(-abs(left) // (1 << self.shift))
                    left = part if left > 0 else -part
                self.active[i] += left
            self.pending, self.moving = 0, int(self.active != self.staged)
        return done

    def keyframe(self):
        return b"".join(pack("<i", self.active[i]) +
                        (pack("<i", self.staged[i]) if row[2] in (SLEWED, LIMIT) else b"")
                        for i, (row, _) in enumerate(VALUES))

    def sum(self, n):
        return sum((4 * i + 1) * self.active[i] + (4 * i + 3) * self.staged[i]
                   for i in range(n)) & 0xFFFFFFFF

    def save(self):
        b = b"EXHP" + pack("<HHI", 1, len(VALUES),
                           TABLE_CRC) + pack("<%di" % len(VALUES), *self.staged)
        return b + pack("<I", zlib.crc32(b))

    def load(self, values):
        """(error, the culprit): all of them or none."""
        for i, raw in enumerate(values):
            err = self.may(i, raw) or (STATE if self.locked and raw != self.staged[i] else 0)
            if err:
                return -err, i
        self.staged, self.pending = values, 1
        return 0, 0


def signal(rate):
    rng = Rng("signal", rate, 0)
    for k in range(TICKS):
        if k in (0, AGAIN):
            p = Params()
        if k % 64 == 0:
            ms = rng.draw(0, 1000)
            p.slew(ms >> rng.draw(0, 10), period(rate, k))
        p.locked = k >> 3 & 1
        row, instance = VALUES[rng.draw(0, len(VALUES) - 1)]
        ident = row[0] + (1 if rng.draw(0, 15) == 0 else 0)
        instance += 1 if rng.draw(0, 15) == 0 else 0
        how, raw = rng.draw(0, 3), rng.draw(-(1 << 31), (1 << 31) - 1)
        if how > 0:
            raw = (row[3], row[4], row[5])[how - 1]
        err = p.stage(ident, instance, raw)
        done = p.apply() if rng.draw(0, 3) else -1
        saved = p.save()
        load = bad = 0
        if rng.draw(0, 3) == 0:  # its own image, one value changed
            values = p.staged[:]
            i = rng.draw(0, len(VALUES) - 1)
            values[i] = rng.draw(-2000, 2000)
            load, bad = p.load(values)
        yield (p.shift, ident, instance, raw, err, done, zlib.crc32(saved[:-1]), load, bad,
               p.pending, p.moving, zlib.crc32(p.keyframe()), 0, *p.active), b""


COLUMNS = ("shift id instance raw | stage apply image_crc load load_at pending moving keyframe_crc "
           "look " + " ".join(
               "v%d" % i for i in range(len(VALUES))))

MODULES = {"signal": (COLUMNS, signal)}
