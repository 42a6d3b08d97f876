# SPDX-License-Identifier: MIT
"""track: does the current monitored follow what is coded?"""

from struct import Struct

from .num import AGAIN, MAX32, MIN32, TICKS, Rng, clamp, period, sat32, wave


class Track:
    pack = Struct("<iiI").pack

    def __init__(self, par, T):
        self.tol, ms = par
        self.ticks = ms * T[1] // (1000 * T[0]) + 5
        self.lo = self.hi = self.off = 0

    def step(self, mon):
        """1: it has not followed for too long."""
        if self.lo - self.tol <= mon <= self.hi + self.tol:
            self.off = 0
        else:
            self.off = min(self.off + 1, self.ticks)
        return int(self.off == self.ticks)

    def coded(self, cur):
        if self.off == 0:
            self.lo = self.hi = cur
        self.lo, self.hi = min(self.lo, cur), max(self.hi, cur)

    def state(self):
        return self.pack(self.lo, self.hi, self.off)


def any_par(rng, rate):
    return rng.draw(6710886, 67108864), clamp(rng.draw(1, 12) * 1000 // rate, 1, 100)


class Monitor:
    """A scene's monitor: mostly the code of the commanded current. Now and then any code for a
    while."""

    def __init__(self):
        self.astray = 0

    def draw(self, rng, drive, coded):
        raw, zero, scale = rng.draw(-32768, 32767), drive[9], drive[10]
        if rng.draw(0, 7 if self.astray else 31) == 0:
            self.astray ^= 1
        return raw if self.astray else clamp(zero + (coded << 14) // scale, -32768, 32767)


def track(rate):
    rng = Rng("track", rate, 0)
    coded = wave("track", rate, 1, MIN32, MAX32, 1 << rng.draw(20, 27))
    last = astray = 0
    for k in range(TICKS):
        if k in (0, AGAIN):
            t, last = Track(any_par(rng, rate), period(rate, k)), 0
        mon, how, by = rng.draw(MIN32, MAX32), rng.draw(0, 7), rng.draw(0, 1)
        if rng.draw(0, 31 if astray else 15) == 0:
            astray ^= 1
        if not astray and how < 6:
            mon = sat32(last + (t.tol + by) * (1 if how < 2 else -1 if how < 4 else 0))
        out = t.step(mon)
        last = coded[k]
        t.coded(last)
        yield (mon, last, out, t.lo, t.hi, t.off), t.state()


COLUMNS = "mon_A_q26 coded_A_q26 | astray lo_A_q26 hi_A_q26 off_ticks"

MODULES = {"track": (COLUMNS, track)}
