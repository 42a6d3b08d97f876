# SPDX-License-Identifier: MIT
"""chatter: a contact that buzzes, and drives the string."""

from struct import Struct

from .num import AGAIN, MAX32, MIN32, TICKS, Rng, clamp, gain, period, times, wrap
from .velocity import scale

CHATTER, SWING, WAY = 1 << 15, 1 << 24, 1 << 24


def any_par(rng):
    """power, energy"""
    power = 10486 + (rng.draw(0, 10475274) >> rng.draw(0, 12))
    energy = 16778 + (rng.draw(0, 16760438) >> rng.draw(0, 12))
    return power, energy if rng.draw(0, 7) else 0


class Chatter:
    pack = Struct("<qqiiiIB").pack

    def __init__(self, par, knot, step, T):
        x, y = knot
        joule = gain((y << 32) // x, step)
        self.energy = times(joule, par[1])
        w, down = times(joule, 16 * par[0]), 0
        while w >> down > MAX32:
            down += 1
        self.leak = times(gain(*T), w >> down) << down
        self.most = max(50 * T[1] // (1000 * T[0]), 8) + 1
        self.net = self.cycle = self.held = self.end = self.cnt = self.ticks = self.rises = 0

    def step(self):
        return CHATTER if self.energy and self.net >= self.energy else 0

    def coded(self, cnt, now):
        moved = clamp(wrap(cnt - self.cnt), -WAY, WAY)
        if self.ticks < self.most:
            self.cycle -= (self.held >> 6) * moved
            self.ticks += 1
        else:
            self.cycle = 0
        self.net -= clamp(self.net, -self.leak, self.leak)
        back = self.end - now if self.rises else now - self.end
        if back > SWING:
            self.end, self.rises = now, 1 - self.rises
            if self.rises:
                self.net += self.cycle
                self.cycle = self.ticks = 0
        elif back < 0:
            self.end = now
        self.net = clamp(self.net, -self.energy, self.energy)
        self.held, self.cnt = now, cnt

    def state(self):
        return self.pack(self.net, self.cycle, self.held, self.end, self.cnt, self.ticks,
                         self.rises)


def chatter(rate):
    """A current that swings, and a string that goes with it, mostly inward: it is given energy."""
    rng = Rng("chatter", rate, 0)
    for k in range(TICKS):
        if k in (0, AGAIN):
            knot = rng.draw(1 << 24, 104857600), rng.draw(1 << 24, 1 << 27)
            step = scale(rng)
            s = Chatter(any_par(rng), knot, step, period(rate, k))
            cnt, coded, inward = rng.draw(MIN32, MAX32), 0, 1
        how = rng.draw(0, 31)
        if how == 0:
            inward = 1 - inward
        if rng.draw(0, 1):
            coded = rng.draw(0, 442918502) >> rng.draw(0, 12)
        move = rng.draw(MIN32, MAX32)
        cnt = wrap(cnt + (move if how == 1 else -abs(move >> 20) if inward else move >> 20))
        due = s.step()
        s.coded(cnt, coded)
        yield (cnt, coded, due, s.net >> 32, s.cycle >> 32, s.ticks), s.state()


COLUMNS = "cnt coded_A_q26 | faults net_Acnt_qm12 cycle_Acnt_qm12 ticks"

MODULES = {"chatter": (COLUMNS, chatter)}
