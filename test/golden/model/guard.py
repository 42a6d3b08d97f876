# SPDX-License-Identifier: MIT
"""guard and supply: has constant memory changed, and do the drives have power?"""

import zlib
from struct import pack

from .num import AGAIN, M32, RANGE, TICKS, Refused, Rng, clamp, period
from .signal import Params

AREA = 40


class Guard:
    def __init__(self, area, params):
        self.area, self.params, self.want = area, params, zlib.crc32(bytes(area))
        self.at = self.crc = self.broken = 0
        if params:
            params.at, params.passed, self.sum = 0, 0, params.sum(len(params.active))

    def step(self):
        if self.area:
            part = bytes(self.area[self.at:self.at + 8])
            self.crc, self.at = zlib.crc32(part, self.crc), self.at + len(part)
            if self.at == len(self.area):
                self.broken |= self.crc != self.want
                self.at = self.crc = 0
        if self.params:
            p = self.params
            for _ in range(2):
                i, p.at = p.at, p.at + 1
                self.broken |= p.active[i] != p.staged[i] and not p.pending and not p.moving
                p.passed += (4 * i + 1) * p.active[i] + (4 * i + 3) * p.staged[i]
                if p.at == len(p.active):
                    self.broken |= p.passed & M32 != self.sum
                    p.at = p.passed = 0
        return int(self.broken)


def guard(rate):
    rng, params = Rng("guard", rate, 0), Params()
    at = word = flip = off = 0
    g = Guard(bytearray(), None)

    def change(new_flip, new_off):
        nonlocal flip, off
        if at < len(g.area):
            g.area[at] ^= flip ^ new_flip
        params.active[word] ^= off ^ new_off
        flip, off = new_flip, new_off

    for k in range(TICKS):
        anew = rng.draw(0, 13) == 0
        if k in (0, AGAIN) or anew:
            change(0, 0)
            n = rng.draw(0, AREA)
            area = bytearray(rng.draw(0, 255) for _ in range(AREA))[:n]
            g = Guard(area, params if rng.draw(0, 3) else None)
        how, new_at = rng.draw(0, 9), rng.draw(0, max(0, len(g.area) - 1))
        new_word, bit = rng.draw(0, 7), 1 << rng.draw(0, 7)
        if how < 5:
            change(0, 0)
        if how < 3:
            at, word = new_at, new_word
            change(bit if how == 0 else 0, 0 if how == 0 else bit)
        if how == 2:
            params.pending = 1
        if how in (5, 6):
            params.pending ^= 1
        if how in (6, 7):
            params.moving ^= 1
        yield (len(g.area), flip, off, params.pending, params.moving, g.step(), g.at, g.crc,
               params.at), b""


# --- supply ---

def any_supply(rng, rate, seldom=3):
    """least, most, scale, time; and a code between the limits"""
    scale_, low = rng.draw(100000, 1500000), rng.draw(1, 20000)
    high = rng.draw(low + 1, 32000)
    least = low * scale_ >> 10 if rng.draw(0, seldom) else 0
    return (least, high * scale_ >> 10, scale_, clamp(rng.draw(1, 12) * 1000 // rate, 1, 1000),
            low + high >> 1)


class Supply:
    def __init__(self, par, T):
        least, most, scale_, ms, _ = par
        self.ticks, self.off = ms * T[1] // (1000 * T[0]) + 1, 0
        self.within = (-32768, 32767)
        if most < least:
            raise Refused(RANGE)
        if least:
            lo, hi = -(-(least << 10) // scale_), (most << 10) // scale_
            if lo > hi or hi >= 32767:
                raise Refused(RANGE)
            self.within = lo, hi

    def step(self, code, missed):
        good = self.within[0] <= code <= self.within[1]
        self.off = 0 if good else min(self.ticks, self.off + 1 + missed)
        return int(self.off >= self.ticks)

    def state(self):
        return pack("<I", self.off)


class Rail:
    """The supply's codes: now and then for some ticks none, too high, or any."""

    def __init__(self, good):
        self.good, self.off = good, None

    def draw(self, rng, k):
        if rng.draw(0, 95 if self.off is None else 15) == 0:
            code = (0, 32766, None)[rng.draw(0, 2)]
            any_ = rng.draw(-32768, 32767)
            self.off = (any_ if code is None else code) if self.off is None else None
        return 32766 if 72 <= k % 96 < 88 else self.good if self.off is None else self.off


def any_limits(rng, rate, k):
    """(error, ticks, limits, good code)"""
    while True:
        least, most, scale_, ms, good = any_supply(rng, rate, 31)
        least = least or 1
        if rng.draw(0, 3) == 0:
            most = least + rng.draw(0, 2000)
        if rng.draw(0, 1) == 0:
            scale_ >>= 1
        try:
            return 0, Supply((least, most, scale_, ms, good), period(rate, k)), good
        except Refused as e:
            if rng.draw(0, 3) == 0:
                # Nothing is judged; the time is known already where it is the limits that are
                # refused.
                return -e.args[0], Supply((0, 100 << 20, scale_, ms, good), period(rate, k)), good


def supply(rate):
    rng, bad = Rng("supply", rate, 0), 0
    for k in range(TICKS):
        err = 0
        if k % 16 == 0:
            err, s, good = any_limits(rng, rate, k)
        if rng.draw(0, 7) == 0:
            bad = rng.draw(0, 3)
        raw = rng.draw(-32768, 32767)
        if bad == 1:
            raw = s.within[0] + rng.draw(-1, 0)
        if bad == 2:
            raw = s.within[1] + rng.draw(0, 1)
        if bad == 0 or not -32768 <= raw <= 32767:
            raw = good
        missed = 0
        if rng.draw(0, 15) == 0:
            missed = rng.u64() & M32
            missed >>= rng.draw(0, 31)
        yield (raw, missed, err, *s.within, s.ticks, s.step(raw, missed)), s.state()


MODULES = {"guard": ("len flip off pending moving | broken at crc word", guard),
           "supply": ("raw missed err | min_raw max_raw ticks fault", supply)}
